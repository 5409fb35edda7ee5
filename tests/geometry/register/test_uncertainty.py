"""The covariance that a registration tells of itself: intervals of 95 % hold the truth in 95 % of synthetic draws."""

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation
from scipy.stats import t as student

from geocontact.geometry.register.icp import IcpSearch, icp, shape_covariance
from geocontact.geometry.register.landmarks import fit_landmarks
from geocontact.geometry.register.quality import PoseCovariance, crossing
from geocontact.geometry.surface import Surface
from tests.geometry.drape.sheets import tube
from tests.geometry.register.test_icp import bumpy

POINT = np.array([0.2, -0.1, 0.3])


def missed(truth, found, point):
    """Shift of a point [m] and turn [rad] by which the truth differs from what was found, both in B."""
    motion = truth * found.inv()
    return np.concatenate([motion.apply(point) - point, motion.rotation.as_rotvec()])


def held(covariance, miss, point=POINT):
    """Which components lie within their intervals of 95 %."""
    sd = np.sqrt(np.diag(covariance.at(point)))
    return np.abs(miss) < student.ppf(0.975, covariance.freedom) * sd


@pytest.mark.parametrize("n", [3, 4, 8])
def test_intervals_of_landmarks_hold_the_truth(n):
    rng = np.random.default_rng(n)
    a = rng.uniform(-0.3, 0.3, (n, 3))
    X = RigidTransform.from_components([0.3, 0.1, -0.2], Rotation.from_rotvec([0.5, -1.0, 0.3]))
    hits = []
    for _ in range(1500):
        found = fit_landmarks(a, X.apply(a) + rng.normal(0.0, 2e-3, a.shape))
        hits.append(held(found.covariance, missed(X, found.pose, POINT)))
    assert np.mean(hits, axis=0) == pytest.approx(np.full(6, 0.95), abs=0.02)


@pytest.mark.slow
def test_covariance_of_landmarks_is_that_of_draws():
    """All of the matrix, not only its diagonal; weights are inverse variances."""
    rng = np.random.default_rng(1)
    a = rng.uniform(-0.3, 0.3, (6, 3))
    weight = np.array([1.0, 4.0, 1.0, 0.25, 1.0, 2.0])
    misses, stated = [], []
    for _ in range(4000):
        found = fit_landmarks(a, a + rng.normal(0.0, 1e-3, a.shape) / np.sqrt(weight)[:, None], weight)
        misses.append(missed(RigidTransform.identity(), found.pose, POINT))
        stated.append(found.covariance.at(POINT))
    seen = np.cov(np.array(misses).T)
    scale = np.sqrt(np.diag(seen))
    assert np.mean(stated, axis=0) / np.outer(scale, scale) == pytest.approx(seen / np.outer(scale, scale), abs=0.07)


@pytest.mark.slow
@pytest.mark.parametrize(
    "points", [400, pytest.param(6000, marks=pytest.mark.long)], ids=["fewer points than vertices", "more"]
)
def test_intervals_of_shapes_hold_the_truth(points):
    """Vertices of the scan are noisy by 0.5 mm each; 1600 of them."""
    fixed, clean = bumpy(-0.15, 0.15, -0.15, 0.15, 40), bumpy(-0.12, 0.12, -0.12, 0.12, 50)
    search, rng = IcpSearch(points=points, settled=1e-7), np.random.default_rng(2)
    best = icp(clean, fixed, RigidTransform.identity(), search).pose  # what the facets alone make of it
    hits = []
    for _ in range(80):
        noisy = Surface(clean.vertices + rng.normal(0.0, 5e-4, clean.vertices.shape), clean.faces, "scan")
        found = icp(noisy, fixed, best, search)
        covariance = shape_covariance(noisy, fixed, found.pose, search)
        hits.append(held(covariance, missed(best, found.pose, POINT)))
    assert 0.9 < np.mean(hits) < 0.985, np.mean(hits, axis=0)


def test_what_the_shapes_leave_open_keeps_the_uncertainty_of_the_start():
    """A tube in a tube: along its axis nothing is known but what the landmarks told (about it, its 80 facets tell)."""
    around, axis = Surface(*tube(n=80)), np.array([0.0, 0.0, 0.25])
    vertices = around.vertices + np.random.default_rng(3).normal(0.0, 2e-4, around.vertices.shape)
    start = PoseCovariance(axis, np.diag([9.0, 9.0, 9.0, 900.0, 900.0, 900.0]) * 1e-6, 6.0)
    found = shape_covariance(Surface(vertices, around.faces), around, RigidTransform.identity(), start=start)
    sd = np.sqrt(np.diag(found.at(axis)))
    assert sd[2] == pytest.approx(3e-3, rel=1e-2)
    assert sd[:2].max() < 1e-4 and sd[3:5].max() < 1e-3


def test_a_shift_of_another_point_contains_the_turn():
    turned = PoseCovariance(np.zeros(3), np.diag([0.0, 0.0, 0.0, 0.0, 0.0, 1e-4]), 6.0).at(np.array([0.5, 0.0, 0.2]))
    assert np.sqrt(np.diag(turned))[:3] == pytest.approx([0.0, 5e-3, 0.0], abs=1e-12)
    assert crossing(POINT) @ [1.0, 2.0, 3.0] == pytest.approx(np.cross(POINT, [1.0, 2.0, 3.0]))


def test_independent_covariances_add_up_at_every_point():
    """Degrees of freedom of Welch and Satterthwaite: n of two alike are 2 n, a negligible one adds nothing."""
    rng = np.random.default_rng(2)
    first, second = (rng.standard_normal((6, 6)) for _ in range(2))
    a = PoseCovariance(np.array([0.1, 0.2, -0.1]), first @ first.T, 5.0)
    b = PoseCovariance(np.array([-0.3, 0.0, 0.4]), second @ second.T, 9.0)
    assert a.plus(b).at(POINT) == pytest.approx(a.at(POINT) + b.at(POINT), rel=1e-9)
    assert a.plus(a).freedom == pytest.approx(10.0)
    assert a.plus(PoseCovariance(a.about, 1e-12 * a.matrix, 1.0)).freedom == pytest.approx(5.0)
    nothing = PoseCovariance(a.about, np.zeros((6, 6)), 3.0)
    assert nothing.plus(nothing).freedom == 6.0
