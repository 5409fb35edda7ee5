"""Measured loads on the bodies of a model: which samples count, loads expressed in bodies, which body a load is under.

A plate's point of application means little where its force is small, so samples below a threshold count as unloaded.
Forces, torques and points may be expressed in bodies, as in OpenSim's class ExternalForce (OpenSim 4.6 API).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.model import Multibody
from geocontact.data.wrench import Wrench

LOADED = 50.0
"""N, from which a centre of pressure is exact to centimetres."""


def unloaded(wrench: Wrench, threshold: float) -> Bool[np.ndarray, " t"]:
    """Samples of (t, 3) whose force is below the threshold [N] or zero; a missing force (NaN) is not small."""
    size = np.linalg.norm(wrench.force, axis=1)
    return np.asarray((size < threshold) | (size == 0.0))


def without_torque(wrench: Wrench) -> Wrench:
    """The force alone, through its origin."""
    return replace(wrench, moment=np.zeros_like(wrench.moment))


def zero_unloaded(wrench: Wrench, threshold: float) -> Wrench:
    """The same (t, 3), force, moment and origin zero where it is unloaded by the threshold [N]."""
    idle = unloaded(wrench, threshold)[:, None]
    force, moment, origin = (np.where(idle, 0.0, each) for each in (wrench.force, wrench.moment, wrench.origin))
    return Wrench(force, moment, origin, wrench.frame)


def without_unloaded(wrench: Wrench, threshold: float) -> Wrench:
    """The same (t, 3) about the frame's origin, zero where it is unloaded by the threshold [N].

    A point that is missing (NaN) does no harm in unloaded samples; elsewhere the moment is missing too.
    """
    return zero_unloaded(wrench, threshold).moved_to(np.zeros(3))


def added(one: Wrench, other: Wrench) -> Wrench:
    """Two loads on one body together, in one frame and about the origin of the first."""
    there = other.moved_to(one.origin)
    return replace(one, force=one.force + there.force, moment=one.moment + there.moment)


def from_bodies(
    time: Float[np.ndarray, " s"],
    wrench: Wrench,
    wanted: Float[np.ndarray, " t"],
    turning: RigidTransform | None,
    carrying: RigidTransform | None,
    frame: str,
) -> Wrench:
    """A load whose parts are expressed in bodies, about the ground's origin and in the ground's frame.

    Parts are interpolated linearly in the frames that they are expressed in, then carried along, as OpenSim does.

    Parameters
    ----------
    time
        Of the load [s], increasing.
    wrench
        Force [N], torque [N m] and point [m] (its origin), (s, 3) each, zero in unloaded samples.
    wanted
        Times [s] of the result; beyond those of the load its first or last sample holds.
    turning
        Poses in the ground of the body that force and torque are expressed in, one for each wanted time; None for the
        ground.
    carrying
        The same of the body that the point is expressed in.
    frame
        Name of the ground's frame.

    Returns
    -------
    Wrench
        (t, 3); NaN where a part is missing.
    """
    parts = (wrench.force, wrench.moment, wrench.origin)
    force, moment, point = (np.column_stack([np.interp(wanted, time, x) for x in each.T]) for each in parts)
    if turning is not None:
        force, moment = turning.rotation.apply(force), turning.rotation.apply(moment)
    if carrying is not None:
        point = carrying.apply(point)
    return Wrench(force, moment, point, frame).moved_to(np.zeros(3))


@dataclass(frozen=True)
class FarthestLine:
    """The sample whose line of force passes farthest from a body.

    Parameters
    ----------
    distance
        From the body's origin [m]; a free torque counts as a farther line.
    force
        Size of the force in that sample [N].
    """

    distance: float
    force: float


def farthest_line(wrench: Wrench, origin: Float[np.ndarray, "t 3"]) -> FarthestLine | None:
    """How far a load (t, 3) passes from a body's origin [m] in the same frame; None for a load that is never there.

    The distance is the size of the moment about the body's origin, divided by that of the force.
    """
    size = np.linalg.norm(wrench.force, axis=1)
    on = size > 0.0
    if not on.any():
        return None
    arm = np.linalg.norm(wrench.moved_to(origin).moment[on], axis=1) / size[on]
    farthest = int(np.argmax(arm))
    return FarthestLine(float(arm[farthest]), float(size[on][farthest]))


@dataclass(frozen=True)
class MisplacedLoad:
    """A load that acts nearer to another body than to its own.

    Parameters
    ----------
    body
        That the load is said to act on.
    distance
        Of its centre of pressure from that body's origin, across the vertical, median over its frames [m].
    nearest
        The loaded body that it is nearest to.
    nearest_distance
        From that one [m].
    """

    body: str
    distance: float
    nearest: str
    nearest_distance: float


def misplaced_loads(
    model: Multibody, values: Float[np.ndarray, "t n"], loads: Mapping[str, Wrench]
) -> list[MisplacedLoad]:
    """Loads that pass nearer another loaded body than their own, in the median of their frames.

    Loads that are exchanged leave no residual at the ground: the sum of all is the same. Centres of pressure are those
    of the plane through the ground's origin, where a load presses with 50 N or more.

    Parameters
    ----------
    model
        Whose bodies bear the loads.
    values
        Its coordinates [rad, m].
    loads
        By body, in the ground's frame, (t, 3) each.
    """
    poses, misplaced = model.poses(values), []
    for body, load in loads.items():
        centre = load.centre_of_pressure(np.zeros(3), model.up, LOADED)
        away = {name: _across(poses[name].translation - centre, model.up) for name in loads if name in poses}
        there = np.isfinite(centre).all(axis=1)
        if body not in away or not there.any():
            continue
        typical = {name: float(np.median(distance[there])) for name, distance in away.items()}
        nearest = min(typical, key=lambda name: typical[name])
        if nearest != body:
            misplaced.append(MisplacedLoad(body, typical[body], nearest, typical[nearest]))
    return misplaced


def _across(offset: Float[np.ndarray, "t 3"], up: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " t"]:
    return np.asarray(np.linalg.norm(offset - (offset @ up)[:, None] * up, axis=1))
