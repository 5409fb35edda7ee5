"""Distance and side of points against libigl, exact rational arithmetic and the exact winding number."""

from fractions import Fraction

import igl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geocontact.geometry.surface import Surface
from meshes import simple_shapes as shapes
from meshes.total_knee import total_knee
from tests.geometry.bodies import MM, box_distance, cube, joined

INSERT, FEMORAL = total_knee(1.0)
BODIES = {
    "sphere": shapes.sphere(20.0, 12),
    "plate": shapes.block(80.0, 80.0, 12.0, 8),
    "cup": shapes.cup(24.0, 5.0, 10),
    "torus": shapes.torus(25.0, 8.0, 16),
    "insert": INSERT,
    "femoral": FEMORAL,
}
each_body = pytest.mark.parametrize("name", BODIES)


def body(name):
    vertices, faces = BODIES[name]
    return vertices * MM, faces


def around(vertices, count=4000, seed=0):
    """Points in and around the bounding box."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return np.random.default_rng(seed).uniform(low - 0.3 * (high - low), high + 0.3 * (high - low), (count, 3))


def close_to(vertices, faces, off, count=4000, seed=0):
    """Points at about `off` times the body's size from its faces, on either side."""
    rng = np.random.default_rng(seed)
    corners = vertices[faces[rng.integers(len(faces), size=count)]]
    on_face = np.einsum("nk,nkx->nx", rng.dirichlet([1, 1, 1], count), corners)
    return on_face + rng.normal(size=(count, 3)) * off * np.ptp(vertices, axis=0).max()


def libigl_distance(points, vertices, faces):
    return np.sqrt(igl.point_mesh_squared_distance(points, vertices, faces.astype(np.int64))[0])


def assert_sides_follow_the_winding_number(vertices, faces, points):
    """Exact winding number (Van Oosterom and Strackee's solid angles); points within 1e-6 of the size are left out."""
    found = Surface(vertices, faces).proximity(points)
    winding = igl.winding_number(vertices, faces.astype(np.int64), points)
    clear = np.abs(found.distance) > 1e-6 * np.ptp(vertices, axis=0).max()
    wrong = clear & ((found.distance < 0) != (winding > 0.5))
    assert found.signed
    assert not wrong.any(), (
        f"{wrong.sum()} of {clear.sum()} points on the wrong side, e.g. {points[wrong][0]} with distance "
        f"{found.distance[wrong][0]:.3g} and winding number {winding[wrong][0]:.3f}"
    )


# --- against libigl ---------------------------------------------------------------------------------------------------


@each_body
@pytest.mark.parametrize("where", ["around", "close"])
def test_distance_equals_libigl(name, where):
    vertices, faces = body(name)
    points = around(vertices) if where == "around" else close_to(vertices, faces, 1e-3)
    found = Surface(vertices, faces).proximity(points)
    apart = np.abs(np.abs(found.distance) - libigl_distance(points, vertices, faces)).max()
    assert apart <= 1e-12, f"largest difference {apart:.2e} m"


@each_body
def test_sides_follow_the_winding_number(name):
    vertices, faces = body(name)
    points = np.concatenate([around(vertices, 1500), close_to(vertices, faces, 1e-3, 1500)])
    assert_sides_follow_the_winding_number(vertices, faces, points)


@each_body
def test_answer_is_consistent(name):
    """distance = |p - closest|, closest lies on the face named, the normal points from one to the other."""
    vertices, faces = body(name)
    points = around(vertices, 1000)
    found = Surface(vertices, faces).proximity(points)
    assert np.linalg.norm(points - found.closest, axis=1) == pytest.approx(np.abs(found.distance), abs=1e-15)
    for k in np.random.default_rng(1).integers(len(points), size=100):
        corner = vertices[faces[found.face[k]]]
        off = libigl_distance(found.closest[k][None], corner, np.array([[0, 1, 2]]))
        assert off < 1e-15, f"closest point {off} m off its face"
    along = found.closest + found.distance[:, None] * found.normal
    assert np.abs(along - points).max() < 1e-14


