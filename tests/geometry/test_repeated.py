"""The clip at many poses through the certified grid: equal to the exact clip, with the derivative of a closed form."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.geometry.contact_area.area import areas_cut_once
from geocontact.geometry.contact_area.repeated import RepeatedArea
from geocontact.geometry.contact_area.sampled import Sampled
from geocontact.geometry.surface import Surface
from meshes import simple_shapes as shapes
from tests.geometry.bodies import MM, surface, turned

R = 20.0
BALL, PLATE = surface(shapes.sphere(R, 16)), surface(shapes.block(80.0, 80.0, 12.0, 16), "plate")
CUP = surface(shapes.cup(24.0, 5.0, 16), "cup")
OPEN = Surface(CUP.vertices, CUP.faces[5:], "cup with a hole")
TWICE = Surface(np.vstack([CUP.vertices, CUP.vertices + 2e-3]), np.vstack([CUP.faces, CUP.faces + len(CUP.vertices)]))


@pytest.mark.parametrize("threshold", [4.0, 0.5])
@pytest.mark.parametrize("other", [CUP, OPEN, TWICE], ids=["closed", "open", "overlapping parts"])
def test_area_is_that_of_the_exact_clip(other, threshold):
    rng = np.random.default_rng(1)
    rotation = Rotation.random(12, random_state=1).as_matrix()
    translation = rng.uniform(-6.0, 6.0, (12, 3)) * MM
    sampled = Sampled.of(BALL, threshold * MM)
    exact = [
        areas_cut_once(sampled, sampled.distances(other, r, p), (threshold * MM,))[0]
        for r, p in zip(rotation, translation, strict=True)
    ]
    found = RepeatedArea(BALL, other, threshold * MM).at(rotation, translation).area
    assert max(exact) > 1e-5
    np.testing.assert_allclose(found, exact, rtol=1e-9, atol=1e-15)


def test_slope_of_a_cap_is_that_of_the_closed_form():
    """A = 2 pi R (T - h) on a ball at the gap h: -2 pi R to a rise, by its arm to a turn."""
    centre = np.array([7.0, R + 1.0, -3.0]) * MM
    found = RepeatedArea(BALL, PLATE, 4e-3).at(turned(10, 20, 30).as_matrix()[None], centre[None])
    rate = -2.0 * np.pi * R * MM
    expected = rate * np.array([0.0, 1.0, 0.0, -centre[2], 0.0, centre[0]])
    scale = abs(rate) * np.array([1.0, 1.0, 1.0, *[R * MM] * 3])
    np.testing.assert_allclose((found.slope[0] - expected) / scale, 0.0, atol=0.01)


def test_slope_agrees_with_differences_of_the_area():
    areas, step = RepeatedArea(BALL, CUP, 1e-3), 1e-8
    rotation, translation = turned(3, 4, 5).as_matrix(), np.array([1.0, -3.4, 0.5]) * MM
    for k, way in enumerate(np.eye(6) * step):
        sides = [Rotation.from_rotvec(sign * way[3:]).as_matrix() for sign in (1, -1)]
        shifts = [side @ translation + sign * way[:3] for side, sign in zip(sides, (1, -1), strict=True)]
        up, down = areas.at(np.array(sides) @ rotation, np.array(shifts)).area
        slope = areas.at(rotation[None], translation[None]).slope[0, k]
        assert (up - down) / (2 * step) == pytest.approx(slope, rel=1e-4, abs=1e-6)
