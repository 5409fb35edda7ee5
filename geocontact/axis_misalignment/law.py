"""Force of the explicit model as a function of everything that may be unknown in it, and its derivatives.

F = k (1 + s (p - p0)) d_tot + b d(d_tot)/dt with the cuff's pressure p as covariate of the stiffness: linear about the
mean pressure p0 of the recordings. With a compliance c of the upper arm's fixation d_tot is that of the axis under
load, no actuator pushing (`fixation`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.deflection import misalignment
from geocontact.axis_misalignment.explicit import Offsets
from geocontact.axis_misalignment.fixation import yielding
from geocontact.geometry.kernels.compile import kernel

NAMES = ("k", "x", "y", "l", "z", "b", "s", "c")
UNITS = {"k": "N/m", "x": "m", "y": "m", "l": "m", "z": "m", "b": "N s/m", "s": "1/Pa", "c": "m/N"}
LENGTHS = ("x", "y", "l", "z")
GROWING = (*LENGTHS, "c")
"""Numbers that grow with the scale."""
SCALED = ("k", "b", *GROWING)
"""Numbers that one factor changes without changing any force: k/s, b/s and s times the lengths and the compliance."""
ABSENT = {"b": 0.0, "s": 0.0, "c": 0.0}
STEP = 1e-6  # of the link, for derivatives with respect to lengths; of 1/k, for that to the compliance; of k, b, s


@kernel
def _force(
    beta: float, rate: float, pressure: float, theta: Float[np.ndarray, " 8"], n: Float[np.ndarray, " slots"]
) -> float:
    """Force of one sample; `n` is written to."""
    n[0], n[1], n[2], n[3] = theta[3], theta[4], theta[1], theta[2]
    cuff = (theta[0] * (1.0 + theta[6] * pressure), theta[5], 0.0)
    return float(yielding(beta, rate, cuff, theta[7], 0.0, 0.0, n)[0])


@kernel
def _forces(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    pressure: Float[np.ndarray, " n"],
    theta: Float[np.ndarray, " 8"],
    n: Float[np.ndarray, " slots"],
) -> Float[np.ndarray, " n"]:
    out = np.empty(beta.size)
    for i in range(beta.size):
        out[i] = _force(beta[i], rate[i], pressure[i], theta, n)
    return out


@kernel
def _by_difference(
    beta: float, rate: float, pressure: float, theta: Float[np.ndarray, " 8"], n: Float[np.ndarray, " slots"], k: int
) -> float:
    """Central difference of the force over one number; `theta` is left as it was."""
    kept = theta[k]
    h = STEP * (theta[3] if 0 < k < 5 else 1.0 / theta[0] if k == 7 else max(abs(kept), STEP))
    theta[k] = kept + h
    above = _force(beta, rate, pressure, theta, n)
    theta[k] = kept - h
    below = _force(beta, rate, pressure, theta, n)
    theta[k] = kept
    return float((above - below) / (2.0 * h))


@kernel
def _slopes(
    beta: Float[np.ndarray, " n"],
    rate: Float[np.ndarray, " n"],
    pressure: Float[np.ndarray, " n"],
    theta: Float[np.ndarray, " 8"],
    n: Float[np.ndarray, " slots"],
    fixation: bool,
) -> Float[np.ndarray, "n 8"]:
    """To k, b and s as the law is linear in them where the fixation is rigid; else by differences."""
    out = np.zeros((beta.size, 8))
    for i in range(beta.size):
        for k in range(1, 5):
            out[i, k] = _by_difference(beta[i], rate[i], pressure[i], theta, n, k)
        if fixation:
            out[i, 7] = _by_difference(beta[i], rate[i], pressure[i], theta, n, 7)
        if theta[7] == 0.0:
            n[0], n[1], n[2], n[3] = theta[3], theta[4], theta[1], theta[2]
            d, v = misalignment(beta[i], rate[i], n)
            out[i, 0], out[i, 5] = (1.0 + theta[6] * pressure[i]) * d, v
            out[i, 6] = theta[0] * pressure[i] * d
        else:
            for k in (0, 5, 6):
                out[i, k] = _by_difference(beta[i], rate[i], pressure[i], theta, n, k)
    return out


@dataclass(frozen=True, eq=False)
class ElbowLaw:
    """The law at some angles [rad], rates [rad/s] and pressures less their mean [Pa].

    `theta` holds the numbers of NAMES in that order.
    """

    beta: Float[np.ndarray, " n"]
    rate: Float[np.ndarray, " n"]
    pressure: Float[np.ndarray, " n"]

    def force(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " n"]:
        """Force [N]; finite for any finite numbers, as the base model of the gap."""
        return np.asarray(_forces(self.beta, self.rate, self.pressure, theta, offsets_of(theta).numbers))

    def slopes(self, theta: Float[np.ndarray, " 8"], *, fixation: bool = True) -> Float[np.ndarray, "n 8"]:
        """Derivative of the force with respect to each number; 0 for c without `fixation`, to save time."""
        numbers = offsets_of(theta).numbers
        return np.asarray(_slopes(self.beta, self.rate, self.pressure, theta.copy(), numbers, fixation))


def offsets_of(theta: Float[np.ndarray, " 8"]) -> Offsets:
    """Lengths among the numbers."""
    return Offsets(l=float(theta[3]), z=float(theta[4]), x=float(theta[1]), y=float(theta[2]))
