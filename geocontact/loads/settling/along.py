"""Equilibrium in every frame of a motion, each started from the one before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.geometry.surface import Surface
from geocontact.loads.settling.coordinates import AXIAL, placed_at
from geocontact.loads.settling.first_touch import pressing
from geocontact.loads.settling.newton import Rest, equilibrium
from geocontact.loads.settling.potential import AxialLoad, Bed


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame: what was asked for, and where it came to rest; None where the bodies miss each other."""

    pull: AxialLoad
    rest: Rest | None

    @property
    def converged(self) -> bool:
        """Whether the equilibrium was found."""
        return self.rest is not None and self.rest.converged


def settle_along(
    bed: Bed,
    fixed: Surface,
    wanted: Float[np.ndarray, "t 6"],
    load: Float[np.ndarray, " t"],
    springs: Float[np.ndarray, " 6"],
    free: Bool[np.ndarray, " 6"],
    each: Callable[[Frame], None],
) -> list[Frame]:
    """Equilibrium of each frame.

    Parameters
    ----------
    wanted
        Coordinates of the motion [m, rad]: held ones stay there, springs are at rest there, the search begins there.
    load
        Axial load of each frame [N], > 0.
    springs
        Stiffness of each coordinate [N/m, N m/rad].
    each
        Is told of every frame as soon as it is found; what it raises ends the work.
    """
    frames: list[Frame] = []
    off = np.zeros(6)
    for k, values in enumerate(wanted):
        pull = AxialLoad(float(load[k]), springs, values)
        rest = _found(bed, fixed, pull, values + off, free) if off.any() else None
        if rest is None or not rest.converged:
            at = pressing(bed, values, fixed)
            rest = rest if at is None else _found(bed, fixed, pull, at, free)
        frames.append(Frame(pull, rest))
        each(frames[-1])
        if rest is not None and rest.converged:
            off = np.where(free, rest.total.values - values, 0.0)
    return frames


def _found(
    bed: Bed, fixed: Surface, pull: AxialLoad, start: Float[np.ndarray, " 6"], free: Bool[np.ndarray, " 6"]
) -> Rest | None:
    """Down onto the layer, then to rest under the load with nothing but the axial way free, then to rest."""
    touches = bed.state(placed_at(start, bed.point)).energy > 0.0
    at = start if touches else pressing(bed, start, fixed)
    if at is None:
        return None
    lowered = equilibrium(bed, replace(pull, springs=np.zeros(6)), at, free & _only_axial())
    return equilibrium(bed, pull, lowered.total.values, free)


def _only_axial() -> Bool[np.ndarray, " 6"]:
    only = np.zeros(6, bool)
    only[AXIAL] = True
    return only
