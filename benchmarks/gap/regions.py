"""Where a model is wrong, and its parameters there and elsewhere: `python -m benchmarks.gap.regions --seeds N`.

Synthetic elastic joints, torque = k angle, whose stiffness varies by 2 % from trial to trial, with noise of both
channels, three trials to fit and three held out. Withheld is nothing, one effect or two that act in a part of the
movement: a stop beyond an angle (state), a load in a quarter of the trial (phase), friction on the way up (rate).

*Bias*: of k, relative, by least squares of everything, by the base model of the diagnosis, which allows for variation
from trial to trial, and in the clean regime. *F1*: of cells that are found against cells in most of whose samples an
effect exceeds the noise, pooled over cases, with k of everything and k of the clean regime. After the figures of Wang
2026 (arXiv 2606.23215) on test beds of his own: bias 0.43 → 0.002, F1 0.44 → 0.80. With `--laboratories SEED` the
bias also of elbows and knees as fresh laboratories record them, all parameters together (root mean square).
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from benchmarks.gap.laboratories import asked
from benchmarks.machine import write_results
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.gap_benchmark.drawing import SYSTEMS, Lot, drawn
from geocontact.identify.intervals.quantile_intervals import CONFIDENCE

STIFFNESS, VARIES, NOISE, ANGLE_NOISE = 60.0, 0.02, 0.2, 5e-4
"""k [N m/rad], its variation, noise of torque [N m] and of angle [rad]."""
STEP, SAMPLES, FITTED, TRIALS = 0.02, 500, 3, 6
Effect = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Torque [N m] of phase, angle [rad] and rate [rad/s]."""
Work = tuple[tuple[str, ...], int] | Lot
"""Effects of a joint and its seed, or a case of a laboratory."""
EFFECTS: dict[str, Effect] = {
    "stop": lambda phase, angle, rate: 60.0 * np.maximum(angle - 0.2, 0.0),
    "load": lambda phase, angle, rate: 1.0 * ((phase >= 0.5) & (phase < 0.75)),
    "friction": lambda phase, angle, rate: 0.6 * (rate > 0.0),
}
KINDS = ((), ("stop",), ("load",), ("friction",), ("stop", "load"), ("stop", "friction"), ("load", "friction"))
FITS = ("everything", "base", "clean")
PARAMETER = Parameter("k", "N m/rad", 50.0, 10.0, 200.0)


def case(kind: tuple[str, ...], seed: int) -> tuple[GapCase, dict[str, np.ndarray]]:
    """A case, and what is withheld in each of its trials [N m]."""
    rng, trials, withheld = np.random.default_rng([seed, KINDS.index(kind)]), [], {}
    for i in range(TRIALS):
        at = STEP * np.arange(SAMPLES)
        pace, turn = 2.0 * np.pi * rng.uniform(0.4, 0.7), rng.uniform(0.0, 2.0 * np.pi)
        angle = 0.25 * np.sin(pace * at + turn) + 0.06 * np.sin(2.7 * pace * at)
        rate = pace * (0.25 * np.cos(pace * at + turn) + 0.162 * np.cos(2.7 * pace * at))
        extra = sum((EFFECTS[name](at / at[-1], angle, rate) for name in kind), np.zeros(SAMPLES))
        torque = STIFFNESS * (1.0 + VARIES * rng.standard_normal()) * angle + extra
        recorded = np.column_stack([angle + rng.normal(0.0, ANGLE_NOISE, SAMPLES), torque])
        recorded[:, 1] += rng.normal(0.0, NOISE, SAMPLES)
        trials.append(Trial(f"t{i}", Signals(at, recorded, ("angle", "torque"), ("rad", "N m"))))
        withheld[f"t{i}"] = extra
    name = "geocontact.systems.elastic_joint:JOINT"
    noise = {"torque": NOISE}
    return GapCase("joint", name, tuple(trials[:FITTED]), tuple(trials[FITTED:]), (PARAMETER,), noise=noise), withheld


def of_joint(kind: tuple[str, ...], seed: int) -> dict[str, Any]:
    """Bias, and cells right, too many and missed, of one case."""
    from benchmarks.gap.clean_regime import clean_regime, on_all_trials
    from geocontact.gap.case.preparation import problem_of
    from geocontact.gap.localise.structure import Structure
    from geocontact.gap.selection.model_comparison import base_contender
    from geocontact.systems.elastic_joint import JOINT

    one, withheld = case(kind, seed)
    problem = problem_of(one, JOINT.build(one.parameters, one.constants, one.tables))
    base = base_contender(problem).judged
    clean = clean_regime(problem, base)
    everything = Structure.within(clean.grid, on_all_trials(problem, problem.plain.values))
    trials = [*problem.calibration.trials, *problem.evaluation.trials]
    acts = [np.abs(withheld[trial.name]) > NOISE for trial in trials]
    true = true_cells(clean.grid.which, acts, clean.p_values.shape[1])

    def cells(of: Structure) -> dict[str, int]:
        return compared(of.q_values[0] <= 1.0 - CONFIDENCE, true, clean.grid.tested[0])

    fits = dict(zip(FITS, (problem.plain.values["k"], base.model.values["k"], clean.model.values["k"]), strict=True))
    bias = {name: abs(k / STIFFNESS - 1.0) for name, k in fits.items()}
    return {"withheld": list(kind), "seed": seed, "bias": bias, "everything": cells(everything), "clean": cells(clean)}


