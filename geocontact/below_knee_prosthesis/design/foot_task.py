"""What a foot has to carry in a stance, on level ground or another, with thigh and shank above it as two bars.

Taken from one recorded stance. What is not taken is the height of the foot: another foot carries the same load at
another height, and the person's leg, free upwards, gives way by that much.

All that is neither thigh, residual limb, prosthesis nor keel is a point mass on the hip, as in the study, whose pelvis
turns as recorded. Coordinates are the hip's place and the turns of the two bars in the ground. The shank's frame is the
keel's straight one, which is fixed to the socket.

What the person does there is bounded as on another foot. With the angles kept the socket turns in the laboratory as
recorded, so that on a slope the foot meets the ground turned by it; with the torque kept the foot turns until the ankle
has the moment of the recorded foot on level ground. The force that the ground returns is the recorded one: it carries
the same body along the same path.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.leg import Leg, combined
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Ground, Stairs

COORDINATES = ("hip x", "hip y", "thigh", "shank")


@dataclass(frozen=True, eq=False)
class SagittalLeg:
    """Masses and lengths.

    Parameters
    ----------
    body
        Mass on the hip [kg].
    length, thigh
        Of the thigh [m]; mass [kg], mass centre from the hip along it [m], moment of inertia about that [kg m²].
    knee, centre
        Of the shank in the keel's frame, x and y [m].
    shank
        Mass of residual limb, prosthesis and keel [kg], and moment of inertia about their centre [kg m²].
    """

    body: float
    length: float
    thigh: tuple[float, float, float]
    knee: Float[np.ndarray, "*n 2"]
    centre: Float[np.ndarray, "*n 2"]
    shank: tuple[float, float]

    def aligned(self, angle: float, ankle: Float[np.ndarray, " 2"]) -> SagittalLeg:
        """With the foot turned toes up by an angle [rad] about the ankle: in its frame the shank turns back."""
        c, s = np.cos(angle), np.sin(angle)
        back = np.array([[c, s], [-s, c]])
        knee, centre = (ankle + back @ (each - ankle) for each in (self.knee, self.centre))
        return SagittalLeg(self.body, self.length, self.thigh, knee, centre, self.shank)


def sagittal_leg(leg: Leg, keel: Keel) -> SagittalLeg:
    """The bars of a person's leg on a keel."""
    place, own = leg.turn.inv(), keel.posterior_mass + keel.joints * keel.segment_mass
    mass, centre, inertia = leg.residual_body()
    turned = place.as_matrix() @ inertia @ place.as_matrix().T
    residual = (mass, place.apply(centre - leg.keel), turned)
    mass, centre, inertia = leg.prosthesis_body()
    bushing = place.apply(leg.bushing - leg.keel)
    below = combined(
        (residual, (mass, bushing + centre, inertia), (own, np.array([0.5 * keel.length, 0.0, 0.0]), _none()))
    )
    mass, centre, inertia = leg.thigh_body()
    return SagittalLeg(
        leg.pelvis_mass(own),
        leg.thigh,
        (mass, float(-centre[1]), float(inertia[2, 2])),
        place.apply(-leg.keel)[:2],
        below[1][:2],
        (below[0], float(below[2][2, 2])),
    )


def _none() -> Float[np.ndarray, "3 3"]:
    return np.zeros((3, 3))


def turned(angle: Float[np.ndarray, "*s"], vector: Float[np.ndarray, "*#s 2"]) -> Float[np.ndarray, "*s 2"]:
    """Vectors of a frame that is turned by an angle [rad] in the ground's."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = vector[..., 0], vector[..., 1]
    return np.stack([c * x - s * y, s * x + c * y], axis=-1)


def across(vector: Float[np.ndarray, "*s 2"]) -> Float[np.ndarray, "*s 2"]:
    """Turned by a quarter to the left."""
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)


def dot(one: Float[np.ndarray, "*s 2"], other: Float[np.ndarray, "*#s 2"]) -> Float[np.ndarray, "*s"]:
    """Product along the last axis."""
    return np.asarray(one[..., 0] * other[..., 0] + one[..., 1] * other[..., 1])


def thigh_direction(angle: Float[np.ndarray, "*s"]) -> Float[np.ndarray, "*s 2"]:
    """From the knee to the hip; upright at 0, leaning back the further it turns to the left."""
    return np.stack([-np.sin(angle), np.cos(angle)], axis=-1)


def mass_matrix(leg: SagittalLeg, q: Float[np.ndarray, "*s 4"]) -> Float[np.ndarray, "*s 4 4"]:
    """By `COORDINATES`."""
    (m1, a, i1), (m2, i2) = leg.thigh, leg.shank
    up, arm = _bars(leg, q)
    found = np.zeros((*q.shape, 4))
    found[..., 0, 0] = found[..., 1, 1] = leg.body + m1 + m2
    one, two = -(m1 * a + m2 * leg.length) * across(up), -m2 * across(arm)
    found[..., :2, 2] = found[..., 2, :2] = one
    found[..., :2, 3] = found[..., 3, :2] = two
    found[..., 2, 2] = m1 * a**2 + i1 + m2 * leg.length**2
    found[..., 2, 3] = found[..., 3, 2] = m2 * leg.length * dot(up, arm)
    found[..., 3, 3] = m2 * dot(arm, arm) + i2
    return found


def bias(leg: SagittalLeg, q: Float[np.ndarray, "*s 4"], u: Float[np.ndarray, "*s 4"]) -> Float[np.ndarray, "*s 4"]:
    """Forces that turning and weight need without any acceleration [N, N m]."""
    (m1, a, _), (m2, _) = leg.thigh, leg.shank
    up, arm = _bars(leg, q)
    w1, w2 = (u[..., k, None] ** 2 for k in (2, 3))
    lift = np.array([0.0, GRAVITY])
    first, second = a * w1 * up + lift, leg.length * w1 * up + w2 * arm + lift
    return np.concatenate(
        [
            leg.body * lift + m1 * first + m2 * second,
            -dot(across(up), m1 * a * first + m2 * leg.length * second)[..., None],
            -dot(across(arm), m2 * second)[..., None],
        ],
        axis=-1,
    )


def point_of_shank(
    leg: SagittalLeg, q: Float[np.ndarray, "*s 4"], u: Float[np.ndarray, "*s 4"], point: Float[np.ndarray, "*#s 2"]
) -> tuple[Float[np.ndarray, "*s 2"], Float[np.ndarray, "*s 2"]]:
    """Place and velocity of a point of the keel's frame [m, m/s]."""
    up = thigh_direction(q[..., 2])
    arm = turned(q[..., 3], leg.knee - point)
    place = q[..., :2] - leg.length * up - arm
    speed = u[..., :2] - leg.length * u[..., 2, None] * across(up) - u[..., 3, None] * across(arm)
    return place, speed


