"""The movement with any parameters, what it asks of strap and knee, and how both follow the parameters.

Each movement starts from the one before, whose parameters are near: three steps of Newton's method instead of twenty.
All of them have one mesh, so that what they ask changes with the parameters alone; where one is to be certified and an
interval leaves too much of the balance, that interval is halved for all that come after it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.refinement import MOST_HALVINGS, halved
from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions, solve
from geocontact.standing_up.assistance.assisted_model import AssistedModel
from geocontact.standing_up.assistance.habit import HabitSizes, habit
from geocontact.standing_up.assistance.peaks import Asked, asked
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.trials import StandingTrial

Vector = Float[np.ndarray, " p"]


class StoppedByHandError(ArithmeticError):
    """Ctrl-C came while a movement was sought."""


@dataclass(frozen=True, eq=False)
class Movement:
    """Of all trials with one set of parameters; `sizes` are those of the problem's cost."""

    problem: ControlProblem
    found: CollocationResult
    asked: Asked
    sizes: HabitSizes


class Movements:
    """Solves the habit of trials again and again.

    Parameters
    ----------
    nodes
        Intervals a second to begin with.
    told
        Called before each search; may raise StoppedByHandError.
    """

    def __init__(
        self,
        model: AssistedModel,
        subject: Subject,
        trials: Sequence[StandingTrial],
        options: SolverOptions,
        nodes: float,
        told: Callable[[], None] = lambda: None,
    ) -> None:
        self.model, self.subject, self.trials, self.options, self.told = model, subject, tuple(trials), options, told
        self.meshes = tuple(np.linspace(0.0, 1.0, round(nodes * float(np.ptp(t.time))) + 1) for t in trials)
        self.shortest = tuple(float(mesh[1]) / 2**MOST_HALVINGS for mesh in self.meshes)
        self.sizes, self.solved, self.seconds = HabitSizes(), 0, 0.0
        self._last: CollocationResult | None = None

    def at(self, p: Vector, *, slopes: bool = True) -> Movement:
        """ArithmeticError where no movement is found, StoppedByHandError where Ctrl-C came."""
        self.told()
        problem = habit(self.model, self.subject, self.trials, p, self.sizes)
        found = self._solved(problem, self._last)
        if not found.solved and self._last is not None:
            found = self._solved(problem, None)
        if not found.solved:
            raise ArithmeticError(found.ending)
        self._last = found
        self.solved, self.seconds = self.solved + 1, self.seconds + found.seconds
        return Movement(problem, found, asked(self.model, problem, found, slopes=slopes), self.sizes)

    def finely_at(self, p: Vector) -> Movement:
        """The same on meshes that are refined for it."""
        movement = self.at(p)
        while self.refine([movement]):
            movement = self.at(p)
        return movement

    def refine(self, movements: Sequence[Movement]) -> bool:
        """Halve the intervals in which one of them leaves too much of the balance; whether there were any.

        None is halved more often than `MOST_HALVINGS` times.
        """
        turning, before = self.model.standing.turning, self.meshes
        each = [halved(one.problem, one.found, turning, shortest=self.shortest) for one in movements]
        self.meshes = tuple(
            np.unique(np.concatenate([mesh, *finer])) for mesh, *finer in zip(before, *each, strict=True)
        )
        return any(len(mesh) > len(old) for mesh, old in zip(self.meshes, before, strict=True))

    def _solved(self, problem: ControlProblem, warm: CollocationResult | None) -> CollocationResult:
        found = solve(problem, self.options, meshes=self.meshes, warm=warm)
        if found.ending.startswith("interrupted"):
            raise StoppedByHandError("interrupted")
        return found
