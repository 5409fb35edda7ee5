"""The spheres, or columns of foam, that stand for the sole of a foot, and what the ground does to each of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import RigidTransform

from geocontact.contact.sphere_foot import friction_coefficient, normal_force
from geocontact.data.frame_blocks import blocks, parts, release, room, worked
from geocontact.loads.ground import Ground
from geocontact.loads.opensim_law import OpenSimLaw


@dataclass(frozen=True)
class SphereSet:
    """Spheres fixed in a foot, grouped in zones (heel, midfoot, toes …).

    Parameters
    ----------
    centre
        Centres in the foot's frame [m].
    radius
        [m].
    zone
        Zone of each sphere.
    thickness
        Of the foam [m], where these are the ends of columns of it, so small that they are points; None for spheres.
    """

    centre: Float[np.ndarray, "n 3"]
    radius: Float[np.ndarray, " n"]
    zone: tuple[str, ...]
    thickness: Float[np.ndarray, " n"] | None = None

    def __post_init__(self) -> None:
        if len(self.zone) != len(self.radius) or not len(self.radius):
            raise ValueError(f"{len(self.radius)} spheres with {len(self.zone)} zones; every sphere has one")
        if not (np.isfinite(self.centre).all() and (self.radius > 0.0).all() and np.isfinite(self.radius).all()):
            raise ValueError("spheres need finite centres and positive radii")
        if self.thickness is not None and not (self.thickness > 0.0).all():
            raise ValueError("foam needs a positive thickness")

    @property
    def deepest(self) -> Float[np.ndarray, " n"]:
        """Depth [m] beyond which a sphere's centre, or the whole thickness of the foam, is in the ground."""
        return self.radius if self.thickness is None else self.thickness

    @property
    def limit(self) -> str:
        """What `deepest` is of each of them."""
        return "radius" if self.thickness is None else "thickness"

    @property
    def kind(self) -> str:
        """What one of them is called."""
        return "sphere" if self.thickness is None else "column of foam"

    @property
    def kinds(self) -> str:
        """What several of them are called."""
        return "spheres" if self.thickness is None else "columns of foam"

    def chosen(self, of: Bool[np.ndarray, " n"]) -> SphereSet:
        """Some of them."""
        zone = tuple(name for name, kept in zip(self.zone, of, strict=True) if kept)
        return SphereSet(self.centre[of], self.radius[of], zone, None if self.thickness is None else self.thickness[of])

    def __len__(self) -> int:
        return len(self.radius)

    @property
    def zones(self) -> dict[str, Bool[np.ndarray, " n"]]:
        """Which spheres belong to each zone, zones in the order in which they first occur."""
        names = np.array(self.zone)
        return {name: names == name for name in dict.fromkeys(self.zone)}


