"""Mats laid on surfaces: exact where these can be laid flat, known where they cannot, never folded."""

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.drape.lay import _aimed, between, lay, marked
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Anchor, spread
from tests.geometry.drape.sheets import cone, over, plane, sphere, thigh, tube

SIDE = np.sqrt(2e-4)  # of a square cell of 2 cm^2
MAT = Mat(16, 8, (SIDE, SIDE))


def at(sheet, point, heading):
    return Anchor.at(sheet, np.array(point, float), np.array(heading, float))


def test_on_a_plane_the_mat_is_the_mat():
    sheet, mat = over(plane()), Mat(16, 8, (0.014, 0.018))
    found = lay(sheet, mat, at(sheet, [0.01, -0.02, 0.3], [0.6, 0.8, 0.5]))
    away = mat.away(np.stack(np.meshgrid(np.arange(17.0), np.arange(9.0), indexing="ij"), axis=-1).reshape(-1, 2))
    expected = np.array([0.01, -0.02, 0.0]) + away @ [[0.6, 0.8, 0], [-0.8, 0.6, 0]]
    assert found.nodes.reshape(-1, 3) == pytest.approx(expected, abs=1e-14)
    assert found.area == pytest.approx(np.full((16, 8), 0.014 * 0.018), rel=1e-12)
    assert found.normal == pytest.approx(np.broadcast_to([0, 0, 1.0], (16, 8, 3)), abs=1e-12)
    assert found.centre == pytest.approx(found.nodes[:-1, :-1] * 0.5 + found.nodes[1:, 1:] * 0.5, abs=1e-14)
    assert np.abs(found.stretch).max() < 1e-12
    assert found.covered.all() and not found.folded.any()


def test_rows_down_and_columns_right_seen_from_outside():
    sheet = over(plane())
    found = lay(sheet, MAT, at(sheet, [0, 0, 0], [0, -1, 0]))
    assert found.nodes[0, 0] == pytest.approx([-4 * SIDE, 8 * SIDE, 0], abs=1e-14), "first cell at the upper left"
    other = lay(sheet, Mat(16, 8, (SIDE, SIDE), mirrored=True), at(sheet, [0, 0, 0], [0, -1, 0]))
    assert other.nodes[0, 0] == pytest.approx([4 * SIDE, 8 * SIDE, 0], abs=1e-14)
    assert other.normal[3, 3] == pytest.approx([0, 0, 1], abs=1e-12)
    assert not other.folded.any()


@pytest.mark.parametrize(
    "body", [tube(), cone(), tube(n=120), cone(120)], ids=["tube", "cone", "fine tube", "fine cone"]
)
@pytest.mark.parametrize("turn", [0.0, 0.4, 1.3])
def test_what_can_be_laid_flat_keeps_every_side_and_area(body, turn):
    sheet = over(body)
    found = lay(sheet, MAT, at(sheet, [0.0, 0.06, 0.24], [np.sin(turn), 0, np.cos(turn)]))
    assert found.covered.all() and not found.folded.any()
    assert np.abs(found.stretch).max() < 1e-9, np.abs(found.stretch).max()
    assert np.abs(found.distortion).max() < 1e-9, np.abs(found.distortion).max()


def test_on_a_tube_the_cells_come_to_lie_where_the_closed_form_says():
    """Second order in the edge length: the prism has less girth than the tube."""
    radius, edges, errors = 0.06, [], []
    for n in (15, 30, 60, 120):
        sheet = over(tube(radius, n=n))
        found = lay(sheet, MAT, at(sheet, [radius, 0, 0.25], [0, 0, 1]))
        row, column = np.arange(17.0) - 8, np.arange(9.0) - 4
        angle, z = -column * SIDE / radius, 0.25 + row * SIDE
        expected = np.stack(np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle), z[:, None]), axis=-1)
        errors.append(np.abs(found.nodes - expected).max())
        edges.append(1 / n)
    order = np.polyfit(np.log(edges), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.3), f"observed order {order:.2f}, errors {errors}"


def test_normals_and_vector_areas_of_a_tube():
    """Each is the cell's projection onto its middle plane: sin(w/2)/(w/2) of its area, w the angle that it spans."""
    radius = 0.06
    sheet = over(tube(radius, n=240))
    found = lay(sheet, MAT, at(sheet, [radius, 0, 0.25], [0, 0, 1]))
    out = found.centre * [1, 1, 0]
    out /= np.linalg.norm(out, axis=-1, keepdims=True)
    assert found.normal == pytest.approx(out, abs=3e-3)
    half = 0.5 * SIDE / radius
    share = np.linalg.norm(found.area_vector, axis=-1) / found.area
    assert share == pytest.approx(np.full((16, 8), np.sin(half) / half), rel=2e-4)


