"""Measured inputs and their derivatives.

Inputs are recorded, often low-passed at 6 Hz, sometimes with rows missing. Positions are used as they were measured;
where an input cell is empty it is taken from the fit below. Rates come from a cubic fitted by least squares around each
sample, with tricube weights over 70 ms to either side (27 samples at 200 Hz; at the ends of a recording 140 ms to one
side), or over the five nearest samples where sampling is coarser: at 25 Hz that is the fourth-order difference.
Accelerations are rates of rates. At 200 Hz a sine keeps 99.95 % of its rate at 2 Hz, 99.3 % at 4 Hz and 97 % at 6 Hz;
white noise of the rate is a ninth of that of central differences. Samples need not be equally spaced.

Sources: Savitzky & Golay (1964) Anal. Chem. 36:1627, for equal spacing; Cleveland (1979) JASA 74:829, for the weights.
"""

from __future__ import annotations

import weakref
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.motion import Signals
from geocontact.geometry.kernels.compile import kernel

REACH = 0.07
"""Half-width of the window [s]; wider where it holds fewer than `NEIGHBOURS` samples."""
NEIGHBOURS = 5
CORE = 0.8
"""Share of the window in which neighbours count."""
DEGREE = 3
REMEMBERED = 32
"""Time axes whose weights are remembered."""
PIECE = 4000
"""Samples of the longest of them, such as inputs of a thinned trial; at 200 Hz their weights take two megabytes."""
Weights = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class DifferentiatedInputs:
    """Inputs of a trial over time with their first two derivatives, one row per input.

    Parameters
    ----------
    time
        Of each sample [s].
    inputs
        Names of the rows.
    position, rate, acceleration
        In the input's unit, per s and per s^2.
    trial
        Name of the trial, for effects that are in some trials only.
    """

    time: Float[np.ndarray, " t"]
    inputs: tuple[str, ...]
    position: Float[np.ndarray, "i t"]
    rate: Float[np.ndarray, "i t"]
    acceleration: Float[np.ndarray, "i t"]
    trial: str = ""

    def row(self, name: str) -> int:
        """Place of an input."""
        return self.inputs.index(name)


@kernel
def window(time: Float[np.ndarray, " n"], at: float, reach: float, neighbours: int) -> tuple[int, int, float]:
    """First and last + 1 sample within reach of `at`, and the reach, widened for want of neighbours or of one side.

    Neighbours count within four fifths of the reach: nearer its end their weights vanish.
    """
    reach = max(reach, 2.0 * reach - min(at - time[0], time[-1] - at))
    first = int(np.searchsorted(time, at - CORE * reach))
    last = int(np.searchsorted(time, at + CORE * reach))
    while last - first < min(neighbours, time.size):
        left = at - time[first - 1] if first > 0 else np.inf
        right = time[last] - at if last < time.size else np.inf
        if left <= right:
            first -= 1
        if right <= left:
            last += 1
        reach = max(reach, min(left, right) / CORE)
    return int(np.searchsorted(time, at - reach)), int(np.searchsorted(time, at + reach)), reach


@kernel
def solve(matrix: Float[np.ndarray, "n n"], right: Float[np.ndarray, "n i"]) -> None:
    """Gauss-Jordan elimination in place for a small positive definite matrix; `right` becomes the solution."""
    for a in range(matrix.shape[0]):
        for b in range(matrix.shape[0]):
            factor = matrix[b, a] / matrix[a, a]
            if b != a:
                for k in range(a, matrix.shape[0]):
                    matrix[b, k] -= factor * matrix[a, k]
                for c in range(right.shape[1]):
                    right[b, c] -= factor * right[a, c]
        for c in range(right.shape[1]):
            right[a, c] /= matrix[a, a]
        for k in range(a + 1, matrix.shape[0]):
            matrix[a, k] /= matrix[a, a]
        matrix[a, a] = 1.0


@kernel
def weights_of(
    time: Float[np.ndarray, " n"], at: Float[np.ndarray, " t"], reach: float, neighbours: int, degree: int
) -> tuple[Int[np.ndarray, " t"], Int[np.ndarray, " t_and_one"], Float[np.ndarray, "two w"]]:
    """First sample of each window, where its weights begin, and what samples weigh in value and first derivative."""
    first, begin, wide = np.empty(at.size, np.int64), np.zeros(at.size + 1, np.int64), np.empty(at.size)
    for i in range(at.size):
        first[i], last, wide[i] = window(time, at[i], reach, neighbours)
        begin[i + 1] = begin[i] + last - first[i]
    weights = np.zeros((2, begin[at.size]))
    for i in range(at.size):
        count = begin[i + 1] - begin[i]
        size = min(degree, count - 1) + 1
        normal, right = np.zeros((size, size)), np.zeros((size, count))
        powers = np.ones(2 * size)
        for j in range(count):
            s = (time[first[i] + j] - at[i]) / wide[i]
            weight = (1.0 - min(abs(s), 1.0) ** 3) ** 3
            for k in range(1, 2 * size):
                powers[k] = powers[k - 1] * s
            for a in range(size):
                right[a, j] = weight * powers[a]
                for b in range(size):
                    normal[a, b] += weight * powers[a + b]
        solve(normal, right)
        for a in range(min(size, 2)):
            for j in range(count):
                weights[a, begin[i] + j] = right[a, j] / wide[i] ** a
    return first, begin, weights


