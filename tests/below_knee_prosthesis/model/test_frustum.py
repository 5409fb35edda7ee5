"""A frustum against closed forms: cylinder, cone, and two parts put together."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.leg import Frustum, combined


def test_cylinder() -> None:
    mass, centre, inertia = Frustum(0.4, 0.05, 0.05).body(1000.0)
    assert mass == pytest.approx(1000.0 * np.pi * 0.05**2 * 0.4, rel=1e-12)
    np.testing.assert_allclose(centre, [0.0, -0.2, 0.0], atol=1e-15)
    across = mass * (3.0 * 0.05**2 + 0.4**2) / 12.0
    np.testing.assert_allclose(np.diag(inertia), [across, 0.5 * mass * 0.05**2, across], rtol=1e-12)


def test_cone() -> None:
    mass, centre, inertia = Frustum(0.3, 0.06, 1e-9).body(900.0)
    assert mass == pytest.approx(900.0 * np.pi * 0.06**2 * 0.3 / 3.0, rel=1e-6)
    assert centre[1] == pytest.approx(-0.3 / 4.0, rel=1e-6)
    across = 3.0 / 20.0 * mass * 0.06**2 + 3.0 / 80.0 * mass * 0.3**2
    np.testing.assert_allclose(np.diag(inertia), [across, 0.3 * mass * 0.06**2, across], rtol=1e-6)


def test_cut_parts_are_the_whole() -> None:
    whole = Frustum(0.42, 0.055, 0.033)
    upper = whole.cut(0.19)
    lower = Frustum(0.42 - 0.19, upper.distal, 0.033)
    below = lower.body(1100.0)
    together = combined((upper.body(1100.0), (below[0], below[1] - [0.0, 0.19, 0.0], below[2])))
    for one, other in zip(together, whole.body(1100.0), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-15)
