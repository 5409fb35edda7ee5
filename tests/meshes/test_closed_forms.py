"""Each closed form against brute force: points spread evenly over one body, signed distance to the other one."""

import numpy as np
import pytest

from tests import closed_forms as exact

SAMPLES = 2**19
"""Points of the additive sequence with the plastic number's powers: even in two dimensions, aligned with nothing."""
PLASTIC = 1.32471795724474602596


def patch(first, second):
    """Points of a rectangle of two parameters and the size that each stands for."""
    k = np.arange(SAMPLES) + 0.5
    a, b = (low + (high - low) * ((k / PLASTIC**power) % 1.0) for power, (low, high) in ((1, first), (2, second)))
    return a, b, (first[1] - first[0]) * (second[1] - second[0]) / SAMPLES


def sphere_points(radius, centre):
    """Points and weights; the bands between heights of a sphere have equal areas."""
    y, turn, cell = patch((-1, 1), (0, 2 * np.pi))
    flat = np.sqrt(1 - y**2)
    unit = np.column_stack([flat * np.cos(turn), y, flat * np.sin(turn)])
    return centre + radius * unit, np.full(len(y), radius**2 * cell)


def plane_points(half):
    x, z, cell = patch((-half, half), (-half, half))
    return np.column_stack([x, np.zeros_like(x), z]), np.full(len(x), cell)


def cylinder_points(radius, length, centre):
    turn, z, cell = patch((0, 2 * np.pi), (-length / 2, length / 2))
    mantle = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), z])
    turn, square, disc_cell = patch((0, 2 * np.pi), (0, 1))
    out = radius * np.sqrt(square)
    caps = [
        np.column_stack([out * np.cos(turn), out * np.sin(turn), np.full(len(out), side)])
        for side in (length / 2, -length / 2)
    ]
    weights = [np.full(len(mantle), radius * cell), *[np.full(len(out), radius**2 / 2 * disc_cell)] * 2]
    return centre + np.vstack([mantle, *caps]), np.concatenate(weights)


def torus_points(ring, tube):
    """Torus about the y axis, centred at the origin."""
    turn, phi, cell = patch((0, 2 * np.pi), (0, 2 * np.pi))
    out = ring + tube * np.cos(phi)
    return np.column_stack([out * np.cos(turn), tube * np.sin(phi), out * np.sin(turn)]), tube * out * cell


def to_half_space(points):
    return points[:, 1]


def to_sphere(points, radius, centre):
    return np.linalg.norm(points - centre, axis=1) - radius


def to_cylinder(points, radius, length, centre):
    away = points - centre
    across, along = np.hypot(away[:, 0], away[:, 1]) - radius, np.abs(away[:, 2]) - length / 2
    return np.minimum(np.maximum(across, along), 0) + np.hypot(np.maximum(across, 0), np.maximum(along, 0))


def to_torus(points, ring, tube):
    return np.hypot(np.hypot(points[:, 0], points[:, 2]) - ring, points[:, 1]) - tube


def wheel(points):
    """Stand a torus about the y axis up, its axis along z."""
    return points[:, [0, 2, 1]] * [1, 1, -1]


def area(points_and_weights, distance, threshold):
    points, weights = points_and_weights
    return float(weights[distance(points) <= threshold].sum())


CASES = [(gap, threshold) for gap in (-0.8, -0.1, 0.0, 0.3) for threshold in (0.0, 0.1, 1.0, 4.0)]
R, L = 20.0, 30.0
RING, TUBE = 25.0, 8.0


def close(brute, formula, sampled):
    """Within 0.1 %, or within 7e-5 of the area that the samples were spread over."""
    assert brute == pytest.approx(formula, rel=1e-3, abs=7e-5 * sampled)


@pytest.mark.parametrize(("gap", "threshold"), CASES)
def test_sphere_and_plane(gap, threshold):
    centre = np.array([0, R + gap, 0])
    brute = area(sphere_points(R, centre), to_half_space, threshold)
    close(brute, exact.sphere_plane_on_sphere(R, gap, threshold), 5000)
    brute = area(plane_points(15), lambda p: to_sphere(p, R, centre), threshold)
    close(brute, exact.sphere_plane_on_plane(R, gap, threshold), 900)


@pytest.mark.parametrize(("gap", "threshold"), CASES)
def test_cylinder_and_plane(gap, threshold):
    centre = np.array([0, R + gap, 0])
    brute = area(cylinder_points(R, L, centre), to_half_space, threshold)
    close(brute, exact.cylinder_plane_on_cylinder(R, L, gap, threshold), 7000)
    brute = area(plane_points(22), lambda p: to_cylinder(p, R, L, centre), threshold)
    close(brute, exact.cylinder_plane_on_plane(R, L, gap, threshold), 7000)


