"""Discrete mistakes in the data: looked for first, corrected, and those that refitted parameters may hide.

Undone where it was made, noise and units are right again for all that follows; errors are then reported against what
was recorded, mistake and all, so that they compare with those of the base model.

A mistake of this kind is gross: a factor of four or more, a sign, two channels exchanged. Where the base model predicts
every channel of every trial to within a share of its size there is none, and nothing is tried. Trials that may hold a
mistake are judged with a model that was fitted to the others.

Base parameters reproduce a force that reads 9.8 times too much, a model that is nearly even in an input hardly tells
its sign, and two sides that carry much the same hardly tell that they were exchanged. Such mistakes compete with the
effects, by evidence, and one that comes near is judged where it is undone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from jaxtyping import Float

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.case.plain_fit import Plain, base_starts
from geocontact.gap.case.preparation import REACHES, problem_of
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import ROUNDS, Measured, Refit, Whiten, refit
from geocontact.gap.levels import DEVIATIONS, FEW, LEFT_OVER, TURNS, WORTH_NAMING
from geocontact.gap.selection.evidence import Judged, by_smoothing
from geocontact.gap.selection.model_comparison import Contender, base_contender
from geocontact.gap.selection.tails import Tails


def corrected(case: GapCase, data_error: DataError) -> GapCase:
    """The case as it would have been recorded without the mistake."""
    return replace(
        case,
        calibration=tuple(_corrected(trial, data_error) for trial in case.calibration),
        evaluation=tuple(_corrected(trial, data_error) for trial in case.evaluation),
    )


def mistaken(trial: Trial, one: Candidate) -> Trial:
    """A trial with a mistake in its data made."""
    return _times(trial, one, one.factor)


def _corrected(trial: Trial, data_error: DataError) -> Trial:
    one = data_error.candidate
    return _times(trial, one, 1.0 / one.factor) if trial.name in data_error.trials else trial


def _times(trial: Trial, one: Candidate, factor: float) -> Trial:
    """The channel of the mistake times a factor, or its two channels exchanged."""
    channels = trial.signals.channels
    values = trial.signals.values.copy()
    if one.channel:
        values[:, channels.index(one.channel)] *= factor
    else:
        a, b = exchanged(one.variant, channels)
        values[:, [a, b]] = values[:, [b, a]]
    return replace(trial, signals=replace(trial.signals, values=values))


def exchanged(variant: str, channels: Sequence[str]) -> tuple[int, int]:
    """Places of the two channels that a swap is about."""
    return next(
        (i, j) for i, a in enumerate(channels) for j, b in enumerate(channels) if i != j and variant == f"{a}_{b}"
    )


def put_back(
    data_error: DataError | None, trial: str, outputs: Sequence[str], columns: Float[np.ndarray, "t c *p"]
) -> Float[np.ndarray, "t c *p"]:
    """Residuals, or derivatives of predictions, as they are of what was recorded."""
    if data_error is None or trial not in data_error.trials:
        return columns
    one = data_error.candidate
    if one.channel and one.channel not in outputs:
        return columns
    out = columns.copy()
    if one.channel:
        out[:, list(outputs).index(one.channel)] *= one.factor
    else:
        a, b = exchanged(one.variant, outputs)
        out[:, [a, b]] = columns[:, [b, a]]
    return out


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


MODEST = 20.0  # factor of a unit up to which a wrong one may hide in parameters


def hidden_mistakes(problem: Problem, base: Judged, candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Wrong units by a modest factor; reversed inputs and exchanged outputs in the trials where that fits better.

    Trials differ by themselves, so residuals are weighed by noise and variation of the base model. A reversal or an
    exchange is dropped where the model that fits best with it still misses something grossly.
    """
    mistakes = [one for one in candidates if one.somewhere is not None]
    found = [one for one in mistakes if one.factor != 1.0 and 1.0 / MODEST <= one.factor <= MODEST]
    reversed_ = [one for one in mistakes if one.factor < 0.0 and one.channel in problem.system.inputs]
    exchanged = [one for one in mistakes if not one.channel]
    whitenings = problem.whitenings(problem.with_lower_noise(base.noise), base.model)
    for one in (*reversed_, *exchanged):
        best = _where(problem, one, whitenings)
        found += [] if best is None else [best]
    return tuple(found)


