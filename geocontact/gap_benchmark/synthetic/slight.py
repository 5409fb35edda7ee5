"""Constants that are told a little wrong: by so little that nobody sees it who allows for how things usually sit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.scene import SyntheticScene
from geocontact.gap_benchmark.synthetic.visibility import WhitenedTrial, sight

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