def force_along(
    leg: SagittalLeg, q: Float[np.ndarray, "*s 4"], point: Float[np.ndarray, "*#s 2"], force: Float[np.ndarray, "*#s 2"]
) -> Float[np.ndarray, "*s 4"]:
    """Generalised forces of a force [N] on a point of the keel's frame: forces along the coordinates [N, N m]."""
    up, arm = thigh_direction(q[..., 2]), turned(q[..., 3], leg.knee - point)
    turning = [-leg.length * dot(across(up), force), -dot(across(arm), force)]
    return np.concatenate([force, np.stack(turning, axis=-1)], axis=-1)


def _bars(
    leg: SagittalLeg, q: Float[np.ndarray, "*s 4"]
) -> tuple[Float[np.ndarray, "*s 2"], Float[np.ndarray, "*s 2"]]:
    """From the knee to the hip as a direction, from the shank's mass centre to the knee [m]."""
    return thigh_direction(q[..., 2]), turned(q[..., 3], leg.knee - leg.centre)


LOADED = 0.08
"""Share of body weight; frames with less are left out."""
EVERY = 2
"""Which frame of a recorded stance is taken: 100 Hz."""


@dataclass(frozen=True, eq=False)
class FootTask:
    """A stance as a foot has to carry it, in the frame of a right leg.

    Parameters
    ----------
    time
        Of the frames [s].
    pitch
        Of the keel's straight axis against the floor, toes up [rad].
    thigh
        Turn of the thigh in the same plane, from upright, to the left where x points to the right [rad].
    load, forward
        Of the ground on the foot, upwards and forwards along the foot [N].
    falling
        Speed at which the foot comes down at touch-down [m/s].
    ankle, bushing
        In the keel's frame [m].
    knee
        Origin of the shank in the keel's frame [m].
    leg
        Its masses and lengths.
    leg_length
        From the hip to the sole of a straight leg [m].
    weight
        Of the body [N].
    pelvis
        Turn of the pelvis in the same plane [rad].
    needed
        Moments about hip and knee that weight and inertia of thigh and shank need, to the left [N m].
    acceleration
        Second derivatives of `COORDINATES` [m/s², rad/s²], of a spline that goes on into the swing on both sides.
    """

    time: Float[np.ndarray, " t"]
    pitch: Float[np.ndarray, " t"]
    thigh: Float[np.ndarray, " t"]
    load: Float[np.ndarray, " t"]
    forward: Float[np.ndarray, " t"]
    falling: float
    ankle: Float[np.ndarray, " 3"]
    bushing: Float[np.ndarray, " 3"]
    knee: Float[np.ndarray, " 3"]
    leg: SagittalLeg
    leg_length: float
    weight: float
    pelvis: Float[np.ndarray, " t"]
    needed: Float[np.ndarray, "t 2"]
    acceleration: Float[np.ndarray, "t 4"]

    def aligned(self, angle: float) -> FootTask:
        """With the foot turned toes up against the socket by an angle [rad], about the ankle.

        The socket moves as it did, so that the foot turns in the ground's frame and the ankle keeps its place on it.
        """
        back = Rotation.from_euler("z", -angle)
        return replace(
            self,
            pitch=self.pitch + angle,
            bushing=self.ankle + back.apply(self.bushing - self.ankle),
            knee=self.ankle + back.apply(self.knee - self.ankle),
            leg=self.leg.aligned(angle, self.ankle[:2]),
        )


