"""A sixth listed system, all that it is in one file: a thumb on a sprung pad of a handle that somebody swings.

Inputs `press [m]` (the pad against the handle) and `swing [rad]` (the handle in space), output `force [N]`, k press.
"""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, Motion, Sensor
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.single_deflection import SingleDeflection
from geocontact.chain.system import System
from geocontact.chain.traits import Mass, Traits, Way
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base

INPUTS, OUTPUTS = ("press", "swing"), ("force",)
TRAITS = Traits(
    roles={"press": "displacement"},
    pushes_only=True,
    plausible={"press": 0.5, "swing": 0.1},
    way=Way(0.25, "deflection"),
    masses=(Mass("thumb", ("swing",), "reach"),),
)


def build(parameters: tuple[Parameter, ...], constants: Mapping[str, float], _: Mapping[str, pd.DataFrame]) -> System:
    """The base model."""
    return System(
        name="thumb",
        motion=Motion(INPUTS),
        geometry=SingleDeflection("press", lambda press, _: press),
        law=Law(INTERFACE_LAW).having({"k": "k"}).lacking("asymmetry.excess", "preload.tension"),
        balance=Balance(OUTPUTS, lambda loads: loads.normal.copy()),
        sensor=Sensor(OUTPUTS),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units={"press": "m", "swing": "rad", "force": "N"},
        traits=TRAITS,
    )


THUMB = Base("thumb", INPUTS, OUTPUTS, build)
