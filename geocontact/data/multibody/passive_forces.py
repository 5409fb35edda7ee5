"""Forces that a model exerts on itself whatever its muscles do: coordinate limits, springs, bushings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform


@dataclass(frozen=True)
class CoordinateLimit:
    """A spring and a dashpot that act beyond the limits of a coordinate (OpenSim's `CoordinateLimitForce`).

    Parameters
    ----------
    coordinate
        Its name.
    upper, lower
        Limits [rad, m].
    upper_stiffness, lower_stiffness
        Of the springs far beyond the limits [N m/rad, N/m].
    damping
        Of the dashpot there [N m s/rad, N s/m].
    transition
        How far beyond a limit they reach their full size [rad, m].
    """

    name: str
    coordinate: str
    upper: float
    lower: float
    upper_stiffness: float
    lower_stiffness: float
    damping: float
    transition: float


@dataclass(frozen=True)
class CoordinateSpring:
    """A spring and a dashpot along a coordinate (OpenSim's `SpringGeneralizedForce`).

    Parameters
    ----------
    stiffness
        [N m/rad, N/m].
    rest
        Where the spring is slack [rad, m].
    viscosity
        [N m s/rad, N s/m].
    """

    name: str
    coordinate: str
    stiffness: float
    rest: float
    viscosity: float


@dataclass(frozen=True)
class FrameBushing:
    """Springs and dashpots between frames of two bodies (OpenSim's `BushingForce`).

    Parameters
    ----------
    bodies
        Names of the first and the second.
    frames
        Poses of the frames in them.
    stiffness, damping
        Three along the Cardan angles (x, y', z'') of the second frame in the first [N m/rad, N m s/rad], three along
        its translation in the first frame's axes [N/m, N s/m].
    """

    name: str
    bodies: tuple[str, str]
    frames: tuple[RigidTransform, RigidTransform]
    stiffness: Float[np.ndarray, " 6"]
    damping: Float[np.ndarray, " 6"]


PassiveForce = CoordinateLimit | CoordinateSpring | FrameBushing


@dataclass(frozen=True)
class PassiveForces:
    """Those of a model.

    Parameters
    ----------
    acting
        That count.
    excluded
        Names of those that were asked to be left out.
    unread
        Kind and name of forces that would act as well, of kinds that are not read.
    """

    acting: tuple[PassiveForce, ...] = ()
    excluded: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()
