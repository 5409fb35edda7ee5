"""The prosthetic foot: spheres in zones over level ground, with whatever is hooked in; its stance and scenes.

The base model of CASES.md a second time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd
from jaxtyping import Float, Int
from scipy.interpolate import CubicSpline

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.course import KNOTS, InputCourse, Path, logistic, smoothed, through
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Pull, Values, read
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.plan import COMMON, COMMON_UNKNOWN, Biased, EffectNumbers, SeriesSpring
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, SyntheticSystem, colour
from geocontact.gap_benchmark.synthetic.systems.interface import NotConvergedError, give_way

INPUTS, OUTPUTS = ("x", "y", "pitch"), ("force_x", "force_y", "cop_x")
LEAST = 20.0
"""Force below which there is no centre of pressure [N]."""


@dataclass(frozen=True)
class Sole:
    """Spheres in the foot's frame [m], and which zone each belongs to."""

    px: Float[np.ndarray, " n"]
    py: Float[np.ndarray, " n"]
    radius: Float[np.ndarray, " n"]
    zone: Int[np.ndarray, " n"]
    names: tuple[str, ...]


def touch(course: InputCourse, sole: Sole) -> tuple[Values, Values, Values, Values]:
    """Depth [m], its rate, forward speed of the bottom [m/s], place of the contact along the foot [m]; "t n" each."""
    y, pitch = (row[:, None] for row in course.position[1:])
    x_rate, y_rate, turn = (row[:, None] for row in course.rate)
    s, c = np.sin(pitch), np.cos(pitch)
    up = sole.px * s + sole.py * c
    depth = sole.radius - y - up
    closing = -y_rate - turn * (sole.px * c - sole.py * s)
    speed = x_rate - turn * (up - sole.radius)
    return depth, closing, speed, sole.px - sole.radius * s


def grip(speed: Values, constants: Mapping[str, float]) -> Values:
    """Friction coefficient m(v)."""
    nodes = np.array([-3.0, -1.5, -1.0, 1.0, 1.5, 3.0]) * constants["v_th"]
    mu_s, mu_k = constants["mu_s"], constants["mu_k"]
    return np.asarray(np.interp(speed, nodes, np.array([-mu_k, -mu_k, -mu_s, mu_s, mu_k, mu_k])))


def onset(depth: Values, full: float) -> Values:
    """Share of the damping that acts at a depth."""
    u = np.clip(depth / full, 0.0, 1.0)
    return np.asarray(u * u * (3.0 - 2.0 * u))


def power(depth: Values, n: float) -> Values:
    """depth^n, 0 off the ground."""
    return np.asarray(np.maximum(depth, 0.0) ** n)


