"""The calibration trials of a case as they would be without noise and without trial-to-trial variation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.linalg import solve_triangular

from geocontact.data.motion import Signals
from geocontact.data.trial import Trial as CaseTrial
from geocontact.gap_benchmark.synthetic.base_fit import jacobian
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks, Outputs
from geocontact.gap_benchmark.synthetic.scene import SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import truth
from geocontact.gap_benchmark.synthetic.visibility import WhitenedTrial


@dataclass(frozen=True)
class IdealTrial:
    """One trial, and how residuals in it weigh: by the true covariance that visibility is told in.

    Parameters
    ----------
    trial
        True inputs; outputs of the true simulator at its nominal parameters.
    effect
        What was planted alone: outputs less those without it, NaN where one of them is.
    nominal
        Those parameters by name.
    factor
        Lower Cholesky factor of noise and input noise, channel after channel.
    directions, gains
        Of trial-to-trial variation in these units: left singular vectors, and 1 - 1/sqrt(1 + s²) of each.
    """

    trial: CaseTrial
    effect: Outputs
    nominal: Mapping[str, float]
    factor: Float[np.ndarray, "n n"]
    directions: Float[np.ndarray, "n p"]
    gains: Float[np.ndarray, " p"]

    def __call__(self, values: Float[np.ndarray, "t c q"]) -> Float[np.ndarray, "n q"]:
        """Whitened columns."""
        columns = np.swapaxes(values, 0, 1).reshape(-1, values.shape[-1])
        white = solve_triangular(self.factor, columns, lower=True)
        return np.asarray(white - self.directions @ (self.gains[:, None] * (self.directions.T @ white)))


def ideal(scene: SyntheticScene, trials: Sequence[WhitenedTrial], hooks: Hooks, fine: int) -> tuple[IdealTrial, ...]:
    """What is hooked in, as a perfect laboratory would see it."""
    return tuple(_ideal(scene, one, hooks, fine, f"t{i + 1:02d}") for i, one in enumerate(trials))


def _ideal(scene: SyntheticScene, one: WhitenedTrial, hooks: Hooks, fine: int, name: str) -> IdealTrial:
    grid = np.arange(one.count) * scene.step
    outputs = truth(scene, one.path, one.count, scene.theta, hooks, fine)
    without = truth(scene, one.path, one.count, scene.theta, BASE, fine)
    course = one.path(grid)
    values = np.column_stack([*course.position, *outputs])
    varied = np.nan_to_num(jacobian(one.model, scene.theta)).reshape(-1, len(scene.theta))
    varied = solve_triangular(one.factor, varied, lower=True) @ np.linalg.cholesky(scene.spread)
    moved = solve_triangular(one.factor, one.placed.reshape(len(varied), -1), lower=True)
    varied = np.column_stack([varied, moved])
    directions, singular, _ = np.linalg.svd(varied, full_matrices=False)
    return IdealTrial(
        CaseTrial(name, Signals(grid, values, (*scene.inputs, *scene.outputs), scene.units), course.setting),
        outputs - without,
        {p.name: float(value) for p, value in zip(scene.parameters, scene.theta, strict=True)},
        one.factor,
        directions,
        1.0 - 1.0 / np.sqrt(1.0 + singular**2),
    )
