"""The sole of a foot that a file describes: spheres of a table, or foam in columns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import reserve
from geocontact.below_knee_prosthesis.keel.foam import FoamNumbers, foam_law, foam_sole
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.sole import BY_ZONE, SHARED, Foam, KeelSole
from geocontact.below_knee_prosthesis.keel.sole import numbers as usual_sole
from geocontact.data.errors import InputError
from geocontact.data.parameter import SOURCES, Number, Source
from geocontact.io.recordings.foot_description import FoamDescription, FoamZone, SoleDescription, SoleZone
from geocontact.io.recordings.shoulder_device import StatedNumber
from geocontact.io.recordings.spheres import read_spheres
from geocontact.loads.sphere_set import SoleLaw, SphereSet

WORDS = ("heel", "mid", "fore", "toe")
"""Beginnings of names of zones, from the back of a sole to its front."""
MANY, MOST = 240, 1200
"""Columns of foam that are slow, and too many."""
CUT = {"column": Number(4e-3, "invented", "how finely the foam is cut"), "across": Number(2.0, "invented", "likewise")}
"""Breadth of a column along the foot [m], and columns side by side."""
OF_FOAM = ("thickness", "modulus", "retardation", "static", "kinetic")


@dataclass(frozen=True)
class DescribedSole:
    """A sole with its law, its height from the keel's axis [m], and its numbers by name with where they are from."""

    sole: KeelSole
    law: SoleLaw
    below: float
    origin: dict[str, Number]


def spheres_of(file: Path, d: SoleDescription, keel: Keel) -> DescribedSole:
    """Spheres on the segments above them, and their law; InputError for what cannot be."""
    table = read_spheres(d.spheres)
    if table.stiffness is not None or table.damping is not None:
        what = "has k or b of single spheres; spheres of a zone share their law here"
        raise InputError(d.spheres, "", what, "take these columns out and write [sole.zones.NAME]")
    spheres = SphereSet(table.centre, table.radius, table.zone)
    if set(spheres.zones) != set(d.zones):
        odd = min(set(spheres.zones) ^ set(d.zones))
        what = "has spheres and no law" if odd in spheres.zones else "has a law and no sphere"
        raise InputError(file, f"[sole.zones.{odd}]", what, f"zones of the table are {', '.join(spheres.zones)}")
    for zone, of in d.zones.items():
        _check_friction(file, f"[sole.zones.{zone}]", of)
    zones = np.array(spheres.zone)
    along = {zone: float(spheres.centre[zones == zone, 0].mean()) for zone in spheres.zones}
    _check_order(d.spheres, along, "are the zones in the order of the spheres, and is x forwards?")
    tip = float(table.centre[:, 0].max())
    if not (table.centre[:, 0].min() >= -keel.length and tip <= 2.0 * keel.length):
        what = f"a sphere is at {1e3 * tip:.4g} mm"
        raise InputError(d.spheres, "px", what, "x counts along the keel; check its unit")
    lowest = float((table.radius - table.centre[:, 1]).max())
    if abs(lowest - d.below.value) > 5e-3:
        what = f"{1e3 * d.below.value:g} mm, and the lowest sphere reaches {1e3 * lowest:.4g} mm below the keel's axis"
        raise InputError(file, "[sole] below", what, "these two have to agree: y counts from the axis upwards")
    numbers = _shared(d)
    by = {kind: np.array([getattr(d.zones[zone], kind).value for zone in spheres.zone]) for kind in BY_ZONE}
    law = SoleLaw(
        stiffness=by["stiffness"],
        damping=by["damping"],
        exponent=numbers["exponent"].value,
        full_depth=numbers["full_depth"].value,
        static=by["static"],
        kinetic=by["kinetic"],
        threshold_speed=numbers["threshold_speed"].value,
    )
    origin = {f"sole {name}": number for name, number in numbers.items()}
    origin |= {f"sole {zone}_{kind}": number_of(getattr(d.zones[zone], kind)) for zone in d.zones for kind in BY_ZONE}
    source = source_of(d.source)
    origin["sole places"] = Number(0.0, source)
    origin["sole radius"] = Number(float(table.radius[0]), source, "of a sphere")
    origin["sole below"] = number_of(d.below)
    sole = KeelSole(spheres, tuple(keel.segment_of(table.centre[:, 0])))
    return DescribedSole(sole, law, d.below.value, origin)


HIGH = 0.06
"""m; half of a keel, its cover and a heel's wedge are lower."""


