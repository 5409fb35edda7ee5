"""A banded friction damper as a simulator of one's own: `system = "benchmarks.devices.friction_damper_model:DAMPER"`.

force = k x + c x' + what the law gives; `RUBBING` has the band's friction in the base as well.
"""

from __future__ import annotations

import numpy as np

import geocontact as gc
from geocontact.systems.acting_law import ActingLaw

REACH = 4.3e-3
"""Stroke over which friction turns round in the base that has it [m]."""


def run(_: np.ndarray, inputs: np.ndarray, numbers: dict[str, float], law: ActingLaw) -> np.ndarray:
    """Spring and dashpot beside whatever acts on the displacement."""
    return np.asarray(numbers["k"] * inputs[0] + numbers["c"] * law.rate + law(inputs[0], law.rate))


CHANNELS = {"x": "m"}, {"force": "N"}
DAMPER = gc.simulator_base("friction_damper", *CHANNELS, run, acts_on="x")
RUBBING = gc.simulator_base(
    "friction_damper_rubbing",
    *CHANNELS,
    run,
    acts_on="x",
    law={"dry_friction.stroke.limit": "F_c", "dry_friction.stroke.reach": "reach"},
)
