"""Is the promise of a next experiment kept? `python -m benchmarks.gap.next_experiment_closed [--cases N]`.

Synthetic cases with an effect that is hardly visible, beside one that resembles it (`benchmarks.gap.next_experiment`).
Where both remain in question and further trials of another movement are proposed, each of the two likeliest
explanations is taken as true in turn: the proposed trials are simulated from it as it was fitted, with noise,
deviations of the trials and noise of the inputs, two are added to the calibration trials and one to those held out, and
the case is diagnosed again from the start, noise and variation estimated anew, with these two effects on offer. They
count as told apart where the true one is ahead by as much as puts the other out of question
(`gap.experiment.promise.margin`); that share is held against the promise. Whether the true one is also named is kept
beside it: an effect that takes less than a tenth of the squared error away is not. Trials on the bench (nothing or a
weight on the sensor, sensors exchanged) are no trials of the model and cannot be added to a case: there both
explanations are refitted to old and new trials together, with the noise levels of the fit.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.gap.next_experiment import FAINT, asked, in_question

HERE = Path(__file__).resolve().parents[1]
PLACES = 4  # bins of the promise


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.gap.next_experiment_closed", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--sources", nargs="+", default=["elbow", "foot", "knee", "sit_to_stand", "shoulder"])
    parser.add_argument("--cases", type=int, default=10, help="of each source")
    parser.add_argument("--repeats", type=int, default=3, help="simulations from each explanation")
    parser.add_argument("--seed", type=int, default=57)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--out", type=Path, default=HERE / "results" / "gap_next_experiment_closed.json")
    return parser.parse_args()


def closed(
    source: str, effect: str, pair: tuple[str, ...], place: int, options: argparse.Namespace
) -> dict[str, Any] | None:
    """One case; None where it cannot be made, no "told" where nothing is proposed that can be added to it."""
    from benchmarks.gap.sources import case_with, name_of
    from geocontact.gap.case.admission import admitted
    from geocontact.gap.experiment.proposal import proposed
    from geocontact.systems.catalogue import system_of

    nats = float(np.exp(np.random.default_rng([options.seed, place]).uniform(*np.log(FAINT))))
    case = case_with(source, effect, nats, options.seed, place)
    if case is None:
        return None
    system = system_of(case)
    case = admitted(case, system)
    found = in_question(case, system, pair)
    row: dict[str, Any] = {"source": name_of(source), "effect": effect, "held": list(pair), "case": place}
    row |= {"in_question": list(found.answer.ambiguity)}
    chosen = proposed(found)
    if chosen is None or chosen.said.share is None:
        return row
    row |= {"experiment": chosen.experiment.name, "nats": chosen.said.gain_nats, "promised": chosen.said.share}
    bench = chosen.experiment.staged(found.clean.system) is not found.clean.system
    again = partial(refitted, found) if bench else partial(repeated, case, system, found)
    outcomes = {one.name: again(chosen, one, options) for one in truths(chosen)}
    row |= {"bench": bench}
    if not bench:
        row |= {"named": {name: [each[1] for each in some] for name, some in outcomes.items()}}
        outcomes = {name: [each[0] for each in some] for name, some in outcomes.items()}
    told = [value for each in outcomes.values() for value in each]
    return row | {"outcomes": outcomes, "told": float(np.mean(told)), "repetitions": len(told)}


def truths(chosen: Any) -> list[Any]:
    """The two explanations, each once."""
    return list({pair.true.name: pair.true for pair in chosen.pairs}.values())[:2]


def repeated(
    case: Any, system: Any, found: Any, chosen: Any, true: Any, options: argparse.Namespace
) -> list[tuple[bool, bool]]:
    """Whether both are told apart and whether the true one is named, for each simulation of the proposed trials."""
    from benchmarks.gap.simulated import trial_of
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.attribute import attribute
    from geocontact.gap.experiment.promise import margin
    from geocontact.gap.experiment.proposal import TRIALS

    names = tuple(one.name for one in truths(chosen))
    outcome = []
    for repeat in range(options.repeats):
        rng = np.random.default_rng([options.seed, repeat, names.index(true.name)])
        made = [
            replace(
                trial_of(found.clean, chosen.lead.noise, chosen.experiment.trial, true.system, true.values, rng),
                name=f"next{k}",
            )
            for k in range(TRIALS)
        ]
        longer = replace(
            case, calibration=(*case.calibration, *made[:-1]), evaluation=(*case.evaluation, made[-1])
        )  # fmt: skip
        again = attribute(longer, system, lambda s: [one for one in candidates(s) if one.name in names])
        nats = {name: max(c.nats for c in again.contenders if c.names == (name,)) for name in names}
        (other,) = (name for name in names if name != true.name)
        apart = nats[true.name] - nats[other] > margin(max(nats.values()) - again.base.nats)
        outcome.append((bool(apart), again.answer.effects == (true.name,)))
    return outcome


def refitted(found: Any, chosen: Any, true: Any, options: argparse.Namespace) -> list[bool]:
    """Whether the true explanation is ahead enough where both are refitted to old and simulated bench trials."""
    from benchmarks.gap.next_experiment import Seen
    from benchmarks.gap.simulated import trial_of
    from geocontact.gap.experiment.promise import margin
    from geocontact.gap.experiment.proposal import TRIALS

    problem, stage, both = found.clean, chosen.experiment.staged, truths(chosen)
    nats = {name: max(c.nats for c in found.contenders if c.names == (name,)) for name in (one.name for one in both)}
    (other,) = (one for one in both if one.name != true.name)
    trials = len(problem.recorded.trials)
    most = (max(nats.values()) - found.base.nats) * (trials + TRIALS) / trials
    outcome = []
    for repeat in range(options.repeats):
        rng = np.random.default_rng([options.seed, repeat, both.index(true)])
        moved = chosen.experiment.trial
        fresh = [
            trial_of(problem, chosen.lead.noise, moved, true.system, true.values, rng, stage) for _ in range(TRIALS)
        ]
        seen = Seen.of(problem, chosen.lead, problem.recorded.trials, fresh, stage)
        own, wrong = seen.costs(true), seen.costs(other)
        gain = (wrong[1] - own[1]) - (wrong[0] - own[0])
        outcome.append(bool(nats[true.name] - nats[other.name] + gain > margin(most)))
    return outcome


def tried(options: argparse.Namespace, work: tuple[str, str, tuple[str, ...], int]) -> None:
    """`closed` with one thread, kept."""
    from threadpoolctl import threadpool_limits

    from benchmarks.gap.rows import keep

    with threadpool_limits(limits=1):
        row = closed(*work, options)
    if row is not None:
        keep(options.out.with_suffix(".rows"), options.seed, row)


def summary(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Shares promised and kept: over all, and by equal parts of the promise."""
    told = [row for row in rows if "told" in row]
    parts = []
    for k in range(PLACES):
        own = [row for row in told if int(min(row["promised"] * PLACES, PLACES - 1)) == k]
        if own:
            parts.append(_pooled(own) | {"from": k / PLACES, "to": (k + 1) / PLACES})
    whole = _pooled(told) if told else {}
    bench = {kind: [row for row in told if row["bench"] is (kind == "bench")] for kind in ("bench", "movement")}
    by_kind = {kind: _pooled(own) for kind, own in bench.items() if own}
    return whole | {"cases": len(rows), "proposals": len(told), "by_promise": parts, "by_kind": by_kind}


