"""Outputs that depend on what they were before: delayed, or passed through a low-pass.

Before the first sample an output is taken to have run straight on as it sets out, but not beyond its range in the
trial. Missing values stay missing, and a filter starts anew after them.
"""

from __future__ import annotations

import math

import numpy as np
from jaxtyping import Float

from geocontact.geometry.kernels.compile import kernel

PIECES = 4  # straight pieces that the cubic between two samples is filtered in


@kernel
def outset(time: Float[np.ndarray, " t"], y: Float[np.ndarray, " t"], first: int) -> float:
    """Slope at the first value, 0 where nothing follows it."""
    if first + 1 < y.size and np.isfinite(y[first + 1]):
        return float((y[first + 1] - y[first]) / (time[first + 1] - time[first]))
    return 0.0


@kernel
def extent(y: Float[np.ndarray, " t"]) -> tuple[float, float, int]:
    """Least and greatest value, and the place of the first; inf, -inf and the length when there is none."""
    low, high, first = np.inf, -np.inf, y.size
    for i in range(y.size):
        if np.isfinite(y[i]):
            low, high, first = min(low, y[i]), max(high, y[i]), min(first, i)
    return low, high, first


@kernel
def slope(time: Float[np.ndarray, " t"], y: Float[np.ndarray, " t"], i: int) -> float:
    """Derivative of the parabola through a sample and its neighbours; one-sided where a neighbour is missing."""
    left = i > 0 and np.isfinite(y[i - 1])
    right = i + 1 < y.size and np.isfinite(y[i + 1])
    before = (y[i] - y[i - 1]) / (time[i] - time[i - 1]) if left else 0.0
    after = (y[i + 1] - y[i]) / (time[i + 1] - time[i]) if right else before
    if not left:
        return float(after)
    if not right:
        return float(before)
    a, b = time[i] - time[i - 1], time[i + 1] - time[i]
    return float((b * before + a * after) / (a + b))


@kernel
def cubic(
    time: Float[np.ndarray, " t"], y: Float[np.ndarray, " t"], i: int, at: float, left: float, right: float
) -> float:
    """Cubic Hermite interpolation between samples i and i + 1 that have these slopes; exact at both."""
    h = time[i + 1] - time[i]
    u = (at - time[i]) / h
    if u <= 0.0:
        return float(y[i])
    if u >= 1.0:
        return float(y[i + 1])
    left, right = h * left, h * right
    step = y[i + 1] - y[i]
    return float(y[i] + u * (left + u * (3.0 * step - 2.0 * left - right + u * (left + right - 2.0 * step))))


@kernel
def between(time: Float[np.ndarray, " t"], y: Float[np.ndarray, " t"], i: int, at: float) -> float:
    """The same with the slopes of parabolas through neighbours; exact at both samples, even beside a missing one."""
    h = time[i + 1] - time[i]
    u = (at - time[i]) / h
    if u <= 0.0:
        return float(y[i])
    if u >= 1.0:
        return float(y[i + 1])
    if not (np.isfinite(y[i]) and np.isfinite(y[i + 1])):
        return np.nan
    return float(cubic(time, y, i, at, slope(time, y, i), slope(time, y, i + 1)))


@kernel
def read_at(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t c"], at: Float[np.ndarray, " t"]
) -> Float[np.ndarray, "t c"]:
    """Each column as it was, or will be, at the times `at`; after the last sample it stays as it is there."""
    out = np.full_like(values, np.nan)
    for c in range(values.shape[1]):
        y = values[:, c].copy()
        low, high, first = extent(y)
        if first == y.size:
            continue
        set_out = outset(time, y, first)
        i = 0
        for j in range(at.size):
            if at[j] < time[0]:
                run = y[first] + set_out * (at[j] - time[first])
                out[j, c] = min(max(run, low), high) if first == 0 else np.nan
                continue
            while i + 2 < y.size and time[i + 1] <= at[j]:
                i += 1
            while i > 0 and time[i] > at[j]:
                i -= 1
            out[j, c] = between(time, y, i, at[j])
    return out


