"""Hum of the electric mains in recorded outputs: part of the noise, a sine of its own in every trial.

Hum has the frequency of the mains, 50 or 60 Hz, as sampling shows it: the columns are sines at the times of the
samples, so that sampling folds them as it folds the hum, and unevenly sampled hum is no line at all. Size and phase are
a trial's own (it begins anywhere in the mains' period); a sine and a cosine with independent normal weights have both.
They are directions like those of `gap.case.placement`, their sizes estimated from the trials with what is usual.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

MAINS = (50.0, 60.0)  # Hz
HUM = 0.3  # root mean square, in noise levels of the channel, that hum of either frequency usually has
WAVES = (np.cos, np.sin)  # of each frequency
HUMMING = 2.0  # bins about such a frequency, or where sampling folds it to, that are hum


def wave_count(channels: int) -> int:
    """How many waves that many outputs have."""
    return channels * len(MAINS) * len(WAVES)


def hum(time: Float[np.ndarray, " t"], rough: Float[np.ndarray, " c"]) -> Float[np.ndarray, "t c k"]:
    """What one usual standard deviation of each wave adds to the outputs, in their units: channel after channel.

    Parameters
    ----------
    time
        Of the samples [s].
    rough
        Noise level of each output, in its unit.
    """
    turns = 2.0 * np.pi * (time - time[0])[:, None] * np.array(MAINS)
    waves = np.concatenate([wave(turns) for wave in WAVES], axis=1)
    waves = waves - waves.mean(axis=0)  # sampled once or so in a period it is a zero of the output, which is known
    found = np.zeros((len(time), len(rough), len(rough), wave_count(1)))
    for c, level in enumerate(rough):
        found[:, c, c] = HUM * level * waves
    return found.reshape(len(time), len(rough), -1)


def at_mains(count: int, samples: int, step: float) -> Bool[np.ndarray, " f"]:
    """Which of `count` frequencies of so many samples, every `step` [s], are those of the mains or of their images."""
    cycles = np.array(MAINS) * step
    image = np.abs(cycles - np.round(cycles)) * samples
    return np.asarray((np.abs(np.arange(count)[:, None] - image) <= HUMMING).any(axis=1))
