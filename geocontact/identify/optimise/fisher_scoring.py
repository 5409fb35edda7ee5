"""Many small problems of greatest likelihood at once, each within bounds, by Fisher's scoring.

Newton's method with a positive semidefinite curvature, such as the expected instead of the observed one (Osborne 1992,
Int. Stat. Rev. 60:99), damped as Levenberg and Marquardt do where a step does not help. Parameters that lie on a bound
and are pushed out of it are left out of a step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Float, Int

from geocontact.identify.optimise.bounded_gauss_newton import CLOSE, DAMPED, LIMIT, ROUNDING, TENFOLD

Batch: TypeAlias = Float[np.ndarray, "k p"]
Scored: TypeAlias = tuple[Float[np.ndarray, " k"], Batch, Float[np.ndarray, "k p p"]]


@dataclass(frozen=True)
class ScoringResult:
    """Where each problem ended, (k, p), and its value there."""

    at: Batch
    value: Float[np.ndarray, " k"]


def least(
    scored: Callable[[Batch, Int[np.ndarray, " k"]], Scored],
    start: Batch,
    low: Float[np.ndarray, " p"],
    high: Float[np.ndarray, " p"],
    rounds: int = LIMIT,
) -> ScoringResult:
    """The least values near the starts.

    Parameters
    ----------
    scored
        Of parameters and the problems (places in `start`) they belong to: values, gradients, and positive semidefinite
        curvatures.
    start
        One row per problem.
    low, high
        Bounds of the parameters, the same for all.
    rounds
        Steps at the most.

    Raises
    ------
    ValueError
        If a problem has no finite value where it starts.
    """
    at = np.clip(start, low, high)
    going = np.arange(len(at))
    value, gradient, curved = scored(at, going)
    if not np.isfinite(value).all():
        raise ValueError(f"problem {int(np.argmin(np.isfinite(value)))} has no finite value where it starts")
    damping, idle = np.full(len(at), DAMPED), np.zeros(len(at), dtype=int)
    for _ in range(rounds):
        new = np.clip(
            at[going] + _step(at[going], gradient[going], curved[going], damping[going], low, high), low, high
        )
        tried = scored(new, going)
        gain = value[going] - tried[0]
        good = gain >= 0.0
        better, worse = going[good], going[~good]
        at[better] = new[good]
        value[better], gradient[better], curved[better] = (each[good] for each in tried)
        idle[better] = np.where(gain[good] < CLOSE, idle[better] + 1, 0)
        damping[better] = np.maximum(damping[better] / TENFOLD, ROUNDING)
        damping[worse] *= TENFOLD
        going = going[(idle[going] < 2) & (damping[going] < 1.0 / ROUNDING)]
        if not len(going):
            break
    return ScoringResult(at, value)


def _step(
    at: Batch,
    gradient: Batch,
    curved: Float[np.ndarray, "k p p"],
    damping: Float[np.ndarray, " k"],
    low: Float[np.ndarray, " p"],
    high: Float[np.ndarray, " p"],
) -> Batch:
    """Damped step of each problem; nothing for parameters that a bound holds."""
    held = ((at <= low) & (gradient > 0.0)) | ((at >= high) & (gradient < 0.0))
    matrix = np.where(held[:, :, None] | held[:, None, :], 0.0, curved)
    diagonal = np.einsum("kpp->kp", matrix)
    diagonal += np.where(held, 1.0, damping[:, None] * (diagonal + DAMPED) + np.finfo(float).tiny)
    return np.asarray(-np.linalg.solve(matrix, np.where(held, 0.0, gradient)[..., None])[..., 0])
