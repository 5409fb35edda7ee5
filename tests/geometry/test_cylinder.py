"""The fitted cylinder: exact ones found again, noise as the linear theory has it, outliers, partial arcs."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.geometry import cylinder
from geocontact.geometry.cylinder import fit_cylinder

TURN, SHIFT = Rotation.from_rotvec([0.3, -1.1, 0.7]), np.array([0.1, -0.4, 0.25])
RADIUS, LENGTH, NOISE = 0.03, 0.04, 1e-4


def wall(arc, count=1000, radius=RADIUS, length=LENGTH, seed=0):
    """Angle [rad] and height of points on a part of a cylinder's wall."""
    rng = np.random.default_rng(seed)
    return np.radians(rng.uniform(-arc / 2, arc / 2, count)), rng.uniform(-length / 2, length / 2, count)


def points(angle, height, radius=RADIUS, turn=TURN, shift=SHIFT):
    """Points about the turned and shifted z axis; radius one number or one per point."""
    return turn.apply(np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])) + shift


def misfit(fit, turn=TURN, shift=SHIFT):
    """Angle [rad] of the fitted axis to the true one, and its distance from the true middle [m]."""
    assert np.linalg.norm(fit.direction) == pytest.approx(1.0, abs=1e-12)
    angle = np.linalg.norm(np.cross(fit.direction, turn.apply([0.0, 0.0, 1.0])))
    return angle, np.linalg.norm(np.cross(shift - fit.point, fit.direction))


@pytest.mark.parametrize("arc", [360, 120, 60])
@pytest.mark.parametrize(("radius", "length"), [(0.03, 0.04), (0.02, 0.15), (0.05, 0.01), (2.0, 3.0)])
def test_exact_cylinder_is_found_again(arc, radius, length):
    """Whatever its place, size and slenderness; a ring as well as a rod."""
    angle, height = wall(arc, 200, radius, length)
    fit = fit_cylinder(points(angle, height, radius))
    assert fit.radius == pytest.approx(radius, rel=1e-8)
    assert fit.rms < 1e-9 * radius
    assert misfit(fit) == pytest.approx((0.0, 0.0), abs=1e-7 * radius)


@pytest.mark.parametrize("axis", [*np.eye(3), *(np.ones((3, 3)) - 2 * np.eye(3)), (1.0, 1.0, 1.0), (0.01, 1.0, 0.0)])
def test_every_direction_is_found(axis):
    """No direction is a blind spot of the starts; a rod twice as thick as long has its smallest extent along it."""
    turn = Rotation.align_vectors([axis], [[0.0, 0.0, 1.0]])[0]
    fit = fit_cylinder(points(*wall(200, 200, length=0.03), turn=turn))
    assert fit.radius == pytest.approx(RADIUS, rel=1e-8)
    assert misfit(fit, turn) == pytest.approx((0.0, 0.0), abs=1e-8)


@pytest.mark.parametrize("arc", [360, 120, 60])
def test_small_noise_moves_the_fit_as_linear_least_squares_does(arc):
    """Distance to the wall, to first order: a cos + b sin + h (p cos + q sin) + dR, with centre (a, b), tilt (p, q).

    Noise of 10 um is small against the loss scale; what it costs grows as the arc gets flatter.
    """
    angle, height = wall(arc, 300)
    noise = 1e-5 * np.random.default_rng(1).normal(size=300)
    fit = fit_cylinder(points(angle, height, RADIUS + noise))
    c, s = np.cos(angle), np.sin(angle)
    jacobian = np.column_stack([c, s, height * c, height * s, np.ones(300)])
    expected = np.linalg.lstsq(jacobian, noise, rcond=None)[0]
    error = 1e-5 * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))  # standard errors
    direction, middle = TURN.inv().apply(fit.direction), TURN.inv().apply(fit.point - SHIFT)
    tilt = direction[:2] / direction[2]
    found = np.array([*(middle[:2] - middle[2] * tilt), *tilt, fit.radius - RADIUS])
    assert np.abs((found - expected) / error).max() < 0.02
    assert fit.rms == pytest.approx(np.sqrt(np.mean((noise - jacobian @ expected) ** 2)), rel=1e-3)


@pytest.mark.parametrize(("arc", "radius", "degrees"), [(360, 4e-5, 0.2), (120, 1e-4, 0.2), (60, 5e-4, 0.3)])
def test_a_fifth_of_outliers_does_not_matter(arc, radius, degrees):
    """Points up to 18 mm off the wall; a plain least-squares radius would be off by tenths of a millimetre and more."""
    for seed in range(2):
        angle, height = wall(arc, 500, seed=seed)
        cloud = points(angle, height, RADIUS + NOISE * np.random.default_rng(seed).normal(size=500))
        cloud[:100] += np.random.default_rng(seed).uniform(-0.6 * RADIUS, 0.6 * RADIUS, (100, 3))
        fit = fit_cylinder(cloud)
        assert abs(fit.radius - RADIUS) < radius
        assert misfit(fit)[0] < np.radians(degrees) and misfit(fit)[1] < 1.2 * radius


def test_two_walls_have_the_radius_between_them():
    """Every point at R - d and at R + d: the radius is R and the root mean square distance d."""
    angle, height = (np.tile(value, 2) for value in wall(360, 300))
    fit = fit_cylinder(points(angle, height, RADIUS + np.repeat([-3e-4, 3e-4], 300)))
    assert fit.radius == pytest.approx(RADIUS, abs=1e-7)
    assert fit.rms == pytest.approx(3e-4, rel=1e-3)


def test_the_fit_moves_and_grows_with_the_points():
    angle, height = wall(150, 300)
    rough = RADIUS + 1e-3 * np.sin(7 * angle)
    here, there = points(angle, height, rough, Rotation.identity(), np.zeros(3)), points(angle, height, rough)
    one, other = fit_cylinder(here), fit_cylinder(there)
    grown = fit_cylinder(10.0 * here, loss_scale=5e-3)
    assert (other.radius, other.rms) == pytest.approx((one.radius, one.rms), rel=1e-5)
    assert (grown.radius, grown.rms) == pytest.approx((10 * one.radius, 10 * one.rms), rel=1e-9)
    assert np.linalg.norm(np.cross(TURN.apply(one.direction), other.direction)) < 1e-4
    assert np.linalg.norm(np.cross(TURN.apply(one.point) + SHIFT - other.point, other.direction)) < 1e-6


def test_of_many_points_some_are_enough_and_always_the_same(monkeypatch):
    monkeypatch.setattr(cylinder, "STARTS", 6)
    angle, height = wall(120, 20_000)
    cloud = points(angle, height, RADIUS + NOISE * np.random.default_rng(3).normal(size=20_000))
    fit, again = fit_cylinder(cloud), fit_cylinder(cloud)
    assert (fit.radius, fit.rms) == (again.radius, again.rms)
    assert np.array_equal(fit.direction, again.direction) and np.array_equal(fit.point, again.point)
    assert fit.radius == pytest.approx(RADIUS, abs=3e-5)


def test_too_few_points_are_refused():
    cloud = points(*wall(360, 6))
    assert fit_cylinder(cloud).rms < 1e-3
    with pytest.raises(ValueError, match="at least 6 points, not 5"):
        fit_cylinder(cloud[:5])
