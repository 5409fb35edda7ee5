"""What every laboratory but the home one has of its own: devices, places of sensors, and constants slightly wrong.

Constants and zeros of inputs vary from trial to trial as base parameters do, and so do gain and zero of a channel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import Path, through
from geocontact.gap_benchmark.synthetic.hooks import BASE
from geocontact.gap_benchmark.synthetic.laboratory import Placement
from geocontact.gap_benchmark.synthetic.plan import NotFoundError
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import followed, samples, sensed
from geocontact.gap_benchmark.synthetic.visibility import WhitenedTrial, floor, placed, sight, varied, whitener

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
    """Sizes of a movement like those that will be recorded."""
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


LENGTH, ANGLE = 1e-3, np.radians(0.5)
"""Standard deviation of a length [m], of an angle [rad]."""
INPUT_ZERO = 0.01
"""Standard deviation of the zero of an input that is neither, as a share of its range."""
GAIN, ZERO = 0.01, 0.005
"""Standard deviations of the gain of an output [-] and of its zero, as a share of its range."""
CAREFUL, CARELESS = 0.7, 1.3
"""Laboratories differ: range of the factor on all of these."""
SEEN = 0.05
"""Root mean square change of an output, as a share of its largest magnitude, that somebody would see."""
FLAG = "-"
"""Unit of an input that has no zero that could be off."""


def placement_laboratory(rng: Rng, scene: SyntheticScene) -> SyntheticScene:
    """The scene, placed anew in every trial."""
    scene = another_device(rng, scene)
    size, care = sizes(scene, scene.path(rng, 0)), rng.uniform(CAREFUL, CARELESS)
    placement = noticed(scene, scene.path(rng, 0), placement_of(scene, size, care))
    return sampled(rng, replace(scene, laboratory=replace(scene.laboratory, placement=placement)))


def placed_as_usual(scene: SyntheticScene, path: Path, count: int) -> Float[np.ndarray, "c s q"]:
    """What each thing that sits elsewhere adds to the outputs along a movement, by one usual standard deviation.

    Of a scene that has a placement of its own or none; nothing is drawn for it. What else varies there is added.
    """
    placement = noticed(scene, path, placement_of(scene, sizes(scene, path), 1.0))
    anew = replace(scene, laboratory=replace(scene.laboratory, placement=placement))
    return varied(anew, path, count)


def placement_of(scene: SyntheticScene, size: Sizes, care: float) -> Placement:
    """Standard deviations of everything that may sit elsewhere."""
    known = {"m": LENGTH, "rad": ANGLE}
    units = scene.units[: len(scene.inputs)]
    inputs = {
        row: care * known.get(unit, INPUT_ZERO * float(size.inputs[row]))
        for row, unit in enumerate(units)
        if unit != FLAG
    }
    rows = range(len(scene.outputs))
    return Placement(
        dict.fromkeys(scene.body.lengths, care * LENGTH),
        inputs,
        dict.fromkeys(rows, care * GAIN),
        {row: care * ZERO * float(size.outputs[row]) for row in rows},
    )


def noticed(scene: SyntheticScene, path: Path, placement: Placement) -> Placement:
    """The same, but nothing so far off that whoever measures would see it and place it better."""
    course = path(np.arange(samples(scene, path)) * scene.step)
    outputs = scene.body.recorded(scene.base_model(course)(scene.theta))
    changed = placed(replace(scene, laboratory=replace(scene.laboratory, placement=placement)), course)
    changed = np.where(np.isfinite(outputs)[..., None], changed, np.nan)
    share = np.sqrt(np.nanmean(changed**2, axis=1)) / np.nanmax(np.abs(outputs), axis=1)[:, None]
    return placement.times(np.minimum(1.0, SEEN / np.maximum(share.max(axis=0), 1e-12)))


UNSEEN = 1.5
"""Most that they may show once base parameters were refitted [nats]."""
ROUNDS = 3
"""How often they are made less, since what they show is not quite quadratic."""


def slightly_wrong(
    scene: SyntheticScene, trials: Sequence[WhitenedTrial], floors: Float[np.ndarray, " c"]
) -> SyntheticScene:
    """The scene, its standing errors made so small that they show at most `UNSEEN` in the calibration trials.

    Parameters
    ----------
    scene
        With standing errors or none.
    trials, floors
        Whitened as if all were placed anew in every trial.
    """
    for _ in range(ROUNDS):
        standing = scene.laboratory.standing
        if not len(standing):
            return scene
        shifted = standing.shifted(scene.numbers(scene.theta))
        planted = [
            scene.body.recorded(
                scene.body.base_model(one.path(np.arange(one.count) * scene.step), shifted)(scene.theta)
            )
            for one in trials
        ]
        seen = sight(scene, trials, planted, floors).nats
        if seen <= UNSEEN:
            return scene
        less = standing.times(np.full(len(standing), 0.9 * np.sqrt(UNSEEN / seen)))
        scene = replace(scene, laboratory=replace(scene.laboratory, standing=less))
    return scene


def sampled_unseen(rng: Rng, scene: SyntheticScene, trials: int) -> SyntheticScene:
    """The scene, if its sampler shows less than `UNSEEN` in so many trials like one of them; or the draw is dropped."""
    if scene.laboratory.sampler:
        seen = sampling_gap(scene, scene.path(rng, 0))
        if seen * trials > UNSEEN:
            raise NotFoundError(f"the sampler alone shows {seen:.2g} nats in a trial")
    return scene


def sampling_gap(scene: SyntheticScene, path: Path) -> float:
    """Visibility of what differs between the base model at sampled inputs and the sampled truth [nats].

    No noise, nothing planted, and parameters refitted to this movement.
    """
    count, fine, sampler = samples(scene, path), scene.body.fine, scene.laboratory.sampler
    time = np.arange(count) * scene.step
    course = path(time)
    inputs = followed(scene, path, time, count, fine)
    again = through(time, inputs, course.duration, course.phase, course.setting)(time)
    true = scene.body.recorded(sensed(scene, path, count, scene.theta, BASE, fine, sampler=sampler))
    one = whitener(scene, path)
    planted = one.outputs + true - scene.base_model(again)(scene.theta)
    return sight(scene, (one,), (planted,), floor(scene, (one,))).nats
