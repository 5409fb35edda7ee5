"""Mistakes in the data: exact and discrete, in every trial or in some."""

from __future__ import annotations

import math

import numpy as np

from geocontact.gap_benchmark.synthetic.scene import SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import SyntheticDataError

FACTORS = {
    "N": (1000.0, 9.80665, 4.4482216),
    "m": (1000.0, 100.0, 0.0254),
    "m^2": (1e6, 1e4),
    "rad": (math.degrees(1.0),),
}
"""What units of a dimension differ by: kN, kgf, lbf; mm, cm, inch; mm^2, cm^2; degrees."""


def draw_data_error(rng: np.random.Generator, scene: SyntheticScene) -> SyntheticDataError:
    """A wrong unit, a wrong sign or, where there are several, two force channels exchanged."""
    loads = scene.body.loads
    names = ("unit_error", "sign_flip") if len(loads) == 1 else ("unit_error", "sign_flip", "side_swap")
    effect = str(rng.choice(names))
    if effect == "side_swap":
        one, other = loads if len(loads) == 2 else sorted(rng.choice(loads, 2, replace=False))
        return SyntheticDataError(effect, "", 1.0, (int(one), int(other)))
    units = dict(zip((*scene.inputs, *scene.outputs), scene.units, strict=True))
    channels = tuple(name for name in units if name not in scene.body.spare)
    if effect == "sign_flip":
        return SyntheticDataError(effect, str(rng.choice(channels)), -1.0)
    channel = str(rng.choice(channels))
    factor = float(rng.choice(FACTORS[units[channel]]))
    return SyntheticDataError(effect, channel, factor if rng.random() < 0.5 else 1.0 / factor)


def words(data_error: SyntheticDataError, scene: SyntheticScene) -> str:
    """What happened, for people."""
    if data_error.swap is not None:
        one, other = (scene.outputs[row] for row in data_error.swap)
        return f"{one} and {other} are exchanged"
    if data_error.effect == "sign_flip":
        return f"{data_error.channel} has the wrong sign"
    return f"{data_error.channel} reads {data_error.factor:.4g} times what it should"
