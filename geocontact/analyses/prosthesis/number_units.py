"""SI unit of each number of a prosthetic leg and foot by its name, for the pages."""

from __future__ import annotations

import re

import pandas as pd

NOTHING = 1e-12  # of any of these numbers in SI: what is smaller is rounding
RULES = (
    (r"leg (?:.*_)?mass|pelvis mass", "kg"),
    (r"pelvis centre_[xyz]|stature", "m"),
    (r"pelvis I[xyz]{2}", "kg m²"),
    (r"leg .*_density", "kg/m³"),
    (r"leg (?:residual_share|ankle_over_knee_radius)", "-"),
    (r"leg (?:turn_[xyz]|foot_pitch(?:_sd)?)", "rad"),
    (r"leg prosthesis_I[xyz]{2}", "kg m²"),
    (r"leg .*(?:_length|_radius|_centre|_height|_height_sd|_[xyz])", "m"),
    (r"socket_r[xyz] stiffness", "N m/rad"),
    (r"socket_t[xyz] stiffness", "N/m"),
    (r"socket_r[xyz] damping", "N m s/rad"),
    (r"socket_t[xyz] damping", "N s/m"),
    (r"fulcrum|keel (?:length|posterior|width|thickness)", "m"),
    (r"keel joints", "-"),
    (r"keel density", "kg/m³"),
    (r"keel retardation", "s"),
    (r"keel (?:bending|torsional)", "N m²"),
    (r"keel (?:stiffness_\d+|torsion|hysteresis)", "N m/rad"),
    (r"keel friction", "N m"),
    (r"keel presliding", "rad"),
    (r"keel section_\d+_from", "m"),
    (r"keel section_\d+_factor", "-"),
    (r"sole .*_(?:static|kinetic)|sole (?:exponent|across)", "-"),
    (r"sole .*_damping", "N s/m"),
    (r"sole .*_modulus", "Pa"),
    (r"sole .*_retardation", "s"),
    (r"sole (?:breadth|column|.*_(?:to|thickness))", "m"),
    (r"sole threshold_speed", "m/s"),
    (r"sole (?:radius|below|full_depth|.*_\d+_(?:[xyz]|radius))", "m"),
    (r"gravity", "m/s²"),
)
"""Whole names and units; of two that match, the first."""


def unit_of(name: str, linear: bool = True) -> str:
    """Unit of a number; empty where no rule has its name. `linear`: the exponent n of the sole's law is 1."""
    if name.startswith("sole ") and name.endswith("_stiffness"):
        return "N/m" if linear else "N/m^n"
    name = re.sub(r"^(?:prosthetic|intact) ", "leg ", name)
    return next((unit for rule, unit in RULES if re.fullmatch(rule, name)), "")


def with_units(numbers: pd.DataFrame) -> pd.DataFrame:
    """`numbers` of a result with a column of units; rounding errors are 0."""
    exponent = numbers.loc[numbers["number"] == "sole exponent", "value"]
    linear = bool((exponent == 1.0).all())
    found = numbers.assign(value=numbers["value"].where(numbers["value"].abs() > NOTHING, 0.0))
    found.insert(2, "unit", [unit_of(name, linear) or unit_of(f"leg {name}", linear) for name in numbers["number"]])
    return found
