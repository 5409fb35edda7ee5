"""Functions of coordinates that move the axes of a joint: affine, polynomial piece by piece, products of sines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Affine:
    """`slopes · q + offset`; without slopes a constant."""

    slopes: Float[np.ndarray, " k"]
    offset: float

    def __call__(self, q: Float[np.ndarray, "t k"]) -> Float[np.ndarray, " t"]:
        """Value in every frame."""
        return np.asarray(q @ self.slopes + self.offset)

    def scaled(self, factor: float) -> Affine:
        """The function times a number."""
        return Affine(factor * self.slopes, factor * self.offset)


@dataclass(frozen=True)
class Piecewise:
    """Polynomials of one coordinate, one more than there are knots; the outermost go on for ever.

    Parameters
    ----------
    knots
        Where one piece ends and the next begins, increasing.
    origins, coefficients
        Piece i is Σ `coefficients[i, n]` (q - `origins[i]`)^(d - n): the highest power comes first.
    """

    knots: Float[np.ndarray, " m"]
    origins: Float[np.ndarray, " p"]
    coefficients: Float[np.ndarray, "p d"]

    def __call__(self, q: Float[np.ndarray, "t 1"]) -> Float[np.ndarray, " t"]:
        """Value in every frame."""
        i = np.searchsorted(self.knots, q[:, 0], side="right")
        x = q[:, 0] - self.origins[i]
        value = self.coefficients[i, 0]
        for power in range(1, self.coefficients.shape[1]):
            value = value * x + self.coefficients[i, power]
        return np.asarray(value)

    def scaled(self, factor: float) -> Piecewise:
        """The function times a number."""
        return Piecewise(self.knots, self.origins, factor * self.coefficients)


@dataclass(frozen=True)
class SineProduct:
    """`factor · Π sin(q_k + phases_k)`, as points of an ellipsoid have it."""

    factor: float
    phases: tuple[float, ...]

    def __call__(self, q: Float[np.ndarray, "t k"]) -> Float[np.ndarray, " t"]:
        """Value in every frame."""
        return np.asarray(self.factor * np.prod(np.sin(q + np.array(self.phases)), axis=1))

    def scaled(self, factor: float) -> SineProduct:
        """The function times a number."""
        return SineProduct(factor * self.factor, self.phases)


JointFunction = Affine | Piecewise | SineProduct