@each_body
def test_single_point_on_the_surface_is_at_distance_zero(name):
    vertices, faces = body(name)
    surface = Surface(vertices, faces)
    for point in (vertices[:1], vertices[faces[:1]].mean(axis=1)):
        found = surface.proximity(point)
        assert abs(found.distance[0]) < 1e-16, f"distance {found.distance[0]} at {point[0]}"
        assert found.closest == pytest.approx(point, abs=1e-16)


@each_body
@pytest.mark.parametrize("off", [1e-6, 1e-8, 1e-10, 1e-12])
def test_points_a_hair_off_the_surface(name, off):
    """One by one, over and under the middles of faces: distance and side to 1e-16 m."""
    vertices, faces = body(name)
    surface = Surface(vertices, faces)
    for k in range(0, len(faces), max(1, len(faces) // 100)):
        for height in (off, -off):
            point = vertices[faces[k]].mean(axis=0) + height * surface.face_normal[k]
            found = surface.proximity(point[None]).distance[0]
            assert abs(found - height) < 1e-16, f"{found} m instead of {height} m at face {k}"


def test_points_on_the_surface_take_the_normal_of_their_face():
    vertices, faces = body("plate")
    on_top = np.column_stack([np.linspace(-0.033, 0.035, 50), np.zeros(50), np.linspace(-0.031, 0.029, 50)])
    found = Surface(vertices, faces).proximity(on_top)
    assert np.abs(found.distance).max() < 1e-15
    assert found.normal == pytest.approx(np.tile([0.0, 1.0, 0.0], (50, 1)), abs=1e-12)


# --- one triangle, exactly --------------------------------------------------------------------------------------------


def exact_distance(point, corners):
    """Distance of a point to a triangle in rational arithmetic: to its plane over it, else to three segments."""
    p, a, b, c = ([Fraction(float(x)) for x in q] for q in (point, *corners))

    def minus(u, v):
        return [x - y for x, y in zip(u, v, strict=True)]

    def dot(u, v):
        return sum(x * y for x, y in zip(u, v, strict=True))

    def to_segment(start, end):
        along, away = minus(end, start), minus(p, start)
        length2 = dot(along, along)
        t = min(max(dot(away, along) / length2, Fraction(0)), Fraction(1)) if length2 else Fraction(0)
        rest = minus(away, [t * x for x in along])
        return dot(rest, rest)

    squares = [to_segment(a, b), to_segment(b, c), to_segment(c, a)]
    u, v, w = minus(b, a), minus(c, a), minus(p, a)
    uu, uv, vv, wu, wv = dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v)
    twice_area2 = uu * vv - uv * uv
    if twice_area2:
        s, t = (vv * wu - uv * wv) / twice_area2, (uu * wv - uv * wu) / twice_area2
        if s >= 0 and t >= 0 and s + t <= 1:
            rest = minus(w, [s * x + t * y for x, y in zip(u, v, strict=True)])
            squares.append(dot(rest, rest))
    return float(min(squares)) ** 0.5


def assert_distance_is_exact(points, corners, within=4e-15):
    """`within` is relative to the size of everything."""
    corners = np.asarray(corners, float)
    found = Surface(corners, np.array([[0, 1, 2]])).proximity(np.atleast_2d(points))
    exact = [exact_distance(p, corners) for p in np.atleast_2d(points)]
    size = np.abs(corners).max() + np.abs(points).max()
    off = np.abs(found.distance - exact) / max(size, 1e-300)
    k = off.argmax()
    assert off[k] < within, f"off by {off[k]:.1e} of the size: {found.distance[k]} instead of {exact[k]}"


coordinate = st.floats(-1.0, 1.0, allow_subnormal=False).map(lambda x: round(x, 12))
point = st.tuples(coordinate, coordinate, coordinate)
flatness = st.sampled_from([0.0, 1e-16, 1e-14, 1e-12, 1e-8, 1e-4, 1.0])


@settings(max_examples=300, deadline=None, derandomize=True)
@given(a=point, b=point, c=point, query=point, along=st.floats(-0.5, 1.5), height=flatness, near=flatness)
def test_distance_to_any_triangle_is_exact(a, b, c, query, along, height, near):
    """Also where the third corner lies `height` off the line of the first two and the point `near` the triangle.

    Triangles flatter than 1e-13 are taken as segments, which is what they may cost.
    """
    a, b, c, query = (np.array(q, float) for q in (a, b, c, query))
    corner = a + along * (b - a) + height * c
    points = (a + b + corner) / 3 + np.outer([near, 1.0], query)
    assert_distance_is_exact(points, [a, b, corner], within=1.1e-13)


DEGENERATE = {
    "point": [[1, 2, 3], [1, 2, 3], [1, 2, 3]],
    "segment with a doubled corner": [[0, 0, 0], [2, 1, 0], [2, 1, 0]],
    "segment with the first corner doubled": [[0, 0, 0], [0, 0, 0], [2, 1, 0]],
    "collinear, third corner in the middle": [[0, 0, 0], [2, 0, 0], [1, 0, 0]],
    "collinear, first corner in the middle": [[1, 1, 1], [0, 0, 0], [3, 3, 3]],
    "collinear, second corner in the middle": [[0, 0, 0], [1, 1, 1], [3, 3, 3]],
    "needle": [[0, 0, 0], [1, 0, 0], [0.5, 1e-14, 0]],
    "needle with a short edge": [[0, 0, 0], [1, 0, 0], [1, 1e-14, 0]],
}


@pytest.mark.parametrize("corners", DEGENERATE.values(), ids=DEGENERATE)
def test_degenerate_face_is_the_segment_or_point_that_it_is(corners):
    points = np.random.default_rng(2).uniform(-2, 4, (200, 3))
    on_it = np.array(corners, float).mean(axis=0)
    assert_distance_is_exact(np.vstack([points, on_it, corners]), corners, within=1e-14)


def test_sides_beside_degenerate_faces_equal_the_box():
    """A box whose edge at x = y = 1 carries a collinear face and a needle: nothing but rounding may change."""
    vertices, faces = cube((0, 0, 0), 1.0)
    edge = [k for k, v in enumerate(vertices) if v[0] == 1 and v[1] == 1]
    middle, owner = len(vertices), next(k for k, f in enumerate(faces) if set(edge) <= set(f))
    at = next(k for k in range(3) if faces[owner][k] not in edge)
    third, start, end = np.roll(faces[owner], -at)
    split = [[third, start, middle], [third, middle, end], [start, end, middle]]
    vertices = np.vstack([vertices, (vertices[start] + vertices[end]) / 2])
    surface = Surface(vertices, np.vstack([np.delete(faces, owner, axis=0), split]))
    assert surface.closed
    assert not surface.face_area.all()
    rng = np.random.default_rng(3)
    near_edge = np.column_stack([1 + 0.05 * rng.normal(size=(2000, 2)), rng.uniform(-1.1, 1.1, 2000)])
    points = np.vstack([near_edge, [[1 + 1e-3, 1 + 1e-3, 0.0], [1 - 1e-3, 1 - 1e-3, 0.0]]])
    off = np.abs(surface.proximity(points).distance - box_distance(points, 0.0, 1.0)).max()
    assert off < 1e-14, f"signed distance off by {off:.1e}"


# --- refused ----------------------------------------------------------------------------------------------------------

TRIANGLE = np.eye(3)


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        (TRIANGLE, np.zeros((0, 3), int), "at least one face"),
        (np.where(TRIANGLE == 1, np.nan, 0.0), [[0, 1, 2]], "must be finite"),
        (np.where(TRIANGLE == 1, np.inf, 0.0), [[0, 1, 2]], "must be finite"),
        (TRIANGLE, [[0, 1, 3]], "names a vertex that is not there"),
        (TRIANGLE, [[0, 1, -1]], "names a vertex that is not there"),
    ],
)
def test_no_surface_from_bad_arrays(vertices, faces, message):
    with pytest.raises(ValueError, match=rf"^tray: .*{message}"):
        Surface(vertices, np.asarray(faces), "tray")


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_query_that_is_not_finite_is_refused(bad):
    """fcl answers 0 to a NaN: in contact."""
    with pytest.raises(ValueError, match="query points must be finite"):
        Surface(TRIANGLE, np.array([[0, 1, 2]])).proximity(np.array([[0.0, bad, 0.0]]))


