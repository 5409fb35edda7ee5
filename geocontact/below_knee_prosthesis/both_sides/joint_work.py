"""Moments and work of the joints of a walk, and a proxy of what that work costs.

The power of a joint is the sum over its coordinates: what one of them gains another may take.

The proxy is positive mechanical work over an efficiency of 0.25 and negative work over 1.2, those of muscles that
shorten and that are stretched (Margaria 1968, Int Z angew Physiol 25, 339-351): a number to compare motions of one
person by, no measurement of metabolism. Muscles that work against each other, hold without moving or carry energy
across two joints are not in it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

SHORTENING, STRETCHED = 0.25, 1.2
"""Efficiency of positive and of negative work."""
NO_JOINTS = ("pelvis", "socket", "keel")
"""Beginnings of coordinates that no muscle drives."""


@dataclass(frozen=True)
class JointMoment:
    """Size of a moment along one coordinate of a joint [N m]: its peak, and its mean over time."""

    peak: float
    mean: float


@dataclass(frozen=True)
class JointWork:
    """Positive and negative work of a joint [J], both without a sign."""

    positive: float
    negative: float


def joint_of(name: str) -> str:
    """The joint that a coordinate is of: hip_r of hip_flexion_r."""
    return f"{name.partition('_')[0]}{name[-2:]}"


def joint_moments(
    time: Float[np.ndarray, " t"], names: Sequence[str], forces: Float[np.ndarray, "t n"]
) -> dict[str, JointMoment]:
    """Moments along each coordinate of a joint, by its name; `forces` are those along all over time [N m]."""
    lasting, found = float(time[-1] - time[0]), {}
    for name, column in zip(names, np.abs(forces).T, strict=True):
        if not name.startswith(NO_JOINTS):
            found[name] = JointMoment(float(column.max()), float(np.trapezoid(column, time)) / lasting)
    return found


def joint_work(
    time: Float[np.ndarray, " t"],
    names: Sequence[str],
    rates: Float[np.ndarray, "t n"],
    forces: Float[np.ndarray, "t n"],
) -> dict[str, JointWork]:
    """Work of each joint, by the power of all its coordinates together.

    Parameters
    ----------
    rates, forces
        Along the coordinates over time [rad/s, N m].
    """
    power: dict[str, Float[np.ndarray, " t"]] = {}
    for name, rate, moment in zip(names, rates.T, forces.T, strict=True):
        if not name.startswith(NO_JOINTS):
            power[joint_of(name)] = power.get(joint_of(name), 0.0) + rate * moment
    return {
        joint: JointWork(*(float(np.trapezoid(np.maximum(sign * own, 0.0), time)) for sign in (1.0, -1.0)))
        for joint, own in power.items()
    }


def metabolic_proxy(work: Mapping[str, JointWork]) -> float:
    """What the work of all joints costs by the efficiencies of muscle [J]."""
    return sum(each.positive / SHORTENING + each.negative / STRETCHED for each in work.values())