def respond(course: InputCourse, numbers: Mapping[str, float], hooks: Hooks, sole: Sole) -> Float[np.ndarray, "c t"]:
    """force_x, force_y [N] and cop_x [m] along a course."""
    for moved in hooks.motion:
        course = moved(course)
    k = np.array([numbers[f"k_{name}"] for name in sole.names])[sole.zone]
    b = np.array([numbers[f"b_{name}"] for name in sole.names])[sole.zone]
    n, full = numbers["n"], numbers["delta_full"]
    depth, closing, speed, arm = touch(course, sole)
    time = course.time
    if hooks.series:
        if hooks.has_memory_in_law or len(hooks.series) > 1:
            raise NotConvergedError("a spring in series under the foot stands alone")
        soft, hard, limit = (float(v) for v in hooks.series[0](np.zeros(0)))
        way = give_way(time, depth, closing, k, b, n, full, soft, hard, limit)
        depth = depth - way[:, None]
        closing = closing - np.gradient(way, time)[:, None]
        # the pylon sits below the origin that is measured: the lever grows by what it gave way
        speed = speed - course.rate[2][:, None] * way[:, None]
    elastic = k * power(depth, n)
    for factor in hooks.spring:
        elastic = elastic * factor(time, depth, closing)
    force = elastic + b * np.maximum(closing, 0.0) * onset(depth, full) * (depth > 0.0)
    for term in hooks.beside:
        force = force + term(Pull(time, depth, closing, elastic))
    force = np.maximum(force, 0.0) * (depth > 0.0)
    vertical = force.sum(axis=1)
    moment = (force * arm).sum(axis=1)
    centre = np.divide(moment, vertical, out=np.zeros_like(moment), where=vertical > 0.0)
    outputs = np.array([-(force * grip(speed, numbers)).sum(axis=1), vertical, centre])
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def base_model(course: InputCourse, constants: Mapping[str, float], sole: Sole) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k per zone, b per zone); sums over spheres are taken once."""
    depth, closing, speed, arm = touch(course, sole)
    elastic = power(depth, constants["n"])
    viscous = np.maximum(closing, 0.0) * onset(depth, constants["delta_full"]) * (depth > 0.0)
    m = grip(speed, constants)
    member = (sole.zone[:, None] == np.arange(len(sole.names))).astype(float)
    across, up, turning = (
        np.hstack([(part * weight) @ member for part in (elastic, viscous)]) for weight in (-m, np.ones_like(m), arm)
    )

    def outputs(theta: Values) -> Values:
        vertical = up @ theta
        moment = turning @ theta
        centre = np.divide(moment, vertical, out=np.zeros_like(moment), where=vertical > 0.0)
        return np.array([across @ theta, vertical, centre])

    return outputs


def course_deflection(course: InputCourse, sole: Sole) -> tuple[Values, Values]:
    """Depths and their rates where in contact."""
    depth, closing, _, _ = touch(course, sole)
    inside = depth > 0.0
    return depth[inside], closing[inside]


def without_centre(outputs: Outputs) -> Outputs:
    """The centre of pressure is empty where the vertical force is small."""
    out = outputs.copy()
    out[2, out[1] < LEAST] = np.nan
    return out


EFFECTS = EffectNumbers(
    (*COMMON, "series_compliance", "stiffening", "damping", "asymmetry", "inertia_load", "crosstalk"),
    (*COMMON_UNKNOWN, "other_carrier", "ringing"),
    biased=lambda _: (Biased("y", 1, 0.004, "m", 2, -0.1, 0.25), Biased("pitch", 2, 0.06, "rad", 2, -0.1, 0.25)),
    quick=(0.01, 0.03),
    apart=(7.0, 14.0),
    gains=(0.6, 0.09, 1.3),
    recovery=(0.008, 0.014),
    pitch=(15.0, 40.0),
    confounded=("sensor_gain",),
    on_ground=True,
    series=SeriesSpring(lambda _: 0.006 / 1400.0),
    thinning=(1.2, 2.5),
    coupling=(0.02, 0.04),
    gained=(0, 0, 1, 2),
    gained_together=True,
    clipped=(0, 1, 1),
    latest=0.05,
)


def foot(sole: Sole) -> SyntheticSystem:
    """A foot with this sole."""
    return SyntheticSystem(
        partial(respond, sole=sole),
        partial(base_model, sole=sole),
        lambda course, _: course_deflection(course, sole),
        EFFECTS,
        loads=(0, 1),
        normal=(1,),
        quotients={2: 1},
        patchy=(2,),
        recorded=without_centre,
    )


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


def sole_of(rng: Rng, *, typical: bool) -> tuple[Sole, pd.DataFrame]:
    """Spheres along a rocker, three to six zones."""
    count = 15 if typical else int(rng.integers(9, 20))
    zones = 5 if typical else int(rng.integers(3, 7))
    length, rocker, radius = 0.22, 2.5, 0.011
    if not typical:
        length, rocker, radius = rng.uniform(0.2, 0.26), rng.uniform(1.5, 4.0), rng.uniform(0.009, 0.014)
    px = np.linspace(0.0, length, count)
    py = radius + (px - 0.36 * length) ** 2 / (2.0 * rocker)
    cuts = np.array([0.1, 0.25, 0.4, 0.7]) if zones == 5 else np.linspace(0.0, 1.0, zones + 1)[1:-1]
    zone = np.searchsorted(cuts, px / length, side="right")
    names = tuple(f"z{i + 1}" for i in range(zones)) if typical or rng.random() < 0.6 else part_names(zones)
    table = pd.DataFrame(
        {
            "px [m]": np.round(px, 4),
            "py [m]": np.round(py, 5),
            "radius [m]": np.full(count, round(radius, 4)),
            "zone": [names[i] for i in zone],
        }
    )
    places = [table[column].to_numpy(float) for column in ("px [m]", "py [m]", "radius [m]")]
    return Sole(places[0], places[1], places[2], zone, names), table


def part_names(zones: int) -> tuple[str, ...]:
    """Words for zones from the heel to the toe."""
    words = {
        3: ("heel", "mid", "fore"),
        4: ("heel", "mid", "ball", "toe"),
        5: ("heel", "rear", "mid", "ball", "toe"),
        6: ("heel", "rear", "arch", "mid", "ball", "toe"),
    }
    return words[zones]


def foot_style(rng: Rng, *, typical: bool) -> FootStyle:
    """How the foot is walked on."""
    return FootStyle(
        stance=0.8 if typical else rng.uniform(0.55, 1.1),
        heel=0.0082 if typical else rng.uniform(0.006, 0.0095),
        middle=0.0070 if typical else rng.uniform(0.0055, 0.008),
        toe=0.0093 if typical else rng.uniform(0.008, 0.0115),
        strike=0.25 if typical else rng.uniform(0.15, 0.32),
        push=0.55 if typical else rng.uniform(0.4, 0.65),
        slide=0.035 if typical else rng.uniform(0.02, 0.08),
        step=0.005,
    )


def other_style(rng: Rng, style: FootStyle) -> FootStyle:
    """Walked faster, or harder."""
    faster, harder = (rng.uniform(0.6, 0.75), 1.1) if rng.random() < 0.5 else (0.95, rng.uniform(1.2, 1.35))
    changes = {
        "stance": style.stance * faster,
        "heel": style.heel * harder,
        "middle": style.middle * harder,
        "toe": style.toe * harder,
    }
    return FootStyle(**{**style.__dict__, **changes})


def foot_scene(rng: Rng, *, shifted: bool) -> SyntheticScene:
    """A prosthetic foot in stance."""
    typical = rng.random() < 0.55
    sole, table = sole_of(rng, typical=typical)
    n = 1.2 if typical else float(rng.choice([1.0, 1.2, 1.5]))
    style = foot_style(rng, typical=typical)
    later = other_style(rng, style) if shifted else style
    zones = len(sole.names)
    soft = 10.0 ** (3.0 * (n - 1.2) * 0.75)
    if typical:
        k = rng.uniform(0.85, 1.05) * 1e5 * np.linspace(1.0, 1.5, zones) * np.exp(rng.normal(0.0, 0.04, zones))
        b = 300.0 * np.exp(rng.normal(0.0, 0.1, zones))
    else:
        k = rng.uniform(0.4, 1.3) * 1e5 * soft * np.exp(rng.normal(0.0, 0.25, zones))
        b = rng.uniform(100.0, 600.0) * np.exp(rng.normal(0.0, 0.3, zones))
    wide = rng.uniform(0.6, 1.3)
    spread = np.zeros((2 * zones, 2 * zones))
    spread[:zones, :zones] = wide**2 * (np.diag((0.013 * k) ** 2) + np.outer(0.006 * k, 0.006 * k))
    spread[zones:, zones:] = wide**2 * np.diag((0.08 * b) ** 2)
    start = 80000.0 * soft if not typical else 80000.0
    letters = [("k", start, start / 10.0, start * 12.5, "N/m^n"), ("b", 200.0, 0.0, 3000.0, "N s/m")]
    parameters = tuple(
        Parameter(f"{letter}_{name}", unit, begin, lower, upper)
        for letter, begin, lower, upper, unit in letters
        for name in sole.names
    )
    level = 1.0 if typical else float(np.exp(rng.uniform(np.log(0.5), np.log(1.7))))
    return SyntheticScene(
        "foot",
        INPUTS,
        OUTPUTS,
        ("m", "m", "rad", "N", "N", "m"),
        parameters,
        {
            "n": n,
            "delta_full": 0.002,
            "mu_s": 0.9 if typical else rng.uniform(0.7, 1.0),
            "mu_k": 0.7 if typical else rng.uniform(0.5, 0.7),
            "v_th": 0.25 if typical else rng.uniform(0.15, 0.3),
        },
        {"spheres": table},
        np.concatenate([k, b]),
        spread,
        tuple(colour(rng, sd * level) for sd in (3.0, 6.0, 0.001)),
        np.array([5.5e-5, 3e-5, 4e-4]) * rng.uniform(0.6, 1.2),
        style.step,
        (NoiseFilter(corner_of(rng, style.step)),) * len(INPUTS),
        lambda r, _: foot_path(r, style, sole),
        lambda r, _: foot_path(r, later, sole),
        foot(sole),
    )
