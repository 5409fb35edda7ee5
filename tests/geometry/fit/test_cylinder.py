"""The fitted cylinder: exact ones found again, noise as the linear theory has it, outliers, partial arcs."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.geometry.fit.cylinder import fit_cylinder
from tests.geometry.fit.clouds import RADIUS, SHIFT, TURN, misfit, noisy, points, spoilt, wall


@pytest.mark.parametrize("robust", [True, False])
@pytest.mark.parametrize("arc", [360, 120, 60])
@pytest.mark.parametrize(("radius", "length"), [(0.03, 0.04), (0.02, 0.15), (0.05, 0.01), (2.0, 3.0)])
def test_exact_cylinder_is_found_again(arc, radius, length, robust):
    """Whatever its place, size and slenderness; a ring as well as a rod."""
    fit = fit_cylinder(points(*wall(arc, 200, length), radius), robust)
    assert fit.radius == pytest.approx(radius, rel=1e-8)
    assert fit.rms < 1e-9 * radius
    assert misfit(fit) == pytest.approx((0.0, 0.0), abs=1e-7 * radius)
    assert np.degrees(fit.arc) == pytest.approx(arc, rel=0.06) and fit.quality.inlier.all()


@pytest.mark.parametrize("axis", [*np.eye(3), *(np.ones((3, 3)) - 2 * np.eye(3)), (1.0, 1.0, 1.0), (0.01, 1.0, 0.0)])
def test_every_direction_is_found(axis):
    """No direction is a blind spot of the starts; a rod twice as thick as long has its smallest extent along it."""
    turn = Rotation.align_vectors([axis], [[0.0, 0.0, 1.0]])[0]
    fit = fit_cylinder(points(*wall(200, 200, length=0.03), turn=turn))
    assert fit.radius == pytest.approx(RADIUS, rel=1e-8)
    assert misfit(fit, turn) == pytest.approx((0.0, 0.0), abs=1e-8)
    assert fit.axis[np.argmax(np.abs(fit.axis))] > 0.0


@pytest.mark.parametrize("arc", [360, 120, 60])
def test_small_noise_moves_plain_squares_as_linear_theory_does(arc):
    """Distance to the wall, to first order: a cos + b sin + h (p cos + q sin) + dR, with centre (a, b), tilt (p, q)."""
    angle, height = wall(arc, 300)
    noise = 1e-5 * np.random.default_rng(1).normal(size=300)
    fit = fit_cylinder(points(angle, height, RADIUS + noise), robust=False)
    c, s = np.cos(angle), np.sin(angle)
    jacobian = np.column_stack([c, s, height * c, height * s, np.ones(300)])
    expected = np.linalg.lstsq(jacobian, noise, rcond=None)[0]
    error = 1e-5 * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))  # standard errors
    direction, middle = TURN.inv().apply(fit.axis), TURN.inv().apply(fit.point - SHIFT)
    tilt = direction[:2] / direction[2]
    found = np.array([*(middle[:2] - middle[2] * tilt), *tilt, fit.radius - RADIUS])
    assert np.abs((found - expected) / error).max() < 0.02
    assert fit.rms == pytest.approx(np.sqrt(np.mean((noise - jacobian @ expected) ** 2)), rel=1e-3)
    assert fit.quality.half_widths[-1] == pytest.approx(1.96 * error[-1], rel=0.5)


@pytest.mark.parametrize(("arc", "limit"), [(360, 5e-6), (120, 2e-5), (60, 1.5e-4)])
@pytest.mark.parametrize("kind", ["anywhere", "inside", "another face"])
def test_a_fifth_of_outliers_does_not_matter(arc, limit, kind):
    """R = 37 mm, noise 0.1 mm, 20,000 points: 0.02 mm on 120 degrees. Plain least squares is off by 0.2 to 20 mm."""
    for seed in range(2):
        cloud = spoilt(arc, 20_000, seed, kind)
        fit = fit_cylinder(cloud)
        assert abs(fit.radius - RADIUS) < limit
        assert misfit(fit)[0] < np.radians(0.1) and misfit(fit)[1] < 1.5 * limit + 1e-5
        assert fit.quality.inlier.mean() == pytest.approx(0.81, abs=0.02)
        assert fit.quality.noise == pytest.approx(1.3e-4, rel=0.1), "the median knows nothing of a fifth of outliers"
        assert abs(fit_cylinder(cloud, robust=False).radius - RADIUS) > 5.0 * limit


def test_two_walls_have_the_radius_between_them():
    """Every point at R - d and at R + d: the radius is R and the root mean square distance d."""
    angle, height = (np.tile(value, 2) for value in wall(360, 300))
    fit = fit_cylinder(points(angle, height, RADIUS + np.repeat([-3e-4, 3e-4], 300)))
    assert fit.radius == pytest.approx(RADIUS, abs=1e-7)
    assert (fit.rms, fit.mean_abs, fit.max_abs) == pytest.approx((3e-4, 3e-4, 3e-4), rel=1e-3)


def test_the_fit_moves_and_grows_with_the_points():
    angle, height = wall(150, 300)
    rough = RADIUS + 1e-3 * np.sin(7 * angle)
    here, there = points(angle, height, rough, Rotation.identity(), np.zeros(3)), points(angle, height, rough)
    one, other, grown = fit_cylinder(here), fit_cylinder(there), fit_cylinder(10.0 * here)
    assert (other.radius, other.rms) == pytest.approx((one.radius, one.rms), rel=1e-5)
    assert (grown.radius, grown.rms) == pytest.approx((10 * one.radius, 10 * one.rms), rel=1e-9)
    assert grown.quality.half_widths[-1] == pytest.approx(10 * one.quality.half_widths[-1], rel=1e-6)
    assert np.linalg.norm(np.cross(TURN.apply(one.axis), other.axis)) < 1e-4
    assert np.linalg.norm(np.cross(TURN.apply(one.point) + SHIFT - other.point, other.axis)) < 1e-6


def test_the_same_points_give_the_same_fit_and_the_distance_its_residuals():
    cloud = noisy(120, 20_000, 3)
    fit, again = fit_cylinder(cloud), fit_cylinder(cloud)
    assert (fit.radius, fit.rms) == (again.radius, again.rms)
    assert np.array_equal(fit.axis, again.axis) and np.array_equal(fit.point, again.point)
    np.testing.assert_allclose(fit.distance(cloud), fit.quality.residual, atol=1e-12)
    assert fit.line.point == pytest.approx(fit.point)


def test_too_few_points_and_points_that_are_none_are_refused():
    cloud = points(*wall(360, 6))
    assert fit_cylinder(cloud).rms < 1e-3
    with pytest.raises(ValueError, match="at least 6 points, not 5"):
        fit_cylinder(cloud[:5])
    with pytest.raises(ValueError, match="must be finite"):
        fit_cylinder(np.vstack([cloud, [np.nan, 0, 0]]))
    with pytest.raises(ValueError, match="are the same"):
        fit_cylinder(np.ones((9, 3)))
