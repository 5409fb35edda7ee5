"""Elbow exoskeleton: force at the attachment from a misaligned axis, F = k d_tot (explicit pHRI model).

Input `beta [rad]`, output `force [N]`; parameters k, x, y; l and z are constants or fixed parameters.
(k, x, y, l, z) together cannot be told from any data: F(k/s, s × lengths) = F.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, Loads, Motion, Sensor
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import System
from geocontact.chain.traits import Mass, Traits, Way
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base, require_numbers
from geocontact.systems.elbow.misalignment import ElbowMisalignment

INPUTS, OUTPUTS = ("beta",), ("force",)
UNITS = {"beta": "rad", "force": "N"}
LENGTHS = ("l", "z", "x", "y")
FORMER = {"l_ex": "l", "z_ex": "z"}
"""Names of an earlier version, which cases may still use."""
ABSENT = ("contact_loss.opening", "asymmetry.excess")
"""Terms of the law that a cuff around the arm does not have: it holds to both sides, alike."""
TRAITS = Traits(way=Way(0.4, "unit"), masses=(Mass("tip", ("beta",), "l"), Mass("attachment")))
"""A spring in series turns by 0.4 rad at the most; a mass may sit at the end of the link, or move with the cuff."""


def measured_force(loads: Loads) -> Float[np.ndarray, "t c"]:
    """The one load is the output."""
    return loads.normal.copy()


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a number that it needs is neither parameter nor constant."""
    parameters = tuple(replace(each, name=FORMER.get(each.name, each.name)) for each in parameters)
    constants = {FORMER.get(name, name): value for name, value in constants.items()}
    require_numbers("elbow", (*LENGTHS, "k"), parameters, constants)
    return System(
        name="elbow",
        motion=Motion(INPUTS),
        geometry=ElbowMisalignment().having({name: name for name in LENGTHS}),
        law=Law(INTERFACE_LAW).having({"k": "k"}).lacking(*ABSENT),
        balance=Balance(OUTPUTS, measured_force),
        sensor=Sensor(OUTPUTS),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=UNITS,
        lengths=tuple(name for name in LENGTHS if name in constants),
        traits=TRAITS,
    )


ELBOW = Base("elbow", INPUTS, OUTPUTS, build)
