"""A sphere under a foot that slides, sinks and turns: force and where it acts, in plain NumPy and turned as a whole."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.dynamics.sphere_contact import OpenSimSphereLaw, StribeckFriction, smooth_sphere_wrench
from geocontact.dynamics.symbols import apply_numpy
from geocontact.dynamics.tree import Moving
from geocontact.geometry.shapes import HalfSpace
from tests.standing_up.by_hand import Foot, sphere

casadi = pytest.importorskip("casadi")
FOOT = Foot(6e6, -0.04, 0.13, 0.09, 0.03, 1.2, 1.3)
LAW = OpenSimSphereLaw(FOOT.stiffness, FOOT.dissipation, FOOT.radius, StribeckFriction(0.2, 0.9 * 1.3, 0.7 * 1.3, 0.4))
Q, U = np.array([0.05, 0.083, 0.04]), np.array([0.11, -0.03, -0.4])


def wrench(turned: Rotation) -> np.ndarray:
    """Force and moment on the toe's sphere with foot and ground turned together, turned back."""
    apply_numpy()
    own = turned.as_matrix()
    in_plane = Rotation.from_rotvec([0.0, 0.0, Q[2]]).as_matrix()
    columns = [own @ [*Q[:2], 0.0], own @ [*U[:2], 0.0], own @ [0.0, 0.0, U[2]]]
    place, speed, spin, none = (casadi.SX(each) for each in (*columns, np.zeros(3)))
    foot = Moving(casadi.SX(own @ in_plane), place, spin, speed, none, none)
    centre = casadi.SX([FOOT.toe, FOOT.radius - FOOT.bottom, 0.0])
    ground = HalfSpace(normal=tuple(own[:, 1]))
    both = casadi.Function("w", [], list(smooth_sphere_wrench(foot, centre, LAW, ground)))()
    return np.array([own.T @ np.array(each).ravel() for each in both.values()])


def test_it_acts_half_of_its_depth_below_the_ground() -> None:
    force, moment = wrench(Rotation.identity())
    along, up, turning = sphere(Q, U, FOOT.toe, FOOT)
    np.testing.assert_allclose(force, [along, up, 0.0], rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(moment, [0.0, 0.0, turning], rtol=1e-12, atol=1e-9)
    assert up > 50.0 and along < -10.0
    centre = Q[1] + np.sin(Q[2]) * FOOT.toe + np.cos(Q[2]) * (FOOT.radius - FOOT.bottom)
    x = Q[0] + np.cos(Q[2]) * FOOT.toe - np.sin(Q[2]) * (FOOT.radius - FOOT.bottom)
    level = (x * up - moment[2]) / along
    assert level == pytest.approx(-0.5 * (FOOT.radius - centre), rel=1e-9)


def test_turned_with_the_ground_it_is_the_same() -> None:
    np.testing.assert_allclose(
        wrench(Rotation.from_rotvec([0.3, -0.2, 0.5])), wrench(Rotation.identity()), rtol=1e-9, atol=1e-9
    )
