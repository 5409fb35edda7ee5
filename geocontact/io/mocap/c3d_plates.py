"""Force plates of a .c3d file, read by ezc3d in a process of its own: damaged files end or stall the library.

`python -m geocontact.io.mocap.c3d_plates FILE` writes an .npz of plain arrays to standard output.
"""

from __future__ import annotations

import io
import os
import re
import struct
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.magnitude import too_large
from geocontact.data.plausible import TOO_LARGE
from geocontact.io.mocap.c3d_parameters import MIPS, as_intel, processor, with_real_numbers, with_whole_counts
from geocontact.io.text.apart import run_apart
from geocontact.io.text.file_preflight import read_bytes
from geocontact.io.text.units import LENGTH, length_unit, si_unit

RUN = 3
"""Samples in a row at the limit that are no chance."""

BITS = (12, 14, 16)
"""Bits of converters, where the file does not say."""

_WHOLE = 0.02  # of a count; files hold single precision


def clipped_runs(
    counts: Float[np.ndarray, "t c"], offset: Float[np.ndarray, " c"], bits: int
) -> Int[np.ndarray, "r 3"]:
    """Channel, first sample and length of every run of samples at the end of the converter.

    Parameters
    ----------
    counts
        As the converter gave them, before offset and scale; channels whose counts are not whole are passed over.
    offset
        Count that means nothing; where it is above 0, counts may begin at 0.
    bits
        Of the converter; 0 where the file does not say.
    """
    found = []
    for channel, column in enumerate(counts.T):
        if not len(column) or not (np.isfinite(column).all() and np.abs(column - np.round(column)).max() < _WHOLE):
            continue
        whole = np.round(column).astype(np.int64)
        limits = _limits((bits,) if bits in range(8, 33) else BITS, bool(offset[channel] > 0.0))
        for extreme in {int(whole.max()), int(whole.min())} & limits:
            edges = np.flatnonzero(np.diff(np.concatenate([[0], whole == extreme, [0]])))
            found += [(channel, start, end - start) for start, end in edges.reshape(-1, 2) if end - start >= RUN]
    return np.array(found, np.int64).reshape(-1, 3)


def _limits(widths: tuple[int, ...], from_zero: bool) -> set[int]:
    ends = {0} if from_zero else set[int]()
    for width in widths:
        half = 1 << (width - 1)
        ends |= {half - 1, -half, 1 - half, 2 * half - 1}
    return ends


_POUND_FORCE = 4.4482216152605
_KILOGRAM_FORCE = 9.80665
_FORCE = {"n": 1.0, "nt": 1.0, "newton": 1.0, "newtons": 1.0, "kn": 1e3, "lbf": _POUND_FORCE, "kgf": _KILOGRAM_FORCE}
_MOMENT = re.compile(r"(?P<force>newtons?|nt|kn|n|lbf|kgf)[\s.*·⋅-]*(?P<length>[a-zµμ]+)\.?", re.IGNORECASE)

MOMENTS_LAST = (2, 4)
"""Types of plates with three channels of force and three of moment."""

_CENTRE = 1
_CALIBRATED = 4
"""Type whose channels may be in volts: its matrix makes newtons of them."""


@dataclass(frozen=True)
class PlateUnits:
    """SI units that one unit of a plate's numbers is: newtons, metres (of points), newton metres (of its moments).

    `doubt` says what is odd about them; empty where nothing is.
    """

    newton: float
    metre: float
    newton_metre: float
    doubt: str = ""


def point_metre(file: str, written: str, stated: str | None) -> float:
    """Metres per unit of places, from POINT:UNITS, or as the user states it where that is empty.

    InputError where neither says it, and for what is no unit of length; a warning where they contradict each other.
    """
    if not written.strip():
        if stated is None:
            raise InputError(file, "POINT:UNITS", "is empty: the unit of its points is unknown", _STATE_IT)
        return LENGTH[stated]
    unit = length_unit(written)
    if unit is None:
        raise InputError(file, "POINT:UNITS", f"is '{written[:20]}'", f"expected one of {', '.join(LENGTH)}")
    if stated not in (None, unit):
        what = f"POINT:UNITS is '{written[:20]}' and is used; `c3d_unit` {stated} is for files without a unit"
        warnings.warn(InputWarning(f"{file}: {what}"), stacklevel=4)
    return LENGTH[unit]