@dataclass(frozen=True)
class SoleLaw:
    """Numbers of the force law `geocontact.contact.sphere_foot`; stiffness, damping and friction sphere by sphere.

    Parameters
    ----------
    stiffness, exponent
        k [N/m^n] of each sphere, and n.
    damping, full_depth
        b [N s/m] of each sphere, and the depth [m] from which it acts fully.
    static, kinetic
        Coefficients of friction of each sphere [-].
    threshold_speed
        Speed [m/s] at which static friction is reached.
    """

    stiffness: Float[np.ndarray, " n"]
    damping: Float[np.ndarray, " n"]
    exponent: float
    full_depth: float
    static: Float[np.ndarray, " n"]
    kinetic: Float[np.ndarray, " n"]
    threshold_speed: float

    def __post_init__(self) -> None:
        positive = (self.exponent, self.full_depth, self.threshold_speed, *self.stiffness)
        not_negative = (*self.static, *self.kinetic, *self.damping)
        if not (np.isfinite([*positive, *not_negative]).all() and min(positive) > 0.0 and min(not_negative) >= 0.0):
            raise ValueError(
                "stiffness, exponent, depth and threshold speed must be positive, damping and friction not negative"
            )

    @property
    def needs_velocity(self) -> bool:
        """Whether any force depends on how the foot moves, not only on where it is."""
        return bool(self.damping.any() or self.static.any() or self.kinetic.any())

    def chosen(self, of: Bool[np.ndarray, " n"]) -> SoleLaw:
        """Numbers of some of the spheres."""
        each = {name: getattr(self, name)[of] for name in ("stiffness", "damping", "static", "kinetic")}
        return replace(self, **each)

    @property
    def reach(self) -> float:
        """Height of a sphere above the ground up to which a force acts [m]: it acts where the sphere touches."""
        return 0.0

    def acts_at(self, sphere: Int[np.ndarray, " c"]) -> Float[np.ndarray, " c"]:
        """Place of the force above the sphere's lowest point, as a share of the depth [-]: on the ground."""
        return np.ones(len(sphere))

    def slides_at(self, sphere: Int[np.ndarray, " c"]) -> Float[np.ndarray, " c"]:
        """Place of the material point that slides, likewise [-]: the sphere's lowest."""
        return np.zeros(len(sphere))

    def pressing(
        self, depth: Float[np.ndarray, " c"], closing: Float[np.ndarray, " c"], sphere: Int[np.ndarray, " c"]
    ) -> Float[np.ndarray, " c"]:
        """Normal force [N] of depth [m] and its rate [m/s]."""
        force = normal_force(
            depth, closing, self.stiffness[sphere], self.exponent, self.damping[sphere], self.full_depth
        )
        return np.asarray(force)

    def rubbing(self, sliding: Float[np.ndarray, "c 3"], sphere: Int[np.ndarray, " c"]) -> Float[np.ndarray, "c 3"]:
        """Friction over normal force, as a vector, of a velocity along the ground [m/s]."""
        speed = np.linalg.norm(sliding, axis=1)
        coefficient = friction_coefficient(speed, self.threshold_speed, self.static[sphere], self.kinetic[sphere])
        direction = np.divide(sliding, speed[:, None], out=np.zeros_like(sliding), where=speed[:, None] > 0.0)
        return np.asarray(-coefficient[:, None] * direction)


@dataclass(frozen=True)
class SphereLoads:
    """Loads of the ground on each sphere in each frame, in the ground's frame.

    Parameters
    ----------
    pressing
        Normal force, >= 0 [N].
    force
        Normal force and friction [N]; it acts at `point`.
    point
        Point of the ground nearest to the sphere's centre [m], with `OpenSimLaw` below it within the depth; NaN where
        no force acts.
    centre
        Centre of the sphere [m].
    normal
        Outward normal of the ground there; NaN where the sphere does not touch.
    depth
        Radius - distance of the centre [m]; -inf where the sphere is farther than the largest radius away.
    """

    pressing: Float[np.ndarray, "t n"]
    force: Float[np.ndarray, "t n 3"]
    point: Float[np.ndarray, "t n 3"]
    centre: Float[np.ndarray, "t n 3"]
    normal: Float[np.ndarray, "t n 3"]
    depth: Float[np.ndarray, "t n"]

    def chosen(self, of: Bool[np.ndarray, " n"]) -> SphereLoads:
        """Loads of some of the spheres."""
        some = (worked(lambda part: np.ascontiguousarray(part[:, of]), getattr(self, e.name)) for e in fields(self))
        return SphereLoads(*some)


def beside(loads: Sequence[SphereLoads]) -> SphereLoads:
    """Loads of spheres on several bodies in the same frames, as of one set."""
    if len(loads) == 1:
        return loads[0]

    def joined(*some: np.ndarray) -> np.ndarray:
        return np.concatenate(some, axis=1)

    return SphereLoads(*(worked(joined, *(getattr(one, each.name) for one in loads)) for each in fields(SphereLoads)))


