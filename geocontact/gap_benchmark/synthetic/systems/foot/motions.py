"""Prescribed stance of a foot, continuous in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from geocontact.gap_benchmark.synthetic.course import Path, through
from geocontact.gap_benchmark.synthetic.motions import KNOTS, Rng, logistic, smoothed
from geocontact.gap_benchmark.synthetic.systems.foot.model import Sole


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


def lowest(pitch: Float[np.ndarray, " t"], sole: Sole) -> Float[np.ndarray, " t"]:
    """Height of the origin at which the lowest sphere just touches [m], smooth where the lowest changes."""
    s, c = np.sin(pitch)[:, None], np.cos(pitch)[:, None]
    touching = sole.radius - (sole.px * s + sole.py * c)
    sharp = 0.0008
    top = touching.max(axis=1, keepdims=True)
    weight = np.exp((touching - top) / sharp)
    return np.asarray((touching * weight).sum(axis=1) / weight.sum(axis=1))
