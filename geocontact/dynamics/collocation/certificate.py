"""What a solution is worth between and beyond its points: residual, forward simulation, certificate.

A small residual at the points says nothing of the polynomials between them. So the equations are evaluated on a five
times finer grid with both ends of every interval, at the start of which Radau's points leave most, and another method
of integration follows the same controls: from every node over one interval and over a longer window, and once from the
start to the end. That last run departs even from an exact solution where the motion is unstable (in standing up a
deviation grows by up to 4e8 in 1.5 s), so it is judged by what the errors of the intervals become on their way to the
end at most.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion, MotionSamples
from geocontact.dynamics.collocation.problem import ControlledSystem, ControlledTrial, Course
from geocontact.dynamics.recorded_inputs import RecordedInputs
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.variation import Variation, nodes_of

Vector = Float[np.ndarray, " _"]


def residuals(
    system: ControlledSystem, trial: ControlledTrial, at: MotionSamples, p: Vector
) -> tuple[Float[np.ndarray, "t x"], Float[np.ndarray, "t h"]]:
    """x' - rate, and the path, in their own units."""
    from casadi import Function

    both = Function("both", [system.x, system.u, system.w, system.p], [system.rate, system.path]).map(len(at.time))
    given = (at.state.T, at.control.T, trial.inputs(at.time).T, np.tile(p[:, None], (1, len(at.time))))
    rate, path = (np.array(each.full()) for each in both(*given))
    return at.rate - rate.T, path.T


def interval_residuals(
    system: ControlledSystem,
    trial: ControlledTrial,
    motion: CollocatedMotion,
    p: Vector,
    scale_x: Vector,
    scale_path: Vector,
) -> Vector:
    """Largest scaled residual of each interval, its ends too: of the states over its length, and of the path."""
    each = 5 * motion.scheme.degree + 1
    rate, path = residuals(system, trial, motion.sampled(each), p)
    lengths = np.repeat(np.diff(motion.breaks), each)[:, None]
    scaled = np.hstack([np.abs(rate) * lengths / scale_x, np.abs(path) / scale_path])
    largest: Vector = scaled.max(axis=1).reshape(-1, each).max(axis=1)
    return largest


POWERS = 6
"""Coefficients of an interval's polynomial for a given input."""
COARSER = 1e-7
"""Tolerance of a step over a longer window; at 1e-6 its end was off by up to 5e-5 rad, of 1e-2 that pass."""
FOLLOWED = 32
"""Steps of the variational equations in an interval: in standing up the growth is then known to 1e-4."""


