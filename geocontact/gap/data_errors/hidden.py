"""Mistakes in the data that refitted parameters may hide, so that nothing about them is gross.

Base parameters reproduce a force that reads 9.8 times too much, a model that is nearly even in an input hardly tells
its sign, and two sides that carry much the same hardly tell that they were exchanged. Such mistakes compete with the
effects, by evidence, and one that comes near is judged where it is undone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from geocontact.chain.candidate import Candidate
from geocontact.data.gap.case import GapCase
from geocontact.gap.case.plain_fit import base_starts
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import ROUNDS, Measured, Refit, Whiten, refit
from geocontact.gap.data_errors.correction import corrected
from geocontact.gap.data_errors.gross import gross, recognised
from geocontact.gap.levels import TURNS
from geocontact.gap.selection.evidence import Judged, by_smoothing
from geocontact.gap.selection.model_comparison import Contender, base_contender
from geocontact.gap.selection.tails import Tails

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
