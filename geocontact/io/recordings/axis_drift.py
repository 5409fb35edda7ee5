"""Table of how a joint's axis drifts with the angle; which of three things it tells is in its columns' names."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.text.side_table import read_side_table

SETS = {
    "exoskeleton": ("beta [rad]", "x [m]", "y [m]"),
    "joint": ("alpha [rad]", "x [m]", "y [m]"),
    "instant centre": ("alpha [rad]", "instant_centre_x [m]", "instant_centre_y [m]"),
}
"""Columns by what a table tells: offsets over the exoskeleton's or the joint's angle, or the instant centre."""

LARGEST_ANGLE = 2.0 * np.pi
"""rad; a table of more is in degrees."""


@dataclass(frozen=True, eq=False)
class DriftTable:
    """What it tells (a key of `SETS`), angles [rad], and x, y [m]."""

    tells: str
    angle: Float[np.ndarray, " n"]
    x: Float[np.ndarray, " n"]
    y: Float[np.ndarray, " n"]


def read_axis_drift(path: Path) -> DriftTable:
    """The table in SI units; InputError unless it holds exactly one of the three sets of columns."""
    table = read_side_table(path, {name for columns in SETS.values() for name in columns})
    fitting = [name for name, columns in SETS.items() if set(columns) == set(table.columns)]
    if not fitting:
        what = f"columns are {', '.join(map(str, table.columns))}"
        remedy = (
            "write beta or alpha [deg], x [mm], y [mm], or alpha [deg], instant_centre_x [mm], instant_centre_y [mm]"
        )
        raise InputError(path, "line 1", what, remedy)
    angle, x, y = (table[column].to_numpy(float) for column in SETS[fitting[0]])
    if np.abs(angle).max() > LARGEST_ANGLE:
        raise InputError(path, "", f"angles reach {np.abs(angle).max():.4g} rad", "are these degrees? write [deg]")
    return DriftTable(fitting[0], angle, x, y)
