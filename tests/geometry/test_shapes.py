"""Half-space, sphere, tube and surface: one catalogue, the same questions."""

import numpy as np
import pytest

from geocontact.geometry.shapes import HalfSpace, Proximity, Sphere, Tube
from geocontact.geometry.surface import Surface
from meshes import simple_shapes
from tests.geometry.bodies import cube, order_of

BOX = Surface(*cube((0.1, 0, 0), 0.5), name="box")
CATALOGUE = {
    "ground": HalfSpace(),
    "slope": HalfSpace((0.1, -0.2, 0.3), (1.0, 2.0, -2.0)),
    "sphere": Sphere((0.1, 0.2, -0.3), 0.7),
    "tube": Tube((0.1, 0.2, -0.3), (1.0, -2.0, 0.5), 0.6),
    "upright tube": Tube((0.0, 0.0, 0.0), (0.0, 0.0, 3.0), 0.9),
    "box": BOX,
}
each_shape = pytest.mark.parametrize("shape", CATALOGUE.values(), ids=CATALOGUE)
O = (0.0, 0.0, 0.0)
POINTS = np.random.default_rng(0).uniform(-1, 1, (400, 3))


def tilted_plane(p):
    return (p @ [1, 2, -2] - (0.1 - 0.4 - 0.6)) / 3


def skew_tube(p):
    axis = np.array([1, -2, 0.5])
    return 0.6 - np.linalg.norm(np.cross(p - [0.1, 0.2, -0.3], axis), axis=1) / np.linalg.norm(axis)


CLOSED_FORMS = {
    "ground": lambda p: p[:, 1],
    "slope": tilted_plane,
    "sphere": lambda p: np.sqrt(((p - [0.1, 0.2, -0.3]) ** 2).sum(axis=1)) - 0.7,
    "tube": skew_tube,
    "upright tube": lambda p: 0.9 - np.hypot(p[:, 0], p[:, 1]),
}


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_distance_is_the_formula(name):
    assert CATALOGUE[name].proximity(POINTS).distance == pytest.approx(CLOSED_FORMS[name](POINTS), abs=1e-15)


@each_shape
def test_normal_is_the_gradient_of_the_distance(shape):
    """Central differences; points within their reach of an edge's bisector have no gradient and are left out."""
    step, found = 1e-6, shape.proximity(POINTS)
    gradient = np.column_stack(
        [
            (shape.proximity(POINTS + e).distance - shape.proximity(POINTS - e).distance) / (2 * step)
            for e in step * np.eye(3)
        ]
    )
    smooth = np.linalg.norm(gradient, axis=1) > 1 - 1e-6
    off = np.abs(gradient - found.normal)[smooth].max()
    assert smooth.mean() > 0.99
    assert off < 1e-6, f"normal and gradient differ by {off:.1e}"
    assert np.linalg.norm(found.normal, axis=1) == pytest.approx(np.ones(len(POINTS)), abs=1e-12)


@each_shape
def test_closest_point_is_on_the_boundary_at_the_distance(shape):
    found = shape.proximity(POINTS)
    assert np.abs(shape.proximity(found.closest).distance).max() < 1e-15
    assert np.linalg.norm(POINTS - found.closest, axis=1) == pytest.approx(np.abs(found.distance), abs=1e-15)
    assert found.closest + found.distance[:, None] * found.normal == pytest.approx(POINTS, abs=1e-14)


@each_shape
def test_distance_is_1_lipschitz(shape):
    other = POINTS[::-1]
    rise = np.abs(shape.proximity(POINTS).distance - shape.proximity(other).distance)
    assert (rise <= np.linalg.norm(POINTS - other, axis=1) + 1e-15).all()


