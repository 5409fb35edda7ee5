"""Measured inputs with their noise taken off, so that no candidate gains by smoothing them.

A low-pass filter, an inertia or a damper that a model does not have can look useful merely because it smooths the noise
of the inputs that the model is driven by. The noise of each input is estimated from what the base model misses
(`identify.covariance`), its spectrum is that of the low-pass filter that motion usually has been through, and the Wiener
filter 1 - N/P takes it off: P is the spectrum of the recording, N that of the noise. Where the signal stands far above
the noise nothing changes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.data.trial import Trial
from geocontact.identify.covariance import low_pass_power

SMOOTH = 7  # bins that the spectrum of the recording is averaged over; it was made three times as long


def denoised(trial: Trial, noise: Mapping[str, float]) -> Trial:
    """A trial with the noise of some inputs, standard deviations in their units, taken off by a Wiener filter.

    Samples are put on an even grid for it and back by linear interpolation of what was taken off; where an input was
    not measured nothing is taken off.
    """
    time = trial.time
    grid = np.linspace(time[0], time[-1], max(round((time[-1] - time[0]) / float(np.median(np.diff(time)))), 1) + 1)
    values = trial.signals.values.copy()
    for name, sd in noise.items():
        column = trial.signals.channels.index(name)
        there = np.isfinite(values[:, column])
        if there.sum() < 2 * SMOOTH:
            continue
        even = np.interp(grid, time[there], values[there, column])
        off = noise_in(even, grid[1] - grid[0], sd)
        values[there, column] -= np.interp(time[there], grid, off)
    return replace(trial, signals=replace(trial.signals, values=values))


def noise_in(values: Float[np.ndarray, " n"], step: float, sd: float) -> Float[np.ndarray, " n"]:
    """What a Wiener filter takes off evenly spaced values whose low-passed noise has this standard deviation."""
    from scipy.ndimage import uniform_filter1d

    count = len(values)
    line = np.linspace(values[0], values[-1], count)
    bent = values - line
    longer = np.concatenate([-bent[::-1][:-1], bent, -bent[::-1][1:]])
    spectrum = np.fft.rfft(longer)
    power = uniform_filter1d(np.abs(spectrum) ** 2, SMOOTH, mode="nearest")
    shape = low_pass_power(np.fft.rfftfreq(len(longer), step))
    both_sides = 2.0 * shape.sum() - shape[0]
    noise = sd**2 * len(longer) ** 2 * shape / both_sides
    share = np.minimum(noise / np.maximum(power, 1e-300), 1.0)
    return np.asarray(np.fft.irfft(share * spectrum, len(longer))[count - 1 : 2 * count - 1])
