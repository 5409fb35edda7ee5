"""A step is looked up by the equations that it is made of, and is that of CasADi's interpreter."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from casadi import SX, Function

from geocontact.dynamics import machine_code, rosenbrock
from geocontact.dynamics.equations import Equations, LawState, equations_of_motion
from geocontact.dynamics.recorded_inputs import linear_inputs
from geocontact.dynamics.rosenbrock import rosenbrock_step, step_recipe, without_repeats
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.tree import tree_of
from tests.dynamics.models import pendulum


def sprung(stiffness: float) -> Equations:
    """A double pendulum with a law that remembers, an input and a parameter."""
    tree = tree_of(pendulum((0.7, 0.4), (1.3, 2.1)))
    s, force, held = SX.sym("s"), SX.sym("force"), SX.sym("held")
    along = {"q1": -held * s - tree.u[0] * force}
    memory = [LawState(s, tree.q[1] - stiffness * s)]
    return equations_of_motion(tree, along=along, memory=memory, inputs=[force], parameters=[held])


@pytest.fixture
def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Equations]:
    """Equations whose step was made, in an empty cache."""
    monkeypatch.setenv("GEOCONTACT_CACHE", str(tmp_path))
    found: list[Equations] = []

    def noted(of: Equations) -> Function:
        found.append(of)
        return rosenbrock_step(of)

    monkeypatch.setattr(rosenbrock, "rosenbrock_step", noted)
    return found


def as_in_a_new_process(equations: Equations) -> Stepper:
    machine_code._IN_MEMORY.clear()
    return Stepper(equations)


def test_a_step_is_made_once_for_the_same_equations(made: list[Equations], monkeypatch: pytest.MonkeyPatch) -> None:
    counts = []
    for stiffness in (50.0, 50.0, 51.0, 50.0):
        assert as_in_a_new_process(sprung(stiffness)).compiled
        counts.append(len(made))
    assert counts == [1, 1, 2, 2]
    monkeypatch.setattr(rosenbrock, "step_source", lambda: "another text of what makes it")
    assert as_in_a_new_process(sprung(50.0)).compiled and len(made) == 3


def test_a_step_that_was_looked_up_is_that_of_casadi(made: list[Equations]) -> None:
    inputs = linear_inputs(np.array([0.0, 1.0]), np.array([[0.0], [1.0]]))
    start, time = (np.array([1.0, 0.2]), np.zeros(2), np.array([0.3])), np.linspace(0.0, 1.0, 5)
    as_in_a_new_process(sprung(50.0))
    ways = [as_in_a_new_process(sprung(50.0)), Stepper(sprung(50.0), machine_code=False)]
    assert ways[0].compiled and not ways[1].compiled and len(made) == 2
    one, other = (each.simulate(start, time, inputs=inputs, parameters=np.array([2.0])) for each in ways)
    for name in ("q", "u", "z", "ends", "error"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)


def test_sizes_are_those_of_the_step() -> None:
    recipe, step = step_recipe(sprung(50.0)), rosenbrock_step(sprung(50.0))
    assert recipe.inputs == tuple(step.nnz_in(k) for k in range(step.n_in()))
    assert recipe.outputs == tuple(step.nnz_out(k) for k in range(step.n_out()))


def test_repeated_operations_are_done_once() -> None:
    """Results are equal: what is done once is what would be done again."""
    step = rosenbrock_step(sprung(50.0))
    fewer = without_repeats(step)
    assert fewer.n_instructions() < 0.95 * step.n_instructions()
    assert (fewer.name_in(), fewer.name_out()) == (step.name_in(), step.name_out())
    rng = np.random.default_rng(5)
    for _ in range(20):
        given = [rng.uniform(0.1, 1.0, step.size1_in(k)) for k in range(step.n_in())]
        for one, other in zip(step(*given), fewer(*given), strict=True):
            np.testing.assert_array_equal(np.array(one), np.array(other))
