"""Ground reactions measured by force plates: OpenSim's .mot and .sto, tables with units, and .c3d."""

from __future__ import annotations

import re
import warnings
from os import PathLike, fspath
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.force_plate import LOADED, ForcePlate
from geocontact.data.wrench import Wrench
from geocontact.io.mocap.c3d_plates import MOMENTS_LAST, Arrays, PlateUnits, plate_units, read_c3d_plates
from geocontact.io.mocap.plate_zero import zero_samples
from geocontact.io.text.tables import CELLS, TextTable, listed, read_table
from geocontact.io.text.units import si_unit

OUTSIDE = 0.2
"""Share of a plate's length, beyond its edge: farther off, the median centre of pressure is warned of."""

FAR = 1.0
"""Share of a plate's length, beyond its edge: farther off, the plate cannot be used."""

OPENSIM_FRAME = "ground of the .mot (OpenSim, y up)"
LABORATORY_FRAME = "laboratory of the .c3d"
WORN = 0.4
"""Share of the body's weight that a force may press down with as a device that is worn: of a plate the wrong way round
half of it and more, by one of two feet that stand."""

STEEP = 0.7
"""Share of a force that is along the plate's normal, in the median under load: of a foot it is near 1, since
walking people's shear is a tenth of the load."""

RETURNS = 10.0
"""Load [N] below which a plate has returned to nothing."""

_WITH_CENTRE = 1  # type of plate whose channels hold the centre of pressure: no offset of it can be taken off
_FORCE = re.compile(r"(?P<head>.*)force(?P<tail>.*)vx", re.IGNORECASE)


def read_force_plates(path: str | PathLike[str], c3d_unit: str | None = None) -> tuple[ForcePlate, ...]:
    """All force plates of a .mot, .sto, .c3d, .csv or .xlsx file, in its order; forces are those on the foot.

    Columns of a .csv have the names of OpenSim's and their units: `ground_force_vx [N]`, `ground_force_px [mm]`.
    `c3d_unit` is the unit of places in a .c3d file whose own is empty.
    """
    suffix = Path(fspath(path)).suffix.lower()
    if suffix == ".c3d":
        return _from_c3d(path, c3d_unit)
    if suffix in (".mot", ".sto", *CELLS):
        return _from_table(read_table(path))
    raise InputError(path, "", f"'{suffix}' is not a file of ground reactions", "give a .mot, .sto, .c3d or .csv file")


def plate_named(
    plates: tuple[ForcePlate, ...],
    name: str | None,
    path: Path,
    option: str,
    weight: float = 0.0,
    in_ground: bool = True,
) -> ForcePlate:
    """The plate of this name or number, counted from 1; the only one where none is named.

    A plate that pulls at the foot is refused: its file holds the forces on the plate. A force whose opposite is there
    too is none of a plate, but between two bodies. One whose centre of pressure lies off its own surface by more than a
    plate's length is refused too.

    Parameters
    ----------
    option
        How the user names a plate, for messages.
    weight
        Of the body [N], where the force may be that of a device worn on it: up to `WORN` of that it may press down,
        which is said.
    in_ground
        Whether the force is in the axes of the ground; in those of a body nothing is known of up and down.
    """
    plate = _named(plates, name, path, option)
    if plate.outside() > FAR:
        raise InputError(path, plate.name, _off(plate), _OFF_REMEDY)
    if in_ground:
        _require_up(plate, plates, path, weight)
    return plate


def _require_up(plate: ForcePlate, plates: tuple[ForcePlate, ...], path: Path, weight: float) -> None:
    """Check of the usual force under load: InputError where it presses down, a warning where a device may do so."""
    usual = plate.usual_load(plates)
    if usual >= 0.0:
        return
    up = "xyz"[int(np.argmax(np.abs(plate.normal)))]
    what = f"its force along {up}, which is up, is {usual:.4g} N under load"
    if -usual > WORN * weight and plate.steepness() < STEEP:
        remedy = "are the plate's axes exchanged, or is another one up?"
        raise InputError(path, plate.name, f"{what}, {plate.steepness():.0%} of the force", remedy)
    if -usual > WORN * weight:
        remedy = "give the force on the foot: turn the sign of forces and torques"
        raise InputError(path, plate.name, f"{what}: that is the force on the plate", remedy)
    part = f"{-usual / weight:.0%} of the model's weight"
    warnings.warn(
        InputWarning(f"{path} {plate.name}: {what}, {part}: it presses down, as a worn device does"),
        stacklevel=4,
    )


