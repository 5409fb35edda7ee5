"""Description of a leg exoskeleton, which several studies may share.

    name = "prototype"

    [numbers]
    module_mass = { value = 5.2, unit = "kg", source = "derived", note = "weighed" }
    knee_coulomb = { value = 0.8, unit = "N m", source = "paper", note = "data sheet of the gear" }

    [identified]
    shank_length = { value = 452.6, unit = "mm" }
    thigh_length = { value = 414.4, unit = "mm" }
    by_itself = ["exo_knee Coulomb friction"]
    [identified.parameters]
    "exo_knee Coulomb friction" = { value = 0.83, unit = "N m" }

Masses and friction are those of both sides. What is not given is that of the shipped exoskeleton. `[identified]` is
what `sit-to-stand device` writes.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

from pydantic import create_model

from geocontact.data.errors import InputError
from geocontact.data.parameter import SOURCES, Number, Source
from geocontact.data.plausible import COULOMB, INERTIA, N_M_S, N_S_PER_M, PART, VISCOUS, Plausible
from geocontact.data.units import m, mm
from geocontact.io.documents import Document, Names, Some, WithUnit, Word, checked
from geocontact.io.recordings.shoulder_device import LARGEST, SourcedQuantity, StatedNumber
from geocontact.io.text.toml_text import toml_of

LENGTHS = ("shank_length", "thigh_length")
BODIES = ("shank", "thigh", "module")
HINGED = ("ankle", "knee", "hip")
SEGMENT = Plausible("the length of a part of a worn device", m, (0.05, 1.0), (0.2, 0.6))
OVER = Plausible("how much higher a device's knee is than a person's", mm, (-200.0, 200.0), (-50.0, 50.0))
PLACE = Plausible("the place of a mass centre in a part of a device", m, (-1.0, 1.0), (-0.5, 0.5))
STRAP_DAMPING = Plausible("the damping of a strap", N_S_PER_M, (0.0, 1e5), (0.0, 1000.0))
TURN_DAMPING = Plausible("the damping of a strap's turn", N_M_S, (0.0, 1e4), (0.0, 10.0))
EXOSKELETON: Mapping[str, Plausible] = {
    "foot_plate_mass": PART,
    **{f"{part}_mass": PART for part in BODIES},
    "knee_above": OVER,
    "shank_length": SEGMENT,
    "thigh_length": SEGMENT,
    "module_height": SEGMENT,
    **{f"{part}_{axis}": PLACE for part in BODIES for axis in ("centre", "ahead")},
    **{f"{part}_inertia": INERTIA for part in BODIES},
    "strap_damping": STRAP_DAMPING,
    "strap_turning_damping": TURN_DAMPING,
    **{f"{hinge}_viscous": replace(VISCOUS, or_zero=True) for hinge in HINGED},
    **{f"{hinge}_coulomb": replace(COULOMB, or_zero=True) for hinge in HINGED},
}
"""All numbers of an exoskeleton; mass centres are above their hinge and ahead of it, inertias about z through them."""


class IdentifiedDynamics(Document):
    """What the motion of an exoskeleton alone identified.

    Parameters
    ----------
    shank_length, thigh_length
        Lengths to which it was set.
    by_itself
        Parameters that the motion identifies by themselves; the others act in sums only, or not at all.
    parameters
        All dynamic parameters by the names of `sit-to-stand device`, each with its unit.
    """

    shank_length: Annotated[float, WithUnit(SEGMENT)]
    thigh_length: Annotated[float, WithUnit(SEGMENT)]
    by_itself: Names = ()
    parameters: Mapping[str, Any]


class ExoskeletonDescription(Document):
    """What differs from the shipped leg exoskeleton.

    Parameters
    ----------
    name
        For the record; the file's name by default.
    numbers
        Numbers by name, `NAME = { value, unit, source, note }`: masses of foot_plate, shank, thigh and module with
        their centre, ahead and inertia; lengths knee_above, shank_length, thigh_length, module_height; strap_damping,
        strap_turning_damping; viscous and coulomb friction of ankle, knee and hip.
    identified
        What `sit-to-stand device` found.
    """

    name: Word | None = None
    numbers: Mapping[str, Any] = {}
    identified: IdentifiedDynamics | None = None


@dataclass(frozen=True)
class IdentifiedParameters:
    """What the motion of the exoskeleton alone identified, in SI.

    Parameters
    ----------
    lengths
        Lengths of shank and thigh to which it was set [m].
    values
        All dynamic parameters by name.
    by_itself
        Names of those that the motion identifies by themselves.
    """

    lengths: tuple[float, float]
    values: Mapping[str, float]
    by_itself: tuple[str, ...]


@dataclass(frozen=True)
class ExoskeletonFile:
    """A description as it was read.

    Parameters
    ----------
    numbers
        Numbers that are given, by name, in SI.
    identified
        What a motion of it alone identified; None without `[identified]`.
    """

    name: str
    numbers: Mapping[str, Number]
    identified: IdentifiedParameters | None = None


def read_exoskeleton(path: Path, sources: tuple[str, ...], parameters: Mapping[str, str]) -> ExoskeletonFile:
    """A leg exoskeleton; InputError for what is missing or cannot be.

    Parameters
    ----------
    sources
        Words that may say where a number is from.
    parameters
        SI unit of every identified parameter by its name; all of them must be there.
    """
    numbers = Some({n: Annotated[StatedNumber, SourcedQuantity(p, sources=sources)] for n, p in EXOSKELETON.items()})
    given: dict[str, Any] = {name: (Annotated[float, WithUnit(unit)], ...) for name, unit in parameters.items()}
    found_alone = create_model("Parameters", __base__=Document, **given)
    dynamics = create_model("Identified", __base__=IdentifiedDynamics, parameters=(found_alone, ...))
    may_be_absent: Any = dynamics | None
    kind = create_model(
        "Exoskeleton",
        __base__=ExoskeletonDescription,
        numbers=(Annotated[dict[str, StatedNumber], numbers], {}),
        identified=(may_be_absent, None),
    )
    read = checked(path, kind, toml_of(path, LARGEST))
    stated: Mapping[str, StatedNumber] = read.numbers
    own = {name: Number(each.value, _source(each.source), each.note) for name, each in stated.items()}
    found = None
    if read.identified is not None:
        of = read.identified
        values = {name: float(getattr(of.parameters, name)) for name in parameters}
        odd = next((name for name in of.by_itself if name not in values), None)
        if odd is not None:
            raise InputError(
                path, "[identified] by_itself", f"{odd!r} is no parameter", "write names of [identified.parameters]"
            )
        found = IdentifiedParameters((of.shank_length, of.thigh_length), values, of.by_itself)
    return ExoskeletonFile(read.name or path.stem, own, found)


def _source(word: str) -> Source:
    return next(source for source in SOURCES if source == word)


def exoskeleton_toml(of: ExoskeletonFile, units: Mapping[str, str], remarks: Mapping[str, str] = {}) -> str:
    """Text that `read_exoskeleton` reads, numbers to the last digit, in the order of `EXOSKELETON`.

    Parameters
    ----------
    units
        SI unit of every identified parameter.
    remarks
        What stands behind numbers and identified parameters as a comment, by name.
    """
    lines = [f"name = {json.dumps(of.name, ensure_ascii=False)}"]
    if of.numbers:
        lines += ["", "[numbers]"]
        for name, each in sorted(of.numbers.items(), key=lambda item: list(EXOSKELETON).index(item[0])):
            said = f"source = {json.dumps(each.source)}, note = {json.dumps(each.note, ensure_ascii=False)}"
            line = f"{name} = {{ value = {each.value!r}, unit = {json.dumps(EXOSKELETON[name].unit.si)}, {said} }}"
            lines.append(f"{line}  # {remarks[name]}" if name in remarks else line)
    if (found := of.identified) is not None:
        lines += ["", "[identified]"]
        lines += [f'{n} = {{ value = {v!r}, unit = "m" }}' for n, v in zip(LENGTHS, found.lengths, strict=True)]
        lines += [f"by_itself = {json.dumps(found.by_itself)}", "", "[identified.parameters]"]
        for name, value in found.values.items():
            line = f'"{name}" = {{ value = {float(value)!r}, unit = "{units[name]}" }}'
            lines.append(f"{line}  # {remarks[name]}" if name in remarks else line)
    return "\n".join(lines) + "\n"
