"""How often could anybody rank the planted effect first? `python -m benchmarks.gap.attainable --seed N`.

Planted effects do not have their candidate's form, and another candidate may come nearer to one than its own does. Here
every candidate is refitted, together with the base, to the calibration trials of the gap benchmark's visible single
effects as they would be without noise (`gap_benchmark.answers`), weighed by the true covariance. The margin is what
the best of the other effects leaves more than the best candidate of the planted one, in nats. Where it is clearly
below zero, whoever weighs these candidates by how well they fit is wrong, however well the noise is known; about zero,
noise and the number of parameters decide. Fits set out from the candidates' own starts; one that ends in a poor minimum
counts as it ends. Mistakes in the data are exact by nature and not asked about. With `--cases`
the margins stand beside what the diagnosis said of the same cases.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from geocontact.gap_benchmark.answers import CLEAR
from geocontact.gap_benchmark.drawing import SYSTEMS

HERE = Path(__file__).resolve().parents[1]
ASKED = ("single", "shift")
"""Kinds of cases."""


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.attainable", description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, required=True, help="of the gap benchmark")
    parser.add_argument("--systems", nargs="+", default=list(SYSTEMS), choices=SYSTEMS)
    parser.add_argument("--of", type=int, default=200, help="cases of each system, all kinds, as in the gap benchmark")
    parser.add_argument("--cases", type=Path, help="cases.csv that the gap benchmark wrote with this seed")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--out", type=Path, default=HERE / "results" / "gap_attainable.json", help="the JSON")
    return parser.parse_args()


def margin(lot: Any) -> dict[str, Any] | None:
    """One case; None where its effect is not visible."""
    from threadpoolctl import threadpool_limits

    from geocontact.effects.catalogue import candidates
    from geocontact.gap.case.admission import admitted
    from geocontact.gap_benchmark.answers import what_each_leaves
    from geocontact.gap_benchmark.drawing import drawn
    from geocontact.gap_benchmark.score import visible
    from geocontact.systems.catalogue import system_of

    with threadpool_limits(limits=1):
        planted = drawn(lot)
        label = planted.label
        if not visible(label.as_dict()):
            return None
        system = system_of(planted.case)
        system = system.scaled(admitted(planted.case, system).calibration)
        offered = candidates(system)
        name_of = {one.label: one.name for one in offered}
        before, left = what_each_leaves(system, planted.ideal, offered, label.floor)
    (truth,) = label.effects
    own = min(left[one] for one in left if name_of[one] == truth)
    rival = min((one for one in left if name_of[one] != truth), key=lambda one: left[one])
    row: dict[str, Any] = {"name": planted.case.name, "system": lot.system, "kind": lot.kind, "place": lot.place}
    row |= {"effect": truth, "nats": label.nats[truth], "base": before, "own": own}
    return row | {"rival": name_of[rival], "rival_label": rival, "rival_left": left[rival], "margin": left[rival] - own}


def asked(options: argparse.Namespace) -> Iterator[Any]:
    """The lots, as the gap benchmark draws them."""
    from geocontact.gap_benchmark.drawing import KINDS, lots

    yield from (lot for lot in lots(options.systems, options.of, KINDS, options.seed) if lot.kind in ASKED)


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """How often the planted effect is ahead, hardly told or behind, and how often it was ranked first there.

    `attainable` is the share that who knows the noise ranks right: two fits Δ nats apart differ by Δ ± √(2Δ) with noise
    on them, so the sum of Φ(±√(Δ/2)).
    """
    from scipy.stats import norm

    from geocontact.gap_benchmark.score import Rate

    margins = np.array([row["margin"] for row in rows])
    right = norm.cdf(np.sign(margins) * np.sqrt(0.5 * np.abs(margins)))
    found: dict[str, Any] = {"attainable": float(right.mean()) if len(right) else float("nan")}
    for name, low, high in (("ahead", CLEAR, np.inf), ("hardly", -CLEAR, CLEAR), ("behind", -np.inf, -CLEAR)):
        rate = Rate.of(low <= row["margin"] < high for row in rows)
        told = [row for row in rows if "first" in row and low <= row["margin"] < high]
        first = Rate.of(row["first"] == row["effect"] for row in told)
        found[name] = {"hits": rate.hits, "count": rate.count, "ci95": list(rate.interval())}
        found[name] |= {"ranked_first": first.hits, "of": first.count}
    return found


def said(path: Path | None) -> dict[str, tuple[str, float]]:
    """What the diagnosis ranked first, by the name of the case, and how visible its effect was there [nats]."""
    if path is None:
        return {}
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {
        row["case"]: ((row["ambiguity"].split() or row["effects"].split(" + "))[0], float(row["nats"] or "nan"))
        for row in rows
    }


def beside(row: dict[str, Any], first: Mapping[str, tuple[str, float]]) -> dict[str, Any]:
    """A case with what the diagnosis said of it; SystemExit where that was said of another case of the same name."""
    if row["name"] not in first:
        return row
    ranked, nats = first[row["name"]]
    if not np.isclose(nats, row["nats"], rtol=1e-6):
        sys.exit(f"{row['name']}: {nats:.6g} nats in --cases, {row['nats']:.6g} here: drawn by another version")
    return row | {"first": ranked}


def main() -> None:
    """Draw, refit, write the JSON after every case, print the shares."""
    from benchmarks.machine import machine
    from geocontact.analyses.frame.source_digest import digest
    from geocontact.analyses.frame.workers import each

    options, rows = arguments(), []
    first = said(options.cases)
    about = {"seed": options.seed, "cases_of_each": options.of, "clear_nats": CLEAR, "version": digest()}
    about["machine"] = machine()
    for _, became in each(margin, list(asked(options)), options.jobs):
        if isinstance(became, BaseException):
            raise became
        if became is None:
            continue
        rows.append(beside(became, first))
        own = {system: summary([row for row in rows if row["system"] == system]) for system in options.systems}
        whole = {**about, "all": summary(rows), "systems": own, "rows": rows}
        options.out.write_text(json.dumps(whole, indent=1) + "\n")
    print(json.dumps(summary(rows), indent=1))


if __name__ == "__main__":
    main()
