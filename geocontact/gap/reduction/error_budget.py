"""What the squared error on held-out trials consists of, channel by channel: shares that add to 1.

    error before = effects + (error after),   error after = variation + sensor + inputs + unexplained

Each part has evidence of its own. *Effects*: what the named effects, or the mistake in the data that is undone, take
away on trials that nothing was fitted to. *Variation*: what the deviation of each trial from the mean of all takes away
of what stays, its base parameters, placement, zeros and gains no larger than is usual; what all trials deviate by alike
is none. *Sensor*: noise as the case states it; without a statement as it was estimated, so that its share is then an
upper bound. *Inputs*: what noise of the inputs makes of the prediction, no louder than is usual. What stays then is
**unexplained**: stated noise never grows to take it. Where the parts of the noise together are more than what there is,
they share it in proportion, and nothing is unexplained.

Intervals are those of blocks drawn within each held-out trial (Künsch 1989, Ann Stat 17, 1217), with levels of noise
known to the factor `SENSOR_LOUDER`. How often they hold the true shares was not counted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.diagnosis import BudgetPart
from geocontact.gap.case.change_amplitude import BLOCKS
from geocontact.gap.case.problem import Problem, noise_variance
from geocontact.gap.case.whitening import SENSOR_LOUDER
from geocontact.gap.data_errors import DataError, put_back
from geocontact.gap.levels import DRAWS
from geocontact.gap.reduction.raw_input_errors import RawInputErrors
from geocontact.gap.selection.evidence import Judged
from geocontact.identify.intervals.quantile_intervals import ENDS

PARTS = ("sensor", "inputs", "variation", "effects", "unexplained")
"""Parts of the squared error, in the order of tables."""


@dataclass(frozen=True, eq=False)
class ErrorTrial:
    """One held-out trial of one channel, samples that were measured, in the channel's unit.

    Parameters
    ----------
    before, after
        Errors of the base model and of the answer; the same where nothing is named.
    cleared
        The latter without the trial's own deviation.
    sensor, inputs
        Variance of the noise of the sensor, and of what noise of the inputs makes of the prediction.
    """

    before: Float[np.ndarray, " n"]
    after: Float[np.ndarray, " n"]
    cleared: Float[np.ndarray, " n"]
    sensor: Float[np.ndarray, " n"]
    inputs: Float[np.ndarray, " n"]


def shares(trials: Sequence[ErrorTrial]) -> dict[str, BudgetPart]:
    """Share of each of `PARTS` in the squared error before, and its 95 % interval; none where there is no error."""
    blocks = [block for trial in trials for block in _blocks(trial)]
    sums = np.array([_sums(each) for each in blocks]) if blocks else np.zeros((0, len(PARTS)))
    if not len(sums) or not sums[:, 0].sum() > 0.0:
        return {}
    rng = np.random.default_rng(0)
    middle = _split(sums.sum(axis=0))
    drawn = np.array([_split(_drawn(sums, [len(_blocks(t)) for t in trials], rng)) for _ in range(DRAWS)])
    low, high = np.nanquantile(drawn, ENDS, axis=0)
    ends = zip(np.minimum(low, middle), np.maximum(high, middle), strict=True)
    values = zip(PARTS, middle, ends, strict=True)
    return {name: BudgetPart(float(share), (float(a), float(b))) for name, share, (a, b) in values}


def _blocks(trial: ErrorTrial) -> list[ErrorTrial]:
    columns = (trial.before, trial.after, trial.cleared, trial.sensor, trial.inputs)
    cut = [np.array_split(each, BLOCKS) for each in columns]
    return [ErrorTrial(*each) for each in zip(*cut, strict=True) if len(each[0])]


def _sums(block: ErrorTrial) -> tuple[float, ...]:
    """Squares of before, after and cleared; variances."""
    squares = (float(each @ each) for each in (block.before, block.after, block.cleared))
    return (*squares, float(block.sensor.sum()), float(block.inputs.sum()))


def _drawn(
    sums: Float[np.ndarray, "b five"], counts: Sequence[int], rng: np.random.Generator
) -> Float[np.ndarray, " five"]:
    """Blocks drawn within each trial, and levels of noise as they may be."""
    first = np.cumsum([0, *counts[:-1]])
    chosen = np.concatenate([k + rng.integers(0, n, n) for k, n in zip(first, counts, strict=True)])
    before, after, cleared, *noise = sums[chosen].sum(axis=0)
    levels = SENSOR_LOUDER ** rng.normal(size=len(noise))
    return np.array([before, after, cleared, *(noise * levels**2)])


def _split(total: Float[np.ndarray, " five"]) -> Float[np.ndarray, " five"]:
    """Shares of `PARTS`; NaN where there is no error, which may be drawn."""
    before, after, cleared, sensor, inputs = total
    varied = float(np.clip(after - cleared, 0.0, after))
    stays = after - varied
    noise = sensor + inputs
    if noise > stays:
        sensor, inputs = (stays * each / noise for each in (sensor, inputs))
    parts = np.array([sensor, inputs, varied, before - after, stays - sensor - inputs])
    return np.asarray(parts / before if before > 0.0 else np.full(len(PARTS), np.nan))


def deviations(
    residuals: Sequence[Float[np.ndarray, "_ c"]],
    varied: Sequence[Float[np.ndarray, "_ c q"]],
    present: Sequence[Bool[np.ndarray, "_ c"]],
    floor: Float[np.ndarray, " c"],
) -> Float[np.ndarray, "i q"]:
    """Most probable deviation of each trial from the mean of all, in usual standard deviations.

    What all trials deviate by alike is no variation: a model that is wrong in the same way in every trial misses there.

    Parameters
    ----------
    varied
        Derivatives with respect to what varies, times its usual standard deviation.
    floor
        Noise of each channel.
    """
    found = []
    for residual, columns, there in zip(residuals, varied, present, strict=True):
        b, r = (columns / floor[:, None])[there], (residual / floor)[there]
        found.append(np.linalg.solve(np.eye(b.shape[1]) + b.T @ b, b.T @ r))
    every = np.asarray(found)
    return np.asarray(every - every.mean(axis=0))


def error_budget(
    problem: Problem,
    clean: Problem,
    errors: RawInputErrors,
    answer: Judged,
    named: bool,
    stated: Mapping[str, float],
    data_error: DataError | None = None,
) -> dict[str, dict[str, BudgetPart]]:
    """Budget of each channel that has an error on held-out trials.

    Parameters
    ----------
    problem, clean
        The case as it came, and with a mistake in its data undone; the same where there is none.
    errors
        Of base model and answer, inputs as measured.
    answer
        The model with what was named, fitted to the clean case, or the base where nothing was.
    stated
        Standard deviation of the noise of channels, in their units, as the case states it.
    """
    count, outputs = len(problem.calibration.trials), problem.system.outputs
    low = clean.with_lower_noise(answer.noise)
    levels = low.levels
    silent = replace(answer.noise.levels, inputs=0.0 * levels.inputs)
    alone = replace(levels, white=0.0 * levels.white, coloured=0.0 * levels.coloured, growing=0.0 * levels.growing)
    raw = clean.recorded.residuals(answer.model.system.as_measured(), answer.model.values)
    names = [trial.name for trial in problem.recorded.trials]
    varied = [
        put_back(data_error, name, outputs, each * low.varies)
        for name, each in zip(names, clean.varied(answer.model.jacobian), strict=True)
    ]
    stays = errors.after if named else errors.before
    own_deviation = deviations(stays, varied, problem.recorded.present, problem.floor)
    found: dict[str, list[ErrorTrial]] = {name: [] for name in outputs}
    for i in range(count, len(problem.recorded.trials)):
        there, after = problem.recorded.present[i], stays[i]
        cleared = after - varied[i] @ own_deviation[i]
        estimated = noise_variance(clean.layouts[i], silent)
        smooth = (answer.model.residuals[i] - raw[i]) ** 2
        inputs = noise_variance(clean.layouts[i], alone) + np.where(there, smooth, 0.0)
        for c, channel in enumerate(outputs):
            own = there[:, c]
            if own.any():
                level = stated.get(channel)
                sensor = estimated[own, c] if level is None else np.full(int(own.sum()), level**2)
                parts = errors.before[i][own, c], after[own, c], cleared[own, c], sensor, inputs[own, c]
                found[channel].append(ErrorTrial(*parts))
    return {channel: budget for channel, trials in found.items() if (budget := shares(trials))}
