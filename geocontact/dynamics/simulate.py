"""A motion from its equations: steps of a Rosenbrock method as long as their error allows; no events.

RODAS3 of Sandu, Verwer, Blom, Spee, Carmichael & Potra (1997), Benchmarking stiff ODE solvers for atmospheric chemistry
problems II: Rosenbrock solvers, Atmos Environ 31, 3459-3472; form without products of Jacobians, as in Hairer & Wanner
(1996), Solving ODEs II, sec. IV.7. Four linear systems share one matrix. Coordinates are eliminated, so that it has
the size of the rates and memories only, and rows of accelerations stay multiplied by the mass matrix.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.compiled import Buffered
from geocontact.dynamics.equations import Equations, solved
from geocontact.dynamics.recorded_inputs import RecordedInputs
from geocontact.dynamics.step_loop import TOO_SHORT, StepControl, StepLoop, step_loop
from geocontact.dynamics.symbols import entries

if TYPE_CHECKING:
    from casadi import SX, Function


ORDER = 3
GAMMA = 0.5
DRIFT = (0.5, 1.5, 0.0, 0.0)
"""What the derivative of the inputs counts in each stage."""
MEMORY = ((), (4.0,), (1.0, -1.0), (1.0, -1.0, -8.0 / 3.0))
"""What earlier stages count on the right-hand side, over the step."""


def rosenbrock_step(equations: Equations) -> Function:
    """(x, h, w, w at the end, w', p) to (x at the end, error of it, x' at the start); x = (q, u, z), h the step [s].

    The first inputs are those at the start, w' their derivative there.
    """
    from casadi import SX, Function, densify, vertcat

    e = equations
    n = e.q.numel()
    h, later, slope = SX.sym("h"), SX.sym("later", e.w.numel()), SX.sym("slope", e.w.numel())
    x = vertcat(e.q, e.u, e.z)
    parts = Function("parts", e.state, [e.mass, e.force, e.growth])
    mass, force, growth = parts(*e.state)
    start = solved(mass, force)
    rest = [(e.u, force, growth)] * 2
    linear = _Linear(e, start, mass, h, slope)
    stages: list[SX] = []
    for stage, (drift, earlier) in enumerate(zip(DRIFT, MEMORY, strict=True)):
        if stage >= 2:
            there = x + 2.0 * stages[0] + (stages[2] if stage == 3 else 0.0)
            at = _split(there, n)
            own, acting, grown = parts(*at, later, e.p)
            rest.append((at[1], mass @ solved(own, acting), grown))
        right = list(rest[stage])
        right[1] = right[1] + drift * h * linear.drift_force
        right[2] = right[2] + drift * h * linear.drift_growth
        for weight, one in zip(earlier, stages, strict=True):
            of_q, of_u, of_z = _split(one, n)
            right[0] = right[0] + weight / h * of_q
            right[1] = right[1] + weight / h * (mass @ of_u)
            right[2] = right[2] + weight / h * of_z
        stages.append(linear.solved(*right))
    found = x + 2.0 * stages[0] + stages[2] + stages[3]
    rate = vertcat(e.u, start, growth)
    given = [x, h, e.w, later, slope, e.p]
    names = ["x", "h", "w", "later", "slope", "p"]
    outputs = [densify(found), densify(stages[3]), densify(rate)]
    return Function("step", given, outputs, names, ["end", "error", "rate"])


def tangent_step(step: Function) -> Function:
    """The step's arguments and dx/dp at its start to dx/dp at its end and the derivative of x' at the start by p."""
    from casadi import SX, Function, densify, jtimes, vertcat

    given = [SX.sym(step.name_in(i), step.size1_in(i)) for i in range(step.n_in())]
    x, p = given[0], given[5]
    found, _, rate = step(*given)
    turned = SX.sym("turned", x.numel(), p.numel())
    both, seeds = vertcat(x, p), vertcat(turned, SX.eye(p.numel()))
    outputs = [densify(jtimes(found, both, seeds)), densify(jtimes(rate, both, seeds))]
    return Function("tangent", [*given, turned], outputs)


def _split(x: SX, n: int) -> tuple[SX, SX, SX]:
    """The parts of a state, or of its change, that belong to n coordinates, their rates and the memories."""
    return entries(x, slice(n)), entries(x, slice(n, 2 * n)), entries(x, slice(2 * n, None))


class _Linear:
    """(1/(h γ) - J) K = F at the start of a step, the row of the rates times the mass matrix.

    `drift_force` and `drift_growth` are what the inputs' derivative `slope` adds to force and growth per second.
    """

    def __init__(self, e: Equations, start: SX, mass: SX, h: SX, slope: SX) -> None:
        from casadi import SX, blockcat, jacobian, jtimes, substitute

        def there(of: SX, by: SX) -> SX:
            return substitute(jacobian(of, by), e.a, start)

        self.n, self.hg = e.q.numel(), GAMMA * h
        self.force_q, force_u, force_z = (there(e.balance, by) for by in (e.q, e.u, e.z))
        self.growth_q, growth_u, growth_z = (jacobian(e.growth, by) for by in (e.q, e.u, e.z))
        along = [jtimes(of, e.w, slope) for of in (e.balance, e.growth)]  # one direction, not a column for each input
        self.drift_force, self.drift_growth = substitute(along[0], e.a, start), along[1]
        rates = mass / self.hg - force_u - self.hg * self.force_q
        memories = SX.eye(e.z.numel()) / self.hg - growth_z
        matrix = blockcat([[rates, -force_z], [-growth_u - self.hg * self.growth_q, memories]])
        self.factors = _Factors(matrix)

    def solved(self, speed: SX, force: SX, growth: SX) -> SX:
        """K of the right-hand sides of coordinates, rates (times the mass matrix) and memories."""
        from casadi import vertcat

        found = self.factors.solved(
            vertcat(force + self.hg * (self.force_q @ speed), growth + self.hg * (self.growth_q @ speed))
        )
        return vertcat(self.hg * (entries(found, slice(self.n)) + speed), found)


class _Factors:
    """L U of a small matrix in symbols, without exchange of rows: for short steps it is little but the mass matrix.

    Where it fails numbers become infinite, and the step is tried again shorter.
    """

    def __init__(self, matrix: SX) -> None:
        self.rows = matrix.size1()
        self.lu = {(i, j): matrix[i, j] for i in range(self.rows) for j in range(self.rows) if _there(matrix[i, j])}
        for k in range(self.rows):
            below = [i for i in range(k + 1, self.rows) if (i, k) in self.lu]
            right = [j for j in range(k + 1, self.rows) if (k, j) in self.lu]
            for i in below:
                self.lu[i, k] = self.lu[i, k] / self.lu[k, k]
                for j in right:
                    product = self.lu[i, k] * self.lu[k, j]
                    self.lu[i, j] = self.lu[i, j] - product if (i, j) in self.lu else -product

    def solved(self, right: SX) -> SX:
        """The solution for one right-hand side."""
        from casadi import vertcat

        x = [right[i] for i in range(self.rows)]
        for i in range(self.rows):
            for j in range(i):
                if (i, j) in self.lu:
                    x[i] = x[i] - self.lu[i, j] * x[j]
        for i in reversed(range(self.rows)):
            for j in range(i + 1, self.rows):
                if (i, j) in self.lu:
                    x[i] = x[i] - self.lu[i, j] * x[j]
            x[i] = x[i] / self.lu[i, i]
        return vertcat(*x)


def _there(entry: SX) -> bool:
    return not entry.is_zero()


Vector = Float[np.ndarray, " _"]
Inputs = Callable[[float], tuple[Vector, Vector]]
"""Time [s] to the equations' inputs and their derivatives."""