_STATE_IT = f"state it with `c3d_unit` {', '.join([*LENGTH][:-1])} or {[*LENGTH][-1]}"


def plate_units(
    file: str, place: str, kind: int, points: str, channels: Sequence[str], stated: str | None = None
) -> PlateUnits:
    """Units of a plate of a type from POINT:UNITS and ANALOG:UNITS of its channels.

    Channels without a unit of force or moment are in N and in N times the unit of points, as ezc3d has it. `stated` is
    the unit of points where the file says none.
    """
    metre, doubt = point_metre(file, points, stated), ""
    pushing = channels[:3] if kind in (*MOMENTS_LAST, _CENTRE) else channels
    newton = _one(file, place, "forces", pushing, [_force(each) for each in pushing]) or 1.0
    if kind in MOMENTS_LAST:
        turning = channels[3:6]
        moment = _one(file, place, "moments", turning, [_moment(each) for each in turning]) or newton * metre
    else:
        moment = newton * metre
        _require_of_points(file, place, kind, channels, points, metre)
    odd = next((each for each in channels if _strange(each)), None)
    if odd is not None and not (kind == _CALIBRATED and _electric(odd)):
        doubt = f"ANALOG:UNITS of its channels is '{odd[:20]}'; they are taken to be in N and N{_name(metre)}"
    return PlateUnits(newton, metre, moment, doubt)


def _one(file: str, place: str, what: str, written: Sequence[str], known: list[float | None]) -> float | None:
    """The one unit of some channels; None where none has a unit that is known, InputError where they differ."""
    found = {each for each in known if each is not None}
    if len(found) > 1:
        units = ", ".join(map(repr, written))
        raise InputError(file, place, f"its {what} are in {units}", "correct ANALOG:UNITS: one unit is expected")
    return found.pop() if found else None


def _strange(written: str) -> bool:
    """Whether a unit is written that is none of force, moment or length: pounds would be 4.4 times too small."""
    return bool(written.strip()) and (_force(written), _moment(written), length_unit(written)) == (None, None, None)


def _require_of_points(file: str, place: str, kind: int, channels: Sequence[str], points: str, metre: float) -> None:
    """A plate whose channels hold the centre of pressure itself: in the unit of points, as ezc3d takes it."""
    if kind != _CENTRE:
        return
    for written in channels[3:5]:
        unit = length_unit(written)
        if unit is not None and LENGTH[unit] != metre:
            what = f"its centre of pressure is in '{written}', points are in '{points}'"
            raise InputError(file, place, what, "save the file with one unit of length")


def _force(written: str) -> float | None:
    return _FORCE.get(written.strip().lower())


def _moment(written: str) -> float | None:
    """Newton metres per unit: `Nmm`, `N.mm`, `ntmm`, `N m`, `N-m`."""
    match = _MOMENT.fullmatch(written.strip())
    unit = length_unit(match["length"]) if match else None
    return None if match is None or unit is None else _FORCE[match["force"].lower()] * LENGTH[unit]


def _name(metre: float) -> str:
    return next(name for name, size in LENGTH.items() if size == metre)


def _electric(written: str) -> bool:
    known = si_unit(written)
    return known is not None and known[0] in ("V", "A")


PATIENCE = 8.0, 2e-7
"""Seconds for a file on an idle machine: to start, and per byte; several times what whole files take."""

LARGEST = 500_000_000
"""Bytes; ten plates at 2 kHz with a hundred markers for an hour."""

SMALLEST_VALUE = 2
"""Bytes of a value in a .c3d file; real ones have 4."""

Arrays = dict[str, np.ndarray]


NOT_DIGESTED = ("not supported", "is not an INT", "is not a FLOAT", "is not a STRING")
"""What ezc3d says of files that are sound, but of a kind that it does not read."""

ALONE = "force plates: "
"""Beginning of what is said where only the plates of a file are at fault."""


