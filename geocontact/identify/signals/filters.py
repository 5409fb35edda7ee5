"""Recordings on even times, their gaps, and the zero-lag low-pass that gait laboratories use."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.frame_blocks import blocks, release, room
from geocontact.identify.signals.butterworth import filtered, sections, settled
from geocontact.identify.signals.cycles import Span

UNEVEN = 0.05
"""Share of a step that a sample may be off without being moved."""
GAP = 1.5
"""Steps between samples beyond which nothing is said of what lies between them."""


def even_times(time: Float[np.ndarray, " t"]) -> tuple[Float[np.ndarray, " e"], float]:
    """Evenly spaced times over the same span and their step [s], the median one; `time` itself where it is even."""
    step = float(np.median(np.diff(time)))
    own = time[0] + step * np.arange(round((time[-1] - time[0]) / step) + 1)
    if len(own) == len(time) and np.abs(own - time).max() <= UNEVEN * step:
        return time, step
    return own[own <= time[-1] + 1e-9 * step], step


def at_times(
    time: Float[np.ndarray, " t"], curve: Float[np.ndarray, " t"], wanted: Float[np.ndarray, " e"], step: float
) -> Float[np.ndarray, " e"]:
    """The curve at other times, straight between samples; NaN inside of gaps longer than `GAP` steps."""
    if wanted is time:
        return curve
    after = np.clip(np.searchsorted(time, wanted), 1, len(time) - 1)
    wide = time[after] - time[after - 1] > GAP * step
    off = np.minimum(np.abs(wanted - time[after]), np.abs(wanted - time[after - 1]))
    return np.where(wide & (off > UNEVEN * step), np.nan, np.interp(wanted, time, curve))


BRIDGED = 0.05
"""s; a straight line across less loses little of what a limb does: 4 % of a stride of 1.2 s."""


def gaps(time: Float[np.ndarray, " t"]) -> list[Span]:
    """Spans between samples that are farther apart than `GAP` usual steps and than `BRIDGED`, in their order."""
    steps = np.diff(time)
    if not len(steps):
        return []
    wide = np.flatnonzero(steps > max(GAP * float(np.median(steps)), BRIDGED))
    return [Span(float(time[k]), float(time[k + 1])) for k in wide]


def in_gaps(time: Float[np.ndarray, " n"], missing: Sequence[Span]) -> Bool[np.ndarray, " n"]:
    """Which times [s] lie inside one of the gaps, their ends not counted."""
    found = np.zeros(len(time), bool)
    for each in missing:
        found |= (time > each.start) & (time < each.end)
    return found


def broken(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"]
) -> tuple[Float[np.ndarray, " b"], Float[np.ndarray, " b"]]:
    """The curve with a missing value (NaN) in the middle of each gap, as it is drawn."""
    missing = gaps(time)
    places = [int(np.searchsorted(time, each.end)) for each in missing]
    middles = [0.5 * (each.start + each.end) for each in missing]
    return np.insert(time, places, middles), np.insert(values, places, np.nan)


def filled_and_smoothed(
    time: Float[np.ndarray, " t"],
    values: Float[np.ndarray, "t n"],
    *,
    cutoff: float | None,
    longest_gap: float,
) -> tuple[Float[np.ndarray, " e"], Float[np.ndarray, "e n"]]:
    """Even times [s] and the columns there, without gaps, through a zero-lag low-pass.

    Gaps are bridged by monotone cubics (Fritsch & Carlson 1980, SIAM J Numer Anal 17, 238-246), which do not overshoot.

    Parameters
    ----------
    time
        [s], increasing.
    values
        NaN where a sample is missing; a row that is left out counts as well.
    cutoff
        Of the low-pass [Hz]; None leaves the values as they are.
    longest_gap
        Time between two samples of a column that is bridged [s]. ValueError names the first gap beyond it, and a
        column that begins late or ends early.
    """
    from scipy.interpolate import PchipInterpolator

    even, step = even_times(time)
    found = np.empty((len(even), values.shape[1]))
    for k, column in enumerate(values.T):
        there = np.isfinite(column)
        if there.sum() < 2:
            raise ValueError(f"column {k + 1} has {int(there.sum())} samples")
        known = time[there]
        wide = np.diff(np.concatenate([even[:1] - 1e-9, known, even[-1:] + 1e-9]))
        worst = int(np.argmax(wide))
        if wide[worst] > longest_gap + 1.5 * step:
            start = known[worst - 1] if worst else even[0]
            told = f"column {k + 1} has a gap of {wide[worst]:.3g} s after {start:.4g} s"
            raise ValueError(f"{told}; up to {longest_gap:g} s is bridged")
        curve = PchipInterpolator(known, column[there])
        found[:, k] = curve(np.clip(even, known[0], known[-1]))
    return even, found if cutoff is None else zero_lag(found, step, cutoff)


ORDER = 2
"""Order of the filter; run both ways it is of the fourth order (Winter, Biomechanics and Motor Control, 2009, sec.
3.4)."""
TWICE = (2.0**0.5 - 1.0) ** 0.25
"""Tangent of the cut-off of two passes of order two over that of each (Winter 2009, sec. 3.4.4.2)."""
OPENSIM = 3
"""Order of OpenSim's filter, which runs both ways with the cut-off of one pass (Storage::lowpassIIR, 4.6)."""


