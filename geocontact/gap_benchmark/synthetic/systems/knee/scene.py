"""Scenes of the knee implant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, colour
from geocontact.gap_benchmark.synthetic.systems.knee import model as knee
from geocontact.gap_benchmark.synthetic.systems.knee.motions import KneeStyle, knee_path


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
        knee.INPUTS,
        knee.OUTPUTS,
        knee.UNITS,
        (Parameter("E_star", "Pa", 12e6, 3e6 if modulus < 15e6 else 5e6, 80e6),),
        {"R": radius},
        {},
        np.array([modulus]),
        np.array([[spread**2]]),
        (colour(rng, sd), colour(rng, sd)),
        np.array([1.5e-3, 6e-4, area_sd, area_sd]) * rng.uniform(0.7, 1.2),
        step,
        (NoiseFilter(corner_of(rng, step)),) * len(knee.INPUTS),
        lambda r, _: knee_path(r, style),
        lambda r, _: knee_path(r, later),
        knee.KNEE,
    )


def other_style(rng: Rng, style: KneeStyle) -> KneeStyle:
    """Faster, or harder."""
    if rng.random() < 0.5:
        return replace(style, duration=style.duration * rng.uniform(0.55, 0.75))
    return replace(style, load=style.load * rng.uniform(1.2, 1.5))
