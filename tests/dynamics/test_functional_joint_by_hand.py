"""What the joint's centre and axis make least, beside loops over plain numbers."""

from __future__ import annotations

from math import sqrt

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.dynamics.functional_joint import functional_axis, functional_centre

RNG = np.random.default_rng(6)


def recorded(hinge: bool) -> tuple[RigidTransform, RigidTransform]:
    """Poses of two segments over 30 frames, each off by some millimetres and hundredths of a radian."""
    first = RigidTransform.from_components(RNG.normal(size=(30, 3)), Rotation.from_rotvec(RNG.normal(size=(30, 3))))
    turns = np.outer(np.linspace(-0.7, 0.9, 30), [0.6, 0.8, 0.0]) if hinge else 0.8 * RNG.normal(size=(30, 3))
    joint = RigidTransform.from_components([0.2, -0.1, 0.05], Rotation.from_rotvec(turns))
    there = RigidTransform.from_translation([0.01, 0.3, -0.02])
    off = RigidTransform.from_components(
        3e-3 * RNG.normal(size=(30, 3)), Rotation.from_rotvec(0.01 * RNG.normal(size=(30, 3)))
    )
    return first, first * joint * off * there


def apart(poses: tuple[RigidTransform, RigidTransform], c: np.ndarray) -> list[float]:
    """R1 c1 + t1 - R2 c2 - t2 of every frame."""
    turned = [p.rotation.as_matrix() for p in poses]
    found = []
    for k in range(30):
        for i in range(3):
            one = sum(turned[0][k, i, j] * c[j] for j in range(3)) + poses[0].translation[k, i]
            two = sum(turned[1][k, i, j] * c[3 + j] for j in range(3)) + poses[1].translation[k, i]
            found.append(one - two)
    return found


def squares(values: list[float]) -> float:
    return sum(v * v for v in values)


def test_a_centre_by_hand() -> None:
    """Least Σ |R1 c1 + t1 - R2 c2 - t2|², its root mean square, and σ² (AᵀA)⁻¹ with σ² over 90 - 6 numbers."""
    poses = recorded(hinge=False)
    found = functional_centre(*poses)
    c = np.array([*found.first, *found.second])
    here = squares(apart(poses, c))
    for step in 1e-4 * np.eye(6):
        ahead, behind = squares(apart(poses, c + step)), squares(apart(poses, c - step))
        assert ahead > here < behind and abs(ahead - behind) < 1e-6 * (ahead + behind - 2.0 * here)
    assert abs(found.rms - sqrt(here / 30)) < 1e-12
    columns = np.array([np.subtract(apart(poses, step), apart(poses, np.zeros(6))) for step in np.eye(6)])
    covariance = here / 84 * np.linalg.inv(columns @ columns.T)
    np.testing.assert_allclose([*found.first_sd, *found.second_sd], np.sqrt(np.diag(covariance)), rtol=1e-9)


def test_an_axis_by_hand() -> None:
    """The direction changes |R1 a1 - R2 a2| least of all of the same size; the point is the nearest to the origin."""
    poses = recorded(hinge=True)
    found = functional_axis(*poses)
    still = apart(poses, np.zeros(6))
    a = np.array([*found.first_direction, *found.second_direction]) / sqrt(2.0)

    def moved(direction: np.ndarray) -> float:
        d = direction / sqrt(float(direction @ direction))
        return squares(list(np.subtract(apart(poses, d), still)))

    # both halves are made unit vectors, which differs from the singular vector by less than the noise squared
    for step in 0.02 * np.eye(6):
        assert min(moved(a + step), moved(a - step)) > moved(a)
    c = np.array([*found.first, *found.second])
    here = squares(apart(poses, c))
    assert abs(found.rms - sqrt(here / 30)) < 1e-12
    assert abs(float(found.first @ found.first_direction)) < 1e-9
    for step in 1e-3 * np.eye(6):
        across = step - (step @ a) * a  # along the axis next to nothing changes
        ahead, behind = squares(apart(poses, c + across)), squares(apart(poses, c - across))
        assert abs(ahead - behind) < 0.05 * (ahead + behind - 2.0 * here)
