"""The movement with any parameters, what it asks of strap and knee, smooth and true peaks, and how both follow the
parameters.

Each movement starts from the one before, whose parameters are near: three steps of Newton's method instead of twenty.
All of them have one mesh, so that what they ask changes with the parameters alone; where one is to be certified and an
interval leaves too much of the balance, that interval is halved for all that come after it.

The smooth maximum of |F| over the collocation points is the norm of order `ORDER` with the points' parts of the time as
weights, (Σ wᵢ |Fᵢ|^r)^(1/r): below the largest by what the peak lasts, 7 % where it lasts a fifth of the movement.
The true peak is the largest over the points and `PLACES` of every interval, both of its ends among them. At 20
intervals a second they are 6 ms apart: a peak that falls to half within 0.1 s is 5e-4 higher between two of them, at
most.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.optimality import MotionResponse, responses
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import MOST_HALVINGS, CollocationResult, SolverOptions, halved, solve
from geocontact.standing_up.assisted_model import KNEE, AssistedModel, HabitSizes, habit
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.trials import StandingTrial

if TYPE_CHECKING:
    from casadi import SX


ORDER = 24
MEASURES = ("strap", "knee", "energy", "shear")
"""Smooth peak of one strap's normal force [N], of the person's knee torque of both legs [N m], mean energy of the
straps' springs [J], smooth peak of one strap's force along the thigh [N]."""
PLACES = 9
"""Places of an interval, evenly from its start to its end: where true peaks are looked for."""
UNITS = {"strap": "N", "knee": "N m", "energy": "J", "shear": "N", "shank": "N", "pelvis": "N"}


def measures_of(model: AssistedModel) -> tuple[str, ...]:
    """`MEASURES`, then the smooth peak of one strap's normal force at each further site [N], by its name."""
    return (*MEASURES, *model.standing.elsewhere)


@dataclass(frozen=True, eq=False)
class Asked:
    """What one movement asks for, in the order of `measures`.

    Parameters
    ----------
    sizes
        Smooth peaks and energy.
    slopes
        Derivatives by what is searched of each parameter.
    largest
        True peaks, without smoothing; of the energy too.
    knee
        The person's knee torque at all places [N m].
    knee_slopes
        Its derivatives by what is searched of each parameter.
    order, places
        Of the norm that smooths; of an interval, where true peaks are looked for.
    measures
        Names of what is asked for.
    """

    sizes: Float[np.ndarray, " k"]
    slopes: Float[np.ndarray, "k p"]
    largest: Float[np.ndarray, " k"]
    knee: Float[np.ndarray, " t"]
    knee_slopes: Float[np.ndarray, "t p"]
    order: int
    places: int
    measures: tuple[str, ...] = MEASURES

    def at(self, measure: str) -> float:
        """Smooth peak, or mean energy."""
        return float(self.sizes[self.measures.index(measure)])

    def largest_at(self, measure: str) -> float:
        """True peak."""
        return float(self.largest[self.measures.index(measure)])


def asked(
    model: AssistedModel,
    problem: ControlProblem,
    found: CollocationResult,
    *,
    slopes: bool = True,
    order: int = ORDER,
    places: int = PLACES,
) -> Asked:
    """What all trials of a solved `habit` ask for; derivatives are not numbers where they are not wanted."""
    parts = [_over_points(model, problem, found, k) for k in range(len(found.motions))]
    weights = np.concatenate([each.weights for each in parts]) / len(parts)
    values = np.concatenate([each.values for each in parts], axis=1)
    size = np.abs(values).max(axis=1)
    scaled = np.abs(values) / size[:, None]
    peaks = size * (scaled**order @ weights) ** (1.0 / order)
    energy, knee = MEASURES.index("energy"), MEASURES.index("knee")
    peaks[energy] = values[energy] @ weights
    there = [_at_places(model, problem, found, k, places) for k in range(len(found.motions))]
    everywhere = np.concatenate([each[0] for each in there], axis=1)
    by, of_knee = np.full((len(values), len(found.p)), np.nan), np.full((everywhere.shape[1], len(found.p)), np.nan)
    if slopes:
        along = responses(problem, found)
        changes = np.concatenate([each.followed(one) for each, one in zip(parts, along, strict=True)], axis=2)
        # of the norm by one value: w |F|^(r-1) sign(F) / norm^(r-1)
        pull = weights * np.sign(values) * (np.abs(values) / peaks[:, None]) ** (order - 1)
        pull[energy] = weights
        by = np.einsum("kt,kpt->kp", pull, changes)
        of_knee = np.concatenate(
            [_knee_slopes(model, one.controls, each[1]) for one, each in zip(along, there, strict=True)]
        )
    return Asked(
        peaks, by, np.abs(everywhere).max(axis=1), everywhere[knee], of_knee, order, places, measures_of(model)
    )


