"""The step of a foot on 24 spheres keeps its size; `benchmarks.contact.sole_step` measures it in seconds."""

from __future__ import annotations

from benchmarks.contact.sole_step import side
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.rosenbrock import rosenbrock_step


def test_a_step_of_24_spheres_takes_so_many_operations() -> None:
    """159 000 with a column of the Jacobian for each input; 132 000 with their derivative in one direction."""
    tree, given = side(24)
    step = rosenbrock_step(equations_of_motion(tree, **given))
    assert step.n_instructions() < 135_000
