"""A prosthetic foot as the base model `foot` of a gap case takes it: rigid, in the sagittal plane, a zone for each row.

The plane is upright and holds the keel's mean direction. The base model's foot does not bend: that the keel does is
left to the stiffness of each row of spheres across the sole, found from what a model with a keel shows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import nnls
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.evaluation import PlateStance, at_times, longest_stance
from geocontact.below_knee_prosthesis.simulate import GATE, Stance
from geocontact.loads.centre_of_pressure import centre_in_foot
from geocontact.loads.sphere_set import SoleLaw, SphereSet

LEVER = 0.05
"""m; a moment about the heel counts as the force that makes it at this distance."""
AROUND = 0.05
"""s; before and after the stance that belong to the trial."""


@dataclass(frozen=True)
class FootInPlane:
    """Where the foot is, in an upright plane.

    Parameters
    ----------
    x, y, pitch
        Of the keel's posterior end along the plane and above the floor [m], and of its axis, toes up [rad].
    forward
        Of the plane, in the ground's frame.
    """

    time: Float[np.ndarray, " t"]
    x: Float[np.ndarray, " t"]
    y: Float[np.ndarray, " t"]
    pitch: Float[np.ndarray, " t"]
    forward: Float[np.ndarray, " 3"]

    def reaction(
        self, force: Float[np.ndarray, "t 3"], centre: Float[np.ndarray, "t 3"]
    ) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
        """Forward and upward force [N], and centre of pressure in the foot's frame [m]; NaN below `GATE`."""
        place = centre_in_foot(centre @ self.forward, self.x, self.y, self.pitch)
        return force @ self.forward, force[:, 1], np.where(force[:, 1] >= GATE, place, np.nan)


def in_plane(time: Float[np.ndarray, " t"], poses: RigidTransform) -> FootInPlane:
    """Motion of the keel's frame at some times [s], y up."""
    axis = poses.rotation.apply([1.0, 0.0, 0.0])
    forward = axis.mean(axis=0) * np.array([1.0, 0.0, 1.0])
    forward /= np.linalg.norm(forward)
    place = poses.translation
    return FootInPlane(time, place @ forward, place[:, 1], np.arctan2(axis[:, 1], axis @ forward), forward)


def rows_of(spheres: SphereSet) -> tuple[str, ...]:
    """Zone of each sphere by its row across the sole: the zone's name, numbered from the heel where it has several.

    Foam has too many rows for a number each: its zones are left as they are.
    """
    if spheres.thickness is not None:
        return spheres.zone
    found = np.empty(len(spheres), dtype=object)
    for zone, of in spheres.zones.items():
        along = np.unique(spheres.centre[of, 0])
        place = np.searchsorted(along, spheres.centre[of, 0])
        found[of] = [f"{zone}_{k + 1}" if len(along) > 1 else zone for k in place]
    return tuple(map(str, found))


@dataclass(frozen=True)
class RowNumbers:
    """Stiffness [N/m^n] and damping [N s/m] of a sphere by row, and how far a rigid foot of them is off [N]."""

    stiffness: dict[str, float]
    damping: dict[str, float]
    off: float


def row_numbers(
    foot: FootInPlane,
    spheres: SphereSet,
    law: SoleLaw,
    force: Float[np.ndarray, " t"],
    centre: Float[np.ndarray, " t"],
) -> RowNumbers:
    """Numbers of the rows with which a rigid foot, moved like this, is nearest to an upward force and its centre.

    Forces are linear in them at given depths: non-negative least squares of the force and of its moment about the heel
    over `LEVER`. What is off is the root mean square of the force.
    """
    rows = rows_of(spheres)
    s, c = np.sin(foot.pitch)[:, None], np.cos(foot.pitch)[:, None]
    px, py, radius = spheres.centre[:, 0], spheres.centre[:, 1], spheres.radius
    depth = np.maximum(radius - (foot.y[:, None] + px * s + py * c), 0.0)
    rate = np.maximum(np.gradient(depth, foot.time, axis=0), 0.0)
    share = np.clip(depth / law.full_depth, 0.0, 1.0)
    unit = depth**law.exponent, rate * share * share * (3.0 - 2.0 * share)
    names = list(dict.fromkeys(rows))
    member = np.array([[row == name for name in names] for row in rows], float)
    up = np.hstack([each @ member for each in unit])
    moment = np.hstack([(each * (px - s * radius)) @ member for each in unit])
    told = np.nan_to_num(force * centre)
    found, _ = nnls(np.concatenate([up, moment / LEVER]), np.concatenate([force, told / LEVER]))
    stiffness, damping = (dict(zip(names, map(float, part), strict=True)) for part in found.reshape(2, -1))
    return RowNumbers(stiffness, damping, float(np.sqrt(np.mean((up @ found - force) ** 2))))


@dataclass(frozen=True, eq=False)
class PlaneTrial:
    """A stance for the base model.

    Parameters
    ----------
    foot
        Its motion by markers.
    reaction
        Of the plate at the same times: forward and upward force [N] and centre of pressure in the foot [m]; None
        without a plate.
    numbers
        Of the rows, with which a rigid foot is nearest to the simulated one.
    """

    foot: FootInPlane
    reaction: tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"], Float[np.ndarray, " t"]] | None
    numbers: RowNumbers


def plane_trial(
    time: Float[np.ndarray, " t"], poses: RigidTransform, plate: PlateStance | None, stance: Stance
) -> PlaneTrial | None:
    """Trial and numbers of a stance on a floor; None where the foot is never loaded.

    Parameters
    ----------
    time, poses
        When the keel was seen [s], and its frame by the markers on the socket.
    plate
        Under the prosthetic foot; None where it is not known: then the trial is where the simulated foot is loaded.
    stance
        That was simulated.
    """
    loaded = (stance.time, stance.force[:, 1]) if plate is None else (plate.time, plate.force[:, 1])
    span = longest_stance(*loaded)
    if span is None:
        return None
    inside = (time >= span[0] - AROUND) & (time <= span[1] + AROUND)
    foot = in_plane(time[inside], poses[inside])
    reaction = None
    if plate is not None:
        reaction = foot.reaction(*(at_times(foot.time, plate.time, each) for each in (plate.force, plate.centre)))
    simulated = in_plane(stance.time, stance.poses)
    _, up, centre = simulated.reaction(stance.force, stance.centre("ground"))
    spheres, law = stance.foot.sole.spheres, stance.foot.law
    return PlaneTrial(foot, reaction, row_numbers(simulated, spheres, law, up, centre))
