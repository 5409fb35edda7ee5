"""The base model refitted to trials by bounded least squares."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

from geocontact.gap_benchmark.synthetic.hooks import Values
from geocontact.gap_benchmark.synthetic.scene import SyntheticScene

Model = Callable[[Values], Values]


def jacobian(model: Model, theta: Float[np.ndarray, " p"]) -> Float[np.ndarray, "c s p"]:
    """By central differences."""
    columns = []
    for i, value in enumerate(theta):
        step = np.zeros_like(theta)
        step[i] = 1e-4 * max(abs(value), 1e-3)
        columns.append((model(theta + step) - model(theta - step)) / (2.0 * step[i]))
    return np.stack(columns, axis=-1)


def refit(
    scene: SyntheticScene,
    models: Sequence[Model],
    measured: Sequence[Values],
    floor: Float[np.ndarray, " c"],
    starts: Sequence[Float[np.ndarray, " p"]],
) -> Float[np.ndarray, " p"]:
    """Best of the fits from `starts`: every channel divided by its floor, within the parameters' bounds."""
    low = np.array([p.lower for p in scene.parameters])
    high = np.array([p.upper for p in scene.parameters])
    there = [np.isfinite(y) for y in measured]

    def residual(theta: Float[np.ndarray, " p"]) -> Float[np.ndarray, " r"]:
        parts = [((m(theta) - y) / floor[:, None])[ok] for m, y, ok in zip(models, measured, there, strict=True)]
        return np.concatenate(parts)

    def slope(theta: Float[np.ndarray, " p"]) -> Float[np.ndarray, "r p"]:
        parts = [(jacobian(m, theta) / floor[:, None, None])[ok] for m, ok in zip(models, there, strict=True)]
        return np.concatenate(parts)

    scale = np.array([max(abs(p.start), 1e-6) for p in scene.parameters])
    inside = 1e-6 * (high - low)
    fits = [
        least_squares(
            residual,
            np.clip(start, low + inside, high - inside),
            jac=slope,
            bounds=(low, high),
            x_scale=scale,
            ftol=1e-7,
            xtol=1e-7,
            gtol=1e-7,
            max_nfev=60,
        )
        for start in starts
    ]
    return np.asarray(min(fits, key=lambda fit: float(fit.cost)).x)


def starts(scene: SyntheticScene, rng: np.random.Generator) -> list[Float[np.ndarray, " p"]]:
    """Where the parameters begin, the nominal ones, and some out of the scene's box, where it has one."""
    begin = [np.array([p.start for p in scene.parameters]), scene.theta]
    if scene.begin is not None:
        low, high = (np.array(side) for side in scene.begin)
        begin += [rng.uniform(low, high) for _ in range(3)]
    return begin
