"""Power of a measured input over frequency, on an even grid, and the steps that a recorder writes values in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.trial import Trial
from geocontact.gap.levels import FEWEST, FLAT, SLIGHT


def even_grid(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " n"]:
    """Evenly spaced times over a trial, about as many as there would be without missing rows."""
    steps = max(round((time[-1] - time[0]) / float(np.median(np.diff(time)))), 1)
    return np.linspace(time[0], time[-1], steps + 1)


NUTTALL = np.array([0.3635819, 0.4891775, 0.1365995, 0.0106411])
"""Minimum four-term window of Nuttall (1981, IEEE Trans Acoust Speech Signal Process 29:84), side lobes at -98 dB.

Published terms, as those of a filter: no choice of this diagnosis.
"""


def nuttall(count: int) -> Float[np.ndarray, " n"]:
    """Nuttall's window of two samples or more, symmetric; `scipy.signal` has it, and takes 0.4 s to import."""
    phase = np.linspace(-np.pi, np.pi, count)
    found = np.zeros(count)
    for k, part in enumerate(NUTTALL):
        found += part * np.cos(k * phase)
    return found


def long_runs(trial: Trial) -> list[slice]:
    """Pieces of a trial that are no shorter than half the longest: shorter ones blur a spectrum."""
    longest = max(one.stop - one.start for one in trial.runs)
    return [one for one in trial.runs if 2 * (one.stop - one.start) >= longest]


MOST = 10  # steps that a small difference may be


def resolution(columns: Sequence[Float[np.ndarray, " _"]]) -> float:
    """Step that nearly all differences are multiples of; 0 where there is none.

    The small ones among them may be a few steps, where a channel hardly rests.
    """
    if not columns:
        return 0.0
    moves = np.abs(np.concatenate([np.diff(x) for x in columns]))
    moves = moves[moves > 0.0]
    if len(moves) < FEWEST:
        return 0.0
    small = float(np.quantile(moves, SLIGHT, method="lower"))
    for parts in range(1, MOST + 1):
        units = moves / small * parts
        if (np.abs(units - np.round(units)) > 0.1).mean() < 0.1:
            return small / parts
    return 0.0


ROUNDED = 1e-5  # of a half-range, up to which a white rest is rounding at any rate: five digits
TREND = 3  # degree of the polynomial that is taken off before the window
APART = 3  # bins from which spectral values under the window count as independent


@dataclass(frozen=True)
class Spectrum:
    """Power of one input over all trials: of unit variance for white noise of unit variance.

    Parameters
    ----------
    frequency
        Of each value [Hz].
    power
        In the input's unit squared.
    half_range
        Of the input, in its unit.
    rounding
        Standard deviation of what rounding adds at the most, in its unit.
    """

    frequency: Float[np.ndarray, " f"]
    power: Float[np.ndarray, " f"]
    half_range: float
    rounding: float


def switches(trials: Sequence[Trial], name: str) -> bool:
    """Whether an input only goes on and off, or stands still: then it is no measurement, and has no noise."""
    values = np.concatenate([trial.column(name) for trial in trials])
    return len(np.unique(values[np.isfinite(values)])) <= 2


def measured_inputs(trials: Sequence[Trial], inputs: Sequence[str]) -> list[str]:
    """Inputs that are measurements, with noise and a zero of their own."""
    return [name for name in inputs if not switches(trials, name)]


def spectrum(trials: Sequence[Trial], name: str, step: float) -> Spectrum | None:
    """Periodograms under Nuttall's window, of all trials long enough, below Nyquist's frequency of a `step` [s].

    None where there are none, where nothing moves, and of an input that only goes on and off.
    """
    from scipy.interpolate import CubicSpline

    frequency, power, values, ends = [], [], [], []
    if switches(trials, name):
        return None
    for trial in trials:
        for run in long_runs(trial):
            column, time = trial.column(name)[run], trial.time[run]
            there = np.isfinite(column)
            if there.sum() <= FEWEST:
                continue
            grid = even_grid(time[there])
            even = CubicSpline(time[there], column[there])(grid)
            u = np.linspace(-1.0, 1.0, len(grid))
            window = nuttall(len(grid))
            bent = even - np.polynomial.legendre.legval(u, np.polynomial.legendre.legfit(u, even, TREND))
            frequency.append(np.fft.rfftfreq(len(grid), grid[1] - grid[0])[APART:-1:APART])
            power.append((np.abs(np.fft.rfft(bent * window)) ** 2 / (window**2).sum())[APART:-1:APART])
            values.append(column[there])
            ends.append(np.nanmin(trial.column(name)))
            ends.append(np.nanmax(trial.column(name)))
    if not values or not np.ptp(np.concatenate(values)) > 0.0:
        return None
    half_range = 0.5 * float(np.ptp(ends))
    least = (1e-12 * half_range) ** 2
    rounding = max(resolution(values) / FLAT, ROUNDED * half_range)
    f, p = np.concatenate(frequency), np.concatenate(power) + least
    below = f < 0.5 / step  # a quicker recording than the others goes beyond
    return Spectrum(f[below], p[below], half_range, rounding) if below.any() and least > 0.0 else None
