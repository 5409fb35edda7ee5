"""A prosthetic foot as the options name it: the shipped one, or that of a file.

The shipped foot is such a file too, `shipped_foot/foot.toml`, written by `python -m meshes.make_foot`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.prosthesis.sole_file import DescribedSole, foam_of, number_of, spheres_of
from geocontact.below_knee_prosthesis.keel.foot import FootRecord, VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel, torsional_stiffness
from geocontact.below_knee_prosthesis.keel.sections import ONE, Sections
from geocontact.below_knee_prosthesis.keel.sole import law_of, sole_of, sole_origin
from geocontact.below_knee_prosthesis.keel.sole import numbers as usual_sole
from geocontact.below_knee_prosthesis.keel.vsf import NAME
from geocontact.below_knee_prosthesis.schedule import FulcrumSchedule, ScheduledPlace
from geocontact.data.errors import InputError
from geocontact.data.parameter import Number
from geocontact.data.plausible import Plausible
from geocontact.data.units import mm
from geocontact.io.recordings.foot_description import (
    FootDescription,
    KeelDescription,
    KeelSection,
    read_foot_description,
)
from geocontact.io.recordings.fulcrum_schedule import read_fulcrum_schedule

SHIPPED = Path(__file__).parent / "shipped_foot" / "foot.toml"
RETARDATION = Number(2e-3, "invented", "a loss factor of 0.013 at 1 Hz")
SHEAR_SHARE = 7.0 / 18.6
"""Shear modulus over flexural modulus where they are not known, of G10/FR4 (invented)."""
UNKNOWN_BENDING = 20.0
"""EI [N m²] from which that of a keel is sought of which it is not known."""
NAMED = ("length", "posterior", "joints", "lowest", "highest", "width", "density")
ROUNDING = 1e-6
"""m; of a length in mm."""
AT_TIP = 1e-6
"""Share of the keel's length by which the last section may end beside the tip."""


@dataclass(frozen=True, eq=False)
class FootFile:
    """A foot from a file.

    Parameters
    ----------
    foot
        With a keel of some EI where that is not known.
    described
        Everything in the file.
    known
        Whether EI is known.
    """

    foot: VariableStiffnessFoot
    described: FootDescription
    known: bool


def foot_of(file: Path | None) -> VariableStiffnessFoot:
    """The foot of a file, the shipped one for None; InputError where its keel is not known."""
    if file is None:
        return _shipped()
    found = read_foot(file)
    keep_inputs(file, found)
    if not found.known:
        what = "EI of the keel is not known"
        raise InputError(file, "[keel]", what, "write bending, or identify it from [[compressions]]: prosthesis keel")
    return found.foot


def keep_inputs(file: Path, found: FootFile) -> None:
    """Keep the files of a foot for run.json."""
    spheres = found.foot.sole.spheres
    add_input("`foot`", file, **{"spheres" if spheres.thickness is None else "columns": len(spheres)})
    if found.described.sole is not None:
        add_input("spheres", found.described.sole.spheres)


@lru_cache(maxsize=1)
def _shipped() -> VariableStiffnessFoot:
    return read_foot(SHIPPED).foot


def fulcrum_at(foot: VariableStiffnessFoot, setting: str, fulcrum: float | None) -> float:
    """Place of the fulcrum [m]: the one that is named, else that of a setting; InputError where the foot has none."""
    low, high = (1e3 * end for end in foot.keel.range)
    if fulcrum is not None:
        Plausible("the place of a fulcrum", mm, (low, high)).require(fulcrum, "`fulcrum`")
        return fulcrum
    settings = foot.record.settings
    if setting not in settings:
        what = f"{setting!r} is none of the settings of {foot.record.name}"
        remedy = f"write {', '.join(settings)}, or name a `fulcrum`" if settings else "it has none: name a `fulcrum`"
        raise InputError("", "`setting`", what, remedy)
    return settings[setting]


