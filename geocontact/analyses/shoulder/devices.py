"""Device, wearer and support profiles as the options name them: built in, or from files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.data.errors import InputError
from geocontact.data.parameter import SOURCES, Number, Source
from geocontact.io.recordings.shoulder_device import DeviceFile, StatedNumber, read_device_file, read_person_file
from geocontact.io.text.side_table import read_side_table
from geocontact.shoulder_exoskeleton.cylinder_hinges import HINGES, REPLACED, with_hinges
from geocontact.shoulder_exoskeleton.device import BUILT_IN, JOINTS, QUANTITIES, Device, DeviceQuantity, Wearer
from geocontact.shoulder_exoskeleton.support.controller_numbers import CONTROLLED, thresholds_of
from geocontact.shoulder_exoskeleton.support.outcome import Factors
from geocontact.shoulder_exoskeleton.support.phase_machine import SUPPORTED
from geocontact.shoulder_exoskeleton.support.profile_limits import FactorKey, Hand
from geocontact.shoulder_exoskeleton.work_phases import PHASES

LENGTHS = ("upper_arm", "shoulder_width", "torso")
UNITS = {name: quantity.unit for name, quantity in QUANTITIES.items()}
HINGE_UNITS = {name: quantity.unit for name, quantity in HINGES.items()}
CONTROLLER_UNITS = {name: quantity.unit for name, quantity in CONTROLLED.items()}


def device_named(named: str) -> Device:
    """A built-in device by its name, else from the file of that name."""
    if named in BUILT_IN:
        return BUILT_IN[named]()
    file = Path(named)
    if not file.is_file():
        what = f"{named!r} is neither a file nor a built-in device"
        raise InputError("", "`device`", what, f"built in are {', '.join(BUILT_IN)}")
    told = read_device_file(file, UNITS, CONTROLLER_UNITS, SOURCES, HINGE_UNITS)
    if told.based_on not in BUILT_IN:
        raise InputError(file, "`based_on`", f"{told.based_on!r} is not built in", f"one of {', '.join(BUILT_IN)}")
    numbers = dict(BUILT_IN[told.based_on]().numbers)
    numbers |= _in_range(file, "numbers", told.numbers, QUANTITIES)
    device = Device(told.name, numbers, _in_range(file, "controller", told.controller, CONTROLLED))
    _require_sound(file, device)
    if told.hinges:
        device = _hinged(file, device, told)
    add_input("`device`", file, numbers=len(told.numbers) + len(told.hinges) + len(told.controller))
    return device


def _hinged(file: Path, device: Device, told: DeviceFile) -> Device:
    """With the levers of its cylinder's hinges; a warning where the stroke ends within the range of the arm."""
    twice = [name for name in REPLACED if name in told.numbers]
    if twice:
        raise InputError(file, f"[numbers] {twice[0]}", "follows from [hinges] as well", "leave it out, or [hinges]")
    try:
        found = with_hinges(device, _in_range(file, "hinges", told.hinges, HINGES))
    except ValueError as error:
        raise InputError(
            file, "[hinges]", str(error), "check places and stroke: y backwards, z up, arm hanging"
        ) from error
    low, high = (np.degrees(found[f"elevation_{end}"]) for end in ("lower", "upper"))
    if (found["elevation_lower"], found["elevation_upper"]) != (device["elevation_lower"], device["elevation_upper"]):
        reserve(f"{file.name}: the cylinder ends within the arm's range, which is {low:.0f} to {high:.0f} deg by it")
    return found


def _in_range(
    file: Path, table: str, stated: Mapping[str, StatedNumber], quantities: Mapping[str, DeviceQuantity]
) -> dict[str, Number]:
    """Numbers of one table of the file; InputError for what cannot be."""
    found = {}
    for name, each in stated.items():
        quantity = quantities[name]
        if not quantity.lower <= each.value <= quantity.upper:
            unit, factor = quantity.written
            ends = f"{quantity.lower * factor:g} to {quantity.upper * factor:g} {unit}"
            what = f"{each.value * factor:g} {unit} cannot be {quantity.what}"
            raise InputError(file, f"[{table}] {name}", what, f"that is {ends}")
        if quantity.usual is not None and not quantity.usual[0] <= each.value <= quantity.usual[1]:
            unit, factor = quantity.written
            ends = " to ".join(f"{end * factor:g}" for end in quantity.usual)
            what = f"{each.value * factor:g} {unit} is unusual for {quantity.what}, which mostly is {ends} {unit}"
            reserve(f"{file} [{table}] {name}: {what}; is its unit right?")
        found[name] = Number(each.value, _source(each.source), each.note)
    return found