def test_no_points_no_answers():
    found = Surface(TRIANGLE, np.array([[0, 1, 2]])).proximity(np.zeros((0, 3)))
    assert found.distance.shape == (0,)
    assert found.closest.shape == (0, 3)


# --- frames, limits, sides --------------------------------------------------------------------------------------------


def test_far_offset_costs_nothing():
    """1e6 mm away: vertices and points on a grid of 2^-36 m, so that the shift is exact; float32 would lose 0.06 mm."""
    vertices, faces = body("femoral")
    grid, far = 2.0**-36, np.array([1000.0, -1000.0, 1000.0])
    vertices, points = (np.round(x / grid) * grid for x in (vertices, around(vertices, 2000)))
    assert np.array_equal((vertices + far) - far, vertices)
    here = Surface(vertices, faces).proximity(points)
    there = Surface(vertices + far, faces).proximity(points + far)
    off = np.abs(here.distance - there.distance).max()
    assert off <= 1e-12, f"distances differ by {off:.1e} m"
    assert np.abs(here.closest + far - there.closest).max() <= 1e-12 + 2 * np.spacing(1000.0)


def test_distance_does_not_depend_on_the_order_of_vertices_and_faces():
    vertices, faces = body("insert")
    rng, points = np.random.default_rng(4), around(vertices, 2000)
    order = rng.permutation(len(vertices))
    place = np.argsort(order)
    shuffled = Surface(vertices[order], place[faces[rng.permutation(len(faces))]])
    apart = np.abs(Surface(vertices, faces).proximity(points).distance - shuffled.proximity(points).distance).max()
    assert apart < 1e-16, f"{apart:.1e} m"


