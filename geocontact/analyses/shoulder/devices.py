"""Device and wearer as the options name them: built in, or from files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.sourced_number import SOURCES, Number, Source
from geocontact.io.recordings.shoulder_device import read_device_file, read_person_file
from geocontact.shoulder_exoskeleton.device import JOINTS, QUANTITIES, Device, Wearer
from geocontact.shoulder_exoskeleton.lucy import BUILT_IN

LENGTHS = ("upper_arm", "shoulder_width", "torso")
SHORTEST, LONGEST = 0.1, 1.0
"""Lengths of a person [m] that are believed."""
UNITS = {name: quantity.unit for name, quantity in QUANTITIES.items()}


def device_named(record: Record, named: str) -> Device:
    """A built-in device by its name, else from the file of that name."""
    if named in BUILT_IN:
        return BUILT_IN[named]()
    file = Path(named)
    if not file.is_file():
        what = f"{named!r} is neither a file nor a built-in device"
        raise InputError("", "`device`", what, f"built in are {', '.join(BUILT_IN)}")
    told = read_device_file(file, UNITS, SOURCES)
    if told.based_on not in BUILT_IN:
        raise InputError(file, "`based_on`", f"{told.based_on!r} is not built in", f"one of {', '.join(BUILT_IN)}")
    numbers = dict(BUILT_IN[told.based_on]().numbers)
    for name, each in told.numbers.items():
        quantity = QUANTITIES[name]
        if not quantity.lower <= each.value <= quantity.upper:
            unit, factor = quantity.written
            ends = f"{quantity.lower * factor:g} to {quantity.upper * factor:g} {unit}"
            what = f"{each.value * factor:g} {unit} cannot be {quantity.what}"
            raise InputError(file, f"[numbers] {name}", what, f"that is {ends}")
        numbers[name] = Number(each.value, _source(each.source), each.note)
    device = Device(told.name, numbers)
    _require_sound(file, device)
    record.add_input("`device`", file, numbers=len(told.numbers))
    return device


def wearer_named(record: Record, file: Path | None) -> Wearer:
    """Lengths of the person in a file; the usual ones where it does not tell them, or there is none."""
    if file is None:
        usual = Wearer()
        record.warn(
            f"no `person`: the device is adjusted to an upper arm of {1e3 * usual.upper_arm:.0f} mm and shoulders "
            f"{1e3 * usual.shoulder_width:.0f} mm wide (invented)"
        )
        return usual
    found = wearer_of_lengths(record, file, read_person_file(file, LENGTHS))
    record.add_input("`person`", file)
    return found


def wearer_of_lengths(record: Record, file: Path, lengths: Mapping[str, float]) -> Wearer:
    """The usual wearer with the lengths [m] that are known, from a file; InputError for those of no person."""
    if not lengths:
        record.warn(f"{file.name}: no lengths of the person; the device is adjusted to the usual ones (invented)")
    for name, value in lengths.items():
        if not SHORTEST <= value <= LONGEST:
            what = f"{1e3 * value:g} mm is no length of a person"
            raise InputError(file, f"`{name}`", what, f"that is {1e3 * SHORTEST:g} to {1e3 * LONGEST:g} mm")
    return Wearer(**lengths)


def _source(text: str) -> Source:
    return next(source for source in SOURCES if source == text)


def _require_sound(file: Path, device: Device) -> None:
    """Ranges that have room between their ends, axes that have a direction."""
    for joint in JOINTS:
        lower, upper = (np.degrees(device[f"{joint}_{end}"]) for end in ("lower", "upper"))
        if not lower < upper:
            what = f"the range of {joint} from {lower:g} to {upper:g} degrees has no room"
            raise InputError(file, f"[numbers] {joint}_lower", what, "give the lower end first")
        try:
            device.axis(joint)
        except ValueError as error:
            raise InputError(file, f"[numbers] axis_{joint}_x", str(error), "give its direction") from error
    if device["mu_k"] > device["mu_s"]:
        what = f"kinetic friction {device['mu_k']:g} is larger than the static one, {device['mu_s']:g}"
        raise InputError(file, "[numbers] mu_k", what, "exchange them, or give mu_s as well")
    if device["arm_mass"] + device["cylinder_mass"] <= 0.0:
        raise InputError(file, "[numbers] arm_mass", "the arm link has no mass", "give it some")
