"""What the squared error on held-out trials consists of, channel by channel: shares that add to 1.

    error before = effects + (error after),   error after = variation + sensor + inputs + unexplained

Each part has evidence of its own. *Effects*: what the named effects, or the mistake in the data that is undone, take
away on trials that nothing was fitted to. *Variation*: what the deviation of each trial takes away of what stays, its
base parameters, placement, zeros and gains within `DEVIATIONS` times what is usual; what the calibration trials deviate
by alike is none. *Sensor*: noise as the case states it, of a quotient as it grows with the divisor; without a statement
as it was estimated, so that its share is then an upper bound. *Inputs*: what noise of the inputs makes of the
prediction, no louder than is usual. What stays then is **unexplained**: stated noise never grows to take it, and no
noise takes what repeats from trial to trial (`gap.reduction.repeats`). Where the parts of the noise together are more
than what there is for them, they share it in proportion.

A channel surely **misses** a share of its squared error where that repeats; or, where its noise is stated, where
neighbours in time share more than `loudest` times the noise: what a model misses is smooth, while noise that grows with
the signal, or has heavy tails, is not.

Intervals are those of blocks drawn within each held-out trial (Künsch 1989, Ann Stat 17, 1217), with levels of noise
known to the factor `SENSOR_LOUDER`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.diagnosis import BudgetPart
from geocontact.gap.case.change_amplitude import BLOCKS
from geocontact.gap.case.noise_sources import seen_growth, signal_size
from geocontact.gap.case.problem import Problem, noise_variance
from geocontact.gap.case.whitening import SENSOR_LOUDER
from geocontact.gap.data_errors import DataError, put_back
from geocontact.gap.levels import DEVIATIONS, DRAWS
from geocontact.gap.reduction.raw_input_errors import RawInputErrors
from geocontact.gap.reduction.repeats import axes_of, repeats
from geocontact.gap.selection.evidence import Judged
from geocontact.identify.intervals.quantile_intervals import ENDS
from geocontact.identify.noise.noise_levels import BEYOND

PARTS = ("sensor", "inputs", "variation", "effects", "unexplained")
"""Parts of the squared error, in the order of tables."""


def loudest() -> float:
    """Times the stated noise of a sensor that is put down to noise at the most: 1.62."""
    return float(SENSOR_LOUDER * np.exp(BEYOND))


@dataclass(frozen=True)
class ChannelBudget:
    """Shares of a channel's squared error on held-out trials.

    Parameters
    ----------
    parts
        Of `PARTS`; they add to 1.
    missed
        Share that is surely neither noise nor variation, nor taken by what is named.
    """

    parts: dict[str, BudgetPart]
    missed: float

    @property
    def floor(self) -> float:
        """Share of noise and variation together, not below 0."""
        return max(sum(self.parts[name].share for name in ("sensor", "inputs", "variation")), 0.0)


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


def shares(trials: Sequence[ErrorTrial], repeating: float = 0.0) -> dict[str, BudgetPart]:
    """Share of each of `PARTS` in the squared error before, and its 95 % interval; none where there is no error.

    `repeating` is the share of what stays, variation off, that no noise may take.
    """
    blocks = [block for trial in trials for block in _blocks(trial)]
    sums = np.array([_sums(each) for each in blocks]) if blocks else np.zeros((0, len(PARTS)))
    if not len(sums) or not sums[:, 0].sum() > 0.0:
        return {}
    rng = np.random.default_rng(0)
    middle = _split(sums.sum(axis=0), repeating)
    counts = [len(_blocks(t)) for t in trials]
    drawn = np.array([_split(_drawn(sums, counts, rng), repeating) for _ in range(DRAWS)])
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


def _split(total: Float[np.ndarray, " five"], repeating: float) -> Float[np.ndarray, " five"]:
    """Shares of `PARTS`; NaN where there is no error, which may be drawn."""
    before, after, cleared, sensor, inputs = total
    varied = float(np.clip(after - cleared, 0.0, after))
    stays = after - varied
    noise = sensor + inputs
    room = (1.0 - repeating) * stays
    if noise > room:
        sensor, inputs = (room * each / noise for each in (sensor, inputs))
    parts = np.array([sensor, inputs, varied, before - after, stays - sensor - inputs])
    return np.asarray(parts / before if before > 0.0 else np.full(len(PARTS), np.nan))


def share_taken(
    base: Sequence[Float[np.ndarray, " _"]],
    lacking: Sequence[Float[np.ndarray, " _"]],
    having: Sequence[Float[np.ndarray, " _"]],
) -> tuple[float, float, float] | None:
    """What the squared error of a model with an effect is less than without it, over that of the base model.

    With its interval of 95 %, from blocks drawn within each trial; None where there is no error.
    """
    cut = [[np.array_split(part, BLOCKS) for part in parts] for parts in (base, lacking, having)]
    sums = np.array([[float(each @ each) for trial in parts for each in trial if len(each)] for parts in cut]).T
    if not len(sums) or not sums[:, 0].sum() > 0.0:
        return None
    rng, counts = np.random.default_rng(0), [sum(bool(len(each)) for each in trial) for trial in cut[0]]
    first = np.cumsum([0, *counts[:-1]])
    rows = np.concatenate([k + rng.integers(0, n, (DRAWS, n)) for k, n in zip(first, counts, strict=True) if n], axis=1)
    drawn = sums[rows].sum(axis=1)
    drawn = drawn[drawn[:, 0] > 0.0]
    low, high = np.quantile((drawn[:, 1] - drawn[:, 2]) / drawn[:, 0], ENDS)
    whole = sums.sum(axis=0)
    return float((whole[1] - whole[2]) / whole[0]), float(low), float(high)


def beyond_noise(trials: Sequence[ErrorTrial]) -> float:
    """Share of the squared error that neighbours in time share beyond what `loudest` noise makes; 0 where none."""
    before = sum(float(t.before @ t.before) for t in trials)
    alike = min(sum(float(r[1:] @ r[:-1]) for r in parts) for parts in _stays(trials))
    noise = sum(float(t.sensor.sum() + t.inputs.sum()) for t in trials)
    return max(alike - loudest() ** 2 * noise, 0.0) / before if before > 0.0 else 0.0


def _stays(trials: Sequence[ErrorTrial]) -> tuple[list[Float[np.ndarray, " _"]], list[Float[np.ndarray, " _"]]]:
    """Errors of the answer, and without the trials' own deviations; taking these off may also leave more."""
    return [t.after for t in trials], [t.cleared for t in trials]


