"""The elbow exoskeleton: F = k d_tot along a course, with whatever is hooked in; its movements and scenes.

The base model of CASES.md a second time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.course import InputCourse, Path
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values, read
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.plan import (
    COMMON,
    COMMON_UNKNOWN,
    STRAPPED,
    Biased,
    DriftingLength,
    EffectNumbers,
    SeriesSpring,
)
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, SyntheticSystem, colour
from geocontact.gap_benchmark.synthetic.systems.interface import in_series, pull

INPUTS, OUTPUTS = ("beta",), ("force",)


def deflection(beta: Values, x: Values, y: float, l: float, z: float) -> Values:
    """d_tot [m]."""
    s, c = np.sin(beta), np.cos(beta)
    d_lin = y + np.sqrt(l * l - x * x) - np.sqrt((l * s - x) ** 2 + (y + l * c) ** 2)
    return np.asarray(d_lin - z * (x * c + y * s) / (l + y * c - x * s))


def respond(course: InputCourse, numbers: Mapping[str, float], hooks: Hooks) -> Float[np.ndarray, "c t"]:
    """Force along a course [N], one row."""
    for moved in hooks.motion:
        course = moved(course)
    beta, time = course.position[0], course.time
    l, z, x, y, k = (numbers[name] for name in ("l_ex", "z_ex", "x", "y", "k"))

    def stretch(angle: Values) -> Values:
        along = np.full_like(angle, x)
        for drift in hooks.axis:
            along = along + drift(angle)
        return deflection(angle, along, y, l, z)

    def carried(angle: Values) -> Values:
        return pull(time, stretch(angle), k, hooks)

    force = in_series(beta, carried, hooks) if hooks.series else carried(beta)
    outputs = force[None, :]
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def base_model(course: InputCourse, constants: Mapping[str, float]) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k, x, y), one row."""
    beta = course.position[0]
    l, z = constants["l_ex"], constants["z_ex"]

    def outputs(theta: Values) -> Values:
        k, x, y = theta
        return np.asarray(k * deflection(beta, np.asarray(x), float(y), l, z))[None, :]

    return outputs


def course_deflection(course: InputCourse, numbers: Mapping[str, float]) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course."""
    u = deflection(course.position[0], np.asarray(numbers["x"]), numbers["y"], numbers["l_ex"], numbers["z_ex"])
    return u, np.gradient(u, course.time, edge_order=2)


CONFOUNDED = (
    "series_compliance",
    "preload",
    "gravity_load",
    "axis_migration",
    "motion_offset",
    "sensor_gain",
    "sensor_offset",
)
EFFECTS = EffectNumbers(
    (*COMMON, "axis_migration", *STRAPPED, "gravity_load", "inertia_load"),
    (*COMMON_UNKNOWN, "other_carrier"),
    biased=lambda scale: (Biased("beta", 0, 0.3, "rad", 0, scale.middle, 0.5),),
    quick=(0.1, 0.5),
    apart=(7.0, 14.0),
    gains=(0.6,),
    recovery=(0.05, 0.12),
    pitch=(3.0, 9.0),
    confounded=CONFOUNDED,
    no_gap=CONFOUNDED,
    axis=DriftingLength("x", 0.03, ripple=1.0),
    # base parameters take most of a linear spring away
    series=SeriesSpring(
        lambda scale: 0.5 / scale.force, lambda share, departure: share + (0.39 + 0.3 * (1.0 - departure)), "rad/N"
    ),
    thinning=(4.0, 8.0),
    lever="l_ex",
    heaviest=4.0,
    slow=(0.25, 0.4),
    zero=0.4,
)


ELBOW = SyntheticSystem(respond, base_model, course_deflection, EFFECTS, lengths=("l_ex", "z_ex"), quickest=10.0)


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


def elbow_scene(rng: Rng, *, shifted: bool) -> SyntheticScene:
    """An elbow exoskeleton at the pace of the practice cases or up to five times as fast."""
    typical = rng.random() < 0.55
    kind = "two" if typical else str(rng.choice(["two", "three", "sweep", "reaches"]))
    pace = float(np.exp(rng.normal(0.0, 0.1))) if typical else float(np.exp(rng.uniform(np.log(0.6), np.log(5.0))))
    step, duration = (
        (0.04, 30.0)
        if typical
        else [(0.04, 30.0), (0.04, 20.0), (0.02, 20.0), (0.02, 24.0), (0.01, 12.0)][rng.integers(5)]
    )
    swing = 1.0 if typical else rng.uniform(0.65, 1.05)
    style = ElbowStyle(kind, pace, swing, rng.uniform(1.1, 1.22), step, duration)
    later = style
    if shifted:
        faster = rng.uniform(1.5, 2.2)
        smaller = rng.uniform(0.6, 0.8)
        style = ElbowStyle(kind, pace, swing * smaller, style.middle, step, duration)
        later = ElbowStyle(kind, min(pace * faster, 7.0), swing, style.middle, step, duration)
        if rng.random() < 0.5:
            later = ElbowStyle(kind, pace, swing, style.middle, step, duration)
    k, x, y = rng.uniform(180.0, 420.0), rng.uniform(0.015, 0.045), rng.uniform(0.03, 0.06)
    if typical:
        k, x, y = rng.normal(260.0, 15.0), rng.normal(0.035, 0.002), rng.normal(0.05, 0.002)
    wide = rng.uniform(0.6, 1.3)
    spread = np.diag([0.03 * k, 0.0007, 0.0012]) * wide
    sd = 0.15 if typical else float(np.exp(rng.uniform(np.log(0.08), np.log(0.3))))
    return SyntheticScene(
        "elbow",
        INPUTS,
        OUTPUTS,
        ("rad", "N"),
        (
            Parameter("k", "N/m", 300.0, 50.0, 1000.0),
            Parameter("x", "m", 0.03, 0.0, 0.1),
            Parameter("y", "m", 0.04, 0.0, 0.12),
        ),
        {"l_ex": 0.185 if typical else rng.uniform(0.16, 0.21), "z_ex": 0.09 if typical else rng.uniform(0.07, 0.11)},
        {},
        np.array([k, x, y]),
        spread**2,
        (colour(rng, sd),),
        np.array([rng.uniform(0.0005, 0.002)]),
        step,
        (NoiseFilter(corner_of(rng, step)),) * len(INPUTS),
        lambda r, _: elbow_path(r, style),
        lambda r, _: elbow_path(r, later),
        ELBOW,
        ((100.0, 0.01, 0.02), (700.0, 0.07, 0.09)),  # away from the wrong basin at x = y = 0
    )
