"""What every laboratory but the home one has of its own: other devices, other starts, a scale of its own for things."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import Path, through
from geocontact.gap_benchmark.synthetic.hooks import BASE
from geocontact.gap_benchmark.synthetic.plan import NotFoundError
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import followed, samples, sensed

OTHER = 1.5
"""Largest factor between a parameter at home and of another device."""
FARTHEST = 2.5
"""Largest factor between a parameter and where its fit starts."""
INSIDE = 0.05
"""Share of the way from a bound to the other that a parameter keeps from it."""
BENT = 0.3
"""Most that the base model may be off between samples of perfect inputs, root mean square in noise of the channel."""


@dataclass(frozen=True)
class Sizes:
    """Range of inputs and outputs, largest magnitude of outputs, along a movement."""

    inputs: Float[np.ndarray, " i"]
    outputs: Float[np.ndarray, " c"]
    largest: Float[np.ndarray, " c"]


def another_device(rng: Rng, scene: SyntheticScene) -> SyntheticScene:
    """The same kind of thing with other parameters, and somebody who starts their fit elsewhere."""
    low, high = (np.array([getattr(p, side) for p in scene.parameters]) for side in ("lower", "upper"))
    room = INSIDE * (high - low)
    theta = np.clip(scene.theta * _factors(rng, OTHER, len(low)), low + room, high - room)
    start = np.clip(theta * _factors(rng, FARTHEST, len(low)), low + room, high - room)
    scaled = np.diag(theta / scene.theta)
    parameters = tuple(replace(p, start=float(f"{s:.3g}")) for p, s in zip(scene.parameters, start, strict=True))
    return replace(scene, theta=theta, spread=scaled @ scene.spread @ scaled, parameters=parameters)


def _factors(rng: Rng, most: float, count: int) -> Float[np.ndarray, " p"]:
    return np.exp(rng.uniform(-np.log(most), np.log(most), count))


def sizes(scene: SyntheticScene, path: Path) -> Sizes:
    """Of a movement like those that will be recorded."""
    course = path(np.arange(samples(scene, path)) * scene.step)
    outputs = scene.body.recorded(scene.base_model(course)(scene.theta))
    ranges = np.nanmax(outputs, axis=1) - np.nanmin(outputs, axis=1)
    return Sizes(np.ptp(course.position, axis=1), ranges, np.nanmax(np.abs(outputs), axis=1))


def sampled(rng: Rng, scene: SyntheticScene) -> SyntheticScene:
    """The scene, if its samples are close enough; or sampling itself would leave a gap, and the draw is dropped."""
    path = scene.path(rng, 0)
    count = samples(scene, path)
    time = np.arange(count) * scene.step
    course, fine = path(time), scene.body.fine
    inputs = followed(scene, path, time, count, fine)
    between = through(time, inputs, course.duration, course.phase, course.setting)
    there = scene.body.recorded(sensed(scene, path, count, scene.theta, BASE, fine, sampler=scene.laboratory.sampler))
    off = scene.base_model(between(time))(scene.theta) - there
    noise = np.array([one.sd for one in scene.noise])
    bent = float((np.sqrt(np.nanmean(off**2, axis=1)) / noise).max())
    if bent > BENT:
        raise NotFoundError(f"between samples the base model is off by {bent:.2g} noise levels")
    return scene