@dataclass(frozen=True)
class Resimulation:
    """The stepper, the inputs and the parameters of one motion.

    Parameters
    ----------
    stepper
        Of the equations that the motion is to obey.
    motion
        Found by collocation; its states are q, u, a, z.
    inputs
        Of the equations.
    p
        Parameters.
    tolerance
        Of a step.
    """

    stepper: Stepper
    motion: CollocatedMotion
    inputs: RecordedInputs
    p: Vector
    tolerance: float = 1e-9

    def states(self) -> Float[np.ndarray, "m1 s"]:
        """Coordinates, rates and memory at the nodes: accelerations follow from them."""
        return self._without_acceleration(self.motion.nodes)

    def known(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t s"]:
        """The collocated motion's at any times."""
        return self._without_acceleration(self.motion.state(time))

    def after(self, start: Vector, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t s"]:
        """States simulated from one at `time[0]`; infinite where the motion cannot go on."""
        n = len(self.stepper.equations.names)
        parts = start[:n], start[n : 2 * n], start[2 * n :]
        try:
            found = self.stepper.simulate(
                parts, time, inputs=self.inputs, parameters=self.p, tolerance=self.tolerance, first=1e-4
            )
        except ArithmeticError:
            return np.full((len(time), len(start)), np.inf)
        return np.hstack([found.q, found.u, found.z])

    def tangents(self) -> Float[np.ndarray, "m s s"]:
        """Derivatives of the state at each interval's end by that at its start: variational equations along the motion.

        In `FOLLOWED` steps each. Differences of simulations from states 1e-4 apart take fifteen times as long.
        """
        breaks, lengths = self.motion.breaks, np.diff(self.motion.breaks)
        starts = breaks[:-1, None] + lengths[:, None] * np.arange(FOLLOWED) / FOLLOWED
        times = np.r_[starts.ravel(), breaks[-1]]
        nodes = nodes_of(times)
        w = _within(self.inputs.coefficients, nodes.reshape(len(lengths), -1) - breaks[:-1, None])
        variation = Variation(self.stepper.equations, (), machine_code=self.stepper.compiled)
        each = variation.tangents(times, self.known(nodes), w, self.p)
        found, *others = each.reshape(len(lengths), FOLLOWED, *each.shape[1:]).swapaxes(0, 1)
        for one in others:
            found = one @ found
        return np.asarray(found)

    def _without_acceleration(self, x: Float[np.ndarray, "t x"]) -> Float[np.ndarray, "t s"]:
        n = len(self.stepper.equations.names)
        return np.hstack([x[:, : 2 * n], x[:, 3 * n :]])


def _within(coefficients: Float[np.ndarray, "m n k"], since: Float[np.ndarray, "m s"]) -> Float[np.ndarray, "ms n"]:
    """Inputs at times since the start of each piece, its own polynomials at its end too, where controls jump."""
    value = np.zeros((*since.shape, coefficients.shape[1]))
    for coefficient in np.moveaxis(coefficients, 2, 0):
        value = value * since[..., None] + coefficient[:, None, :]
    return value.reshape(-1, coefficients.shape[1])


def resimulation(
    stepper: Stepper, motion: CollocatedMotion, p: Vector, given: Course, controlled: Sequence[int] = ()
) -> Resimulation:
    """Put the equations' inputs together from the controls and from what was given over time.

    Parameters
    ----------
    given
        Of a trial; the equations' own inputs come first. Taken as polynomials of degree 5 in each interval.
    controlled
        Which of the equations' inputs are the motion's controls after the jerks.
    """
    e = stepper.equations
    count = e.w.numel()
    own = [k for k in range(count) if k not in controlled]
    powers = max(POWERS, motion.scheme.degree)
    coefficients = np.zeros((len(motion.states), count, powers))
    if own:
        coefficients[:, own, powers - POWERS :] = _polynomials(given, motion.breaks)[:, : len(own)]
    if len(controlled):
        sought = motion.as_inputs(slice(len(e.names), None)).coefficients
        coefficients[:, list(controlled), powers - sought.shape[2] :] = sought
    return Resimulation(stepper, motion, RecordedInputs(motion.breaks, coefficients), p)


def _polynomials(course: Course, breaks: Vector) -> Float[np.ndarray, "m n k"]:
    """Through Chebyshev's points of each interval, in powers of the time since its start."""
    k = np.arange(POWERS)
    points = 0.5 - 0.5 * np.cos((k + 0.5) * np.pi / POWERS)
    lengths = np.diff(breaks)
    values = course((breaks[:-1, None] + lengths[:, None] * points).ravel()).reshape(len(lengths), POWERS, -1)
    fall = k[::-1]
    inverse = np.linalg.inv(points[:, None] ** fall)
    found: Float[np.ndarray, "m n k"] = np.einsum("kd,mdn->mnk", inverse, values)
    return np.asarray(found / (lengths[:, None] ** fall)[:, None, :])


FINER, LEAST = 5, 101
"""Places for each point of an interval, and of a motion at least."""
MARGIN = 3.0
"""Times the bound of the open-loop error that is let pass: the bound is of first order only."""


@dataclass(frozen=True)
class CertificateLimits:
    """What passes.

    Parameters
    ----------
    force, moment
        Residual between the points [N], [N m].
    interval, window
        Departure of a coordinate after one interval and after the window [rad, m].
    seconds
        The window.
    """

    force: float = 5.0
    moment: float = 1.0
    interval: float = 1e-3
    window: float = 1e-2
    seconds: float = 0.2


@dataclass(frozen=True)
class Certificate:
    """Certificate of one trial's motion.

    Parameters
    ----------
    converged
        Whether all of it passes.
    failed
        What does not, in words.
    force, moment
        Largest residual on the finer grid [N], [N m]; the acceleration taken as the state's and as the derivative of
        the rate's polynomial, whichever is worse.
    interval, window, open_loop
        Largest departure of a coordinate from the simulation [rad, m].
    bound
        Largest departure of the open loop to first order: sizes of the intervals' departures, each grown on its way to
        the end, added up [rad, m]. Where their signs differ the departure is several times smaller.
    growth, growth_rate
        Of the deviation (rad, m and per second, memory in its unit) that grows most from start to end: factor, and its
        logarithm over the time [1/s].
    intervals, shortest
        How many there are, and the length of the shortest [s].
    """

    converged: bool
    failed: tuple[str, ...]
    force: float
    moment: float
    interval: float
    window: float
    open_loop: float
    bound: float
    growth: float
    growth_rate: float
    intervals: int
    shortest: float


def certificate(
    solved: bool,
    system: ControlledSystem,
    trial: ControlledTrial,
    again: Resimulation,
    turning: Sequence[bool],
    limits: CertificateLimits | None = None,
    left: FineResidual | None = None,
) -> Certificate:
    """Judge one trial of a jerk-controlled system.

    Parameters
    ----------
    solved
        Whether the solver met its tolerance.
    turning
        Of each coordinate: whether it is an angle, so that its balance is in N m.
    left
        `fine_residual` of the motion, where it is known.
    """
    limit = limits or CertificateLimits()
    left = left or fine_residual(system, trial, again.motion, again.p, turning)
    force, moment = float(left.force.max()), float(left.moment.max())
    n = len(again.stepper.equations.names)
    ends, known = _after_intervals(again), again.states()
    off = ends - known[1:]
    interval = float(np.abs(off[:, :n]).max())
    window = _window(again, limit.seconds, n)
    begin, end = again.motion.breaks[[0, -1]]
    run = again.after(known[0], again.motion.breaks)
    open_loop = float(np.abs(run[-1, :n] - known[-1, :n]).max())
    bound, growth = _grown(off, again.tangents(), n)
    checks = {
        "the solver did not meet its tolerance": solved,
        f"residual between the points {force:.3g} N": force <= limit.force,
        f"residual between the points {moment:.3g} N m": moment <= limit.moment,
        f"departure after one interval {interval:.3g} rad or m": interval <= limit.interval,
        f"departure after {limit.seconds:g} s {window:.3g} rad or m": window <= limit.window,
        f"open loop {open_loop:.3g}, bound {bound:.3g} rad or m": open_loop <= MARGIN * bound + limit.interval,
    }
    failed = tuple(words for words, passed in checks.items() if not passed)
    rate = float(np.log(growth) / (end - begin))
    sizes = force, moment, interval, window, open_loop, bound, growth, rate
    lengths = np.diff(again.motion.breaks)
    return Certificate(not failed, failed, *sizes, len(lengths), float(lengths.min()))


@dataclass(frozen=True, eq=False)
class FineResidual:
    """What is left of the balance, interval by interval, the same number of times in each.

    Parameters
    ----------
    time
        Both ends of every interval among them [s].
    force, moment
        Largest of the coordinates that move [N] and that turn [N m].
    """

    time: Float[np.ndarray, " t"]
    force: Float[np.ndarray, " t"]
    moment: Float[np.ndarray, " t"]


def fine_residual(
    system: ControlledSystem,
    trial: ControlledTrial,
    motion: CollocatedMotion,
    p: Float[np.ndarray, " p"],
    turning: Sequence[bool],
) -> FineResidual:
    """Residual of a jerk-controlled system, with the acceleration as the state has it and as the derivative of the
    rate's polynomial, whichever leaves more.
    """
    from casadi import Function

    n, turns = len(turning), np.array(turning, bool)
    at = motion.sampled(max(FINER * motion.scheme.degree + 1, -(-LEAST // len(motion.states))))
    _, path = residuals(system, trial, at, p)
    x = at.state.copy()
    x[:, 2 * n : 3 * n] = at.rate[:, n : 2 * n]
    balance = Function("balance", [system.x, system.u, system.w, system.p], [system.path]).map(len(x))
    given = (x.T, at.control.T, trial.inputs(at.time).T, np.tile(p[:, None], (1, len(x))))
    left = np.maximum(np.abs(path), np.abs(balance(*given).full().T))
    force, moment = (left[:, which].max(axis=1, initial=0.0) for which in (~turns, turns))
    return FineResidual(at.time, force, moment)


def _after_intervals(again: Resimulation) -> Float[np.ndarray, "m s"]:
    breaks = again.motion.breaks
    starts = again.states()[:-1]
    return np.array([again.after(start, breaks[k : k + 2])[-1] for k, start in enumerate(starts)])


def _window(again: Resimulation, seconds: float, n: int) -> float:
    """Largest departure of a coordinate over so many seconds from any node; steps are far finer than what passes."""
    breaks, largest, coarser = again.motion.breaks, 0.0, replace(again, tolerance=COARSER)
    for begin, start in zip(breaks[:-1], again.states()[:-1], strict=True):
        time = np.linspace(begin, min(begin + seconds, breaks[-1]), 21)
        largest = max(largest, float(np.abs(coarser.after(start, time) - again.known(time))[:, :n].max()))
    return largest


def _grown(off: Float[np.ndarray, "m s"], tangents: Float[np.ndarray, "m s s"], n: int) -> tuple[float, float]:
    """Departures carried to the end and summed by size [rad, m], and the largest growth of any deviation."""
    to_end, total = np.eye(off.shape[1]), np.zeros(off.shape[1])
    for departure, tangent in zip(off[::-1], tangents[::-1], strict=True):
        total += np.abs(to_end @ departure)
        to_end = to_end @ tangent
    return float(total[:n].max()), float(np.linalg.norm(to_end, 2))
