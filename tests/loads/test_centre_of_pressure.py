"""Centre of pressure of a foot on spheres: closed forms to 1e-9 m, force-plate formulas, both points, invariances."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.centre_of_pressure import centre_of_pressure, path_length, points_in_foot
from geocontact.loads.ground import Stairs
from geocontact.loads.sphere_set import SphereLoads, sphere_loads
from tests.loads.scenes import RADIUS, law, rigid, scattered, sole, standing, still, twist

LEVEL = HalfSpace()
HERE = still()[0]
UP = np.array([0.0, 1.0, 0.0])
seeds = st.integers(0, 2**31)


def sliding(seed: int) -> SphereLoads:
    """A foot that slides, turns and sinks on y = 0."""
    rng = np.random.default_rng(seed)
    spheres = scattered(seed)
    numbers = law(len(spheres), b=300.0, mu=0.8, k=rng.uniform(2e4, 9e4, len(spheres)))
    _, rate = twist(RigidTransform.identity(), rng.normal(size=3) * 0.3, rng.normal(size=3))
    return sphere_loads(spheres, numbers, HERE, rate, LEVEL)


def test_symmetric_grid_has_its_centre_in_the_middle() -> None:
    x, z = np.meshgrid(np.linspace(-0.1, 0.1, 5) + 0.3, np.linspace(-0.04, 0.04, 3) - 0.2)
    spheres = sole(np.column_stack([x.ravel(), np.full(15, RADIUS - 2e-3), z.ravel()]))
    c = centre_of_pressure(standing(spheres, law(15), LEVEL))
    np.testing.assert_allclose(c.centre[0], [0.3, 0.0, -0.2], atol=1e-12)
    assert c.pressing[0] == pytest.approx(15 * 5e4 * 2e-3**1.5, rel=1e-12)
    assert c.free_moment[0] == 0.0


@pytest.mark.parametrize(("deep", "shallow"), [(2e-3, 1e-3), (4e-3, 1e-6), (1e-3, 1e-3)])
def test_two_spheres_share_by_their_depths(deep: float, shallow: float) -> None:
    spheres = sole(np.array([[0.0, RADIUS - deep, 0.01], [0.2, RADIUS - shallow, 0.05]]))
    share = shallow**1.5 / (deep**1.5 + shallow**1.5)
    c = centre_of_pressure(standing(spheres, law(2), LEVEL))
    np.testing.assert_allclose(c.centre[0], [0.2 * share, 0.0, 0.01 + 0.04 * share], atol=1e-9)


def test_zones_of_different_stiffness_draw_the_centre() -> None:
    spheres = sole(np.array([[0.0, RADIUS - 1e-3, 0.0], [0.2, RADIUS - 1e-3, 0.0]]), zone=("heel", "toe"))
    c = centre_of_pressure(standing(spheres, law(2, k=np.array([3e4, 9e4])), LEVEL))
    np.testing.assert_allclose(c.centre[0], [0.15, 0.0, 0.0], atol=1e-12)


@given(seeds)
def test_a_force_plate_would_show_the_same(seed: int) -> None:
    """The centre by the plate's formulas from force and moment alone equals the weighted centre of ground points."""
    loads = sliding(seed)
    c = centre_of_pressure(loads)
    if not c.pressing[0] > 1.0:
        return
    np.testing.assert_allclose(c.wrench.centre_of_pressure(np.zeros(3), UP), c.centre, atol=1e-9)
    # plate axes: x = z of the ground, y = x, z = y; its sensor lies 60 mm under the surface
    sensor = np.array([0.05, -0.06, 0.02])
    turn = Rotation.from_matrix(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))
    plate = c.wrench.moved_to(sensor).seen_from(RigidTransform.from_components(-turn.apply(sensor), turn), "plate")
    (fx, fy, fz), (mx, my, mz), oz = plate.force[0], plate.moment[0], 0.06
    x, y = (oz * fx - my) / fz, (mx + oz * fy) / fz
    np.testing.assert_allclose([y + sensor[0], x + sensor[2]], c.centre[0, [0, 2]], atol=1e-9)
    assert mz - (x * fy - y * fx) == pytest.approx(c.free_moment[0], abs=1e-8)


