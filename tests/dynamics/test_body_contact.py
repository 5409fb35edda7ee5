"""Contact between two bodies: momentum is kept, and a force between links equals a spring along their coordinates."""

from __future__ import annotations

import casadi
import numpy as np
import pytest
from casadi import SX

from geocontact.data.multibody.joint import free
from geocontact.data.multibody.model import Body, Multibody
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.sphere_contact import action_and_reaction, together
from geocontact.dynamics.tree import tree_of
from tests.dynamics.models import pendulum

NONE = np.zeros(0)


def test_two_free_bodies_keep_momentum_and_angular_momentum() -> None:
    """Joined by a spring between points off their centres, one on each."""
    inertia = np.diag([0.02, 0.03, 0.04])
    bodies = tuple(Body(name, mass, np.zeros(3), inertia) for name, mass in (("a", 1.0), ("b", 2.5)))
    model = Multibody("two", bodies, tuple(free(n, "ground", n) for n in "ab"), (), np.zeros(3))
    tree = tree_of(model)
    ends = [tree.point(name, SX(np.array(at))) for name, at in (("a", [0.1, 0.0, 0.02]), ("b", [0.0, -0.1, 0.0]))]
    force = 40.0 * (ends[1] - ends[0])
    loads = together(action_and_reaction("a", "b", force, ends[0]), {"b": (SX(3, 1), SX(3, 1))})
    # The spring pulls along the line between its ends, so that either end is on the line of action.
    momentum, angular = SX(3, 1), SX(3, 1)
    for body in bodies:
        frame = tree.bodies[body.name]
        momentum += body.mass * frame.speed
        own = frame.rotation @ SX(inertia) @ frame.rotation.T @ frame.spin
        angular += own + casadi.cross(frame.place, body.mass * frame.speed)
    kept = casadi.Function("kept", [tree.q, tree.u], [casadi.vertcat(momentum, angular)])
    rng = np.random.default_rng(3)
    start = (0.3 * rng.normal(size=12), 0.3 * rng.normal(size=12), NONE)
    course = Stepper(equations_of_motion(tree, loads=loads), machine_code=False).simulate(
        start, np.linspace(0.0, 0.5, 4), tolerance=1e-8
    )
    found = np.array([np.array(kept(q, u)).ravel() for q, u in zip(course.q, course.u, strict=True)])
    np.testing.assert_allclose(found, np.broadcast_to(found[0], found.shape), atol=1e-7)
    assert np.abs(course.u[-1] - course.u[0]).max() > 0.1


def test_a_load_on_the_ground_is_left_out() -> None:
    tree = tree_of(pendulum((0.7,), (1.3,)))
    loads = action_and_reaction("bob0", "ground", SX(np.array([1.0, 0.0, 0.0])), SX(np.array([0.0, -0.7, 0.0])))
    assert set(loads) == {"bob0"}
    force = casadi.Function("f", [tree.q, tree.u], [equations_of_motion(tree, loads=loads).force])
    assert float(force(np.zeros(1), np.zeros(1))) == pytest.approx(0.7)
