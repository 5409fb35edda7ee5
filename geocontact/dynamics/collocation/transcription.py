"""A control problem on a mesh: its variables, their places and sizes, and the blocks that it is made of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.dynamics.collocation.blocks import BlockFunctions, ProgramBlock, block_functions
from geocontact.dynamics.collocation.motion import CollocatedMotion, Scheme
from geocontact.dynamics.collocation.problem import ControlledTrial, ControlProblem, Course
from geocontact.dynamics.symbols import residual, scaled

if TYPE_CHECKING:
    from casadi import SX

Vector = Float[np.ndarray, " _"]
Mesh = Float[np.ndarray, " _"]
"""Where intervals end, as parts of a trial's duration, from 0 to 1."""


@dataclass(frozen=True)
class Scales:
    """What counts as 1: of states, controls, parameters and the rows of the path."""

    x: Vector
    u: Vector
    p: Vector
    path: Vector


def scales_from(problem: ControlProblem) -> Scales:
    """Scales that the problem has, else from its data.

    From data: the largest size in the courses where the search starts, 1 where all is 0; of a parameter its start.
    """

    def largest(of: list[Float[np.ndarray, "t n"]]) -> Vector:
        size: Vector = np.abs(np.concatenate(of)).max(axis=0)
        return np.where(size > 0.0, size, 1.0)

    at = [t.begin + np.linspace(0.0, t.guessed_duration, 50) for t in problem.trials]
    rows = problem.system.path.numel()
    path = np.ones(rows) if problem.scale_path is None else problem.scale_path
    return Scales(
        largest([t.guess_x(time) for t, time in zip(problem.trials, at, strict=True)])
        if problem.scale_x is None
        else problem.scale_x,
        largest([t.guess_u(time) for t, time in zip(problem.trials, at, strict=True)])
        if problem.scale_u is None
        else problem.scale_u,
        largest([problem.guess_p[None]]),
        path,
    )


