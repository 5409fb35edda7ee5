"""Prescribed movements, continuous in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import InputCourse, Path

Rng = np.random.Generator
KNOTS = 0.002
"""Spacing of the nodes through which prescribed but not closed-form movements run [s]."""


@dataclass(frozen=True)
class ElbowStyle:
    """How one case moves: `kind`, pace (1 = as a slow study), amplitude, middle [rad], step [s], duration [s]."""

    kind: str
    pace: float
    swing: float
    middle: float
    step: float
    duration: float


def elbow_path(rng: Rng, style: ElbowStyle) -> Path:
    """One trial of the elbow."""
    phase = rng.uniform(0.0, 2.0 * np.pi)
    if style.kind == "reaches":
        return reaches(rng, style, phase)
    return sines(rng, style, phase)


def sines(rng: Rng, style: ElbowStyle, phase: float) -> Path:
    """Two or three sines; "sweep" lets their pace rise through the trial."""
    size = style.swing * np.array([rng.uniform(0.5, 0.63), rng.uniform(0.24, 0.4), rng.uniform(0.03, 0.1)])
    if style.kind != "three":
        size[2] = 0.0
    omega = 2.0 * np.pi * style.pace * np.array([rng.uniform(0.08, 0.14), rng.uniform(0.2, 0.33), 0.55])
    offset = rng.uniform(0.0, 2.0 * np.pi, 3)
    middle = style.middle + rng.normal(0.0, 0.03)
    chirp = 0.8 / style.duration if style.kind == "sweep" else 0.0

    def along(time: Float[np.ndarray, " t"]) -> InputCourse:
        warped, speed = time * (1.0 + 0.5 * chirp * time), 1.0 + chirp * time
        angle = omega[:, None] * warped + offset[:, None]
        turn = omega[:, None] * speed
        position = middle + size @ np.sin(angle)
        rate = size @ (np.cos(angle) * turn)
        acceleration = size @ (-np.sin(angle) * turn**2 + np.cos(angle) * omega[:, None] * chirp)
        return InputCourse(time, position[None], rate[None], acceleration[None], style.duration, phase)

    return along


def reaches(rng: Rng, style: ElbowStyle, phase: float) -> Path:
    """Minimum-jerk reaches between random angles, with holds."""
    times, places = [-1.0], [style.middle]
    while times[-1] < style.duration + 1.0:
        sign = -1.0 if places[-1] > style.middle else 1.0
        target = style.middle + sign * style.swing * rng.uniform(0.35, 0.95)
        hold = rng.uniform(0.2, 1.5) / style.pace
        move = abs(target - places[-1]) * rng.uniform(1.2, 2.0) / style.pace
        times += [times[-1] + hold, times[-1] + hold + move]
        places += [places[-1], target]
    begin, end = np.array(times), np.array(places)

    def along(time: Float[np.ndarray, " t"]) -> InputCourse:
        leg = np.clip(np.searchsorted(begin, time, side="right") - 1, 0, len(begin) - 2)
        span, size = begin[leg + 1] - begin[leg], end[leg + 1] - end[leg]
        u = (time - begin[leg]) / span
        position = end[leg] + size * u**3 * (10.0 - 15.0 * u + 6.0 * u * u)
        rate = size / span * 30.0 * u * u * (1.0 - u) ** 2
        acceleration = size / span**2 * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)
        return InputCourse(time, position[None], rate[None], acceleration[None], style.duration, phase)

    return along


def logistic(u: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """1/(1 + exp(-u))."""
    return np.asarray(0.5 * (1.0 + np.tanh(0.5 * u)))


def smoothed(
    nodes: Float[np.ndarray, " n"], values: Float[np.ndarray, " n"], at: Float[np.ndarray, " t"], width: float
) -> Float[np.ndarray, " t"]:
    """Polyline with its corners rounded: the mean of it over a bell of `width`."""
    bell = np.linspace(-2.5, 2.5, 21)
    weight = np.exp(-0.5 * bell**2)
    lines = np.interp(at[:, None] + width * bell, nodes, values)
    return np.asarray(lines @ weight / weight.sum())