@given(seeds)
def test_on_level_ground_both_points_have_the_same_centre_but_for_the_height(seed: int) -> None:
    loads = sliding(seed)
    ground, sphere = (centre_of_pressure(loads, point) for point in ("ground", "sphere"))
    np.testing.assert_allclose(sphere.centre[:, [0, 2]], ground.centre[:, [0, 2]], atol=1e-12)
    np.testing.assert_allclose(sphere.free_moment, ground.free_moment, atol=1e-9)
    loaded = np.isfinite(ground.centre[:, 0])
    weights = loads.pressing[loaded] / loads.pressing[loaded].sum(axis=1, keepdims=True)
    heights = (weights * loads.centre[loaded, :, 1]).sum(axis=1)
    np.testing.assert_allclose(sphere.centre[loaded, 1], heights, atol=1e-12)


def test_on_a_slope_the_points_differ_by_the_sine() -> None:
    tilt = 0.3
    normal = (-float(np.sin(tilt)), float(np.cos(tilt)), 0.0)
    spheres = sole((RADIUS - 1e-3) * np.array([normal]))
    loads = standing(spheres, law(1), HalfSpace((0.0, 0.0, 0.0), normal))
    ground, sphere = (centre_of_pressure(loads, point).centre[0] for point in ("ground", "sphere"))
    np.testing.assert_allclose(ground, 0.0, atol=1e-15)
    np.testing.assert_allclose(sphere[0], -np.sin(tilt) * (RADIUS - 1e-3), atol=1e-15)


@given(seeds, rigid)
def test_tilted_ground_equals_the_flat_after_turning_everything(seed: int, pose: RigidTransform) -> None:
    rng = np.random.default_rng(seed)
    spheres, numbers = scattered(seed), law(12, b=300.0, mu=0.8)
    _, rate = twist(RigidTransform.identity(), rng.normal(size=3) * 0.3, rng.normal(size=3))
    flat = sphere_loads(spheres, numbers, HERE, rate, LEVEL)
    up = tuple(map(float, pose.rotation.apply(UP)))
    tilted = HalfSpace(tuple(map(float, pose.translation)), up)
    turned = sphere_loads(
        spheres, numbers, RigidTransform.from_matrix(pose.as_matrix()[None]), pose.as_matrix() @ rate, tilted
    )
    for point in ("ground", "sphere"):
        ours, theirs = centre_of_pressure(turned, point, 1.0), centre_of_pressure(flat, point, 1.0)
        if np.isfinite(theirs.centre).all():
            np.testing.assert_allclose(ours.centre[0], pose.apply(theirs.centre[0]), atol=1e-9)
            np.testing.assert_allclose(ours.normal[0], up, atol=1e-12)
            assert ours.free_moment[0] == pytest.approx(theirs.free_moment[0], abs=1e-7)


@pytest.mark.parametrize("turning", [0.2, -0.2, 4.0])
def test_free_moment_of_a_foot_that_spins_on_the_spot(turning: float) -> None:
    """Spheres on a circle of radius a: moment = -m(a |turning|) a times the normal force, against the turning."""
    a, mu, v_th, angle = 0.06, 0.8, 0.05, np.linspace(0.0, 2.0 * np.pi, 9)[:-1]
    middle = np.array([0.1, RADIUS - 2e-3, -0.3])
    spheres = sole(middle + a * np.column_stack([np.cos(angle), 0.0 * angle, np.sin(angle)]))
    turn = turning * UP
    moving = twist(RigidTransform.identity(), -np.cross(turn, middle), turn)
    c = centre_of_pressure(sphere_loads(spheres, law(8, mu=mu, v_th=v_th), *moving, LEVEL))
    nodes, table = np.array([0.0, 1.0, 1.5]) * v_th, [0.0, mu, 0.8 * mu]
    expected = -np.sign(turning) * np.interp(a * abs(turning), nodes, table) * a * 8 * 5e4 * 2e-3**1.5
    assert c.free_moment[0] == pytest.approx(expected, rel=1e-12)
    np.testing.assert_allclose(c.centre[0], middle * [1, 0, 1], atol=1e-12)
    np.testing.assert_allclose(c.wrench.force[0, [0, 2]], 0.0, atol=1e-10)


