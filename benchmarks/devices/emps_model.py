"""The linear drive of the EMPS data as an own model: `system = "benchmarks.devices.emps_model:DRIVE"`.

force = M q'' + F_v q', with a friction F_c q'/(|q'| + v) + F_0 as well in `RUBBING` (Janot, Gautier & Brunot, the EMPS
benchmark of nonlinearbenchmark.org). The carriage's position q is the input; the law's spring is left at zero.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Channels, Law, Loads, Modifier, Motion, Sensor, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.single_deflection import SingleDeflection
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base

INPUTS, OUTPUTS = ("q",), ("force",)
TURNING = 1e-3
"""Rate at which dry friction turns round in the base that has it [m/s]."""


def weight_of_the_carriage(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
    """Mass times acceleration."""
    return np.asarray(outputs + values["M"] * movement.acceleration[0][:, None])


def position(q: np.ndarray, _: Values) -> np.ndarray:
    """What dampers and friction follow."""
    return q


def normal(loads: Loads) -> Channels:
    """The law's force."""
    return loads.normal


def drive(name: str, sources: Mapping[str, str | float]) -> Base:
    """A drive whose law has these numbers."""

    def build(
        parameters: tuple[Parameter, ...], constants: Mapping[str, float], _: Mapping[str, pd.DataFrame]
    ) -> System:
        return System(
            name=name,
            motion=Motion(INPUTS),
            geometry=SingleDeflection("q", position),
            law=Law(INTERFACE_LAW, load="N", deflection="m").having(dict(sources)),
            balance=Balance(OUTPUTS, normal).having(Modifier("mass", 1.0, weight_of_the_carriage)),
            sensor=Sensor(OUTPUTS),
            parameters=parameters,
            constants=dict(constants),
            scale=Magnitudes(),
            units={"q": "m", "force": "N"},
        )

    return Base(name, INPUTS, OUTPUTS, build)


DRIVE = drive("emps", {"b": "F_v"})
RUBBING = drive(
    "emps_rubbing",
    {"b": "F_v", "dry_friction.rate.limit": "F_c", "dry_friction.rate.turning": TURNING, "preload.tension": "F_0"},
)
