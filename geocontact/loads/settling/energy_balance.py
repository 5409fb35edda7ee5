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
    """Work of the load while it grows slowly from 0, and the energy stored at its end [J].

    `alone`: on the axial way alone, everything else held where it came to rest under the full load; springs that this
    strains are then in neither.
    """

    work: float
    stored: float
    alone: bool = False

    @property
    def difference(self) -> float:
        """Of the work, in shares of it."""
        return abs(self.work - self.stored) / self.work


def energy_balance(bed: Bed, pull: AxialLoad, rest: Rest, free: Bool[np.ndarray, " 6"]) -> EnergyBalance | None:
    """Balance along the equilibria under smaller loads, or else along the axial way alone; None without either.

    The way of the load is y, downwards. By parts its work is F y less the integral of y over the load, taken with
    F = s^3 times the full load at Gauss-Legendre points of s: y goes with about F^(2/3) at first, which is smooth in s.

    With every coordinate free a component slides to where it conforms, and may leave that place under a smaller load:
    there are then no equilibria to follow. What is held does no work, so the same balance holds on the axial way.
    """
    values = rest.total.values
    work = _work(bed, pull, values, free)
    if work is not None:
        return EnergyBalance(work, rest.total.stored)
    only = np.zeros(6, bool)
    only[AXIAL] = True
    work = _work(bed, replace(pull, springs=np.zeros(6)), values, only)
    return None if work is None else EnergyBalance(work, rest.total.foundation.energy, alone=True)


def _work(bed: Bed, pull: AxialLoad, values: Float[np.ndarray, " 6"], free: Bool[np.ndarray, " 6"]) -> float | None:
    """Work of the load up to these coordinates [J]; None where a smaller load has no equilibrium."""
    points, weights = np.polynomial.legendre.leggauss(NODES)
    share, weight = 0.5 * (points + 1.0), 0.5 * weights
    at, ways = values, np.empty(NODES)
    for k in np.argsort(-share):
        lighter = equilibrium(bed, replace(pull, load=pull.load * float(share[k]) ** 3), at, free)
        if not lighter.converged:
            return None
        at = lighter.total.values
        ways[k] = _way(at)
    mean = float(np.sum(weight * 3.0 * share**2 * ways))
    return pull.load * (_way(values) - mean)


def _way(values: Float[np.ndarray, " 6"]) -> float:
    return -float(values[AXIAL])
