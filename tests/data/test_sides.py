"""Sides of the body in names."""

from __future__ import annotations

import pytest

from geocontact.data.sides import differ_by_side, stem_and_side


@pytest.mark.parametrize(
    ("name", "stem", "side"),
    [
        ("hip_flexion_r", "hip_flexion", "right"),
        ("knee_left", "knee", "left"),
        ("l_elbow", "elbow", "left"),
        ("pelvis_tilt", "pelvis_tilt", ""),
        ("r", "r", ""),
    ],
)
def test_sides_of_names(name: str, stem: str, side: str) -> None:
    assert stem_and_side(name) == (stem, side)


@pytest.mark.parametrize(
    ("one", "other", "sides"),
    [
        ("R.ASIS", "L.ASIS", True),
        ("knee_l", "knee_r", True),
        ("LeftHeel", "RightHeel", True),
        ("heel.right", "heel.left", True),
        ("RKNE", "LANK", False),
        ("R.Toe.Lat", "L.Toe.Med", False),
        ("R.Toe", "R.Toe2", False),
        ("toe1", "toe2", False),
    ],
)
def test_names_that_differ_by_the_side_alone(one: str, other: str, sides: bool) -> None:
    assert differ_by_side(one, other) == sides