@pytest.mark.parametrize("n", [12, 48, 192])
def test_a_belt_closes_around_a_tube(n):
    """Its 32 columns are as long as the tube's girth; the prism lacks (pi/n)^2/6 of it, which the cells share."""
    radius = 0.06
    mat = Mat(8, 32, (SIDE, 2 * np.pi * radius / 32))
    sheet = over(tube(radius, n=n))
    found = lay(sheet, mat, at(sheet, [radius, 0, 0.25], [0, 0, 1]), belt="columns")
    short = np.sinc(1 / n) - 1
    assert np.array_equal(found.nodes[:, 0], found.nodes[:, -1])
    assert found.stretch[..., 1] == pytest.approx(np.full((8, 32), short), abs=1e-7 + 1e-3 * abs(short))
    assert (np.abs(found.stretch[..., 0]) < 0.06 * abs(short) + 1e-7).all(), "rows take over what the diagonals ask"
    both = (1 + found.stretch[..., 0]) * (1 + found.stretch[..., 1]) - 1
    assert found.distortion == pytest.approx(both, abs=1e-7)
    assert found.covered.all() and not found.folded.any()
    girth = np.linalg.norm(np.diff(found.centre, axis=1, append=found.centre[:, :1]), axis=2).sum(axis=1)
    chords = 1 - np.sinc(1 / 32)  # that a polygon through the 32 centres lacks; corners of the prism are cut once more
    assert girth == pytest.approx(np.full(8, 2 * np.pi * radius), rel=2.5 * abs(short) + 1.5 * chords)


def test_a_belt_of_rows_is_the_belt_of_columns_turned():
    sheet, pitch = over(tube()), 2 * np.pi * 0.06 / 32
    lying = lay(sheet, Mat(8, 32, (SIDE, pitch)), at(sheet, [0.06, 0, 0.25], [0, 0, 1]), belt="columns")
    standing = lay(sheet, Mat(32, 8, (pitch, SIDE), mirrored=True), at(sheet, [0.06, 0, 0.25], [0, -1, 0]), belt="rows")
    assert standing.nodes.transpose(1, 0, 2) == pytest.approx(lying.nodes, abs=2e-5)


def test_a_belt_that_does_not_go_around_is_refused():
    sheet = over(tube())
    mat = Mat(8, 24, (SIDE, 2 * np.pi * 0.06 / 32))
    with pytest.raises(ValueError, match="does not go once around"):
        lay(sheet, mat, at(sheet, [0.06, 0, 0.25], [0, 0, 1]), belt="columns")
    flat = over(plane())
    with pytest.raises(ValueError, match="runs off body"):
        lay(flat, Mat(8, 60, (SIDE, SIDE)), at(flat, [0, 0, 0], [1, 0, 0]), belt="columns")


def test_a_mat_longer_than_the_way_around_lies_on_itself():
    sheet = over(tube(0.05))
    found = lay(sheet, Mat(8, 26, (SIDE, SIDE)), at(sheet, [0.05, 0, 0.25], [0, 0, 1]))
    over_itself = round((26 * SIDE - 2 * np.pi * 0.05) / SIDE)
    assert found.folded[:, :over_itself].all() and found.folded[:, -over_itself:].all()
    assert not found.folded[:, 8:18].any()


def spherical_area(a, b, c):
    """Of a triangle of great circles on the unit sphere (Van Oosterom and Strackee 1983)."""
    up = np.einsum("...i,...i", a, np.cross(b, c))
    dot = [np.einsum("...i,...i", x, y) for x, y in ((a, b), (b, c), (c, a))]
    return np.abs(2 * np.arctan2(up, 1 + sum(dot)))


def test_the_spread_mat_on_a_sphere_has_the_area_of_the_closed_form():
    """Geodesic parallel coordinates: the node (u, v) lies at latitude v / R above the great circle of the spine."""
    radius, errors, edges = 0.12, [], []
    u, v = (np.arange(17) - 8) * SIDE / radius, (np.arange(9) - 4) * SIDE / radius
    u, v = np.meshgrid(u, v, indexing="ij")
    p = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=-1)
    first, row, both, column = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    expected = radius**2 * (spherical_area(first, row, both) + spherical_area(first, both, column))
    for n in (15, 30, 60):
        sheet = over(sphere(radius, n))
        found = lay(sheet, MAT, at(sheet, [0.02, 0.01, 0.1], [0, 1, 0.3]), settle=False)
        errors.append(np.sqrt(np.mean((found.area / expected - 1) ** 2)))
        edges.append(1 / n)
    assert errors[-1] < 1e-3, errors
    assert np.polyfit(np.log(edges), np.log(errors), 1)[0] > 1.5, errors
    assert np.abs(found.stretch[..., 1]).max() < 2e-3, "ribs keep their pitch"


