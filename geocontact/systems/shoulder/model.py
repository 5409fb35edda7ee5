"""Shoulder exoskeleton driven by recorded human motion, in the plane of elevation.

Inputs `arm [rad]` (human upper arm) and `event [-]` (1 while the tool runs; the base does not use it), outputs
`exo [rad]` (exoskeleton's arm) and `force [N]` (on the human arm, positive where it supports). Angles are counted from
hanging down, upward. Parameters k_t, b_t, m; constants L_h, o_x, o_y, I, c, l_c; covariate `level` (0 … 1) of a trial;
table `support` (`angle [rad]`, `torque [N m]`), linear between its rows and constant beyond them.

Human shoulder at the origin, hinge at (o_x, o_y), interface sphere at p = L_h (sin a, -cos a), w = p - hinge:
s = w·(sin e, -cos e) along the tube, r = w·(cos e, sin e) off its axis, N = k_t r + b_t r', force = -N,
I e'' + c e' = level τ(e) - m g l_c sin e + N s. A trial starts at rest in equilibrium.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, Loads, Motion, Sensor
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import System
from geocontact.chain.traits import Mass, Migration, Traits, Way
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base, require_numbers
from geocontact.systems.shoulder.arm import ShoulderArm

INPUTS, OUTPUTS = ("arm", "event"), ("exo", "force")
UNITS = {"arm": "rad", "event": "-", "exo": "rad", "force": "N"}
LENGTHS = ("L_h", "o_x", "o_y", "l_c")
NUMBERS = ("L_h", "o_x", "o_y", "I", "c", "l_c", "m")
COLUMNS = ("angle [rad]", "torque [N m]")
TRAITS = Traits(
    way=Way(3.0, "deflection"),
    migration=Migration(0.2, centre=0.0),
    masses=(Mass("cuff", ("arm",), "L_h"),),
)
"""o_x is known from the arm that hangs down, so that its migration is counted from there."""


def angle_and_force(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Angle of the exoskeleton's arm and force on the human one."""
    return np.column_stack((loads.moved, loads.normal))


def support_table(tables: Mapping[str, pd.DataFrame]) -> Float[np.ndarray, "two k"]:
    """Angles [rad] and torques [N m]; ValueError when there is no such table, or when it is none."""
    if "support" not in tables:
        raise ValueError(
            'shoulder: the table of support torques is missing; name it in case.toml, support = "support.csv"'
        )
    table = tables["support"]
    for column in COLUMNS:
        if column not in table.columns:
            has = ", ".join(map(str, table))
            raise ValueError(f"shoulder: the support torques have no column {column!r}; they have {has}")
    angle, torque = (np.ascontiguousarray(table[column], float) for column in COLUMNS)
    if not len(angle) or any(b <= a for a, b in pairwise(angle)):
        raise ValueError("shoulder: the angles of the support torques do not increase; sort the rows, each angle once")
    return np.array([angle, torque])


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a table, column or number that it needs is missing."""
    table = support_table(tables)
    require_numbers("shoulder", (*NUMBERS, "k_t", "b_t"), parameters, constants)
    inertia = {**constants, **{p.name: p.lower for p in parameters}}["I"]
    if not inertia > 0.0:
        raise ValueError(f"shoulder: the moment of inertia I = {inertia:g} kg m^2 is not positive")
    law = Law(INTERFACE_LAW).having({"k": "k_t", "b": "b_t"}).lacking("asymmetry.excess")
    return System(
        name="shoulder",
        motion=Motion(INPUTS),
        geometry=ShoulderArm(table, law).having({name: name for name in (*NUMBERS, "level")}),
        law=law,
        balance=Balance(OUTPUTS, angle_and_force),
        sensor=Sensor(OUTPUTS),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=UNITS,
        spare=("event",),
        lengths=tuple(name for name in LENGTHS if name in constants),
        dynamic=True,
        traits=TRAITS,
    )


SHOULDER = Base("shoulder", INPUTS, OUTPUTS, build)