def undone(problem: Problem, case: GapCase, one: Contender, heavy: Tails) -> Contender:
    """A mistake judged where it is undone, with the noise that the case tells, if that makes it more probable.

    Samples weigh what they do for everyone else (`heavy`).
    A wrong unit of an output is a change of variables: the densities differ by the factor, sample by sample.
    """
    mistake = one.candidates[0]
    data_error = recognised(problem, mistake, one.judged.model)
    clean = heavy.weighed(problem_of(corrected(case, data_error), problem.system))
    base = base_contender(clean).judged
    wide = np.log(abs(mistake.factor)) if mistake.channel in problem.system.outputs else 0.0
    column = problem.system.outputs.index(mistake.channel) if wide else 0
    calibration, evaluation = (
        wide
        * sum(
            int(there[:, column].sum())
            for t, there in zip(m.trials, m.present, strict=True)
            if t.name in data_error.trials
        )
        for m in (problem.calibration, problem.evaluation)
    )
    count = len(problem.calibration.trials)  # there nobody passes less on than the base; here everyone pays for it
    owed = by_smoothing(problem, one.judged.model, problem.whitenings(one.judged.noise, one.judged.model))
    there = replace(
        base,
        nats=base.nats - calibration - evaluation - float(owed.sum()),
        calibration=base.calibration - calibration - float(owed[:count].sum()),
    )
    return (
        one
        if there.nats <= one.judged.nats
        else replace(one, judged=replace(one.judged, nats=there.nats, calibration=there.calibration))
    )


def _where(problem: Problem, one: Candidate, whitenings: Sequence[Whiten]) -> Candidate | None:
    """A reversal or an exchange in all calibration trials, or in those that differ from the others; what fits best."""
    calibration = problem.calibration
    every = frozenset(t.name for t in calibration.trials)
    alone = replace(calibration, trials=calibration.trials[:1], outputs=calibration.outputs[:1])
    fitted = whitenings[: len(calibration.trials)]
    if gross(problem, alone, _fitted(problem, one, every, alone, fitted[:1])):
        return None
    start = _fitted(problem, one, frozenset(), alone, fitted[:1]).values
    turned = _turned(problem, one, calibration, fitted, start)
    patterns = [every]
    for some in (turned, every - turned):
        for _ in range(TURNS):
            model = _fitted(problem, one, some, calibration, fitted)
            again = _turned(problem, one, calibration, fitted, model.values)
            if again == some:
                break
            some = again
        if some and some not in patterns:
            patterns.append(some)
    best, least = None, np.inf
    for some in patterns:
        model = _fitted(problem, one, some, calibration, fitted)
        held_out = _turned(problem, one, problem.evaluation, whitenings[len(fitted) :], model.values)
        count = len(every) + len(problem.evaluation.trials)
        candidate = one if len(some | held_out) == count else one.only(some | held_out)
        ways = 1 if candidate is one else 2**count - 1
        price = model.cost + np.log(ways)
        if price < least and not gross(problem, calibration, model):
            best, least = replace(candidate, starts=(model.values,), ways=ways), price
    return best


def _fitted(
    problem: Problem, one: Candidate, some: frozenset[str], measured: Measured, whitenings: Sequence[Whiten]
) -> Refit:
    """The base model with the mistake in some trials."""
    system = one.only(some).apply(problem.system)
    return refit(system, measured, whitenings, [*base_starts(problem.system)[:2], problem.plain.values], ROUNDS // 2)


def _turned(
    problem: Problem, one: Candidate, measured: Measured, whitenings: Sequence[Whiten], values: dict[str, float]
) -> frozenset[str]:
    """Trials that a model at these values predicts better with the mistake."""
    every = frozenset(t.name for t in measured.trials)
    mistaken = one.only(every).apply(problem.system)
    pairs = zip(measured.residuals(problem.system, values), measured.residuals(mistaken, values), strict=True)
    return frozenset(
        t.name
        for t, whiten, (a, b) in zip(measured.trials, whitenings, pairs, strict=True)
        if np.sum(whiten(b[..., None]) ** 2) < np.sum(whiten(a[..., None]) ** 2)
    )
