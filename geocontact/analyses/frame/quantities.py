"""Numbers with units as they are typed on the command line."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from os.path import lexists
from pathlib import Path
from typing import Literal

from geocontact.data.errors import InputError
from geocontact.io.text.units import ANGLE, DIMENSIONS, LENGTH, si_unit

_NUMBER_AND_UNIT = re.compile(r"(?P<number>[-+0-9.eE]+?)\s*(?P<unit>[a-zA-Z][a-zA-Z/^0-9]*)")

UNITS = tuple(unit for units in DIMENSIONS.values() for unit in units)
"""Units that can be chosen for a column of a recording."""


def is_known(unit: str) -> bool:
    """Whether a column in this unit can be read as it is."""
    return si_unit(unit) is not None


def named_file(text: str) -> Path | None:
    """The file of that name, None when the text is something else (an expression, a list of numbers).

    A pipe, a device or a broken link of that name is what the user meant too: who reads it refuses it.
    """
    try:
        return Path(text) if lexists(text) and not Path(text).is_dir() else None
    except (OSError, ValueError):  # too long or impossible for a file name
        return None


def number(text: str, option: str, example: str) -> float:
    """A finite number, or one line that says what was expected."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError("", option, f"{text.strip()!r} is not a finite number", f"write for example {example}")
    return value


def length(text: str, option: str, unit: str = "mm") -> float:
    """ "4", "4mm", "0.4 cm" to metres; `unit` when none is written."""
    text = text.strip()
    for name in sorted(LENGTH, key=len, reverse=True):
        if text.endswith(name):
            text, unit = text[: -len(name)], name
            break
    return number(text, option, f"{option} 4 or {option} 4mm") * LENGTH[unit]


def millimetres(value: float, option: str) -> float:
    """A number of millimetres in metres."""
    return finite(value, option) * LENGTH["mm"]


def degrees(value: float, option: str) -> float:
    """A number of degrees in radians."""
    return finite(value, option) * ANGLE["deg"]


def finite(value: float, option: str) -> float:
    """The number, which is finite."""
    if not math.isfinite(value):
        raise InputError("", option, f"{value} is not a finite number", "give a number")
    return value


def named_numbers(texts: Iterable[str], option: str) -> dict[str, float]:
    """ "damping.b=25", "damping.c=1" to numbers by name; in SI as they are."""
    found = {}
    for text in texts:
        name, _, value = text.partition("=")
        if name in found:
            raise InputError("", option, f"{name} is given twice", "give each once")
        try:
            found[name] = float(value)
        except ValueError:
            raise InputError("", option, f"{value!r} is not a number", f"write {name}=1.5") from None
    return found


def friction(text: str, option: str) -> tuple[float, float]:
    """ "0.9,0.7" to a static and a kinetic coefficient."""
    parts = text.split(",")
    if len(parts) != 2:
        raise InputError("", option, f"{text!r} is not two numbers", "write static,kinetic as 0.9,0.7")
    static, kinetic = (number(part, option, f"{option} 0.9,0.7") for part in parts)
    return static, kinetic


def pressure(text: str, option: str) -> float:
    """ "500MPa", "0.5 GPa" to pascals; the unit is never guessed."""
    found = _NUMBER_AND_UNIT.fullmatch(text.strip())
    known = si_unit(found["unit"]) if found else None
    if found is None or known is None or known[0] != "Pa":
        raise InputError(
            "", option, f"{text!r} is not a pressure", f"write 500MPa (one of {', '.join(DIMENSIONS['Pa'])})"
        )
    value = number(found["number"], option, "500MPa") * known[1]
    if value <= 0.0:
        raise InputError("", option, f"{text!r} is not positive", "write for example 500MPa")
    return value


def wear_factor(text: str, option: str) -> float:
    """ "1e-7mm^3/(N m)", "1e-7 mm3/Nm" to m^2/N, volume per force and path; the unit is never guessed."""
    found = re.fullmatch(r"(?P<number>[-+0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(?P<unit>.*)", text.strip())
    known = si_unit(found["unit"]) if found else None
    if found is None or known is None or known[0] != "m^2/N":
        what = f"{text!r} is not a wear factor"
        raise InputError("", option, what, f"write 1e-7mm^3/(N m) (one of {', '.join(DIMENSIONS['m^2/N'])})")
    return number(found["number"], option, "1e-7mm^3/(N m)") * known[1]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def body_mass(text: str, option: str) -> float:
    """ "77.3", "77.3kg", "170 lb" to kilograms; kg when no unit is written."""
    example = f"{option} 77.3 or {option} 77.3kg"
    found = None if _is_number(text) else _NUMBER_AND_UNIT.fullmatch(text.strip())
    if found is None:
        return number(text, option, example)
    known = si_unit(found["unit"])
    if known is None or known[0] != "kg":
        raise InputError("", option, f"{found['unit']!r} is not a unit of mass", f"write for example {example}")
    return number(found["number"], option, example) * known[1]


