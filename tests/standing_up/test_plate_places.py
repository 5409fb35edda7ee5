"""Plates by where their centre of pressure lies, of a body whose places are set by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.data.wrench import Wrench
from geocontact.standing_up.plate_places import BodySites, plate_places

TIME = np.linspace(0.0, 1.0, 11)


def still(x: float, z: float) -> np.ndarray:
    return np.tile([x, 0.1, z], (len(TIME), 1))


def plate(name: str, x: float, z: float) -> ForcePlate:
    """300 N straight up at a point of the floor."""
    up = np.tile([0.0, 300.0, 0.0], (len(TIME), 1))
    origin = np.tile([x, 0.0, z], (len(TIME), 1))
    return ForcePlate(name, TIME, Wrench(up, 0.0 * up, origin, "ground"), np.zeros(3), np.array([0.0, 1.0, 0.0]))


def sitting(ankles: float) -> BodySites:
    """Hips at 0, knees 0.4 m ahead of them, ankles this far ahead and 0.2 m apart."""
    forward = np.tile([1.0, 0.0, 0.0], (len(TIME), 1))
    at = {"right": still(ankles, 0.1), "left": still(ankles, -0.1)}
    return BodySites(TIME, at, {"right": forward, "left": forward}, still(0.0, 0.0), still(0.4, 0.0))


@pytest.mark.parametrize("ankles", [0.1, 0.2, 0.45])
def test_a_chair_between_the_ankles_is_the_seat(ankles: float) -> None:
    """Wherever the ankles of somebody who sits are, as long as each foot has its own plate."""
    right, left = plate("R", ankles + 0.05, 0.1), plate("L", ankles + 0.05, -0.1)
    chair = plate("C", 0.1, 0.0)
    found = {each.name: each for each in plate_places((chair, left, right), sitting(ankles))}
    assert [found[name].carries for name in "RLC"] == ["right foot", "left foot", "seat"]
    assert found["C"].away == pytest.approx(found["C"].from_seat) == pytest.approx(0.0, abs=1e-12)


def test_one_plate_between_the_feet_carries_both() -> None:
    (found,) = plate_places((plate("P", 0.2, 0.0),), sitting(0.15))
    assert found.carries == "both feet"
