"""Scenes of the prosthetic foot."""

from __future__ import annotations

import numpy as np
import pandas as pd

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, colour
from geocontact.gap_benchmark.synthetic.systems.foot import model as foot
from geocontact.gap_benchmark.synthetic.systems.foot.motions import FootStyle, foot_path


def sole_of(rng: Rng, *, typical: bool) -> tuple[foot.Sole, pd.DataFrame]:
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
    return foot.Sole(places[0], places[1], places[2], zone, names), table


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
        foot.INPUTS,
        foot.OUTPUTS,
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
        (NoiseFilter(corner_of(rng, style.step)),) * len(foot.INPUTS),
        lambda r, _: foot_path(r, style, sole),
        lambda r, _: foot_path(r, later, sole),
        foot.foot(sole),
    )
