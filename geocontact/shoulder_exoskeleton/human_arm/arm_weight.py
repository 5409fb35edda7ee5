"""Moment of an arm's weight, from what is known of a person without any trial: body mass, sex, length of the upper arm.

Shares of mass and mass centres are de Leva's; forearm and hand are as long beside the upper arm as those of his mean
person.
"""

from __future__ import annotations

from geocontact.data.body_segments import SEGMENTS, Sex

GRAVITY = 9.81
"""m/s²; only ratios of persons count."""
CHAIN = ("upper_arm", "forearm", "hand")
"""From the shoulder outwards."""


def arm_moment(mass: float, sex: Sex, upper_arm: float) -> float:
    """About the shoulder, of the arm stretched out level [N m].

    Parameters
    ----------
    mass
        Of the whole body [kg].
    upper_arm
        Shoulder to elbow [m].
    """
    size = upper_arm / SEGMENTS[sex][CHAIN[0]].length
    moment, start = 0.0, 0.0
    for name in CHAIN:
        segment = SEGMENTS[sex][name]
        moment += segment.mass * mass * GRAVITY * size * (start + segment.centre * segment.length)
        start += segment.length
    return moment
