"""How far apart, how deep, and where a component comes to rest."""

import numpy as np
import pytest

from geocontact.geometry.kernels.floor import _lowest
from geocontact.geometry.separation import CLOSE, Collider, separation, settle
from geocontact.geometry.surface import Surface
from meshes import reference
from meshes import simple_shapes as shapes
from tests.geometry.bodies import MM, contact, cube, moved, order_of, pose_of, surface, turned

DEEP = 1e-6  # m; depths are promised to this
UNIT = surface(cube((0, 0, 0), 10.0), "cube")


def smallest(moving, fixed, pose):
    return contact(moving, fixed, pose, 1 * MM).min_distance


def without(body, face):
    """An open body: one face taken away."""
    return body[0], np.delete(body[1], face, axis=0)


# --- apart ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("gap", [1e-3, 0.5, 40.0])
@pytest.mark.parametrize(
    ("rotation", "height"),
    [(turned(0, 30, 0), 10.0), (turned(0, 0, 45), 10 * 2**0.5), (turned(20, 30, 40), None)],
    ids=["face", "edge", "corner"],
)
def test_cube_over_a_face(rotation, height, gap):
    """Nearest points in the middle of a face of two triangles: lowest corner or edge of the moving cube."""
    height = -(rotation.apply(UNIT.vertices)[:, 1].min()) / MM if height is None else height
    pose = pose_of(rotation, np.array([0.7, 10 + height + gap, -0.4]) * MM)
    assert separation(UNIT, UNIT, pose) / MM == pytest.approx(gap, abs=1e-12)
    assert smallest(UNIT, UNIT, pose) / MM == pytest.approx(gap, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("gap", [1e-3, 0.5, 40.0])
def test_crossed_edges(gap):
    """Two cubes edge to edge, the edges at right angles: no corner of either is near the other."""
    upper = pose_of(turned(45, 0, 0), np.array([0.0, 10 * 2**0.5 + gap, 0.0]) * MM)
    lower = surface(moved(cube((0, 0, 0), 10.0), turned(0, 0, 45), [0, -10 * 2**0.5, 0]))
    assert separation(UNIT, lower, upper) / MM == pytest.approx(gap, abs=1e-12)
    assert smallest(UNIT, lower, upper) / MM == pytest.approx(gap, abs=1e-12)


def test_two_spheres_converge_at_second_order():
    cells, excess = np.array([6, 12, 24]), []
    pose = pose_of(turned(10, 20, 30), np.array([1.0, 2.0, 3.0]) / 14**0.5 * (20 + 12 + 0.7) * MM)
    for n in cells:
        gap = separation(surface(shapes.sphere(12.0, n)), surface(shapes.sphere(20.0, n)), pose)
        excess.append(gap / MM - 0.7)
    assert min(excess) > 0, f"facets lie inside the spheres: {excess}"
    assert excess[-1] < 0.05, f"excess {excess} mm"
    assert order_of(1 / cells, excess) == pytest.approx(2.0, abs=0.6), f"excess {excess} mm"


def test_collision_begins_where_the_distance_ends():
    collider = Collider(UNIT, UNIT)
    for gap, meets in ((1e-9, False), (-1e-9, True)):
        shift = np.array([3.0, 20.0 + gap, 1.0]) * MM
        assert collider.collide(np.eye(3), shift) == meets
        assert (collider.distance(np.eye(3), shift) == 0) == meets


def test_far_offset_costs_nothing():
    far = surface((UNIT.vertices / MM + [1e6, -1e6, 1e6], UNIT.faces))
    gap = separation(far, far, pose_of(shift=[0, 20.5 * MM, 0]))
    assert gap / MM == pytest.approx(0.5, abs=1e-6)


def test_degenerate_faces_do_not_touch():
    """fcl answers about 0 to a triangle without area."""
    vertices, faces = cube((0, 0, 0), 10.0)
    spoilt = surface((vertices, np.vstack([faces, [[0, 0, 0], [0, 1, 1]]])))
    assert separation(spoilt, UNIT, pose_of(shift=[0, 21 * MM, 0])) / MM == pytest.approx(1.0, abs=1e-12)


def test_nothing_but_degenerate_faces_is_refused():
    flat = surface((np.zeros((3, 3)), np.array([[0, 1, 2]])), "speck")
    with pytest.raises(ValueError, match="speck: every face is degenerate"):
        Collider(flat, UNIT)


# --- overlapping ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("depth", [1e-3, 0.5, 3.0])
@pytest.mark.parametrize("swapped", [False, True])
def test_cube_pushed_into_a_larger_one(depth, swapped):
    large = surface(cube((0, -40.0, 0), 40.0))
    pose = pose_of(turned(0, 20, 0), np.array([1.0, 10 - depth, 2.0]) * MM)
    found = contact(large, UNIT, pose.inv(), 0.0) if swapped else contact(UNIT, large, pose, 0.0)
    assert -found.min_distance / MM == pytest.approx(depth, abs=DEEP / MM)
    # the large cube's face between the small one's walls is as deep as the small one's floor in the large cube
    assert found.max_penetration_fixed / MM == pytest.approx(depth, abs=DEEP / MM)


@pytest.mark.parametrize("height", [2.0, -1.0])
def test_below_the_opening_of_a_body_taken_as_closed_nothing_is_deep(height):
    """Normals of the walls say inside there, winding numbers outside.

    Points of the plate within the cup, near its opening, are no deeper than its walls are far.
    """
    vertices, faces = cube((0, 0, 0), 10.0)
    low = np.isclose(vertices[faces][:, :, 1], vertices[:, 1].min()).all(axis=1)
    cup = Surface(vertices * MM, faces[~low], assume_closed=True)
    plate = surface(cube((0, -5.0, 0), (60.0, 5.0, 60.0)), "plate")
    for turn in (0.0, 20.0):
        found = contact(cup, plate, pose_of(turned(0, turn, 0), np.array([0.3, 10.0 + height, 0.7]) * MM), 0.0)
        rays = np.stack(np.meshgrid(*[np.linspace(-9.9, 9.9, 67)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
        inside = np.zeros(len(rays)) if height > 0 else 10.0 - np.abs(rays).max(axis=1)
        assert found.max_penetration_fixed / MM <= inside.max() + DEEP / MM


def test_the_lowest_floors_are_kept():
    """Of more faces than are divided at a time exactly those with the lowest floors, also beside an outlier."""
    rng = np.random.default_rng(5)
    for floor in (rng.random(501), np.append(rng.random(500), -1e6), np.append(rng.random(500), 1e6), np.zeros(400)):
        keep = np.arange(len(floor))
        kept = getattr(_lowest, "py_func", _lowest)(keep.copy(), floor, 300)
        assert len(kept) == 300 and (np.diff(kept) > 0).all()
        assert sorted(floor[kept]) == sorted(floor)[:300]


@pytest.mark.slow
def test_depth_in_the_middle_of_a_large_face():
    """The plate is open, so only its own points can be deep: none of its corners is near the wedge that enters it.

    An edge of 90 deg, its tip at depth t, holds points of the plate's plane t / sqrt(2) away from its sides.
    """
    plate = surface(without(cube((0, -5.0, 0), (100.0, 5.0, 90.0)), [f for f, c in enumerate(bottoms()) if c]))
    assert not plate.closed
    for tip in (0.05, 1.0, 4.0):
        found = contact(UNIT, plate, pose_of(turned(0, 0, 45), np.array([7.0, 10 * 2**0.5 - tip, 3.0]) * MM), 0.0)
        depth = tip / 2**0.5
        assert -found.min_distance / MM == pytest.approx(depth, abs=DEEP / MM)
        assert found.max_penetration_fixed / MM == pytest.approx(depth, abs=DEEP / MM)


def bottoms():
    vertices, faces = cube((0, 0, 0), 1.0)
    return vertices[faces][:, :, 1].max(axis=1) < 0


def test_ball_pressed_into_a_plate():
    """Depth of the lowest vertex, which is that of no face of the plate."""
    ball, depth = shapes.sphere(20.0, 12), 0.3
    turn = turned(10, 20, 30)
    lowest = turn.apply(ball[0])[:, 1].min()
    plate = surface(shapes.block(80.0, 80.0, 12.0, 5))
    pose = pose_of(turn, np.array([1.3, -lowest - depth, -2.1]) * MM)
    assert smallest(surface(ball), plate, pose) / MM == pytest.approx(-depth, abs=DEEP / MM)


@pytest.mark.parametrize("n", [4, 12])
@pytest.mark.parametrize("depth", [0.5, 4.0])
def test_overlapping_balls(n, depth):
    """Between the bounds of adaptive subdivision with libigl of the same facets, near the closed form of spheres."""
    large, small = shapes.sphere(20.0, n), shapes.sphere(12.0, n)
    turn, shift = turned(10, 20, 30), np.array([1.0, 2.0, 3.0]) / 14**0.5 * (32 - depth)
    found = smallest(surface(small), surface(large), pose_of(turn, shift * MM)) / MM
    lower, upper = reference.smallest_distance(large, moved(small, turn, shift))
    assert lower - DEEP / MM <= found <= upper + DEEP / MM, f"{found} mm, not within {lower} .. {upper}"
    sagitta = (
        (20 + 12) * (1.2 / n) ** 2 / 6
    )  # edges of at most 1.2 R / n, circles around faces of a third of that squared
    assert -depth <= found <= -depth + sagitta


def test_one_body_inside_the_other():
    """Nothing touches; the inner cube's far face is deepest: 10 - 3 + 2 mm from the nearest side of the outer one."""
    inner = surface(cube((0, 0, 0), 2.0), "inner")
    pose = pose_of(shift=[5.0 * MM, 0, 0])
    assert separation(inner, UNIT, pose) / MM == pytest.approx(3.0, abs=1e-12)
    within, around = contact(inner, UNIT, pose, 1 * MM), contact(UNIT, inner, pose.inv(), 1 * MM)
    assert within.min_distance / MM == pytest.approx(-7.0, abs=DEEP / MM)
    assert around.min_distance / MM == pytest.approx(-7.0, abs=DEEP / MM)
    assert (within.max_penetration_fixed, around.max_penetration_fixed / MM) == pytest.approx((0.0, 7.0), abs=DEEP / MM)


def test_crossing_bars_overlap_although_no_corner_is_inside():
    """Deepest are the middles of the side faces: 2 mm from top and bottom, 3 mm from the sides of the other bar."""
    one, other = surface(cube((0, 0, 0), (30.0, 2.0, 3.0))), surface(cube((0, 0, 0), (3.0, 2.0, 30.0)))
    found = contact(one, other, pose_of(shift=[0, 1.0 * MM, 0]), 0.0)
    assert found.min_distance / MM == pytest.approx(-2.0, abs=DEEP / MM)
    assert found.max_penetration_fixed / MM == pytest.approx(2.0, abs=DEEP / MM)


def test_depth_of_counted_faces_only():
    """max_penetration_fixed is of the faces that count, min_distance of the whole surfaces."""
    large = surface(cube((0, -40.0, 0), 40.0))
    pose = pose_of(shift=[0, (10 - 0.5) * MM, 0])
    sides = np.abs(UNIT.face_normal[:, 1]) < 0.5
    found = contact(large, UNIT, pose.inv(), 0.0, fixed_faces=UNIT.face_normal[:, 1] > 0.5)
    assert (found.min_distance / MM, found.max_penetration_fixed) == pytest.approx((-0.5, 0.0), abs=DEEP / MM)
    found = contact(large, UNIT, pose.inv(), 0.0, fixed_faces=sides)
    assert found.max_penetration_fixed / MM == pytest.approx(0.5, abs=DEEP / MM)


@pytest.mark.slow
def test_open_bodies_overlap_without_depth():
    """Where no body is closed the distance of overlapping bodies is 0 and the depth unknown."""
    lidless = surface(without(cube((0, 0, 0), 10.0), [0]))
    touching, apart = pose_of(turned(0, 0, 20), [12 * MM, 3 * MM, 0]), pose_of(shift=[25 * MM, 0, 0])
    both = contact(lidless, lidless, touching, 0.0)
    assert both.min_distance == 0.0
    assert np.isnan(both.max_penetration_fixed)
    moving = contact(lidless, UNIT, touching, 0.0)
    assert moving.min_distance < -1 * MM
    assert np.isnan(moving.max_penetration_fixed)
    fixed = contact(UNIT, lidless, touching, 0.0)
    assert fixed.max_penetration_fixed == -fixed.min_distance > 1 * MM
    for one, other in ((lidless, lidless), (lidless, UNIT), (UNIT, lidless)):
        assert contact(one, other, apart, 0.0).min_distance / MM == pytest.approx(5.0, abs=1e-12)


def test_distance_is_the_depth_turned_over_as_bodies_meet():
    """No step where gap turns into depth."""
    large = surface(cube((0, -40.0, 0), 40.0))
    gaps = np.array([1e-3, 1e-5, 1e-7, -1e-7, -1e-5, -1e-3])
    found = [smallest(UNIT, large, pose_of(turned(3, 5, 7), [0, h, 0])) for h in gaps - lowest(UNIT, turned(3, 5, 7))]
    assert found == pytest.approx(gaps, abs=DEEP)


def lowest(body, rotation):
    return rotation.apply(body.vertices)[:, 1].min()


# --- settling ---------------------------------------------------------------------------------------------------------

DOWN = (0.0, -1.0, 0.0)
PLATE = surface(shapes.block(80.0, 80.0, 12.0, 5), "plate")
BALL = surface(shapes.sphere(20.0, 8), "ball")
TURN = turned(10, 20, 30)


@pytest.mark.parametrize("start", [500.0, 20.5, 3.0, -300.0], ids=["far", "near", "overlapping", "below"])
def test_ball_settles_on_a_plate_at_its_lowest_vertex(start):
    rest = settle(BALL, PLATE, pose_of(TURN, np.array([1.3, start, -2.1]) * MM), DOWN)
    height = np.asarray(rest.translation)[1]
    assert height == pytest.approx(-lowest(BALL, TURN), abs=2 * CLOSE), f"{(height + lowest(BALL, TURN)):.1e} m off"
    assert np.asarray(rest.translation)[[0, 2]] / MM == pytest.approx([1.3, -2.1], abs=1e-12)
    assert rest.rotation.as_matrix() == pytest.approx(TURN.as_matrix(), abs=1e-15)
    assert 0 < separation(BALL, PLATE, rest) <= CLOSE


@pytest.mark.parametrize("offset", [0.0, 2.0, 4.5])
def test_ball_settles_in_a_cup(offset):
    """Centres R2 - R1 apart where they touch: the ball's is sqrt((R2 - R1)^2 - x^2) below the cup's."""
    ball, cup = surface(shapes.sphere(18.0, 24)), surface(shapes.cup(24.0, 5.0, 28))
    rests = [settle(ball, cup, pose_of(TURN, np.array([offset, h, 0.0]) * MM), DOWN) for h in (300.0, 30.0, -3.0)]
    heights = np.array([np.asarray(rest.translation)[1] for rest in rests])
    assert np.ptp(heights) <= 1e-7, f"heights {heights}"
    assert heights[0] / MM == pytest.approx(-((36 - offset**2) ** 0.5), abs=0.1)
    assert separation(ball, cup, rests[0]) <= CLOSE
    further = pose_of(TURN, np.asarray(rests[0].translation) + 1e-6 * np.array(DOWN))
    assert separation(ball, cup, further) == 0


def test_settling_along_any_direction_of_any_length():
    way = np.array([3.0, -4.0, 1.0])
    rest = [settle(BALL, PLATE, pose_of(TURN, [0, 0.05, 0]), tuple(k * way)) for k in (1.0, 70.0)]
    assert rest[0].translation == pytest.approx(rest[1].translation, abs=1e-9)
    travel = np.asarray(rest[0].translation) - [0, 0.05, 0]
    assert travel / np.linalg.norm(travel) == pytest.approx(way / np.linalg.norm(way), abs=1e-9)
    assert np.asarray(rest[0].translation)[1] == pytest.approx(-lowest(BALL, TURN), abs=2e-9)


def test_bodies_that_miss_are_said_to():
    with pytest.raises(ValueError, match=r"ball misses plate along \(0.0, -1.0, 0.0\)"):
        settle(BALL, PLATE, pose_of(TURN, [0.2, 0.1, 0]), DOWN)


def test_no_direction_is_refused():
    with pytest.raises(ValueError, match="direction of settling has no length"):
        settle(BALL, PLATE, pose_of(TURN), (0.0, 0.0, 0.0))