def zero_lag(values: Float[np.ndarray, "t ..."], step: float, cutoff: float) -> Float[np.ndarray, "t ..."]:
    """Values, evenly spaced by `step` [s], without what lies above `cutoff` [Hz]; half the power passes there.

    ValueError where the cut-off is not below half the sampling frequency or the recording is too short to be filtered.
    """
    _check(step, cutoff)
    corner = float(np.arctan(np.tan(np.pi * cutoff * step) / TWICE)) / (np.pi * step)
    return _both_ways(values, step, corner, ORDER)


def as_opensim(values: Float[np.ndarray, "t ..."], step: float, cutoff: float) -> Float[np.ndarray, "t ..."]:
    """The same by OpenSim's filter: a quarter of the power passes at `cutoff`. Ends are mirrored over half the length.

    OpenSim starts from nothing beyond the mirrored ends, this filter from where it would have settled.
    """
    _check(step, cutoff)
    return _both_ways(values, step, cutoff, OPENSIM, len(values) // 2)


def _check(step: float, cutoff: float) -> None:
    if not 0.0 < cutoff < 0.5 / step:
        raise ValueError(f"a cut-off of {cutoff:g} Hz needs to lie between 0 and {0.5 / step:.3g} Hz")


def _both_ways(
    values: Float[np.ndarray, "t ..."], step: float, corner: float, order: int, mirrored: int | None = None
) -> Float[np.ndarray, "t ..."]:
    """The operations of `scipy.signal.sosfiltfilt` one by one, a part of the time after the other.

    The state of the filter at the end of a part is that at the beginning of the next, so that parts have no borders:
    the values are those of the whole, to the last digit.
    """
    low_pass = sections(order, corner, step)
    beyond = 3 * _taps(low_pass) if mirrored is None else mirrored
    if len(values) <= beyond:
        raise ValueError(f"{len(values)} samples are too few to be filtered")
    channels = values.reshape(len(values), -1)
    found = room(channels.shape)
    before = 2.0 * channels[0] - channels[beyond:0:-1]
    after = 2.0 * channels[-1] - channels[-2 : -beyond - 2 : -1]
    still = settled(low_pass)[:, :, None]
    state = still * (before[0] if beyond else channels[0])
    if beyond:
        _, state = filtered(low_pass, before, state)
    every = list(blocks(len(channels), channels.shape[1]))
    for some in every:
        found[some], state = filtered(low_pass, channels[some], state)
        release()
    if beyond:
        after, _ = filtered(low_pass, after, state)
        _, state = filtered(low_pass, after[::-1], still * after[-1])
    else:
        state = still * found[-1]
    for some in reversed(every):
        turned, state = filtered(low_pass, found[some][::-1], state)
        found[some] = turned[::-1]
        release()
    return found.reshape(values.shape)


def _taps(low_pass: Float[np.ndarray, "s six"]) -> int:
    """Taps of a filter, trailing zeros of its sections not counted."""
    without = min(int((low_pass[:, 2] == 0.0).sum()), int((low_pass[:, 5] == 0.0).sum()))
    return 2 * len(low_pass) + 1 - without