def sphere_loads(
    spheres: SphereSet,
    law: SoleLaw | OpenSimLaw,
    poses: RigidTransform,
    rate: Float[np.ndarray, "t 4 4"],
    ground: Ground,
) -> SphereLoads:
    """Loads along a motion.

    Depth is radius - distance of the centre, its rate the speed of the centre against the ground's normal. Friction
    acts against the velocity along the ground of that material point of the foot which is the sphere's lowest, with
    `OpenSimLaw` of the one at which the force acts.

    Parameters
    ----------
    poses, rate
        Poses `X_GF` of the foot in the ground's frame, one per frame, and their time derivative (`pose_rate`).

    One that is deeper than any of `SphereSet.deepest` is a ValueError: that is a mistaken frame, not a contact.
    """
    every = list(blocks(len(rate), OF_A_SPHERE * len(spheres)))
    if len(every) == 1:
        return _loads_of(spheres, law, poses, rate, ground, 0)
    wide, flat = (len(rate), len(spheres), 3), (len(rate), len(spheres))
    found = SphereLoads(room(flat), room(wide), room(wide), room(wide), room(wide), room(flat))
    for some in every:
        part = _loads_of(spheres, law, poses[some], rate[some], ground, some.start)
        for each in fields(SphereLoads):
            getattr(found, each.name)[some] = getattr(part, each.name)
        release()
    return found


OF_A_SPHERE = 14
"""Numbers of `SphereLoads` for a sphere in a frame."""


def _loads_of(
    spheres: SphereSet,
    law: SoleLaw | OpenSimLaw,
    poses: RigidTransform,
    rate: Float[np.ndarray, "t 4 4"],
    ground: Ground,
    first: int,
) -> SphereLoads:
    """Loads in the frames of a part, which begins at frame `first`."""
    matrices = poses.as_matrix().reshape(-1, 4, 4)
    turn, count = matrices[:, :3, :3], len(spheres)
    centre = np.einsum("tij,nj->tni", turn, spheres.centre) + matrices[:, None, :3, 3]
    limit = float(spheres.deepest.max())
    near = ground.proximity(centre.reshape(-1, 3), limit + law.reach)
    distance = near.distance.reshape(-1, count)
    depth = spheres.radius - distance
    _refuse_buried(distance < -limit, spheres, first)
    touching = depth > -law.reach
    frame, sphere = np.nonzero(touching)
    normal = np.full_like(centre, np.nan)
    point = np.full_like(centre, np.nan)
    pressing, force = np.zeros(depth.shape), np.zeros_like(centre)
    n, deep = near.normal.reshape(centre.shape)[touching], depth[touching]
    normal[touching] = n
    below = ((1.0 - law.acts_at(sphere)) * deep)[:, None] * n
    point[touching] = near.closest.reshape(centre.shape)[touching] - below
    arm = spheres.radius[sphere] - law.slides_at(sphere) * deep
    sliding_point = spheres.centre[sphere] - arm[:, None] * np.einsum("cij,ci->cj", turn[frame], n)
    closing = -np.einsum("ci,ci->c", n, _velocity(rate[frame], spheres.centre[sphere]))
    pressing[touching] = law.pressing(deep, closing, sphere)
    velocity = _velocity(rate[frame], sliding_point)
    sliding = velocity - np.einsum("ci,ci->c", velocity, n)[:, None] * n
    force[touching] = pressing[touching][:, None] * (n + law.rubbing(sliding, sphere))
    return SphereLoads(pressing, force, point, centre, normal, depth)


def clearance(spheres: SphereSet, loads: SphereLoads, ground: Ground) -> float:
    """Smallest distance between any sphere and the ground over all frames [m]; negative where one touches."""

    def least(centre: Float[np.ndarray, "t n 3"]) -> float:
        distance = ground.proximity(centre.reshape(-1, 3)).distance.reshape(centre.shape[:2])
        return float((distance - spheres.radius).min())

    return min(least(part) for (part,) in parts(loads.centre))


def _velocity(rate: Float[np.ndarray, "c 4 4"], body_point: Float[np.ndarray, "c 3"]) -> Float[np.ndarray, "c 3"]:
    return np.asarray(np.einsum("cij,cj->ci", rate[:, :3, :3], body_point) + rate[:, :3, 3])


def _refuse_buried(deeper: Bool[np.ndarray, "t n"], spheres: SphereSet, first: int) -> None:
    buried = np.argwhere(deeper)
    if len(buried):
        frame, sphere = buried[0]
        one = f"{spheres.kind} {sphere + 1}"
        raise ValueError(f"{one} is deeper under the ground than any {spheres.limit} in frame {first + frame + 1}")
