"""Areas within a threshold: closed forms, orders, bounds, invariances, and what adds up.

What the facets cost is kept apart in two ways. `test_sample_pairs` compares with areas of the *same* facets, converged
by adaptive subdivision with libigl. Here closed forms of the smooth bodies are met by extrapolating two meshes to edge
length zero (the facets cost area in proportion to its square), or by that order itself.
"""

from functools import cache

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.contact_area.area import AS_GIVEN, Refinement
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from meshes import reference
from meshes import simple_shapes as shapes
from tests import closed_forms as exact
from tests.geometry.bodies import MM, MM2, contact, cube, joined, moved, order_of, pose_of, surface, turned

TURN = turned(10, 20, 30)
PLATE = surface(shapes.block(80.0, 80.0, 12.0, 24), "plate")
R1, R2 = 20.0, 12.0


# --- closed forms -----------------------------------------------------------------------------------------------------


def over_plate(body, height, rotation=TURN):
    """A body over the plate, its reference point at this height [mm]."""
    return surface(body), PLATE, pose_of(rotation, np.array([1.3, height, -2.1]) * MM)


def in_cup(n, gap):
    downwards = np.array([np.sin(np.radians(10)), -np.cos(np.radians(10)), 0])
    return surface(shapes.sphere(18.0, n)), surface(shapes.cup(24.0, 5.0, n)), pose_of(TURN, (6 - gap) * downwards * MM)


def spheres(n, gap):
    along = np.array([1.0, 2.0, 3.0]) / 14**0.5
    return surface(shapes.sphere(R2, n)), surface(shapes.sphere(R1, n)), pose_of(TURN, (R1 + R2 + gap) * along * MM)


CASES = {  # (n, gap) -> moving, fixed, pose; (gap, T) -> area on fixed, on moving; n; relative error
    "sphere over plane": (
        lambda n, gap: over_plate(shapes.sphere(20.0, n), 20 + gap),
        lambda gap, t: exact.sphere_plane_on_plane(20, gap, t),
        lambda gap, t: exact.sphere_plane_on_sphere(20, gap, t),
        24,
        1e-3,
    ),
    "cylinder on plane": (
        lambda n, gap: over_plate(shapes.cylinder(15.0, 40.0, n), 15 + gap, turned(0, 20, 0)),
        lambda gap, t: exact.cylinder_plane_on_plane(15, 40, gap, t),
        lambda gap, t: exact.cylinder_plane_on_cylinder(15, 40, gap, t),
        20,
        1e-3,
    ),
    "sphere in cup": (
        in_cup,
        lambda gap, t: exact.sphere_cup_on_cup(18, 24, 6 - gap, t),
        lambda gap, t: exact.sphere_cup_on_sphere(18, 24, 6 - gap, t),
        24,
        1e-3,
    ),
    "flat torus on plane": (
        lambda n, gap: over_plate(shapes.torus(25.0, 8.0, n), 8 + gap, turned(0, 25, 0)),
        lambda gap, t: exact.flat_torus_plane_on_plane(25, 8, gap, t),
        lambda gap, t: exact.flat_torus_plane_on_torus(25, 8, gap, t),
        64,
        2e-3,
    ),
    "upright torus on plane": (
        lambda n, gap: over_plate(shapes.torus(25.0, 8.0, n), 33 + gap, turned(0, 25, 0) * turned(90, 0, 0)),
        lambda gap, t: exact.upright_torus_plane_on_plane(25, 8, gap, t),
        lambda gap, t: exact.upright_torus_plane_on_torus(25, 8, gap, t),
        40,
        1e-3,
    ),
}


