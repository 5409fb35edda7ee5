"""What a synthetic case is the answer to, and its calibration trials as they would be without noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, get_args

import numpy as np
from jaxtyping import Float
from scipy.linalg import solve_triangular

from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial as CaseTrial
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks, Outputs
from geocontact.gap_benchmark.synthetic.scene import SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import truth
from geocontact.gap_benchmark.synthetic.visibility import WhitenedTrial, jacobian


@dataclass(frozen=True)
class IdealTrial:
    """One trial, and how residuals in it weigh: by the true covariance that visibility is measured in.

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


Kind = Literal["none", "single", "pair", "outside", "absorbed", "fault", "shift"]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""none: nothing left out. single, pair: one or two rows of the vocabulary. outside: no row of it. absorbed: a row that
base parameters reproduce. fault: a discrete mistake in the data. shift: single, evaluation trials faster or larger."""


@dataclass(frozen=True)
class Label:
    """The truth about a synthetic case.

    Parameters
    ----------
    kind
        Which sort of case.
    effects
        Names of the vocabulary; () for none and outside, also where base parameters reproduce an effect they are named.
    words
        What was planted, for people.
    nats
        Visibility of each effect alone: half the squared norm of its signature on the calibration trials after the
        base parameters were refitted, whitened by sensor noise, propagated input noise and trial-to-trial variation.
        Outside the vocabulary it stands under "outside".
    nats_anew
        The same of the one effect, were everything placed anew in every trial as is usual (a millimetre, half a degree,
        a per cent of a calibration), whatever the laboratory does. None where it is not one.
    swallowed
        Share of the signature's energy (whitened by noise alone) that refitted base parameters take away.
    rmse_before, rmse_after, reduction
        Per channel, on fresh trials of the evaluation kind: the base refitted to the calibration trials, and the true
        simulator at its nominal parameters, both predicting from measured inputs. None where there is no such thing.
    window
        Shortest phase window that holds 70 % of a channel's squared gap on the fresh trials, noise left out.
    shares
        Part of each channel in the whole squared gap, channels in units of their floor.
    floor
        Per channel: sensor noise, input noise and trial-to-trial variation together, root mean square.
    faulty
        Names of the trials that hold a mistake in the data.
    imitated
        Whether some candidate reproduces an effect outside the table; who scores fills it in.
    """

    kind: Kind
    effects: tuple[str, ...]
    words: str
    nats: Mapping[str, float]
    swallowed: Mapping[str, float]
    rmse_before: Mapping[str, float | None]
    rmse_after: Mapping[str, float | None]
    reduction: Mapping[str, float | None]
    window: Mapping[str, tuple[float, float]]
    shares: Mapping[str, float]
    floor: Mapping[str, float]
    faulty: tuple[str, ...] = ()
    imitated: bool | None = None
    details: Mapping[str, str | float] = field(default_factory=dict)
    nats_anew: float | None = None

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers, words, lists and dicts, as JSON takes them."""
        return {**asdict(self), "effects": list(self.effects), "faulty": list(self.faulty)}


@dataclass(frozen=True)
class SyntheticCase:
    """A synthetic case, the truth about it, and its calibration trials without noise."""

    case: GapCase
    label: Label
    ideal: tuple[IdealTrial, ...] = ()
