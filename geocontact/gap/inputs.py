"""Measured inputs with their noise taken off, so that no candidate gains by smoothing them.

A low-pass filter, an inertia or a damper that a model does not have can look useful merely because it smooths the noise
of the inputs that the model is driven by. The noise of each input is estimated from what the base model misses
(`identify.covariance`), its spectrum is that of the low-pass filter that motion usually has been through, and the
Wiener filter 1 - N/P takes it off: P is the spectrum of the recording, N that of the noise. Both hold for a stretch of
it: a movement that sets out sharply after a rest keeps its high frequencies, and the rest loses its noise. Where the
signal stands far above the noise nothing changes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from jaxtyping import Complex, Float

from geocontact.data.trial import Trial
from geocontact.gap.grids import even_grid
from geocontact.identify.low_pass import LowPass

PLATEAU = (0.25, 0.42, 0.58, 0.75, 0.92)  # of the corner
FLAT = 2.5  # largest over smallest power of a plateau
SMOOTH = 5  # bins that the spectrum of a stretch is averaged over
PERIODS, FEWEST = 8.0, 8  # of the corner in a stretch, and samples in a quarter of it at the least
WINDOWS = 1.5  # sum of the squares of Hann windows that stand a quarter of their width apart


def denoised(trial: Trial, noise: Mapping[str, float], passed: LowPass) -> Trial:
    """A trial with the noise of some inputs, standard deviations in their units, taken off by a Wiener filter.

    `passed` is the filter that the inputs came through.

    Samples are put on an even grid for it and back by linear interpolation of what was taken off; where an input was
    not measured nothing is taken off.
    """
    time, grid = trial.time, even_grid(trial.time)
    values = trial.signals.values.copy()
    for name, sd in noise.items():
        column = trial.signals.channels.index(name)
        there = np.isfinite(values[:, column])
        if there.sum() < 4 * FEWEST:
            continue
        even = np.interp(grid, time[there], values[there, column])
        off = noise_in(even, grid[1] - grid[0], sd, passed)
        values[there, column] -= np.interp(time[there], grid, off)
    return replace(trial, signals=replace(trial.signals, values=values))


def seen_noise(trials: Sequence[Trial], name: str, passed: LowPass) -> float | None:
    """Noise of an input as its spectrum over all trials shows it, None where the movement hides it."""
    recordings = []
    for trial in trials:
        column, grid = trial.column(name), even_grid(trial.time)
        there = np.isfinite(column)
        if there.sum() > 4 * FEWEST:
            recordings.append((np.interp(grid, trial.time[there], column[there]), float(grid[1] - grid[0])))
    return plateau(recordings, passed) if recordings else None


def plateau(recordings: Sequence[tuple[Float[np.ndarray, " _"], float]], passed: LowPass) -> float | None:
    """Standard deviation of an input's noise where its spectrum shows it, else None.

    A movement slower than the low-pass filter leaves a plateau of noise between its own frequencies and the corner:
    over the bands from a quarter of it up to it power per power let through is the same. `recordings` are evenly
    spaced values and their step [s].
    """
    levels = []
    for low, high in pairwise(passed.corner * share for share in PLATEAU):
        power = []
        for values, step in recordings:
            spectrum, frequency, scale = _spectrum(values, step, passed)
            inside = (frequency >= low) & (frequency < high)
            if inside.any():
                power.append(float(np.mean(np.abs(spectrum[inside]) ** 2 / passed.power(frequency[inside])) / scale))
        if not power:
            return None
        levels.append(float(np.mean(power)))
    return float(np.sqrt(np.mean(levels))) if max(levels) < FLAT * min(levels) else None


def _spectrum(
    values: Float[np.ndarray, " n"], step: float, passed: LowPass
) -> tuple[Complex[np.ndarray, " f"], Float[np.ndarray, " f"], float]:
    """Windowed spectrum, its frequencies, and what its power is for unit variance where the filter lets all through."""
    count = len(values)
    window = np.blackman(count)
    spectrum = np.fft.rfft((values - np.linspace(values[0], values[-1], count)) * window)
    frequency = np.fft.rfftfreq(count, step)
    return spectrum, frequency, float((window**2).sum() * count / (2.0 * passed.power(frequency).sum()))


def noise_in(values: Float[np.ndarray, " n"], step: float, sd: float, passed: LowPass) -> Float[np.ndarray, " n"]:
    """What a Wiener filter takes off evenly spaced values whose low-passed noise has this standard deviation.

    It works on stretches of `PERIODS` periods of the corner, less a cubic, a quarter of a stretch apart, weighed by a
    Hann window before and after so that they add up to the whole (Portnoff, IEEE Trans. Acoust. Speech Signal Process.
    28:55, 1980).
    """
    from scipy.ndimage import uniform_filter1d

    hop = max(round(0.25 * PERIODS / (passed.corner * step)), FEWEST)
    width = 4 * hop
    longer = np.pad(values, (width, 2 * width), mode="reflect", reflect_type="odd")
    place = (np.arange(width) + 0.5) / width
    window = np.sin(np.pi * place) ** 2
    slow, _ = np.linalg.qr(np.vander(2.0 * place - 1.0, 4))
    shape = passed.power(np.fft.rfftfreq(width, step))
    noise = sd**2 * float(window @ window) * width * shape / (2.0 * shape.sum() - shape[0])
    off = np.zeros(len(longer))
    for begin in range(0, len(longer) - width + 1, hop):
        stretch = longer[begin : begin + width]
        spectrum = np.fft.rfft(window * (stretch - slow @ (slow.T @ stretch)))
        power = uniform_filter1d(np.abs(spectrum) ** 2, SMOOTH, mode="nearest")
        share = np.minimum(noise / np.maximum(power, 1e-300), 1.0)
        off[begin : begin + width] += window * np.fft.irfft(share * spectrum, width)
    return off[width : width + len(values)] / WINDOWS
