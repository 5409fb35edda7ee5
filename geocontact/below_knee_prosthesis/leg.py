"""The prosthetic leg of one person: lengths, masses with their sources, places of its parts, and the foot's offset on
its socket.

Always a right leg: a left one is its mirror image. Frames are right-handed, x forward, y up, z to the right.

A standing trial places the keel as if the foot had stood flat on the floor. Where it stood out of flat, that place is
wrong by a height and a pitch, which hold for every walk that is read with the same standing trial.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.body_segments import LEVA, BodySegments, body_segments
from geocontact.data.multibody.model import Marker
from geocontact.data.parameter import Number, Source

NODES, WEIGHTS = np.polynomial.legendre.leggauss(3)
"""Exact up to the fifth power; the fourth is the highest that is needed."""


@dataclass(frozen=True)
class Frustum:
    """A frustum with its axis along -y from the proximal end.

    Parameters
    ----------
    length
        [m].
    proximal, distal
        Radii of both ends [m].

    ValueError for a length or radius that is not positive.
    """

    length: float
    proximal: float
    distal: float

    def __post_init__(self) -> None:
        if not (np.isfinite([self.length, self.proximal, self.distal]).all() and min(self.length, self.distal) > 0.0):
            raise ValueError("a frustum needs a positive length and positive radii")
        if not self.proximal > 0.0:
            raise ValueError("a frustum needs a positive length and positive radii")

    @property
    def volume(self) -> float:
        """[m³]."""
        return float(np.pi * self._sum(self._radius**2))

    def cut(self, length: float) -> Frustum:
        """The proximal part of that length [m]; ValueError where it is not within the frustum."""
        if not 0.0 < length <= self.length:
            raise ValueError(f"a frustum of {self.length:g} m cannot be cut at {length:g} m")
        return Frustum(length, self.proximal, self.proximal + (self.distal - self.proximal) * length / self.length)

    def body(self, density: float) -> tuple[float, Float[np.ndarray, " 3"], Float[np.ndarray, "3 3"]]:
        """Mass [kg], mass centre [m] and inertia about it [kg m²] of a body of that density [kg/m³]."""
        x, r = self._place, self._radius
        mass = density * self.volume
        centre = density * float(np.pi * self._sum(x * r**2)) / mass
        long = density * float(np.pi * self._sum(0.5 * r**4))
        across = density * float(np.pi * self._sum(0.25 * r**4 + (x - centre) ** 2 * r**2))
        return mass, np.array([0.0, -centre, 0.0]), np.diag([across, long, across])

    @property
    def _place(self) -> Float[np.ndarray, " 3"]:
        return np.asarray(0.5 * self.length * (1.0 + NODES))

    @property
    def _radius(self) -> Float[np.ndarray, " 3"]:
        return self.proximal + (self.distal - self.proximal) * self._place / self.length

    def _sum(self, of: Float[np.ndarray, " 3"]) -> float:
        return float(0.5 * self.length * (WEIGHTS @ of))


def taper(centre: float) -> float:
    """Distal over proximal radius of a frustum whose mass centre is at that share of its length."""

    def off(ratio: float) -> float:
        return float((1.0 + 2.0 * ratio + 3.0 * ratio**2) / (4.0 * (1.0 + ratio + ratio**2)) - centre)

    return float(brentq(off, 1e-6, 1e3))


MIDDLE = np.array([0.11, 0.0, 0.0])
"""m; of the keel, about which an error of pitch turns it."""


@dataclass(frozen=True)
class FootOffset:
    """Offset of the foot on the socket, beside its standing trial; none unless it was found.

    Parameters
    ----------
    height
        By which the middle of the foot is raised, along the keel's upward axis [m].
    pitch
        By which it is turned about that middle, the toes up [rad].
    height_sd, pitch_sd
        Standard deviations of both.
    """

    height: float = 0.0
    pitch: float = 0.0
    height_sd: float = 0.0
    pitch_sd: float = 0.0

    @property
    def given(self) -> bool:
        """Whether there is anything of it."""
        return self != AS_STOOD

    @property
    def words(self) -> str:
        """Height and pitch with their standard deviations."""
        return (
            f"{1e3 * self.height:+.2f} mm (SD {1e3 * self.height_sd:.2f}) and {np.degrees(self.pitch):+.2f} degrees "
            f"(SD {np.degrees(self.pitch_sd):.2f}, toes up)"
        )


AS_STOOD = FootOffset()
"""Nothing beside the standing trial."""


Side = Literal["right", "left"]
Vector = Float[np.ndarray, " 3"]
Inertial = tuple[float, Vector, Float[np.ndarray, "3 3"]]
"""Mass [kg], mass centre [m] and inertia about it [kg m²]."""

RESIDUAL = 0.45
"""Share of the shank that is left; invented."""
SOCKET, PYLON, FOOT = 1.1, 0.35, 0.75
"""kg; socket with liner, pylon with adapters, foot shell with shoe; invented."""
SOCKET_RADIUS, FOOT_SIZE = 0.055, (0.24, 0.06, 0.08)
"""m; of the socket as a hollow cylinder, and of the foot shell as a box; invented."""


MAN = body_segments("male")


@dataclass(frozen=True)
class Person:
    """Who walks.

    Parameters
    ----------
    mass
        Of the body with the prosthesis [kg].
    segments
        Segments of the body as it is without the prosthesis.
    residual
        Share of the shank's length that is left [-].
    prosthesis
        Mass of socket, pylon and foot without the keel [kg].
    """

    mass: float
    segments: BodySegments = MAN
    residual: float = RESIDUAL
    prosthesis: float = SOCKET + PYLON + FOOT

    def __post_init__(self) -> None:
        if not (0.0 < self.prosthesis < self.mass < np.inf and 0.0 < self.residual < 1.0):
            raise ValueError("a person has a mass above that of the prosthesis, and a part of the shank is left")

    @property
    def parts(self) -> tuple[float, float, float]:
        """Masses of socket, pylon and foot shell [kg], shared as the invented ones are."""
        by = self.prosthesis / (SOCKET + PYLON + FOOT)
        return by * SOCKET, by * PYLON, by * FOOT


@dataclass(frozen=True, eq=False)
class Leg:
    """Geometry of pelvis and prosthetic leg.

    Parameters
    ----------
    person
        Whose leg it is.
    hip
        Its centre in the pelvis' frame (origin in the middle of the front spines) [m].
    thigh
        Length, hip to knee [m].
    ankle
        In the shank's frame (origin in the knee) [m].
    knee_radius
        Half the distance of the epicondyles [m].
    keel
        Origin of the keel's frame K in the shank's frame [m].
    turn
        R_SK: turns components in K into components in the shank's frame S.
    markers
        On the bodies `pelvis`, `thigh` and `shank`, which the socket is fixed to as long as it does not give.
    offset
        Of the foot beside its standing trial; `keel` and `turn` have it.
    """

    person: Person
    hip: Vector
    thigh: float
    ankle: Vector
    knee_radius: float
    keel: Vector
    turn: Rotation
    markers: tuple[Marker, ...] = field(default=())
    offset: FootOffset = AS_STOOD

    def with_foot(self, offset: FootOffset) -> Leg:
        """With its foot raised and turned on the socket; ValueError where that was done before."""
        if self.offset.given:
            raise ValueError("the foot already has an offset from its standing trial")
        turn = self.turn * Rotation.from_euler("z", offset.pitch)
        raised = MIDDLE + np.array([0.0, offset.height, 0.0])
        keel = self.keel + self.turn.apply(raised) - turn.apply(MIDDLE)
        return replace(self, keel=keel, turn=turn, offset=offset)

    def with_residual(self, length: float) -> Leg:
        """With a residual limb of a measured length, knee to its end [m]; ValueError where the shank is not longer."""
        if not 0.0 < length < self.shank:
            what = f"a residual limb of {1e3 * length:.0f} mm is not shorter than the shank"
            raise ValueError(f"{what}, {1e3 * self.shank:.0f} mm")
        return replace(self, person=replace(self.person, residual=length / self.shank))

    @property
    def bushing(self) -> Vector:
        """Middle of the bushing in the shank's frame [m]: half-way down the residual limb."""
        return np.array([0.0, -0.5 * self.person.residual * self.shank, 0.0])

    @property
    def shank(self) -> float:
        """Length, knee to ankle along the shank's axis [m]."""
        return float(-self.ankle[1])

    @property
    def X_SB(self) -> RigidTransform:  # noqa: N802 the pose's own name
        """The bushing's frame B in the shank's: its middle, with the axes of the keel's frame."""
        return RigidTransform.from_components(self.bushing, self.turn)

    @property
    def keel_place(self) -> Vector:
        """Origin of K in B [m]; their axes are those of each other."""
        return np.asarray(self.turn.inv().apply(self.keel - self.bushing))

    def thigh_body(self) -> Inertial:
        """Body of the thigh in its frame, by the segment's shares of mass and length."""
        of = self.person.segments["thigh"]
        mass = of.mass * self.person.mass
        sagittal, transverse, long = of.moments(mass, self.thigh)
        return mass, np.array([0.0, -of.centre * self.thigh, 0.0]), np.diag([sagittal, long, transverse])

    def residual_body(self) -> Inertial:
        """Body of the residual limb in the shank's frame: a frustum cut off, of the density of the whole shank.

        Whole it has the segment's mass, and its mass centre gives the taper: the limb weighs the same whatever else is
        known of the person.
        """
        of = self.person.segments["shank"]
        whole = Frustum(self.shank, self.knee_radius, taper(of.centre) * self.knee_radius)
        density = of.mass * self.person.mass / whole.volume
        return whole.cut(self.person.residual * self.shank).body(density)

    def prosthesis_body(self) -> Inertial:
        """Body of socket, pylon and foot shell together in the bushing's frame B; the keel is not in it."""
        long, own = self.person.residual * self.shank, self.person.parts
        socket = _tube(own[0], long, 0.0)
        pylon = _tube(own[1], self.shank - long, -long, radius=0.015)
        size = np.array(FOOT_SIZE)
        middle = self.keel + self.turn.apply([0.45 * size[0], 0.0, 0.0])
        box = own[2] / 12.0 * np.diag((size**2).sum() - size**2)
        turned = self.turn.as_matrix() @ box @ self.turn.as_matrix().T
        mass, centre, inertia = combined((socket, pylon, (own[2], middle, turned)))
        back = self.turn.inv().as_matrix()
        return mass, self.turn.inv().apply(centre - self.bushing), back @ inertia @ back.T

    def pelvis_mass(self, keel: float) -> float:
        """Mass of all that is neither thigh, residual limb, prosthesis nor keel: trunk, head, arms, the other leg
        [kg].
        """
        parts = (self.thigh_body(), self.residual_body(), self.prosthesis_body())
        return self.person.mass - keel - sum(part[0] for part in parts)

    def numbers(self) -> Mapping[str, Number]:
        """Every number of the segments in SI, and where it is from: what a simulation takes of this leg."""
        masses, shapes = self.person.segments.source, self.person.segments.shape_source
        has = f"{shapes.removesuffix(' 1996')} has it"
        same = "; the study takes the same table" if masses == LEVA else ""
        whole = "de Leva's mass" if masses == LEVA else f"the mass by {masses}"
        measured = "from the markers of the standing trial"
        weighed = self.person.prosthesis != SOCKET + PYLON + FOOT
        source: Source = "derived" if weighed else "invented"
        shared = "; shares of the prosthesis' mass are invented" if weighed else ""
        socket, pylon, foot = self.person.parts
        thigh, residual = self.thigh_body(), self.residual_body()
        return {
            "mass": Number(self.person.mass, "option", "of the whole body, as the option mass states it"),
            "thigh_length": Number(self.thigh, "derived", measured),
            "shank_length": Number(self.shank, "derived", measured),
            "knee_radius": Number(self.knee_radius, "derived", f"{measured}: half the distance of the epicondyles"),
            **_places("hip", self.hip, "its centre in the pelvis' frame, by regression or a functional trial"),
            **_places("ankle", self.ankle, f"in the shank's frame, {measured}"),
            **_places("keel", self.keel, f"origin of the keel's frame K in the shank's, {measured}"),
            **_places("turn", self.turn.as_rotvec(), f"of K in the shank's frame as a rotation vector, {measured}"),
            **_offset(self.offset),
            "thigh_mass": Number(thigh[0], "derived", f"{masses}, of the body's mass{same}"),
            "thigh_centre": Number(float(-thigh[1][1]), "derived", f"of its mass, below the hip; {shapes}"),
            "residual_share": _share(self.person.residual),
            "ankle_over_knee_radius": Number(
                taper(self.person.segments["shank"].centre),
                "derived",
                f"of the frustum of a whole shank, which puts its mass centre where {has}",
            ),
            "residual_mass": Number(residual[0], "derived", f"that frustum cut off, with {whole}"),
            "residual_centre": Number(float(-residual[1][1]), "derived", "of its mass, below the knee"),
            "socket_mass": Number(socket, source, f"with liner{shared}"),
            "pylon_mass": Number(pylon, source, f"with adapters{shared}"),
            "foot_mass": Number(foot, source, f"shell and shoe, without keel{shared}"),
            **_prosthesis(*self.prosthesis_body()),
        }


