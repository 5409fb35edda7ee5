"""Moments and work of the joints of a walk, and a proxy of what that work costs.

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
class JointWork:
    """What a joint does along one coordinate.

    Parameters
    ----------
    peak, mean
        Size of the moment [N m], the mean over time.
    positive, negative
        Work [J], both without a sign.
    """

    peak: float
    mean: float
    positive: float
    negative: float


def joint_work(
    time: Float[np.ndarray, " t"],
    names: Sequence[str],
    rates: Float[np.ndarray, "t n"],
    forces: Float[np.ndarray, "t n"],
) -> dict[str, JointWork]:
    """Moments and work of each coordinate of a joint.

    Parameters
    ----------
    rates, forces
        Along the coordinates over time [rad/s, N m].
    """
    lasting, found = float(time[-1] - time[0]), {}
    for k, name in enumerate(names):
        if name.startswith(NO_JOINTS):
            continue
        moment = forces[:, k]
        power = moment * rates[:, k]
        positive, negative = (float(np.trapezoid(np.maximum(sign * power, 0.0), time)) for sign in (1.0, -1.0))
        mean = float(np.trapezoid(np.abs(moment), time)) / lasting
        found[name] = JointWork(float(np.abs(moment).max()), mean, positive, negative)
    return found


def metabolic_proxy(work: Mapping[str, JointWork]) -> float:
    """What the work of all joints costs by the efficiencies of muscle [J]."""
    return sum(each.positive / SHORTENING + each.negative / STRETCHED for each in work.values())
