"""Elastic joint: moment = k u, u = φ (1 + h φ²), φ = angle - angle0, or u along a curve that is measured.

Input `angle [rad]`, output `torque [N m]`, positive where it resists a positive angle. Parameter k [N m/rad]; angle0
[rad] and h, `hardening` [1/rad^2], are 0 where the case does not give them. With `growth` and `bend` the stiffness
depends on the trial's covariate `setting`: k exp(growth setting + bend setting²), positive whatever they are.

With a table `curve` (`angle [rad]`, `torque [N m]`, angle increasing) u = torque(φ)/k_curve (1 + h φ²), where k_curve
is the slope of the line through the ends of the curve; so u is an angle, and k = k_curve is the curve itself. Between
its points the curve is a cubic without overshoot (Fritsch & Carlson 1980), beyond its ends straight.

Deflection is u: damping, friction, play, stops, slip and relaxation act on it as anywhere else, in N m and rad.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from math import exp

import numpy as np
import pandas as pd
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator

from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, Loads, Motion, Sensor, Source, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.single_deflection import Deflect, SingleDeflection
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base, require_numbers

INPUTS, OUTPUTS = ("angle",), ("torque",)
UNITS = {"angle": "rad", "torque": "N m"}
OPTIONAL = ("angle0", "hardening", "growth", "bend")
COLUMNS = ("angle [rad]", "torque [N m]")
LARGEST_GROWTH = 50.0
"""Logarithm of how much stiffer a setting can be; more would not be a finite number for long."""


def straight(angle: Float[np.ndarray, " t"], values: Values) -> Float[np.ndarray, " t"]:
    """Deflection of a joint that hardens at most, φ (1 + h φ²)."""
    turned = angle - values.get("angle0", 0.0)
    return turned * (1.0 + values.get("hardening", 0.0) * turned**2)


def following(curve: pd.DataFrame) -> Deflect:
    """Deflection along a curve; ValueError when it cannot be one."""
    for column in COLUMNS:
        if column not in curve.columns:
            raise ValueError(f"elastic joint: the curve has no column {column!r}; it has {', '.join(map(str, curve))}")
    angle, torque = (curve[column].to_numpy(float) for column in COLUMNS)
    if len(angle) < 2 or any(b <= a for a, b in pairwise(angle)):
        raise ValueError("elastic joint: the curve needs two angles or more, each larger than the one before")
    secant = (torque[-1] - torque[0]) / (angle[-1] - angle[0])
    if secant <= 0.0:
        raise ValueError("elastic joint: the curve's torque is not larger at its last angle than at its first")
    inside = PchipInterpolator(angle, torque / secant)
    slope = inside.derivative()(angle[[0, -1]])

    def deflect(angles: Float[np.ndarray, " t"], values: Values) -> Float[np.ndarray, " t"]:
        turned = angles - values.get("angle0", 0.0)
        within = np.clip(turned, angle[0], angle[-1])
        beyond = np.where(turned > within, slope[1], slope[0]) * (turned - within)
        return np.asarray((inside(within) + beyond) * (1.0 + values.get("hardening", 0.0) * turned**2))

    return deflect


def stiffness_at_setting(values: Values) -> float:
    """k exp(growth setting + bend setting²)."""
    setting = values["setting"]
    growth = values.get("growth", 0.0) * setting + values.get("bend", 0.0) * setting**2
    return values["k"] * exp(min(growth, LARGEST_GROWTH))


def measured_torque(loads: Loads) -> Float[np.ndarray, "t c"]:
    """The one load is the output."""
    return loads.normal.copy()


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when it lacks a number, has one that it does not know, or a curve that is none."""
    require_numbers("elastic joint", ("k",), parameters, constants, positive=("k",))
    for parameter in parameters:
        if parameter.name not in ("k", *OPTIONAL):
            raise ValueError(f"elastic joint: no parameter {parameter.name}; it has k, {', '.join(OPTIONAL)}")
    given = {p.name for p in parameters} | set(constants)
    k: Source = stiffness_at_setting if given & {"growth", "bend"} else "k"
    return System(
        name="elastic_joint",
        motion=Motion(INPUTS),
        geometry=SingleDeflection("angle", following(tables["curve"]) if "curve" in tables else straight),
        law=Law(INTERFACE_LAW, load="N m", deflection="rad").having({"k": k}),
        balance=Balance(OUTPUTS, measured_torque),
        sensor=Sensor(OUTPUTS),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=UNITS,
    )


JOINT = Base("elastic_joint", INPUTS, OUTPUTS, build)