def _named(plates: tuple[ForcePlate, ...], name: str | None, path: Path, option: str) -> ForcePlate:
    names = [plate.name for plate in plates]
    if name is None:
        if len(plates) == 1:
            return plates[0]
        remedy = f"pass {option} NAME or its number"
        raise InputError(path, "", f"holds {len(plates)} plates: {', '.join(names)}", remedy)
    if name in names:
        return plates[names.index(name)]
    if name.isdecimal() and 1 <= int(name) <= len(plates):
        return plates[int(name) - 1]
    remedy = f"plates are: {', '.join(names)} (or 1 to {len(plates)})"
    raise InputError(path, option, f"no plate {name!r}", remedy)


def _from_table(table: TextTable) -> tuple[ForcePlate, ...]:
    """Every `…force…vx, vy, vz` with its points `…force…px` and torques `…torque…x` or `…moment…x`."""
    found = [(name, match) for name in table.channels if (match := _FORCE.fullmatch(name))]
    if not found:
        what = "no column of the form ground_force_vx"
        raise InputError(table.file, "", what, f"columns are: {listed(table.channels)}")
    return tuple(_plate(table, match["head"], match["tail"]) for _, match in found)


def _plate(table: TextTable, head: str, tail: str) -> ForcePlate:
    name = f"{head}force{tail}".strip("_")
    force = _three(table, f"{head}force{tail}v", "N")
    point = _three(table, f"{head}force{tail}p", "m")
    kinds = [f"{head}{word}{tail}{letter}" for word in ("torque", "moment") for letter in ("", "m")]
    torque = next((kind for kind in kinds if f"{kind}x" in table.channels), None)
    if torque is None:
        warnings.warn(InputWarning(f"{table.file}: no torque for {name}; its free moment is not known"), stacklevel=4)
    moment = np.full_like(force, np.nan) if torque is None else _three(table, torque, "N m")
    on = np.linalg.norm(force, axis=1) >= LOADED
    if not on.any():
        warnings.warn(InputWarning(f"{table.file}: {name} never carries {LOADED:g} N"), stacklevel=4)
    surface = np.array([0.0, float(np.median(point[on, 1])) if on.any() else 0.0, 0.0])
    if torque is None:  # the point is then the centre of pressure by the file's own word
        moment[:, [0, 2]] = 0.0
    wrench = Wrench(force, moment, point, OPENSIM_FRAME)
    return ForcePlate(name, table.time, wrench, surface, np.array([0.0, 1.0, 0.0]))


def _three(table: TextTable, stem: str, si: str) -> Float[np.ndarray, "t 3"]:
    names = tuple(f"{stem}{axis}" for axis in "xyz")
    for name in names:
        if table.channels.count(name) != 1:
            count = table.channels.count(name)
            what = f"column '{name}' occurs {count} times" if count else f"no column '{name}'"
            raise InputError(table.file, "", what, f"columns are: {listed(table.channels)}")
    values = np.column_stack([table.column(name) * _factor(table, name, si) for name in names])
    endless = np.argwhere(np.isinf(values))
    if len(endless):
        row, column = endless[0]
        what = f"'{names[column]}' is {values[row, column]}"
        raise InputError(table.file, f"line {table.lines[row]}", what, "write NaN where nothing was measured")
    return values


def _factor(table: TextTable, name: str, si: str) -> float:
    """How many SI units one unit of a column is; OpenSim's files are in SI and name none."""
    if Path(table.file).suffix.lower() not in CELLS:
        return 1.0
    written = table.units[table.channels.index(name)]
    known = si_unit(written)
    if known is None or known[0] != si:
        what = f"column '{name}' has no unit" if not written else f"'{written}' is not a unit in which {name} can be"
        raise InputError(table.file, "", what, f"name it '{name} [{si}]'")
    return known[1]


def _from_c3d(path: str | PathLike[str], c3d_unit: str | None) -> tuple[ForcePlate, ...]:
    """Plates as ezc3d calibrates and turns them into the laboratory: moment about the middle of the surface."""
    file = fspath(path)
    arrays = read_c3d_plates(path)
    rate, count = float(arrays["rate"]), sum(name.startswith("force_") for name in arrays)
    if not count:
        labels = listed(tuple(str(label) for label in arrays["labels"]), 80)
        remedy = f"give a file recorded with force plates; analog channels are: {labels}"
        raise InputError(file, "", "holds no force plate", remedy)
    if not rate > 0.0 or not np.isfinite(rate):
        raise InputError(file, "", f"analogue rate is {rate:g} Hz", "is the file complete?")
    if bool(arrays["polynomial"]):
        what = "FORCE_PLATFORM:FPCOPPOLY, Kistler's correction of the centre of pressure, is not applied"
        warnings.warn(InputWarning(f"{file}: {what}"), stacklevel=4)
    return tuple(_c3d_plate(file, arrays, k, c3d_unit) for k in range(count))


_OFF_REMEDY = "check POINT:UNITS, ANALOG:UNITS, and ORIGIN, CORNERS and CHANNEL of FORCE_PLATFORM"


