"""Scenes of the exoskeleton strapped to pelvis, thigh and shank of somebody who stands up and sits down."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, colour
from geocontact.gap_benchmark.synthetic.systems.sit_to_stand import model as sit_to_stand
from geocontact.gap_benchmark.synthetic.systems.sit_to_stand.motions import (
    SiteStyle,
    SitToStandStyle,
    sit_to_stand_path,
)

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
    sites = tuple(site for i, site in enumerate(sit_to_stand.SITES) if i != left_out)
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
        sit_to_stand.inputs(sites),
        sit_to_stand.outputs(sites),
        sit_to_stand.units(sites),
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
        (NoiseFilter(corner_of(rng, style.step)),) * len(sit_to_stand.inputs(sites)),
        lambda r, _: sit_to_stand_path(r, style),
        lambda r, _: sit_to_stand_path(r, later),
        sit_to_stand.sit_to_stand(sites),
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