@cache
def areas(case, gap, thresholds, n):
    """Areas [mm^2] (2, thresholds) on fixed and moving."""
    found = contact(*CASES[case][0](n, gap), np.array(thresholds) * MM)
    return np.array([[a.area / MM2 for a in side] for side in (found.fixed, found.moving)])


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(("gap", "thresholds"), [(-0.3, (0.5, 1.0, 4.0)), (0.4, (2.0, 4.0))])
def test_area_is_the_closed_form_beyond_what_the_facets_cost(case, gap, thresholds):
    """Richardson: a third of the change from n to 2n cells is left to go; 0.1 %, with the flat torus 0.2 %.

    There rows of facets run along the edge of the patch and cost now more, now less than the square of their size.
    """
    _, on_fixed, on_moving, n, within = CASES[case]
    coarse, fine = areas(case, gap, thresholds, n), areas(case, gap, thresholds, 2 * n)
    true = np.array([[form(gap, t) for t in thresholds] for form in (on_fixed, on_moving)])
    off = (fine + (fine - coarse) / 3) / true - 1
    assert np.abs(off).max() < within, f"relative errors of the extrapolated areas:\n{off}"
    assert np.abs(fine / true - 1).max() < 0.02, f"relative errors with facets:\n{fine / true - 1}"


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["refined", "clip"])
@pytest.mark.parametrize(("gap", "threshold"), [(-0.1, 1.0), (-0.1, 4.0), (0.3, 4.0)])
def test_area_of_sphere_pairs_converges_at_second_order(rule, gap, threshold):
    cells, error = np.array([12, 24, 48]), []
    true = [exact.sphere_sphere_on_first(a, b, gap, threshold) for a, b in ((R1, R2), (R2, R1))]
    for n in cells:
        found = contact(*spheres(n, gap), threshold * MM, rule=rule)
        error.append([found.fixed[0].area / MM2 / true[0] - 1, found.moving[0].area / MM2 / true[1] - 1])
    for side, name in enumerate(("fixed", "moving")):
        errors = np.array(error)[:, side]
        order = order_of(1 / cells, errors)
        assert order == pytest.approx(2.0, abs=0.2), (
            f"area_{name}: observed order {order:.2f}, relative errors {errors}"
        )


@pytest.mark.slow
@pytest.mark.parametrize(("rule", "sign"), [("all-vertices", -1), ("any-vertex", 1)])
def test_counting_whole_faces_converges_at_first_order(rule, sign):
    cells, true = np.array([8, 16, 32, 64]), exact.sphere_sphere_on_first(R1, R2, 0.3, 4.0)
    error = [contact(*spheres(n, 0.3), 4 * MM, rule=rule).fixed[0].area / MM2 / true - 1 for n in cells]
    order = order_of(1 / cells, error)
    assert (np.sign(error) == sign).all(), f"relative errors {error}"
    assert order == pytest.approx(1.0, abs=0.25), f"observed order {order:.2f}, relative errors {error}"
    assert abs(error[1]) > 0.05, f"{error[1]}: no cruder than cutting faces"


# --- flat faces: exact ------------------------------------------------------------------------------------------------

W, D, H = 20.0, 16.0, 10.0  # of the box [mm]
GAP, THRESHOLD = 0.2, 2.0


def tilted_box(degrees, cells=1):
    """A box with its lower edge at x = 0 turned about it, `GAP` above the plane y = 0, rising with x."""
    box = shapes.block(W, D, H, cells)
    return moved((box[0] + [W / 2, H, 0], box[1]), turned(0, 0, degrees), [0, GAP, 0])


def tilted_box_parts(degrees, threshold):
    """Area [mm^2] and centroid [mm] of each part of the tilted box below the threshold: floor, end wall, two sides."""
    slope, rise = np.radians(degrees), threshold - GAP
    c, s = np.cos(slope), np.sin(slope)
    floor, wall = rise / s, rise / c
    assert floor < W and wall < H
    tips = np.array([[0, 0], [floor * c, floor * s], [-wall * s, wall * c]])
    x, y = tips.mean(axis=0)
    return [
        (floor * D, [floor * c / 2, GAP + floor * s / 2, 0]),
        (wall * D, [-wall * s / 2, GAP + wall * c / 2, 0]),
        (floor * wall / 2, [x, GAP + y, -D / 2]),
        (floor * wall / 2, [x, GAP + y, D / 2]),
    ]


