"""What the noise of a channel may grow with, and how much of that its recording shows.

Noise of a standard deviation b |y| is white noise whose size is known but for b. For y the recording is taken, smoothed
over a few samples, and not the prediction of a model: it is the same for every model, so that none gains by predicting
less, and it has the effect in it that a base model misses. With a sample as it was recorded its noise would decide what
it weighs: one that is too high would weigh less than one that is as much too low.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.ndimage import uniform_filter1d

from geocontact.identify.noise.typical_noise import typical_noise

ASIDE = 4  # samples to either side that the recording is smoothed over
ORDER = 4  # of differences that show noise beside a movement


def signal_size(outputs: Sequence[Float[np.ndarray, "_ c"]]) -> list[Float[np.ndarray, "_ c"]]:
    """Per trial, the magnitude of each channel's mean over `ASIDE` samples to either side; 0 where nothing is known."""
    found = []
    for each in outputs:
        there = np.isfinite(each)
        total, count = (
            uniform_filter1d(x.astype(float), 2 * ASIDE + 1, axis=0, mode="constant")
            for x in (np.where(there, each, 0.0), there)
        )
        found.append(np.abs(np.divide(total, count, out=np.zeros_like(total), where=count > 1e-9)))
    return found


def seen_growth(
    outputs: Sequence[Float[np.ndarray, "_ c"]], spread: Sequence[Float[np.ndarray, "_ c"]]
) -> Float[np.ndarray, " c"]:
    """Noise of each channel per unit of its signal, as the recording shows it; 0 where it does not grow.

    Fourth differences of white noise have 70 times its variance; a movement of frequency f leaves (2π f step)⁴ of
    itself in them, less than a thousandth from 36 samples per period on. Their typical squares in the third of the
    samples with the largest signal and in that with the smallest differ by b² times the difference of its squares.

    Parameters
    ----------
    outputs
        Measured, per trial.
    spread
        How many times its level the noise of each sample is for other reasons (`quotient_noise`).
    """
    grown = np.zeros(outputs[0].shape[1])
    sizes = signal_size(outputs)
    for c in range(len(grown)):
        rows = [_differences(y[:, c], size[:, c], s[:, c]) for y, size, s in zip(outputs, sizes, spread, strict=True)]
        rough, size = np.concatenate(rows, axis=1)
        low, high = np.quantile(size, np.array([1.0, 2.0]) / 3.0) if len(size) else (0.0, 0.0)
        if high > low:
            parts = size <= low, size >= high
            noise = [typical_noise(rough[part], ORDER) ** 2 for part in parts]
            signal = [np.mean(size[part] ** 2) for part in parts]
            grown[c] = np.sqrt(max(noise[1] - noise[0], 0.0) / (signal[1] - signal[0]))
    return grown


def _differences(
    values: Float[np.ndarray, " t"], size: Float[np.ndarray, " t"], spread: Float[np.ndarray, " t"]
) -> Float[np.ndarray, "two m"]:
    """Fourth differences where all five samples were measured, and the signal's size there, in levels of the noise."""
    half = ORDER // 2
    rough = np.diff(values, ORDER)
    middle = slice(half, len(values) - half)
    both = np.stack([rough, size[middle]])[:, : len(rough)] / spread[middle]
    return np.asarray(both[:, np.isfinite(rough)])
