"""Loads on spheres: closed forms on a plane, the sagittal formula, other grounds, moving frames."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.shapes import HalfSpace
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from geocontact.loads.ground import Ground, Sheet, Stairs
from geocontact.loads.sphere_set import SoleLaw, SphereSet, clearance, sphere_loads
from tests.loads.scenes import RADIUS, ROOT, law, rigid, scattered, sole, standing, still, twist

LEVEL = HalfSpace()
HERE = still()[0]
seeds = st.integers(0, 2**31)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and outward faces of a box."""
    corners = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)])
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    return corners, np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])


def slab() -> Surface:
    """A closed block whose top is y = 0."""
    surface = Surface(*box((-1.0, -0.5, -1.0), (1.0, 0.0, 1.0)))
    assert surface.closed and not surface.inside_out
    return surface


def test_one_sphere_on_the_plane() -> None:
    loads = standing(sole(np.array([[0.1, RADIUS - 1e-3, 0.02]])), law(1), LEVEL)
    expected = 5e4 * 1e-3**1.5
    np.testing.assert_allclose(loads.force[0, 0], [0.0, expected, 0.0], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(loads.point[0, 0], [0.1, 0.0, 0.02], atol=1e-15)
    assert loads.depth[0, 0] == pytest.approx(1e-3, abs=1e-15)


def test_a_sphere_that_does_not_touch_is_unloaded() -> None:
    loads = standing(sole(np.array([[0.0, RADIUS + 1e-9, 0.0], [0.0, RADIUS - 1e-9, 0.0]])), law(2, b=100.0), LEVEL)
    assert loads.pressing[0, 0] == 0.0 < loads.pressing[0, 1]
    assert np.isnan(loads.point[0, 0]).all() and not loads.force[0, 0].any()


def test_clearance_is_that_of_the_nearest_sphere_in_any_frame() -> None:
    """Lowest points at 40 and 30 mm; the foot is 10 mm higher in one frame and 10 mm lower in the other."""
    spheres = sole(np.array([[0.0, 0.05, 0.0], [0.2, 0.06, 0.0]]), np.array([0.01, 0.03]))
    poses, rate = still(*(RigidTransform.from_translation([0.0, y, 0.0]) for y in (0.01, -0.01)))
    loads = sphere_loads(spheres, law(2), poses, rate, LEVEL)
    assert clearance(spheres, loads, LEVEL) == pytest.approx(0.02, abs=1e-15)
    assert clearance(spheres, loads, HalfSpace((0.0, 0.025, 0.0))) == pytest.approx(-0.005, abs=1e-15)


def test_damping_acts_on_the_approach_of_the_centre_alone() -> None:
    """Turning about the sphere's centre presses no harder; sinking does, and rising no less."""
    spheres, numbers = sole(np.array([[0.1, RADIUS - 3e-3, 0.0]])), law(1, b=500.0)
    centre = spheres.centre[0]
    spin = np.array([3.0, 1.0, -2.0])
    rest = 5e4 * 3e-3**1.5
    for velocity, expected in (((0, -0.2, 0), rest + 100.0), ((0, 0.2, 0), rest), ((0.5, 0, 0.3), rest)):
        pose, rate = twist(RigidTransform.identity(), np.array(velocity) - np.cross(spin, centre), spin)
        loads = sphere_loads(spheres, numbers, pose, rate, LEVEL)
        assert loads.pressing[0, 0] == pytest.approx(expected, rel=1e-12)


def test_friction_opposes_the_sliding_of_the_lowest_point() -> None:
    spheres, numbers = sole(np.array([[0.0, RADIUS - 1e-3, 0.0]])), law(1, mu=0.6, v_th=0.1)
    pressing = 5e4 * 1e-3**1.5
    for speed, coefficient in ((0.05, 0.3), (0.1, 0.6), (0.125, 0.54), (0.15, 0.48), (2.0, 0.48)):
        direction = np.array([0.6, 0.0, -0.8])
        loads = sphere_loads(spheres, numbers, *twist(RigidTransform.identity(), speed * direction, np.zeros(3)), LEVEL)
        np.testing.assert_allclose(
            loads.force[0, 0], pressing * (np.array([0, 1, 0]) - coefficient * direction), rtol=1e-12, atol=1e-12
        )


def test_every_sphere_has_its_own_friction() -> None:
    """As zones have it whose soles differ."""
    spheres = sole(np.array([[0.0, RADIUS - 1e-3, 0.0], [0.2, RADIUS - 1e-3, 0.0]]), zone=("heel", "toe"))
    numbers = replace(law(2, mu=0.6), static=np.array([0.6, 0.9]), kinetic=np.array([0.5, 0.2]))
    loads = sphere_loads(spheres, numbers, *twist(RigidTransform.identity(), np.array([2.0, 0, 0]), np.zeros(3)), LEVEL)
    np.testing.assert_allclose(loads.force[0, :, 0], -5e4 * 1e-3**1.5 * np.array([0.5, 0.2]), rtol=1e-12)


def test_a_rolling_sphere_feels_no_friction() -> None:
    """Its lowest point, RADIUS below the centre, stands still while the centre moves on."""
    spheres, numbers = sole(np.array([[0.0, RADIUS - 1e-3, 0.0]])), law(1, mu=0.6)
    centre, turning = spheres.centre[0], np.array([0.0, 0.0, -10.0])
    velocity = np.array([10.0 * RADIUS, 0.0, 0.0]) - np.cross(turning, centre)
    loads = sphere_loads(spheres, numbers, *twist(RigidTransform.identity(), velocity, turning), LEVEL)
    np.testing.assert_allclose(loads.force[0, 0, [0, 2]], 0.0, atol=1e-12)


def sagittal(spheres: SphereSet, n: SoleLaw, pose: np.ndarray, rate: np.ndarray) -> tuple[float, float, float]:
    """Force along x and y and centre along x by the planar formulas of a foot in the sagittal plane."""
    (x, y, pitch), (vx, vy, turning) = pose, rate
    c, s = np.cos(pitch), np.sin(pitch)
    px, py = spheres.centre[:, 0], spheres.centre[:, 1]
    height, climb = y + s * px + c * py, vy + turning * (c * px - s * py)
    depth = spheres.radius - height
    u = np.clip(depth / n.full_depth, 0.0, 1.0)
    normal = n.stiffness * np.maximum(depth, 0.0) ** n.exponent + n.damping * np.maximum(-climb, 0.0) * u**2 * (
        3 - 2 * u
    )
    normal *= depth > 0.0
    speed = vx - turning * (height - spheres.radius - y)
    nodes = np.array([-3, -1.5, -1, 1, 1.5, 3]) * n.threshold_speed
    static, kinetic = n.static[0], n.kinetic[0]
    table = [-kinetic, -kinetic, -static, static, kinetic, kinetic]
    tangential = -np.interp(speed, nodes, table) * normal
    contact = x + c * px - s * py
    return tangential.sum(), normal.sum(), float((normal * contact).sum() / normal.sum())


@given(seeds)
def test_sagittal_motion_follows_the_planar_formulas(seed: int) -> None:
    rng = np.random.default_rng(seed)
    spheres = scattered(seed)
    numbers = law(len(spheres), b=300.0, mu=0.8, k=rng.uniform(2e4, 9e4, len(spheres)))
    pose = np.array([rng.uniform(-1, 1), rng.uniform(-3e-3, 0.0), rng.uniform(-0.02, 0.02)])
    rate = rng.normal(size=3) * [0.2, 0.1, 1.0]
    turn = Rotation.from_rotvec([0.0, 0.0, pose[2]])
    where = RigidTransform.from_components([pose[0], pose[1], 0.0], turn)
    moving = twist(where, np.array([rate[0], rate[1], 0.0]), np.array([0.0, 0.0, rate[2]]))
    loads = sphere_loads(spheres, numbers, *moving, LEVEL)
    if not loads.pressing.any():
        return
    along, up, centre = sagittal(spheres, numbers, pose, rate)
    total = loads.force[0].sum(axis=0)
    np.testing.assert_allclose(total[:2], [along, up], rtol=1e-9, atol=1e-9)
    touching = loads.pressing[0] > 0.0
    ours = (loads.pressing[0] * loads.point[0, :, 0])[touching].sum() / loads.pressing[0].sum()
    assert ours == pytest.approx(centre, abs=1e-11)


@given(seeds, rigid)
def test_turning_everything_turns_the_loads(seed: int, pose: RigidTransform) -> None:
    rng = np.random.default_rng(seed)
    spheres = scattered(seed)
    numbers = law(len(spheres), b=200.0, mu=0.7)
    _, rate = twist(RigidTransform.identity(), rng.normal(size=3) * 0.2, rng.normal(size=3))
    flat = sphere_loads(spheres, numbers, HERE, rate, LEVEL)
    up = pose.rotation.apply([0.0, 1.0, 0.0])
    tilted = HalfSpace(tuple(map(float, pose.translation)), tuple(map(float, up)))
    moved = RigidTransform.from_matrix(pose.as_matrix()[None])
    loads = sphere_loads(spheres, numbers, moved, pose.as_matrix() @ rate, tilted)
    np.testing.assert_allclose(loads.force[0], pose.rotation.apply(flat.force[0]), rtol=1e-8, atol=1e-7)
    touching = (flat.depth[0] > 1e-12) & (loads.depth[0] > 1e-12)
    np.testing.assert_allclose(loads.point[0][touching], pose.apply(flat.point[0][touching]), atol=1e-12)


def sheet() -> Sheet:
    """An open rectangle in y = 0 that looks up."""
    corners = np.array([[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]])
    return Sheet(Surface(corners, np.array([[0, 1, 2], [0, 2, 3]])))


@pytest.mark.parametrize("made", [lambda: Stairs((), (0.0,)), slab, sheet], ids=["stairs", "mesh", "sheet"])
def test_other_grounds_equal_the_half_space(made: Callable[[], Ground]) -> None:
    ground, numbers = made(), law(12, b=200.0, mu=0.7)
    _, rate = twist(RigidTransform.identity(), np.array([0.1, -0.05, 0.02]), np.array([0.3, 0.1, -0.2]))
    for seed in range(20):
        spheres = scattered(seed)
        plane = sphere_loads(spheres, numbers, HERE, rate, LEVEL)
        other = sphere_loads(spheres, numbers, HERE, rate, ground)
        np.testing.assert_allclose(other.force, plane.force, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(other.point, plane.point, atol=1e-12)


@pytest.mark.parametrize("kind", ["stairs", "mesh"])
def test_a_step_equals_two_planes(kind: str) -> None:
    """Heel on the floor, toes on a step: each sphere feels the tread that it stands on."""
    step, edge = 0.1, 0.15
    low = scattered(3, 20)
    centre = low.centre + np.where(low.centre[:, :1] > edge, [[0.0, step, 0.0]], 0.0)
    clear = (low.centre[:, 0] < edge - 0.03) | (low.centre[:, 0] > edge + 0.03)
    spheres = sole(centre[clear], low.radius[clear])
    ground: Ground = Stairs((edge,), (0.0, step))
    if kind == "mesh":
        profile = np.array([[-1, -1], [1, -1], [1, step], [edge, step], [edge, 0.0], [-1, 0.0]])
        ground = Surface(*prism(profile, -1.0, 1.0))
        assert ground.closed and not ground.inside_out
    numbers = law(len(spheres), b=100.0, mu=0.5)
    _, rate = twist(RigidTransform.identity(), np.array([0.1, -0.05, 0.02]), np.zeros(3))
    loads = sphere_loads(spheres, numbers, HERE, rate, ground)
    upper = spheres.centre[:, 0] > edge
    assert loads.pressing[0, upper].any() and loads.pressing[0, ~upper].any()
    for which, plane in ((~upper, LEVEL), (upper, HalfSpace((0.0, step, 0.0)))):
        part = sphere_loads(sole(spheres.centre[which], spheres.radius[which]),
                            law(int(which.sum()), b=100.0, mu=0.5), HERE, rate, plane)  # fmt: skip
        np.testing.assert_allclose(loads.force[0, which], part.force[0], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(loads.point[0, which], part.point[0], atol=1e-12)


def prism(profile: np.ndarray, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """The L of a step (counter-clockwise profile in x y) between two z: vertices and outward faces."""
    n = len(profile)
    vertices = np.vstack([np.column_stack([profile, np.full(n, z)]) for z in (low, high)])
    sides = [face for i in range(n) for face in ((i, (i + 1) % n, n + (i + 1) % n), (i, n + (i + 1) % n, n + i))]
    caps = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    top = [(n + a, n + b, n + c) for a, b, c in caps]
    return vertices, np.array([*sides, *top, *((a, c, b) for a, b, c in caps)])


def test_shipped_plate_is_a_ground() -> None:
    """The top of the sample plate carries spheres as the plane through it does."""
    plate = Surface.of(read_mesh(ROOT / "meshes" / "plate_80x80x12.stl", "mm"))
    top = plate.vertices.max(axis=0)
    middle = 0.5 * (plate.vertices.min(axis=0) + top)
    axis = int(np.argmin(plate.vertices.max(axis=0) - plate.vertices.min(axis=0)))
    up = np.eye(3)[axis]
    centre = np.array(
        [middle + (top[axis] - middle[axis] + 4e-3) * up + shift for shift in np.roll(np.eye(3), axis) * 5e-3]
    )
    spheres = sole(centre, 5e-3)
    plane = HalfSpace(tuple(map(float, top)), tuple(map(float, up)))
    ours, theirs = (standing(spheres, law(3), ground) for ground in (plate, plane))
    assert theirs.pressing.any()
    np.testing.assert_allclose(ours.force, theirs.force, rtol=1e-6, atol=1e-9)


@settings(max_examples=20)
@given(seeds)
def test_frames_do_not_know_of_each_other(seed: int) -> None:
    rng = np.random.default_rng(seed)
    spheres, numbers = scattered(seed), law(12, b=100.0, mu=0.5)
    poses = RigidTransform.from_components(
        rng.normal(size=(5, 3)) * [1, 1e-3, 1], Rotation.from_rotvec(rng.normal(size=(5, 3)) * 0.02)
    )
    rate = rng.normal(size=(5, 4, 4)) * 0.1
    together = sphere_loads(spheres, numbers, poses, rate, LEVEL)
    order = rng.permutation(5)
    shuffled = sphere_loads(spheres, numbers, poses[order], rate[order], LEVEL)
    np.testing.assert_array_equal(shuffled.force, together.force[order])


def test_a_buried_foot_is_refused() -> None:
    with pytest.raises(ValueError, match="sphere 2 is deeper under the ground than any radius in frame 1"):
        standing(sole(np.array([[0.0, 0.0, 0.0], [0.0, -2.0 * RADIUS, 0.0]])), law(2), LEVEL)


def test_zones_and_checks_of_the_sole() -> None:
    spheres = sole(np.zeros((3, 3)), zone=("heel", "toe", "heel"))
    assert {name: which.tolist() for name, which in spheres.zones.items()} == {
        "heel": [True, False, True],
        "toe": [False, True, False],
    }
    with pytest.raises(ValueError, match="positive radii"):
        sole(np.zeros((2, 3)), np.array([0.01, -0.01]))
    with pytest.raises(ValueError, match="3 spheres with 1 zones"):
        sole(np.zeros((3, 3)), zone=("heel",))
    with pytest.raises(ValueError, match="must be positive"):
        law(2, k=0.0)
    assert not law(2).needs_velocity and law(2, mu=0.1).needs_velocity