def read_c3d_plates(path: str | PathLike[str]) -> Arrays:
    """Arrays of all plates of a file.

    `frames`, `rate` [Hz] and `start` [s]; `unit` of points, `labels` of the analog channels, `zero` as
    FORCE_PLATFORM:ZERO has it, and `polynomial`, whether FPCOPPOLY is there. For plate k = 0, 1 …: `force_k`,
    `moment_k` about the middle of the surface, `corners_k`, `origin_k` and `type_k`, as the file has them; `names_k`
    and `units_k` of its channels, and `clipped_k` (channel, first sample, length) of runs at the end of the converter.
    """
    return read_apart(path, __name__)


def read_apart(path: str | PathLike[str], module: str, analogs: bool = True) -> Arrays:
    """Arrays that `python -m module FILE` writes of a .c3d file, `frames` among them, in another process.

    `analogs` says whether analog channels are among them.
    """
    file = fspath(path)
    data = read_bytes(path, LARGEST, "cut it")
    if len(data) < 512 or data[1] != 0x50:
        raise InputError(file, "", "is not a .c3d file although its name says so", "export or download it again")
    patience = (PATIENCE[0] + PATIENCE[1] * len(data)) * _waiting()
    digestible = _digestible(data, file, analogs)
    _refuse_short(digestible, file)
    if digestible is data:
        arrays = _run(file, module, file, patience)
    else:
        with tempfile.TemporaryDirectory() as folder:
            copy = Path(folder) / "copy.c3d"
            copy.write_bytes(digestible)
            arrays = _run(file, module, str(copy), patience)
    declared, found = _frames_declared(digestible), int(arrays["frames"])
    if found < declared:  # ezc3d passes over what is missing without a word
        raise InputError(file, "", f"holds {found} of the {declared} frames it declares", "is it complete?")
    for name, values in arrays.items():
        if values.dtype.kind == "f" and too_large(values).any():
            raise InputError(file, "", f"holds a number in {name.partition('_')[0]} that {TOO_LARGE}", "is it damaged?")
    return arrays


def _refuse_short(data: bytes, file: str) -> None:
    """InputError where the header declares more than the bytes behind it hold, whatever the rest of the file says."""
    points, samples, begin = (int.from_bytes(data[at : at + 2], "little") for at in (2, 4, 16))
    declared, size = _frames_declared(data), SMALLEST_VALUE * (4 * points + samples)
    there = len(data) - (begin - 1) * 512
    if begin and declared * size > there:
        what = f"holds {max(there, 0) // size} of the {declared} frames it declares"
        raise InputError(file, "", what, "is it complete?")


def _digestible(data: bytes, file: str, analogs: bool) -> bytes:
    """The file as ezc3d takes it: for PC, counts as whole numbers, rates, scales and places as real ones."""
    if processor(data) == MIPS:
        try:
            data = as_intel(data)
        except (IndexError, struct.error) as error:
            what = "is in the byte order of MIPS (SGI) computers, and its parameters cannot be followed"
            raise InputError(file, "", what, "is the file damaged?") from error
    data = with_whole_counts(data, file, analogs) or data
    return with_real_numbers(data) or data


def _run(file: str, module: str, copy: str, patience: float) -> Arrays:
    """The module in another process, on a file or a copy of it."""
    try:
        child = run_apart(module, [str(Path(copy).absolute())], patience)
    except subprocess.TimeoutExpired as error:
        raise InputError(file, "", f"is not read within {patience:.0f} s", "is the file damaged?") from error
    if child.returncode == 0:
        with np.load(io.BytesIO(child.stdout), allow_pickle=False) as arrays:
            return dict(arrays)
    said = child.stderr.decode(errors="replace").strip().splitlines()
    if said and said[-1].startswith("ModuleNotFoundError"):
        raise InputError(file, "", "reading .c3d needs ezc3d", "pip install 'geocontact[mocap]'")
    why = said[-1].partition(": ")[2][:160] or said[-1][:160] if said and child.returncode > 0 else "ezc3d stopped"
    if why.startswith(ALONE):
        what = f"its force plates cannot be computed ({why.removeprefix(ALONE)})"
        raise InputError(file, "", what, "the rest of the file is read: correct its parameters FORCE_PLATFORM")
    if any(each in why for each in NOT_DIGESTED):
        what = f"is of a kind that ezc3d does not read ({why}); the file itself may be sound"
        raise InputError(file, "", what, "save it anew with the program that made it, or with Mokka")
    raise InputError(file, "", f"cannot be read ({why})", "is the file damaged?")


