"""Static equilibria with closed forms, one that nothing holds, and none."""

from __future__ import annotations

import numpy as np
import pytest
from casadi import SX

from geocontact.dynamics.equations import LawState, equations_of_motion
from geocontact.dynamics.equilibrium import Equilibrium
from geocontact.dynamics.tree import tree_of
from tests.dynamics.models import pendulum

NONE = np.zeros(0)


def test_a_pendulum_with_a_spring_hangs_where_the_torques_balance() -> None:
    """m g l sin q = k (1 - q), from the upper side, near the equilibrium that is none: it ends at the stable one."""
    tree = tree_of(pendulum((0.7,), (1.3,)))
    k = SX.sym("k")
    search = Equilibrium(equations_of_motion(tree, along={"q0": k * (1.0 - tree.q[0])}, parameters=[k]))
    (q,), _ = search.find((np.array([3.1]), NONE), parameters=np.array([2.0]))
    assert 1.3 * 9.81 * 0.7 * np.sin(q) == pytest.approx(2.0 * (1.0 - q), abs=1e-8)
    assert 0.0 < q < 0.5


def test_memories_settle_and_inputs_count() -> None:
    """A torque that follows an input through a lag holds two rods: statics of the chain."""
    tree, z, push = tree_of(pendulum((0.7, 0.4), (1.3, 2.1))), SX.sym("z"), SX.sym("push")
    equations = equations_of_motion(tree, along={"q0": z}, memory=[LawState(z, 9.0 * (push - z))], inputs=[push])
    q, found = Equilibrium(equations).find((np.zeros(2), np.zeros(1)), inputs=np.array([4.0]))
    assert found[0] == pytest.approx(4.0, abs=1e-9)
    assert (1.3 + 2.1) * 9.81 * 0.7 * np.sin(q[0]) == pytest.approx(4.0, abs=1e-8)
    assert q.sum() == pytest.approx(0.0, abs=1e-8)


def test_what_nothing_holds_stays_where_it_was() -> None:
    """Without gravity the second rod is free; the first one's spring is satisfied."""
    tree = tree_of(pendulum((0.7, 0.4), (1.3, 2.1)), gravity=SX(3, 1))
    q, _ = Equilibrium(equations_of_motion(tree, along={"q0": 5.0 * (0.2 - tree.q[0])})).find(
        (np.array([0.0, 1.1]), NONE)
    )
    assert q[0] == pytest.approx(0.2, abs=1e-9)
    assert np.isfinite(q[1])


def test_a_torque_that_no_weight_balances_has_none() -> None:
    tree = tree_of(pendulum((0.7,), (1.3,)))
    with pytest.raises(ArithmeticError, match=r"no static equilibrium is found: .* is left along coordinate q0"):
        Equilibrium(equations_of_motion(tree, along={"q0": SX(20.0)})).find((np.zeros(1), NONE))
