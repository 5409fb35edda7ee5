"""What registration makes least, beside loops over plain numbers: of landmarks, and of one round of the search."""

from __future__ import annotations

from math import sqrt

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.register.icp import Partners, _motion, system
from geocontact.geometry.register.landmarks import fit_landmarks

RNG = np.random.default_rng(11)


def missed(R: np.ndarray, t: np.ndarray, a: np.ndarray, b: np.ndarray, w: np.ndarray) -> float:
    """Σ w |R a + t - b|²."""
    total = 0.0
    for k in range(len(a)):
        for i in range(3):
            total += w[k] * (sum(R[i, j] * a[k, j] for j in range(3)) + t[i] - b[k, i]) ** 2
    return total


def test_landmarks_by_hand() -> None:
    """Weights of which no two are alike; one that counts for nothing is far off."""
    a, w = RNG.normal(size=(6, 3)), np.array([0.3, 1.7, 5.0, 0.9, 2.2, 0.0])
    turn = Rotation.from_rotvec([0.4, -1.1, 0.7])
    b = turn.apply(a) + np.array([0.3, -2.0, 1.0]) + 0.05 * RNG.normal(size=(6, 3))
    b[5] += 40.0
    pose = fit_landmarks(a, b, w).pose
    R, t = pose.rotation.as_matrix(), pose.translation
    here = missed(R, t, a, b, w)
    for k in range(3):
        ends = [missed(R, t + way * 1e-4 * np.eye(3)[k], a, b, w) for way in (1.0, -1.0)]
        turned = [
            missed(Rotation.from_rotvec(way * 1e-4 * np.eye(3)[k]).as_matrix() @ R, t, a, b, w) for way in (1, -1)
        ]
        for ahead, behind in (ends, turned):
            assert ahead > here < behind
            assert abs(ahead - behind) < 1e-5 * (ahead + behind - 2.0 * here) + 1e-12
    other = fit_landmarks(a, b, np.array([0.3, 1.7, 5.0, 0.9, 2.2, 1e-3])).pose
    assert missed(other.rotation.as_matrix(), other.translation, a, b, w) > here


def partners() -> Partners:
    """Any points, planes and heights; two so far off that they weigh nothing."""
    points, normal = 0.2 * RNG.normal(size=(40, 3)) + 1.0, RNG.normal(size=(40, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    height = 1e-3 * RNG.normal(size=40)
    height[:2] = 0.1, -0.2
    return Partners(np.arange(40), points, normal, height)


def test_one_round_by_hand() -> None:
    """Least Σ w (h + n · (s + ω x arm))²: normal equations row by row, w = (1 - (h/c)²)², c = 4.685 · 1.4826 median."""
    some = partners()
    middle = [sum(p[k] for p in some.points) / 40 for k in range(3)]
    c = 4.685 * 1.4826 * float(np.median(np.abs(some.height)))
    matrix, right = np.zeros((6, 6)), np.zeros(6)
    arms = 0.0
    for p, n, h in zip(some.points, some.normal, some.height, strict=True):
        d = [p[k] - middle[k] for k in range(3)]
        arms += sum(x * x for x in d) / 40
        row = [*n, d[1] * n[2] - d[2] * n[1], d[2] * n[0] - d[0] * n[2], d[0] * n[1] - d[1] * n[0]]
        w = (1.0 - (h / c) ** 2) ** 2 if abs(h) < c else 0.0
        for i in range(6):
            right[i] -= w * row[i] * h
            for j in range(6):
                matrix[i, j] += w * row[i] * row[j]
    x = np.linalg.solve(matrix, right)
    motion, size = _motion(some)
    assert isinstance(motion, RigidTransform)
    np.testing.assert_allclose(motion.rotation.as_rotvec(), x[3:], rtol=1e-9)
    np.testing.assert_allclose(motion.apply(np.array(middle)) - middle, x[:3], rtol=1e-9, atol=1e-15)
    turned = sqrt(arms) * x[3:]  # at the points
    np.testing.assert_allclose(size, sqrt(sum(s * s for s in x[:3]) + sum(s * s for s in turned)), rtol=1e-9)
    assert (system(some)[1][:2] == 0.0).all()
