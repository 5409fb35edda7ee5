"""Do proposed experiments tell apart what they promise? `python -m benchmarks.gap_next_experiment [--cases N]`.

Synthetic cases (`gap.benchmark`: effects that are hardly visible, effects that base parameters swallow, nothing) are
attributed and asked for the next experiment. Then every answer in question is simulated on trials like those of the
case and on the trials proposed, with noise, deviations of the trials and noise of the inputs, and refitted by itself
and by every other: what the wrong one leaves more than the right one, in nats, on the old trials and on old and new
ones together. The smallest of these is what the experiment must raise, `TIMES` times or more, a separation of less than
`NOTHING` nats counting as that much.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
TIMES = 3.0
NOTHING = 5.0 / 3.0  # nats: so that at least 5 must be reached
KINDS = ("single", "absorbed", "none")
FAINT = (15.0, 60.0)  # visible nats of effects that are hardly told apart


def arguments() -> argparse.Namespace:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.gap_next_experiment", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--systems", nargs="+", default=["elbow", "foot"])
    parser.add_argument("--cases", type=int, default=4, help="of each kind and system")
    parser.add_argument("--repeats", type=int, default=3, help="simulations of each answer of a case")
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--out", type=Path, default=HERE / "results", help="folder for the JSON")
    return parser.parse_args()


def checked(system_name: str, kind: str, place: int, options: argparse.Namespace) -> dict[str, Any] | None:
    """One case; None where nothing is proposed."""
    from geocontact.effects.catalogue import candidates
    from geocontact.gap.absorbed import absorbed
    from geocontact.gap.admission import admitted
    from geocontact.gap.attribute import attribute
    from geocontact.gap.benchmark.planted.cases import plant
    from geocontact.gap.diagnose import first_of
    from geocontact.gap.next_experiment import proposed
    from geocontact.systems.catalogue import system_of

    nats = float(np.exp(np.random.default_rng([options.seed, place]).uniform(*np.log(FAINT))))
    seed = np.random.SeedSequence(options.seed, spawn_key=(KINDS.index(kind), place))
    case = plant(system_name, kind, seed, nats=nats if kind == "single" else None).case
    system = system_of(case)
    found = attribute(admitted(case, system), system, candidates)
    problem = found.clean
    hidden = [each.name for each in absorbed(problem, candidates(problem.system), found.answer.effects)]
    chosen = proposed(found, first_of(candidates(problem.system), hidden))
    if chosen is None:
        return None
    rng = np.random.default_rng([options.seed, place, 1])
    before, after = separated(found, chosen, rng, options.repeats)
    row = {"system": system_name, "kind": kind, "case": place, "separates": list(chosen.said.separates)}
    row |= {"change": chosen.said.change, "promised_nats": chosen.said.gain_nats, "before": before, "after": after}
    return row | {"raised": after >= TIMES * max(before, NOTHING)}


def separated(found: Any, chosen: Any, rng: np.random.Generator, repeats: int) -> tuple[float, float]:
    """Smallest mean separation over all pairs, on the old trials and on old and new ones."""
    from benchmarks.gap_simulated import trial_of
    from geocontact.gap.next_experiment import TRIALS

    problem, noise = found.clean, chosen.lead.noise
    old = [*problem.calibration.trials, *problem.evaluation.trials]
    outcomes: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for true in {id(pair.true): pair.true for pair in chosen.pairs}.values():
        imitators = [pair.imitator for pair in chosen.pairs if pair.true is true]
        for _ in range(repeats):
            values = dict(true.values)
            recorded = [trial_of(problem, noise, t, true.system, values, rng) for t in old]
            stage = chosen.experiment.staged
            moved = chosen.experiment.trial
            fresh = [trial_of(problem, noise, moved, true.system, values, rng, stage) for _ in range(TRIALS)]
            own = costs(problem, noise, true, recorded, fresh, stage)
            for other in imitators:
                wrong = costs(problem, noise, other, recorded, fresh, stage)
                gap = (wrong[0] - own[0], wrong[1] - own[1])
                outcomes.setdefault((true.name, other.name), []).append(gap)
    means = [np.mean(each, axis=0) for each in outcomes.values()]
    return float(min(m[0] for m in means)), float(min(m[1] for m in means))


def costs(
    problem: Any, noise: Any, one: Any, recorded: Sequence[Any], fresh: Sequence[Any], stage: Any
) -> tuple[float, float]:
    """Half the weighed squares that a model leaves where it is fitted: of the old trials, and of old and new ones."""
    return tuple(
        refitted(problem, noise, one, trials, stage, len(recorded)) for trials in (recorded, [*recorded, *fresh])
    )


def refitted(problem: Any, noise: Any, one: Any, trials: Sequence[Any], stage: Any, plain: int) -> float:
    """Bounded least squares over all trials; those from `plain` on are staged."""
    from scipy.optimize import least_squares

    from geocontact.gap.inputs import denoised
    from geocontact.gap.refit import free, magnitude

    sd = dict(zip(problem.system.inputs, noise.levels.inputs.tolist(), strict=True))
    seen = [denoised(t, sd, problem.passed) for t in trials]
    models = [one.system if k < plain else stage(one.system) for k in range(len(trials))]
    weigh = weighings(problem, noise, one, seen, stage, plain)
    measured = [np.stack([t.column(name) for name in problem.system.outputs], axis=1) for t in seen]
    parameters = free(one.system)
    size = np.array([magnitude(p) for p in parameters])
    low, high = (np.array([getattr(p, side) for p in parameters]) / size for side in ("lower", "upper"))

    def residual(z: np.ndarray) -> np.ndarray:
        values = {p.name: float(v) for p, v in zip(parameters, z * size, strict=True)}
        parts = [np.nan_to_num(m - s.simulate(t, values)) for m, s, t in zip(measured, models, seen, strict=True)]
        return np.concatenate([w(r[..., None])[:, 0] for w, r in zip(weigh, parts, strict=True)])

    start = np.array([one.values[p.name] for p in parameters]) / size
    inside = np.clip(start, low + 1e-6, high - 1e-6)
    return float(least_squares(residual, inside, bounds=(low, high), max_nfev=12, diff_step=1e-5).cost)


def weighings(problem: Any, noise: Any, one: Any, trials: Sequence[Any], stage: Any, plain: int) -> list[Any]:
    """Whitening of every trial, at the base parameters of the case's answer."""
    from geocontact.chain.movement import rate_of_waves
    from geocontact.gap.refit import Measured, derivatives
    from geocontact.gap.weighing import Weighing, sensitivity
    from geocontact.identify.covariance import Layout
    from geocontact.identify.noise_spectrum import NoiseSpectrum

    passed, base = problem.passed, {name: one.values[name] for name in problem.plain.values}
    spectrum = NoiseSpectrum.after(passed, lambda f: rate_of_waves(f, passed.step, problem.system.motion.reach))
    made = []
    for k, trial in enumerate(trials):
        system = problem.system if k < plain else stage(problem.system)
        measured = Measured.of(replace(system), [trial], problem.calibration.rough)
        layout = Layout.of(trial.time, measured.present[0], sensitivity(system, trial, base), spectrum)
        varied = derivatives(system, measured, base)[0] * noise.varies
        made.append(Weighing.of(layout.whitener(noise.levels), varied))
    return made