@pytest.mark.parametrize("degrees", [8.0, 25.0, 60.0])
@pytest.mark.parametrize("refinement", [AS_GIVEN, Refinement()], ids=["as given", "refined"])
def test_tilted_box_over_a_plate_is_exact(degrees, refinement):
    """Distance to a plane is linear, so nothing but rounding is lost: area, centroid and the part beyond a plane."""
    parts = tilted_box_parts(degrees, THRESHOLD)
    area = sum(a for a, _ in parts)
    centroid = sum(a * np.array(c) for a, c in parts) / area
    found = contact(PLATE, surface(tilted_box(degrees, 3)), pose_of(), THRESHOLD * MM, refinement=refinement).fixed[0]
    assert found.area / MM2 == pytest.approx(area, rel=1e-12)
    assert found.centroid / MM == pytest.approx(centroid, abs=1e-11)
    assert found.lower <= found.area <= found.upper
    assert found.error <= refinement.accuracy * found.area or refinement == AS_GIVEN


@pytest.mark.parametrize("at", [-5.0, 0.0, 1.7, 7.9])
def test_part_beyond_the_splitting_plane_is_exact(at):
    """The plane z = at cuts floor and wall of the tilted box; one side lies beyond it as a whole."""
    floor, wall, side, _ = tilted_box_parts(25.0, THRESHOLD)
    negative = (floor[0] + wall[0]) * (at + D / 2) / D + side[0]
    box = surface(tilted_box(25.0, 3))
    found = contact(PLATE, box, pose_of(), THRESHOLD * MM, split=Plane.across("z", at * MM), medial_side=-1).fixed[0]
    assert found.negative / MM2 == pytest.approx(negative, rel=1e-12)


def test_oblique_plane_through_the_middle_halves_a_symmetric_patch():
    """The patch is symmetric about z = 0; mirrored planes cut it alike, and each with its flipped one adds up."""
    box = surface(tilted_box(25.0, 3))
    parts = []
    for normal in ((0.6, 0.0, 0.8), (0.6, 0.0, -0.8), (-0.6, 0.0, -0.8)):
        found = contact(
            PLATE, box, pose_of(), THRESHOLD * MM, split=Plane(normal, 1e-3 * np.sign(normal[0])), medial_side=-1
        ).fixed[0]
        parts.append(found.negative)
    assert parts[0] == pytest.approx(parts[1], rel=1e-12)
    assert parts[0] + parts[2] == pytest.approx(found.area, rel=1e-12)
    assert 0 < parts[0] < found.area


@pytest.mark.slow
def test_medial_part_of_a_disc_is_cut_by_its_chord():
    """Plane under a sphere: segment r^2 acos(c/r) - c sqrt(r^2 - c^2) beyond the chord at distance c."""
    gap, threshold, n = -0.3, 4.0, 48
    area = exact.sphere_plane_on_plane(20, gap, threshold)
    r = (area / np.pi) ** 0.5
    for c in (-7.0, 0.0, 3.3, 12.0):
        segment = r**2 * np.arccos(c / r) - c * (r**2 - c**2) ** 0.5
        split = Plane.across("x", (1.3 - c) * MM)
        found = contact(
            *over_plate(shapes.sphere(20.0, n), 20 + gap), threshold * MM, split=split, medial_side=-1
        ).fixed[0]
        off = found.negative / MM2 - segment
        assert abs(off) < 1.5e-3 * area, f"chord at {c}: {off:.3f} mm^2 off {segment:.1f}"


