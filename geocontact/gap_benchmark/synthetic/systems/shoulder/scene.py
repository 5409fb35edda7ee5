"""Scenes of the shoulder exoskeleton of somebody who works overhead."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, colour
from geocontact.gap_benchmark.synthetic.systems.shoulder import model as shoulder
from geocontact.gap_benchmark.synthetic.systems.shoulder.motions import ShoulderStyle, shoulder_path

LEVELS = ((0.0, 0.5, 1.0), (0.0, 0.5, 1.0), (0.0, 1.0), (0.3, 0.6, 1.0), (0.6, 0.8, 1.0))
"""Of support, taken in turn by the trials."""

RATE, STILL = 0.06, 0.0014
"""Noise of the recorded arm: of its rate [rad/s], about, whatever the corner, for who smooths little has markers of
low noise; and the most of its angle [rad]."""


def shoulder_scene(rng: Rng, *, shifted: bool) -> SyntheticScene:
    """An exoskeleton that carries the arm, at several levels of support."""
    typical = rng.random() < 0.55
    style = style_of(rng, typical=typical)
    later = other_style(rng, style) if shifted else style
    k, b, m = rng.normal(900.0, 40.0), rng.normal(30.0, 1.5), rng.normal(1.9, 0.05)
    if not typical:
        k, b, m = np.exp(rng.uniform(np.log(400.0), np.log(2000.0))), rng.uniform(10.0, 45.0), rng.uniform(1.2, 3.0)
    wide, corner = rng.uniform(0.6, 1.3), corner_of(rng, style.step)
    force = 0.4 if typical else float(np.exp(rng.uniform(np.log(0.2), np.log(0.8))))
    angle = 0.002 if typical else rng.uniform(0.001, 0.003)
    lengths = {"L_h": 0.25, "o_x": 0.01, "o_y": 0.02, "I": 0.09, "c": 0.2, "l_c": 0.2}
    if not typical:
        other = {"L_h": (0.2, 0.3), "o_x": (-0.02, 0.03), "o_y": (-0.01, 0.03), "I": (0.05, 0.15), "c": (0.05, 0.4)}
        lengths |= {name: rng.uniform(*within) for name, within in other.items()}
        lengths["l_c"] = rng.uniform(0.15, 0.25)
    return SyntheticScene(
        "shoulder",
        shoulder.INPUTS,
        shoulder.OUTPUTS,
        shoulder.UNITS,
        (
            Parameter("k_t", "N/m", 700.0, 100.0, 5000.0),
            Parameter("b_t", "N s/m", 20.0, 0.0, 100.0),
            Parameter("m", "kg", 2.0, 0.3, 5.0),
        ),
        lengths,
        {"support": (table := support(rng, typical=typical))},
        np.array([k, b, m]),
        (np.diag([0.03 * k, 0.05 * b, 0.004 * m]) * wide) ** 2,
        (colour(rng, angle), colour(rng, force)),
        np.array([min(rng.uniform(0.6, 1.2) * RATE / (2.0 * np.pi * corner), STILL), 0.0]),
        style.step,
        (NoiseFilter(corner), NoiseFilter(corner)),
        lambda r, i: shoulder_path(r, style, i),
        lambda r, i: shoulder_path(r, later, i),
        shoulder.shoulder(table),
    )


def support(rng: Rng, *, typical: bool) -> pd.DataFrame:
    """Torque of full support: rises from the hanging arm, is largest about shoulder height and falls above it."""
    top = 8.0 if typical else rng.uniform(5.0, 12.0)
    apart = 0.2 if typical else float(rng.choice([0.1, 0.2, 0.25]))
    begin, peak = rng.uniform(-0.15, -0.05), rng.uniform(1.35, 1.6)
    angle = np.arange(-0.6, 3.0, apart)
    rising = np.sin(np.clip(0.5 * np.pi * (angle - begin) / (peak - begin), 0.0, np.pi))
    return pd.DataFrame({"angle [rad]": angle.round(4), "torque [N m]": (top * rising).round(3)})


def style_of(rng: Rng, *, typical: bool) -> ShoulderStyle:
    """How somebody works."""
    if typical:
        return ShoulderStyle("raise", 0.25, 1.5, 0.8, 8.2, 0.01, LEVELS[0])
    kind = str(rng.choice(["raise", "heights", "cycle"]))
    step = float(rng.choice([0.01, 0.02]))
    hanging, raised = rng.uniform(0.15, 0.4), rng.uniform(1.2, 2.0)
    pace = float(np.exp(rng.uniform(np.log(1.4 if kind == "cycle" else 0.7), np.log(2.0))))
    return ShoulderStyle(
        kind, hanging, raised, pace, rng.uniform(6.0, 9.0), step, LEVELS[int(rng.integers(len(LEVELS)))]
    )


def other_style(rng: Rng, style: ShoulderStyle) -> ShoulderStyle:
    """Faster, or higher."""
    if rng.random() < 0.5:
        return replace(style, pace=style.pace * rng.uniform(1.4, 1.9))
    return replace(style, raised=style.raised + rng.uniform(0.25, 0.45))
