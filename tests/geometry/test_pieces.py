"""Several closed surfaces in one mesh: counted, and the surface of their union by hand, by clipping, in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.geometry.surface import Surface
from geocontact.geometry.topology import signed_volume
from geocontact.geometry.union import closed_pieces, united
from meshes import simple_shapes
from tests.geometry.bodies import MM2, cube, joined, moved, surface

BOX = cube((-4, -2.5, 0), (6, 2.5, 10))  # x -10 … 2
BESIDE = cube((4, -2.5, 0), (6, 2.5, 10))  # x -2 … 10: five faces lie in planes of the first box


def reversed_faces(body):
    return body[0], body[1][:, ::-1]


def area(found):
    return found.surface.face_area.sum() / MM2


def clipped(corners, point, normal):
    """The part of a convex polygon below a plane (Sutherland and Hodgman 1974)."""
    out = []
    height = (corners - point) @ normal
    for k in range(len(corners)):
        after = (k + 1) % len(corners)
        if height[k] <= 0.0:
            out.append(corners[k])
        if height[k] * height[after] < 0.0:
            out.append(corners[k] + height[k] / (height[k] - height[after]) * (corners[after] - corners[k]))
    return np.array(out).reshape(-1, 3)


def area_inside(body, convex):
    """Area of a body's faces inside a convex body."""
    total = 0.0
    for face in body[1]:
        polygon = body[0][face]
        for a, b, c in convex[0][convex[1]]:
            if len(polygon):
                normal = np.cross(b - a, c - a)
                polygon = clipped(polygon, a, normal / np.linalg.norm(normal))
        for k in range(1, len(polygon) - 1):
            total += 0.5 * np.linalg.norm(np.cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]))
    return total


def test_boxes_that_share_planes_unite_to_one_box():
    found = united(surface(joined(BOX, BESIDE)))
    assert found.words == "2 closed surfaces that overlap"
    assert area(found) == pytest.approx(2 * (20 * 5 + 20 * 20 + 5 * 20), rel=1e-12)
    assert found.inner_area / MM2 == pytest.approx(2 * 12 * 2 * (5 + 20) + 4 * 5 * 20 - 1200, rel=1e-12)
    assert signed_volume(found.surface.vertices, found.surface.faces) == pytest.approx(2e-6, rel=1e-12)
    assert found.surface.closed


def test_faces_come_from_those_of_the_mesh():
    body = surface(joined(BOX, BESIDE))
    found = united(body)
    alike = np.einsum("fi,fi->f", found.surface.face_normal, body.face_normal[found.face])
    assert alike.min() > 1.0 - 1e-9
    from_face = np.bincount(found.face, found.surface.face_area, len(body.faces))
    assert (from_face <= body.face_area * (1.0 + 1e-9)).all()


@pytest.mark.parametrize("wound", [lambda body: body, reversed_faces])
@pytest.mark.parametrize("first", [0, 1])
def test_a_surface_inside_another_goes_whichever_way_it_is_wound(wound, first):
    inner, outer = wound(cube((0, 0, 0), 3)), cube((0, 0, 0), 5)
    found = united(surface(joined(*((inner, outer), (outer, inner))[first])))
    assert found.words == "2 closed surfaces, one inside the other"
    assert area(found) == pytest.approx(600, rel=1e-12)
    assert found.inner_area / MM2 == pytest.approx(216, rel=1e-12)
    assert found.surface.topology.closed
    signs = found.surface.proximity(np.zeros((1, 3)), 0.1).distance
    assert signs[0] == pytest.approx(-5e-3, rel=1e-12)  # what was a cavity is inside the body


def test_bodies_that_touch_have_no_wall_between_them():
    found = united(surface(joined(cube((-5, 0, 0), 5), cube((5, 1, 0), (5, 4, 3)))))
    assert area(found) == pytest.approx(600 + 2 * (8 * 6) + 2 * 10 * (8 + 6) - 2 * 8 * 6, rel=1e-12)


@pytest.mark.parametrize("far", [0.0, 30.0])
def test_bodies_apart_are_counted_and_left_alone(far):
    body = surface(joined(cube((0, 0, 0), 5), cube((11 + far, 0, 0), 5), cube((0, 30, 0), 1)))
    assert closed_pieces(body).count == 3
    assert united(body) is None


