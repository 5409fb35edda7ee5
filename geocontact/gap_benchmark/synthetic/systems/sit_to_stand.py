"""Straps of an exoskeleton while one stands up and sits down: per site F = k u + b u', u = normal + rho rotation.

The base model of CASES.md a second time, with whatever is hooked in; its movements at different paces, and its scenes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.course import KNOTS, InputCourse, Path, reached, through
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Values, read
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.plan import (
    COMMON,
    COMMON_UNKNOWN,
    STRAP_IN_SERIES,
    STRAPPED,
    Biased,
    DriftingLength,
    EffectNumbers,
    SyntheticMagnitudes,
)
from geocontact.gap_benchmark.synthetic.scene import Rng, Site, SyntheticScene, SyntheticSystem, colour
from geocontact.gap_benchmark.synthetic.systems.interface import in_series, pull

SITES = ("pelvis", "thigh", "shank")
MOTIONS = {"normal": "m", "tangential": "m", "rotation": "rad"}
"""What is measured at each site, in this order, with its unit."""
NORMAL, ROTATION = 0, 2
Sites = tuple[str, ...]


def inputs(sites: Sites) -> tuple[str, ...]:
    """Names of the inputs."""
    return tuple(f"{site}_{motion}" for site in sites for motion in MOTIONS)


def outputs(sites: Sites) -> tuple[str, ...]:
    """Names of the outputs."""
    return tuple(f"{site}_force" for site in sites)


def units(sites: Sites) -> tuple[str, ...]:
    """Units of inputs, then of outputs."""
    return (*(unit for _ in sites for unit in MOTIONS.values()), *("N" for _ in sites))


def respond(course: InputCourse, numbers: Mapping[str, float], hooks: Hooks, sites: Sites) -> Float[np.ndarray, "c t"]:
    """Force of each site along a course [N].

    Behind a spring in series the pad's dashpot b stays fixed to what is measured: it lies beside both springs.
    """
    for moved in hooks.motion:
        course = moved(course)
    time, b = course.time, numbers["b"]
    rows = []
    for i, site in enumerate(sites):
        own = hooks.seen_from(site)
        normal, rotation = course.position[3 * i + NORMAL], course.position[3 * i + ROTATION]
        lever = np.full_like(rotation, numbers[f"rho_{site}"])
        for drift in own.axis:
            lever = lever + drift(rotation)
        u, k = normal + lever * rotation, numbers[f"k_n_{site}"]
        if own.series:
            elastic = in_series(u, partial(pull, time, k=k, hooks=own), own)
            rows.append(elastic + b * np.gradient(u, time, edge_order=2))
        else:
            rows.append(pull(time, u, k, own, b))
    forces = np.array(rows)
    for add in hooks.load:
        forces = forces + add(course, numbers)
    return read(hooks, course, forces)


def base_model(course: InputCourse, constants: Mapping[str, float], sites: Sites) -> Callable[[Values], Values]:
    """Outputs of the base model as a function of (k of each site, rho of each site)."""
    count, b = len(sites), constants["b"]
    normal, rotation = (course.position[row::3] for row in (NORMAL, ROTATION))
    closing, turning = (course.rate[row::3] for row in (NORMAL, ROTATION))

    def forces(theta: Values) -> Values:
        k, rho = theta[:count, None], theta[count:, None]
        return np.asarray(k * (normal + rho * rotation) + b * (closing + rho * turning))

    return forces


def course_deflection(course: InputCourse, numbers: Mapping[str, float], sites: Sites) -> tuple[Values, Values]:
    """Deflection and rate of the base model along a course, one row per site."""
    rho = np.array([numbers[f"rho_{site}"] for site in sites])[:, None]
    place, rate = course.position, course.rate
    return place[NORMAL::3] + rho * place[ROTATION::3], rate[NORMAL::3] + rho * rate[ROTATION::3]


def biased(scale: SyntheticMagnitudes) -> tuple[Biased, ...]:
    """The normal displacement of any site, more at one end of its rotation."""
    return tuple(
        Biased(f"{site}_normal", 3 * i + NORMAL, 0.004, "m", 3 * i + ROTATION, place.middle, 0.7 * place.span)
        for i, (site, place) in enumerate(scale.places.items())
    )


EFFECTS = EffectNumbers(
    (*COMMON, "axis_migration", *STRAPPED, "contact_loss", "crosstalk"),
    (*COMMON_UNKNOWN, "swelling"),
    biased=biased,
    quick=(0.04, 0.08),
    apart=(15.0, 30.0),
    gains=(0.6, 0.6, 0.6),
    recovery=(0.05, 0.09),
    pitch=(3.5, 9.0),
    confounded=("sensor_gain", "series_compliance"),
    no_gap=("sensor_gain",),
    axis=DriftingLength("the lever", 0.1, over_range=True),
    series=STRAP_IN_SERIES,
    uneven=(0.5, 0.8),
    thinning=(2.5, 4.5),
    leaning=1.5,
    softer=1.5,
    lossy=2.5,
    relaxing=2.0,
    lagging=4.0,
    coupling=(0.04, 0.07),
    uneven_coupling=(0.6, 0.9),
    zero=0.4,
    wander=(0.05, 0.08),
)


def sit_to_stand(sites: Sites) -> SyntheticSystem:
    """Straps at these sites."""
    every = tuple(range(len(sites)))
    return SyntheticSystem(
        partial(respond, sites=sites),
        partial(base_model, sites=sites),
        partial(course_deflection, sites=sites),
        EFFECTS,
        loads=every,
        normal=every,
        places=tuple(Site(site, i, 3 * i + ROTATION) for i, site in enumerate(sites)),
        spare=tuple(f"{site}_tangential" for site in sites),
    )


MARGIN = 0.2
"""Time before a trial and after it through which its path runs on [s]."""


@dataclass(frozen=True)
class SiteStyle:
    """How one strap moves: normal displacement seated, its growth, ripple and lean; tangential and rotation.

    Lengths in m, `turn` in rad; the others are phases of a cycle of standing up and sitting down [rad].
    """

    seated: float
    growth: float
    ripple: float
    lean: float
    slide: float
    slide_phase: float
    turn: float
    turn_phase: float


@dataclass(frozen=True)
class SitToStandStyle:
    """How one case moves: `kind`, duration [s], step [s], and each site."""

    kind: str
    duration: float
    step: float
    sites: tuple[SiteStyle, ...]


def sit_to_stand_path(rng: Rng, style: SitToStandStyle) -> Path:
    """One trial."""
    duration = style.duration * float(np.exp(rng.normal(0.0, 0.08)))
    time = np.arange(-MARGIN, duration + MARGIN + KNOTS, KNOTS)
    cycle = 2.0 * np.pi * progress(style.kind, time / duration, rng.uniform(-0.04, 0.04))
    turn = float(np.exp(rng.normal(0.0, 0.07)))
    rows = [row for site in style.sites for row in of_site(rng, site, cycle, turn)]
    return through(time, np.array(rows), duration, rng.uniform(0.0, 2.0 * np.pi))


def of_site(
    rng: Rng, site: SiteStyle, cycle: Float[np.ndarray, " t"], turn: float
) -> tuple[Float[np.ndarray, " t"], ...]:
    """Normal, tangential and rotation along a cycle."""
    growth = site.growth * float(np.exp(rng.normal(0.0, 0.03)))
    risen = 0.5 - 0.5 * np.cos(cycle + 0.35 * np.sin(cycle) * site.lean)
    normal = site.seated + growth * risen + site.ripple * (1.0 - np.cos(2.0 * cycle)) * np.sin(cycle + site.lean)
    tangential = site.slide * np.sin(0.5 * cycle + site.slide_phase)
    rotation = site.turn * turn * np.sin(cycle + site.turn_phase)
    return normal, tangential, rotation


def progress(kind: str, share: Float[np.ndarray, " t"], uneven: float) -> Float[np.ndarray, " t"]:
    """Cycles of standing up and sitting down since the beginning, 0.5 is upright.

    "cycle" goes through at about one pace, "hold" rests upright, "rise" only stands up, "twice" does it two times.
    """
    warped = share + uneven * np.sin(2.0 * np.pi * share)
    if kind == "hold":
        return np.asarray(0.5 * reached(share, 0.06, 0.4 + uneven) + 0.5 * reached(share, 0.6 + uneven, 0.94))
    if kind == "rise":
        return np.asarray(0.5 * reached(share, 0.12, 0.75 + uneven))
    return 2.0 * warped if kind == "twice" else warped


NUMBERS = {"pelvis": (4050.0, 0.04), "thigh": (5050.0, -0.05), "shank": (6550.0, 0.03)}
"""Stiffness [N/m] and lever [m] of a usual case."""
USUAL = {
    "pelvis": SiteStyle(0.005, 0.0075, 0.0005, -0.6, 0.006, 0.0, 0.083, 0.0),
    "thigh": SiteStyle(0.005, 0.0055, -0.0008, -0.5, 0.006, 0.95, 0.075, 0.8),
    "shank": SiteStyle(0.005, 0.0050, -0.0006, 0.5, 0.006, 1.95, 0.078, 1.6),
}


def sit_to_stand_scene(rng: Rng, *, shifted: bool) -> SyntheticScene:
    """Pads that are pressed while one stands up and sits down."""
    typical = rng.random() < 0.55
    few = not typical and rng.random() < 0.25
    left_out = int(rng.integers(3)) if few else -1
    sites = tuple(site for i, site in enumerate(SITES) if i != left_out)
    style = style_of(rng, sites, typical=typical)
    later = other_style(rng, style) if shifted else style
    usual = np.array([NUMBERS[site] for site in sites])
    k, rho = usual.T * np.exp(rng.normal(0.0, 0.06 if typical else 0.3, usual.T.shape))
    if not typical:
        rho = rng.uniform(0.02, 0.08, len(sites)) * rng.choice([-1.0, 1.0], len(sites))
    wide = rng.uniform(0.6, 1.3)
    sd = 0.9 if typical else float(np.exp(rng.uniform(np.log(0.5), np.log(1.6))))
    return SyntheticScene(
        "sit_to_stand",
        inputs(sites),
        outputs(sites),
        units(sites),
        (
            *(Parameter(f"k_n_{site}", "N/m", 5000.0, 1500.0, 25000.0) for site in sites),
            *(Parameter(f"rho_{site}", "m", 0.0, -0.15, 0.15) for site in sites),
        ),
        {"b": 80.0 if typical else rng.uniform(30.0, 200.0)},
        {},
        np.concatenate([k, rho]),
        variation(k, wide),
        tuple(colour(rng, sd) for _ in sites),
        np.tile([6e-5, 8e-5, 8e-4], len(sites)) * rng.uniform(0.6, 1.2),
        style.step,
        (NoiseFilter(corner_of(rng, style.step)),) * len(inputs(sites)),
        lambda r, _: sit_to_stand_path(r, style),
        lambda r, _: sit_to_stand_path(r, later),
        sit_to_stand(sites),
    )


def variation(k: Float[np.ndarray, " s"], wide: float) -> Float[np.ndarray, "p p"]:
    """Covariance from trial to trial: stiffness by 2.5 %, levers by 0.8 mm; `wide` scales both."""
    return np.diag(np.concatenate([0.025 * k, np.full(len(k), 0.0008)]) * wide) ** 2


def style_of(rng: Rng, sites: tuple[str, ...], *, typical: bool) -> SitToStandStyle:
    """How somebody stands up."""
    usual = tuple(USUAL[site] for site in sites)
    if typical:
        return SitToStandStyle("cycle", 2.05, 0.02, usual)
    kind = str(rng.choice(["cycle", "cycle", "hold", "rise", "twice"]))
    step = float(rng.choice([0.01, 0.02, 0.04]))
    longest = {0.01: 1.7, 0.02: 3.2, 0.04: 6.0}[step]
    own = tuple(
        replace(
            one,
            seated=one.seated * rng.uniform(0.6, 1.3),
            growth=one.growth * rng.uniform(0.7, 1.4),
            ripple=one.ripple * rng.uniform(0.5, 1.5),
            turn=one.turn * rng.uniform(0.6, 1.3),
            turn_phase=one.turn_phase + rng.normal(0.0, 0.3),
        )
        for one in usual
    )
    return SitToStandStyle(kind, longest * rng.uniform(0.55, 1.0), step, own)


def other_style(rng: Rng, style: SitToStandStyle) -> SitToStandStyle:
    """Faster, or pressed harder."""
    if rng.random() < 0.5:
        return replace(style, duration=style.duration * rng.uniform(0.5, 0.7))
    harder = rng.uniform(1.2, 1.5)
    return replace(style, sites=tuple(replace(one, growth=one.growth * harder) for one in style.sites))