def _off(plate: ForcePlate) -> str:
    return f"under load its centre of pressure lies {plate.outside():.2g} plate's lengths outside of it (median)"


def _c3d_plate(file: str, arrays: Arrays, k: int, c3d_unit: str | None) -> ForcePlate:
    name = f"plate {k + 1}"
    channels = list(map(str, arrays[f"units_{k}"]))
    units = plate_units(file, name, int(arrays[f"type_{k}"]), str(arrays["unit"]), channels, c3d_unit)
    corners = arrays[f"corners_{k}"] * units.metre
    with np.errstate(over="ignore", invalid="ignore"):
        down = np.cross(corners[0] - corners[1], corners[0] - corners[3])
        area = float(np.linalg.norm(down))
        force, moment = arrays[f"force_{k}"] * units.newton, _moment(arrays, k, units)
    if not (1e-4 < area < 100.0) or not (np.isfinite(force).all() and np.isfinite(moment).all()):
        what = f"its corners span {area:.3g} m^2" if np.isfinite(force).all() else "its forces are not finite"
        raise InputError(file, name, what, "is the file damaged?")
    normal = -down / area
    doubts = [units.doubt, *_clipped(arrays, k)]
    if int(arrays[f"type_{k}"]) != _WITH_CENTRE:
        per_frame = max(len(force) // max(int(arrays["frames"]), 1), 1)
        zero = zero_samples(force @ normal, arrays["zero"], per_frame)
        doubts.append(zero.doubt)
        if zero.samples is not None:
            force, moment = (values - values[zero.samples].mean(axis=0) for values in (force, moment))
    pushing = force @ normal
    loaded = pushing[np.abs(pushing) >= LOADED]
    if len(loaded) and np.median(loaded) < 0.0:  # a plate can only push; the file holds the force on the plate
        force, moment = -force, -moment
    time = float(arrays["start"]) + np.arange(len(force)) / float(arrays["rate"])
    middle = corners.mean(axis=0)
    origin = np.broadcast_to(middle, force.shape).copy()
    plate = ForcePlate(name, time, Wrench(force, moment, origin, LABORATORY_FRAME), middle, normal, corners)
    said = [doubt for doubt in (*doubts, *_doubts(plate)) if doubt]
    if said:
        warnings.warn(InputWarning(f"{file}: {name}: {'; '.join(said)}"), stacklevel=5)
    return plate


def _moment(arrays: Arrays, k: int, units: PlateUnits) -> Float[np.ndarray, "t 3"]:
    """Moment about the middle of the surface [N m].

    ezc3d adds force times the lever of ORIGIN to the channels of moment as if these were in N times the unit of points.
    Where they are not, the two are taken apart again.
    """
    moment = arrays[f"moment_{k}"]
    by_lever = units.newton * units.metre
    if units.newton_metre == by_lever or int(arrays[f"type_{k}"]) not in MOMENTS_LAST:
        return np.asarray(moment * by_lever)
    corners = arrays[f"corners_{k}"]
    x, y = corners[0] - corners[1], corners[0] - corners[3]
    down = np.cross(x, y)
    axes = np.column_stack([each / np.linalg.norm(each) for each in (x, np.cross(down, x), down)])
    lever = np.cross(arrays[f"force_{k}"], axes @ arrays[f"origin_{k}"])
    return np.asarray(lever * by_lever + (moment - lever) * units.newton_metre)


def _clipped(arrays: Arrays, k: int) -> list[str]:
    """Channels at the end of their converter, each with the longest time of it."""
    runs, said = arrays[f"clipped_{k}"], []
    for channel in dict.fromkeys(runs[:, 0].tolist()):
        own = runs[runs[:, 0] == channel]
        _, first, count = own[int(np.argmax(own[:, 2]))]
        begin, rate = float(arrays["start"]) + first / float(arrays["rate"]), float(arrays["rate"])
        often = f" and {len(own) - 1} times more" if len(own) > 1 else ""
        where = f"from {begin:.4g} to {begin + (count - 1) / rate:.4g} s{often}"
        said.append(f"channel '{arrays[f'names_{k}'][channel]}' is clipped at the end of its converter {where}")
    return said


def _doubts(plate: ForcePlate) -> list[str]:
    """What is odd about a plate's load as a whole."""
    load = plate.wrench.force @ plate.normal
    if not (load >= LOADED).any():
        return [f"never carries {LOADED:g} N"]
    said = []
    low = float(np.percentile(np.abs(load), 5.0))
    if low > RETURNS:
        said.append(
            f"never returns to about 0 N: it carries {low:.0f} N or more for 95 % of the time; its zero is not known"
        )
    if plate.outside() > OUTSIDE:
        said.append(f"{_off(plate)}; {_OFF_REMEDY}")
    return said
