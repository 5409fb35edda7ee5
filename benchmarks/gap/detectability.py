"""Do detectability statements hold? `python -m benchmarks.gap.detectability [--cases N] [--repeats N]`.

Cases without an effect (planted ones, or a folder: `benchmarks.gap.sources`) are fitted;
`gap.identifiability.detectability` says from which amplitude on the diagnosis would see an effect. Then trials are
simulated at that amplitude, at half and at one and a half times of it, with noise, deviations of the trials and noise
of the inputs as fitted, and attributed. Seen is an effect where the verdict is not `no_gap`. A statement is what is
more probable by the predicted power, at half and at one and a half times; it is right where that happens. Every
simulation is kept as it comes (`benchmarks.gap.rows`).
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parents[1]
TIMES = (0.5, 1.0, 1.5)
EFFECTS = (
    "time_shift", "damping", "asymmetry", "sensor_drift", "stiffening", "dead_zone", "crosstalk", "dry_friction",
    "saturation",
)  # fmt: skip
"""Asked about in this order, as far as a system has them; the first candidate of each."""


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.detectability", description=__doc__.splitlines()[0])
    parser.add_argument(
        "--sources", nargs="+", default=["elbow", "foot", "knee", "sit_to_stand", "shoulder"],
        help="systems with planted cases, or folders of cases without an effect",
    )  # fmt: skip
    parser.add_argument("--cases", type=int, default=1, help="of each source")
    parser.add_argument("--most", type=int, default=4, help="effects asked about in a case")
    parser.add_argument("--repeats", type=int, default=1, help="simulations of each effect at each amplitude of a case")
    parser.add_argument(
        "--narrow", nargs="*", default=[],
        help="sources whose diagnoses, and statements, are offered nothing but the effects asked about: quicker",
    )  # fmt: skip
    parser.add_argument("--times", nargs="+", type=float, default=list(TIMES))
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--out", type=Path, default=HERE / "results" / "gap_detectability.json", help="the JSON")
    return parser.parse_args()


@dataclass(frozen=True)
class Asked:
    """A statement about one effect of a case, and everything to try it."""

    case: Any
    problem: Any
    base: Any
    told: Any
    offer: Callable[[Any], list[Any]]


def statements(source: str, place: int, options: argparse.Namespace) -> Iterator[tuple[dict[str, Any], Asked]]:
    """What is said of every effect of a case at every amplitude: rows without the outcome."""
    from benchmarks.gap.sources import bare_case, name_of
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.case.admission import admitted
    from geocontact.gap.case.preparation import problem_of
    from geocontact.gap.identifiability.detectability import competitors_of, detectabilities, power
    from geocontact.gap.identifiability.signatures import base_state_of, reach_of, rest_of, sized
    from geocontact.gap.selection.model_comparison import base_contender
    from geocontact.systems.catalogue import system_of

    case = bare_case(source, options.seed, place)
    case = admitted(case, system_of(case))
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    ground = base_state_of(problem, base.noise, base.model.values)
    known = [one for one in candidates(problem.system) if one.parameters]
    able = [name for name in EFFECTS if any(one.name == name for one in known)]
    names = [able[(place + k) % len(able)] for k in range(min(options.most, len(able)))]
    asked = [next(one for one in known if one.name == name) for name in names]

    def offer(system: Any) -> list[Any]:
        return [one for one in candidates(system) if source not in options.narrow or one.name in names]

    offered = [one for one in offer(problem.system) if one.parameters]
    competitors = competitors_of(ground, offered)
    for told in detectabilities(ground, offered, asked):
        one = told.candidate
        if told.smallest is None:
            continue
        rest, first = rest_of(one), one.parameters[0].name
        others = [each for label, some in competitors.items() if label != one.label for each in some]
        for times in options.times:
            amplitude = rest + times * (told.smallest - rest)
            if (amplitude - rest) / reach_of(one, one.starts[0]) > 1.0:
                continue
            there = sized(ground, one, {**told.at.values, first: amplitude})
            chance = power(ground, there, others, sum(each.name == one.name for each in offered))
            row = {"source": name_of(source), "case": place, "effect": one.label, "times": times}
            row |= {"amplitude": amplitude, "unit": one.parameters[0].unit, "visible_nats": there.visible}
            yield row | {"predicted": chance}, Asked(case, problem, base, there, offer)


def simulated(options: argparse.Namespace, work: tuple[str, int]) -> None:
    """One case: every effect at every amplitude, simulated and attributed, kept as it comes."""
    from threadpoolctl import threadpool_limits

    from benchmarks.gap.rows import keep
    from benchmarks.gap.simulated import case_of
    from geocontact.gap.attribute import attribute
    from geocontact.systems.catalogue import system_of

    source, place = work
    with threadpool_limits(limits=1):
        for row, one in statements(source, place, options):
            values = {**one.base.model.values, **one.told.values}
            system = one.told.candidate.apply(one.problem.system)
            for k in range(options.repeats):
                new = case_of(one.case, one.problem, one.base.noise, system, values, 1000 * place + k)
                said = attribute(new, system_of(new), one.offer).answer
                done = row | {"seen": said.verdict != "no_gap", "verdict": said.verdict}
                done |= {"named": one.told.candidate.name in said.ambiguity}
                keep(options.out.with_suffix(".rows"), options.seed, done)


def right(row: dict[str, Any]) -> bool:
    """Whether what the predicted power makes more probable happened."""
    return bool(row["seen"] == (row["predicted"] >= 0.5))


def summary(found: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Shares seen by amplitude, and statements right, at other amplitudes than the stated one."""
    from geocontact.gap_benchmark.score import Rate

    seen = {t: Rate.of(row["seen"] for row in found if row["times"] == t) for t in sorted({r["times"] for r in found})}
    rate = Rate.of(right(row) for row in found if row["times"] != 1.0)
    shares = {f"{t:g}": {"seen": one.hits, "of": one.count} for t, one in seen.items()}
    cases = len({(row["seed"], row["source"], row["case"]) for row in found})
    return {
        "right": rate.hits, "statements": rate.count, "interval": rate.interval(), "cases": cases, "seen_at": shares,
    }  # fmt: skip


def main() -> None:
    """Simulate, attribute, write the JSON after each case and when interrupted, print the shares."""
    from benchmarks.gap.rows import begin
    from benchmarks.gap.sources import name_of
    from benchmarks.machine import machine
    from geocontact.analyses.frame.workers import each

    options = arguments()
    said = {k: v for k, v in vars(options).items() if k not in ("out", "seed")}
    said |= {key: [name_of(one) for one in said[key]] for key in ("sources", "narrow")}
    begin(options.out.with_suffix(".rows"), options.seed, {"machine": machine(), "options": said})
    work = [(source, place) for place in range(options.cases) for source in options.sources]
    try:
        for _, became in each(partial(simulated, options), work, options.jobs):
            if became is not None:
                raise became
            written(options.out)
    finally:
        print(written(options.out)["all"])


def written(out: Path) -> dict[str, Any]:
    """The JSON of what is kept so far: pooled, by source, then every simulation."""
    from benchmarks.gap.rows import kept

    runs, found = kept(out.with_suffix(".rows"))
    sources = dict.fromkeys(source for run in runs for source in run["options"]["sources"])
    own = {source: summary([row for row in found if row["source"] == source]) for source in sources}
    whole = {"runs": runs, "all": summary(found), "of": own, "rows": found}
    out.write_text(json.dumps(whole, indent=1) + "\n")
    return whole


if __name__ == "__main__":
    main()