@pytest.mark.parametrize(("gap", "threshold"), CASES)
def test_long_cylinder_is_the_limit_of_the_finite_one(gap, threshold):
    growth = [
        f(R, 2e6, gap, threshold) - f(R, 1e6, gap, threshold)
        for f in (exact.cylinder_plane_on_cylinder, exact.cylinder_plane_on_plane)
    ]
    per_length = [
        f(R, gap, threshold)
        for f in (exact.cylinder_plane_on_cylinder_per_length, exact.cylinder_plane_on_plane_per_length)
    ]
    assert np.array(growth) / 1e6 == pytest.approx(per_length, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("gap", "threshold"), CASES)
def test_two_spheres(gap, threshold):
    other = np.array([0, -(R + 12.0 + gap), 0])
    brute = area(sphere_points(R, np.zeros(3)), lambda p: to_sphere(p, 12.0, other), threshold)
    close(brute, exact.sphere_sphere_on_first(R, 12.0, gap, threshold), 5000)


@pytest.mark.parametrize("offset", [0.4, 0.9, 1.0, 1.3])
@pytest.mark.parametrize("threshold", [0.0, 0.1, 0.5, 0.9])
def test_sphere_in_cup(offset, threshold):
    cavity, centre = R + 1.0, np.array([0, -offset, 0])
    assert exact.sphere_cup_gap(R, cavity, offset) == pytest.approx(1.0 - offset)
    brute = area(sphere_points(R, centre), lambda p: -to_sphere(p, cavity, np.zeros(3)), threshold)
    close(brute, exact.sphere_cup_on_sphere(R, cavity, offset, threshold), 8000)
    brute = area(sphere_points(cavity, np.zeros(3)), lambda p: to_sphere(p, R, centre), threshold)
    close(brute, exact.sphere_cup_on_cup(R, cavity, offset, threshold), 8000)


@pytest.mark.parametrize(("gap", "threshold"), CASES)
def test_flat_torus_and_plane(gap, threshold):
    lift = np.array([0, TUBE + gap, 0])
    points, weights = torus_points(RING, TUBE)
    brute = area((points + lift, weights), to_half_space, threshold)
    close(brute, exact.flat_torus_plane_on_torus(RING, TUBE, gap, threshold), 8000)
    brute = area(plane_points(36), lambda p: to_torus(p - lift, RING, TUBE), threshold)
    close(brute, exact.flat_torus_plane_on_plane(RING, TUBE, gap, threshold), 8000)


@pytest.mark.parametrize(("gap", "threshold"), CASES)
def test_upright_torus_and_plane(gap, threshold):
    lift = np.array([0, RING + TUBE + gap, 0])
    points, weights = torus_points(RING, TUBE)
    brute = area((wheel(points) + lift, weights), to_half_space, threshold)
    close(brute, exact.upright_torus_plane_on_torus(RING, TUBE, gap, threshold), 5000)
    brute = area(plane_points(22), lambda p: to_torus(wheel(p - lift), RING, TUBE), threshold)
    close(brute, exact.upright_torus_plane_on_plane(RING, TUBE, gap, threshold), 5000)


def test_a_thin_ring_closes_its_hole():
    covered = exact.flat_torus_plane_on_plane(3.0, 8.0, 0.0, 4.0)
    lift = np.array([0, 8.0, 0])
    close(area(plane_points(13), lambda p: to_torus(p - lift, 3.0, 8.0), 4.0), covered, 700)


def test_whole_bodies_within_reach_have_their_whole_area():
    assert exact.sphere_plane_on_sphere(R, 0, 100) == pytest.approx(4 * np.pi * R**2, rel=1e-14)
    assert exact.cylinder_plane_on_cylinder(R, L, 0, 100) == pytest.approx(2 * np.pi * R * (L + R), rel=1e-14)
    assert exact.flat_torus_plane_on_torus(RING, TUBE, 0, 100) == pytest.approx(4 * np.pi**2 * RING * TUBE, rel=1e-14)
    assert exact.sphere_sphere_on_first(R, 12.0, 0, 100) == pytest.approx(4 * np.pi * R**2, rel=1e-14)


def test_quadratures_do_not_depend_on_their_nodes(monkeypatch):
    forms = [
        lambda: exact.upright_torus_plane_on_torus(RING, TUBE, -0.1, 4.0),
        lambda: exact.upright_torus_plane_on_plane(RING, TUBE, -0.1, 4.0),
        lambda: exact.cylinder_plane_on_plane(R, L, -0.1, 4.0),
    ]
    fine = [f() for f in forms]
    nodes, weights = np.polynomial.legendre.leggauss(90)
    monkeypatch.setattr(exact, "NODES", nodes)
    monkeypatch.setattr(exact, "WEIGHTS", weights)
    assert [f() for f in forms] == pytest.approx(fine, rel=1e-12)


def test_a_wheel_without_a_ring_is_a_sphere():
    """With R -> 0 the outer half of the tube becomes a sphere, and only that half reaches below H > 0."""
    wheel_area = exact.upright_torus_plane_on_torus(1e-9, TUBE, 0.5, 4.0)
    assert wheel_area == pytest.approx(exact.sphere_plane_on_sphere(TUBE, 0.5, 4.0), rel=1e-7)