@pytest.mark.parametrize(
    ("body", "point", "heading"),
    [(sphere(0.12, 40), [0.02, 0.01, 0.1], [0, 1, 0.3]), (thigh(), [0.078, 0, 0.24], [0, 0, 1])],
    ids=["sphere", "thigh"],
)
def test_evening_out_brings_cells_nearer_to_their_size(body, point, heading):
    sheet = over(body)
    spread, settled = (lay(sheet, MAT, at(sheet, point, heading), settle=settle) for settle in (False, True))
    rms = [np.sqrt(np.mean(found.distortion**2)) for found in (spread, settled)]
    assert rms[1] < 0.35 * rms[0], rms
    assert np.abs(settled.distortion).max() < 0.02
    assert np.abs(settled.stretch).max() < 0.02
    assert settled.covered.all() and not settled.folded.any()


def test_total_area_is_that_of_the_surface_under_the_mat():
    """The outline of a belt on a thigh cuts out a band: its area by the closed form of the surface of revolution."""
    sheet = over(thigh(160))
    girth = 2 * np.pi * 0.0776
    mat = Mat(6, 32, (SIDE, girth / 32))
    found = lay(sheet, mat, at(sheet, [0.078, 0, 0.28], [0, 0, 1]), belt="columns")
    low, high = found.nodes[0, :, 2].mean(), found.nodes[-1, :, 2].mean()
    z = np.linspace(low, high, 2001)
    r = 0.078 - 0.023 * ((z - 0.28) / 0.28) ** 2
    slope = -2 * 0.023 * (z - 0.28) / 0.28**2
    band = np.trapezoid(2 * np.pi * r * np.sqrt(1 + slope**2), z)
    assert found.area.sum() == pytest.approx(band, rel=1e-3)


def test_a_motion_of_the_body_carries_the_mat():
    vertices, faces = thigh(60)
    X = RigidTransform.from_components(np.array([1.0, -2.0, 0.5]), Rotation.from_rotvec([0.5, 1.0, -0.7]))
    here, there = over((vertices, faces)), over((X.apply(vertices), faces))
    cells = np.array([[2.0, 1.0], [3.0, 7.0], [14.0, 4.0]])
    truth = lay(here, MAT, at(here, [0.07, 0.02, 0.22], [0.1, 0.05, 1.0]))
    marks = np.array([truth.nodes[int(i), int(j)] for i, j in cells])
    marks += 0.001 * np.eye(3)
    a = lay(here, MAT, Marks(cells, marks))
    b = lay(there, MAT, Marks(cells, X.apply(marks)))
    assert b.nodes == pytest.approx(X.apply(a.nodes.reshape(-1, 3)).reshape(a.nodes.shape), abs=2e-5)
    assert b.area == pytest.approx(a.area, rel=1e-4)


def test_the_order_of_faces_and_vertices_does_not_matter():
    vertices, faces = thigh(40)
    rng = np.random.default_rng(0)
    place = rng.permutation(len(vertices))
    shuffled = np.empty_like(vertices)
    shuffled[place] = vertices
    again = np.roll(place[faces[rng.permutation(len(faces))]], 1, axis=1)
    a, b = (
        lay(sheet, MAT, at(sheet, [0.078, 0.001, 0.24], [0, 0.02, 1]))
        for sheet in (over((vertices, faces)), over((shuffled, again)))
    )
    assert b.nodes == pytest.approx(a.nodes, abs=1e-6)


def test_overhanging_cells_are_not_covered():
    sheet = over(plane(0.5))
    found = lay(sheet, MAT, at(sheet, [0.2, 0, 0], [0, 1, 0]))
    beyond = found.nodes[..., 0]
    assert found.covered.sum() == 16 * 7, "the mat reaches 0.0566 m beyond its middle, the sheet 0.05 m"
    assert np.isnan(found.area[~found.covered]).all() and np.isnan(found.normal[~found.covered]).all()
    assert np.nanmin(np.abs(beyond - 0.25)) > 0
    assert found.area[found.covered] == pytest.approx(np.full(16 * 7, 2e-4), rel=1e-12)


