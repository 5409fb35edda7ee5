"""Do proposed experiments tell apart what they promise? `python -m benchmarks.gap.next_experiment [--cases N]`.

Synthetic cases have one effect that is hardly visible; it and one that looks like it are fitted, and where their
evidence leaves both in question the next experiment is asked for. Others have an effect that base parameters swallow,
or none, and are attributed with everything on offer. Then every answer in question is simulated on trials like those of
the case and on the trials proposed, with noise, deviations of the trials and noise of the inputs, and refitted by
itself and by every other: what the wrong one leaves more than the right one, in nats, on the old trials and on old and
new ones together. The smallest of these over all pairs is what the experiment must raise, `TIMES` times or more, a
separation of less than `NOTHING` nats counting as that much. Every case is kept as it comes (`benchmarks.gap.rows`).
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parents[1]
TIMES = 3.0
NOTHING = 5.0 / 3.0  # nats: so that at least 5 must be reached
FAINT = (15.0, 60.0)  # visible nats of effects that are hardly told apart
PAIRS = (
    ("asymmetry", "sensor_gain"), ("preload", "sensor_offset"), ("crosstalk", "sensor_gain"),
    ("motion_offset", "sensor_offset"), ("damping", "relaxation"), ("motion_offset", "preload"),
    ("time_shift", "filter_lag"),
)  # fmt: skip
"""Effects that look like each other, in the order in which cases get them."""
CLOSE = 1e-6  # relative change of the squares at which a refit has ended
ROUNDS = 30


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.gap.next_experiment", description=__doc__.splitlines()[0]
    )
    parser.add_argument(
        "--sources", nargs="+", default=["elbow", "foot", "knee", "sit_to_stand", "shoulder"],
        help="systems with planted cases, or folders of cases without an effect that are simulated anew",
    )  # fmt: skip
    parser.add_argument("--cases", type=int, default=10, help="of each source that have an effect")
    parser.add_argument("--others", type=int, default=1, help="absorbed ones, and ones without an effect")
    parser.add_argument("--repeats", type=int, default=3, help="simulations of each answer of a case")
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--out", type=Path, default=HERE / "results" / "gap_next_experiment.json", help="the JSON")
    return parser.parse_args()


def asked(options: argparse.Namespace) -> Iterator[tuple[str, str, tuple[str, ...], int]]:
    """Source, effect, pair that is held against each other (none: the diagnosis decides) and place of every case."""
    from benchmarks.gap.sources import CONFOUNDED, effects_of, has_confounded, known_to
    from benchmarks.gap.sources import NOTHING as BARE

    known = {source: list(_pairs(effects_of(source), known_to(source))) for source in options.sources}
    for place in range(options.cases):
        for source, pairs in known.items():
            pair, able = pairs[place % len(pairs)]
            yield source, able[place // len(pairs) % len(able)], pair, place
    for place in range(options.others):
        for source in options.sources:
            yield source, BARE, (), options.cases + 2 * place
            if has_confounded(source):
                yield source, CONFOUNDED, (), options.cases + 2 * place + 1


def _pairs(effects: Sequence[str], known: Sequence[str]) -> Iterator[tuple[tuple[str, str], tuple[str, ...]]]:
    """Pairs that a source knows, and which of the two its cases can have."""
    for pair in PAIRS:
        able = tuple(name for name in pair if name in effects)
        if able and set(pair) <= set(known):
            yield pair, able


def checked(
    source: str, effect: str, pair: tuple[str, ...], place: int, options: argparse.Namespace
) -> dict[str, Any] | None:
    """One case; None where it cannot be made, no "change" where nothing is proposed."""
    from benchmarks.gap.sources import case_with, name_of
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.attribute import attribute
    from geocontact.gap.case.admission import admitted
    from geocontact.gap.diagnose import first_of
    from geocontact.gap.experiment.proposal import proposed
    from geocontact.gap.identifiability.non_identifiable import non_identifiable
    from geocontact.systems.catalogue import system_of

    nats = float(np.exp(np.random.default_rng([options.seed, place]).uniform(*np.log(FAINT))))
    case = case_with(source, effect, nats, options.seed, place)
    if case is None:
        return None
    system = system_of(case)
    case = admitted(case, system)
    found = in_question(case, system, pair) if pair else attribute(case, system, candidates)
    problem, said = found.clean, found.answer
    hidden = [each.name for each in non_identifiable(problem, candidates(problem.system), said.effects)]
    chosen = proposed(found, first_of(candidates(problem.system), hidden))
    row: dict[str, Any] = {"source": name_of(source), "effect": effect, "held": list(pair), "case": place}
    row |= {"verdict": said.verdict, "in_question": list(said.ambiguity)}
    if chosen is None:
        return row
    rng = np.random.default_rng([options.seed, place, 1])
    before, after = separated(found, chosen, rng, options.repeats)
    row |= {"about": "absorbed" if said.verdict == "no_gap" else "rivals", "separates": list(chosen.said.separates)}
    row |= {"experiment": chosen.experiment.name, "change": chosen.said.change}
    row |= {"promised_nats": chosen.said.gain_nats, "before": before, "after": after}
    return row | {"raised": after >= TIMES * max(before, NOTHING)}


def in_question(case: Any, system: Any, pair: tuple[str, ...]) -> Any:
    """The two as they are fitted, both in question where their evidence differs by less than one that is out needs."""
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.attribute import Attribution
    from geocontact.gap.case.preparation import problem_of
    from geocontact.gap.levels import SLIGHT
    from geocontact.gap.selection.model_comparison import base_contender, singles
    from geocontact.gap.selection.verdict import Answer

    problem = problem_of(case, system)
    base = base_contender(problem)
    known = [one for one in candidates(problem.system) if one.name in pair and one.parameters]
    ranked = singles(problem, base, known)
    near = [c for c in ranked if c.judged.nats > ranked[0].judged.nats + np.log(SLIGHT)]
    names = tuple(dict.fromkeys(name for c in near for name in c.names))
    said = Answer("explained", names[:1], {}, names, ranked[0])
    nothing = {"odd": (), "recorder": (), "objections": {}, "flat": ()}
    return Attribution(problem, None, problem, base, tuple(ranked), remaining={}, answer=said, **nothing)


def separated(found: Any, chosen: Any, rng: np.random.Generator, repeats: int) -> tuple[float, float]:
    """Smallest mean separation over all pairs, on the old trials and on old and new ones."""
    from benchmarks.gap.simulated import trial_of
    from geocontact.gap.experiment.proposal import TRIALS

    problem, noise = found.clean, chosen.lead.noise
    old = [*problem.calibration.trials, *problem.evaluation.trials]
    stage, moved = chosen.experiment.staged, chosen.experiment.trial
    outcomes: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for true in {id(pair.true): pair.true for pair in chosen.pairs}.values():
        confounders = [pair.confounder for pair in chosen.pairs if pair.true is true]
        for _ in range(repeats):
            values = dict(true.values)
            recorded = [trial_of(problem, noise, t, true.system, values, rng) for t in old]
            fresh = [trial_of(problem, noise, moved, true.system, values, rng, stage) for _ in range(TRIALS)]
            seen = Seen.of(problem, chosen.lead, recorded, fresh, stage)
            own = seen.costs(true)
            for other in confounders:
                wrong = seen.costs(other)
                gap = (wrong[0] - own[0], wrong[1] - own[1])
                outcomes.setdefault((true.name, other.name), []).append(gap)
    means = [np.mean(each, axis=0) for each in outcomes.values()]
    return float(min(m[0] for m in means)), float(min(m[1] for m in means))


class Seen:
    """Old and new trials as the diagnosis sees them, and one weighing of each for every model."""

    def __init__(self, outputs: Sequence[str], trials: Sequence[Any], whitenings: Sequence[Any], old: int, stage: Any):
        self.trials, self.whitenings, self.old, self.stage = trials, whitenings, old, stage
        self.measured = [np.stack([t.column(name) for name in outputs], axis=1) for t in trials]

    @classmethod
    def of(cls, problem: Any, lead: Any, recorded: Sequence[Any], fresh: Sequence[Any], stage: Any) -> Seen:
        """Trials denoised; weighed at the base parameters and by the noise of the model that leads."""
        from geocontact.gap.inputs.denoise import denoised

        sd = dict(zip(problem.system.inputs, lead.noise.levels.inputs.tolist(), strict=True))
        seen = [denoised(t, sd, problem.passed) for t in (*recorded, *fresh)]
        return cls(
            problem.system.outputs, seen, whitenings(problem, lead, seen, stage, len(recorded)), len(recorded), stage
        )

    def costs(self, one: Any) -> tuple[float, float]:
        """Half the weighed squares that a model leaves where it is fitted: of the old trials, of old and new ones."""
        return self.refitted(one, self.old), self.refitted(one, len(self.trials))

    def refitted(self, one: Any, count: int) -> float:
        """Bounded least squares over the first trials."""
        from scipy.optimize import least_squares

        from geocontact.gap.case.refit import free, magnitude

        staged = self.stage(one.system)
        parameters = free(one.system)
        size = np.array([magnitude(p) for p in parameters])
        low, high = (np.array([getattr(p, side) for p in parameters]) / size for side in ("lower", "upper"))

        def residual(z: np.ndarray) -> np.ndarray:
            values = {p.name: float(v) for p, v in zip(parameters, z * size, strict=True)}
            parts = []
            for k in range(count):
                predicted = (one.system if k < self.old else staged).simulate(self.trials[k], values)
                left = np.nan_to_num(self.measured[k] - predicted)
                parts.append(self.whitenings[k](left[..., None])[:, 0])
            return np.concatenate(parts)

        start = np.array([one.values[p.name] for p in parameters]) / size
        inside = np.clip(start, low + 1e-6, high - 1e-6)
        fit = least_squares(residual, inside, bounds=(low, high), max_nfev=ROUNDS, ftol=CLOSE, diff_step=1e-5)
        return float(fit.cost)


def whitenings(problem: Any, lead: Any, trials: Sequence[Any], stage: Any, plain: int) -> list[Any]:
    """Whitening of every trial; those from `plain` on are staged."""
    from geocontact.gap.case.noise_sources import noise_spread, quotient_noise, signal_size
    from geocontact.gap.case.placement import placement
    from geocontact.gap.case.refit import Measured, derivatives
    from geocontact.gap.case.whitening import Whitening, propagated_input_noise
    from geocontact.gap.inputs.spectrum import measured_inputs
    from geocontact.identify.noise.covariance import Layout

    base = {name: lead.model.values[name] for name in problem.plain.values}
    made = []
    for k, trial in enumerate(trials):
        system = problem.system if k < plain else stage(problem.system)
        measured = Measured.of(system, [trial], problem.calibration.rough)
        heard = propagated_input_noise(system, trial, base, problem.passed, problem.left)
        shape = quotient_noise(system, problem.recorded.outputs, problem.calibration.rough)
        spread = noise_spread(system, measured.outputs, shape)[0]
        layout = Layout.of(trial.time, measured.present[0], heard, spread, signal_size(measured.outputs)[0])
        movable = measured_inputs(problem.recorded.trials, system.inputs)
        placed = placement(system, [trial], base, movable, problem.calibration.rough)[0]
        varied = np.concatenate([derivatives(system, measured, base)[0], placed], axis=-1) * lead.noise.varies
        made.append(Whitening.of(layout.whitener(lead.noise.levels), varied))
    return made


def tried(options: argparse.Namespace, work: tuple[str, str, tuple[str, ...], int]) -> None:
    """`checked` with one thread, kept."""
    from threadpoolctl import threadpool_limits

    from benchmarks.gap.rows import keep

    with threadpool_limits(limits=1):
        row = checked(*work, options)
    if row is not None:
        keep(options.out.with_suffix(".rows"), options.seed, row)


def main() -> None:
    """Ask, simulate, refit, write what there is after each case and when interrupted, print the share."""
    from benchmarks.gap.rows import begin
    from benchmarks.gap.sources import name_of
    from benchmarks.machine import machine
    from geocontact.analyses.frame.workers import each

    options = arguments()
    said = {k: v for k, v in vars(options).items() if k not in ("out", "seed")}
    said["sources"] = [name_of(one) for one in options.sources]
    begin(options.out.with_suffix(".rows"), options.seed, {"machine": machine(), "options": said})
    try:
        for _, became in each(partial(tried, options), list(asked(options)), options.jobs):
            if became is not None:
                raise became
            written(options.out)
    finally:
        print(written(options.out)["all"])


def rate_of(rows: Sequence[dict[str, Any]]) -> Any:
    """Share of proposals that raised the separation."""
    from geocontact.gap_benchmark.score import Rate

    return Rate.of(row["raised"] for row in rows if "raised" in row)


def summary(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Share of proposals that raised the separation, its interval, and how many cases were asked."""
    rate = rate_of(rows)
    return {"raised": rate.hits, "proposals": rate.count, "interval": rate.interval(), "cases": len(rows)}


def written(out: Path) -> dict[str, Any]:
    """The JSON of what is kept so far: shares pooled, by what they are about and by source, then every case."""
    from benchmarks.gap.rows import kept

    runs, found = kept(out.with_suffix(".rows"))
    sources = dict.fromkeys(source for run in runs for source in run["options"]["sources"])
    by = {kind: summary([row for row in found if row.get("about") == kind]) for kind in ("rivals", "absorbed")}
    own = {source: summary([row for row in found if row["source"] == source]) for source in sources}
    whole = {"runs": runs, "all": summary(found), "about": by, "of": own, "rows": found}
    out.write_text(json.dumps(whole, indent=1) + "\n")
    return whole


if __name__ == "__main__":
    main()
