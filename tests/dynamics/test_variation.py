"""Derivatives of a motion by its variational equations, beside those that are followed through the steps."""

from __future__ import annotations

import casadi
import numpy as np
from casadi import SX

from geocontact.dynamics.equations import LawState, equations_of_motion
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.tree import tree_of
from geocontact.dynamics.variation import Variation, nodes_of
from tests.dynamics.models import pendulum


def test_derivatives_are_those_of_the_steps() -> None:
    """A mass, a motor's stiffness, and the rate of a law with memory that pulls."""
    mass, k, rate, z = SX.sym("m"), SX.sym("k"), SX.sym("rate"), SX.sym("z")
    tree = tree_of(pendulum((0.7, 0.4), (1.3, 2.1)), masses={"bob1": mass})
    memory = [LawState(z, rate * (tree.q[0] - z))]
    along = {"q0": -z, "q1": -k * tree.q[1]}
    equations = equations_of_motion(tree, along=along, memory=memory, parameters=[mass, casadi.vertcat(k, rate)])
    start, p = (np.array([0.6, -0.3]), np.zeros(2), np.zeros(1)), np.array([2.1, 1.5, 4.0])
    stepper = Stepper(equations, machine_code=False, by_parameter=True)
    followed = stepper.simulate(start, np.linspace(0.0, 0.8, 3), parameters=p, steps=200)
    times = np.concatenate([[0.0], followed.ends])
    found = stepper.simulate(start, np.concatenate([[0.0], nodes_of(times)]), parameters=p, steps=200)
    x = np.hstack([found.q, found.u, found.z])[1:]
    variation = Variation(equations, [0, 2], machine_code=False)
    by = variation.along(times, x, np.zeros((len(x), 0)), p, np.zeros((5, 2)))
    assert by.shape == (201, 5, 2)
    assert np.abs(by[-1]).max(axis=0).min() > 1e-3
    np.testing.assert_allclose(by[[0, 100, 200]], followed.by_parameter[:, :, [0, 2]], atol=2e-5)
