"""What a sampler alone leaves of a gap; a laboratory whose sampler would show is none."""

from __future__ import annotations

import numpy as np

from geocontact.gap_benchmark.synthetic.course import Path, through
from geocontact.gap_benchmark.synthetic.hooks import BASE
from geocontact.gap_benchmark.synthetic.plan import NotFoundError
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene
from geocontact.gap_benchmark.synthetic.slight import UNSEEN
from geocontact.gap_benchmark.synthetic.trials import followed, samples, sensed
from geocontact.gap_benchmark.synthetic.visibility import floor, sight, whitener


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