def read_schedule(file: Path, foot: VariableStiffnessFoot) -> FulcrumSchedule:
    """A schedule with the places of this foot's fulcrum; InputError for one that it has not."""
    table, places = read_fulcrum_schedule(file), []
    add_input("`schedule`", file, rows=len(table.rows))
    for number, row in enumerate(table.rows, start=1):
        try:
            fulcrum = fulcrum_at(foot, row.setting or "", row.fulcrum)
        except InputError as error:
            raise replace(error, file=file, place=f"row {number}") from error
        places.append(ScheduledPlace(row.start, row.setting or f"{1e3 * fulcrum:g} mm", fulcrum))
    return FulcrumSchedule(table.by, tuple(places))


def read_foot(file: Path) -> FootFile:
    """Keel, sole and law of a description; InputError for what cannot be."""
    described = read_foot_description(file)
    keel, known = _keel(file, described.keel)
    name = described.name or file.stem
    for setting, place in described.settings.items():
        if not keel.range[0] <= place.value <= keel.range[1]:
            ends = f"{1e3 * keel.range[0]:g} to {1e3 * keel.range[1]:g} mm"
            what = f"{1e3 * place.value:g} mm is out of the fulcrum's range"
            raise InputError(file, f"[settings] {setting}", what, f"that is {ends}")
    settings = {setting: place.value for setting, place in described.settings.items()}
    under = _under(file, described, keel)
    places = {f"setting {setting}": number_of(place) for setting, place in described.settings.items()}
    origin = _origin(described.keel, keel) | places | under.origin
    moved = described.actuator
    if moved is not None:
        origin["actuator speed"] = number_of(moved.speed)
    record = FootRecord(str(name), under.below, settings, origin, None if moved is None else moved.speed.value)
    return FootFile(VariableStiffnessFoot(keel, under.sole, under.law, record), described, known)


def _under(file: Path, described: FootDescription, keel: Keel) -> DescribedSole:
    """What the keel stands on; the spheres of the shipped foot where the file does not say."""
    if described.foam is not None:
        return foam_of(file, described.foam, keel)
    if described.sole is not None:
        return spheres_of(file, described.sole, keel)
    sole = sole_of(keel)
    law = law_of(sole)
    reserve(f"{file}: no [sole]; it has that of {NAME}, stretched to the keel, whose numbers are invented")
    return DescribedSole(sole, law, usual_sole()["below"].value, sole_origin(sole, law))


def _keel(file: Path, d: KeelDescription) -> tuple[Keel, bool]:
    """The keel, and whether its EI is known."""
    bending, known = _bending(file, d)
    sections = _sections(file, d) if d.sections else ONE
    thickness = _thickness(file, d, bending, known)
    torsional = None if d.torsional is None else d.torsional.value
    if torsional is None:
        torsional = _torsional(d, bending, thickness)
    retardation = RETARDATION.value if d.retardation is None else d.retardation.value
    try:
        keel = Keel(
            length=d.length.value,
            posterior=d.posterior.value,
            joints=_joints(file, d),
            bending=bending,
            torsional=torsional,
            retardation=retardation,
            width=d.width.value,
            thickness=thickness,
            density=d.density.value,
            support=d.support,
            range=(d.lowest.value, d.highest.value),
            sections=sections,
            twists=d.twists,
        )
    except ValueError as error:
        raise InputError(file, "[keel]", str(error), "check lengths and the range of the fulcrum") from error
    if d.posterior.value > d.lowest.value + ROUNDING:
        what = f"the first joint, at {1e3 * d.posterior.value:g} mm, is in front of the first place of the fulcrum"
        reserve(f"{file} [keel] posterior: {what}, {1e3 * d.lowest.value:g} mm: the keel does not bend between them")
    return keel, known


def _joints(file: Path, d: KeelDescription) -> int:
    if d.joints.value != round(d.joints.value):
        raise InputError(file, "[keel] joints", f"{d.joints.value:g} is no count", "write a whole number")
    return round(d.joints.value)