def foot_task(stance: RecordedStance, pelvis: RigidTransform, leg: Leg, keel: Keel, below: float) -> FootTask:
    """From a recorded stance; ValueError where it carries nothing.

    Parameters
    ----------
    pelvis
        Its poses at the stance's times, in the frame of the leg.
    below
        Height of the keel's axis above the sole [m].
    """
    loaded = np.flatnonzero(stance.force[:, 1] > LOADED * stance.weight)
    if not len(loaded):
        raise ValueError("the stance carries nothing")
    kept = np.arange(loaded[0], loaded[-1] + 1, EVERY)
    kept = kept[stance.force[kept, 1] > LOADED * stance.weight]
    axis = stance.poses.rotation.apply([1.0, 0.0, 0.0])
    level = axis[:, ::2] / np.linalg.norm(axis[:, ::2], axis=1, keepdims=True)
    place, hip = leg.turn.inv(), pelvis.apply(leg.hip)

    def turn(up: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, " t"]:
        return np.asarray(np.arctan2(-np.einsum("ti,ti->t", level, up[:, ::2]), up[:, 1]))

    along = level[kept].mean(axis=0)
    pitch = np.arcsin(np.clip(axis[:, 1], -1.0, 1.0))
    thigh = turn(hip - stance.poses.apply(place.apply(-leg.keel)))
    q = np.column_stack([hip[:, ::2] @ along / np.linalg.norm(along), hip[:, 1], thigh, pitch])
    bars = sagittal_leg(leg, keel)
    return FootTask(
        time=stance.time[kept],
        pitch=pitch[kept],
        thigh=thigh[kept],
        load=stance.force[kept, 1],
        forward=np.einsum("ti,ti->t", level[kept], stance.force[kept, ::2]),
        falling=max(float(-stance.rate[int(loaded[0]), 1, 3]), 0.0),
        ankle=place.apply(leg.ankle - leg.keel),
        bushing=place.apply(leg.bushing - leg.keel),
        knee=place.apply(-leg.keel),
        leg=bars,
        leg_length=leg.thigh + leg.shank + float(leg.ankle[1] - leg.keel[1]) + below,
        weight=stance.weight,
        pelvis=turn(pelvis.rotation.apply([0.0, 1.0, 0.0]))[kept],
        needed=needed_of(bars, stance.time, q)[kept],
        acceleration=make_interp_spline(stance.time, q, k=5)(stance.time, 2)[kept],
    )


def needed_of(leg: SagittalLeg, time: Float[np.ndarray, " t"], q: Float[np.ndarray, "t 4"]) -> Float[np.ndarray, "t 2"]:
    """Moments about hip and knee that weight and inertia of a motion need [N m], by `COORDINATES` over time."""
    course = make_interp_spline(time, q, k=5)
    u, a = course(time, 1), course(time, 2)
    along = np.einsum("tij,tj->ti", mass_matrix(leg, q), a) + bias(leg, q, u)
    return np.column_stack([along[:, 2] + along[:, 3], along[:, 3]])


FLAT = HalfSpace()
BELOW = 0.17
"""m; from a step down to the one behind: a usual riser, too far for the heel to reach."""


@dataclass(frozen=True)
class Terrain:
    """Ground under one foot.

    Parameters
    ----------
    slope
        By which it rises forwards [rad].
    edge
        Of a step, ahead of the keel's posterior end while the foot stands flat [m]: what is behind hangs in the air.
        None for no step.
    """

    slope: float = 0.0
    edge: float | None = None

    def met(self, task: FootTask) -> FootTask:
        """A stance of level ground in the frame of this one: turns against it, load along its normal."""
        s, c = np.sin(self.slope), np.cos(self.slope)
        return replace(
            task,
            pitch=task.pitch - self.slope,
            thigh=task.thigh - self.slope,
            load=c * task.load - s * task.forward,
            forward=c * task.forward + s * task.load,
        )

    @property
    def ground(self) -> Ground:
        """In its own frame, a level tread at y = 0; the keel's posterior end stands at x = 0."""
        return FLAT if self.edge is None else Stairs((self.edge,), (-BELOW, 0.0))

    def standing(self, poses: RigidTransform, held: Float[np.ndarray, " 3"]) -> RigidTransform:
        """Moved along the ground so that a point of the keel stays above where it is while the foot is flat."""
        shift = held[0] - poses.apply(held)[:, 0]
        return RigidTransform.from_translation(np.column_stack([shift, 0.0 * shift, 0.0 * shift])) * poses


LEVEL = Terrain()


def words(terrain: Terrain) -> str:
    """Where the foot is judged; nothing for level ground."""
    told = []
    if terrain.slope:
        told.append(
            f"on ground that {'rises' if terrain.slope > 0.0 else 'falls'} by {np.degrees(abs(terrain.slope)):g}°"
        )
    if terrain.edge is not None:
        told.append(f"on a step whose edge is {1e3 * terrain.edge:.0f} mm ahead of the heel")
    return ", ".join(told)
