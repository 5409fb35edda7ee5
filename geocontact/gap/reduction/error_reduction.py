"""How far the gap shrinks on trials that were not used once the effect is in the model.

What is asked for is the reduction on fresh trials of the same kind, of which the held-out ones are a few, against the
model with the effect at its true values. Where these lie is best estimated from all trials together. The error that
stays, a², is what that best fit leaves of each trial and what it bent towards it, with what the fitted noise levels
imply counted as part of a trial more. The error that goes, g², is how far the base model, fitted to few trials, is from
the truth on the held-out ones: from the best fit, and what that errs by itself; and what noise of the inputs makes of
the one error beyond the other, which may be less than nothing. Then

    reduction = 1 - rmse_after / rmse_before = 1 - (1 + g²/a²)^(-1/2).

The interval comes from the spread of log g² and of log a² over all trials, each fitted one predicted by a fit to the
others: parameters and the form of the effect, which is never exactly that of the candidate (from the fit), trials that
differ in motion and in their deviations. What the held-out trials show, and what all do when each is left out once, is
always inside: where what is named is not all that is missing, the best fit is not the truth, and the curves are right.

Leaving a trial out needs no fit of its own: with each trial's whitened residual r_i and derivatives D_i at the common
fit, A_i = D_iᵀ D_i and g_i = D_iᵀ r_i, one Gauss-Newton step without trial i is

    δ₋ᵢ = (A - A_i + S⁻²)⁻¹ (g - g_i),   C₋ᵢ = (A - A_i + S⁻²)⁻¹,

S the prior spread of the parameters, and the trial's predictive density N(r_i - D_i δ₋ᵢ; 0, I + D_i C₋ᵢ D_iᵀ).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit

from geocontact.data.diagnosis_evidence import HeldOut
from geocontact.gap.case.problem import Problem
from geocontact.gap.data_errors import DataError
from geocontact.gap.reduction.raw_input_errors import RawInputErrors, misjudged, passed_on, raw_input_errors
from geocontact.gap.selection.evidence import Judged, prior_spread
from geocontact.identify.intervals.quantile_intervals import ENDS


def held_out(problem: Problem, errors: RawInputErrors, named: bool) -> tuple[HeldOut, ...]:
    """Every held-out trial of the case as it came, by name; without predictions of the answer where nothing is named.

    Parameters
    ----------
    errors
        Of base model and answer (`raw_input_errors.raw_input_errors`).
    """
    trials = []
    for k in range(len(problem.calibration.trials), len(problem.recorded.trials)):
        trial, measured = problem.recorded.trials[k], problem.recorded.outputs[k]
        there = np.isfinite(measured)
        base, after = (np.where(there, measured - part[k], np.nan) for part in (errors.before, errors.after))
        trials.append(HeldOut(trial.name, trial.time, measured, base, after if named else None))
    return tuple(sorted(trials, key=lambda trial: trial.name))


FORM = 0.04  # relative standard deviation of g² for the form of the effect
LONE = 0.3  # the same between trials, where neither side has two
HEARD, UNHEARD = (
    2.0,
    0.05,
)  # of g²/a², that it may lie below 0: times what noise of the inputs was seen to make, and more
LEAST = -0.75  # that it is at the least
WIDE = 1.0  # half-width of the interval of log(g²/a²) up to which it is taken of the logarithm
TELLING = 2.0  # times the squared floor that the squared error before must be, for a share to mean something


@dataclass(frozen=True)
class ErrorReduction:
    """One channel's gap.

    Parameters
    ----------
    rmse_before, rmse_after
        On the held-out trials as they were measured, without and with the effect [the channel's unit].
    floor
        Noise, noise of inputs and trial-to-trial variation, root mean square on the held-out trials; what was fitted of
        them counts no more than the error that is there.
    reduction, low, high
        Of fresh trials of the same kind, and its 95 % interval.
    unexplained
        (mse_after - floor²)/(mse_before - floor²); None where there is too little gap for it.
    """

    rmse_before: float
    rmse_after: float
    floor: float
    reduction: float
    low: float
    high: float
    unexplained: float | None


def error_reduction(
    problem: Problem, clean: Problem, after: Judged, named: bool, data_error: DataError | None = None
) -> dict[str, ErrorReduction]:
    """Reduction of the error of every channel.

    Parameters
    ----------
    problem, clean
        The case as it came, and with a mistake in its data undone; the same where there is none.
    after
        The model with what was named, fitted to the clean case, or the base where nothing was.
    named
        Whether anything was.
    data_error
        The mistake. Calibration trials that have it while others have not tell nothing of what stays on others.
    """
    return error_reduction_of(raw_input_errors(problem, clean, after, data_error), problem, after, named, data_error)


def error_reduction_of(
    errors: RawInputErrors, problem: Problem, after: Judged, named: bool, data_error: DataError | None
) -> dict[str, ErrorReduction]:
    """Reduction of the error of every channel, from its errors; see `error_reduction`."""
    count, present = len(problem.calibration.trials), problem.recorded.present
    student = float(stdtrit(max(errors.told_by - 2, 1), ENDS[1]))  # a spread about two means of as few trials
    heard = np.zeros(len(problem.system.outputs))
    if named and data_error is None:  # beside a mistake in the data noise of the inputs is nothing
        base = (problem.system.as_measured(), errors.values, errors.before[count:])
        own = (after.model.system.as_measured(), errors.fitted, errors.after[count:])
        heard = passed_on(problem, after, [base, own])
    found = {}
    for c, name in enumerate(problem.system.outputs):
        error = _mean_square(errors.before[count:], present[count:], c)
        stays = _mean_square(errors.after[count:], present[count:], c)
        floor = min(float(np.mean([f[c] for f in errors.implied[count:]])), error, stays)
        if not named:
            found[name] = ErrorReduction(error**0.5, error**0.5, floor**0.5, 0.0, 0.0, 0.0, None)
            continue
        (gone, gone_sd), (left, left_sd) = _gone(problem, errors, c), errors.left[c]
        gone += float(heard[c])
        least = max(-(HEARD * abs(float(heard[c])) / left + UNHEARD), LEAST)
        low, middle, high = (
            1.0 - (1.0 + max(each, least)) ** -0.5
            for each in between(gone / left, student * gone_sd / left, student * left_sd / left)
        )
        share = None
        if error >= TELLING * floor:
            share = min(max(left - floor, 0.0) / (left + gone - floor), 1.0) if left + gone > floor else 0.0
        seen = 1.0 - (stays / error) ** 0.5 if error > 0.0 else 0.0
        whole = _mean_square(errors.unseen, present, c), _mean_square(errors.unseen_after, present, c)
        by_all = 1.0 - (whole[1] / whole[0]) ** 0.5 if whole[0] > 0.0 and data_error is None else seen
        low, high = min(float(low), seen, by_all), max(float(high), seen, by_all)
        found[name] = ErrorReduction(error**0.5, stays**0.5, floor**0.5, float(middle), low, high, share)
    return found


def between(ratio: float, spread: float, divisor: float = 0.0) -> tuple[float, float, float]:
    """An interval of g²/a²: of its logarithm, `spread`/`ratio` to either side, as long as that is `WIDE` at the most.

    What is spread wider than that may be less than nothing; its two sides go on growing in proportion, without a jump.
    `divisor` is the half-width of the interval of log a², which is never less than nothing: it adds in squares.
    """
    relative = spread / ratio if ratio > 0.0 else np.inf
    down, up = (1.0 - np.exp(-WIDE)) / WIDE, (np.exp(WIDE) - 1.0) / WIDE
    if relative <= WIDE:
        low, high = ratio * float(np.exp(-relative)), ratio * float(np.exp(relative))
    else:
        low, high = ratio - down * spread, ratio + up * spread
    own = min(relative, WIDE)
    more = float(np.exp(np.hypot(own, divisor) - own))
    return (low / more if low > 0.0 else low * more), ratio, high * more


def _mean_square(residuals: list[np.ndarray], present: tuple[np.ndarray, ...], c: int) -> float:
    values = np.concatenate([r[p[:, c], c] for r, p in zip(residuals, present, strict=True)])
    return float(np.mean(values**2)) if len(values) else 0.0


def _gone(problem: Problem, errors: RawInputErrors, c: int) -> tuple[float, float]:
    """Mean square that the base model's error has beyond what stays, and its standard deviation.

    The base model, fitted to few trials, misses the truth by d + e, d the difference to the best fit with the effect, e
    that fit's own error; an efficient fit errs independently of what others differ from it by, so the squares add.
    """
    squares, slopes, alike = [], [], []
    count, seen = len(problem.calibration.trials), []
    for i in range(len(errors.before)):
        there = problem.recorded.present[i][:, c]
        own = errors.derivatives[i][there, c]
        if not len(own):
            continue
        off = (errors.unseen[i] - errors.best[i])[there, c]
        seen.append((i >= count, float(np.mean(off**2))))
        if i < count:
            continue
        squares.append(float(np.mean(off**2)))
        slopes.append(2.0 * off @ own / len(off))
        alike.append(misjudged(own, errors.known))
    if not squares:
        return 0.0, 0.0
    slope, more = np.mean(slopes, axis=0), float(np.mean(alike))
    gone = float(np.mean(squares)) + more
    scatter = gone**2 * relative_scatter(seen) / len(squares)
    return gone, float(np.sqrt(slope @ errors.known @ slope + scatter + (FORM * gone) ** 2 + more**2))


def relative_scatter(seen: Sequence[tuple[bool, float]]) -> float:
    """Variance of numbers over the square of their mean, of those that are held out and of the others, pooled.

    The two sides may move differently, so each has a mean of its own; `LONE` squared where neither has two numbers.
    """
    total, freedom = 0.0, 0
    for side in (False, True):
        own = np.array([value for held, value in seen if held == side])
        if len(own) > 1 and own.mean() > 0.0:
            total += float(((own / own.mean() - 1.0) ** 2).sum())
            freedom += len(own) - 1
    return total / freedom if freedom else LONE**2


@dataclass(frozen=True)
class TrialGain:
    """How much better a trial is predicted from all others with what was named [nats], and whether it was held out."""

    trial: str
    held_out: bool
    nats: float


def leave_one_out(problem: Problem, base: Judged, named: Judged) -> tuple[TrialGain, ...]:
    """Gain of every trial, calibration trials first; both models under the noise of the one that was named.

    Levels of noise stay as they were estimated, from the calibration trials together.
    """
    without, with_it = predictive(problem, base, named), predictive(problem, named, named)
    count = len(problem.calibration.trials)
    return tuple(
        TrialGain(trial.name, i >= count, float(b - a))
        for i, (trial, a, b) in enumerate(zip(problem.recorded.trials, without, with_it, strict=True))
    )


def predictive(problem: Problem, one: Judged, under: Judged) -> Float[np.ndarray, " i"]:
    """Logarithm of each trial's predictive density given all others, without the constant [nats]."""
    whitenings = problem.whitenings(under.noise, one.model)
    spread = prior_spread(one.model.system, one.model.values)
    whitened = [
        whiten(np.concatenate([residual[..., None], jacobian * spread], axis=-1))
        for whiten, residual, jacobian in zip(whitenings, one.model.residuals, one.model.jacobian, strict=True)
    ]
    densities = left_out([each[:, 0] for each in whitened], [each[:, 1:] for each in whitened])
    return np.asarray(densities - [whiten.log_scale for whiten in whitenings])


def left_out(
    residuals: list[Float[np.ndarray, " _"]], designs: list[Float[np.ndarray, "_ p"]]
) -> Float[np.ndarray, " i"]:
    """Logarithm of N(r_i; D_i m, I + D_i C D_iᵀ), without the constant.

    m and C are the mean and covariance of the parameters given all other trials, under a unit prior.
    """
    grams = [design.T @ design for design in designs]
    pulls = [design.T @ residual for residual, design in zip(residuals, designs, strict=True)]
    scores = []
    for residual, design, gram, pull in zip(residuals, designs, grams, pulls, strict=True):
        others = np.eye(len(gram)) + sum(grams) - gram
        left = residual - design @ np.linalg.solve(others, sum(pulls) - pull)
        inner = others + gram  # I + D C Dᵀ by the matrix determinant lemma and Woodbury's identity
        part = design.T @ left
        quadratic = float(left @ left) - float(part @ np.linalg.solve(inner, part))
        half = 0.5 * float(np.linalg.slogdet(inner)[1] - np.linalg.slogdet(others)[1])
        scores.append(-0.5 * quadratic - half)
    return np.array(scores)
