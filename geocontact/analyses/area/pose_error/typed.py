"""What is typed of the error of a pose, in SI."""

from __future__ import annotations

from geocontact.analyses import quantities
from geocontact.data.errors import InputError
from geocontact.io.text.units import ANGLE, LENGTH


def pose_sd(text: str, option: str) -> tuple[float, ...]:
    """ "t=0.5,r=1" or "tx=0.5,rz=2" (mm, degrees) to three lengths [m] and three angles [rad]; 0 where not named."""
    names, found = ("tx", "ty", "tz", "rx", "ry", "rz"), dict[str, float]()
    for part in text.split(","):
        name, _, value = (piece.strip() for piece in part.partition("="))
        meant = [each for each in names if each == name or each[0] == name]
        if not meant or not value or any(each in found for each in meant):
            raise InputError("", option, f"{part.strip()!r} is no standard deviation", f"write {option} t=0.5,r=1")
        size = quantities.number(value, option, "t=0.5,r=1")
        found |= {each: size * (LENGTH["mm"] if each[0] == "t" else ANGLE["deg"]) for each in meant}
    if min(found.values()) < 0.0:
        raise InputError("", option, f"{text!r} is negative", "a standard deviation is not")
    return tuple(found.get(each, 0.0) for each in names)
