"""Marks hold a mat where they were found, as a whole; what they contradict each other by is left and told."""

import numpy as np
import pytest

from geocontact.geometry.drape.lay import lay
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.slip import motions
from geocontact.geometry.drape.spread import Anchor, directions
from tests.geometry.drape.sheets import over, plane, sphere, thigh, tube

SIDE = np.sqrt(2e-4)
MAT = Mat(16, 8, (SIDE, SIDE))
CORNERS = np.array([[0.0, 0], [0, 8], [16, 0], [16, 8]])


def at(sheet, point, heading):
    return Anchor.at(sheet, np.array(point, float), np.array(heading, float))


def marks_of(laid, cells):
    return Marks(cells, np.array([laid.nodes[int(i), int(j)] for i, j in cells]))


def left_over(mat, laid, marks, belt=None):
    """Shifts [m] and turns [rad] by which the whole mat would come nearer to its marks."""
    ways = motions(mat, laid.nodes, marks.cells, belt)
    found = np.array([laid.nodes[int(i), int(j)] for i, j in marks.cells])
    return np.linalg.lstsq(ways.reshape(len(ways), -1).T, (marks.points - found).ravel(), rcond=None)[0]


@pytest.mark.parametrize("count", [3, 4])
@pytest.mark.parametrize(
    ("body", "point", "heading"),
    [(thigh(), [0.078, 0, 0.22], [0, 0.1, 1]), (sphere(0.12, 40), [0.02, 0.01, 0.1], [0, 1, 0.3])],
    ids=["thigh", "sphere"],
)
def test_a_mat_comes_back_to_where_its_marks_were_taken(body, point, heading, count):
    """Evened out without them, three corners were missed by 0.6 mm on the thigh and 6 mm on the sphere."""
    sheet = over(body)
    truth = lay(sheet, MAT, at(sheet, point, heading))
    found = lay(sheet, MAT, marks_of(truth, CORNERS[:count]))
    assert found.misses.max() < 1e-4, found.misses
    assert np.linalg.norm(found.nodes - truth.nodes, axis=-1).max() < 2e-4
    assert np.abs(found.distortion).max() < 1.05 * np.abs(truth.distortion).max() + 1e-4
    assert not found.folded.any()


def level_belt(z, mat, belt):
    """Four marks on the middle line of a belt that lies level on the thigh, at quarters of the way around."""
    r = 0.078 - 0.023 * ((z - 0.28) / 0.28) ** 2
    turn = 2 * np.pi * np.arange(4) / 4
    points = np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(4, z)])
    gone, middle = -turn / (2 * np.pi) % 1.0, 0.5
    cells = np.column_stack([np.full(4, middle), gone] if belt == "columns" else [gone, np.full(4, middle)])
    return Marks(cells * [mat.rows, mat.columns], points)


@pytest.mark.parametrize("belt", ["columns", "rows"])
def test_a_belt_stays_on_its_marks_below_the_fullest_place(belt):
    """Held by each corner's weak spring only, it slid 10 mm towards where its length fits."""
    z, rings = 0.16, 6
    sheet = over(thigh(120))
    pitch = 2 * np.pi * (0.078 - 0.023 * ((z - 0.28) / 0.28) ** 2) / 32
    mat = Mat(rings, 32, (SIDE, pitch)) if belt == "columns" else Mat(32, rings, (pitch, SIDE), mirrored=True)
    marks = level_belt(z, mat, belt)
    found = lay(sheet, mat, marks, belt=belt)
    assert found.misses.max() < 1e-3, found.misses
    assert np.abs(left_over(mat, found, marks, belt)[:2]).max() < 2e-4
    assert np.abs(found.distortion).max() < 0.08
    assert found.covered.all() and not found.folded.any()


@pytest.mark.parametrize("body", [tube(), thigh()], ids=["tube", "thigh"])
def test_marks_too_far_apart_are_missed_by_half_the_difference_each(body):
    """A mat does not stretch: of 5 % between two marks along it, either of them is left with 2.5 %."""
    sheet = over(body)
    truth = lay(sheet, MAT, at(sheet, [0.078, 0, 0.24], [0, 0, 1]))
    cells = np.array([[1.0, 4], [15, 4]])
    marks = marks_of(truth, cells)
    middle = marks.points.mean(axis=0)
    found = lay(sheet, MAT, Marks(cells, middle + 1.05 * (marks.points - middle)))
    assert found.misses == pytest.approx(np.full(2, 0.025 * 14 * SIDE), rel=0.03)
    assert found.area.sum() == pytest.approx(truth.area.sum(), rel=1e-4)


