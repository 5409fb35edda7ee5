"""Mistakes in the data: exact and discrete, in every trial or in some."""

from __future__ import annotations

import math

import numpy as np

from geocontact.gap.benchmark.planted.scene import Scene
from geocontact.gap.benchmark.planted.trials import Fault

FACTORS = {"N": (1000.0, 9.80665, 4.4482216), "m": (1000.0, 100.0, 0.0254), "rad": (math.degrees(1.0),)}
"""What units of a dimension differ by: kN, kgf, lbf; mm, cm, inch; degrees."""


def draw_fault(rng: np.random.Generator, scene: Scene) -> Fault:
    """A wrong unit, a wrong sign or, at the foot, its force channels exchanged."""
    names = ("unit_error", "sign_flip") if scene.system == "elbow" else ("unit_error", "sign_flip", "side_swap")
    effect = str(rng.choice(names))
    if effect == "side_swap":
        return Fault(effect, "", 1.0, (0, 1))
    channels = (*scene.inputs, *scene.outputs)
    units = dict(zip(channels, scene.units, strict=True))
    if effect == "sign_flip":
        return Fault(effect, str(rng.choice(channels)), -1.0)
    channel = str(rng.choice(channels))
    factor = float(rng.choice(FACTORS[units[channel]]))
    return Fault(effect, channel, factor if rng.random() < 0.5 else 1.0 / factor)


def words(fault: Fault) -> str:
    """What happened, for people."""
    if fault.swap is not None:
        return "force_x and force_y are exchanged"
    if fault.effect == "sign_flip":
        return f"{fault.channel} has the wrong sign"
    return f"{fault.channel} reads {fault.factor:.4g} times what it should"
