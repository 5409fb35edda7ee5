"""The converged reference areas against cases whose answer is known."""

import numpy as np
import pytest

from meshes.reference import area_within, smallest_distance
from meshes.simple_shapes import block, sphere
from tests import closed_forms as exact

SLOPE = np.radians(12.0)


def wedge(gap):
    """A plate and a smaller one that rises from it along x, `gap` above it at x = -10."""
    upper = block(20.0, 16.0, 3.0, 4)
    c, s = np.cos(SLOPE), np.sin(SLOPE)
    flipped = upper[0] * [1, -1, -1] + [10.0, 0.0, 0.0]
    turned = flipped @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    return block(60.0, 60.0, 5.0, 6), (turned + np.array([-10.0, gap, 0.0]), upper[1])


@pytest.mark.parametrize("threshold", [0.5, 1.0, 2.0])
def test_a_wedge_has_a_strip_of_known_width(threshold):
    plate, upper = wedge(0.2)
    strip = 16.0 * (threshold - 0.2) / np.sin(SLOPE)
    # The upright end face of the tilted plate, turned by the slope, counts as well.
    end = 16.0 * min(3.0, (threshold - 0.2) / np.cos(SLOPE))
    sides = (threshold - 0.2) ** 2 / (np.sin(SLOPE) * np.cos(SLOPE))
    area = area_within(upper, plate, threshold, most=40_000)
    assert area.estimate == pytest.approx(strip + end + sides, rel=1e-9)
    assert area.lower <= strip + end + sides <= area.upper


def test_smallest_distance_is_found_inside_a_face():
    ball, plate = sphere(20.0, 6), block(60.0, 60.0, 5.0, 1)
    lower, upper = smallest_distance((ball[0] - [0, ball[0][:, 1].min() - 0.3, 0], ball[1]), plate)
    assert lower <= 0.3 <= upper + 1e-12
    assert upper - lower <= 2e-4


def test_facets_cost_area_in_proportion_to_the_square_of_the_edge():
    cells, cost = np.array([8, 16, 32]), []
    plate = block(60.0, 60.0, 8.0, 12)
    for n in cells:
        ball = sphere(20.0, n)
        area = area_within((ball[0] + [0, 19.6, 0], ball[1]), plate, 4.0, most=40_000)
        cost.append(exact.sphere_plane_on_sphere(20.0, -0.4, 4.0) - area.estimate)
    order = -np.polyfit(np.log(cells), np.log(cost), 1)[0]
    assert order == pytest.approx(2.0, abs=0.15), f"observed order {order:.2f}, costs {cost}"