def deviations(
    residuals: Sequence[Float[np.ndarray, "_ c"]],
    varied: Sequence[Float[np.ndarray, "_ c q"]],
    present: Sequence[Bool[np.ndarray, "_ c"]],
    floor: Float[np.ndarray, " c"],
) -> Float[np.ndarray, "i q"]:
    """Most probable deviation of each trial, in usual standard deviations, `DEVIATIONS` at most.

    Parameters
    ----------
    varied
        Derivatives with respect to what varies, times its usual standard deviation.
    floor
        Noise of each channel.
    """
    from scipy.optimize import lsq_linear

    found = []
    for residual, columns, there in zip(residuals, varied, present, strict=True):
        b, r = (columns / floor[:, None])[there], (residual / floor)[there]
        root = np.linalg.cholesky(np.eye(b.shape[1]) + b.T @ b).T
        found.append(lsq_linear(root, np.linalg.solve(root.T, b.T @ r), (-DEVIATIONS, DEVIATIONS)).x)
    return np.asarray(found)


def error_budget(
    problem: Problem,
    clean: Problem,
    errors: RawInputErrors,
    answer: Judged,
    named: bool,
    stated: Mapping[str, float],
    data_error: DataError | None = None,
) -> dict[str, ChannelBudget]:
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
    own = deviations(stays, varied, problem.recorded.present, problem.floor)
    freed = [r - b @ d for r, b, d in zip(stays, varied, own, strict=True)]
    cleared = [r - b @ d for r, b, d in zip(stays, varied, own - own[:count].mean(axis=0), strict=True)]
    measured = problem.recorded.outputs
    growth = seen_growth(measured, [np.ones_like(each) for each in measured])
    grown = [(growth * each) ** 2 for each in signal_size(measured)]
    trials: dict[str, list[ErrorTrial]] = {name: [] for name in outputs}
    for i in range(count, len(problem.recorded.trials)):
        there = problem.recorded.present[i]
        estimated = noise_variance(clean.layouts[i], silent)
        smooth = np.where(there, (answer.model.residuals[i] - raw[i]) ** 2, 0.0)
        inputs = noise_variance(clean.layouts[i], alone) + smooth
        for c, channel in enumerate(outputs):
            at = there[:, c]
            if at.any():
                known = stated.get(channel), grown[i][at, c]
                sensor = _of_sensor(estimated[at, c], *known, channel in problem.system.quotients)
                parts = (errors.before[i][at, c], stays[i][at, c], cleared[i][at, c], sensor, inputs[at, c])
                trials[channel].append(ErrorTrial(*parts))
    axes = axes_of(problem.recorded.trials, problem.system)
    found = {}
    for c, channel in enumerate(outputs):
        same = repeats([r[:, c] for r in freed], [there[:, c] for there in problem.recorded.present], axes).sure
        split = shares(trials[channel], same)
        if split:
            kept = min(sum(float(r @ r) for r in parts) for parts in _stays(trials[channel]))
            repeating = same * kept / sum(float(t.before @ t.before) for t in trials[channel])
            found[channel] = ChannelBudget(
                split, max(repeating, beyond_noise(trials[channel]) if channel in stated else 0.0)
            )
    return found


def _of_sensor(
    estimated: Float[np.ndarray, " n"], stated: float | None, grown: Float[np.ndarray, " n"], quotient: bool
) -> Float[np.ndarray, " n"]:
    """Variance of a sensor's noise: as stated, and what successive samples show that it grows with the signal.

    Of a quotient no less than it is estimated to be by its divisor.
    """
    if stated is None:
        return estimated
    return np.maximum(estimated, stated**2) if quotient else stated**2 + grown
