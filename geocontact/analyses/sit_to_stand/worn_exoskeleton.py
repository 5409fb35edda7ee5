"""The exoskeleton of a study: as described in a file, by its own motion where that identified it, else the shipped one.

What is said twice must agree: masses of the study and of the description, dashpots of the straps, lengths to which the
exoskeleton was set while it moved alone and those that it has on the person, friction and bodies as described and as
identified.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.sit_to_stand.worn_trials import person_of
from geocontact.data.errors import InputError
from geocontact.data.parameter import SOURCES, Number
from geocontact.io.recordings.device_numbers import read_device_numbers
from geocontact.io.recordings.exoskeleton_description import ExoskeletonFile, IdentifiedParameters, read_exoskeleton
from geocontact.io.recordings.standing_study import StandingStudy
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import hinges_above, part_lengths
from geocontact.standing_up.exoskeleton_torque import UNITS, parameter_names
from geocontact.standing_up.strap_sites import StrapSite, strap_sites
from geocontact.standing_up.worn_device import (
    FRICTION_NAMES,
    PARTS,
    SHIPPED_NUMBERS,
    DeviceMasses,
    WornDevice,
    device_of,
    identified_device,
)

SAME_LENGTH = 1e-4
"""Difference in length [m] from which another exoskeleton is meant."""
SAME = 1e-3
"""Share by which a number that is given twice may differ."""
BY_ITSELF = 11
"""Parameters that a motion of all hinges identifies by themselves."""
BESIDE = 0.05
"""Distance of the exoskeleton's hinge from the person's [m] that is warned of; invented."""


def units_of_parameters() -> dict[str, str]:
    """SI units of the dynamic parameters by name."""
    return dict(zip(parameter_names(), UNITS, strict=True))


def described_exoskeleton(file: Path, role: str = "`device`") -> tuple[WornDevice, ExoskeletonFile]:
    """A description and what it makes of the shipped exoskeleton; InputError for a body that cannot be."""
    read = read_exoskeleton(file, SOURCES, units_of_parameters())
    for name, each in read.numbers.items():
        if each.value == 0.0 and name.endswith(("_mass", "_inertia")) and name != "foot_plate_mass":
            raise InputError(file, f"[numbers] {name}", "0 is not that of a body", "weigh it, or leave it out")
    found = {} if read.identified is None else read.identified.values
    add_input(role, file, numbers=len(read.numbers), parameters=len(found))
    return device_of(read.numbers), read


def worn_device(study: StandingStudy, file: Path, named: Path | None = None) -> WornDevice:
    """The exoskeleton of a study; InputError where its numbers are of other lengths or leave no inertia.

    Parameters
    ----------
    named
        Description in place of the study's.
    """
    if named is not None and not study.exoskeleton:
        raise InputError(file, "exoskeleton", "`device` has no effect without one", "write exoskeleton = true")
    if named is not None and study.device is not None and named.resolve() != study.device.resolve():
        raise InputError("", "`device`", f"{file} names {study.device.name} as device", "name one of them")
    source = study.device if named is None else named
    if source is None:
        return WornDevice(DeviceMasses(**study.masses))
    identified: IdentifiedParameters | None
    if source.suffix.lower() == ".csv":
        described, identified = WornDevice(), _of_table(source, study)
    else:
        described, read = described_exoskeleton(source, "device" if named is None else "`device`")
        identified = read.identified
    masses = _masses(study, file, described, source)
    described = replace(described, masses=masses)
    _confront_hinges(replace(person_of(study), device=described), source)
    return described if identified is None else _moved_alone(described, identified, study, (file, source))


def _of_table(file: Path, study: StandingStudy) -> IdentifiedParameters:
    """Parameters of numbers.csv, whose exoskeleton is set to a man of its height."""
    found = read_device_numbers(file, parameter_names())
    add_input("device", file, parameters=len(found.values))
    if abs(found.height - study.height) > 1e-6:
        what = f"is of an exoskeleton that is set to {found.height:g} m, the person is {study.height:g} m tall"
        raise InputError(file, "height", what, f"run sit-to-stand device with height {study.height:g} m")
    shank, thigh, _ = part_lengths(Subject(height=found.height))
    return IdentifiedParameters((shank, thigh), found.values, found.by_itself)


def _masses(study: StandingStudy, file: Path, described: WornDevice, source: Path) -> DeviceMasses:
    """Masses of study and description, which must not contradict each other."""
    for name, mass in study.masses.items():
        other = described.stated.get(f"{name}_mass")
        if other is not None and _differ(mass, other.value):
            what = f"{mass:g} kg, and {other.value:g} kg in {source.name}"
            raise InputError(file, f"[masses] {name}", what, "weigh it, and keep one of them")
    return replace(described.masses, **study.masses)


def _moved_alone(
    described: WornDevice, found: IdentifiedParameters, study: StandingStudy, files: tuple[Path, Path]
) -> WornDevice:
    """The described exoskeleton with the dynamics that its own motion identified."""
    file, source = files
    lengths = part_lengths(replace(person_of(study), device=described))
    off = max(abs(own - other) for own, other in zip(lengths, found.lengths, strict=False))
    if off > SAME_LENGTH:
        what = f"moved alone with other lengths than it has on this person, by {1e3 * off:.1f} mm"
        remedy = "let it move alone as worn: sit-to-stand device with `height`, or with shank_length and thigh_length"
        if source.suffix.lower() == ".csv":
            what = f"is set to the lengths of a man of that height, from which [person] differs by {1e3 * off:.1f} mm"
            remedy = "leave the lengths of [person] out, or device"
        raise InputError(source, "", what, remedy)
    if len(found.by_itself) < BY_ITSELF:
        what = (
            f"identifies {len(found.by_itself)} parameters by themselves, where a motion of all hinges has {BY_ITSELF}"
        )
        raise InputError(source, "", what, "move all three hinges in the motion without a person")
    lacking = [
        name for name in vars(described.masses) if name not in study.masses and f"{name}_mass" not in described.stated
    ]
    if lacking:
        reserve(
            f"{file.name}: no mass of {', '.join(lacking)}: invented ones are used, which no motion without a person "
            "identifies; weigh the parts, and write [masses], or NAME_mass in a description of the exoskeleton"
        )
    _confront_friction(described, found, source)
    try:
        device = identified_device(found.values, lengths, described.masses, described)
    except ValueError as error:
        remedy = "weigh the parts, and check their masses: they are of both sides"
        raise InputError(source, "", str(error), remedy) from error
    _confront_bodies(device, source)
    for part, more in zip(PARTS, device.raised, strict=True):
        if more > 0.0:
            reserve(
                f"{source.name}: the inertia of {part} is raised by {more:.2g} kg m² to be that of a body: "
                "faster motions without a person, or its true mass, identify it better"
            )
    return device


def _confront_friction(described: WornDevice, found: IdentifiedParameters, source: Path) -> None:
    """InputError for friction that is described otherwise than identified, and for one that would drive its hinge.

    What noise makes of no friction is less than 0; `sit-to-stand device` describes it as 0.
    """
    for number, name in FRICTION_NAMES.items():
        value, stated = found.values[name], described.stated.get(number)
        if stated is None and value < 0.0:
            what, remedy = (
                f"{value:.3g} would drive the hinge",
                f"check the motors' signs; describe {number} in [numbers]",
            )
            if source.suffix.lower() == ".csv":
                remedy = (
                    "check the motors' signs; name device.toml of the same run, where 0 stands for it if noise is why"
                )
            raise InputError(source, name, what, remedy)
        if stated is not None and name in found.by_itself and _differ(stated.value, max(value, 0.0)):
            what = f"{stated.value:.4g}, and {value:.4g} in [identified.parameters] {name!r}"
            raise InputError(source, f"[numbers] {number}", what, "run sit-to-stand device again, or keep one of them")


def _confront_bodies(device: WornDevice, source: Path) -> None:
    """InputError where mass centres or inertias are described that are not those of the identified dynamics."""
    for part, body in zip(PARTS, device.parts, strict=True):
        kinds = (
            ("centre", body.along, SAME_LENGTH),
            ("ahead", body.across, SAME_LENGTH),
            ("inertia", body.inertia, 0.0),
        )
        for kind, value, least in kinds:
            name = f"{part.removeprefix('exo_')}_{kind}"
            stated = device.stated.get(name)
            if stated is not None and _differ(stated.value, value, least):
                what = f"{stated.value:.4g}, and {value:.4g} by [identified] with a mass of {body.mass:.4g} kg"
                remedy = "leave it out, as [identified] has it, and check the masses"
                raise InputError(source, f"[numbers] {name}", what, remedy)


def _differ(one: float, other: float, least: float = 0.0) -> bool:
    """Whether a number that is given twice is not the same; a difference below `least` does not count."""
    return abs(one - other) > max(least, SAME * max(abs(one), abs(other)))


def _confront_hinges(subject: Subject, source: Path) -> None:
    """A warning for an exoskeleton that does not fit the person, InputError where it has no part left."""
    lengths = part_lengths(subject)
    if min(lengths) <= 0.0:
        what = f"on this person its parts are {', '.join(f'{1e3 * each:.0f}' for each in lengths)} mm long"
        raise InputError(source, "[numbers]", what, "check shank_length, thigh_length and knee_above")
    above = hinges_above(subject)
    for segment, hinge in (("thigh", "knee"), ("trunk", "hip")):
        if abs(above[segment]) > BESIDE:
            off = f"{1e3 * above[segment]:.0f} mm above the person's"
            reserve(f"{source.name}: its {hinge} is {off}: are its lengths in their unit, and set to this person?")


def worn_sites(study: StandingStudy, file: Path, subject: Subject) -> tuple[StrapSite, ...]:
    """Straps of the trials, the thigh's first, with dashpots of study or description, at the exoskeleton's hinges."""
    damped, stated = [], subject.device.stated
    for key in ("damping", "turning_damping"):
        own, other = study.straps.get(key), stated.get(f"strap_{key}")
        if own is not None and other is not None and _differ(own, other.value):
            what = f"{own:g}, and {other.value:g} in the description of the exoskeleton"
            raise InputError(file, f"[straps] {key}", what, "keep one of them")
        damped.append(_first(own, stated, f"strap_{key}"))
    above = hinges_above(subject)
    return tuple(
        replace(site, damping=damped[0], turning_damping=damped[1], above=above[site.person])
        for site in strap_sites(tuple(site for each in study.trials for site in each.elsewhere))
    )


def _first(own: float | None, stated: Mapping[str, Number], name: str) -> float:
    return own if own is not None else {**SHIPPED_NUMBERS, **stated}[name].value
