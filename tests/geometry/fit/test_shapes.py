"""Every shape of the catalogue: exact Jacobians, exact shapes found again, outliers, rigid motion; the closed forms."""

import numpy as np
import pytest

from geocontact.geometry.fit.catalogue import SHAPES
from geocontact.geometry.fit.circle import CircleModel, fit_circle, fit_cylinder_along
from geocontact.geometry.fit.cylinder import CylinderModel
from geocontact.geometry.fit.plane import PlaneModel
from geocontact.geometry.fit.solver import across, biweight
from geocontact.geometry.fit.sphere import SphereModel
from tests.geometry.fit.clouds import RADIUS, SHIFT, TURN, points, wall

FRAME = across(np.array([0.2, -0.5, 0.84]))
MODELS = [
    CylinderModel(FRAME, np.array([0.1, -0.2, 0.05, 0.03, 0.8])),
    SphereModel(np.array([0.1, -0.2, 0.05, 0.8])),
    PlaneModel(FRAME, np.array([0.1, -0.2, 0.05])),
    CircleModel(np.array([0.1, -0.2, 0.8])),
]


def cloud_of(shape, count, seed, noise=0.0):
    """Points on a part of the shape, about the turned and shifted origin."""
    rng = np.random.default_rng(seed)
    off = noise * rng.normal(size=count)
    if shape == "cylinder":
        return points(*wall(120, count, seed=seed), RADIUS + off)
    if shape == "sphere":
        way = rng.normal(size=(count, 3))
        way[:, 2] = np.abs(way[:, 2])
        way /= np.linalg.norm(way, axis=1, keepdims=True)
        return TURN.apply((RADIUS + off)[:, None] * way) + SHIFT
    flat = np.column_stack([rng.uniform(-0.03, 0.03, (count, 2)), off])
    return TURN.apply(flat) + SHIFT


@pytest.mark.parametrize("model", MODELS, ids=lambda m: type(m).__name__)
def test_jacobian_is_the_derivative(model):
    cloud = np.random.default_rng(4).normal(size=(40, 3))
    step = 1e-6
    for k in range(len(model.x)):
        ahead, behind = model.x.copy(), model.x.copy()
        ahead[k] += step
        behind[k] -= step
        slope = (model.residual(ahead, cloud) - model.residual(behind, cloud)) / (2.0 * step)
        np.testing.assert_allclose(model.jacobian(model.x, cloud)[:, k], slope, atol=1e-8)
    np.testing.assert_allclose(
        np.abs(model.moved(model.x).residual(model.moved(model.x).x, cloud)), np.abs(model.residual(model.x, cloud)),
        atol=1e-12,
    )  # fmt: skip
    assert len(model.names) == len(model.lengths) == len(model.x)


def test_biweight_and_its_derivatives():
    """A third at most, flat beyond the scale; the derivatives are those of the values."""
    square = np.array([0.0, 0.1, 0.5, 0.9, 1.1, 5.0])
    value, slope, bend = biweight(square)
    np.testing.assert_allclose(value[[0, 4, 5]], [0.0, 1.0 / 3.0, 1.0 / 3.0])
    step = 1e-5
    for here, derivative in ((0, slope), (1, bend)):
        difference = (biweight(square + step)[here] - biweight(square - step)[here]) / (2.0 * step)
        np.testing.assert_allclose(derivative[1:], difference[1:], atol=1e-8)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("robust", [True, False])
def test_exact_shape_is_found_again(shape, robust):
    fit = SHAPES[shape](cloud_of(shape, 300, 0), robust)
    assert fit.rms < 1e-10 and fit.shape == shape
    if fit.radius is not None:
        assert fit.radius == pytest.approx(RADIUS, rel=1e-8)
    if shape == "sphere":
        np.testing.assert_allclose(fit.point, SHIFT, atol=1e-9)
        assert fit.axis is None and np.degrees(fit.arc) == pytest.approx(180, abs=25)
        with pytest.raises(ValueError, match="a sphere has no axis"):
            _ = fit.line
    else:
        assert np.linalg.norm(np.cross(fit.axis, TURN.apply([0.0, 0.0, 1.0]))) < 1e-8
    if shape == "plane":
        assert abs((SHIFT - fit.point) @ fit.axis) < 1e-9 and fit.radius_interval is None


