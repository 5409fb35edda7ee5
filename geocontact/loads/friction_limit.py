"""Measured shear beside the friction limit |shear| <= μ normal of Coulomb: how often and by how much it is exceeded.

Dry friction of coefficient μ cannot pass on more. Shear beyond it is no friction of this contact: something clamps or
sticks (a strap that is sewn on, skin that is glued), part of the normal force is not measured, or a unit is wrong.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

SURE = 3.0
"""Standard deviations of the noise by which a sample must exceed the limit."""
LOADED = 0.05
"""Share of the largest normal force from which a ratio of shear to normal is formed: below it is one of two noises."""
FEWEST = 5
"""Samples from which a limit is judged."""
FEW = 0.01
"""Share of the samples that noise may put beyond the limit."""
CAUSES = "does a strap clamp, is part of the normal force not measured, or a unit another one?"


@dataclass(frozen=True)
class FrictionLimit:
    """Shear beside μ times the normal force.

    Parameters
    ----------
    friction
        The coefficient μ.
    samples
        At which both were known.
    beyond
        Share of them at which shear exceeds the limit by `SURE` standard deviations of its noise.
    first
        Index of the first of these; -1 without one.
    largest, usual
        Largest ratio of shear to normal force under load, and its median [-]; NaN without load.
    noise
        Standard deviation of white noise of the shear [N].
    """

    friction: float
    samples: int
    beyond: float
    first: int
    largest: float
    usual: float
    noise: float

    @property
    def kept(self) -> bool:
        """Whether no more samples than those of noise exceed the limit."""
        return self.beyond <= FEW


def friction_limit(
    shear: Float[np.ndarray, " t"], normal: Float[np.ndarray, " t"], friction: float, noise: float | None = None
) -> FrictionLimit:
    """Sizes of shear [N] beside normal forces [N] at the same evenly spaced times; NaN does not count.

    A normal force below 0 is none. White noise of variance s² has second differences of variance 6 s².

    Parameters
    ----------
    noise
        Of the shear as recorded [N] (`noise_of`): values interpolated to closer times have nearly none between their
        samples. From `shear` itself by default.
    """
    both: Bool[np.ndarray, " t"] = np.isfinite(shear) & np.isfinite(normal)
    size, pressed = np.abs(shear), np.maximum(normal, 0.0)
    spread = noise_of(shear) if noise is None else noise
    over = both & (size > friction * pressed + SURE * spread)
    count = int(both.sum())
    loaded = both & (pressed > LOADED * np.max(pressed[both], initial=0.0)) & (pressed > 0.0)
    ratio = size[loaded] / pressed[loaded]
    return FrictionLimit(
        friction=friction,
        samples=count,
        beyond=float(over.sum() / count) if count >= FEWEST else 0.0,
        first=int(np.argmax(over)) if over.any() else -1,
        largest=float(ratio.max()) if len(ratio) else float("nan"),
        usual=float(np.median(ratio)) if len(ratio) else float("nan"),
        noise=spread,
    )


def noise_of(values: Float[np.ndarray, " t"]) -> float:
    """Standard deviation of white noise on a smooth course, by the median of its second differences; 0 without three.

    The median of |x| of a normal distribution is 0.6745 of its standard deviation.
    """
    bends = np.diff(values, 2)
    bends = bends[np.isfinite(bends)]
    return float(np.median(np.abs(bends)) / 0.6745 / np.sqrt(6.0)) if len(bends) else 0.0
