"""Force of the explicit model as a function of everything that may be unknown in it, and its derivatives.

F = k (1 + s (p - p0)) d_tot + b d(d_tot)/dt with the cuff's pressure p as covariate of the stiffness: linear about the
mean pressure p0 of the recordings.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.deflection import misalignment
from geocontact.axis_misalignment.explicit import Offsets
from geocontact.geometry.kernels.compile import kernel

NAMES = ("k", "x", "y", "l", "z", "b", "s")
UNITS = {"k": "N/m", "x": "m", "y": "m", "l": "m", "z": "m", "b": "N s/m", "s": "1/Pa"}
LENGTHS = ("x", "y", "l", "z")
SCALED = ("k", "b", *LENGTHS)
"""Numbers that one factor changes without changing any force: k/s, b/s and s times the lengths."""
ABSENT = {"b": 0.0, "s": 0.0}
STEP = 1e-6  # of the link, for derivatives with respect to lengths


@kernel
def _moved(beta: float, rate: float, n: Float[np.ndarray, " slots"], slot: int, by: float) -> tuple[float, float]:
    """Deflection and rate with one of the link's numbers moved."""
    kept = n[slot]
    n[slot] = kept + by
    there = misalignment(beta, rate, n)
    n[slot] = kept
    return there


@kernel
def _forces(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    pressure: Float[np.ndarray, " n"],
    theta: Float[np.ndarray, " 7"],
    n: Float[np.ndarray, " slots"],
) -> Float[np.ndarray, " n"]:
    out = np.empty(beta.size)
    for i in range(beta.size):
        d, v = misalignment(beta[i], rate[i], n)
        out[i] = theta[0] * (1.0 + theta[6] * pressure[i]) * d + theta[5] * v
    return out


@kernel
def _slopes(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    pressure: Float[np.ndarray, " n"],
    theta: Float[np.ndarray, " 7"],
    n: Float[np.ndarray, " slots"],
) -> Float[np.ndarray, "n 7"]:
    out = np.empty((beta.size, 7))
    h = STEP * theta[3]
    for i in range(beta.size):
        d, v = misalignment(beta[i], rate[i], n)
        stiffness = theta[0] * (1.0 + theta[6] * pressure[i])
        out[i, 0] = (1.0 + theta[6] * pressure[i]) * d
        for column, slot in ((1, 2), (2, 3), (3, 0), (4, 1)):
            above, fast = _moved(beta[i], rate[i], n, slot, h)
            below, slow = _moved(beta[i], rate[i], n, slot, -h)
            out[i, column] = (stiffness * (above - below) + theta[5] * (fast - slow)) / (2.0 * h)
        out[i, 5] = v
        out[i, 6] = theta[0] * pressure[i] * d
    return out


@dataclass(frozen=True, eq=False)
class ElbowLaw:
    """The law at some angles [rad], rates [rad/s] and pressures less their mean [Pa].

    `theta` holds the numbers of NAMES in that order.
    """

    beta: Float[np.ndarray, " n"]
    rate: Float[np.ndarray, " n"]
    pressure: Float[np.ndarray, " n"]

    def force(self, theta: Float[np.ndarray, " 7"]) -> Float[np.ndarray, " n"]:
        """Force [N]; finite for any finite numbers, as the base model of the gap."""
        return np.asarray(_forces(self.beta, self.rate, self.pressure, theta, offsets_of(theta).numbers))

    def slopes(self, theta: Float[np.ndarray, " 7"]) -> Float[np.ndarray, "n 7"]:
        """Derivative of the force with respect to each number; to lengths by central differences."""
        return np.asarray(_slopes(self.beta, self.rate, self.pressure, theta, offsets_of(theta).numbers))


def offsets_of(theta: Float[np.ndarray, " 7"]) -> Offsets:
    """Lengths among the numbers."""
    return Offsets(l=float(theta[3]), z=float(theta[4]), x=float(theta[1]), y=float(theta[2]))
