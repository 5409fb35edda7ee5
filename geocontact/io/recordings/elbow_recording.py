"""Recordings of an exoskeleton at an elbow: tables over time or analog channels of a .c3d file, to SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.io.mocap.c3d_analogs import read_c3d_analogs
from geocontact.io.recordings.load_cells import column_in_newtons
from geocontact.io.text.columns import angles_of, lengths, resolve
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.io.text.units import DIMENSIONS, si_unit

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


BETA, FORCE, DISPLACEMENT, PRESSURE, TORQUE = "beta", "force", "displacement", "pressure", "torque"
MOMENT, ALPHA, TARGET = "moment", "alpha", "target"
CHANNELS = (BETA, FORCE, DISPLACEMENT, PRESSURE, TORQUE, MOMENT, ALPHA, TARGET)
"""What is looked for, by these names unless mapped; all but the first two may be missing."""

Mapped = Mapping[str, tuple[float, str]]

STRAIGHTEST, MOST_BENT = np.radians(-30.0), np.radians(180.0)
"""Angles [rad] beyond which nothing is an elbow's."""
LEAST_TURN = np.radians(10.0)
"""A smaller range [rad] tells nothing of offsets."""
TURN_OF_ANY_ELBOW = np.radians(3.3)
"""A range [rad] below which a column of degrees may well hold radians."""
STRONGEST, FARTHEST = 2000.0, 0.5
"""No cuff bears more [N], and no compensation joint slides farther [m]."""
TIGHTEST = 1000.0 * DIMENSIONS["Pa"]["mmHg"]
"""No cuff is pumped to more [Pa]."""
HARDEST = 1000.0
"""No actuator of an arm turns harder [N m]."""
TWISTED = 200.0
"""No cuff around a forearm is twisted harder [N m]."""
AGAINST = -0.5
"""Correlation with the exoskeleton's angle below which another angle has its sign turned."""


def read_elbow_recording(
    path: Path, mapping: Mapped, angles: str | None = None, unit: str | None = None, needed: tuple[str, ...] = (FORCE,)
) -> ElbowRecording:
    """One trial from a .csv, .mot, .sto or .c3d file, named after the file.

    Parameters
    ----------
    mapping
        Sign and name of the column that holds a channel, by channel.
    angles, unit
        Unit of the angle and of the force where the file does not say; see `angles_of` and `column_in_newtons`.
    needed
        Channels that must be there besides the angle; a force that is not needed and not there is 0 throughout.

    Refused: angles that no elbow has, that hardly change or are turned over, degrees and radians taken for each other,
    forces and displacements of an absurd size, and values that are missing.
    """
    table = read_c3d_analogs(path) if path.suffix.lower() == ".c3d" else read_table(path)
    if table.time_unit != "s":
        raise InputError(table.file, "", "time is in per cent of a cycle", "give a recording in seconds")
    if len(table.time) < 2:
        raise InputError(table.file, "", "holds one sample", "give a recording over time")
    source = {channel: _source(table, channel, mapping, channel in (BETA, *needed)) for channel in CHANNELS}
    sign, name = source[BETA] or (1.0, BETA)
    beta = sign * angles_of(table, [name], angles)[:, 0]
    require_elbow(beta, table.file, name)
    force = _force(table, source[FORCE], unit)
    return ElbowRecording(
        path.stem,
        table.time,
        beta,
        force,
        _length(table, source[DISPLACEMENT]),
        _pressure(table, source[PRESSURE]),
        _torque(table, source[TORQUE]),
        _moment(table, source[MOMENT]),
        _angle_beside(table, source[ALPHA], angles, beta),
        _angle_beside(table, source[TARGET], angles, beta),
    )


def require_elbow(beta: Float[np.ndarray, " t"], file: str, name: str) -> None:
    """Refuse angles [rad] that are not those of an elbow that moves, flexion positive."""
    low, high = (float(np.degrees(end)) for end in (beta.min(), beta.max()))
    span = f"angle '{name}' runs from {low:.3g} to {high:.3g} degrees"
    if beta.max() - beta.min() < TURN_OF_ANY_ELBOW and high - low > 0.5:
        what = f"{span}, too little for an elbow in degrees: are these radians?"
        raise InputError(file, "", what, "name the right unit in the header, or pass `angles` rad")
    if beta.max() - beta.min() < LEAST_TURN:
        raise InputError(file, "", f"{span}: it hardly changes", "give a recording that moves by 10 degrees or more")
    if beta.max() <= 0.0 or (beta.max() <= LEAST_TURN and beta.min() < STRAIGHTEST):
        raise InputError(file, "", f"{span}: flexion is positive here", f"turn its sign: `map` {BETA}=-{name}")
    if beta.min() < STRAIGHTEST or beta.max() > MOST_BENT:
        what = f"{span}, beyond any elbow: are degrees taken for radians, or is its zero elsewhere?"
        raise InputError(file, "", what, "pass `angles` deg or rad, or subtract the zero")