def lengths(text: str, option: str) -> tuple[float, ...]:
    """Comma-separated lengths [m], in the order given; mm unless a unit is written."""
    parts = text.split(",")
    if len(parts) > 1 and parts[0].strip() == "0":
        meant, several = f"write {option} 0.{parts[1].strip()}", f"{option} 0mm,{','.join(parts[1:]).strip()}"
        raise InputError("", option, f"{text!r} may have a decimal comma", f"{meant}, or {several} for two thresholds")
    values = tuple(length(part, option) for part in parts)
    if min(values) < 0.0:
        raise InputError("", option, f"{text!r} is negative", "a point counts when its distance is not above it")
    if len(set(values)) < len(values):
        raise InputError("", option, f"{text!r} names a threshold twice", "give each once")
    return values


def fraction(text: str, option: str) -> float:
    """ "2%" or "0.02" to 0.02."""
    value = number(text.rstrip("% "), option, "2%") * (0.01 if text.strip().endswith("%") else 1.0)
    if value <= 0.0:
        raise InputError("", option, f"{text!r} is not positive", "write for example 2%")
    if "%" not in text and 1.0 <= value <= 100.0:
        raise InputError("", option, f"{text!r} may be meant in per cent", "write for example 2% or 0.02")
    return value


def sweep_range(text: str, option: str) -> tuple[str, float, float, float]:
    """ "flexion=0:90:1" to a name and start, stop, step [rad]; degrees are typed."""
    name, found, rest = text.partition("=")
    if not found or not name.strip() or ":" not in rest:
        raise InputError("", option, f"{text!r} is not a range", "write flexion=0:90:1 (degrees)")
    return (name.strip(), *angle_range(rest, option, "flexion=0:90:1"))


def thickness(text: str, option: str) -> float | Literal["rays"]:
    """ "8mm" to a length [m], mm unless a unit is written; "rays" stays."""
    return "rays" if text.strip() == "rays" else length(text, option)


def pose_sd(text: str, option: str) -> tuple[float, ...]:
    """ "t=0.5,r=1" or "tx=0.5,rz=2" (mm, degrees) to three lengths [m] and three angles [rad]; 0 where not named."""
    names, found = ("tx", "ty", "tz", "rx", "ry", "rz"), dict[str, float]()
    for part in text.split(","):
        name, _, value = (piece.strip() for piece in part.partition("="))
        meant = [each for each in names if each == name or each[0] == name]
        if not meant or not value or any(each in found for each in meant):
            raise InputError("", option, f"{part.strip()!r} is not a standard deviation", f"write {option} t=0.5,r=1")
        size = number(value, option, "t=0.5,r=1")
        found |= {each: size * (LENGTH["mm"] if each[0] == "t" else ANGLE["deg"]) for each in meant}
    if min(found.values()) < 0.0:
        raise InputError("", option, f"{text!r} is negative", "a standard deviation is not")
    return tuple(found.get(each, 0.0) for each in names)


def cycle_part(text: str, option: str) -> float | Literal["stance"]:
    """ "60%" or "0.6" to 0.6; "stance" stays."""
    return "stance" if text.strip() == "stance" else fraction(text, option)


def turn(text: str, option: str) -> tuple[str, float]:
    """ "x=2" to a coordinate axis and an angle [rad]; degrees are typed."""
    axis, _, angle = text.partition("=")
    if axis.strip() not in ("x", "y", "z") or not angle.strip():
        raise InputError("", option, f"{text!r} is not an axis and an angle", f"write {option} x=2 (degrees)")
    value = number(angle, option, "x=2")
    if abs(value) > 45.0:
        raise InputError("", option, f"{text!r} is not a small offset", "write at most 45 degrees")
    return axis.strip(), value * ANGLE["deg"]


def angle_range(text: str, option: str, example: str) -> tuple[float, float, float]:
    """ "0:90:1" to start, stop, step [rad]; degrees are typed, and the step is 1 by default."""
    parts = text.split(":")
    if len(parts) not in (2, 3):
        raise InputError("", option, f"{text!r} is not a range", f"write {example} (degrees)")
    start, stop, step = (number(part, option, example) for part in (*parts, "1")[:3])
    if step == 0.0 or (stop - start) * step < 0.0 or abs((stop - start) / step) > 1e5:
        raise InputError("", option, f"{text!r} never arrives", f"write start:stop:step in degrees, as in {example}")
    steps = (stop - start) / step
    if abs(steps - round(steps)) > 1e-6:
        raise InputError("", option, f"steps of {step:g} from {start:g} do not end at {stop:g}", "change the step")
    return start * ANGLE["deg"], stop * ANGLE["deg"], step * ANGLE["deg"]


def degree_range(text: str, option: str) -> tuple[float, float, float]:
    """ "-30:120:5" to start, stop, step [rad]; degrees are typed."""
    return angle_range(text, option, f"{option}=-30:120:5")