@pytest.mark.parametrize("accuracy", [2e-4, 1e-5])
@pytest.mark.parametrize(("gap", "threshold"), [(0.5, 2.0), (1.0, 4.0), (0.0, 1.0)])
def test_flat_box_over_a_plate_covers_a_rounded_rectangle(gap, threshold, accuracy):
    """Plate within T of a box g above it: (w + 2s)(d + 2s) - (4 - pi) s^2, s^2 = T^2 - g^2; box: floor and walls.

    The facets cost nothing, so the accuracy asked for is what must come back, and be known.
    """
    box = shapes.block(W, D, H, 2)
    lifted, pose = surface((box[0] + [0, H, 0], box[1])), pose_of(shift=[0, gap * MM, 0])
    found = contact(lifted, PLATE, pose, threshold * MM, refinement=Refinement(accuracy))
    s, rise, ours = (threshold**2 - gap**2) ** 0.5, threshold - gap, found.fixed[0]
    rounded = (W + 2 * s) * (D + 2 * s) - (4 - np.pi) * s**2
    off, estimate = ours.area / MM2 / rounded - 1, ours.error / ours.area
    assert abs(off) < 2 * accuracy, f"relative error {off:.1e}, estimated {estimate:.1e}"
    assert abs(off) < 3 * estimate, f"relative error {off:.1e}, estimated {estimate:.1e}"
    assert found.moving[0].area / MM2 == pytest.approx(W * D + 2 * (W + D) * rise, rel=1e-12)


# --- centroids --------------------------------------------------------------------------------------------------------


def test_centroids_under_a_sphere():
    """The disc's lies below the centre; the cap's half way up the cap (Archimedes); both in FIXED's frame."""
    gap, threshold = -0.3, 4.0
    found = contact(*over_plate(shapes.sphere(20.0, 48), 20 + gap), threshold * MM)
    assert found.fixed[0].centroid / MM == pytest.approx([1.3, 0.0, -2.1], abs=5e-3)
    assert found.moving[0].centroid / MM == pytest.approx([1.3, gap + (threshold - gap) / 2, -2.1], abs=5e-3)


@pytest.mark.parametrize("rule", ["refined", "clip", "all-vertices", "any-vertex", "centroid"])
def test_centroid_of_a_patch_is_in_the_frame_of_the_fixed_body(rule):
    """Far from both frames' origins, for every rule: a mean weighted wrongly would be metres off."""
    moving, fixed, pose = over_plate(shapes.sphere(20.0, 24), 19.7)
    far, there = turned(40, -70, 20), np.array([3.0, -2.0, 5.0])
    to_moving, to_fixed = pose_of(turned(5, 6, 7), [-4.0, 1.0, 2.0]), pose_of(far, there)
    found = contact(
        placed(moving, to_moving), placed(fixed, to_fixed), to_fixed * pose * to_moving.inv(), 4 * MM, rule=rule
    )
    for side, height in (("fixed", 0.0), ("moving", 1.85)):
        centroid = to_fixed.inv().apply(getattr(found, side)[0].centroid) / MM
        assert centroid == pytest.approx([1.3, height, -2.1], abs=0.6), f"{side}: {centroid}"


def test_no_patch_no_centroid():
    found = contact(*over_plate(shapes.sphere(20.0, 8), 25.0), 4 * MM)
    for side in (found.fixed[0], found.moving[0]):
        assert (side.area, side.lower, side.upper) == (0, 0, 0)
        assert np.isnan(side.centroid).all()


# --- bounds -----------------------------------------------------------------------------------------------------------

SMALL = {
    "ball": shapes.sphere(10.0, 3),
    "box": cube((0, 0, 0), (8.0, 5.0, 6.0)),
    "ring": shapes.torus(8.0, 3.0, 6),
    "bowl": shapes.cup(9.0, 3.0, 3),
    "two balls in one": joined(shapes.sphere(7.0, 3), moved(shapes.sphere(6.0, 3), turned(1, 2, 3), [0, 4.0, 9.0])),
}


