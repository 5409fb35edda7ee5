"""Errors of the base model and of the answer on every trial, inputs and their central differences as measured.

That is what a simulator in somebody's hands does; smoothing inputs first leaves less of an error than is reported here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.gap.case.plain_fit import Plain, measured_fit
from geocontact.gap.case.problem import Problem, differences, noise_variance
from geocontact.gap.case.refit import ROUNDS, Measured, derivatives, free, refit
from geocontact.gap.data_errors import DataError, put_back
from geocontact.gap.inputs.denoise import changed, drawn
from geocontact.gap.inputs.spectrum import measured_inputs
from geocontact.gap.selection.evidence import Judged, prior_spread

IMPLIED = 0.3  # trials that the fitted noise levels count as
DRAWS = 16  # of noise that is added to inputs


@dataclass(frozen=True)
class RawInputErrors:
    """Residuals per trial, calibration first, of what was recorded, mistakes in the data included.

    Parameters
    ----------
    before
        Base model refitted to the calibration trials by plain least squares, every channel divided by its floor.
    after
        The answer, fitted to the calibration trials likewise, as it was judged (`gap.case.plain_fit`).
    best
        The answer where all trials together put it (to first order), its effects bent as they may be otherwise than
        their candidates (`gap.selection.model_comparison`): nearest to the truth, not to be reported as an error on
        trials it was fitted to.
    derivatives
        Of the answer's predictions, with respect to its parameters and to how its effects are bent.
    known
        Covariance of these in `best`.
    implied
        Mean square per trial and channel that the fitted noise levels imply.
    left
        Mean square that stays on a fresh trial, and its standard deviation, per channel; the squared floor.
    told_by
        How many trials tell that.
    values, fitted
        Parameters of the base model, and of the answer.
    unseen, unseen_after
        `before` and `after` with each calibration trial predicted from the others (`unseen`).
    """

    before: list[Float[np.ndarray, "_ c"]]
    after: list[Float[np.ndarray, "_ c"]]
    best: list[Float[np.ndarray, "_ c"]]
    derivatives: list[Float[np.ndarray, "_ c p"]]
    known: Float[np.ndarray, "p p"]
    implied: list[Float[np.ndarray, " c"]]
    left: tuple[tuple[float, float], ...]
    told_by: int
    values: dict[str, float]
    fitted: dict[str, float]
    unseen: list[Float[np.ndarray, "_ c"]]
    unseen_after: list[Float[np.ndarray, "_ c"]]


def raw_input_errors(problem: Problem, clean: Problem, answer: Judged, data_error: DataError | None) -> RawInputErrors:
    """Errors of a case: as it came (`problem`), and with a mistake in its data undone (`clean`).

    For the base fit channels are divided by the floors that the answer leaves: those that suit the base model would
    give little weight to the channel that it misses most.
    """
    whole, outputs = problem.recorded, problem.system.outputs
    names, count = [trial.name for trial in whole.trials], len(problem.calibration.trials)
    slopes = [put_back(data_error, n, outputs, d) for n, d in zip(names, directions(answer), strict=True)]
    model = answer.model
    predicted = clean.recorded.residuals(model.system.as_measured(), model.values)
    at_best = [put_back(data_error, name, outputs, each) for name, each in zip(names, predicted, strict=True)]
    fitted, predicted = measured_fit(clean, model, clean.floor)
    after = [put_back(data_error, name, outputs, each) for name, each in zip(names, predicted, strict=True)]
    varies = observed_variation(clean, answer)
    shift, known = from_all_trials(clean, answer, varies)
    best = [r - j @ shift for r, j in zip(at_best, slopes, strict=True)]
    implied = _implied(clean, answer, varies, data_error)
    sound = [data_error is None or name not in data_error.trials for name in names[:count]]
    used = [*(sound if any(sound) else [True] * count), *(True for _ in names[count:])]
    left = tuple(_left(problem, slopes, known, used, best, implied, c) for c in range(len(outputs)))
    first = replace(whole, trials=whole.trials[:count], outputs=whole.outputs[:count])
    whiten = [Plain(there, np.sqrt([value for value, _ in left])) for there in first.present]
    base = problem.system.as_measured()
    values = refit(base, first, whiten, [problem.plain.values], ROUNDS).values
    before = whole.residuals(base, values)
    told = left, sum(used), values, fitted
    if data_error is not None:  # what a fit to trials with a mistake predicts of others says nothing of the effect
        return RawInputErrors(before, after, best, slopes, known, implied, *told, before, after)
    floor = np.sqrt([value for value, _ in left])
    apart = [*unseen(base, first, floor, values, before[:count]), *before[count:]]
    later = unseen(model.system.as_measured(), first, clean.floor, fitted, after[:count])
    return RawInputErrors(before, after, best, slopes, known, implied, *told, apart, [*later, *after[count:]])


def unseen(
    system: System,
    fitted: Measured,
    floor: Float[np.ndarray, " c"],
    values: Mapping[str, float],
    residuals: Sequence[Float[np.ndarray, "_ c"]],
) -> list[Float[np.ndarray, "_ c"]]:
    """Residuals of each trial of a fit to all of them, predicted from a fit to the others.

    That fit is one Gauss-Newton step away, within bounds, and the trial is simulated there. With r_i and J_i divided by
    the floor, δ₋ᵢ = (Σ_{j≠i} J_jᵀJ_j + S⁻²)⁻¹ Σ_{j≠i} J_jᵀ r_j, S the prior spread, 0 of a parameter on a bound; the
    step of all trials together, nothing at a finished fit, is taken off.

    Parameters
    ----------
    values, residuals
        Of the fit to all of the trials in `fitted`.
    """
    parameters, spread = free(system), prior_spread(system, dict(values))
    weights = [Plain(there, floor) for there in fitted.present]
    slopes = derivatives(system, fitted, values, residuals)
    design = [w(j * spread) for w, j in zip(weights, slopes, strict=True)]
    left = [w(r[..., None])[:, 0] for w, r in zip(weights, residuals, strict=True)]
    grams, pulls = [j.T @ j for j in design], [j.T @ r for j, r in zip(design, left, strict=True)]
    known, pull = np.eye(len(spread)) + sum(grams), sum(pulls)
    found = []
    for trial, measured, gram, own in zip(fitted.trials, fitted.outputs, grams, pulls, strict=True):
        step = spread * (np.linalg.solve(known - gram, pull - own) - np.linalg.solve(known, pull))
        there = {
            p.name: float(np.clip(values[p.name] + by, p.lower, p.upper))
            for p, by in zip(parameters, step, strict=True)
        }
        found += replace(fitted, trials=(trial,), outputs=(measured,)).residuals(system, there)
    return found


def passed_on(
    problem: Problem, answer: Judged, pair: list[tuple[System, dict[str, float], list[Float[np.ndarray, "_ c"]]]]
) -> Float[np.ndarray, " c"]:
    """2 E[a (b - a)] with a, b what noise of the inputs does to the answer's prediction and to the base model's.

    Per channel, on the held-out trials: what it makes of the square of the base model's error beyond the answer's, less
    the square of the difference of the two. `pair` are the base model and the answer, as they see what was measured:
    system, values, residuals on those trials. Noise is drawn, as high as the answer has it, and added to what was
    recorded (simulation extrapolation: Cook & Stefanski 1994, J. Am. Stat. Assoc. 89:1314). A draw in which a
    simulation fails tells nothing.
    """
    trials, rng = problem.recorded.trials[len(problem.calibration.trials) :], np.random.default_rng(0)
    held_out = replace(problem.recorded, trials=trials, outputs=problem.evaluation.outputs)
    levels = dict(zip(problem.system.inputs, answer.noise.levels.inputs, strict=True))
    noisy = measured_inputs(problem.recorded.trials, list(levels))

    def change(name: str, even: Float[np.ndarray, " n"], step: float) -> Float[np.ndarray, " n"]:
        return drawn(rng, len(even), step, levels[name], problem.passed[name])

    found = []
    for _ in range(DRAWS):
        more = replace(held_out, trials=tuple(changed(trial, noisy, change) for trial in trials))
        base, own = (differences(more, *each) for each in pair)
        product = [2.0 * a * (b - a) for a, b in zip(own, base, strict=True)]
        sums = [np.where(there, each, 0.0).sum(axis=0) for each, there in zip(product, held_out.present, strict=True)]
        found.append(sum(sums) / np.maximum(sum(there.sum(axis=0) for there in held_out.present), 1))
    finite = [each for each in found if np.isfinite(each).all()]
    return np.asarray(np.mean(finite, axis=0) if finite else np.zeros(len(problem.system.outputs)))


def observed_variation(clean: Problem, after: Judged) -> Float[np.ndarray, " q"]:
    """How much the base parameters differ between trials, around the best fit to all of them."""
    shift, _ = from_all_trials(clean, after, after.noise.varies)
    moved = [r - d @ shift for r, d in zip(after.model.residuals, directions(after), strict=True)]
    return clean.seen_variation(replace(after.model, residuals=moved), after.noise.levels)


def from_all_trials(
    clean: Problem, after: Judged, varies: np.ndarray
) -> tuple[Float[np.ndarray, " p"], Float[np.ndarray, "p p"]]:
    """How parameters and discrepancies move when the held-out trials tell of them too, and their covariance then.

    Nothing that is fitted is reported of a trial it was fitted to; this is where the true values are estimated to lie.
    Trials vary as much as they are seen to, so that few of them tell less than many samples would.
    """
    noise = replace(after.noise, varies=varies)
    whitenings = clean.whitenings(noise, after.model)
    model = after.model.weighed(whitenings)
    whitened_basis = np.concatenate([whiten(b) for whiten, b in zip(whitenings, after.discrepancy_basis, strict=True)])
    spread = np.concatenate([prior_spread(model.system, model.values), np.ones(whitened_basis.shape[1])])
    scaled = np.concatenate([model.whitened_jacobian, whitened_basis], axis=1) * spread
    covariance = np.linalg.inv(np.eye(len(spread)) + scaled.T @ scaled)
    return spread * (covariance @ (scaled.T @ model.whitened)), spread[:, None] * covariance * spread


def directions(one: Judged) -> list[Float[np.ndarray, "_ c k"]]:
    """Per trial, what is free to move: derivatives with respect to parameters, then the discrepancy basis."""
    pairs = zip(one.model.jacobian, one.discrepancy_basis, strict=True)
    return [np.concatenate([jacobian, discrepancy_basis], axis=-1) for jacobian, discrepancy_basis in pairs]


def _implied(
    clean: Problem, after: Judged, varies: np.ndarray, data_error: DataError | None
) -> list[Float[np.ndarray, " c"]]:
    """Mean square per channel of what no model can predict, trial by trial.

    Sensor noise, noise that inputs bring in, what smoothing them would take off, and trial-to-trial variation.
    """
    found = []
    raw = clean.recorded.residuals(after.model.system.as_measured(), after.model.values)
    everything = zip(
        clean.layouts,
        clean.varied(after.model.jacobian),
        clean.recorded.present,
        after.model.residuals,
        raw,
        strict=True,
    )
    for trial, (layout, varied, there, smooth, rough) in zip(clean.recorded.trials, everything, strict=True):
        own = noise_variance(layout, after.noise.levels) + ((varied * varies) ** 2).sum(axis=-1) + (smooth - rough) ** 2
        own = put_back(data_error, trial.name, clean.system.outputs, np.sqrt(own)) ** 2
        found.append(np.where(there, own, 0.0).sum(axis=0) / np.maximum(there.sum(axis=0), 1))
    return found


def misjudged(derivatives: Float[np.ndarray, "t p"], posterior: Float[np.ndarray, "p p"]) -> float:
    """Mean square error of predictions because parameters are not known exactly."""
    return float(np.einsum("tp,pq,tq->", derivatives, posterior, derivatives)) / len(derivatives)


def _left(
    problem: Problem,
    derivatives: list[np.ndarray],
    known: np.ndarray,
    used: list[bool],
    best: list[np.ndarray],
    implied: list[np.ndarray],
    c: int,
) -> tuple[float, float]:
    """Mean square error that stays on a fresh trial, and its standard deviation.

    The best fit bent towards each trial, so each shows less than a fresh one will.
    """
    count = len(problem.calibration.trials)
    each, more = [], []
    for i, (residual, there, columns) in enumerate(zip(best, problem.recorded.present, derivatives, strict=True)):
        own = there[:, c]
        if own.any() and used[i]:
            more.append(misjudged(columns[own, c], known))
            each.append(float(np.mean(residual[own, c] ** 2)) + more[-1])
    floor = float(np.mean([f[c] for f in implied[count:]]))
    weight = len(each) + IMPLIED
    seen = sum(each) / len(each) if each else floor
    left = max((sum(each) + IMPLIED * min(floor, seen)) / weight, 1e-300)
    scatter = float(np.var(each, ddof=1)) if len(each) > 1 else left**2
    return left, float(np.sqrt(scatter / weight + np.mean(more) ** 2)) if more else left