def test_an_open_piece_is_no_closed_surface():
    box = cube((0, 0, 0), 5)
    sheet = np.array([[-1.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
    body = surface(joined(box, sheet))
    pieces = closed_pieces(body)
    assert (len(pieces.closed), pieces.count) == (2, 1)
    assert united(body) is None


def test_corners_in_one_place_do_not_join_two_bodies():
    touching = surface(joined(cube((0, 0, 0), 5), cube((10, 10, 10), 5)))
    assert touching.topology.closed
    assert closed_pieces(touching).count == 2


@pytest.mark.parametrize("seed", range(4))
def test_turned_boxes_against_clipping_by_half_spaces(seed):
    rng = np.random.default_rng(seed)
    one, other = simple_shapes.block(20.0, 10.0, 16.0, 2), cube((0, 0, 0), (4, 9, 3))
    other = moved(other, Rotation.random(random_state=rng), rng.uniform(-4, 4, 3) - (0, 5, 0))
    inside = area_inside(one, other) + area_inside(other, one)
    found = united(surface(joined(one, other)))
    assert inside > 1.0
    assert found.inner_area / MM2 == pytest.approx(inside, rel=1e-9)
    whole = sum(surface(each).face_area.sum() for each in (one, other)) / MM2
    assert area(found) == pytest.approx(whole - inside, rel=1e-9)


@pytest.mark.parametrize("offset", [0.0, 1e3, 1e6])
def test_single_precision_far_from_the_origin_leaves_the_union_as_it_is(offset):
    """Coordinates as an STL holds them: at 1e6 mm they are multiples of 1/16 mm, as these are."""
    turn = Rotation.from_euler("y", 90, degrees=True)
    vertices, faces = joined(moved(BOX, turn, (offset, 0, 0)), moved(BESIDE, turn, (offset, 0, 0)))
    found = united(surface((vertices.astype(np.float32).astype(float), faces)))
    assert area(found) == pytest.approx(1200, rel=1e-6)


def test_single_precision_of_a_turned_pair_in_common_planes():
    turn = Rotation.from_rotvec([0.4, -0.7, 0.3])
    vertices, faces = joined(moved(BOX, turn, (10, 20, -30)), moved(BESIDE, turn, (10, 20, -30)))
    found = united(surface((vertices.astype(np.float32).astype(float), faces)))
    assert area(found) == pytest.approx(1200, rel=1e-5)


def test_balls_against_the_closed_form_at_second_order():
    """Two balls of 20 mm, 16 mm apart: of each the cap of height 20 - 8 lies in the other, 2 π r h."""
    right, errors, edges = 2 * 2 * np.pi * 20 * 12, [], []
    for rings in (12, 24):
        vertices, faces = simple_shapes.sphere(20.0, rings)
        found = united(surface(joined((vertices, faces), (vertices + np.array([16.0, 0.3, 0.2]), faces))))
        errors.append(abs(found.inner_area / MM2 / right - 1.0))
        edges.append(1.0 / rings)
    order = np.log(errors[0] / errors[1]) / np.log(edges[0] / edges[1])
    assert errors[1] < 0.01
    assert order == pytest.approx(2.0, abs=0.3), f"observed order {order:.2f}, errors {errors}"


def test_three_bodies_in_words():
    body = surface(joined(BOX, BESIDE, cube((0, -2.5, 0), 1), cube((0, 50, 0), 1)))
    found = united(body)
    assert (found.count, found.inside, found.across) == (4, 1, 2)
    assert found.words == "4 closed surfaces, 1 inside another one and 2 that overlap"


def test_sides_and_depths_are_those_of_the_union():
    found = united(surface(joined(BOX, BESIDE))).surface
    points = np.array([[0.0, -2.5, 0], [1.9, -1, 0], [0, 1, 0], [0, -6, 0], [11, -1, 0]]) * 1e-3
    np.testing.assert_allclose(
        found.proximity(points).distance, np.array([-2.5, -1.0, 1.0, 1.0, 1.0]) * 1e-3, atol=1e-12
    )


def test_a_mesh_of_one_piece_is_none_of_this():
    assert united(Surface(*cube((0, 0, 0), 5))) is None
