"""A motion from its equations: steps of a Rosenbrock method as long as their error allows; no events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.compiled import Buffered
from geocontact.dynamics.equations import Equations
from geocontact.dynamics.recorded_inputs import RecordedInputs
from geocontact.dynamics.rosenbrock import ORDER, rosenbrock_step, step_recipe, tangent_step
from geocontact.dynamics.step_loop import TOO_SHORT, StepControl, StepLoop, step_loop

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
        self.step = Buffered(step_recipe(equations), compiled=machine_code)
        count = len(equations.names)
        self.loop = step_loop(self.step.code, 2 * count + equations.z.numel(), count) if self.step.code else None
        self.tangent = None
        if by_parameter:
            tangent = tangent_step(rosenbrock_step(equations))
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