def windows(text: str, option: str) -> tuple[tuple[float, float], ...]:
    """ "0:0.5,9:9.5" to pairs of times [s]."""
    found = []
    for part in text.split(","):
        first, colon, last = part.partition(":")
        if not colon:
            raise InputError("", option, f"{part!r} is not a time from … to", "write for example 0:0.5")
        found.append((number(first, option, "0:0.5"), number(last, option, "0:0.5")))
        if found[-1][1] <= found[-1][0]:
            raise InputError("", option, f"{part!r} ends before it begins", "write for example 0:0.5")
    return tuple(found)


def time_span(text: str, option: str) -> tuple[float, float]:
    """ "0.4:1.6" as first and last time [s]."""
    first, colon, last = text.partition(":")
    if not colon:
        raise InputError("", option, f"'{text}' is not a span", "write for example 0.4:1.6")
    start, stop = (number(each, option, "0.4:1.6") for each in (first, last))
    if start > stop:
        raise InputError("", option, f"'{text}' ends before it begins", "write for example 0.4:1.6")
    return start, stop


def registration(text: str, option: str) -> tuple[float, float]:
    """ "1mm,2deg" to a length [m] and an angle [rad]."""
    parts = [part.strip() for part in text.split(",")]
    if len(parts) != 2 or not parts[1].endswith(("deg", "rad")):
        raise InputError("", option, f"{text!r} is not a length and an angle", "write 1mm,2deg")
    angle = number(parts[1][:-3], option, "1mm,2deg") * ANGLE[parts[1][-3:]]
    shift = length(parts[0], option)
    if shift < 0.0 or angle < 0.0:
        raise InputError("", option, f"{text!r} is negative", "write 1mm,2deg")
    return shift, angle


def angle_span(text: str, option: str) -> tuple[float, float]:
    """ "0:120deg" to two angles [rad]; the unit is written and counts for both."""
    found = re.fullmatch(r"(?P<first>[^:]+):(?P<last>[^:a-z]+)\s*(?P<unit>deg|rad)", text.strip())
    if found is None:
        raise InputError("", option, f"{text!r} is not a range of angles with its unit", "write for example 0:120deg")
    first, last = (number(found[end], option, "0:120deg") * ANGLE[found["unit"]] for end in ("first", "last"))
    return first, last


def length_span(text: str, option: str) -> tuple[float, float]:
    """ "-20:35" to two lengths [m], mm unless a unit is written."""
    first, colon, last = text.partition(":")
    if not colon:
        raise InputError("", option, f"{text!r} is not a length from … to", "write for example -20:35")
    return length(first, option), length(last, option)


def length_pair(text: str, option: str) -> tuple[float, float]:
    """ "5,-3" to two lengths [m], mm unless a unit is written."""
    parts = text.split(",")
    if len(parts) != 2:
        raise InputError("", option, f"{text!r} is not two lengths", "write for example 5,-3")
    return length(parts[0], option), length(parts[1], option)


FREE_UNITS = {"threshold": LENGTH["mm"], "lag": 1.0, "adduction": ANGLE["deg"], "slope": 1.0, "work": 1.0}
"""SI units per unit in which the bounds of a free number are typed."""


def free_numbers(text: str, option: str) -> dict[str, tuple[float, float] | None]:
    """ "threshold=1:6,lag" to bounds in SI by name, None where none are given."""
    found: dict[str, tuple[float, float] | None] = {}
    for part in text.split(","):
        name, _, bounds = (piece.strip() for piece in part.partition("="))
        if name not in FREE_UNITS or name in found:
            what = f"{part.strip()!r} is none of {', '.join(FREE_UNITS)}, or is named twice"
            raise InputError("", option, what, "write threshold,lag=-0.05:0.05")
        found[name] = _bounds(bounds, option, FREE_UNITS[name]) if bounds else None
    return found


def _bounds(text: str, option: str, unit: float) -> tuple[float, float]:
    low, colon, high = text.partition(":")
    if not colon:
        raise InputError("", option, f"{text!r} is not lower:upper", "write threshold=1:6")
    return number(low, option, "lag=-0.05:0.05") * unit, number(high, option, "lag=-0.05:0.05") * unit


def body_pair(text: str, option: str) -> tuple[str, str]:
    """ "femur_r,tibia_r" to two names."""
    names = [name.strip() for name in text.split(",")]
    if len(names) != 2 or not all(names) or names[0] == names[1]:
        raise InputError("", option, f"{text!r} is not two bodies", "write femur_r,tibia_r")
    return names[0], names[1]


def programs(text: str, option: str) -> tuple[str, ...]:
    """ "febio,abaqus" to names."""
    return tuple(name.strip() for name in text.split(","))


def ratios(text: str, option: str) -> tuple[float, ...]:
    """ "0.25,0.46" to numbers."""
    return tuple(number(part, option, "0.25,0.46") for part in text.split(","))
