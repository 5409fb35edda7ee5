"""Energy of a loaded component on an elastic foundation, with its derivatives to the coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.geometry.surface import Surface
from geocontact.loads.foundation import Layer
from geocontact.loads.foundation_stiffness import FoundationState, foundation_state
from geocontact.loads.settling.coordinates import AXIAL, Placed, placed_at


@dataclass(frozen=True, eq=False)
class Bed:
    """A rigid component over an elastic layer.

    Parameters
    ----------
    layer
        Of FIXED.
    moving, normals
        The component and its `corner_normals`.
    point
        Of MOVING, in its frame [m]: its translations are the coordinates, and the load acts there.
    """

    layer: Layer
    moving: Surface
    normals: Float[np.ndarray, "m 3 3"]
    point: Float[np.ndarray, " 3"]

    def state(self, at: Placed) -> FoundationState:
        """Energy, slope and stiffness at a place."""
        return foundation_state(self.layer, self.moving, self.normals, at.rotation, at.translation, at.point)


@dataclass(frozen=True, eq=False)
class AxialLoad:
    """What acts on the component besides the foundation.

    Parameters
    ----------
    load
        Towards FIXED, along -y of its frame [N].
    springs
        Stiffness of each coordinate [N/m, N m/rad]; 0 without.
    rest
        Coordinates at which the springs are at rest [m, rad].
    """

    load: float
    springs: Float[np.ndarray, " 6"]
    rest: Float[np.ndarray, " 6"]


@dataclass(frozen=True, eq=False)
class Total:
    """Energy of everything at some coordinates.

    Parameters
    ----------
    values
        The coordinates [m, rad].
    potential
        Stored energy and the load's [J].
    slope, stiffness
        First and second derivative to the coordinates: slope 0 is equilibrium.
    springs
        Energy of the springs [J].
    foundation
        State of the layer.
    """

    values: Float[np.ndarray, " 6"]
    potential: float
    slope: Float[np.ndarray, " 6"]
    stiffness: Float[np.ndarray, "6 6"]
    springs: float
    foundation: FoundationState

    @property
    def stored(self) -> float:
        """Energy of layer and springs [J]."""
        return self.foundation.energy + self.springs


def total_at(bed: Bed, pull: AxialLoad, values: Float[np.ndarray, " 6"]) -> Total:
    """Energy and its derivatives at `values`."""
    at = placed_at(values, bed.point)
    state = bed.state(at)
    slope, stiffness = at.to_coordinates(state.slope, state.stiffness)
    off = values - pull.rest
    stretched = pull.springs * off
    springs = 0.5 * float(stretched @ off)
    slope = slope + stretched
    slope[AXIAL] += pull.load
    potential = state.energy + springs + pull.load * float(values[AXIAL])
    return Total(values, potential, slope, stiffness + np.diag(pull.springs), springs, state)
