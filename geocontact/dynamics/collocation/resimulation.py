"""A collocated motion simulated forward by another method from the same equations and controls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.problem import Course
from geocontact.dynamics.recorded_inputs import RecordedInputs
from geocontact.dynamics.simulate import Stepper

Vector = Float[np.ndarray, " _"]
POWERS = 6
"""Coefficients of an interval's polynomial for a given input."""
CHANGE, COARSER = 1e-4, 1e-7
"""Change of a state whose effect is looked at, and the tolerance of a step meanwhile and over a longer window.

How it grows is then known to some thousandths, in a quarter of the time that a tolerance of 1e-9 takes."""


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
        """Derivatives of the state at each interval's end by that at its start; central differences."""
        states, breaks, tangents = self.states(), self.motion.breaks, []
        coarser = replace(self, tolerance=COARSER)
        for k, start in enumerate(states[:-1]):
            span, steps = breaks[k : k + 2], CHANGE * np.eye(len(start))
            columns = [coarser.after(start + h, span)[-1] - coarser.after(start - h, span)[-1] for h in steps]
            tangents.append(np.stack(columns, axis=1) / (2.0 * CHANGE))
        return np.array(tangents)

    def _without_acceleration(self, x: Float[np.ndarray, "t x"]) -> Float[np.ndarray, "t s"]:
        n = len(self.stepper.equations.names)
        return np.hstack([x[:, : 2 * n], x[:, 3 * n :]])


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