SAFE, SHRINK, GROW = 0.9, 0.2, 5.0
"""Share of the step that the error allows; least and most that a step changes by."""
SMALLEST = 1e-12
"""Share of the span; a step below it means that the motion cannot go on."""


@dataclass(frozen=True)
class SimulatedMotion:
    """A motion at the times that were wanted.

    Parameters
    ----------
    time
        [s].
    names
        Coordinates that were found.
    q, u
        Values and rates [rad, m, s].
    z
        Memory of the laws.
    ends, refused
        Where the steps taken end [s], and how many were tried in vain.
    error
        Sum of the estimated errors of the steps, by coordinate [rad, m]: what the end is off by if nothing damps or
        amplifies them.
    by_parameter
        Derivatives of q, u and z, in this order, by the parameters; none unless the stepper was asked for them.
    """

    time: Float[np.ndarray, " t"]
    names: tuple[str, ...]
    q: Float[np.ndarray, "t n"]
    u: Float[np.ndarray, "t n"]
    z: Float[np.ndarray, "t k"]
    ends: Float[np.ndarray, " s"]
    refused: int
    error: Vector
    by_parameter: Float[np.ndarray, "t x p"]

    @property
    def steps(self) -> int:
        """Steps taken."""
        return len(self.ends)


class Stepper:
    """Steps of some equations.

    Parameters
    ----------
    equations
        Whose motion is sought.
    machine_code
        Whether the step is machine code, and the loop over the steps too where there is a compiler.
    by_parameter
        Whether to follow the derivatives of the motion by the parameters: those of the steps as they are taken, their
        lengths held.
    """

    def __init__(self, equations: Equations, *, machine_code: bool = True, by_parameter: bool = False) -> None:
        self.equations = equations
        step = rosenbrock_step(equations)
        self.step = Buffered(step, compiled=machine_code)
        count = len(equations.names)
        self.loop = step_loop(self.step.code, 2 * count + equations.z.numel(), count) if self.step.code else None
        self.tangent = None
        if by_parameter:
            tangent = tangent_step(step)
            self.tangent = Buffered(tangent, compiled=machine_code)

    @property
    def compiled(self) -> bool:
        """Whether the step is machine code."""
        return self.step.code is not None

    def simulate(
        self,
        start: tuple[Vector, Vector, Vector],
        time: Float[np.ndarray, " t"],
        *,
        inputs: Inputs | None = None,
        parameters: Vector | None = None,
        tolerance: float = 1e-6,
        first: float = 1e-4,
        longest: float = np.inf,
        steps: int | None = None,
    ) -> SimulatedMotion:
        """Motion from q, u, z at `time[0]` to `time[-1]`, between the steps by cubic polynomials.

        Parameters
        ----------
        inputs
            Course of the equations' inputs; `RecordedInputs`, or none, let the whole loop run in machine code.
        tolerance
            Error allowed in each step: of a coordinate [rad, m], of a rate [rad/s, m/s] and of a memory [its unit],
            plus as much of each one's size.
        first, longest
            Step tried first and longest step [s].
        steps
            So many even steps instead, whatever their error.

        ArithmeticError where the step would have to become shorter than a `SMALLEST` part of the span.
        """
        p = np.zeros(0) if parameters is None else np.asarray(parameters, float)
        _check(self.equations, time, p, inputs)
        x = np.concatenate(start).astype(float)
        control = StepControl(tolerance, first, longest, steps, SAFE, SHRINK, GROW, SMALLEST, ORDER)
        if self.loop and not self.tangent and (inputs is None or isinstance(inputs, RecordedInputs)):
            return self._looped(self.loop, x, time, inputs, p, control)
        return self._stepped(x, time, inputs or (lambda _: (np.zeros(0), np.zeros(0))), p, control)

    def _stepped(
        self, x: Vector, time: Float[np.ndarray, " t"], at: Inputs, p: Vector, control: StepControl
    ) -> SimulatedMotion:
        """The loop in Python: for inputs of any kind, for derivatives, and where there is no compiler."""
        from scipy.interpolate import CubicHermiteSpline

        steps, n = control.steps, len(self.equations.names)
        now, end = float(time[0]), float(time[-1])
        span = end - now
        h = (end - now) / steps if steps else min(control.first, control.longest, end - now)
        times, states, rates = [now], [x], []
        turn = np.zeros((len(p) if self.tangent else 0, len(x)))  # transposed: columns follow each other
        turns, turn_rates = [turn], []
        error, refused = np.zeros(n), 0
        given, slope = at(now)
        while now < end:
            h = min(h, end - now) if steps is None else h
            there = end if steps is not None and len(times) == steps else now + h
            later = at(there)
            found, off, rate = self.step(x, np.array([h]), given, later[0], slope, p)
            size = 0.0 if steps else _size(off, x, found, control.tolerance)
            if not np.isfinite(found).all():
                size = np.inf
            if size <= 1.0:
                rates.append(rate.copy())
                if self.tangent:
                    turned = self.tangent(x, np.array([h]), given, later[0], slope, p, turn)
                    turn_rates.append(turned[1].reshape(turn.shape).copy())
                    turn = turned[0].reshape(turn.shape).copy()
                    turns.append(turn)
                x, now = found.copy(), there if end - there > SMALLEST * span else end
                error += np.abs(off[:n])
                times.append(now)
                states.append(x)
                given, slope = later
            else:
                refused += 1
            if steps is None:
                allowed = SAFE * size ** (-1.0 / ORDER) if size > 0.0 else GROW
                h = min(h * min(max(allowed, SHRINK), GROW), control.longest)
            if h < SMALLEST * span or (steps and size > 1.0):
                raise ArithmeticError(f"no step is short enough at {now:g} s")
        rates.append(self.step(x, np.array([h]), given, given, slope, p)[2].copy())
        values = CubicHermiteSpline(times, np.array(states), np.array(rates))(time)
        q, u, z = values[:, :n], values[:, n : 2 * n], values[:, 2 * n :]
        if self.tangent:
            turned = self.tangent(x, np.array([h]), given, given, slope, p, turn)
            turn_rates.append(turned[1].reshape(turn.shape).copy())
            by = CubicHermiteSpline(times, np.array(turns), np.array(turn_rates))(time).swapaxes(1, 2)
        else:
            by = np.zeros((len(time), len(x), 0))
        return SimulatedMotion(time, self.equations.names, q, u, z, np.array(times[1:]), refused, error, by)

    def _looped(
        self,
        loop: StepLoop,
        x: Vector,
        time: Float[np.ndarray, " t"],
        inputs: RecordedInputs | None,
        p: Vector,
        control: StepControl,
    ) -> SimulatedMotion:
        n = len(self.equations.names)
        found = loop.run(x, time, inputs, p, control)
        if found.end == TOO_SHORT:
            raise ArithmeticError(f"no step is short enough at {found.reached:g} s")
        q, u, z = found.states[:, :n], found.states[:, n : 2 * n], found.states[:, 2 * n :]
        none = np.zeros((len(time), len(x), 0))
        return SimulatedMotion(time, self.equations.names, q, u, z, found.ends, found.refused, found.error, none)


def _check(equations: Equations, time: Vector, p: Vector, inputs: Inputs | None) -> None:
    if len(p) != equations.p.numel():
        raise ValueError(f"{len(p)} parameters given, {equations.p.numel()} needed")
    if len(time) < 2 or not time[-1] > time[0] or np.any(np.diff(time) < 0.0):
        raise ValueError("two times at least are needed, none before the one that it follows")
    if isinstance(inputs, RecordedInputs):
        _check_recorded(inputs, equations, float(time[0]), float(time[-1]))


def _check_recorded(inputs: RecordedInputs, equations: Equations, start: float, end: float) -> None:
    if inputs.count != equations.w.numel():
        raise ValueError(f"{inputs.count} inputs given, {equations.w.numel()} needed")
    first, last = inputs.breaks[[0, -1]]
    if start < first - 1e-9 or end > last + 1e-9:
        raise ValueError(f"inputs are known from {first:g} to {last:g} s, wanted from {start:g} to {end:g} s")


def _size(off: Vector, x: Vector, found: Vector, tolerance: float) -> float:
    """Largest error over what is allowed."""
    with np.errstate(invalid="ignore"):
        return float((abs(off) / (tolerance * (1.0 + np.maximum(abs(x), abs(found))))).max(initial=0.0))