@each_body
def test_inverted_faces_keep_the_sides(name):
    vertices, faces = body(name)
    points = around(vertices, 2000)
    upright, inverted = Surface(vertices, faces), Surface(vertices, faces[:, ::-1])
    assert (upright.inside_out, inverted.inside_out) == (False, True)
    one, other = upright.proximity(points), inverted.proximity(points)
    assert (one.distance < 0).any()
    assert one.distance == pytest.approx(other.distance, abs=1e-15)
    assert one.normal == pytest.approx(other.normal, abs=1e-9)


@each_body
@pytest.mark.parametrize("limit", [1e-4, 4e-3, 30e-3])
def test_bounded_query_is_the_unbounded_one_up_to_its_limit(name, limit):
    vertices, faces = body(name)
    surface, points = Surface(vertices, faces), np.vstack([around(vertices), close_to(vertices, faces, 1e-3, 1000)])
    whole, bounded = surface.proximity(points), surface.proximity(points, limit)
    near = np.abs(whole.distance) <= limit
    assert near.any() and not near.all()
    for one, other in ((whole.distance, bounded.distance), (whole.closest, bounded.closest)):
        assert one[near] == pytest.approx(other[near], abs=1e-15)
    assert np.array_equal(bounded.distance[~near], np.copysign(np.inf, whole.distance[~near]))
    assert (bounded.face[~near] == -1).all()
    assert np.isnan(bounded.closest[~near]).all()
    assert np.isnan(bounded.normal[~near]).all()


