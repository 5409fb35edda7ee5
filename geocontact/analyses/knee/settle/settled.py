"""The equilibria of a motion as arrays over its frames."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.knee.settle.read import SettleInputs
from geocontact.data.multibody.knee_angles import angles_of_tibia
from geocontact.loads.foundation_stiffness import layer_loads
from geocontact.loads.pressure_load import PressureLoad
from geocontact.loads.settling.along import Frame
from geocontact.loads.settling.coordinates import poses_of

SIDES = ("medial", "lateral", "total")


@dataclass(frozen=True, eq=False)
class Settled:
    """What every frame came to; not a number where it came to no rest.

    Parameters
    ----------
    inputs, frames
        What was asked for, and what was found in each frame.
    side
        Side of the body.
    """

    inputs: SettleInputs
    frames: tuple[Frame, ...]
    side: str

    @cached_property
    def converged(self) -> Bool[np.ndarray, " t"]:
        """Frames at rest."""
        return np.array([frame.converged for frame in self.frames])

    @property
    def heaviest(self) -> int:
        """Frame at rest with the largest load."""
        return int(np.argmax(np.where(self.converged, self.inputs.load, -np.inf)))

    @cached_property
    def coordinates(self) -> Float[np.ndarray, "t 6"]:
        """Coordinates [m, rad], as `loads.settling.coordinates` has them."""
        lost = np.full(6, np.nan)
        return np.array([f.rest.total.values if f.rest and f.converged else lost for f in self.frames])

    @property
    def kept(self) -> np.ndarray:
        """Numbers of the frames at rest."""
        return np.flatnonzero(self.converged)

    @property
    def poses(self) -> RigidTransform:
        """Poses of MOVING in FIXED in the frames at rest."""
        return poses_of(self.coordinates[self.kept], self.inputs.bed.point)

    @cached_property
    def knee_angles(self) -> Float[np.ndarray, "t 3"]:
        """Flexion, adduction and internal rotation of Grood and Suntay [rad]."""
        found = np.full((len(self.frames), 3), np.nan)
        turned = self.poses.rotation.inv()
        found[self.kept] = np.column_stack(angles_of_tibia(turned, self.side))
        return found

    @cached_property
    def loads(self) -> list[dict[str, PressureLoad] | None]:
        """Load on FIXED of each compartment and of all; None without rest."""
        layer = self.inputs.bed.layer
        return [layer_loads(layer, f.rest.total.foundation) if f.rest and f.converged else None for f in self.frames]

    def forces(self, side: str) -> Float[np.ndarray, " t"]:
        """Force of one compartment, or of the "total", along the load [N]."""
        return self._each(side, lambda load: -float(load.wrench.force[1]))

    @property
    def peaks(self) -> Float[np.ndarray, " t"]:
        """Largest pressure [Pa]."""
        return self._each("total", lambda load: load.peak)

    @property
    def areas(self) -> Float[np.ndarray, " t"]:
        """Area of FIXED under pressure [m^2]."""
        return self._each("total", lambda load: load.area)

    def centres(self, side: str) -> Float[np.ndarray, "t 3"]:
        """Centre of pressure [m]."""
        lost = np.full(3, np.nan)
        return np.array([lost if load is None else load[side].centre for load in self.loads])

    @property
    def residuals(self) -> Float[np.ndarray, " t"]:
        """Force left over [N]; also where that is too much."""
        return np.array([np.nan if f.rest is None else f.rest.residual for f in self.frames])

    @property
    def stored(self) -> Float[np.ndarray, " t"]:
        """Energy of layer and springs [J]."""
        return np.array([f.rest.total.stored if f.rest and f.converged else np.nan for f in self.frames])

    @property
    def largest_strain(self) -> float:
        """Of the layer [-]."""
        thickness = self.inputs.bed.layer.thickness
        states = [f.rest.total.foundation for f in self.frames if f.rest and f.converged]
        return max(float((state.depth / thickness[state.pressed]).max()) for state in states)

    def face_pressure(self, frame: int) -> Float[np.ndarray, " f"]:
        """Mean pressure of each face of FIXED [Pa]; 0 without rest."""
        faces, found = len(self.inputs.fixed.faces), self.frames[frame]
        if found.rest is None or not found.converged:
            return np.zeros(faces)
        state, pieces = found.rest.total.foundation, self.inputs.bed.layer.pieces
        pressure = np.zeros(len(pieces.area))
        pressure[state.pressed] = state.pressure
        return pieces.face_means(pressure, faces)

    def _each(self, side: str, value: Callable[[PressureLoad], float]) -> Float[np.ndarray, " t"]:
        return np.array([np.nan if load is None else value(load[side]) for load in self.loads])
