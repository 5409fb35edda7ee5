"""Whether angles in a table are in the unit that its header says, held against the ranges of a model's coordinates."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from math import inf, pi

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.joint import Coordinate, JointModel
from geocontact.data.multibody.model import GROUND
from geocontact.io.text.columns import LARGEST_RADIANS
from geocontact.io.text.tables import TextTable

BEYOND = 1.0
"""Radians that a motion may leave the range of its coordinate: ranges are drawn generously, and not all are kept."""

HALF_TURN = (-pi, pi)
"""Range of a joint angle whose model states none; no joint of the body turns further."""


def refuse_degrees_as_radians(
    table: TextTable,
    joints: Sequence[JointModel],
    columns: Mapping[str, str],
    found: Mapping[str, Float[np.ndarray, " t"]],
    angles: str | None,
) -> None:
    """InputError for angles read as radians that leave their range by a radian and are within it as degrees.

    Joints that free a body of the ground are left out: which way a subject faces has no range. Where the user said
    `angles` himself it is a warning.
    """
    for joint in joints:
        free = joint.parent == GROUND and len(joint.coordinates) == 6
        for c in joint.coordinates:
            if not free and c.kind == "rotational" and c.name in columns:
                _judge(table, c, columns[c.name], found[c.name], angles)


def _judge(table: TextTable, c: Coordinate, column: str, values: Float[np.ndarray, " t"], angles: str | None) -> None:
    raw = table.column(column)
    low, high = c.limits if c.limits != (-inf, inf) else HALF_TURN
    excess = np.maximum(values - high, low - values)
    row = int(np.argmax(excess))
    as_degrees = np.radians(raw)
    fits = low - BEYOND <= as_degrees.min() and as_degrees.max() <= high + BEYOND
    if excess[row] <= BEYOND or not fits or not np.array_equal(raw, values):
        return
    whose = "range" if c.limits != (-inf, inf) else "half turn of a joint"
    what = (
        f"column '{column}' is {raw.min():.3g} to {raw.max():.3g}: as radians beyond the {whose} {low:.3g} to "
        f"{high:.3g} of {c.name}, within it as degrees"
    )
    if angles is None:
        raise InputError(table.file, f"line {table.lines[row]}", what, "pass `angles` deg or rad")
    if np.abs(raw).max() <= LARGEST_RADIANS:  # beyond it the column is warned of where it is read
        line = f"{table.file} line {table.lines[row]}: {what}; read as {angles} as asked for"
        warnings.warn(InputWarning(line), stacklevel=5)