def foam_of(file: Path, d: FoamDescription, keel: Keel) -> DescribedSole:
    """Columns of foam on the segments above them, and their law; InputError for what cannot be."""
    foam = _cut(file, d, keel)
    for zone, own in d.zones.items():
        place = f"[foam.zones.{zone}]"
        _check_friction(file, place, own)
        if own.thickness.value > d.below.value:
            what = (
                f"{1e3 * own.thickness.value:g} mm, and the sole ends {1e3 * d.below.value:g} mm below the keel's axis"
            )
            raise InputError(file, f"{place} thickness", what, "foam lies below the axis: correct it, or [foam] below")
        above = d.below.value - own.thickness.value
        if above > HIGH:
            what = (
                f"{1e3 * above:.0f} mm of something else lie between the keel's axis and {1e3 * own.thickness.value:g}"
            )
            reserve(f"{file} {place} thickness: {what} mm of foam: are it and [foam] below in their units?")
    _check_order(
        file,
        {zone: 0.5 * (start + stop) for zone, (start, stop, _) in foam.cuts.items()},
        "do the zones begin at the heel?",
    )
    shared = _shared(d)
    numbers = {zone: FoamNumbers(*(getattr(own, name).value for name in OF_FOAM)) for zone, own in d.zones.items()}
    sole = foam_sole(keel, foam, d.below.value, {zone: each.thickness for zone, each in numbers.items()})
    law = foam_law(sole, numbers, *(shared[name].value for name in SHARED))
    origin = {f"sole {name}": number_of(getattr(d, name)) for name in ("below", "breadth")}
    origin |= {f"sole {name}": number for name, number in (_usual(d) | shared).items()}
    for zone, own in d.zones.items():
        origin |= {f"sole {zone}_{name}": number_of(getattr(own, name)) for name in ("to", *OF_FOAM)}
    return DescribedSole(sole, law, d.below.value, origin)


def _cut(file: Path, d: FoamDescription, keel: Keel) -> Foam:
    """How the foam is cut into columns."""
    if not d.zones:
        raise InputError(file, "[foam.zones]", "there is no zone", "write for example [foam.zones.heel]")
    column, across = (_usual(d)[name].value for name in CUT)
    if across != round(across):
        raise InputError(file, "[foam] across", f"{across:g} is no count", "write a whole number")
    before = 0.0
    for zone, own in d.zones.items():
        if not own.to.value > before:
            what = f"{zone} ends at {1e3 * own.to.value:g} mm and begins at {1e3 * before:g} mm"
            raise InputError(file, f"[foam.zones.{zone}] to", what, "order the zones from the heel")
        before = own.to.value
    if not 0.5 * keel.length <= before <= 2.0 * keel.length:
        what = f"the foam ends at {1e3 * before:g} mm, the keel at {1e3 * keel.length:g} mm"
        raise InputError(file, "[foam.zones] to", what, "it counts along the keel; check its unit")
    ends = tuple((zone, own.to.value) for zone, own in d.zones.items())
    foam = Foam(d.breadth.value, column, round(across), ends)
    count = foam.across * sum(columns for _, _, columns in foam.cuts.values())
    if count > MOST:
        raise InputError(file, "[foam] column", f"{count} columns are too many", f"up to {MOST}: write broader ones")
    if count > MANY:
        reserve(f"{file} [foam]: {count} columns; a simulation takes long with more than {MANY}")
    return foam


def _usual(d: FoamDescription) -> dict[str, Number]:
    """How finely foam is cut, as the file states it or usually."""
    given = {name: getattr(d, name) for name in CUT}
    return {name: CUT[name] if each is None else number_of(each) for name, each in given.items()}


def _shared(d: SoleDescription | FoamDescription) -> dict[str, Number]:
    """Numbers of the law that all of a sole have."""
    usual, given = usual_sole(), {name: getattr(d, name) for name in SHARED}
    return {name: usual[name] if each is None else number_of(each) for name, each in given.items()}


def _check_friction(file: Path, place: str, of: SoleZone | FoamZone) -> None:
    """InputError for friction that grows with sliding."""
    if of.kinetic.value > of.static.value:
        what = f"kinetic friction {of.kinetic.value:g} is larger than the static one, {of.static.value:g}"
        raise InputError(file, f"{place} kinetic", what, "exchange them")


def _check_order(file: Path, places: Mapping[str, float], question: str) -> None:
    """A warning for zones, with their places along the keel [m], in another order than their names say."""
    named = [(k, zone) for k, word in enumerate(WORDS) for zone in places if zone.lower().startswith(word)]
    for (k, back), (j, front) in pairwise(named):
        if k < j and places[back] > places[front]:
            reserve(
                f"{file}: zone {back} is at {1e3 * places[back]:.0f} mm, in front of {front} at "
                f"{1e3 * places[front]:.0f} mm: {question}"
            )


def number_of(stated: StatedNumber) -> Number:
    """A number of a file as the tables of numbers have it."""
    return Number(stated.value, source_of(stated.source), stated.note)


def source_of(text: str) -> Source:
    """What a file says of where a number is from; "option" where it does not."""
    return next((source for source in SOURCES if source == text), "option")
