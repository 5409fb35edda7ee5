"""Knee implant: medial and lateral force from the sides' contact areas, F = (4/3) E* a³/R, a = sqrt(area/π).

Inputs `flexion [rad]`, `adduction [rad]`, `area_medial [m^2]`, `area_lateral [m^2]`; the base uses the areas only.
Outputs `force_medial [N]`, `force_lateral [N]`. Parameter E_star [Pa], constant or fixed parameter R [m]. Only E*/R can
be told from areas and forces.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, Loads, Motion, Sensor, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import System
from geocontact.chain.traits import Migration, Traits
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base, require_numbers
from geocontact.systems.knee.contact import AREAS, KneeContact

INPUTS, OUTPUTS = ("flexion", "adduction", *AREAS), ("force_medial", "force_lateral")
UNITS = {"flexion": "rad", "adduction": "rad", **dict.fromkeys(AREAS, "m^2"), **dict.fromkeys(OUTPUTS, "N")}
STRAPS = (
    *("slip.mobility", "dead_zone.width", "stiffening.gain", "end_stop.upper.stiffness", "end_stop.lower.stiffness"),
    *("damping.b", "dry_friction.stroke.limit", "dry_friction.rate.limit", "preload.tension"),
    "contact_loss.opening",
)
"""Terms of the law that an implant does not have: they stay neutral and are not offered."""
TRAITS = Traits(plausible=dict.fromkeys(AREAS, 0.8), migration=Migration(2.0))
"""A radius changes by twice itself per radian at the most; an area is wrong by 0.8 of its half-range at the most."""


def stiffness(values: Values) -> float:
    """(4/3) E* [Pa]: force over a³/R."""
    return 4.0 / 3.0 * values["E_star"]


def measured_forces(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Each side's load is an output."""
    return loads.normal.copy()


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a number that it needs is neither parameter nor constant."""
    require_numbers("knee", ("R", "E_star"), parameters, constants)
    return System(
        name="knee",
        motion=Motion(INPUTS),
        geometry=KneeContact().having({"R": "R"}),
        law=Law(INTERFACE_LAW, deflection="m^2").having({"k": stiffness}).lacking(*STRAPS),
        balance=Balance(OUTPUTS, measured_forces),
        sensor=Sensor(OUTPUTS),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=UNITS,
        spare=("flexion", "adduction"),
        lengths=tuple(name for name in ("R",) if name in constants),
        traits=TRAITS,
    )


KNEE = Base("knee", INPUTS, OUTPUTS, build)
