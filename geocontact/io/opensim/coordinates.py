"""Values of a model's coordinates in a table of motion, by name or by path (`/jointset/joint/name/value`)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from functools import partial
from math import inf, pi

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.joint import Coordinate, JointModel
from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.io.text.columns import LARGEST_RADIANS, angles_of, lengths, resolve
from geocontact.io.text.tables import TextTable, listed

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


def motion_of(table: TextTable, model: Multibody, angles: str | None = None) -> Float[np.ndarray, "t n"]:
    """All coordinates of a model in its order [rad, m]; those without a column at their default, with a warning.

    One without a column that depends on others is what these make it.
    """
    columns = columns_of(table, model.joints)
    found = coordinates_of(table, model.joints, columns, angles)
    followers = {coupler.dependent for coupler in model.couplers}
    own = [c for c in model.coordinates if c.name not in followers]
    warn_of_defaults(table, own, columns, model.name or "the model")
    frames = len(table.time)
    values = np.column_stack([found.get(c.name, np.full(frames, c.default)) for c in model.coordinates])
    follows = np.array([c.name in followers and c.name not in found for c in model.coordinates])
    return np.where(follows, model.coupled(values), values)


def columns_of(table: TextTable, joints: Sequence[JointModel]) -> dict[str, str]:
    """Columns by the coordinates that they hold; a table with none of those that there are is refused."""
    named = [(joint, c) for joint in joints for c in joint.coordinates]
    columns = {c.name: column for joint, c in named if (column := resolve(table, c.name, joint.name))}
    if named and not columns:
        of = f"joint {joints[0].name}" if len(joints) == 1 else "the model"
        what = f"no column for any coordinate of {of} ({listed(tuple(c.name for _, c in named))})"
        raise InputError(table.file, "", what, f"columns are: {listed(table.channels)}")
    return columns


def warn_of_defaults(table: TextTable, coordinates: Sequence[Coordinate], columns: Mapping[str, str], of: str) -> None:
    """Say which coordinates have no column and what they are taken to be."""
    absent = [c for c in coordinates if c.name not in columns]
    if absent:
        values = ", ".join(f"{c.name} = {c.default:g}" for c in absent)
        what = f"no column for {len(absent)} coordinate(s) of {of}; default taken: {values}"
        warnings.warn(InputWarning(f"{table.file}: {what}"), stacklevel=4)


def coordinates_of(
    table: TextTable, joints: Sequence[JointModel], columns: Mapping[str, str], angles: str | None
) -> dict[str, Float[np.ndarray, " t"]]:
    """Values of the joints' coordinates that have a column [rad, m]; InputError for degrees called radians.

    A coupled one stands in the file as in the model, in rad or m, also where OpenSim writes the others in degrees.
    """
    found = [c for joint in joints for c in joint.coordinates if c.name in columns]
    q: dict[str, Float[np.ndarray, " t"]] = {}
    for kind, read in (("rotational", partial(angles_of, angles=angles)), ("translational", lengths)):
        names = [c.name for c in found if c.kind == kind]
        if names:
            q.update(zip(names, read(table, [columns[name] for name in names]).T, strict=True))
    refuse_degrees_as_radians(table, joints, columns, q, angles)
    for name in (c.name for c in found if c.kind == "coupled"):
        q[name] = table.needed(columns[name])
        if "deg" in (angles, table.angles.unit):
            what = f"column '{columns[name]}' is not a plain rotation; read in rad or m as OpenSim writes it"
            warnings.warn(InputWarning(f"{table.file}: {what}"), stacklevel=3)
    return q