def test_centre_on_a_step_lies_between_the_treads() -> None:
    spheres = sole(np.array([[0.0, RADIUS - 1e-3, 0.0], [0.3, RADIUS + 0.1 - 1e-3, 0.0]]))
    c = centre_of_pressure(standing(spheres, law(2), Stairs((0.15,), (0.0, 0.1))))
    np.testing.assert_allclose(c.centre[0], [0.15, 0.05, 0.0], atol=1e-12)
    np.testing.assert_allclose(c.normal[0], UP, atol=1e-12)


@given(seeds)
def test_order_of_the_spheres_does_not_matter(seed: int) -> None:
    spheres = scattered(seed)
    order = np.random.default_rng(seed).permutation(12)
    ours = centre_of_pressure(standing(spheres, law(12), LEVEL))
    theirs = centre_of_pressure(standing(sole(spheres.centre[order], spheres.radius[order]), law(12), LEVEL))
    np.testing.assert_allclose(theirs.centre, ours.centre, atol=1e-12)


def test_gate_leaves_the_force_and_takes_the_centre() -> None:
    spheres = sole(np.array([[0.0, RADIUS - 1e-3, 0.0]]))
    loads = standing(spheres, law(1), LEVEL)
    force = 5e4 * 1e-3**1.5
    for gate, there in ((0.0, True), (force * 0.999, True), (force * 1.001, False)):
        c = centre_of_pressure(loads, gate=gate)
        assert np.isfinite(c.centre).all() == np.isfinite(c.free_moment).all() == there
        assert c.wrench.force[0, 1] == pytest.approx(force)
    away = standing(sole(np.array([[0.0, 2.0 * RADIUS, 0.0]])), law(1), LEVEL)
    assert np.isnan(centre_of_pressure(away).centre).all(), "no force, no centre, even without a gate"


def test_points_have_names() -> None:
    with pytest.raises(ValueError, match="point must be ground or sphere, not 'toe'"):
        centre_of_pressure(standing(scattered(0), law(12), LEVEL), "toe")


def test_points_in_the_foot() -> None:
    """A quarter turn about z takes the foot's x to the ground's y: 0.1 m ahead in it is 0.1 m above its origin."""
    turn = Rotation.from_rotvec(np.radians([[0.0, 0.0, 0.0], [0.0, 0.0, 90.0], [0.0, 0.0, 90.0]]))
    poses = RigidTransform.from_components([[1.0, 2.0, 3.0]] * 3, turn)
    points = np.array([[1.1, 2.0, 3.0], [1.0, 2.1, 3.0], [np.nan] * 3])
    inside = points_in_foot(points, poses)
    np.testing.assert_allclose(inside, [[0.1, 0.0, 0.0], [0.1, 0.0, 0.0], [np.nan] * 3], atol=1e-15)


def test_a_path_has_no_length_across_frames_without_a_centre() -> None:
    centre = np.array([[0.0, 0.0, 0.0], [0.03, 0.0, 0.04], [np.nan] * 3, [1.0, 0.0, 0.0], [1.0, 0.0, 0.01]])
    assert path_length(centre) == pytest.approx(0.05 + 0.01, rel=1e-12)
    assert path_length(np.full((4, 3), np.nan)) == 0.0
