"""A mat found on a second scan: where it stands off, its outline, its corners. All scans are synthetic."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.geometry.drape.mat import Mat
from geocontact.geometry.drape.scan_difference import Rectangle, rectangle_on, scan_difference
from geocontact.geometry.register.icp import same_place, unguided
from geocontact.geometry.surface import Surface
from tests.geometry.drape.second_scan import ELSEWHERE, bare, corners, with_mat
from tests.geometry.drape.sheets import over, plane


@pytest.mark.slow
@pytest.mark.parametrize(
    ("thickness", "noise", "n", "within"),
    [
        (1.5, 0.1, 40, 0.6),
        pytest.param(3.0, 0.0, 30, 0.7, marks=pytest.mark.long),
        pytest.param(8.0, 0.3, 24, 1.6, marks=pytest.mark.long),
    ],
)
def test_corners_are_found_to_a_part_of_the_scans_edges(thickness, noise, n, within):
    """Through another mesh, turned by a radian, noisy; edges of the scan are 4 to 2 mm long; `within` in mm."""
    first, second = bare(), with_mat(thickness, noise, n=n)
    found = unguided(second, first)
    miss = found.pose * ELSEWHERE
    assert np.linalg.norm(miss.translation) < 1e-4 and np.degrees(miss.rotation.magnitude()) < 0.2
    raised = scan_difference(same_place(second, found), first)
    assert raised.thickness == pytest.approx(1e-3 * thickness, abs=1.5e-4 + 1e-4 * noise)
    assert raised.area == pytest.approx(256e-4, rel=0.08)
    outline = rectangle_on(over((first.vertices, first.faces)), raised.outline, raised.length)
    apart = np.linalg.norm(outline.corners[:, None] - corners()[None], axis=2)
    order = apart.argmin(axis=1)
    assert list((order - order[0]) % 4) == [0, 1, 2, 3], "counter-clockwise seen from outside"
    assert 1e3 * apart.min(axis=1).max() < within
    sides = 1e-3 * 200**0.5 * np.array([16.0, 8.0])
    assert sorted(outline.sides) == pytest.approx(sorted([*sides, *sides]), abs=3e-3)
    assert outline.rms < 1e-3


def test_a_scan_in_the_same_frame_needs_no_search():
    first = bare()
    second = with_mat(3.0, 0.0)
    found = unguided(Surface(ELSEWHERE.inv().apply(second.vertices), second.faces), first)
    assert np.linalg.norm(found.pose.translation) < 1e-4
    assert np.degrees(found.pose.rotation.magnitude()) < 0.05


def test_nothing_that_stands_off_is_told():
    second = with_mat(0.0, 0.0)
    without = Surface(ELSEWHERE.inv().apply(second.vertices), second.faces, "thigh with mat")
    with pytest.raises(ValueError, match=r"nothing on thigh with mat stands off thigh.* by 0\.5 mm or more"):
        scan_difference(without, bare())


@pytest.mark.slow
@pytest.mark.parametrize("turn", [0.0, 0.4, 1.2])
@pytest.mark.parametrize("size", [(0.2, 0.12), (0.15, 0.15)], ids=["oblong", "square"])
def test_a_rectangle_on_a_plane_is_exact(turn, size):
    """Points of its outline, half of them gone, some of them stray: the sides are met all the same."""
    rng = np.random.default_rng(0)
    a, b = size
    along, across = rng.uniform(-0.5, 0.5, (2, 200)) * np.array([[a], [b]])
    half = np.full(200, 0.5)
    sides = [(along, half * b), (along[::-1], -half * b), (half * a, across), (-half[:100] * a, across[:100])]
    outline = np.concatenate([np.column_stack(side) for side in sides])
    X = Rotation.from_rotvec([0.0, 0.0, turn])
    points = X.apply(np.column_stack([outline, np.zeros(len(outline))])) + np.array([0.01, 0.02, 0.0])
    points[::50, :2] += 0.004
    found = rectangle_on(over(plane()), points, np.ones(len(points)))
    expected = X.apply(0.5 * np.array([[-a, -b, 0], [a, -b, 0], [a, b, 0], [-a, b, 0]])) + np.array([0.01, 0.02, 0.0])
    apart = np.linalg.norm(found.corners[:, None] - expected[None], axis=2)
    assert apart.min(axis=1).max() < 3e-4
    assert sorted(found.sides) == pytest.approx(sorted([a, b, a, b]), abs=5e-4)
    inner = rectangle_on(over(plane()), points, np.ones(len(points)), edge=0.01)
    assert sorted(inner.sides) == pytest.approx(sorted([a - 0.02, b - 0.02] * 2), abs=5e-4)


AROUND = np.array([[0.0, 0, 0], [0.2, 0, 0], [0.2, 0.1, 0], [0, 0.1, 0]])
OBLONG = Rectangle(AROUND, np.array([0.2, 0.1, 0.2, 0.1]), 0.0)


@pytest.mark.parametrize(("mirrored", "first"), [(False, [0, 2]), (True, [1, 3])])
def test_rows_run_along_the_long_sides_in_the_mats_order(mirrored, first):
    """Ten rows of 20 mm, five columns: seen from outside, columns lie to the left of the rows' way, or to the right."""
    assert OBLONG.first_corners(Mat(10, 5, (0.02, 0.02), mirrored=mirrored)) == first


def test_any_corner_of_a_square_may_be_the_first_and_none_where_the_mat_is_larger():
    square = Rectangle(OBLONG.corners, np.full(4, 0.1), 0.0)
    assert square.first_corners(Mat(5, 5, (0.02, 0.02))) == [0, 1, 2, 3]
    assert square.first_corners(Mat(6, 5, (0.02, 0.02))) == []
    assert square.first_corners(Mat(6, 5, (0.02, 0.02)), within=0.2) == [0, 1, 2, 3]


@pytest.mark.parametrize(("mirrored", "first", "x"), [(False, 2, [0.2, 0.0]), (True, 1, [0.2, 0.0])])
def test_marks_are_the_corners_from_the_first_cell_on(mirrored, first, x):
    """The end of column 1 is a row's length away along x, the end of row 1 on the other side in y."""
    marks = OBLONG.marks(Mat(10, 5, (0.02, 0.02), mirrored=mirrored), first)
    assert marks.cells.tolist() == [[0, 0], [10, 0], [0, 5], [10, 5]]
    y = OBLONG.corners[first, 1]
    assert marks.points.tolist() == [[x[0], y, 0], [x[1], y, 0], [x[0], 0.1 - y, 0], [x[1], 0.1 - y, 0]]
