"""Inverse dynamics at random states beside MuJoCo and Pinocchio."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

import casadi
import numpy as np
import pytest

from geocontact.data.multibody.joint import revolute
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.inverse_dynamics import generalised_forces
from geocontact.dynamics.tree import tree_of
from tests import rigid_body_oracle
from tests.dynamics.models import plain_joints
from tests.elsewhere import another_process

PEERS = {
    "mujoco": rigid_body_oracle.mujoco_inverse_dynamics,
    "pinocchio": rigid_body_oracle.pinocchio_inverse_dynamics,
}


@pytest.mark.oracle
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize(("peer", "theirs"), PEERS.items(), ids=PEERS)
def test_inverse_dynamics_is_theirs(peer: str, theirs: Callable[..., np.ndarray], seed: int) -> None:
    """To 1e-12 of the largest force, 50 states of a tree with every joint that all three have."""
    if find_spec(peer) is None:
        pytest.skip(f"{peer} is the oracle and not installed")
    tree = tree_of(plain_joints(seed))
    rng = np.random.default_rng(7)
    states = [rng.uniform(-3.0, 3.0, (50, len(tree.names))), *rng.normal(size=(2, 50, len(tree.names)))]
    run = casadi.Function("id", [tree.q, tree.u, tree.a], [generalised_forces(tree)]).map(50)
    ours = np.array(run(*(each.T for each in states))).T
    with another_process() as call:
        wanted = call(theirs, tree.model, *states)
    assert np.abs(ours - wanted).max() <= 1e-12 * np.abs(wanted).max()


def test_forward_dynamics_undoes_inverse_dynamics() -> None:
    """Accelerations of the forces that some accelerations need are these."""
    tree = tree_of(plain_joints())
    push = casadi.SX.sym("push", len(tree.names))
    along = {name: push[k] for k, name in enumerate(tree.names)}
    equations = equations_of_motion(tree, along=along, inputs=[push])
    needed = casadi.Function("id", [tree.q, tree.u, tree.a], [generalised_forces(tree)])
    rng = np.random.default_rng(8)
    for _ in range(10):
        q, u, a = rng.normal(size=(3, len(tree.names)))
        found = equations.accelerations()(q, u, np.zeros(0), needed(q, u, a), np.zeros(0))
        np.testing.assert_allclose(np.array(found).ravel(), a, atol=1e-10)


def test_an_axis_without_a_length_is_refused() -> None:
    with pytest.raises(ValueError, match="joint knee: an axis of length 0"):
        revolute("knee", "thigh", "shank", np.zeros(3))