def test_open_and_doubled_surfaces_have_no_sides():
    vertices, faces = body("sphere")
    points = around(vertices, 500)
    for spoilt in (faces[1:], np.vstack([faces, faces[:1]]), np.vstack([faces, faces])):
        surface = Surface(vertices, spoilt)
        found = surface.proximity(points)
        assert (surface.closed, found.signed) == (False, False)
        assert found.distance == pytest.approx(libigl_distance(points, vertices, spoilt), abs=1e-12)


AGAIN = {
    "none": lambda f: f,
    "one": lambda f: np.vstack([f, f[40:41]]),
    "one that begins elsewhere": lambda f: np.vstack([f, np.roll(f[40:41], 1, axis=1)]),
    "some turned over": lambda f: np.vstack([f, f[40:60, ::-1]]),
    "all": lambda f: np.vstack([f, f]),
    "one, and one without area": lambda f: np.vstack([f, f[40:41], [[0, 0, 1]]]),
}


@pytest.mark.parametrize("inwards", [False, True], ids=["outwards", "inwards"])
@pytest.mark.parametrize("again", AGAIN)
def test_doubled_faces_change_nothing_where_a_body_is_assumed_closed(again, inwards):
    """Distances, sides, normals and area of the clean body; a vertex of no face far away is no part of it either."""
    vertices, faces = body("sphere")
    above = 3.0 * vertices[faces[40:60]].mean(axis=1)
    points = np.vstack([around(vertices), close_to(vertices, faces[40:60], 1e-3, 500), above])
    clean = Surface(vertices, faces)
    spoilt = AGAIN[again](faces[:, ::-1] if inwards else faces)
    surface = Surface(np.vstack([vertices, [[1.0, 2.0, 3.0]]]), spoilt, assume_closed=True)
    expected, found = clean.proximity(points), surface.proximity(points)
    assert found.distance == pytest.approx(expected.distance, abs=1e-12)
    assert surface.inside_out == Surface(vertices, spoilt).inside_out == inwards, "said of the open one as well"
    assert surface.face_normal[: len(faces)] == pytest.approx(clean.face_normal, abs=1e-12)
    assert surface.face_area[~surface.repeated].sum() == pytest.approx(clean.face_area.sum(), rel=1e-12)


def test_assumed_closed_box_without_lid_has_sides_where_they_are_clear():
    """Winding number of five sixths of a cube; beside the missing lid it is near one half."""
    vertices, faces = cube((0, 0, 0), 1.0)
    lidless = faces[vertices[faces][:, :, 1].min(axis=1) < 1]
    assert len(lidless) == 10
    points = np.random.default_rng(5).uniform(-1.5, 1.5, (2000, 3))
    points = points[(points[:, 1] < 0.2) | (points[:, 1] > 2.0)]
    found = Surface(vertices, lidless, assume_closed=True).proximity(points)
    assert found.signed
    assert np.array_equal(found.distance < 0, (np.abs(points) < 1).all(axis=1))


def pyramid(slivers):
    """Sharp: four sides over a square, the one at x = 1 cut into slivers that all end at the tip."""
    edge = np.column_stack([np.ones(slivers + 1), np.zeros(slivers + 1), np.linspace(1, -1, slivers + 1)])
    vertices = np.vstack([[[0, 4, 0], [0, 0, 0]], edge, [[-1, 0, -1], [-1, 0, 1]]])
    around = np.append(np.arange(2, len(vertices)), 2)
    sides = np.column_stack([np.zeros(len(around) - 1, int), around[:-1], around[1:]])
    floor = np.column_stack([np.ones(len(around) - 1, int), around[1:], around[:-1]])
    return vertices, np.vstack([sides, floor])