def main() -> None:
    """Ask, simulate, refit, write what there is after each round of cases, print the share."""
    options = arguments()
    from threadpoolctl import threadpool_limits

    found: list[dict[str, Any]] = []
    asked = 0
    with threadpool_limits(limits=1):
        for place in range(options.cases):
            for system in options.systems:
                for kind in KINDS:
                    row = checked(system, kind, place, options)
                    asked += 1
                    if row is not None:
                        found.append(row)
                        print(json.dumps(row), file=sys.stderr, flush=True)
            written(options, found, asked)


def written(options: argparse.Namespace, found: Sequence[dict[str, Any]], asked: int) -> None:
    """The JSON, and a line."""
    from benchmarks.machine import machine
    from geocontact.gap.benchmark.rates import Rate

    rate = Rate.of(row["raised"] for row in found)
    print(
        f"raised at least {TIMES:g} times: {rate}; nothing proposed in {asked - len(found)} of {asked} cases",
        flush=True,
    )
    about = {"machine": machine(), "options": {k: str(v) for k, v in vars(options).items() if k != "out"}}
    summary = {"raised": rate.value, "interval": rate.interval(), "proposals": rate.count, "cases": asked}
    options.out.mkdir(parents=True, exist_ok=True)
    text = json.dumps({**about, **summary, "rows": list(found)}, indent=1)
    (options.out / "gap_next_experiment.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
