"""What a laboratory does a little wrong, and nobody may see: constants that are told wrong, what a sampler leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import Path, through
from geocontact.gap_benchmark.synthetic.hooks import BASE
from geocontact.gap_benchmark.synthetic.plan import NotFoundError
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import followed, samples, sensed
from geocontact.gap_benchmark.synthetic.visibility import WhitenedTrial, floor, sight, whitener

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
