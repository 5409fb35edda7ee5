"""Scenes of the elbow."""

from __future__ import annotations

import numpy as np

from geocontact.data.parameter import Parameter
from geocontact.gap_benchmark.synthetic.motions import ElbowStyle, elbow_path
from geocontact.gap_benchmark.synthetic.noise import NoiseFilter, corner_of
from geocontact.gap_benchmark.synthetic.scene import Rng, SyntheticScene, colour
from geocontact.gap_benchmark.synthetic.systems.elbow import model as elbow


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
        elbow.INPUTS,
        elbow.OUTPUTS,
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
        (NoiseFilter(corner_of(rng, step)),) * len(elbow.INPUTS),
        lambda r, _: elbow_path(r, style),
        lambda r, _: elbow_path(r, later),
        elbow.ELBOW,
        ((100.0, 0.01, 0.02), (700.0, 0.07, 0.09)),  # away from the wrong basin at x = y = 0
    )
