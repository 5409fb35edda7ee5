"""Units of the channels of a force plate in a .c3d file: those of ANALOG:UNITS, and what the format takes without."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.text.units import LENGTH, length_unit, si_unit

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
            raise InputError(file, "POINT:UNITS", "is empty: the unit of its places is not known", _STATE_IT)
        return LENGTH[stated]
    unit = length_unit(written)
    if unit is None:
        raise InputError(file, "POINT:UNITS", f"is '{written[:20]}'", f"expected one of {', '.join(LENGTH)}")
    if stated not in (None, unit):
        what = f"POINT:UNITS is '{written[:20]}', which counts; `c3d_unit` {stated} is for files whose own is empty"
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