@dataclass(frozen=True, eq=False)
class _OverPoints:
    """Values of one trial at its collocation points, and derivatives there by states, controls and parameters."""

    values: Float[np.ndarray, "k t"]
    weights: Float[np.ndarray, " t"]
    by_state: Float[np.ndarray, "k t x"]
    by_control: Float[np.ndarray, "k t u"]
    by_parameter: Float[np.ndarray, "k t p"]

    def followed(self, along: MotionResponse) -> Float[np.ndarray, "k p t"]:
        """Derivatives by the parameters, the movement following."""
        count = along.states.shape[0]
        x = along.states[:, :, 1:].reshape(count, -1, along.states.shape[3])
        u = along.controls.reshape(count, -1, along.controls.shape[3])
        by_motion = np.einsum("ktx,ptx->kpt", self.by_state, x) + np.einsum("ktu,ptu->kpt", self.by_control, u)
        return np.asarray(by_motion + self.by_parameter.transpose(0, 2, 1))


def _over_points(model: AssistedModel, problem: ControlProblem, found: CollocationResult, k: int) -> _OverPoints:
    from casadi import Function, densify, jacobian

    system, seen, motion = problem.system, _outputs(model, problem), found.motions[k]
    symbols = [system.x, system.u, system.p]
    outputs = [seen, *(densify(jacobian(seen, each)) for each in symbols)]
    x, u = (each.reshape(-1, each.shape[-1]) for each in (motion.states[:, 1:], motion.controls))
    at = Function("at", symbols, outputs).map(len(x))(x.T, u.T, np.tile(found.p[:, None], (1, len(x))))
    values, *by = (each.full() for each in at)
    lengths = np.diff(motion.breaks) / np.ptp(motion.breaks)
    weights = (lengths[:, None] * motion.scheme.weights).ravel()
    return _OverPoints(values, weights, *(each.reshape(len(values), len(x), -1) for each in by))


def _outputs(model: AssistedModel, problem: ControlProblem) -> SX:
    """In the order of `measures_of`: of states, controls and parameters."""
    from casadi import vertcat

    standing = model.standing
    energy = standing.energy + standing.normal_energy
    seen: SX = vertcat(
        standing.strap, problem.system.u[standing.count + KNEE], energy, standing.shear, *standing.elsewhere.values()
    )
    return seen


def _at_places(
    model: AssistedModel, problem: ControlProblem, found: CollocationResult, k: int, places: int
) -> tuple[Float[np.ndarray, "k t"], Float[np.ndarray, "s d"]]:
    """Values at the places of all intervals of a trial, and the weights of an interval's controls at its places."""
    from casadi import Function

    system, motion = problem.system, found.motions[k]
    where = np.unique(np.r_[np.linspace(0.0, 1.0, places), motion.scheme.points])
    of_controls = motion.scheme.of_controls(where)
    x = np.einsum("sd,mdx->msx", motion.scheme.of_states(where), motion.states).reshape(-1, motion.states.shape[2])
    u = np.einsum("sd,mdu->msu", of_controls, motion.controls).reshape(-1, motion.controls.shape[2])
    at = Function("at", [system.x, system.u, system.p], [_outputs(model, problem)]).map(len(x))
    return at(x.T, u.T, np.tile(found.p[:, None], (1, len(x)))).full(), of_controls


def _knee_slopes(
    model: AssistedModel, controls: Float[np.ndarray, "p m d u"], weights: Float[np.ndarray, "s d"]
) -> Float[np.ndarray, "t p"]:
    """The knee's torque is a control itself, so that its derivatives are those of the controls, at all places."""
    along = np.einsum("sd,pmd->msp", weights, controls[:, :, :, model.standing.count + KNEE])
    return np.asarray(along.reshape(-1, len(controls)))


Vector = Float[np.ndarray, " p"]


class StoppedByHandError(ArithmeticError):
    """Ctrl-C came while a movement was sought."""


@dataclass(frozen=True, eq=False)
class Movement:
    """The movement of all trials with one set of parameters; `sizes` are those of the problem's cost."""

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
