"""How far the gap shrinks on trials that were not used once the effect is in the model.

What is asked for is the reduction on fresh trials of the same kind, of which the held-out ones are a few, against the
model with the effect at its true values. Where these lie is best told by all trials together. The error that stays, a²,
is what that best fit leaves of each trial and what it bent towards it, with what the fitted noise levels imply counted
as part of a trial more. The error that goes, g², is how far the base model, fitted to few trials, is from the truth on
the held-out ones: from the best fit, and what that errs by itself. Then

    reduction = 1 - rmse_after / rmse_before = 1 - (1 + g²/a²)^(-1/2).

Both models are given the inputs as they were measured, with central differences for rates, since that is what a
simulator in somebody's hands does; smoothing them first leaves less of an error than is reported here. The interval
comes from the spread of log(g²/a²): parameters (from the fit), trials that differ in motion and in their deviations,
and the form of the effect, which is never exactly that of the candidate.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.gap.evidence import Judged, prior_spread
from geocontact.gap.faults import Fault
from geocontact.gap.mending import put_back
from geocontact.gap.problem import Plain, Problem, noise_variance
from geocontact.gap.refit import refit

IMPLIED = 0.3  # trials that the fitted noise levels count as
FORM = 0.04  # relative standard deviation of g² for the form of the effect
WIDE = 1.0  # half-width of the interval of log(g²/a²) beyond which it is taken of g²/a² itself
TELLING = 2.0  # times the squared floor that the squared error before must be, for a share to mean something


@dataclass(frozen=True)
class Shrinkage:
    """One channel's gap.

    Parameters
    ----------
    rmse_before, rmse_after
        On the held-out trials as they were measured, without and with the effect [the channel's unit].
    floor
        Noise, noise of inputs and trial-to-trial variation, root mean square on the held-out trials.
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


def shrinkage(
    problem: Problem, clean: Problem, after: Judged, named: bool, fault: Fault | None = None
) -> dict[str, Shrinkage]:
    """Of every channel.

    Parameters
    ----------
    problem, clean
        The case as it came, and with a mistake in its data undone; the same where there is none.
    after
        The model with what was named, fitted to the clean case, or the base where nothing was.
    named
        Whether anything was.
    fault
        The mistake. Calibration trials that have it while others have not tell nothing of what stays on others.
    """
    from scipy.stats import t

    outputs = problem.system.outputs
    names = [trial.name for trial in problem.recorded.trials]
    jacobian = [put_back(fault, n, outputs, j) for n, j in zip(names, after.model.jacobian, strict=True)]
    sound = [fault is None or trial.name not in fault.trials for trial in problem.calibration.trials]
    used = [*(sound if any(sound) else [True] * len(sound)), *(True for _ in problem.evaluation.trials)]
    count = len(problem.calibration.trials)
    residuals = as_measured(problem, clean, after, fault)
    varies = seen(clean, after)
    shift, known = from_all_trials(clean, after, varies)
    best = [r - j @ shift for r, j in zip(residuals.after, jacobian, strict=True)]
    present = problem.recorded.present
    floors = _floors(clean, after, varies, fault)
    student = float(t.ppf(0.975, max(sum(used) - 1, 1)))  # a spread that is known from as few trials
    found = {}
    for c, name in enumerate(problem.system.outputs):
        error = _mean_square(residuals.before[count:], present[count:], c)
        stays = _mean_square(residuals.after[count:], present[count:], c)
        floor = float(np.mean([f[c] for f in floors[count:]]))
        if not named:
            found[name] = Shrinkage(error**0.5, error**0.5, floor**0.5, 0.0, 0.0, 0.0, None)
            continue
        gone, gone_sd = _gone(problem, jacobian, known, residuals.before, best, c)
        left, left_sd = _left(problem, jacobian, known, used, best, floors, c)
        ratio = gone / left
        spread = student * float(np.hypot(gone_sd / max(gone, 1e-300), left_sd / left))
        ratios = (ratio * np.exp(-spread), ratio, ratio * np.exp(spread))
        if spread > WIDE:  # little goes, so little that it might be nothing: its own error, not that of its logarithm
            ratios = (ratio * max(1.0 - spread, 0.0), ratio, ratio * np.exp(spread))
        low, middle, high = (1.0 - (1.0 + each) ** -0.5 for each in ratios)
        share = None
        if error >= TELLING * floor:
            share = float(max(left - floor, 0.0) / (left + gone - floor)) if left + gone > floor else 0.0
        found[name] = Shrinkage(error**0.5, stays**0.5, floor**0.5, float(middle), float(low), float(high), share)
    return found


@dataclass(frozen=True)
class Residuals:
    """Of all trials, inputs as they were measured and their rates by central differences."""

    before: list[Float[np.ndarray, "_ c"]]
    after: list[Float[np.ndarray, "_ c"]]


def as_measured(problem: Problem, clean: Problem, after: Judged, fault: Fault | None) -> Residuals:
    """Base model refitted by plain least squares, and the model with the effect at its values."""
    base = problem.system.as_measured()
    count = len(problem.calibration.trials)
    whole = problem.recorded
    first = replace(whole, trials=whole.trials[:count], outputs=whole.outputs[:count])
    weigh = [Plain(there, problem.floor) for there in first.present]
    values = refit(base, first, weigh, [problem.plain.values], 20).values
    later = clean.recorded.residuals(after.model.system.as_measured(), after.model.values)
    names, outputs = [trial.name for trial in whole.trials], problem.system.outputs
    return Residuals(
        whole.residuals(base, values),
        [put_back(fault, name, outputs, each) for name, each in zip(names, later, strict=True)],
    )


def _mean_square(residuals: list[np.ndarray], present: tuple[np.ndarray, ...], c: int) -> float:
    values = np.concatenate([r[p[:, c], c] for r, p in zip(residuals, present, strict=True)])
    return float(np.mean(values**2)) if len(values) else 0.0


def _floors(clean: Problem, after: Judged, varies: np.ndarray, fault: Fault | None) -> list[Float[np.ndarray, " c"]]:
    """Mean square per channel of what no model can predict, trial by trial.

    Sensor noise, noise that inputs bring in, what smoothing them would take off, and trial-to-trial variation.
    """
    found = []
    raw = clean.recorded.residuals(after.model.system.as_measured(), after.model.values)
    everything = zip(
        clean.layouts, after.model.jacobian, clean.recorded.present, after.model.residuals, raw, strict=True
    )
    for trial, (layout, jacobian, there, smooth, rough) in zip(clean.recorded.trials, everything, strict=True):
        own = noise_variance(layout, after.noise.levels) + _varied(jacobian, varies) + (smooth - rough) ** 2
        own = put_back(fault, trial.name, clean.system.outputs, np.sqrt(own)) ** 2
        found.append(np.where(there, own, 0.0).sum(axis=0) / np.maximum(there.sum(axis=0), 1))
    return found


def _varied(jacobian: Float[np.ndarray, "t c p"], varies: Float[np.ndarray, " q"]) -> Float[np.ndarray, "t c"]:
    """Variance that trial-to-trial variation brings to each sample."""
    return np.asarray(((jacobian[..., : len(varies)] * varies) ** 2).sum(axis=-1))


def seen(clean: Problem, after: Judged) -> Float[np.ndarray, " q"]:
    """How much the base parameters differ between trials, around the best fit to all of them."""
    shift, _ = from_all_trials(clean, after, after.noise.varies)
    moved = [r - j @ shift for r, j in zip(after.model.residuals, after.model.jacobian, strict=True)]
    return clean.seen_variation(replace(after.model, residuals=moved), after.noise.levels)


def from_all_trials(
    clean: Problem, after: Judged, varies: np.ndarray
) -> tuple[Float[np.ndarray, " p"], Float[np.ndarray, "p p"]]:
    """How the parameters move when the held-out trials tell of them too, and their covariance then.

    Nothing that is fitted is reported of a trial it was fitted to; this is where the true values are believed to lie.
    Trials vary as much as they are seen to, so that few of them tell less than many samples would.
    """
    noise = replace(after.noise, varies=varies)
    model = after.model.weighed(clean.weighings(noise, after.model))
    spread = prior_spread(model.system, model.values)
    scaled = model.whitened_jacobian * spread
    covariance = np.linalg.inv(np.eye(len(spread)) + scaled.T @ scaled)
    return spread * (covariance @ (scaled.T @ model.whitened)), spread[:, None] * covariance * spread


def _gone(
    problem: Problem,
    derivatives: list[np.ndarray],
    known: np.ndarray,
    before: list[np.ndarray],
    best: list[np.ndarray],
    c: int,
) -> tuple[float, float]:
    """Mean square that the base model's error has beyond what stays, and its standard deviation.

    The base model, fitted to few trials, misses the truth by d + e, d the difference to the best fit with the effect, e
    that fit's own error; an efficient fit errs independently of what others differ from it by, so the squares add.
    """
    squares, slopes, alike = [], [], []
    for i in range(len(problem.calibration.trials), len(before)):
        there = problem.recorded.present[i][:, c]
        own = derivatives[i][there, c]
        if not len(own):
            continue
        off = (before[i] - best[i])[there, c]
        squares.append(float(np.mean(off**2)))
        slopes.append(2.0 * off @ own / len(off))
        alike.append(_misjudged(own, known))
    if not squares:
        return 0.0, 0.0
    slope, more = np.mean(slopes, axis=0), float(np.mean(alike))
    gone = float(np.mean(squares)) + more
    between = float(np.var(squares, ddof=1)) / len(squares) if len(squares) > 1 else (0.3 * gone) ** 2
    return gone, float(np.sqrt(slope @ known @ slope + between + (FORM * gone) ** 2 + more**2))


def _misjudged(derivatives: Float[np.ndarray, "t p"], posterior: Float[np.ndarray, "p p"]) -> float:
    """Mean square error of predictions because parameters are not known exactly."""
    return float(np.einsum("tp,pq,tq->", derivatives, posterior, derivatives)) / len(derivatives)


def _left(
    problem: Problem,
    derivatives: list[np.ndarray],
    known: np.ndarray,
    used: list[bool],
    best: list[np.ndarray],
    floors: list[np.ndarray],
    c: int,
) -> tuple[float, float]:
    """Mean square error that stays on a fresh trial, and its standard deviation.

    The best fit bent towards each trial, so each shows less than a fresh one will.
    """
    count = len(problem.calibration.trials)
    each = []
    for i, (residual, there, jacobian) in enumerate(zip(best, problem.recorded.present, derivatives, strict=True)):
        own = there[:, c]
        if own.any() and used[i]:
            each.append(float(np.mean(residual[own, c] ** 2)) + _misjudged(jacobian[own, c], known))
    implied = float(np.mean([f[c] for f in floors[count:]]))
    weight = len(each) + IMPLIED
    left = (sum(each) + IMPLIED * implied) / weight
    scatter = float(np.var(each, ddof=1)) if len(each) > 1 else left**2
    return left, float(np.sqrt(scatter / weight))
