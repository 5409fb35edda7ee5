"""The knee implant: per side F = (4/3) E* a³/R from an area, with whatever is hooked in; its movements and scenes.

The base model of CASES.md a second time. The deflection of a side is a³/R [m^2], its stiffness (4/3) E* [Pa]. Movements
are walking, stairs and squats, as flexion, adduction and the loads that make the two areas.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.course import KNOTS, InputCourse, Path, smoothed, through
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values, read
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.plan import (
    COMMON,
    COMMON_UNKNOWN,
    Biased,
    DriftingLength,
    EffectNumbers,
    SyntheticMagnitudes,
)
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, SyntheticSystem, colour
from geocontact.gap_benchmark.synthetic.systems.interface import pull

SIDES = ("medial", "lateral")
INPUTS = ("flexion", "adduction", *(f"area_{side}" for side in SIDES))
OUTPUTS = tuple(f"force_{side}" for side in SIDES)
UNITS = ("rad", "rad", "m^2", "m^2", "N", "N")
AREAS = slice(2, 4)
LEAST = 1e-9
"""Area that a side keeps [m^2]."""


def deflection(area: Values, radius: Values) -> Values:
    """(area/π)^(3/2)/R [m^2]."""
    return np.asarray((np.maximum(area, LEAST) / np.pi) ** 1.5 / radius)


def area_under(force: Values, modulus: float, radius: float) -> Values:
    """Area [m^2] that a force makes in the base model."""
    return np.asarray(np.pi * (0.75 * force * radius / modulus) ** (2.0 / 3.0))


def respond(course: InputCourse, numbers: Mapping[str, float], hooks: Hooks) -> Float[np.ndarray, "c t"]:
    """force_medial and force_lateral [N] along a course."""
    for moved in hooks.motion:
        course = moved(course)
    flexion = course.position[0]
    radius = np.full_like(flexion, numbers["R"])
    for drift in hooks.axis:
        radius = radius + drift(flexion)
    k = 4.0 / 3.0 * numbers["E_star"]
    outputs = np.array(
        [
            pull(course.time, deflection(area, radius), k, hooks.seen_from(side))
            for side, area in zip(SIDES, course.position[AREAS], strict=True)
        ]
    )
    for add in hooks.load:
        outputs = outputs + add(course, numbers)
    return read(hooks, course, outputs)


def base_model(course: InputCourse, constants: Mapping[str, float]) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (E_star,), one row per side."""
    u = deflection(course.position[AREAS], np.asarray(constants["R"]))

    def outputs(theta: Values) -> Values:
        return np.asarray(4.0 / 3.0 * theta[0] * u)

    return outputs


