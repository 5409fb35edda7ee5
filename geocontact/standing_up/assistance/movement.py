"""The movement with any parameters, what it asks of strap and knee, and how both follow the parameters.

Each movement starts from the one before, whose parameters are near: three steps of Newton's method instead of twenty.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions, solve
from geocontact.standing_up.assistance.assisted_model import AssistedModel
from geocontact.standing_up.assistance.habit import habit
from geocontact.standing_up.assistance.peaks import Asked, asked
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.trials import StandingTrial

Vector = Float[np.ndarray, " p"]


class StoppedByHandError(ArithmeticError):
    """Ctrl-C came while a movement was sought."""


@dataclass(frozen=True, eq=False)
class Movement:
    """Of all trials with one set of parameters."""

    problem: ControlProblem
    found: CollocationResult
    asked: Asked


class Movements:
    """Solves the habit of trials again and again.

    Parameters
    ----------
    nodes
        Intervals a second.
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
        self.solved, self.seconds = 0, 0.0
        self._last: CollocationResult | None = None

    def at(self, p: Vector, *, slopes: bool = True) -> Movement:
        """ArithmeticError where no movement is found, StoppedByHandError where Ctrl-C came."""
        self.told()
        problem = habit(self.model, self.subject, self.trials, p)
        found = self._solved(problem, self._last)
        if not found.solved and self._last is not None:
            found = self._solved(problem, None)
        if not found.solved:
            raise ArithmeticError(found.ending)
        self._last = found
        self.solved, self.seconds = self.solved + 1, self.seconds + found.seconds
        return Movement(problem, found, asked(self.model, problem, found, slopes=slopes))

    def _solved(self, problem: ControlProblem, warm: CollocationResult | None) -> CollocationResult:
        found = solve(problem, self.options, meshes=self.meshes, warm=warm)
        if found.ending.startswith("interrupted"):
            raise StoppedByHandError("interrupted")
        return found
