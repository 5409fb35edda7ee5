"""Moment of an arm's weight by hand, and the scales that persons get from it."""

from __future__ import annotations

import pytest

from geocontact.data.body_segments import body_segments
from geocontact.shoulder_exoskeleton.human_arm import arm_moment
from geocontact.shoulder_exoskeleton.support.arm_trial import scales_of


def test_the_moment_of_a_man_s_arm_by_hand() -> None:
    """De Leva's table 4, men: 2.71, 1.62, 0.61 % of the mass at 57.72, 45.74, 79.00 % of 281.7, 268.9, 86.2 mm."""
    weight = 73.0 * 9.81
    by_hand = weight * (
        0.0271 * 0.5772 * 0.2817 + 0.0162 * (0.2817 + 0.4574 * 0.2689) + 0.0061 * (0.2817 + 0.2689 + 0.79 * 0.0862)
    )
    assert arm_moment(73.0, body_segments("male"), 0.2817) == pytest.approx(by_hand, rel=1e-12)
    assert arm_moment(73.0, body_segments("male"), 2.0 * 0.2817) == pytest.approx(2.0 * by_hand, rel=1e-12)
    assert arm_moment(61.0, body_segments("female"), 0.268) < 0.8 * arm_moment(70.0, body_segments("male"), 0.278)


def test_scales_are_shares_of_the_heaviest_maker() -> None:
    found = scales_of({"P1": 12.0, "P2": 9.0, "P3": 6.0}, {"P2", "P3"})
    assert found == pytest.approx({"P1": 1.0, "P2": 1.0, "P3": 2.0 / 3.0}), "P1 is heavier than any maker"


def test_the_arm_of_a_child_by_hand() -> None:
    """A boy of 9 years and 30 kg: half-way between the printed percentages at 6 and 12 years, upper arm of 230 mm."""
    at6, at12 = 100.2, 100.2  # sums of both columns, limbs twice
    upper, fore, hand = (0.5 * (a / at6 + b / at12) * 30.0 for a, b in ((2.4, 3.2), (1.3, 1.7), (0.8, 0.9)))
    size = 0.230 / 0.2817
    long, short = size * 0.2689, size * 0.0862
    levers = 0.5772 * 0.230, 0.230 + 0.4574 * long, 0.230 + long + 0.79 * short
    by_hand = 9.81 * (upper * levers[0] + fore * levers[1] + hand * levers[2])
    assert arm_moment(30.0, body_segments("male", 9.0), 0.230) == pytest.approx(by_hand, rel=1e-12)


def test_an_arm_of_its_own_by_hand() -> None:
    own = {
        "upper_arm": {"mass": 1.4, "length": 0.30, "centre": 0.16},
        "forearm": {"mass": 0.8, "length": 0.21, "centre": 0.09},
        "hand": {"mass": 0.3, "length": 0.08, "centre": 0.05},
    }
    body = body_segments("female", mass=55.0, height=1.65, own=own)
    by_hand = 9.81 * (1.4 * 0.16 + 0.8 * (0.30 + 0.09) + 0.3 * (0.30 + 0.21 + 0.05))
    assert arm_moment(55.0, body, 0.30) == pytest.approx(by_hand, rel=1e-12)