def course_deflection(course: InputCourse, numbers: Mapping[str, float]) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course, one row per side."""
    u = deflection(course.position[AREAS], np.asarray(numbers["R"]))
    return u, np.gradient(u, course.time, axis=1, edge_order=2)


RADIUS = 0.037
"""Radius of a usual case [m]."""


def biased(scale: SyntheticMagnitudes) -> tuple[Biased, ...]:
    """Either area, more at one end of flexion."""
    areas = enumerate(INPUTS[AREAS], AREAS.start)
    return tuple(Biased(name, row, 8e-5, "m^2", 0, scale.middle, 0.7 * scale.span) for row, name in areas)


EFFECTS = EffectNumbers(
    (*COMMON, "axis_migration", "asymmetry", "crosstalk"),
    (*COMMON_UNKNOWN, "other_carrier"),
    biased=biased,
    quick=(0.02, 0.04),
    apart=(15.0, 30.0),
    gains=(0.9, 0.9),
    recovery=(0.05, 0.07),
    pitch=(7.0, 25.0),
    confounded=("sensor_gain",),
    sides=True,
    axis=DriftingLength("R", 0.4 * RADIUS, over_range=True),
    uneven=(0.5, 0.8),
    coupling=(0.05, 0.08),
    gained_together=True,
)


KNEE = SyntheticSystem(
    respond, base_model, course_deflection, EFFECTS, loads=(0, 1), normal=(0, 1), spare=INPUTS[:2], lengths=("R",)
)


FLEXION: Mapping[str, tuple[tuple[float, float], ...]] = {
    "gait": ((0.0, 0.13), (0.15, 0.3), (0.3, 0.58), (0.45, 0.8), (0.6, 0.76), (0.75, 0.5), (0.9, 0.2), (1.0, 0.13)),
    "stairs": ((0.0, 0.9), (0.2, 0.75), (0.4, 0.35), (0.55, 0.15), (0.7, 0.3), (0.85, 0.8), (1.0, 0.9)),
    "squat": ((0.0, 0.1), (0.1, 0.12), (0.45, 1.2), (0.55, 1.2), (0.9, 0.12), (1.0, 0.1)),
}
"""Share of a trial and flexion [rad]."""
LOAD: Mapping[str, tuple[tuple[float, float], ...]] = {
    "gait": ((0.0, 0.5), (0.08, 0.75), (0.2, 1.0), (0.4, 0.8), (0.58, 0.92), (0.72, 0.65), (0.87, 0.1), (1.0, 0.42)),
    "stairs": ((0.0, 0.3), (0.15, 0.85), (0.3, 1.0), (0.5, 0.6), (0.65, 0.8), (0.8, 0.25), (1.0, 0.3)),
    "squat": ((0.0, 0.35), (0.2, 0.5), (0.45, 1.0), (0.55, 0.95), (0.8, 0.5), (1.0, 0.35)),
}
"""Share of a trial and of the largest load of both sides."""
MARGIN = 0.15
"""Shares of a trial before it and after it through which its path runs on."""


@dataclass(frozen=True)
class KneeStyle:
    """How one case moves: `kind`, duration [s], largest load of both sides [N], medial share, its swing, step [s].

    `bend` scales flexion; `modulus` [Pa] and `radius` [m] turn loads into areas.
    """

    kind: str
    duration: float
    load: float
    medial: float
    sway: float
    bend: float
    modulus: float
    radius: float
    step: float


def knee_path(rng: Rng, style: KneeStyle) -> Path:
    """One trial."""
    duration = style.duration * float(np.exp(rng.normal(0.0, 0.05)))
    late = rng.normal(0.0, 0.012)
    share = np.arange(-MARGIN, 1.0 + MARGIN, KNOTS / duration)
    bend = style.bend * float(np.exp(rng.normal(0.0, 0.02)))
    flexion = bend * periodic(FLEXION[style.kind], share + late)
    load = style.load * float(np.exp(rng.normal(0.0, 0.03))) * periodic(LOAD[style.kind], share + rng.normal(0.0, 0.01))
    turn = rng.normal(0.0, 0.15)
    adduction = 0.022 * np.exp(rng.normal(0.0, 0.08)) * np.sin(2.0 * np.pi * share + turn)
    middle = style.medial + rng.normal(0.0, 0.005)
    medial = middle + style.sway * np.sin(2.0 * np.pi * share + 0.6 + turn) + 0.3 * style.sway * np.cos(9.0 * share)
    areas = [area_under(part * load, style.modulus, style.radius) for part in (medial, 1.0 - medial)]
    time = share * duration
    return through(time, np.array([flexion, adduction, *areas]), duration, rng.uniform(0.0, 2.0 * np.pi))


def periodic(nodes: tuple[tuple[float, float], ...], share: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Polyline through `nodes` that repeats itself, corners rounded."""
    at, value = (np.array(column) for column in zip(*nodes, strict=True))
    thrice = np.concatenate([at[:-1] - 1.0, at[:-1], at + 1.0])
    return smoothed(thrice, np.concatenate([value[:-1], value[:-1], value]), share, 0.035)


def knee_scene(rng: Rng, *, shifted: bool) -> SyntheticScene:
    """A knee implant on a simulator: areas of the two sides, and the forces that were measured under them."""
    typical = rng.random() < 0.55
    modulus = rng.normal(19.8e6, 0.4e6) if typical else rng.uniform(9e6, 45e6)
    radius = 0.037 if typical else rng.uniform(0.022, 0.055)
    kind = "gait" if typical else str(rng.choice(["gait", "stairs", "squat"]))
    step = 0.01 if typical else float(rng.choice([0.005, 0.01, 0.01, 0.02]))
    longest = {0.005: 0.9, 0.01: 1.5, 0.02: 3.0}[step]
    style = KneeStyle(
        kind,
        1.18 if typical else longest * rng.uniform(0.6, 1.0),
        1400.0 if typical else rng.uniform(600.0, 2200.0),
        0.6 if typical else rng.uniform(0.45, 0.68),
        0.03 if typical else rng.uniform(0.02, 0.08),
        1.0 if typical else rng.uniform(0.7, 1.15),
        modulus,
        radius,
        step,
    )
    later = other_style(rng, style) if shifted else style
    sd = 10.0 if typical else float(np.exp(rng.uniform(np.log(5.0), np.log(18.0))))
    area_sd = 1.2e-6 if typical else rng.uniform(0.6e-6, 2.4e-6)
    spread = 0.012 * modulus * rng.uniform(0.6, 1.6)
    return SyntheticScene(
        "knee",
        INPUTS,
        OUTPUTS,
        UNITS,
        (Parameter("E_star", "Pa", 12e6, 3e6 if modulus < 15e6 else 5e6, 80e6),),
        {"R": radius},
        {},
        np.array([modulus]),
        np.array([[spread**2]]),
        (colour(rng, sd), colour(rng, sd)),
        np.array([1.5e-3, 6e-4, area_sd, area_sd]) * rng.uniform(0.7, 1.2),
        step,
        (NoiseFilter(corner_of(rng, step)),) * len(INPUTS),
        lambda r, _: knee_path(r, style),
        lambda r, _: knee_path(r, later),
        KNEE,
    )


def other_style(rng: Rng, style: KneeStyle) -> KneeStyle:
    """Faster, or harder."""
    if rng.random() < 0.5:
        return replace(style, duration=style.duration * rng.uniform(0.55, 0.75))
    return replace(style, load=style.load * rng.uniform(1.2, 1.5))