@pytest.mark.slow
@settings(max_examples=12, deadline=None, derandomize=True, phases=[Phase.generate])
@given(
    names=st.tuples(st.sampled_from(list(SMALL)), st.sampled_from(list(SMALL))),
    seed=st.integers(0, 2**32 - 1),
    apart=st.floats(0.0, 1.2),
    threshold=st.just(0.0) | st.floats(0.1, 5.0),
)
def test_truth_lies_between_the_bounds(names, seed, apart, threshold):
    """Random poses, from one body inside the other to just apart; the truth by subdivision with libigl."""
    moving, fixed = SMALL[names[0]], SMALL[names[1]]
    rng = np.random.default_rng(seed)
    rotation, way = Rotation.random(rng=rng), rng.normal(size=3)
    shift = 20.0 * apart * way / np.linalg.norm(way)
    placed_moving = moved(moving, rotation, shift)
    true = {
        "fixed": reference.area_within(fixed, placed_moving, threshold, width=5e-3, most=20_000),
        "moving": reference.area_within(placed_moving, fixed, threshold, width=5e-3, most=20_000),
    }
    for refinement in (AS_GIVEN, Refinement(), Refinement(bounds=0.02)):
        found = contact(
            surface(moving), surface(fixed), pose_of(rotation, shift * MM), threshold * MM, refinement=refinement
        )
        for side in ("fixed", "moving"):
            known, doubt = true[side], 3 * true[side].uncertainty + 1e-9
            lower, area, upper = (getattr(getattr(found, side)[0], x) / MM2 for x in ("lower", "area", "upper"))
            what = f"{refinement}: {side} {lower:.6g} <= {area:.6g} <= {upper:.6g}, {known}"
            assert lower <= area <= upper, what
            assert lower <= known.upper + 1e-9 and known.lower <= upper + 1e-9, what
            assert lower - doubt <= known.estimate <= upper + doubt, what
            if refinement.bounds == 0.02 and upper > 0.01 and known.uncertainty < 1e-4 * known.estimate:
                assert upper - lower <= 0.02 * upper, what
                assert area == pytest.approx(known.estimate, rel=1e-3, abs=doubt), what


def test_body_deep_inside_another_counts_as_a_whole():
    large, small = surface(cube((0, 0, 0), 30.0)), surface(shapes.sphere(5.0, 4))
    for threshold in (0.0, 1.0, 4.0):
        found = contact(small, large, pose_of(TURN, [3 * MM, 0, 0]), threshold * MM)
        whole = small.face_area.sum()
        assert (found.fixed[0].area, found.fixed[0].upper) == (0, 0)
        assert [found.moving[0].lower, found.moving[0].area] == pytest.approx([whole, whole], rel=1e-12)


@pytest.mark.parametrize(("gap", "threshold"), [(4.0, 4.0), (0.0, 0.0)])
def test_surfaces_exactly_a_threshold_apart_end(gap, threshold):
    """Nothing can tell what counts there, so dividing must not go on for ever; the bounds still hold both answers."""
    box = shapes.block(W, D, H, 2)
    lifted = surface((box[0] + [0, H, 0], box[1]))
    found = contact(lifted, PLATE, pose_of(shift=[0, gap * MM, 0]), threshold * MM, refinement=Refinement(bounds=0.02))
    for side in (found.fixed[0], found.moving[0]):
        assert side.lower == 0
        assert side.upper / MM2 >= W * D * (1 - 1e-9)


# --- invariances ------------------------------------------------------------------------------------------------------


def placed(body, pose):
    """The same body described in another frame."""
    return Surface(pose.apply(body.vertices), body.faces, body.name)


def shuffled(body, rng):
    """The same body with vertices, faces and the first corner of each face in another order."""
    order = rng.permutation(len(body.vertices))
    faces = np.argsort(order)[body.faces][rng.permutation(len(body.faces))]
    turn = rng.integers(3, size=(len(faces), 1))
    return Surface(body.vertices[order], np.take_along_axis(faces, (np.arange(3) + turn) % 3, axis=1))


def numbers(found):
    """Everything that should not change."""
    return np.array([[s.area, s.lower, s.upper, s.negative] for side in (found.fixed, found.moving) for s in side])