@kernel
def delayed(time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t c"], delay: float) -> Float[np.ndarray, "t c"]:
    """Each column as it was `delay` seconds ago."""
    return values.copy() if delay == 0.0 else read_at(time, values, time - delay)


@kernel
def with_play(
    position: Float[np.ndarray, " t"], width: float, start: float
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """What follows a position with a play of `width` around it, and 1 where it is carried along, 0 where it rests.

    At first it lies `start` half-widths behind the middle of the play.
    """
    out, carried = np.empty(position.size), np.zeros(position.size)
    last = position[0] - start * 0.5 * width
    for k in range(position.size):
        low, high = position[k] - 0.5 * width, position[k] + 0.5 * width
        if last <= low or last >= high:
            carried[k] = 1.0
        last = min(max(last, low), high)
        out[k] = last
    return out, carried


@kernel
def decay_of_steps(
    time: Float[np.ndarray, " t"], quick: float, slow: float
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, "four t"]]:
    """Length of the pieces before each sample [s], and what `two_stages` fades by over one of them.

    These are exp(-h/slow), h/quick (0 for a wire), the mean of exp(-(1/quick - 1/slow) t) over a piece, exp(-h/quick).
    """
    length, out = np.zeros(time.size), np.zeros((4, time.size))
    for i in range(1, time.size):
        h = (time[i] - time[i - 1]) / PIECES
        length[i] = h
        out[0, i] = math.exp(-h / slow)
        if quick <= 0.0 or h / quick > 700.0:
            continue
        apart = h * (1.0 / quick - 1.0 / slow)
        out[1, i] = h / quick
        out[2, i] = -math.expm1(-apart) / apart if abs(apart) > 1e-12 else 1.0
        out[3, i] = math.exp(-h / quick)
    return length, out


@kernel
def two_stages(
    first: float,
    second: float,
    y: float,
    rise: float,
    h: float,
    quick: float,
    slow: float,
    fades: Float[np.ndarray, " four"],
) -> tuple[float, float]:
    """Both stages of a filter `h` seconds on, for an input that starts at `y` and rises at the slope `rise`.

    first' = (input - first)/slow, second' = (first - second)/quick, in closed form; quick = 0 is a wire. `fades` are
    a column of `decay_of_steps`.
    """
    end = y + rise * h
    excess = first - y + slow * rise
    one = end - slow * rise + excess * fades[0]
    if fades[1] == 0.0:
        return one, one
    settled = y - (slow + quick) * rise
    two = settled + rise * h + excess * fades[0] * fades[1] * fades[2] + (second - settled) * fades[3]
    return one, two


@kernel
def lagged(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t c"], lag: float, order: float
) -> Float[np.ndarray, "t c"]:
    """Each column behind a low-pass of `order` 1 to 2 that makes slow signals late by `lag` seconds.

    Between samples a column runs along the same cubic as in `delayed`, taken as straight over a quarter of a step: a
    lag far shorter than a step comes to the same as a delay.
    """
    out = values.copy()
    if lag == 0.0:
        return out
    quick = 0.5 * (order - 1.0) * lag
    slow = lag - quick
    length, fades = decay_of_steps(time, quick, slow)
    for c in range(values.shape[1]):
        y = values[:, c].copy()
        low, high, _ = extent(y)
        going = False
        one = two = left = right = 0.0
        for i in range(y.size):
            if not np.isfinite(y[i]):
                going = False
                continue
            right = slope(time, y, i)
            if going:
                h, start = length[i], y[i - 1]
                for piece in range(1, PIECES + 1):
                    end = cubic(time, y, i - 1, time[i - 1] + piece * h, left, right)
                    one, two = two_stages(one, two, start, (end - start) / h, h, quick, slow, fades[:, i])
                    start = end
            else:
                rise = outset(time, y, i)
                one = min(max(y[i] - slow * rise, low), high)
                two = min(max(y[i] - lag * rise, low), high)
                going = True
            left = right
            out[i, c] = two
    return out