def _source(table: TextTable, channel: str, mapping: Mapped, must: bool) -> tuple[float, str] | None:
    sign, name = mapping.get(channel, (1.0, channel))
    found = resolve(table, name)
    if found is None and (must or channel in mapping):
        what = f"no column '{name}' for {channel}; columns are: {listed(table.channels)}"
        raise InputError(table.file, "", what, f"name it: `map` {channel}=NAME")
    return None if found is None else (sign, found)


def _force(table: TextTable, source: tuple[float, str] | None, unit: str | None) -> Float[np.ndarray, " t"]:
    if source is None:
        return np.zeros(len(table.time))
    sign, name = source
    newtons, said = column_in_newtons(table, name, unit)
    largest = float(np.abs(newtons).max())
    if largest > STRONGEST:
        what = f"'{name}' reaches {largest:.4g} N, more than any cuff carries"
        raise InputError(table.file, "", what, f"is it in {said} at all?")
    if float(np.ptp(newtons)) == 0.0:
        raise InputError(table.file, "", f"'{name}' is {newtons[0]:g} N throughout", "is the right column named?")
    return np.asarray(sign * newtons)


def _length(table: TextTable, source: tuple[float, str] | None) -> Float[np.ndarray, " t"] | None:
    if source is None:
        return None
    sign, name = source
    metres = lengths(table, [name])[:, 0]
    largest = float(np.abs(metres).max())
    if largest > FARTHEST:
        what = f"'{name}' reaches {largest * 1e3:.4g} mm, more than any compensation joint slides"
        raise InputError(table.file, "", what, "name its unit in the header, for example displacement [mm]")
    return np.asarray(sign * metres)


def _pressure(table: TextTable, source: tuple[float, str] | None) -> Float[np.ndarray, " t"] | None:
    return None if source is None else _bounded(table, source, "Pa", "mmHg", TIGHTEST, "any cuff is pumped to")


def _torque(table: TextTable, source: tuple[float, str] | None) -> Float[np.ndarray, " t"] | None:
    return (
        None if source is None else _bounded(table, source, "N m", "N m", HARDEST, "an actuator of an arm turns with")
    )


def _moment(table: TextTable, source: tuple[float, str] | None) -> Float[np.ndarray, " t"] | None:
    return None if source is None else _bounded(table, source, "N m", "N m", TWISTED, "any cuff passes on")


def _angle_beside(
    table: TextTable, source: tuple[float, str] | None, angles: str | None, beta: Float[np.ndarray, " t"]
) -> Float[np.ndarray, " t"] | None:
    """An angle that goes with `beta` [rad]; refused where it runs against it, or is that of no elbow."""
    if source is None:
        return None
    sign, name = source
    found = np.asarray(sign * angles_of(table, [name], angles)[:, 0])
    require_elbow(found, table.file, name)
    with np.errstate(invalid="ignore"):
        along = float(np.corrcoef(found, beta)[0, 1])
    if along < AGAINST:
        what = f"angle '{name}' runs against the exoskeleton's (correlation {along:.2f})"
        raise InputError(table.file, "", what, "is its sign turned, or is it the angle between the bones?")
    return found


def _bounded(
    table: TextTable, source: tuple[float, str], si: str, usual: str, most: float, than: str
) -> Float[np.ndarray, " t"]:
    """A channel in SI whose header has to name its unit, refused where it is more than can be."""
    sign, name = source
    values = table.needed(name)
    said = table.units[table.channels.index(name)]
    known = si_unit(said) if said else None
    if known is None or known[0] != si:
        what = f"'{name}' is in '{said}'" if said else f"'{name}' has no unit"
        raise InputError(table.file, "", what, f"write {name} [{usual}] (one of {', '.join(DIMENSIONS[si])})")
    found = np.asarray(sign * values * known[1])
    largest = float(np.abs(found).max())
    if largest > most:
        what = f"'{name}' reaches {largest / known[1]:.4g} {said}, more than {than}"
        raise InputError(table.file, "", what, "is it in that unit at all?")
    return found