def test_marks_that_contradict_each_other_do_not_bend_the_mat():
    """Only moves and turns of the whole are taken from them: none is left over, and cells stay as they were."""
    sheet = over(thigh())
    truth = lay(sheet, MAT, at(sheet, [0.078, 0, 0.24], [0, 0, 1]))
    cells = np.vstack([CORNERS, [[8.0, 4]]])
    exact = marks_of(truth, cells)
    off = np.random.default_rng(3).normal(0.0, 3e-3, (5, 3))
    found = lay(sheet, MAT, Marks(cells, exact.points + off))
    on_skin = Marks(cells, sheet.nearest(exact.points + off).point)
    assert found.misses.max() > 3e-3
    left = np.abs(left_over(MAT, found, on_skin))
    assert left[:2].max() < 1e-4 and left[2] < 1e-3, left
    assert np.sqrt(np.mean(found.distortion**2)) < 1.1 * np.sqrt(np.mean(truth.distortion**2))
    assert np.abs(found.stretch).max() < 1.2 * np.abs(truth.stretch).max()


def test_a_mat_that_hangs_over_the_edge_is_held_by_the_marks_that_lie():
    sheet = over(thigh(60))
    truth = lay(sheet, MAT, at(sheet, [0.07, 0, 0.34], [0, 0, 1]))
    assert not truth.covered[-1].any(), "rows run off the open end"
    found = lay(sheet, MAT, marks_of(truth, np.array([[2.0, 1], [2, 7], [10, 4]])))
    assert found.misses.max() < 3e-4
    assert np.array_equal(found.covered, truth.covered)


def test_motions_of_a_flat_mat_are_those_of_the_plane():
    sheet = over(plane())
    laid = lay(sheet, MAT, at(sheet, [0.01, -0.02, 0], [0.6, 0.8, 0]))
    cells = np.array([[0.0, 0], [16, 8], [3.25, 5.5]])
    ahead, aside, turned = motions(MAT, laid.nodes, cells)
    assert ahead == pytest.approx(np.broadcast_to([0.6, 0.8, 0], (3, 3)), abs=1e-12)
    assert aside == pytest.approx(np.broadcast_to([-0.8, 0.6, 0], (3, 3)), abs=1e-12)
    arms = MAT.away(cells) @ [[0.6, 0.8, 0], [-0.8, 0.6, 0]]
    assert turned == pytest.approx(np.cross([0, 0, 1.0], arms), abs=1e-12)


def test_motions_of_a_belt_are_those_of_a_ring():
    """Shifted, rolled about the tube, tilted: the first two are rigid motions, the tilts are so along the tube."""
    radius, sheet = 0.06, over(tube(n=240))
    mat = Mat(4, 32, (SIDE, 2 * np.pi * radius / 32))
    laid = lay(sheet, mat, at(sheet, [radius, 0, 0.25], [0, 0, 1]), belt="columns")
    cells = np.column_stack([np.full(32, 2.0), np.arange(32.0)])
    points = laid.nodes[2, :32] - [0, 0, 0.25]
    up, round_, first, second = motions(mat, laid.nodes, cells, "columns")
    assert up == pytest.approx(np.broadcast_to([0, 0, 1.0], (32, 3)), abs=1e-3)
    assert radius * round_ == pytest.approx(np.cross([0, 0, -1.0], points), abs=0.01 * radius)
    for tilt, axis in ((first, [0, -1.0, 0]), (second, [-1.0, 0, 0])):
        expected = np.cross(axis, points)[:, 2]
        assert tilt[:, 2] == pytest.approx(expected * np.sign(expected @ tilt[:, 2]), abs=2e-3 * radius)


def test_directions_between_corners():
    sheet = over(plane())
    laid = lay(sheet, MAT, at(sheet, [0, 0, 0], [1, 0, 0]))
    ways = directions(laid.nodes, np.array([[0.0, 0], [16, 8], [3.25, 5.5]]))
    assert ways == pytest.approx(np.broadcast_to([[1.0, 0, 0], [0, 1, 0]], (3, 2, 3)), abs=1e-12)


@pytest.mark.parametrize(
    ("cells", "in_line"),
    [([[0, 0], [16, 8]], True), ([[0, 0], [4, 2], [16, 8]], True), ([[0, 0], [4, 2.1], [16, 8]], False)],
)
def test_marks_in_line_are_those_on_one_line_of_the_mat(cells, in_line):
    assert Marks(np.array(cells, float), np.zeros((len(cells), 3))).in_line is in_line
