"""Whether the work of the load is what the foundation stores: a check of forces, energy and equilibria together."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.loads.settling.coordinates import AXIAL
from geocontact.loads.settling.newton import Rest, equilibrium
from geocontact.loads.settling.potential import AxialLoad, Bed

NODES = 8


@dataclass(frozen=True)
class EnergyBalance:
    """Work of the load while it grows slowly from 0, and the energy of layer and springs at its end [J]."""

    work: float
    stored: float

    @property
    def difference(self) -> float:
        """Of the work, in shares of it."""
        return abs(self.work - self.stored) / self.work


def energy_balance(bed: Bed, pull: AxialLoad, rest: Rest, free: Bool[np.ndarray, " 6"]) -> EnergyBalance | None:
    """Balance along the equilibria under smaller loads; None where one of them is not found.

    The way of the load is y, downwards. By parts its work is F y less the integral of y over the load, taken with
    F = s^3 times the full load at Gauss-Legendre points of s: y goes with about F^(2/3) at first, which is smooth in s.
    """
    points, weights = np.polynomial.legendre.leggauss(NODES)
    share, weight = 0.5 * (points + 1.0), 0.5 * weights
    at, ways = rest.total.values, np.empty(NODES)
    for k in np.argsort(-share):
        lighter = equilibrium(bed, replace(pull, load=pull.load * float(share[k]) ** 3), at, free)
        if not lighter.converged:
            return None
        at = lighter.total.values
        ways[k] = _way(at)
    mean = float(np.sum(weight * 3.0 * share**2 * ways))
    return EnergyBalance(pull.load * (_way(rest.total.values) - mean), rest.total.stored)


def _way(values: Float[np.ndarray, " 6"]) -> float:
    return -float(values[AXIAL])