def true_cells(which: tuple[np.ndarray, ...], acts: list[np.ndarray], count: int) -> np.ndarray:
    """Cells of the one channel in most of whose samples something is withheld."""
    at, there = np.concatenate([w[:, 0] for w in which]), np.concatenate(acts)
    kept = at >= 0
    counts, active = (np.bincount(at[kept], each, count) for each in (np.ones(kept.sum()), there[kept]))
    return np.asarray(active > 0.5 * np.maximum(counts, 1.0))


def compared(found: np.ndarray, true: np.ndarray, tested: np.ndarray) -> dict[str, int]:
    """Cells found that are true, found that are not, and true that are not found, among those that are tested."""
    pairs = {"right": found & true, "too_many": found & ~true, "missed": ~found & true}
    return {name: int((cells & tested).sum()) for name, cells in pairs.items()}


def f1(rows: list[Mapping[str, Any]], fit: str) -> float:
    """2 right / (2 right + too many + missed), of all cells of all cases; NaN where there is none."""
    right, many, missed = (sum(row[fit][name] for row in rows) for name in ("right", "too_many", "missed"))
    return 2.0 * right / (2.0 * right + many + missed) if right + many + missed else float("nan")


def figures(rows: list[Mapping[str, Any]]) -> dict[str, Any]:
    """By how many effects are withheld: median bias of each fit, F1, cells found in vain."""
    found = {}
    for count, name in enumerate(("none", "one", "two")):
        own = [row for row in rows if len(row["withheld"]) == count]
        if not own:
            continue
        bias = {fit: float(np.median([row["bias"][fit] for row in own])) for fit in FITS}
        scores = {fit: f1(own, fit) for fit in ("everything", "clean")} if count else {}
        vain = {fit: sum(row[fit]["too_many"] for row in own) for fit in ("everything", "clean")}
        found[name] = {"cases": len(own), "bias": bias, "f1": scores, "cells_in_vain": vain}
    return found


def of_laboratory(lot: Lot) -> dict[str, Any]:
    """Bias of a case of a laboratory, and cells found."""
    from benchmarks.gap.clean_regime import clean_regime
    from geocontact.gap.case.admission import admitted
    from geocontact.gap.case.preparation import problem_of
    from geocontact.gap.selection.model_comparison import base_contender
    from geocontact.systems.catalogue import system_of

    planted = drawn(lot)
    system = system_of(planted.case)
    problem = problem_of(admitted(planted.case, system), system)
    base = base_contender(problem).judged
    clean = clean_regime(problem, base)
    true = planted.ideal[0].nominal
    fits = zip(FITS, (problem.plain.values, base.model.values, clean.model.values), strict=True)
    bias = {
        fit: float(np.sqrt(np.mean([(values[name] / true[name] - 1.0) ** 2 for name in values if name in true])))
        for fit, values in fits
    }
    found = int((clean.q_values <= 1.0 - CONFIDENCE).sum())
    return {"system": lot.system, "kind": lot.kind, "place": lot.place, "bias": bias, "cells": found}


def cases_of_laboratories(seed: int) -> list[Lot]:
    """Elbows and knees of the run on fresh laboratories: nothing withheld, and pairs."""
    counts = {"none": 2, "single": 0, "unknown": 0, "pairs": 2}
    some = asked(argparse.Namespace(kinds="fresh", systems=list(SYSTEMS), seed=seed, **counts))
    return [lot for lot in some if lot.system in ("elbow", "knee")]


def worked(work: Work) -> dict[str, Any]:
    """One case, on one core."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1):
        return of_laboratory(work) if isinstance(work, Lot) else of_joint(*work)


def biases(rows: list[Mapping[str, Any]]) -> dict[str, Any]:
    """Median bias of each fit, by system and kind."""
    found = {}
    for system, kind in dict.fromkeys((row["system"], row["kind"]) for row in rows):
        own = [row for row in rows if (row["system"], row["kind"]) == (system, kind)]
        bias = {fit: float(np.median([row["bias"][fit] for row in own])) for fit in FITS}
        with_cells = sum(row["cells"] > 0 for row in own)
        found[f"{system} {kind}"] = {"cases": len(own), "bias": bias, "cases_with_cells": with_cells}
    return found


def main() -> None:
    """Write the figures and every case, as each is done."""
    from geocontact.analyses.frame.workers import each

    parser = argparse.ArgumentParser(prog="python -m benchmarks.gap.regions", description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=4, help="of each kind of joint")
    parser.add_argument("--laboratories", type=int, help="seed of cases of laboratories")
    parser.add_argument("--workers", type=int, default=1)
    o = parser.parse_args()
    joints: list[Work] = [(kind, seed) for seed in range(o.seeds) for kind in KINDS]
    lots: list[Work] = [] if o.laboratories is None else [*cases_of_laboratories(o.laboratories)]
    rows: list[dict[str, Any]] = []
    others: list[dict[str, Any]] = []
    for work, became in each(worked, [*joints, *lots], o.workers):
        if isinstance(became, BaseException):
            raise became
        (others if isinstance(work, Lot) else rows).append(became)
        print(became, flush=True)
        told = {**figures(rows), "laboratories": biases(others), "cases": rows, "laboratory_cases": others}
        write_results("gap_regions", {"seeds": o.seeds, "laboratories": o.laboratories}, told)


if __name__ == "__main__":
    main()
