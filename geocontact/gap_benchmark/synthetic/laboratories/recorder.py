"""Laboratories with another recorder: coarse numbers, other noise, inputs filtered otherwise than the movement.

Noise is low-passed at 6 Hz under a movement that reaches beyond 11 Hz, or nobody filtered it, or every input came
through a filter of its own. The pace has harmonics, or stops and starts sharply, which no home movement does.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import Path
from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import Sizes, another_device, sampled, sizes
from geocontact.gap_benchmark.synthetic.laboratories.movements import Pace, Speed, paced
from geocontact.gap_benchmark.synthetic.noise import (
    FAR_FROM_NYQUIST,
    LOWEST,
    USUAL,
    NoiseFilter,
    PowerLawNoise,
    smooth_covariance,
)
from geocontact.gap_benchmark.synthetic.recording import Clock, Quotient, Recorder
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import samples

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
    """Filters of every input, other than the movement's."""
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


SLOWEST, FASTEST = 25.0, 1000.0
"""Samples per second."""
MOST, MOST_OF_ALL = 1100, 2200
"""Samples of a channel, and of all outputs, in a trial; a trial has no more, since whole covariances are inverted."""
COARSEST, FINEST = 2.0, 0.05
"""Step of an output's numbers, in standard deviations of its noise."""
COARSEST_INPUT = 1.0
"""The same of an input."""
SORTS = ("pink", "growing", "tailed")
CLOCKS = (
    Clock(losing=0.0),
    Clock(uneven=0.3, losing=0.0),
    Clock(losing=1.0, alone=0.05, longest=12),
)
TAILS = 4.0
"""Degrees of freedom."""
QUARTER = 0.25
"""Share of the largest divisor at which a quotient has the noise that is stated."""


def recorder_laboratory(rng: Rng, scene: SyntheticScene) -> SyntheticScene:
    """The scene, recorded in another way."""
    scene = at_another_rate(rng, another_device(rng, scene))
    size, sort = sizes(scene, scene.path(rng, 0)), str(rng.choice(SORTS))
    noise = tuple(power_law_noise(rng, sort, one.sd) for one in scene.noise)
    recorder = Recorder(
        growth_of(rng, scene, size) if sort == "growing" else {},
        {},
        quotients_of(scene, size),
        {row: one.sd * _step(rng, COARSEST) for row, one in enumerate(noise)},
        {row: float(sd) * _step(rng, COARSEST_INPUT) for row, sd in enumerate(scene.input_noise) if sd},
    )
    laboratory = replace(scene.laboratory, recorder=recorder, clock=CLOCKS[rng.integers(len(CLOCKS))])
    return sampled(rng, replace(scene, noise=noise, laboratory=laboratory))


def at_another_rate(rng: Rng, scene: SyntheticScene) -> SyntheticScene:
    """The scene at 25 to 1000 samples per second, as far as a trial has room; what nobody filtered is filtered now."""
    quicker = float(np.exp(rng.uniform(0.0, np.log(scene.body.quickest))))
    scene = paced(scene, lambda _, duration: Pace.even(duration, quicker))
    duration = scene.path(rng, 0)(np.zeros(1)).duration
    most = min(MOST, MOST_OF_ALL / len(scene.outputs)) / (1.15 * duration)
    rate = float(np.exp(rng.uniform(np.log(SLOWEST), np.log(min(FASTEST, most)))))
    highest = FAR_FROM_NYQUIST * rate
    white = 0.5 / scene.step
    filters = tuple(
        NoiseFilter(min(USUAL if one.corner >= white else one.corner, highest), one.order) for one in scene.filters
    )
    return replace(scene, step=1.0 / rate, filters=filters)


def power_law_noise(rng: Rng, sort: str, sd: float) -> PowerLawNoise:
    """Noise of one output that had `sd`: pink, growing (white here, or nearly) or tailed."""
    sd = sd * rng.uniform(0.7, 1.4)
    if sort == "pink":
        return PowerLawNoise(sd, rng.uniform(0.7, 1.2), float(np.exp(rng.uniform(np.log(0.5), np.log(5.0)))), 0.3)
    return PowerLawNoise(sd, 0.0 if rng.random() < 0.5 else 0.5, freedom=TAILS if sort == "tailed" else np.inf)


def quotients_of(scene: SyntheticScene, size: Sizes) -> dict[int, Quotient]:
    """Every output that a laboratory gets by a division."""
    return {row: Quotient(by, QUARTER * float(size.largest[by])) for row, by in scene.body.quotients.items()}


def growth_of(rng: Rng, scene: SyntheticScene, size: Sizes) -> dict[int, float]:
    """Slope by which the noise of each output grows, but of a quotient."""
    rows = [row for row in range(len(scene.outputs)) if row not in scene.body.quotients]
    return {row: float(np.exp(rng.uniform(np.log(0.5), np.log(3.0)))) / float(size.largest[row]) for row in rows}


def hurry_of(rng: Rng, scene: SyntheticScene, path: Path) -> dict[int, float]:
    """Slope by which the noise of each output grows with its change from sample to sample, but of a quotient."""
    outputs = scene.body.recorded(scene.base_model(path(np.arange(samples(scene, path)) * scene.step))(scene.theta))
    largest = np.nanmax(np.abs(np.gradient(outputs, axis=1)), axis=1)
    rows = [row for row in range(len(scene.outputs)) if row not in scene.body.quotients]
    return {row: float(np.exp(rng.uniform(np.log(0.5), np.log(3.0)))) / float(largest[row]) for row in rows}


def _step(rng: Rng, coarsest: float) -> float:
    return float(np.exp(rng.uniform(np.log(FINEST), np.log(coarsest))))
