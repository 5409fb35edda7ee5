"""Landmarks: the exact pose, what noise makes of it, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.register.landmarks import fit_landmarks

turns = st.tuples(*[st.floats(-3.0, 3.0)] * 3)
shifts = st.tuples(*[st.floats(-5.0, 5.0)] * 3)


def pose(turn, shift):
    return RigidTransform.from_components(np.array(shift), Rotation.from_rotvec(turn))


def landmarks(n=6, seed=0):
    return np.random.default_rng(seed).uniform(-0.3, 0.3, (n, 3))


def apart(a, b):
    """Largest difference of two poses: of the translation [m] and of the rotation [rad]."""
    return max(np.linalg.norm(a.translation - b.translation), float((a.rotation.inv() * b.rotation).magnitude()))


@given(turns, shifts, st.integers(3, 9), st.integers(0, 20))
def test_recovers_any_pose(turn, shift, n, seed):
    X_BA, a = pose(turn, shift), landmarks(n, seed)
    found = fit_landmarks(a, X_BA.apply(a))
    assert apart(found.pose, X_BA) < 1e-12
    assert found.rms < 1e-14 + 1e-15 * np.linalg.norm(shift)
    assert found.overlap == 1.0


@given(turns, shifts)
@settings(max_examples=30)
def test_a_motion_of_either_body_goes_into_the_pose(turn, shift):
    rng = np.random.default_rng(1)
    a = landmarks(7)
    b = a + rng.normal(0, 0.003, a.shape)
    before, X = fit_landmarks(a, b), pose(turn, shift)
    assert apart(fit_landmarks(a, X.apply(b)).pose, X * before.pose) < 1e-11
    assert apart(fit_landmarks(X.apply(a), b).pose, before.pose * X.inv()) < 1e-11
    assert fit_landmarks(a, X.apply(b)).residual == pytest.approx(before.residual, abs=1e-13)


@pytest.mark.parametrize("n", [3, 5, 10])
def test_residual_of_noise_is_that_of_the_formula(n):
    """E[rms^2] = 3 s^2 (1 - 2/n): a fit takes up six of 3 n freedoms."""
    rng, sigma, a = np.random.default_rng(n), 0.002, landmarks(n)
    squares = [fit_landmarks(a, a + rng.normal(0, sigma, a.shape)).rms ** 2 for _ in range(3000)]
    assert np.mean(squares) == pytest.approx(3 * sigma**2 * (1 - 2 / n), rel=0.05)


def test_error_of_the_pose_falls_with_the_root_of_the_number():
    rng, sizes, errors = np.random.default_rng(0), np.array([8, 32, 128, 512]), []
    for n in sizes:
        a = landmarks(n)
        shifts = [fit_landmarks(a, a + rng.normal(0, 0.002, a.shape)).pose.translation for _ in range(300)]
        errors.append(np.sqrt(np.mean(np.square(shifts))))
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(-0.5, abs=0.07)


def test_a_weight_counts_as_so_many_landmarks():
    a = landmarks(5)
    b = a + np.random.default_rng(3).normal(0, 0.01, a.shape)
    weight = np.array([1.0, 2.0, 1.0, 3.0, 1.0])
    again = np.repeat(np.arange(5), weight.astype(int))
    assert apart(fit_landmarks(a, b, weight).pose, fit_landmarks(a[again], b[again]).pose) < 1e-13


def test_never_mirrors():
    a = landmarks(8)
    found = fit_landmarks(a, a * [1, 1, -1])
    assert np.linalg.det(found.pose.rotation.as_matrix()) == pytest.approx(1.0, abs=1e-12)
    assert found.rms > 0.05, "mirrored landmarks do not fit"


def test_the_worst_is_named():
    a = landmarks(6)
    b = a.copy()
    b[4] += [0.03, 0, 0]
    name, miss = fit_landmarks(a, b, names=["C7", "T8", "left PSIS", "right PSIS", "knee", "hip"]).worst
    assert name == "knee"
    assert 0.005 < miss < 0.03
    assert fit_landmarks(a, b).worst[0] == "landmark 5"


def test_refused():
    line = np.outer(np.arange(5.0), [0.1, 0.2, 0.3])
    a = landmarks(5)
    with pytest.raises(ValueError, match="3 landmarks at least, not 2"):
        fit_landmarks(a[:2], a[:2])
    with pytest.raises(ValueError, match="moving landmarks lie in one line"):
        fit_landmarks(line, a)
    with pytest.raises(ValueError, match="fixed landmarks lie in one line"):
        fit_landmarks(a, line)
    with pytest.raises(ValueError, match="lie in one line"):
        fit_landmarks(np.vstack([line, a[:1]]), np.vstack([line, a[:1]]), np.array([1.0, 1, 1, 1, 1, 0]))
    with pytest.raises(ValueError, match="hip is not finite"):
        fit_landmarks(a, np.where(np.arange(5)[:, None] == 2, np.nan, a), names=["a", "b", "hip", "c", "d"])
    with pytest.raises(ValueError, match="5 landmarks but 2 names"):
        fit_landmarks(a, a, names=["a", "b"])
    with pytest.raises(ValueError, match="not negative"):
        fit_landmarks(a, a, -np.ones(5))
