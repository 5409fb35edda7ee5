"""Torques that a motion on the ground and in the strap needs, beside Pinocchio's with the same contact forces."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest

from geocontact.dynamics.tree import tree_of
from geocontact.standing_up.chain import PLANTED, Subject, ground_on_feet
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, thigh_strap, two_chains, with_exoskeleton
from geocontact.standing_up.trials import rising
from tests import rigid_body_oracle
from tests.elsewhere import another_process

SUBJECT = Subject()
P = np.r_[PLANTED, STRAP_PLANTED]


def standing_up() -> list[np.ndarray]:
    """Coordinates, rates and accelerations of a synthetic rise of 1.5 s, the exoskeleton's joints a little behind."""
    time, h = np.linspace(0.05, 1.45, 30), 1e-3
    course = rising(1.5)

    def both(at: np.ndarray) -> np.ndarray:
        q = course(at)
        return np.hstack([q, course(at - 0.02)[:, 3:]])

    before, now, after = both(time - h), both(time), both(time + h)
    return [now, (after - before) / (2 * h), (after - 2 * now + before) / h**2]


@pytest.mark.oracle
def test_torques_are_those_of_pinocchio() -> None:
    """To 1e-9 of the largest; the feet press by more than half of the weight, the strap by more than a newton."""
    if find_spec("pinocchio") is None:
        pytest.skip("pinocchio is the oracle and not installed")
    from casadi import Function, vertcat

    states = standing_up()
    model, tree = with_exoskeleton(SUBJECT), tree_of(two_chains(SUBJECT))
    e, feet = model.equations, len(PLANTED)
    on_feet = ground_on_feet(tree, e.p[:feet, :])
    on_thighs = thigh_strap(tree, e.p[feet:, :]).loads
    names = ("foot", *on_thighs)
    pressed = [vertcat(*{**on_feet, **on_thighs}[name]) for name in names]
    columns = [each.T for each in states]
    many = len(states[0])
    seen = Function("seen", [tree.q, tree.u, e.p], pressed).map(many)(*columns[:2], np.tile(P[:, None], (1, many)))
    loads = {name: each.full().T for name, each in zip(names, seen, strict=True)}
    assert loads["foot"][:, 1].min() > 400.0 and np.abs(loads["thigh"][:, :3]).max() > 1.0
    needed = Function("needed", [e.q, e.u, e.a, e.w, e.p], [-e.balance]).map(many)
    ours = needed(*columns, np.zeros((6, many)), np.tile(P[:, None], (1, many))).full().T
    with another_process() as call:
        theirs = call(rigid_body_oracle.pinocchio_inverse_dynamics, tree.model, *states, loads)
    assert np.abs(ours - theirs).max() <= 1e-9 * np.abs(theirs).max()
