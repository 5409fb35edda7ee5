"""What is sought: motions under controls, several trials of one system at once, with parameters that they share."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.dynamics.collocation.blocks import BlockFunctions
from geocontact.dynamics.symbols import column

if TYPE_CHECKING:
    from casadi import SX

Vector = Float[np.ndarray, " _"]
Bounds = tuple[Vector, Vector]
Course = Callable[[Float[np.ndarray, " t"]], Float[np.ndarray, "t n"]]
"""Values at times [s]."""


@dataclass(frozen=True)
class ControlledSystem:
    """x' = `rate`, `path` = 0, and what it costs, in symbols; all columns.

    Parameters
    ----------
    x, u, w, p
        States, controls, inputs that are given over time, parameters.
    duration
        Of a trial [s].
    rate
        Derivative of the state in time.
    path
        Held at 0 at every collocation point.
    path_at_start
        Rows of `path` that are held at the start as well, with the controls continued there. Radau's points leave the
        start out: where the state holds accelerations, those would be free there.
    cost
        Integrated over time.
    end_cost
        Of the last state, the duration and the parameters.
    prior
        Of the parameters, once for all trials.
    names
        Of the states, of the controls and of the parameters.
    """

    x: SX
    u: SX
    w: SX
    p: SX
    duration: SX
    rate: SX
    path: SX
    cost: SX
    end_cost: SX
    prior: SX
    names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]
    path_at_start: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        """ValueError for what is no column, a rate that is not one for each state, a cost that is not one number."""
        for name in ("x", "u", "w", "p", "path"):
            column(getattr(self, name))
        column(self.rate, self.x.numel())
        for name in ("duration", "cost", "end_cost", "prior"):
            column(getattr(self, name), 1)


@dataclass(frozen=True)
class ControlledTrial:
    """One trial: bounds, data and where the search starts.

    Parameters
    ----------
    name
        As messages call it.
    begin
        Time at its start [s].
    duration
        Least and greatest [s]; equal where it is given.
    x, u
        Bounds of states and controls.
    start, end
        Bounds of the first and the last state.
    inputs
        At times [s]; none where the duration is sought.
    guess_x, guess_u
        Where the search starts, over the times that the mean of the duration's bounds gives.
    """

    name: str
    begin: float
    duration: tuple[float, float]
    x: Bounds
    u: Bounds
    start: Bounds
    end: Bounds
    guess_x: Course
    guess_u: Course
    inputs: Course = lambda time: np.zeros((len(time), 0))

    @property
    def guessed_duration(self) -> float:
        """Mean of the bounds [s]."""
        return 0.5 * (self.duration[0] + self.duration[1])


@dataclass(frozen=True)
class ControlProblem:
    """A system, its trials and its parameters.

    Parameters
    ----------
    system, trials
        What moves.
    p
        Bounds of the parameters.
    guess_p
        Where their search starts.
    scale_path, scale_x, scale_u
        What counts as 1 in each row of the system's path, in each state and in each control; 1 and the largest size
        where the search starts, by default.
    derived
        Functions that transcriptions have made of it, for those on other meshes.
    """

    system: ControlledSystem
    trials: tuple[ControlledTrial, ...]
    p: Bounds = field(default_factory=lambda: (np.zeros(0), np.zeros(0)))
    guess_p: Vector = field(default_factory=lambda: np.zeros(0))
    scale_path: Vector | None = None
    scale_x: Vector | None = None
    scale_u: Vector | None = None
    derived: dict[Hashable, BlockFunctions] = field(default_factory=dict, init=False, repr=False, compare=False)


def checked(problem: ControlProblem) -> None:
    """InputError for bounds without room, a start outside of them, and values that are not numbers."""
    x, u, p = problem.system.names
    _inside("parameters", p, problem.p, problem.guess_p)
    for trial in problem.trials:
        low, high = trial.duration
        if not 0.0 < low <= high < np.inf:
            raise InputError(
                trial.name, "duration", f"{low:g} to {high:g} s is not a time", "give 0 < least <= greatest"
            )
        time = trial.begin + np.linspace(0.0, trial.guessed_duration, 50)
        for names, bounds, course in ((x, trial.x, trial.guess_x), (u, trial.u, trial.guess_u)):
            for at in course(time):
                _inside(trial.name, names, bounds, at)
        for place, bounds in (("start", trial.start), ("end", trial.end)):
            both = np.maximum(bounds[0], trial.x[0]), np.minimum(bounds[1], trial.x[1])
            _room(f"{trial.name} {place}", x, both)
        if low < high and problem.system.w.numel():
            raise InputError(trial.name, "duration", "sought, though inputs are given over time", "give one value")
        if not np.isfinite(trial.inputs(time)).all():
            raise InputError(trial.name, "inputs", "not every value is a number", "fill or cut the gaps")


def _room(where: str, names: tuple[str, ...], bounds: Bounds) -> None:
    for name, low, high in zip(names, *bounds, strict=True):
        if not low <= high:
            raise InputError(where, name, f"no room between {low:g} and {high:g}", "give least <= greatest")


def _inside(where: str, names: tuple[str, ...], bounds: Bounds, at: Vector) -> None:
    _room(where, names, bounds)
    for name, low, high, value in zip(names, *bounds, at, strict=True):
        if not np.isfinite(value):
            raise InputError(where, name, "the search starts at no number", "fill or cut the gaps")
        if not low <= value <= high:
            raise InputError(
                where, name, f"the search starts at {value:g}, outside {low:g} to {high:g}", "start inside or widen"
            )