@kernel
def weighed(
    first: Int[np.ndarray, " t"],
    begin: Int[np.ndarray, " t_and_one"],
    weights: Float[np.ndarray, "two w"],
    values: Float[np.ndarray, "i n"],
) -> Float[np.ndarray, "two i t"]:
    """Values and derivatives as weighed sums over windows."""
    out = np.zeros((2, values.shape[0], first.size))
    for a in range(2):
        for c in range(values.shape[0]):
            for i in range(first.size):
                total = 0.0
                for j in range(begin[i + 1] - begin[i]):
                    total += weights[a, begin[i] + j] * values[c, first[i] + j]
                out[a, c, i] = total
    return out


def local_fit(
    time: Float[np.ndarray, " n"],
    values: Float[np.ndarray, "i n"],
    at: Float[np.ndarray, " t"],
    reach: float,
    neighbours: int,
    degree: int,
) -> Float[np.ndarray, "two i t"]:
    """Value and first derivative at `at` of polynomials fitted around it.

    Weights of the same times are remembered, up to `PIECE` of them; more are worked out piece by piece.
    """
    time, at, values = (np.ascontiguousarray(each, dtype=float) for each in (time, at, values))
    if at.size <= PIECE:
        return np.asarray(weighed(*_remembered(time.tobytes(), at.tobytes(), reach, neighbours, degree), values))
    pieces = (at[k : k + PIECE] for k in range(0, at.size, PIECE))
    return np.concatenate([weighed(*weights_of(time, p, reach, neighbours, degree), values) for p in pieces], axis=2)


@lru_cache(maxsize=REMEMBERED)
def _remembered(time: bytes, at: bytes, reach: float, neighbours: int, degree: int) -> Weights:
    return weights_of(np.frombuffer(time), np.frombuffer(at), reach, neighbours, degree)


def differentiated_inputs(
    time: Float[np.ndarray, " t"], inputs: tuple[str, ...], position: Float[np.ndarray, "i t"], reach: float = REACH
) -> DifferentiatedInputs:
    """Differentiate measured inputs by local fits over `reach` to either side [s].

    ValueError when an input was never measured.
    """
    fitted = np.empty((2, *position.shape))
    for row, name in enumerate(inputs):
        there = np.isfinite(position[row])
        if not there.any():
            raise ValueError(f"input {name} has no value in this trial; it needs at least one")
        known = np.ascontiguousarray(position[row : row + 1, there])
        fitted[:, row : row + 1] = local_fit(time[there], known, time, reach, NEIGHBOURS, DEGREE)
    place, rate = fitted
    acceleration = local_fit(time, np.ascontiguousarray(rate), time, reach, NEIGHBOURS, DEGREE)[1]
    return DifferentiatedInputs(time, inputs, np.where(np.isfinite(position), position, place), rate, acceleration)


def by_differences(
    time: Float[np.ndarray, " t"], inputs: tuple[str, ...], position: Float[np.ndarray, "i t"]
) -> DifferentiatedInputs:
    """Inputs as they were measured, with central differences: what a simulator sees that smooths nothing.

    Empty cells are bridged by straight lines; ValueError when an input was never measured.
    """
    filled = position.copy()
    for row, name in enumerate(inputs):
        there = np.isfinite(position[row])
        if not there.any():
            raise ValueError(f"input {name} has no value in this trial; it needs at least one")
        filled[row] = np.interp(time, time[there], position[row, there])
    if len(time) == 1:
        return DifferentiatedInputs(time, inputs, filled, np.zeros_like(filled), np.zeros_like(filled))
    rate = np.gradient(filled, time, axis=1)
    return DifferentiatedInputs(time, inputs, filled, rate, np.gradient(rate, time, axis=1))


def rate_of_waves(frequency: Float[np.ndarray, " f"], step: float, reach: float = REACH) -> Float[np.ndarray, " f"]:
    """Amplitude of the rate that a unit sine of each frequency [Hz] is given far from the ends [1/s].

    2 π f where the smoothing leaves it alone, less above; |sin(2 π f Δ)|/Δ for central differences.
    """
    if not reach:
        return np.asarray(np.abs(np.sin(2.0 * np.pi * frequency * step)) / step)
    half = max(int(np.ceil(2.0 * reach / step)), NEIGHBOURS)
    time = step * np.arange(-half, half + 1)
    weights = local_fit(time, np.eye(len(time)), np.zeros(1), reach, NEIGHBOURS, DEGREE)[1, :, 0]
    return np.asarray(np.abs(np.sin(2.0 * np.pi * frequency[:, None] * time) @ weights))


_SEEN: dict[tuple[int, tuple[str, ...], float], tuple[weakref.ref[Signals], DifferentiatedInputs]] = {}


def recorded(signals: Signals, inputs: tuple[str, ...], reach: float = REACH) -> DifferentiatedInputs:
    """Movement of a recording; remembered as long as the recording lives, which must not be altered.

    Rates by local fits over `reach` to either side [s], by central differences where it is 0.
    """
    key = (id(signals), inputs, reach)
    seen = _SEEN.get(key)
    if seen is not None and seen[0]() is signals:
        return seen[1]
    position = np.array([signals.column(name) for name in inputs])
    found = (
        differentiated_inputs(signals.time, inputs, position, reach)
        if reach
        else by_differences(signals.time, inputs, position)
    )
    _SEEN[key] = (weakref.ref(signals, lambda _: _SEEN.pop(key, None)), found)
    return found