SCENES = {
    "sphere over plane": lambda: over_plate(shapes.sphere(20.0, 16), 19.7),
    "sphere in cup": lambda: in_cup(16, -0.3),
    "box over plate": lambda: (PLATE, surface(tilted_box(25.0, 3)), pose_of(turned(0, 3, 0))),
}
THRESHOLDS = np.array([0.0, 0.5, 4.0]) * MM


def assert_same(one, other, rel=1e-9):
    off = np.abs(other - one).max() / one.max()
    assert off <= rel, f"relative change {off:.1e}:\n{one}\n{other}"


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "scene"), list(enumerate(SCENES)))
@pytest.mark.parametrize("refinement", [AS_GIVEN, Refinement()], ids=["as given", "refined"])
def test_nothing_changes_when_everything_moves(scene, refinement, seed):
    moving, fixed, pose = SCENES[scene]()
    rng = np.random.default_rng(seed)
    a, b = (RigidTransform.from_components(rng.uniform(-1, 1, 3), Rotation.random(rng=rng)) for _ in range(2))
    here = contact(moving, fixed, pose, THRESHOLDS, refinement=refinement)
    there = contact(placed(moving, a), placed(fixed, b), b * pose * a.inv(), THRESHOLDS, refinement=refinement)
    assert_same(numbers(here), numbers(there))
    assert there.min_distance == pytest.approx(here.min_distance, abs=1e-12)
    for side in ("fixed", "moving"):
        for one, other in zip(getattr(here, side), getattr(there, side), strict=True):
            assert other.centroid == pytest.approx(b.apply(one.centroid), abs=1e-11, nan_ok=True)


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("scale", [25.4e-3, pytest.param(25.4, marks=pytest.mark.long)])
def test_nothing_changes_with_the_unit(scene, scale):
    """Thresholds and all in inches taken for millimetres, and for metres: areas go with the square."""
    moving, fixed, pose = SCENES[scene]()
    larger = [Surface(body.vertices * scale, body.faces) for body in (moving, fixed)]
    there = contact(*larger, pose_of(pose.rotation, pose.translation * scale), THRESHOLDS * scale)
    assert_same(numbers(contact(moving, fixed, pose, THRESHOLDS)), numbers(there) / scale**2)


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("refinement", [AS_GIVEN, Refinement()], ids=["as given", "refined"])
def test_nothing_changes_with_the_order_of_vertices_and_faces(scene, refinement):
    moving, fixed, pose = SCENES[scene]()
    rng = np.random.default_rng(0)
    here = contact(moving, fixed, pose, THRESHOLDS, refinement=refinement)
    there = contact(shuffled(moving, rng), shuffled(fixed, rng), pose, THRESHOLDS, refinement=refinement)
    assert_same(numbers(here), numbers(there))


@pytest.mark.slow
def test_bodies_change_places():
    """What moves is a matter of words: fixed and moving areas swap when the bodies do."""
    moving, fixed, pose = SCENES["sphere in cup"]()
    here, there = contact(moving, fixed, pose, THRESHOLDS), contact(fixed, moving, pose.inv(), THRESHOLDS)
    assert_same(numbers(here)[:, :3], np.roll(numbers(there), len(THRESHOLDS), axis=0)[:, :3])
    assert there.min_distance == pytest.approx(here.min_distance, abs=1e-12)


@pytest.mark.parametrize(("refinement", "jump"), [(AS_GIVEN, 0.0), (Refinement(), 5e-4)], ids=["as given", "refined"])
def test_area_changes_little_with_a_little_shift(refinement, jump):
    """1e-7 m down: dA = 2 pi (R + gap) dz on the plane, no steps; refining may change its mind within its accuracy."""
    step, heights = 1e-7, 19.7 * MM - 1e-7 * np.arange(30)
    moving, fixed, pose = over_plate(shapes.sphere(20.0, 16), 19.7)
    shift = np.array(pose.translation)
    area = []
    for height in heights:
        shift[1] = height
        area.append(contact(moving, fixed, pose_of(pose.rotation, shift), 4 * MM, refinement=refinement).fixed[0].area)
    rise = np.diff(area)
    expected = 2 * np.pi * 19.7 * MM * step
    assert np.abs(rise - expected).max() < 0.5 * expected + jump * area[0], (
        f"steps of {rise.min():.2e} .. {rise.max():.2e}"
    )