def test_marks_on_a_tube_are_met():
    """The mat laid somewhere, some of its points taken as marks: it comes to lie there again."""
    sheet = over(tube())
    truth = lay(sheet, MAT, at(sheet, [0.02, 0.055, 0.27], [0.3, -0.1, 0.9]))
    nodes = np.array([[2, 1], [14, 2], [3, 7], [12, 6]])
    points = truth.nodes[nodes[:, 0], nodes[:, 1]]
    for k in (2, 3, 4):
        found = lay(sheet, MAT, Marks(nodes[:k].astype(float), points[:k]))
        assert found.nodes == pytest.approx(truth.nodes, abs=1e-8), k
        assert found.misses.max() < 1e-8


def test_marks_off_the_surface_are_told_by_their_misses():
    sheet = over(tube())
    truth = lay(sheet, MAT, at(sheet, [0.06, 0, 0.25], [0, 0, 1]))
    nodes = np.array([[2, 1], [14, 2], [3, 7], [12, 6]])
    points = truth.nodes[nodes[:, 0], nodes[:, 1]]
    outside = points * [1.05, 1.05, 1.0]
    found = lay(sheet, MAT, Marks(nodes.astype(float), outside))
    assert found.misses == pytest.approx(np.full(4, 0.003), rel=0.02)
    assert found.nodes == pytest.approx(truth.nodes, abs=1e-5)


@pytest.mark.parametrize("mirrored", [False, True])
def test_the_search_for_the_marks_begins_at_the_answer_on_a_plane(mirrored):
    sheet, mat = over(plane()), Mat(16, 8, (0.014, 0.018), mirrored)
    truth = at(sheet, [0.03, -0.01, 0.0], [0.6, 0.8, 0.0])
    cells = np.array([[2.0, 1.0], [14.0, 2.0], [3.5, 7.0]])
    marks = Marks(cells, marked(sheet, mat, Marks(cells, np.zeros((3, 3))), truth))
    goals = sheet.nearest(marks.points)
    for k in range(3):
        start = _aimed(sheet, mat, marks, goals, k)
        assert start.place.point[0] == pytest.approx(truth.place.point[0], abs=1e-14)
        assert start.heading == pytest.approx(truth.heading, abs=1e-13)


def test_a_mat_the_other_way_up_is_refused():
    sheet = over(tube())
    truth = lay(sheet, Mat(16, 8, (SIDE, SIDE), mirrored=True), at(sheet, [0.06, 0, 0.25], [0, 0, 1]))
    nodes = np.array([[2, 1], [14, 2], [3, 7], [12, 6]])
    marks = Marks(nodes.astype(float), truth.nodes[nodes[:, 0], nodes[:, 1]])
    with pytest.raises(ValueError, match=r"fit a mat that is mirrored: rms 0\.0 mm"):
        lay(sheet, MAT, marks)
    assert lay(sheet, Mat(16, 8, (SIDE, SIDE), mirrored=True), marks).misses.max() < 1e-8


def test_refused():
    points = np.array([[0.0, 0, 0], [0.1, 0, 0]])
    sheet = over(plane())
    with pytest.raises(ValueError, match="second is at row 17, column 3; the mat has 16 rows and 8 columns"):
        lay(sheet, MAT, Marks(np.array([[0.0, 0], [17, 3]]), points, ("first", "second")))
    with pytest.raises(ValueError, match="two marks at least"):
        lay(sheet, MAT, Marks(np.array([[1.0, 1], [1, 1]]), points))
    with pytest.raises(ValueError, match="2 marks of the mat but 1 names"):
        Marks(np.zeros((2, 2)), points, ("one",))
    with pytest.raises(ValueError, match="stand upright"):
        at(sheet, [0, 0, 0], [0, 0, 1])
    with pytest.raises(ValueError, match="positive pitch"):
        Mat(3, 3, (0.01, 0.0))


def test_positions_between_nodes():
    sheet = over(plane())
    anchor = at(sheet, [0, 0, 0], [1, 0, 0])
    row, column = (np.arange(17.0) - 8) * SIDE, (np.arange(9.0) - 4) * SIDE
    nodes = spread(sheet, anchor, MAT, row, column)
    cells = np.array([[0.0, 0.0], [16.0, 8.0], [3.25, 5.5]])
    assert between(nodes, cells)[:, :2] == pytest.approx(MAT.away(cells), abs=1e-14)
