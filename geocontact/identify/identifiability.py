"""What data tell apart: singular values, condition and correlations of the sensitivities to several numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

SAME = 1e-6  # of the largest singular value: below, two numbers act as one
POOR = 100.0  # condition from which on estimates lean on each other


@dataclass(frozen=True, eq=False)
class Identifiability:
    """How separable a set of numbers is.

    Parameters
    ----------
    names
        What was varied.
    singular_values
        Of the sensitivities, each scaled to the unit of its own size (columns of length 1); largest first.
    condition
        Largest over smallest; infinite where at least two of them are one number to the data.
    correlation
        Of the estimates under white noise; 1 or -1 off the diagonal where they are one number.
    """

    names: tuple[str, ...]
    singular_values: Float[np.ndarray, " p"]
    condition: float
    correlation: Float[np.ndarray, "p p"]

    @property
    def verdict(self) -> str:
        """In one word."""
        if not np.isfinite(self.condition):
            return "one number"
        return "poorly separated" if self.condition > POOR else "separable"


def identifiability(names: Sequence[str], jacobian: Float[np.ndarray, "n p"]) -> Identifiability:
    """Identifiability of the numbers whose derivatives are the columns of `jacobian`; their units do not matter."""
    size = np.linalg.norm(jacobian, axis=0)
    columns = jacobian / np.where(size > 0.0, size, 1.0)
    _, values, rows = np.linalg.svd(columns, full_matrices=False)
    alike = bool(values[-1] <= SAME * values[0])
    condition = float("inf") if alike else float(values[0] / values[-1])
    return Identifiability(tuple(names), values, condition, _correlation(values, rows))


def _correlation(values: Float[np.ndarray, " p"], rows: Float[np.ndarray, "p p"]) -> Float[np.ndarray, "p p"]:
    kept = np.maximum(values, SAME * values[0])
    covariance = (rows.T / kept**2) @ rows
    sd = np.sqrt(np.diag(covariance))
    return np.asarray(np.clip(covariance / np.outer(sd, sd), -1.0, 1.0))