def _share(residual: float) -> Number:
    if residual == RESIDUAL:
        return Number(residual, "invented", "of the shank; the study does not state it")
    return Number(residual, "option", "of the shank, as stated or measured")


def _places(name: str, values: Vector, note: str) -> dict[str, Number]:
    return {f"{name}_{axis}": Number(float(each), "derived", note) for axis, each in zip("xyz", values, strict=True)}


def _offset(of: FootOffset) -> dict[str, Number]:
    """Offset of the foot beside its standing trial."""
    whose = "as the law's file has it; in leg keel and leg turn already" if of.given else "none: as it stood"
    words = {
        "height": f"of the foot's middle, raised relative to its standing trial, {whose}",
        "height_sd": "standard deviation of that height",
        "pitch": f"of the foot, toes up, relative to its standing trial, {whose}",
        "pitch_sd": "standard deviation of that pitch",
    }
    return {f"foot_{name}": Number(getattr(of, name), "derived", note) for name, note in words.items()}


def _prosthesis(mass: float, centre: Vector, inertia: Float[np.ndarray, "3 3"]) -> dict[str, Number]:
    """Body of socket, pylon and foot shell together."""
    found = {"prosthesis_mass": Number(mass, "derived", "of these three, without keel")}
    found |= _places("prosthesis_centre", centre, "of their mass, in the bushing's frame")
    for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
        note = "about that centre: tubes and a box of invented size"
        found[f"prosthesis_I{'xyz'[a]}{'xyz'[b]}"] = Number(float(inertia[a, b]), "derived", note)
    return found


def combined(parts: tuple[Inertial, ...]) -> Inertial:
    """Several rigid parts in one frame as one."""
    mass = sum(part[0] for part in parts)
    centre = np.asarray(sum(part[0] * part[1] for part in parts) / mass)
    inertia = np.zeros((3, 3))
    for own, place, about in parts:
        arm = place - centre
        inertia += about + own * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass, centre, inertia


def _tube(mass: float, length: float, top: float, radius: float = SOCKET_RADIUS) -> Inertial:
    """A thin cylinder along -y."""
    across = mass * (0.5 * radius**2 + length**2 / 12.0)
    return mass, np.array([0.0, top - 0.5 * length, 0.0]), np.diag([across, mass * radius**2, across])