class Transcription:
    """Variables are the parameters, then for each trial its duration, and the states and controls in order of time.

    Parameters
    ----------
    problem, scheme
        What is sought, and with which points.
    meshes
        One for each trial.
    scales
        Variables and constraints are divided by these.
    by_all
        Whether blocks are derived also by parameters and durations whose bounds are equal: no search needs that.
    """

    def __init__(
        self, problem: ControlProblem, scheme: Scheme, meshes: tuple[Mesh, ...], scales: Scales, *, by_all: bool = False
    ) -> None:
        self.problem, self.scheme, self.meshes, self.scales = problem, scheme, meshes, scales
        given = all(trial.duration[0] == trial.duration[1] for trial in problem.trials)
        self.held = np.r_[problem.p[0] == problem.p[1], given] & (not by_all)
        s = problem.system
        self.nx, self.nu, self.np = s.x.numel(), s.u.numel(), s.p.numel()
        self.stride = self.nx + scheme.degree * (self.nx + self.nu)
        counts = [1 + self.stride * (len(mesh) - 1) + self.nx for mesh in meshes]
        self.first = self.np + np.cumsum([0, *counts])
        self.size = int(self.first[-1])
        step = np.concatenate([scales.x, np.tile(np.r_[scales.x, scales.u], scheme.degree)])
        parts = [np.r_[1.0, np.tile(step, len(mesh) - 1), scales.x] for mesh in meshes]
        self.scale = np.concatenate([scales.p, *parts])

    def blocks(self) -> list[ProgramBlock]:
        """Intervals, starts, ends and the prior."""
        blocks = [self._intervals()]
        if self.problem.system.path_at_start:
            blocks.append(self._starts())
        ends = np.array([[self.first[k], *range(self.first[k + 1] - self.nx, self.first[k + 1])] for k in self._trials])
        index, none = np.vstack([self._parameters(len(ends)), ends.T]), np.zeros(0)
        made = self._functions("ends", self._ends)
        return [*blocks, ProgramBlock(made, index, np.zeros((0, len(ends))), none, none)]

    def bounds(self) -> tuple[Vector, Vector]:
        """Least and greatest of the scaled variables."""
        both = []
        for side in (0, 1):
            parts = [self.problem.p[side]]
            pick = np.minimum if side else np.maximum
            for trial, mesh in zip(self.problem.trials, self.meshes, strict=True):
                step = np.concatenate([trial.x[side], np.tile(np.r_[trial.x[side], trial.u[side]], self.scheme.degree)])
                states = np.r_[np.tile(step, len(mesh) - 1), trial.x[side]]
                states[: self.nx] = pick(states[: self.nx], trial.start[side])
                states[-self.nx :] = pick(states[-self.nx :], trial.end[side])
                parts.append(np.r_[trial.duration[side], states])
            both.append(np.concatenate(parts) / self.scale)
        return both[0], both[1]

    def guess(self) -> Vector:
        """Scaled variables where the problem says that the search starts."""
        trials = self.problem.trials
        return self.packed(
            self.problem.guess_p,
            [t.guessed_duration for t in trials],
            [t.guess_x for t in trials],
            [t.guess_u for t in trials],
        )

    def packed(self, p: Vector, durations: list[float], x: list[Course], u: list[Course]) -> Vector:
        """Scaled variables of parameters, durations and courses."""
        parts = [p]
        for trial, mesh, duration, of_x, of_u in zip(self.problem.trials, self.meshes, durations, x, u, strict=True):
            points, nodes = trial.begin + duration * self._points(mesh), trial.begin + duration * mesh
            states = of_x(points.ravel()).reshape(*points.shape, self.nx)
            controls = of_u(points.ravel()).reshape(*points.shape, self.nu)
            at_nodes = of_x(nodes)
            inner = np.concatenate([states, controls], axis=2).reshape(len(points), -1)
            parts.append(np.r_[duration, np.hstack([at_nodes[:-1], inner]).ravel(), at_nodes[-1]])
        return np.asarray(np.concatenate(parts) / self.scale)

    def resampled(self, p: Vector, motions: Sequence[CollocatedMotion]) -> Vector:
        """Scaled variables of motions on other meshes."""
        durations = [float(m.breaks[-1] - m.breaks[0]) for m in motions]
        return self.packed(p, durations, [m.state for m in motions], [m.control for m in motions])

    def again(self, p: Vector, motions: Sequence[CollocatedMotion]) -> Vector:
        """Scaled variables of what `unpacked` gave on the same meshes.

        As courses, Radau's last point of an interval would have the control of the next one.
        """
        parts = [p]
        for motion in motions:
            inner = np.concatenate([motion.states[:, 1:], motion.controls], axis=2).reshape(len(motion.states), -1)
            steps = np.hstack([motion.states[:, 0], inner]).ravel()
            parts.append(np.r_[motion.breaks[-1] - motion.breaks[0], steps, motion.end])
        return np.asarray(np.concatenate(parts) / self.scale)

    def unpacked(self, z: Vector) -> tuple[Vector, tuple[CollocatedMotion, ...]]:
        """Parameters and motions."""
        values, d = z * self.scale, self.scheme.degree
        motions = []
        for k, trial in enumerate(self.problem.trials):
            own = values[self.first[k] : self.first[k + 1]]
            steps = own[1 : -self.nx].reshape(-1, self.stride)
            inner = steps[:, self.nx :].reshape(len(steps), d, self.nx + self.nu)
            states = np.concatenate([steps[:, None, : self.nx], inner[:, :, : self.nx]], axis=1)
            breaks = trial.begin + own[0] * self.meshes[k]
            motions.append(
                CollocatedMotion(trial.name, self.scheme, breaks, states, inner[:, :, self.nx :], own[-self.nx :])
            )
        return values[: self.np], tuple(motions)

    @property
    def _trials(self) -> range:
        return range(len(self.problem.trials))

    def _points(self, mesh: Mesh) -> Float[np.ndarray, "m d"]:
        points: Float[np.ndarray, "m d"] = mesh[:-1, None] + np.diff(mesh)[:, None] * self.scheme.points
        return points

    def _parameters(self, places: int) -> Int[np.ndarray, "p m"]:
        return np.tile(np.arange(self.np)[:, None], (1, places))

    def _symbols(self, parts: int) -> tuple[SX, list[SX]]:
        """Scaled variables of a block, and the true values that they stand for."""
        from casadi import SX, vertcat

        inner = np.tile(np.r_[self.scales.x, self.scales.u], self.scheme.degree)
        order = [self.scales.p, np.ones(1), self.scales.x, inner, self.scales.x][:parts]
        local = [SX.sym(f"v{k}", len(scale)) for k, scale in enumerate(order)]
        return vertcat(*local), [v * SX(s) if len(s) else v for v, s in zip(local, order, strict=True)]

    def _of(self, symbols: list[SX], values: list[SX], expression: SX) -> SX:
        from casadi import Function

        function = Function("f", symbols, [expression], {"allow_free": False})
        result: SX = function(*values)
        return result

    def _functions(self, of: str, make: Callable[[], tuple[SX, SX, SX, SX]]) -> BlockFunctions:
        """Functions of a block, derived once for the problem, its points and scales.

        They are the same on all meshes, and to derive them takes as long as several iterations.
        """
        sizes = (each.tobytes() for each in (self.scales.x, self.scales.u, self.scales.p, self.scales.path, self.held))
        key, known = (of, self.scheme.kind, self.scheme.degree, *sizes), self.problem.derived
        if key not in known:
            variables, data, cost, constraints = make()
            held = np.r_[self.held, np.zeros(variables.numel() - len(self.held), bool)]
            known[key] = block_functions(variables, data, cost, constraints, held)
        return known[key]

    def _ends(self) -> tuple[SX, SX, SX, SX]:
        from casadi import SX

        s = self.problem.system
        local, (p, duration, x) = self._symbols(3)
        cost = self._of([s.p, s.duration, s.x], [p, duration, x], s.end_cost)
        cost = cost + self._of([s.p], [p], s.prior) / len(self._trials)
        return local, SX.sym("none", 0), cost, SX(0, 1)

    def _interval(self) -> tuple[SX, SX, SX, SX]:
        from casadi import SX, horzcat, mtimes, vertcat

        s, d, c = self.problem.system, self.scheme.degree, self.scheme
        local, (p, duration, x0, inner, x1) = self._symbols(5)
        nw = s.w.numel()
        data = SX.sym("data", d * nw + 1)
        length = duration * data[d * nw]
        at = inner.reshape((self.nx + self.nu, d))
        x, u = at[: self.nx, :], at[self.nx :, :]
        every = horzcat(x0, x)
        cost, pieces = SX(0), []
        for j in range(d):
            given = [x[:, j], u[:, j], data[j * nw : (j + 1) * nw, :], p]
            symbols = [s.x, s.u, s.w, s.p]
            slope = mtimes(every, SX(c.derivative[j]))
            pieces.append(residual(slope, length * self._of(symbols, given, s.rate), self.scales.x))
            pieces.append(scaled(self._of(symbols, given, s.path), self.scales.path))
            cost = cost + length * c.weights[j] * self._of(symbols, given, s.cost)
        pieces.append(residual(mtimes(every, SX(c.of_states(np.ones(1))[0])), x1, self.scales.x))
        return local, data, cost, vertcat(*pieces)

    def _intervals(self) -> ProgramBlock:
        made = self._functions("interval", self._interval)
        index, values = [], []
        for k, (trial, mesh) in enumerate(zip(self.problem.trials, self.meshes, strict=True)):
            begin = self.first[k] + 1 + self.stride * np.arange(len(mesh) - 1)
            own = np.vstack([np.full(len(begin), self.first[k]), begin + np.arange(self.stride + self.nx)[:, None]])
            index.append(np.vstack([self._parameters(len(begin)), own]))
            points = self._points(mesh)
            w = self._inputs(trial, points.ravel()).reshape(len(points), -1)
            values.append(np.vstack([w.T, np.diff(mesh)]))
        zero = np.zeros(made.rows)
        return ProgramBlock(made, np.hstack(index), np.hstack(values), zero, zero)

    def _start(self) -> tuple[SX, SX, SX, SX]:
        from casadi import SX, mtimes

        s, d = self.problem.system, self.scheme.degree
        local, (p, _, x0, inner) = self._symbols(4)
        data = SX.sym("data", s.w.numel())
        u = inner.reshape((self.nx + self.nu, d))[self.nx :, :]
        at_start = mtimes(u, SX(self.scheme.of_controls(np.zeros(1))[0]))
        path = scaled(self._of([s.x, s.u, s.w, s.p], [x0, at_start, data, p], s.path), self.scales.path)
        return local, data, SX(0), path[list(s.path_at_start), :]

    def _starts(self) -> ProgramBlock:
        made = self._functions("start", self._start)
        index, values = [], []
        for k, trial in enumerate(self.problem.trials):
            own = self.first[k] + np.arange(1 + self.stride)
            index.append(np.r_[np.arange(self.np), own])
            values.append(self._inputs(trial, np.zeros(1))[0])
        zero = np.zeros(made.rows)
        return ProgramBlock(made, np.stack(index, 1), np.stack(values, 1), zero, zero)

    def _inputs(self, trial: ControlledTrial, fractions: Vector) -> Float[np.ndarray, "t w"]:
        return trial.inputs(trial.begin + trial.guessed_duration * fractions)