def wearer_named(file: Path | None, *, back: bool = False) -> Wearer:
    """Lengths of the person in a file; the usual ones where it does not tell them, or there is none.

    A warning for a torso, which moves no arm, unless the loads of the lower `back` are asked for.
    """
    if file is None:
        usual = Wearer()
        reserve(
            f"no `person`: the device is adjusted to an upper arm of {1e3 * usual.upper_arm:.0f} mm and shoulders "
            f"{1e3 * usual.shoulder_width:.0f} mm wide (invented)"
        )
        return usual
    lengths = read_person_file(file, LENGTHS)
    found = wearer_of_lengths(file, lengths)
    if "torso" in lengths and not back:
        reserve(f"{file.name}: torso changes no arm and no force: it is drawn, and places the lower back with `mass`")
    add_input("`person`", file)
    return found


def wearer_of_lengths(file: Path, lengths: Mapping[str, float]) -> Wearer:
    """The usual wearer with the lengths [m] that are known, from a file."""
    if not lengths:
        reserve(f"{file.name}: no lengths of the person; the device is adjusted to the usual ones (invented)")
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
    try:
        thresholds_of(device)
    except ValueError as error:
        raise InputError(file, "[controller]", str(error), "give both of them") from error
    if device["mu_k"] > device["mu_s"]:
        what = f"kinetic friction {device['mu_k']:g} is larger than the static one, {device['mu_s']:g}"
        raise InputError(file, "[numbers] mu_k", what, "exchange them, or give mu_s as well")
    if device["arm_mass"] + device["cylinder_mass"] <= 0.0:
        raise InputError(file, "[numbers] arm_mass", "the arm link has no mass", "give it some")


WORKING = tuple(PHASES[k] for k in SUPPORTED)
"""Phases that every profile has a factor for; that of rest is 0 unless there is a column."""
HANDS: tuple[Hand, ...] = ("dominant", "other")
NAMES = ("profile", "task", "hand")
WRITTEN = "give factors.csv of `geocontact shoulder optimise`, or a table like it"


def read_profiles(file: Path) -> dict[str, Factors]:
    """Profiles by their names, in the file's order; InputError for what is none."""
    table = read_side_table(file, (*NAMES, *PHASES))
    missing = [name for name in (*NAMES, *WORKING) if name not in table]
    if missing:
        raise InputError(file, "", f"no column {missing[0]}", WRITTEN)
    found: dict[str, Factors] = {}
    for row, told in table.iterrows():
        profile, task, word = (str(told[name]) for name in NAMES)
        hand = next((each for each in HANDS if each == word), None)
        place = f"row {int(str(row)) + 1}"
        if hand is None:
            raise InputError(file, place, f"hand {word!r} is not known", f"write {' or '.join(HANDS)}")
        factors = found.setdefault(profile, {})
        for phase in (name for name in PHASES if name in table):
            key = FactorKey(task, hand, phase)
            if key in factors:
                raise InputError(file, place, f"{profile}, {task}, {hand} is there twice", "leave one")
            factors[key] = _factor(file, place, phase, told[phase])
    return found


def factors_written(profiles: dict[str, Factors]) -> pd.DataFrame:
    """The table that `read_profiles` reads."""
    rows = []
    for name, factors in profiles.items():
        for task, hand in dict.fromkeys((key.task, key.hand) for key in factors):
            own = {phase: factors[FactorKey(task, hand, phase)] for phase in WORKING}
            rows.append({"profile": name, "task": task, "hand": hand, **own})
    return pd.DataFrame(rows)


def _factor(file: Path, place: str, phase: str, text: object) -> float:
    try:
        value = float(str(text))
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= 1.0:
        raise InputError(file, place, f"factor {text!r} of {phase} is not 0 to 1", "write a number from 0 to 1")
    return value
