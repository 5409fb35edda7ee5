"""Collocation points of one interval, and the motion that collocation gives: polynomials, interval by interval.

States are polynomials of degree d through the interval's start and its d points, controls of degree d - 1 through the
points. Radau's points (IIA) end with the interval and leave its start out; Legendre's leave out both ends. At the
nodes the error falls with the power 2 d - 1 and 2 d of the interval (Hairer & Wanner (1996), Solving ODEs II, IV.5).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.dynamics.recorded_inputs import RecordedInputs

Matrix = Float[np.ndarray, "_ _"]
KINDS = ("radau", "legendre")


@dataclass(frozen=True)
class Scheme:
    """Points of the unit interval.

    Parameters
    ----------
    kind
        radau or legendre.
    points
        In (0, 1], d of them.
    derivative
        Of the state's polynomial at the points, per length of the interval, of its values at 0 and the points.
    weights
        Of the points in the integral over the interval.
    """

    kind: str
    points: Float[np.ndarray, " d"]
    derivative: Float[np.ndarray, "d d1"]
    weights: Float[np.ndarray, " d"]

    @property
    def degree(self) -> int:
        """Number of points."""
        return len(self.points)

    def of_states(self, where: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s d1"]:
        """Weights of the values at 0 and the points in the state at some places of the interval."""
        return _lagrange(np.r_[0.0, self.points], where)

    def of_controls(self, where: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s d"]:
        """Weights of the values at the points in a control there."""
        return _lagrange(self.points, where)

    def of_rates(self, where: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s d1"]:
        """Weights in the state's derivative there, per length of the interval: it has the controls' degree."""
        weights: Matrix = self.of_controls(where) @ self.derivative
        return weights


def scheme(kind: str, degree: int) -> Scheme:
    """Radau or Legendre points, 1 to 9 of them. ValueError for others."""
    from casadi import collocation_points

    if kind not in KINDS or not 1 <= degree <= 9:
        raise ValueError(f"collocation is {' or '.join(KINDS)} of degree 1 to 9, not {kind} of degree {degree}")
    points = np.array(collocation_points(degree, kind))
    nodes = np.r_[0.0, points]
    powers = np.arange(degree + 1)
    values = np.vander(nodes, increasing=True)
    slopes = np.where(powers > 0, powers * points[:, None] ** np.maximum(powers - 1, 0), 0.0)
    derivative = np.linalg.solve(values.T, slopes.T).T
    weights = np.linalg.solve(np.vander(points, increasing=True).T, 1.0 / (powers[:-1] + 1.0))
    return Scheme(kind, points, derivative, weights)


def _lagrange(nodes: Float[np.ndarray, " n"], where: Float[np.ndarray, " s"]) -> Float[np.ndarray, "s n"]:
    columns = []
    for i, node in enumerate(nodes):
        others = np.delete(nodes, i)
        columns.append(np.prod((where[:, None] - others) / (node - others), axis=1))
    return np.stack(columns, axis=1)


Times = Float[np.ndarray, " t"]


@dataclass(frozen=True, eq=False)
class MotionSamples:
    """States, their derivatives in time and controls at some times [s]; a time may stand there twice."""

    time: Times
    state: Float[np.ndarray, "t x"]
    rate: Float[np.ndarray, "t x"]
    control: Float[np.ndarray, "t u"]


@dataclass(frozen=True)
class CollocatedMotion:
    """States and controls of one trial.

    Parameters
    ----------
    name
        Of the trial.
    scheme
        Its points.
    breaks
        Where intervals begin and end [s].
    states
        At the start and the points of each interval.
    controls
        At the points of each interval.
    end
        Last state.
    """

    name: str
    scheme: Scheme
    breaks: Float[np.ndarray, " m1"]
    states: Float[np.ndarray, "m d1 x"]
    controls: Float[np.ndarray, "m d u"]
    end: Float[np.ndarray, " x"]

    @property
    def nodes(self) -> Float[np.ndarray, "m1 x"]:
        """States where intervals begin, and the last."""
        return np.vstack([self.states[:, 0], self.end])

    def sampled(self, each: int) -> MotionSamples:
        """At so many even places of every interval from its start to its end, all by the interval's own polynomials.

        Where two intervals meet both answer: Radau's points leave the start out, so that controls and the derivative of
        the state there are only continued.
        """
        where, lengths = np.linspace(0.0, 1.0, each), np.diff(self.breaks)
        state, rate, control = (
            np.einsum("ts,msx->mtx", weights, values)
            for weights, values in (
                (self.scheme.of_states(where), self.states),
                (self.scheme.of_rates(where), self.states / lengths[:, None, None]),
                (self.scheme.of_controls(where), self.controls),
            )
        )
        times = (self.breaks[:-1, None] + lengths[:, None] * where).ravel()
        return MotionSamples(times, *(of.reshape(len(times), -1) for of in (state, rate, control)))

    @property
    def held_times(self) -> Float[np.ndarray, " t"]:
        """The start, the points inside of intervals, and the end: where the equations hold and one interval answers.

        A point that ends its interval is left out: there the controls of the next one begin. The end holds them with
        Radau's points; so does the start where the problem's `path_at_start` asks for it.
        """
        inside = self.scheme.points[self.scheme.points < 1.0]
        points = (self.breaks[:-1, None] + np.diff(self.breaks)[:, None] * inside).ravel()
        return np.asarray(np.r_[self.breaks[0], points, self.breaks[-1]])

    def state(self, time: Times) -> Float[np.ndarray, "t x"]:
        """At any times."""
        piece, where, _ = self._places(time)
        return np.asarray(np.einsum("ts,tsx->tx", self.scheme.of_states(where), self.states[piece]))

    def rate(self, time: Times) -> Float[np.ndarray, "t x"]:
        """Derivative of the states' polynomials in time."""
        piece, where, length = self._places(time)
        return np.asarray(np.einsum("ts,tsx->tx", self.scheme.of_rates(where), self.states[piece]) / length[:, None])

    def control(self, time: Times) -> Float[np.ndarray, "t u"]:
        """At any times."""
        piece, where, _ = self._places(time)
        return np.asarray(np.einsum("ts,tsu->tu", self.scheme.of_controls(where), self.controls[piece]))

    def as_inputs(self, which: slice) -> RecordedInputs:
        """Some of the controls as inputs of equations: the same polynomials."""
        powers = np.arange(self.scheme.degree)[::-1]
        to_powers = np.linalg.inv(self.scheme.points[:, None] ** powers)
        lengths = np.diff(self.breaks)[:, None] ** powers
        coefficients = np.einsum("kd,mdu->muk", to_powers, self.controls[:, :, which]) / lengths[:, None]
        return RecordedInputs(self.breaks, coefficients)

    def _places(self, time: Times) -> tuple[Int[np.ndarray, " t"], Times, Times]:
        piece = np.clip(np.searchsorted(self.breaks, time, "right") - 1, 0, len(self.states) - 1)
        length = np.diff(self.breaks)[piece]
        return piece, (time - self.breaks[piece]) / length, length