@each_shape
@pytest.mark.parametrize("limit", [0.05, np.inf])
def test_every_shape_gives_the_same_kind_of_answer(shape, limit):
    found, whole = shape.proximity(POINTS, limit), shape.proximity(POINTS).distance
    assert isinstance(found, Proximity)
    assert found.signed
    n, near = len(POINTS), np.abs(whole) <= limit
    assert [a.shape for a in (found.distance, found.closest, found.normal, found.face)] == [(n,), (n, 3), (n, 3), (n,)]
    assert np.issubdtype(found.face.dtype, np.integer)
    assert (found.face[near] >= 0).all() == isinstance(shape, Surface)
    assert np.array_equal(np.isfinite(found.distance), near)
    assert np.array_equal(found.distance < 0, whole < 0)
    for away in (found.closest, found.normal):
        assert np.array_equal(np.isnan(away).all(axis=1), ~near)
    assert (found.face[~near] == -1).all()


def test_direction_of_any_length_is_the_same_shape():
    for one, other in (
        (HalfSpace(O, (0.0, 2.0, 1.0)), HalfSpace((0.0, -1.0, 2.0), (0.0, 200.0, 100.0))),
        (Tube(O, (1.0, 1.0, 0.0), 0.5), Tube((3.0, 3.0, 0.0), (-7.0, -7.0, 0.0), 0.5)),
    ):
        assert one.proximity(POINTS).distance == pytest.approx(other.proximity(POINTS).distance, abs=1e-15)


@pytest.mark.parametrize("shape", [HalfSpace, Tube])
@pytest.mark.parametrize("direction", [(0.0, 0.0, 0.0), (np.nan, 0.0, 1.0), (np.inf, 0.0, 1.0)])
def test_direction_without_length_is_refused(shape, direction):
    with pytest.raises(ValueError, match="has no length"):
        (HalfSpace(O, direction) if shape is HalfSpace else Tube(O, direction, 1.0)).proximity(POINTS)


@pytest.mark.parametrize(
    ("shape", "middle"),
    [(Sphere((1.0, 2.0, 3.0), 0.5), [1, 2, 3]), (Tube((1.0, 2.0, 3.0), (0.0, 0.0, 2.0), 0.5), [1, 2, 7])],
)  # fmt: skip
def test_at_the_very_middle_some_normal_is_given(shape, middle):
    point = np.array([middle], float)
    found = shape.proximity(point)
    assert abs(found.distance[0]) == pytest.approx(0.5)
    assert np.linalg.norm(found.normal) == pytest.approx(1)
    assert found.closest + found.distance[:, None] * found.normal == pytest.approx(point)
    if isinstance(shape, Tube):
        assert np.asarray(shape.direction) @ found.normal[0] == pytest.approx(0, abs=1e-15)


# --- meshes of the same shapes ----------------------------------------------------------------------------------------


def bore(radius, length, n):
    """Tube about the z axis, open at both ends."""
    turn, z = np.meshgrid(2 * np.pi * np.arange(n) / n, np.linspace(-length / 2, length / 2, n), indexing="ij")
    vertices = np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=-1).reshape(-1, 3)
    index = np.arange(n * n).reshape(n, n)
    right = np.roll(index, -1, axis=0)
    quads = np.stack([index[:, :-1], right[:, :-1], right[:, 1:], index[:, 1:]], axis=-1).reshape(-1, 4)
    return vertices, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


@pytest.mark.parametrize(
    ("shape", "mesh", "points"),
    [
        (Sphere(O, 1.0), lambda n: simple_shapes.sphere(1.0, n // 4), 1.4 * POINTS),
        (Tube(O, (0.0, 0.0, 1.0), 1.0), lambda n: bore(1.0, 8.0, n), 0.7 * POINTS),
    ],
    ids=["sphere", "tube"],
)
def test_mesh_of_the_shape_converges_to_it_at_second_order(shape, mesh, points):
    exact, cells = shape.proximity(points).distance, np.array([32, 64, 128, 256])
    error = [np.abs(Surface(*mesh(n)).proximity(points).distance - exact).max() for n in cells]
    order = order_of(1 / cells, error)
    assert order == pytest.approx(2.0, abs=0.1), f"observed order {order:.3f}, errors {error}"


def test_top_of_a_plate_is_the_half_space():
    plate, points = Surface(*simple_shapes.block(8.0, 8.0, 4.0, 5)), POINTS
    assert plate.proximity(points).distance == pytest.approx(HalfSpace().proximity(points).distance, abs=1e-15)