def _bending(file: Path, d: KeelDescription) -> tuple[float, bool]:
    """EI of the keel, of its first section where it has several, and whether it is known."""
    if d.sections and d.bending is not None:
        what = "EI of the whole keel and of its sections"
        raise InputError(file, "[keel] bending", what, "give one of them: a section is a whole keel too")
    if d.sections:
        return _section_bending(file, d, d.sections[0], 1), True
    if d.bending is not None:
        return d.bending.value, True
    if d.modulus is not None and d.thickness is not None:
        return _flat(d.modulus.value, d.width.value, d.thickness.value), True
    return UNKNOWN_BENDING, False


def _sections(file: Path, d: KeelDescription) -> Sections:
    """Factors on EI of the first section."""
    ends = [section.to.value for section in d.sections]
    if abs(ends[-1] / d.length.value - 1.0) > AT_TIP:
        what = f"the last section ends at {1e3 * ends[-1]:g} mm, the keel at {1e3 * d.length.value:g} mm"
        raise InputError(file, f"[[keel.sections]] {len(ends)} to", what, "let it end at the tip")
    bendings = [_section_bending(file, d, section, k) for k, section in enumerate(d.sections, 1)]
    try:
        return Sections(tuple(ends[:-1]), tuple(each / bendings[0] for each in bendings))
    except ValueError as error:
        raise InputError(file, "[[keel.sections]] to", str(error), "order them from the posterior end") from error


def _section_bending(file: Path, d: KeelDescription, section: KeelSection, number: int) -> float:
    """EI of a section [N m²]."""
    place = f"[[keel.sections]] {number}"
    if (section.bending is None) == (section.thickness is None):
        raise InputError(file, place, "needs bending or thickness", "give one of them")
    if section.bending is not None:
        return section.bending.value
    if d.modulus is None or section.thickness is None:
        raise InputError(file, place, "has a thickness, but the keel no modulus", "write [keel] modulus, or bending")
    width = d.width if section.width is None else section.width
    return _flat(d.modulus.value, width.value, section.thickness.value)


def _thickness(file: Path, d: KeelDescription, bending: float, known: bool) -> float:
    """Thickness that the keel's mass is from [m]; the mean of its sections where they have one each."""
    if d.thickness is not None:
        return d.thickness.value
    stated = [section.thickness.value for section in d.sections if section.thickness is not None]
    if d.sections and len(stated) == len(d.sections):
        long = np.diff([0.0, *(section.to.value for section in d.sections)])
        return float(np.average(stated, weights=long))
    if d.modulus is not None and known:
        return float((12.0 * bending / (d.modulus.value * d.width.value)) ** (1.0 / 3.0))
    raise InputError(file, "[keel] thickness", "is not known: the keel's mass is from it", "write it")


def _torsional(d: KeelDescription, bending: float, thickness: float) -> float:
    """GJ of a flat section; by the moduli' usual ratio where they are not known."""
    if d.shear_modulus is not None and not d.sections and d.width.value >= 2.0 * thickness:
        return torsional_stiffness(d.shear_modulus.value, d.width.value, thickness)
    share = SHEAR_SHARE
    if d.shear_modulus is not None and d.modulus is not None:
        share = d.shear_modulus.value / d.modulus.value
    return 4.0 * share * bending


def _flat(modulus: float, width: float, thickness: float) -> float:
    """EI of a rectangle [N m²]."""
    return modulus * width * thickness**3 / 12.0


def _origin(d: KeelDescription, keel: Keel) -> dict[str, Number]:
    """Where the keel's numbers are from, by their names in `foot_numbers`."""
    found = {f"keel {name}": number_of(getattr(d, name)) for name in NAMED}
    found["keel retardation"] = RETARDATION if d.retardation is None else number_of(d.retardation)
    derived = Number(keel.bending, "derived", "EI, from modulus and section")
    if d.twists:
        flat = Number(keel.torsional, "derived", "GJ, of a flat section")
        found["keel torsional"] = flat if d.torsional is None else number_of(d.torsional)
    found["keel bending"] = derived if d.bending is None else number_of(d.bending)
    usual = Number(keel.thickness, "derived", "from width, modulus and EI as of beam theory")
    found["keel thickness"] = usual if d.thickness is None else number_of(d.thickness)
    return found
