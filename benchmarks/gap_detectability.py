"""Do detectability statements hold? `python -m benchmarks.gap_detectability [--cases N] [--repeats N] [--effects A …]`.

Synthetic cases without an effect (`gap.benchmark`) are fitted; `gap.detectability` says from which amplitude on the
diagnosis would see each effect. Then trials are simulated at that amplitude, at half and at one and a half times of
it, with noise, deviations of the trials and noise of the inputs as fitted, and attributed. Seen is an effect where the
verdict is not `no_gap`. A statement is what is more probable by the predicted power, at half and at one and a half
times; it is right where that happens.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
TIMES = (0.5, 1.0, 1.5)
EFFECTS = ("time_shift", "damping", "dry_friction.rate", "stiffening", "sensor_drift.force", "saturation.force")


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap_detectability", description=__doc__.splitlines()[0])
    parser.add_argument("--system", default="elbow")
    parser.add_argument("--cases", type=int, default=2)
    parser.add_argument("--repeats", type=int, default=4, help="simulations of each effect at each amplitude of a case")
    parser.add_argument("--effects", nargs="+", default=list(EFFECTS))
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--out", type=Path, default=HERE / "results", help="folder for the JSON")
    return parser.parse_args()


def rows(options: argparse.Namespace, place: int) -> list[dict[str, Any]]:
    """One case: every effect at every amplitude."""
    from benchmarks.gap_simulated import case_of
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.admission import admitted
    from geocontact.gap.attribute import attribute
    from geocontact.gap.benchmark.drawing import Lot, drawn
    from geocontact.gap.contest import base_contender
    from geocontact.gap.detectability import detectabilities, power, rivals_of
    from geocontact.gap.problem import problem_of
    from geocontact.gap.signatures import ground_of, reach_of, rest_of, sized
    from geocontact.systems.catalogue import system_of

    case = drawn(Lot(options.system, "none", options.seed, place)).case
    case = admitted(case, system_of(case))
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    ground = ground_of(problem, base.noise, base.model.values)
    offered = [one for one in candidates(problem.system) if one.parameters]
    rivals, found = rivals_of(ground, offered), []
    for told in detectabilities(ground, offered, [one for one in offered if one.label in options.effects]):
        one = told.candidate
        if told.smallest is None:
            continue
        rest, first = rest_of(one), one.parameters[0].name
        for times in TIMES:
            share = times * (told.smallest - rest) / reach_of(one, one.starts[0])
            if share > 1.0:
                continue
            amplitude = rest + times * (told.smallest - rest)
            values = {**base.model.values, **told.at.values, first: amplitude}
            others = [each for label, some in rivals.items() if label != one.label for each in some]
            there = sized(ground, one, {**told.at.values, first: amplitude})
            predicted = power(ground, there, others, sum(each.name == one.name for each in offered))
            for k in range(options.repeats):
                new = case_of(case, problem, base.noise, one.apply(problem.system), values, 1000 * place + k)
                said = attribute(new, system_of(new), candidates).answer
                seen = said.verdict != "no_gap"
                row = {"case": place, "effect": one.label, "times": times, "amplitude": amplitude, "seen": seen}
                row |= {"unit": one.parameters[0].unit, "visible_nats": there.visible, "predicted": predicted}
                found.append(row | {"verdict": said.verdict, "named": one.name in said.ambiguity})
            print(
                place, one.label, times, sum(r["seen"] for r in found[-options.repeats :]), file=sys.stderr, flush=True
            )
    return found


def main() -> None:
    """Simulate, attribute, print the shares, write the JSON."""
    options = arguments()
    from threadpoolctl import threadpool_limits

    from benchmarks.machine import machine
    from benchmarks.tables import markdown
    from geocontact.gap.benchmark.rates import Rate

    with threadpool_limits(limits=1):
        found = [row for place in range(options.cases) for row in rows(options, place)]
    seen: dict[str, dict[float, list[bool]]] = defaultdict(lambda: defaultdict(list))
    for row in found:
        for label in (row["effect"], "all"):
            seen[label][row["times"]].append(row["seen"])
    shares = {label: {f"{t:g}": sum(v) / len(v) for t, v in own.items()} for label, own in seen.items()}
    right = [row["seen"] == (row["predicted"] >= 0.5) for row in found if row["times"] != 1.0]
    rate = Rate.of(right)
    head = ("effect", *(f"seen at {t:g} times" for t in TIMES))
    print(
        markdown(head, [[k, *(f"{own.get(f'{t:g}', float('nan')):.2f}" for t in TIMES)] for k, own in shares.items()])
    )
    print(f"statements right: {rate}")
    about = {"machine": machine(), "options": {k: str(v) for k, v in vars(options).items() if k != "out"}}
    summary = {"share_seen": shares, "statements_right": sum(right) / len(right), "statements": len(right)}
    options.out.mkdir(parents=True, exist_ok=True)
    text = json.dumps({**about, **summary, "rows": found}, indent=1)
    (options.out / "gap_detectability.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