def _waiting() -> float:
    """How many times longer a process takes beside those that wait for a processor now; 1 where none has to wait."""
    try:
        return max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))
    except (AttributeError, OSError):  # Windows has no such figure
        return 1.0


def plates_of(path: str) -> Arrays:
    """The same, in this process."""
    import ezc3d  # type: ignore[import-untyped]

    try:
        content = ezc3d.c3d(path, extract_forceplat_data=True)
    except Exception as error:
        ezc3d.c3d(path)  # where this fails too, it is not for the plates
        raise ValueError(f"{ALONE}{error}") from error
    told, points, analogs = content["parameters"], content["header"]["points"], content["header"]["analogs"]
    platform = told.get("FORCE_PLATFORM", {})
    arrays: Arrays = {
        "frames": np.array(content["data"]["points"].shape[2]),
        "rate": np.array(float(analogs["frame_rate"])),
        "start": np.array(float(points["first_frame"]) / max(float(points["frame_rate"]), 1e-9)),
        "labels": _texts(told["ANALOG"], "LABELS"),
        "unit": np.array(next(iter(_texts(told["POINT"], "UNITS")), "")),
        "zero": _numbers(platform, "ZERO").astype(np.int64),
        "polynomial": np.array(bool(np.any(_numbers(platform, "FPCOPPOLY")))),
    }
    for k, plate in enumerate(content["data"].get("platform", [])):
        arrays |= {f"{key}_{k}": np.asarray(plate[key], float).T for key in ("force", "moment", "corners", "origin")}
        arrays |= {f"{key}_{k}": value for key, value in _channels_of(content, k).items()}
    return arrays


def _channels_of(content: Any, k: int) -> Arrays:
    """Type of a plate, names and units of its channels, and runs of these at the end of the converter."""
    told, values = content["parameters"], content["data"]["analogs"][0]
    analog, platform = told["ANALOG"], told["FORCE_PLATFORM"]
    channels = np.asarray(platform["CHANNEL"]["value"], int)
    own = channels[:, k] if channels.ndim == 2 else channels
    used = own[(own >= 1) & (own <= len(values))] - 1
    scale, offset = (
        _padded(_numbers(analog, key), len(values), default) for key, default in (("SCALE", 1.0), ("OFFSET", 0.0))
    )
    scale *= float(next(iter(_numbers(analog, "GEN_SCALE")), 1.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        counts = (values[used] / scale[used, None] + offset[used, None]).T
    names, units = (_padded(_texts(analog, key), len(values), "") for key in ("LABELS", "UNITS"))
    return {
        "type": np.array(int(_numbers(platform, "TYPE")[k])),
        "names": names[used],
        "units": units[used],
        "clipped": clipped_runs(counts, offset[used], int(next(iter(_numbers(analog, "BITS")), 0))),
    }


def _numbers(group: Mapping[str, Any], name: str) -> np.ndarray:
    """A parameter's numbers in a row; none where it is not there."""
    return np.asarray(group.get(name, {"value": []})["value"], float).ravel()


def _texts(group: Mapping[str, Any], name: str) -> np.ndarray:
    """A parameter's texts, with those of NAME2, NAME3 … behind them."""
    keys = [name, *(f"{name}{k}" for k in range(2, 99))]
    return np.array([str(text).strip() for key in keys if key in group for text in group[key]["value"]], dtype=str)


def _padded(values: np.ndarray, count: int, default: float | str) -> np.ndarray:
    """Values for as many channels as there are."""
    return np.concatenate([values[:count], np.full(max(count - len(values), 0), default)])


def _frames_declared(data: bytes) -> int:
    """Frames by the header's first and last frame; 0 where it cannot tell (16 bits, wrapped in long files)."""
    first, last = (int.from_bytes(data[at : at + 2], "little") for at in (6, 8))
    return last - first + 1 if first <= last < 0xFFFF else 0


if __name__ == "__main__":
    np.savez(sys.stdout.buffer, **plates_of(sys.argv[1]))  # type: ignore[arg-type]
