"""Discrete mistakes in the data, looked for first: in all trials or in some, each tried without a parameter of its own.

A mistake of this kind is gross: a factor of four or more, a sign, two channels exchanged. Where the base model predicts
every channel of every trial to within a share of its size there is none, and nothing is tried. Trials that may hold a
mistake are judged with a model that was fitted to the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from geocontact.chain.candidate import Candidate
from geocontact.chain.system import System
from geocontact.gap.case.plain_fit import Plain, base_starts
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.rate_smoothing import REACHES
from geocontact.gap.case.refit import ROUNDS, Measured, Refit, refit
from geocontact.gap.levels import DEVIATIONS, FEW, LEFT_OVER, WORTH_NAMING


@dataclass(frozen=True)
class DataError:
    """A mistake, the trials that have it, and what of the misfit is left when it is undone."""

    candidate: Candidate
    trials: tuple[str, ...]
    left: float


def data_error_of(problem: Problem, candidates: Sequence[Candidate]) -> DataError | None:
    """The mistake that explains a gross misfit, if one does.

    Looked for in the trials as they were recorded: what was taken for noise of an input may be the input, in another
    unit.
    """
    problem = _as_recorded(problem)
    mistakes = [one for one in candidates if one.somewhere is not None]
    in_calibration = gross(problem, problem.calibration, problem.plain)
    if not mistakes:
        return None
    if not in_calibration:
        return _held_out_only(problem, mistakes)
    best: tuple[float, Candidate, frozenset[str]] | None = None
    for some in _subsets(problem):
        for one, cost in _costs(problem, mistakes, some):
            if best is None or cost < best[0]:
                best = (cost, one, some)
    if best is None:
        return None
    cost, one, some = best
    before = _cost(problem, problem.system, problem.calibration, problem.plain.values).sum()
    if cost > LEFT_OVER * before:
        return None
    return _over_all_trials(problem, one, some, float(cost / before))


def recognised(problem: Problem, one: Candidate, model: Refit) -> DataError:
    """A mistake that won by evidence against the effects; `model` is the base fitted with it."""
    names = [t.name for t in (*problem.calibration.trials, *problem.evaluation.trials)]
    before = _cost(problem, problem.system, problem.calibration, problem.plain.values).sum()
    after = _cost(problem, model.system, problem.calibration, model.values).sum()
    return DataError(one, tuple(sorted(one.within or names)), float(after / before))


def gross(problem: Problem, measured: Measured, model: Refit) -> bool:
    """Whether a model misses some channel of some trial by a large share of its size."""
    for residual, outputs in zip(measured.residuals(model.system, model.values), measured.outputs, strict=True):
        size = np.maximum(np.nanmean(outputs**2, axis=0), (DEVIATIONS * problem.floor_of_noise) ** 2)
        if (np.mean(residual**2, axis=0) > WORTH_NAMING * size).any():
            return True
    return False


def _as_recorded(problem: Problem) -> Problem:
    """Inputs with all their noise, rates smoothed well."""
    count, recorded = len(problem.calibration.trials), problem.recorded

    def part(some: slice) -> Measured:
        return replace(recorded, trials=recorded.trials[some], outputs=recorded.outputs[some])

    system = problem.system.reaching(REACHES[0] * problem.system.scale.step)
    return replace(problem, system=system, calibration=part(slice(count)), evaluation=part(slice(count, None)))


def _subsets(problem: Problem) -> list[frozenset[str]]:
    """Trials that may have a mistake, the largest sets first: every set of a few; of more all, the worst, the best.

    Where the mistake is in the minority the base model misses those trials most, else the others.
    """
    names = [trial.name for trial in problem.calibration.trials]
    if len(names) <= FEW:
        return [frozenset(some) for size in range(len(names), 0, -1) for some in combinations(names, size)]
    costs = _cost(problem, problem.system, problem.calibration, problem.plain.values)
    worst = [names[i] for i in np.argsort(-costs, kind="stable")]
    found = [frozenset(order[:size]) for size in range(len(names), 0, -1) for order in (worst, worst[::-1])]
    return list(dict.fromkeys(found))


def _part(measured: Measured, names: frozenset[str]) -> Measured:
    pairs = [(t, o) for t, o in zip(measured.trials, measured.outputs, strict=True) if t.name in names]
    return replace(measured, trials=tuple(t for t, _ in pairs), outputs=tuple(o for _, o in pairs))


def _cost(problem: Problem, system: System, measured: Measured, values: dict[str, float]) -> np.ndarray:
    """Half the squared residual of each trial in noise levels; large numbers stay finite."""
    scale = problem.floor_of_noise
    residuals = measured.residuals(system, values)
    return np.array([0.5 * float(np.minimum((r / scale) ** 2, 1e12).sum()) for r in residuals])


def _costs(problem: Problem, mistakes: list[Candidate], some: frozenset[str]) -> list[tuple[Candidate, float]]:
    measured = problem.calibration
    others = _part(measured, frozenset(t.name for t in measured.trials) - some)
    scale = problem.floor_of_noise
    if not others.trials:
        whiten = [Plain(there, scale) for there in measured.present]
        starts = base_starts(problem.system)[:2]
        found = []
        for one in mistakes:
            model = refit(one.apply(problem.system), measured, whiten, starts, ROUNDS // 2)
            found.append((one, model.cost))
        return found
    whiten = [Plain(there, scale) for there in others.present]
    values = refit(problem.system, others, whiten, [{}, problem.plain.values], ROUNDS // 2).values
    known = float(_cost(problem, problem.system, others, values).sum())
    suspects = _part(measured, some)
    return [
        (one, known + float(_cost(problem, one.only(some).apply(problem.system), suspects, values).sum()))
        for one in mistakes
    ]


def _over_all_trials(problem: Problem, one: Candidate, some: frozenset[str], left: float) -> DataError:
    """The same mistake in the held-out trials that are predicted better with it."""
    names = {t.name for t in problem.calibration.trials}
    candidate = one if some == names else one.only(some)
    system = candidate.apply(problem.system)
    whiten = [Plain(there, problem.floor_of_noise) for there in problem.calibration.present]
    values = refit(system, problem.calibration, whiten, [*base_starts(system)[:2], problem.plain.values], ROUNDS).values
    also = frozenset(_better_with(problem, one, problem.system, values))
    everywhere = some | also
    held_out = {t.name for t in problem.evaluation.trials}
    if everywhere == names | held_out:
        return DataError(one, tuple(sorted(everywhere)), left)
    return DataError(one.only(everywhere), tuple(sorted(everywhere)), left)


def _better_with(problem: Problem, one: Candidate, system: System, values: dict[str, float]) -> list[str]:
    names = frozenset(t.name for t in problem.evaluation.trials)
    without = _cost(problem, system, problem.evaluation, values)
    having = _cost(problem, one.only(names).apply(system), problem.evaluation, values)
    trials = problem.evaluation.trials
    return [t.name for t, a, b in zip(trials, without, having, strict=True) if b < LEFT_OVER * a]


def _held_out_only(problem: Problem, mistakes: list[Candidate]) -> DataError | None:
    if not gross(problem, problem.evaluation, problem.plain):
        return None
    values = problem.plain.values
    before = _cost(problem, problem.system, problem.evaluation, values).sum()
    best: DataError | None = None
    for one in mistakes:
        names = frozenset(_better_with(problem, one, problem.system, values))
        if not names:
            continue
        candidate = one.only(names)
        after = _cost(problem, candidate.apply(problem.system), problem.evaluation, values).sum()
        if best is None or after / before < best.left:
            best = DataError(candidate, tuple(sorted(names)), float(after / before))
    return best
