"""Prescribed movements, continuous in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from geocontact.gap_benchmark.synthetic.course import InputCourse, Path, through
from geocontact.gap_benchmark.synthetic.systems.foot.model import Sole

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


@dataclass(frozen=True)
class FootStyle:
    """How one case walks: stance time [s], depths of the load's humps [m], pitch at both ends [rad], slide [m/s]."""

    stance: float
    heel: float
    middle: float
    toe: float
    strike: float
    push: float
    slide: float
    step: float


def foot_path(rng: Rng, style: FootStyle, sole: Sole) -> Path:
    """One stance: pitch falls, stays flat and leaves over the toe; depth has two humps; the loaded sphere creeps."""
    stance = style.stance * float(np.exp(rng.normal(0.0, 0.05)))
    strike = style.strike + rng.normal(0.0, 0.015)
    push = style.push + rng.normal(0.0, 0.03)
    flat, leave = 0.145 + rng.normal(0.0, 0.006), 0.80 + rng.normal(0.0, 0.01)
    humps = np.array([style.heel, style.middle, style.toe]) * np.exp(rng.normal(0.0, 0.02, 3))
    slide = style.slide * np.exp(rng.normal(0.0, 0.08, 2))
    time = np.arange(-0.1, stance + 0.1 + KNOTS, KNOTS)
    phase = time / stance
    pitch = strike * logistic((flat - phase) / 0.035) - push * logistic((phase - leave) / 0.055)
    nodes = np.array([-0.15, 0.0, 0.08, 0.17, 0.26, 0.47, 0.70, 0.82, 0.92, 1.0, 1.15])
    depths = np.array(
        [
            0.0008,
            0.0011,
            0.0043,
            0.9 * humps[0],
            humps[0],
            humps[1],
            humps[2],
            0.95 * humps[2],
            0.55 * humps[2],
            0.0014,
            0.0,
        ]
    )
    deepest = smoothed(nodes, depths, phase, 0.03)
    creep = smoothed(
        np.array([-0.15, 0.0, 0.15, 0.32, 0.5, 0.77, 0.95, 1.1]),
        np.array([0.0, 0.0, 0.0, slide[0], 0.15 * slide[0], -slide[1], -0.2 * slide[1], 0.0]),
        phase,
        0.03,
    )
    bottom = lowest(pitch, sole)
    y = bottom - deepest
    turn = CubicSpline(time, pitch)(time, 1)
    # the material point at the bottom of the deepest sphere moves with the prescribed creep
    speed = creep - turn * bottom
    x = CubicSpline(time, speed).antiderivative()(time)
    x = x - np.interp(0.0, time, x) + rng.normal(0.0, 2e-5)
    return through(time, np.array([x, y, pitch]), stance, rng.uniform(0.0, 2.0 * np.pi))


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


def lowest(pitch: Float[np.ndarray, " t"], sole: Sole) -> Float[np.ndarray, " t"]:
    """Height of the origin at which the lowest sphere just touches [m], smooth where the lowest changes."""
    s, c = np.sin(pitch)[:, None], np.cos(pitch)[:, None]
    touching = sole.radius - (sole.px * s + sole.py * c)
    sharp = 0.0008
    top = touching.max(axis=1, keepdims=True)
    weight = np.exp((touching - top) / sharp)
    return np.asarray((touching * weight).sum(axis=1) / weight.sum(axis=1))
