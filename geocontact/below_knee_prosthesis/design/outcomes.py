"""What a foot means for the person, in numbers: moments, energy, roll-over, landing.

The arc is the circle of least algebraic error (Kåsa 1976); a path that is straight has no radius.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.both_sides.joint_work import joint_moments, joint_work, metabolic_proxy
from geocontact.below_knee_prosthesis.design.aims import Aim
from geocontact.below_knee_prosthesis.design.foot_map import CarriedLoad


@dataclass(frozen=True)
class Arc:
    """A circle through a path, lying above it.

    Parameters
    ----------
    radius
        [m]; infinite for a straight path, negative where it curves upwards.
    middle
        Of the circle, forward and up [m].
    off
        Root mean square distance of the path [m].
    """

    radius: float
    middle: tuple[float, float]
    off: float


def arc_through(points: Float[np.ndarray, "t 2"]) -> Arc:
    """Through a path in the sagittal plane, forward and up [m]; ValueError for fewer than three points."""
    if len(points) < 3:
        raise ValueError("an arc needs three points")
    base = points.mean(axis=0)
    x, y = (points - base).T
    matrix = np.column_stack([2.0 * x, 2.0 * y, np.ones(len(x))])
    (a, b, c), *_ = np.linalg.lstsq(matrix, x**2 + y**2, rcond=None)
    radius = float(np.sqrt(max(c + a**2 + b**2, 0.0)))
    off = np.hypot(x - a, y - b) - radius
    sign = 1.0 if b >= 0.0 else -1.0
    return Arc(sign * radius, (float(base[0] + a), float(base[1] + b)), float(np.sqrt(np.mean(off**2))))


Sense = Literal["least", "most", "nearest"]


@dataclass(frozen=True)
class Measure:
    """A number of a stance: what it is, its unit, and which is best unless a target is given."""

    words: str
    unit: str
    sense: Sense


MEASURES: Mapping[Aim, Measure] = {
    "ankle_moment": Measure("peak ankle moment", "N m", "least"),
    "socket_moment": Measure("peak moment at the socket, in the sagittal plane", "N m", "least"),
    "energy": Measure("energy that the keel returns", "J", "most"),
    "radius": Measure("radius of the roll-over shape", "m", "nearest"),
    "loading_rate": Measure("rate of loading at touch-down", "N/s", "least"),
    "ankle_mean": Measure("mean ankle moment", "N m", "least"),
    "socket_mean": Measure("mean moment at the socket, in the sagittal plane", "N m", "least"),
    "knee_moment": Measure("peak knee moment", "N m", "least"),
    "knee_mean": Measure("mean knee moment", "N m", "least"),
    "hip_moment": Measure("peak hip moment", "N m", "least"),
    "hip_mean": Measure("mean hip moment", "N m", "least"),
    "metabolic": Measure("metabolic proxy, work of hip and knee over the stance", "J", "least"),
}
LEG = ("hip_r", "knee_r")
"""Joints of the leg above the prosthesis."""
ROLLING = 0.3
"""Radius over the length of the leg: where walking costs least (Adamczyk, Collins & Kuo 2006, J Exp Biol 209)."""
ROLLS = 0.8
"""Share of the stance up to which the path of the centre of pressure is a roll-over shape: to opposite heel contact."""
FIRM = 0.2
"""Share of body weight; load from which it counts."""
LANDING = 0.3
"""Share of body weight; load at which the stiffness of the landing foot is taken."""


def outcomes(found: CarriedLoad) -> dict[Aim, float]:
    """By measure, in SI.

    Energy returned is what the keel has stored at most, less what is left at the end and what its dampers take on the
    way. The rate of loading is the foot's stiffness as it lands times the speed at which it comes down. Means are those
    of a moment's size over the loaded stance. The metabolic proxy is that of the work of hip and knee (`joint_work`);
    what the other leg does is not in it.
    """
    time, socket, torques = found.task.time, found.moment(found.task.bushing), found.leg_torques
    rates = np.gradient(found.leg_angles, time, axis=0)
    moments = np.column_stack([found.ankle_moment, socket, torques])
    ankle, limb, hip, knee = joint_moments(time, ("ankle", "limb", *LEG), moments).values()
    return {
        "ankle_moment": float(found.ankle_moment.max()),
        "socket_moment": float(np.abs(found.moment(found.task.bushing)).max()),
        "energy": returned(found),
        "radius": roll_over_radius(found),
        "loading_rate": loading_rate(found),
        "ankle_mean": ankle.mean,
        "socket_mean": limb.mean,
        "knee_moment": knee.peak,
        "knee_mean": knee.mean,
        "hip_moment": hip.peak,
        "hip_mean": hip.mean,
        "metabolic": metabolic_proxy(joint_work(time, LEG, rates, torques)),
    }


def returned(found: CarriedLoad) -> float:
    """Energy [J]."""
    at = int(np.argmax(found.stored))
    keel = found.foot.keel
    if at + 1 >= len(found.stored):
        return 0.0
    rate = np.gradient(found.angles, found.task.time, axis=0)
    lost = np.trapezoid((rate**2 @ keel.keel.damping(keel.fulcrum))[at:], found.task.time[at:])
    return float(found.stored[at] - found.stored[-1] - lost)


def roll_over_radius(found: CarriedLoad) -> float:
    """Radius of the arc through the centre of pressure in the shank's frame [m]."""
    return radius_of_path(found.task.time, found.task.load / found.task.weight, shank_path(found))


def radius_of_path(
    time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"], path: Float[np.ndarray, "t 2"]
) -> float:
    """The same of a path over the loaded stance [m]; the load is over body weight."""
    share = (time - time[0]) / (time[-1] - time[0])
    return arc_through(path[(share <= ROLLS) & (load >= FIRM)]).radius


def shank_path(found: CarriedLoad) -> Float[np.ndarray, "t 2"]:
    """Centre of pressure in the shank's frame, forward and up from the ankle [m]: the roll-over shape."""
    task = found.task
    up = task.knee - task.ankle
    turn = Rotation.from_euler("z", 0.5 * np.pi - np.arctan2(up[1], up[0]))
    places = np.column_stack([found.centre - task.ankle[:2], np.zeros(len(found.centre))])
    return np.asarray(turn.apply(places)[:, :2])


def loading_rate(found: CarriedLoad) -> float:
    """At touch-down [N/s]."""
    task = found.task
    at = int(np.argmax(task.load >= LANDING * task.weight))
    pitch = np.full(2, task.pitch[at] + found.tilt[at])
    height = found.foot.at(pitch, np.array([0.5, 1.0]) * LANDING * task.weight)[:, 0]
    stiffness = 0.5 * LANDING * task.weight / max(float(height[0] - height[1]), 1e-6)
    return stiffness * task.falling
