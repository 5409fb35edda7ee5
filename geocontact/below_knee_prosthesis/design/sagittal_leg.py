"""Thigh and shank with the prosthesis as two bars below the rest of the body, in the foot's sagittal plane.

All that is neither thigh, residual limb, prosthesis nor keel is a point mass on the hip, as in the study, whose pelvis
turns as recorded. Coordinates are the hip's place and the turns of the two bars in the ground. The shank's frame is the
keel's straight one, which is fixed to the socket.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.model.leg import Leg, combined
from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY

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
    """Of a person's leg on a keel."""
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
    """Of a force [N] on a point of the keel's frame: forces along the coordinates [N, N m]."""
    up, arm = thigh_direction(q[..., 2]), turned(q[..., 3], leg.knee - point)
    turning = [-leg.length * dot(across(up), force), -dot(across(arm), force)]
    return np.concatenate([force, np.stack(turning, axis=-1)], axis=-1)


def _bars(
    leg: SagittalLeg, q: Float[np.ndarray, "*s 4"]
) -> tuple[Float[np.ndarray, "*s 2"], Float[np.ndarray, "*s 2"]]:
    """From the knee to the hip as a direction, from the shank's mass centre to the knee [m]."""
    return thigh_direction(q[..., 2]), turned(q[..., 3], leg.knee - leg.centre)
