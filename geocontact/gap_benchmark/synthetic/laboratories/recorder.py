"""A laboratory with another recorder: coarse numbers, noise that is 1/f, grows or has heavy tails, another clock."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.gap_benchmark.synthetic.course import Path
from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import Sizes, another_device, sampled, sizes
from geocontact.gap_benchmark.synthetic.laboratories.movements import Pace, paced
from geocontact.gap_benchmark.synthetic.noise import FAR_FROM_NYQUIST, USUAL, NoiseFilter, PowerLawNoise
from geocontact.gap_benchmark.synthetic.recording import Clock, Quotient, Recorder
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import samples

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
    """Of one output that had `sd`: pink, growing (white here, or nearly) or tailed."""
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
