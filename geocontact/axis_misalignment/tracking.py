"""How well a person follows a target angle with an exoskeleton, beside the force that it puts on the arm.

Of each trial the error β - target as it is, and what it consists of: the delay at which the angle goes best with the
target, the gain over the delayed target, and what is left. Over trials a measure of performance, or a score of the
trial, goes with the force or it does not: slope with Student's interval, Spearman's rank correlation with the p of
permutations, Holm's correction over all of them. Trials are what counts, samples of one trial are not independent.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit

from geocontact.data.elbow_recording import ElbowRecording
from geocontact.identify.intervals.bin_tests import holm

LONGEST_DELAY = 1.0
"""s; nobody follows a visible target later."""
FEWEST = 4
"""Trials over which something is said to go with something else."""
PERMUTATIONS = 9999


@dataclass(frozen=True)
class Tracking:
    """One trial; angles are NaN where no target was recorded.

    Parameters
    ----------
    rmse, bias
        Of the angle less the target [rad].
    delay
        [s].
    gain
        Slope of the angle over the delayed target [-].
    rest
        Root mean square of what delay, gain and a constant leave [rad].
    rms_force, peak_force
        Of the force along the limb [N].
    pressure
        Mean of the cuff [Pa]; NaN where it was not recorded.
    """

    rmse: float
    bias: float
    delay: float
    gain: float
    rest: float
    rms_force: float
    peak_force: float
    pressure: float


def tracking_of(r: ElbowRecording) -> Tracking:
    """Error and force of one trial."""
    force = float(np.sqrt(np.mean(r.force**2))), float(np.abs(r.force).max())
    pressure = np.nan if r.pressure is None else float(r.pressure.mean())
    if r.target is None:
        return Tracking(*(5 * (np.nan,)), *force, pressure)
    off = r.beta - r.target
    delay = delay_of(r.time, r.beta, r.target)
    gain, rest = _line(*_delayed(r.time, r.beta, r.target, delay))
    return Tracking(float(np.sqrt(np.mean(off**2))), float(off.mean()), delay, gain, rest, *force, pressure)


def delay_of(time: Float[np.ndarray, " t"], angle: Float[np.ndarray, " t"], target: Float[np.ndarray, " t"]) -> float:
    """Delay [s] from 0 to 1 s at which a line over the delayed target leaves least of the angle, between steps too."""
    step = float(np.median(np.diff(time)))
    tried = step * np.arange(int(min(LONGEST_DELAY, 0.25 * (time[-1] - time[0])) / step) + 1)
    left = np.array([_line(*_delayed(time, angle, target, delay))[1] ** 2 for delay in tried])
    best = int(np.argmin(left))
    if not 0 < best < len(tried) - 1:
        return float(tried[best])
    before, here, after = left[best - 1 : best + 2]
    return float(tried[best] + 0.5 * step * (before - after) / (before - 2.0 * here + after))


def _delayed(
    time: Float[np.ndarray, " t"], angle: Float[np.ndarray, " t"], target: Float[np.ndarray, " t"], delay: float
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    there = time >= time[0] + delay
    return np.interp(time[there] - delay, time, target), angle[there]


def _line(x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]) -> tuple[float, float]:
    """Slope, and root mean square of what the line leaves."""
    off = x - x.mean()
    square = float(off @ off)
    slope = float(off @ y) / square if square > 0.0 else np.nan
    left = y - y.mean() - slope * off
    return slope, float(np.sqrt(np.mean(left**2)))


@dataclass(frozen=True)
class GoesWith:
    """How one measure goes with another over trials.

    Parameters
    ----------
    measure, over
        Their names.
    slope, lower, upper
        And its 95 %, in the measures' units.
    rank, p, p_holm
        Spearman's correlation, the share of permutations that reach it, and that over all pairs.
    """

    measure: str
    over: str
    trials: int
    slope: float
    lower: float
    upper: float
    rank: float
    p: float
    p_holm: float = float("nan")


def goes_with(
    measures: Mapping[str, Float[np.ndarray, " n"]], overs: Mapping[str, Float[np.ndarray, " n"]]
) -> list[GoesWith]:
    """Every measure over every other quantity; pairs of fewer than four trials, or without change, are left out."""
    pairs = [(name, over, *_both(y, x)) for over, x in overs.items() for name, y in measures.items()]
    kept = [each for each in pairs if len(each[2]) >= FEWEST and np.ptp(each[2]) > 0.0 and np.ptp(each[3]) > 0.0]
    found = [_goes(name, over, y, x) for name, over, y, x in kept]
    corrected = holm(np.array([each.p for each in found])) if found else np.zeros(0)
    return [replace(each, p_holm=float(p)) for each, p in zip(found, corrected, strict=True)]


def _both(y: Float[np.ndarray, " n"], x: Float[np.ndarray, " n"]) -> tuple[np.ndarray, np.ndarray]:
    there = np.isfinite(y) & np.isfinite(x)
    return y[there], x[there]


def _goes(name: str, over: str, y: Float[np.ndarray, " n"], x: Float[np.ndarray, " n"]) -> GoesWith:
    slope, left = _line(x, y)
    freedom = len(y) - 2
    error = left * np.sqrt(len(y) / freedom) / float(np.sqrt(np.sum((x - x.mean()) ** 2)))
    half = float(stdtrit(freedom, 0.975)) * error
    rank, p = _spearman(y, x)
    return GoesWith(name, over, len(y), slope, slope - half, slope + half, rank, p)


def _ranks(values: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """Ranks from 1; equal values share the mean of theirs."""
    _, place, count = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(count) - 0.5 * (count - 1))[place])


def _spearman(y: Float[np.ndarray, " n"], x: Float[np.ndarray, " n"], seed: int = 0) -> tuple[float, float]:
    a, b = _ranks(y), _ranks(x)
    a, b = (a - a.mean()) / a.std(), (b - b.mean()) / b.std()
    rank = float(a @ b) / len(a)
    rng = np.random.default_rng(seed)
    drawn = rng.permuted(np.tile(a, (PERMUTATIONS, 1)), axis=1) @ b / len(a)
    return rank, float((1 + np.sum(np.abs(drawn) >= abs(rank) - 1e-12)) / (1 + PERMUTATIONS))


def of_conditions(
    conditions: Sequence[str], measures: Mapping[str, Float[np.ndarray, " n"]]
) -> list[tuple[str, str, int, float, float]]:
    """Condition, measure, trials, mean and SD over trials of each."""
    rows = []
    for condition in dict.fromkeys(conditions):
        mine = np.array([each == condition for each in conditions])
        for name, values in measures.items():
            own = values[mine & np.isfinite(values)]
            if len(own):
                sd = float(own.std(ddof=1)) if len(own) > 1 else float("nan")
                rows.append((condition, name, len(own), float(own.mean()), sd))
    return rows