@pytest.mark.parametrize("slivers", [1, 40])
def test_sides_around_a_tip_do_not_depend_on_how_a_side_is_cut(slivers):
    """Normals at the tip count by their angles; counted by faces, points off the uncut sides would lie inside."""
    vertices, faces = pyramid(slivers)
    surface = Surface(vertices, faces)
    assert surface.closed and not surface.inside_out
    points = [0, 4, 0] + 0.05 * np.random.default_rng(8).normal(size=(3000, 3))
    found = surface.proximity(points)
    at_tip = np.linalg.norm(found.closest - [0, 4, 0], axis=1) == 0
    assert at_tip.sum() > 1000, "points whose nearest feature is the tip are outside"
    assert (found.distance[at_tip] > 0).all(), f"{(found.distance[at_tip] < 0).sum()} of {at_tip.sum()} inside"
    assert_sides_follow_the_winding_number(vertices, faces, points)


# --- bodies that overlap themselves -----------------------------------------------------------------------------------


def spiked(vertices, faces, start, tip):
    """The vertex nearest to `start` drawn out to `tip`, through the body: folded over, inside out beyond."""
    vertices = vertices.copy()
    vertices[np.argmin(np.linalg.norm(vertices - start, axis=1))] = tip
    return vertices, faces


def upside(body):
    vertices, faces = body
    return vertices, faces[:, ::-1]


BLOCK = shapes.block(2.0, 2.0, 2.0, 4)
TANGLED = {
    "two overlapping cubes": joined(cube((0, 0, 0), 1.0), cube((0.7, 0.3, 0.2), 0.8)),
    "cube with a spike through its floor": spiked(BLOCK[0] + [0, 1, 0], BLOCK[1], [0, 1, 0], [0.1, -2.0, 0.07]),
    "sphere with a spike through its back": spiked(*shapes.sphere(1.0, 16), [0, 0, 1], [0.1, 0.1, -1.5]),
    "torus that meets itself": shapes.torus(1.0, 1.4, 24),
    "cubes stacked on a common plane": joined(cube((0, 0, 0), 1.0), cube((0.1, 1.5, 0.05), 0.5)),
    "cube within a cube": joined(cube((0, 0, 0), 1.0), cube((0.1, 0, 0), 0.3)),
    "cube with a cavity": joined(cube((0, 0, 0), 1.0), upside(cube((0.1, 0, 0), 0.3))),
    "fine sphere pierced by the corners of a box": joined(shapes.sphere(1.0, 64), cube((0.1, 0, 0), 0.6)),
}


@pytest.mark.parametrize("tangle", TANGLED.values(), ids=TANGLED)
def test_sides_of_a_tangled_body_follow_the_winding_number(tangle):
    vertices, faces = tangle
    assert Surface(vertices, faces).closed
    points = np.concatenate([around(vertices, 2000), *(close_to(vertices, faces, off, 1000) for off in (3e-2, 1e-3))])
    if len(faces) > 10_000:
        points = points[np.linalg.norm(points - [0.65, 0.55, 0.55], axis=1) < 0.2]
        corner = np.random.default_rng(6).uniform(0.45, 0.75, (1000, 3))
        points = np.concatenate([points, corner])
    assert_sides_follow_the_winding_number(vertices, faces, points)


def test_overlapping_cubes_keep_their_distance_outside():
    """Outside the union the nearest face is a real one: the smaller of the two boxes' distances."""
    one, other = ((0, 0, 0), 1.0), ((0.7, 0.3, 0.2), 0.8)
    points = np.random.default_rng(7).uniform(-2, 2.5, (4000, 3))
    union = np.minimum(box_distance(points, *one), box_distance(points, *other))
    found = Surface(*joined(cube(*one), cube(*other))).proximity(points).distance
    assert np.array_equal(found < 0, union < 0)
    assert found[union > 0] == pytest.approx(union[union > 0], abs=1e-14)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1))
def test_distance_moves_with_the_body(seed):
    rng = np.random.default_rng(seed)
    vertices, faces = body("cup")
    turn, shift, points = Rotation.random(rng=rng), rng.uniform(-1, 1, 3), around(vertices, 200, seed)
    here = Surface(vertices, faces).proximity(points)
    there = Surface(turn.apply(vertices) + shift, faces).proximity(turn.apply(points) + shift)
    assert here.distance == pytest.approx(there.distance, abs=1e-14)