def test_area_grows_with_the_threshold():
    """From 0, where only what overlaps counts."""
    thresholds = np.linspace(0, 4, 33) * MM
    found = contact(*over_plate(shapes.sphere(20.0, 24), 19.7), thresholds)
    for side, at_zero in (("fixed", exact.sphere_plane_on_plane(20, -0.3, 0)), ("moving", 2 * np.pi * 20 * 0.3)):
        area = np.array([a.area for a in getattr(found, side)]) / MM2
        assert (np.diff(area) > 0).all(), f"area_{side} {area}"
        assert area[0] == pytest.approx(at_zero, rel=0.03)


# --- what adds up -----------------------------------------------------------------------------------------------------


def test_regions_add_up_to_the_whole():
    moving, fixed, pose = SCENES["sphere in cup"]()
    stripes = np.random.default_rng(0).integers(3, size=len(fixed.faces))
    for refinement, rel in ((AS_GIVEN, 1e-12), (Refinement(), 5e-4)):
        parts = [
            contact(moving, fixed, pose, 4 * MM, fixed_faces=stripes == k, refinement=refinement) for k in range(3)
        ]
        whole = contact(moving, fixed, pose, 4 * MM, refinement=refinement)
        assert sum(p.fixed[0].area for p in parts) == pytest.approx(whole.fixed[0].area, rel=rel)
        assert sum(p.fixed[0].moment for p in parts) == pytest.approx(whole.fixed[0].moment, abs=rel * 1e-5)
        assert all(p.min_distance == whole.min_distance for p in parts), "the distance is of the whole surfaces"
        assert all(p.moving[0].area == whole.moving[0].area for p in parts)
        assert max(p.max_penetration_fixed for p in parts) == whole.max_penetration_fixed


@pytest.mark.parametrize("height", [11.0, 9.0], ids=["apart", "overlapping"])
def test_region_of_no_face_has_no_area(height):
    moving, fixed, pose = over_plate(shapes.sphere(10.0, 6), height)
    found = contact(moving, fixed, pose, 4 * MM, fixed_faces=np.zeros(len(fixed.faces), bool))
    assert (found.fixed[0].area, found.fixed[0].upper) == (0, 0)
    assert found.moving[0].area > 0


@pytest.mark.slow
def test_unsigned_area_is_the_signed_one_without_what_lies_deeper():
    """A face taken away on the far side makes the ball open: what lies deeper than T no longer counts."""
    ball, plate, threshold = shapes.sphere(20.0, 12), shapes.block(80.0, 80.0, 12.0, 24), 0.5
    highest = ball[0][ball[1]][:, :, 1].mean(axis=1).argmax()
    shift = np.array([1.3, 18.0, -2.1])
    signed, unsigned = (
        contact(
            surface((ball[0], faces)),
            PLATE,
            pose_of(shift=shift * MM),
            threshold * MM,
            refinement=Refinement(bounds=0.02),
        )
        for faces in (ball[1], np.delete(ball[1], highest, axis=0))
    )
    deeper = reference.area_within(plate, (ball[0] + shift, ball[1]), -threshold, width=2e-3).estimate
    assert deeper > 100
    assert unsigned.fixed[0].area / MM2 == pytest.approx(signed.fixed[0].area / MM2 - deeper, rel=1e-3)
    assert unsigned.fixed[0].lower <= unsigned.fixed[0].area <= unsigned.fixed[0].upper
    assert unsigned.moving[0].area == pytest.approx(signed.moving[0].area, rel=1e-3), "the plate is still closed"
    assert np.isnan(unsigned.max_penetration_fixed)
