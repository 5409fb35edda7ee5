"""The intact leg of one person: lengths, masses, sole, and where its markers are.

Always a left leg: a right one is its mirror image. Frames are right-handed, x forward, y up, z to the right.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.leg import Frustum, Inertial, Person, taper
from geocontact.data.multibody.model import Marker
from geocontact.data.parameter import Number
from geocontact.loads.sphere_set import SoleLaw, SphereSet

Vector = Float[np.ndarray, " 3"]
HEEL, HEEL_APART, SPHERE = 0.03, 0.02, 0.02
"""m; of the heel's spheres in front of the heel's back and of each from the middle, radius of a sphere; invented."""
STIFFNESS, DAMPING, FULL_DEPTH = 30e3, 300.0, 2e-3
"""N/m, N s/m and m; of a sphere's law, linear: two of them sink by 13 mm under 80 kg; invented."""
STATIC, KINETIC, THRESHOLD_SPEED = 0.8, 0.7, 0.01
"""Coefficients of friction, and m/s below which what sticks creeps; invented."""
PIECES = "heel_medial", "heel_lateral", "metatarsal_1", "metatarsal_5", "hallux"
"""Where the sole presses most; the last is on the toes."""


@dataclass(frozen=True, eq=False)
class IntactLeg:
    """Geometry of the intact leg.

    Parameters
    ----------
    person
        Whose leg it is.
    hip
        Its centre in the pelvis' frame [m].
    thigh
        Length, hip to knee [m].
    ankle
        In the shank's frame (origin in the knee) [m].
    knee_radius, ankle_radius
        Half the distance of epicondyles, and of malleoli [m].
    heel, metatarsals, hallux
        Back of the heel, heads of the first and of the fifth metatarsal, tip of the big toe: in the foot's frame
        (origin in the ankle, x along the foot, y up from the floor) [m].
    sole
        Height of the ankle above the sole [m].
    markers
        On the bodies `intact_thigh`, `intact_shank`, `intact_foot` and `intact_toes`, the last one in a frame with its
        origin in the toe joint and the foot's axes.
    """

    person: Person
    hip: Vector
    thigh: float
    ankle: Vector
    knee_radius: float
    ankle_radius: float
    heel: Vector
    metatarsals: tuple[Vector, Vector]
    hallux: Vector
    sole: float
    markers: tuple[Marker, ...] = field(default=())

    @property
    def shank(self) -> float:
        """Length, knee to ankle along the shank's axis [m]."""
        return float(-self.ankle[1])

    @property
    def toe_joint(self) -> Vector:
        """Middle of the metatarsal heads, in the foot's frame [m]."""
        return np.asarray(0.5 * (self.metatarsals[0] + self.metatarsals[1]))

    @property
    def toe_axis(self) -> Vector:
        """Through the metatarsal heads in the plane of the floor, to the right; about it the toes bend up."""
        across = (self.metatarsals[0] - self.metatarsals[1]) * np.array([1.0, 0.0, 1.0])
        return np.asarray(across / np.linalg.norm(across))

    @property
    def length(self) -> float:
        """Length of the foot, from the heel to the tip along x [m]."""
        return float(self.hallux[0] - self.heel[0])

    def thigh_body(self) -> Inertial:
        """Body of the thigh in its frame, by the segment's shares of mass and length."""
        of = self.person.segments["thigh"]
        mass = of.mass * self.person.mass
        sagittal, transverse, long = of.moments(mass, self.thigh)
        return mass, np.array([0.0, -of.centre * self.thigh, 0.0]), np.diag([sagittal, long, transverse])

    @property
    def shank_frustum(self) -> Frustum:
        """Between knee and ankle."""
        return Frustum(self.shank, self.knee_radius, self.ankle_radius)

    @property
    def density(self) -> float:
        """Density of that frustum with the mass of a shank [kg/m³]."""
        return self.person.segments["shank"].mass * self.person.mass / self.shank_frustum.volume

    def shank_body(self) -> Inertial:
        """Body of the shank in its frame."""
        return self.shank_frustum.body(self.density)

    def foot_bodies(self) -> tuple[Inertial, Inertial]:
        """Bodies of the foot in its frame, and of the toes in a frame with the same axes and its origin in the toe
        joint.

        A frustum from heel to tip, as thick at the heel as the ankle, whose taper puts the mass centre where de Leva
        has it; cut off at the toe joint. Half-way up between sole and ankle.
        """
        of = self.person.segments["foot"]
        whole = Frustum(self.length, self.ankle_radius, taper(of.centre) * self.ankle_radius)
        density = of.mass * self.person.mass / whole.volume
        back = float(self.toe_joint[0] - self.heel[0])
        rear = whole.cut(back)
        front = Frustum(self.length - back, rear.distal, whole.distal)
        up = -0.5 * self.sole
        start = np.array([self.heel[0], up, 0.0])
        toes = np.array([0.0, up - self.toe_joint[1], -self.toe_joint[2]])
        return _along_x(rear.body(density), start), _along_x(front.body(density), toes)

    def spheres(self) -> tuple[SphereSet, SphereSet]:
        """Spheres of the sole, on the foot in its frame and on the toes in theirs; places follow the markers, sizes do
        not.

        The study puts spheres where pressure is high and does not tell where.
        """
        low = SPHERE - self.sole
        places = [np.array([self.heel[0] + HEEL, low, z]) for z in (HEEL_APART, -HEEL_APART)]
        places += [np.array([place[0], low, place[2]]) for place in self.metatarsals]
        radius = np.full(len(places), SPHERE)
        toe = np.array([self.hallux[0] - SPHERE, low, self.hallux[2]]) - self.toe_joint
        return SphereSet(np.array(places), radius, PIECES[:-1]), SphereSet(toe[None], radius[:1], PIECES[-1:])

    def laws(self) -> tuple[SoleLaw, SoleLaw]:
        """Laws of these spheres. The study has no force under the intact foot to fit them to either: they bear the
        body.
        """
        found = []
        for spheres in self.spheres():
            ones = np.ones(len(spheres))
            found.append(
                SoleLaw(
                    stiffness=STIFFNESS * ones,
                    damping=DAMPING * ones,
                    exponent=1.0,
                    full_depth=FULL_DEPTH,
                    static=STATIC * ones,
                    kinetic=KINETIC * ones,
                    threshold_speed=THRESHOLD_SPEED,
                )
            )
        return found[0], found[1]

    def numbers(self) -> Mapping[str, Number]:
        """Every number of the segments in SI, and where it is from."""
        leva, measured = f"{self.person.segments.source}, of the body's mass", "from the markers of the standing trial"
        rear, toes = self.foot_bodies()
        return {
            "thigh_length": Number(self.thigh, "derived", measured),
            "shank_length": Number(self.shank, "derived", measured),
            "foot_length": Number(self.length, "derived", measured),
            "knee_radius": Number(self.knee_radius, "derived", f"{measured}: half the distance of the epicondyles"),
            "ankle_radius": Number(self.ankle_radius, "derived", f"{measured}: half the distance of the malleoli"),
            "ankle_height": Number(self.sole, "derived", measured),
            "thigh_mass": Number(self.thigh_body()[0], "derived", leva),
            "shank_mass": Number(self.shank_body()[0], "derived", leva),
            "shank_density": Number(self.density, "derived", "that mass in a frustum from knee to ankle"),
            "foot_mass": Number(rear[0], "derived", f"{leva}; a frustum from heel to tip, up to the toe joint"),
            "toes_mass": Number(toes[0], "derived", "what is in front of it"),
            "sole_sphere_radius": Number(SPHERE, "invented", "of five spheres"),
        }


def _along_x(body: Inertial, start: Vector) -> Inertial:
    """A body along -y as one along x from a start."""
    mass, centre, inertia = body
    turn = Rotation.from_euler("z", np.pi / 2.0).as_matrix()
    return mass, start + turn @ centre, turn @ inertia @ turn.T