def _pooled(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    promised, kept = (np.array([row[key] for row in rows]) for key in ("promised", "told"))
    off = kept - promised
    error = float(off.std(ddof=1) / np.sqrt(len(off))) if len(off) > 1 else None
    return {
        "proposals": len(rows),
        "promised": round(float(promised.mean()), 3),
        "kept": round(float(kept.mean()), 3),
        "standard_error": None if error is None else round(error, 3),
        "repetitions": sum(row["repetitions"] for row in rows),
    }


def written(out: Path) -> dict[str, Any]:
    """The JSON of what is kept so far."""
    from benchmarks.gap.rows import kept

    runs, found = kept(out.with_suffix(".rows"))
    own = {name: summary([row for row in found if row["source"] == name]) for name in {row["source"] for row in found}}
    whole = {"runs": runs, "all": summary(found), "of": own, "rows": found}
    out.write_text(json.dumps(whole, indent=1) + "\n")
    return whole


def main() -> None:
    """Propose, simulate, diagnose, write what there is after each case, print the shares."""
    from benchmarks.gap.rows import begin
    from benchmarks.machine import machine
    from geocontact.analyses.frame.workers import each

    options = arguments()
    said = {k: v for k, v in vars(options).items() if k not in ("out", "seed")}
    begin(options.out.with_suffix(".rows"), options.seed, {"machine": machine(), "options": said})
    options.others = 0  # cases without an effect have no two explanations
    try:
        for _, became in each(partial(tried, options), list(asked(options)), options.jobs):
            if became is not None:
                raise became
            written(options.out)
    finally:
        print(json.dumps(written(options.out)["all"], indent=1))


if __name__ == "__main__":
    main()
