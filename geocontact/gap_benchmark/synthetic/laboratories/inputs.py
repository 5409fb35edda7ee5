"""A laboratory whose inputs' noise is filtered otherwise than the movement lies.

Noise is low-passed at 6 Hz under a movement that reaches beyond 11 Hz, or nobody filtered it, or every input came
through a filter of its own. The pace has harmonics, or stops and starts sharply, which no home movement does.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import another_device, sampled
from geocontact.gap_benchmark.synthetic.laboratories.movements import Pace, Speed, paced
from geocontact.gap_benchmark.synthetic.noise import FAR_FROM_NYQUIST, LOWEST, USUAL, NoiseFilter, smooth_covariance
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene

HIGHEST = 11.0
"""Frequency up to which a pace has harmonics, where samples are close enough [Hz]."""
SHARPEST, BLUNTEST = 0.02, 0.06
"""Time that a start or a stop takes [s]."""
FILTERS = ("six", "raw", "each")
PACES = ("harmonics", "starts")


def inputs_laboratory(rng: Rng, scene: SyntheticScene) -> SyntheticScene:
    """The scene with other filters and another pace."""
    scene = another_device(rng, scene)
    highest = min(HIGHEST, FAR_FROM_NYQUIST / scene.step)
    if rng.choice(PACES) == "harmonics":
        scene = paced(scene, lambda r, duration: Pace.of(duration, harmonics(r, duration, highest)))
    else:
        edge = max(float(rng.uniform(SHARPEST, BLUNTEST)), 1.5 * scene.step)
        scene = paced(scene, lambda r, duration: Pace.of(duration, starts(r, duration, edge)))
    filters = other_filters(rng, str(rng.choice(FILTERS)), len(scene.inputs), scene.step)
    noise = [
        sd * quieter(scene.step, before, after)
        for sd, before, after in zip(scene.input_noise, scene.filters, filters, strict=True)
    ]
    return sampled(rng, replace(scene, filters=filters, input_noise=np.array(noise)))


def harmonics(rng: Rng, duration: float, highest: float) -> Speed:
    """Speed with a few harmonics, the last of them near the highest frequency [Hz]; it never goes back."""
    count = int(rng.integers(3, 6))
    lowest = max(2.0, 2.0 / duration)
    low = np.exp(rng.uniform(np.log(lowest), np.log(max(highest, 1.1 * lowest)), count))
    frequency = np.append(low, rng.uniform(0.9, 1.0) * highest)
    size = rng.dirichlet(np.ones(count + 1)) * rng.uniform(0.5, 0.85)
    phase = rng.uniform(0.0, 2.0 * np.pi, count + 1)
    return lambda t: 1.0 + size @ np.sin(2.0 * np.pi * np.outer(frequency, t) + phase[:, None])


def starts(rng: Rng, duration: float, edge: float) -> Speed:
    """Speed that falls to nearly nothing and comes back within `edge` [s], two to four times in a trial."""
    times = int(rng.integers(2, 5))
    begin = (np.arange(times) + rng.uniform(0.2, 0.8, times)) / times * duration
    rest = rng.uniform(0.15, 0.35, times) * duration / times
    depth = rng.uniform(0.7, 0.95)

    def speed(t: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        away = np.abs(t[:, None] - begin) - 0.5 * rest
        return np.asarray(1.0 - depth * (0.5 - 0.5 * np.tanh(2.0 * away / edge)).max(axis=1))

    return speed


def other_filters(rng: Rng, sort: str, count: int, step: float) -> tuple[NoiseFilter, ...]:
    """Of every input."""
    if sort == "raw":
        return (NoiseFilter(0.5 / step),) * count
    if sort == "six":
        return (NoiseFilter(min(USUAL, FAR_FROM_NYQUIST / step)),) * count
    corners = np.exp(rng.uniform(np.log(LOWEST), np.log(FAR_FROM_NYQUIST / step), count))
    return tuple(NoiseFilter(float(corner), int(rng.integers(1, 5))) for corner in corners)


def quieter(step: float, before: NoiseFilter, after: NoiseFilter) -> float:
    """Factor on the noise that is left: who filters less has better sensors, half-way to an equal noise of the rate."""
    slow, quick = (smooth_covariance(1.0, 2, step, one)[2][0, 0] for one in (before, after))
    return float(min((slow / quick) ** 0.25, 1.0))