@pytest.mark.parametrize(("shape", "limit"), [("cylinder", 2.5e-5), ("sphere", 5e-6), ("plane", 4e-6)])
def test_a_fifth_of_outliers_to_one_side_does_not_matter(shape, limit):
    """Noise 0.1 mm, outliers up to 10 mm outside; what is compared are distances of a clean cloud to both shapes."""
    count = 10_000
    cloud, clean = cloud_of(shape, count, 5, 1e-4), cloud_of(shape, count, 6)
    middle = SHIFT if shape != "plane" else SHIFT - TURN.apply([0.0, 0.0, 1.0])
    way = cloud[: count // 5] - middle
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    cloud[: count // 5] += way * np.random.default_rng(7).uniform(1e-3, 1e-2, (count // 5, 1))
    robust, plain = (SHAPES[shape](cloud, flag) for flag in (True, False))
    assert np.sqrt(np.mean(robust.distance(clean) ** 2)) < limit
    assert np.sqrt(np.mean(plain.distance(clean) ** 2)) > 20.0 * limit
    assert robust.quality.converged


def test_plain_squares_of_a_plane_are_its_smallest_singular_vector():
    cloud = cloud_of("plane", 500, 8, 1e-3)
    fit = SHAPES["plane"](cloud, False)
    middle = cloud.mean(axis=0)
    normal = np.linalg.svd(cloud - middle, full_matrices=False)[2][-1]
    assert np.linalg.norm(np.cross(fit.axis, normal)) < 1e-9
    assert abs((middle - fit.point) @ normal) < 1e-12


def test_circle_of_a_polygon():
    """Corners of a regular polygon lie on its circle; the middles of its sides on one smaller by the cosine."""
    turn = np.arange(12) * np.pi / 6
    corners = 0.02 * np.column_stack([np.cos(turn), np.sin(turn)]) + [0.3, -0.1]
    middles = 0.5 * (corners + np.roll(corners, 1, axis=0))
    assert fit_circle(corners).radius == pytest.approx(0.02, rel=1e-9)
    assert fit_circle(middles).radius == pytest.approx(0.02 * np.cos(np.pi / 12), rel=1e-9)
    np.testing.assert_allclose(fit_circle(middles).centre, [0.3, -0.1], atol=1e-12)
    with pytest.raises(ValueError, match="at least 5"):
        fit_circle(corners[:4])


@pytest.mark.parametrize(("shape", "least"), [("cylinder", 6), ("sphere", 5), ("plane", 4)])
def test_too_few_points_are_refused(shape, least):
    with pytest.raises(ValueError, match=f"needs at least {least} points, not {least - 1}"):
        SHAPES[shape](cloud_of(shape, least - 1, 0), True)


def test_held_cylinder_keeps_its_direction_where_the_best_one_lies_across():
    """A patch of a torus, radii 33 and 8 mm: the best cylinder has the smaller, the held one the larger."""
    along, across_it = np.meshgrid(np.radians(np.linspace(-25, 25, 41)), np.radians(np.linspace(-50, 50, 41)))
    ring = 0.025 + 0.008 * np.cos(across_it)
    cloud = np.stack([ring * np.cos(along), ring * np.sin(along), 0.008 * np.sin(across_it)], axis=-1).reshape(-1, 3)
    free = SHAPES["cylinder"](cloud, True)
    held = fit_cylinder_along(cloud, np.array([0.0, 0.0, -2.0]))
    assert free.radius < 0.012 and abs(free.axis[2]) < 0.01
    np.testing.assert_array_equal(held.axis, [0.0, 0.0, 1.0])
    assert 0.025 < held.radius < 0.034 and held.rms > free.rms
    np.testing.assert_allclose(held.distance(cloud), held.quality.residual, atol=1e-12)


def test_held_cylinder_is_the_best_one_when_held_along_it():
    cloud = cloud_of("cylinder", 3000, 9, 1e-4)
    free = SHAPES["cylinder"](cloud, True)
    held = fit_cylinder_along(cloud, free.axis)
    assert held.radius == pytest.approx(free.radius, abs=2e-7) and held.arc == pytest.approx(free.arc, abs=1e-3)
    assert np.linalg.norm(np.cross(held.point - free.point, free.axis)) < 2e-7
