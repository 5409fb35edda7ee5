"""Keys of descriptions in TOML: docs/reference/descriptions.md, from the classes that read them.

What a key holds follows from how it is declared; what it means stands under its name in the docstring of its class.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import groupby
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from annotated_types import Ge, Gt, Le, Lt
from pydantic.fields import FieldInfo

from geocontact.analyses.frame.docstrings import documented
from geocontact.analyses.misalignment.population.drawn import UNITS
from geocontact.data.plausible import Plausible
from geocontact.io.cases.gathering import Sources
from geocontact.io.documents import Document, Holds, Listed, Some, WithUnit
from geocontact.io.recordings.contact_pairs import PairsDescription
from geocontact.io.recordings.exoskeleton_description import ExoskeletonDescription
from geocontact.io.recordings.foot_description import FootDescription
from geocontact.io.recordings.gait_study import GaitStudy
from geocontact.io.recordings.overhead_study import OverheadStudy
from geocontact.io.recordings.population import PopulationDescription, QuantityEntry
from geocontact.io.recordings.shoulder_device import DeviceDescription, StatedNumber
from geocontact.io.recordings.socket_description import SocketDescription
from geocontact.io.recordings.standing_study import StandingStudy
from geocontact.study.description import StudyFile

PAGE = "docs/reference/descriptions.md"
REQUIRED = "required"
"""In place of a default."""
INTRODUCTION = """# Keys of descriptions

Files in TOML that commands read; made by `python -m website.pages`. Keys in **bold** are required. Paths start from the
folder of the file. A key that is not listed is refused, and so is a value that its key does not hold. A quantity is a
number with its unit, `{ value = 32, unit = "mm" }`, in any unit of the same kind; `source` and `note` may stand
beside them."""


@dataclass(frozen=True)
class DescribedFile:
    """A kind of file.

    Parameters
    ----------
    title
        What it describes.
    commands
        Who reads it, and where there is an example, in Markdown.
    kind
        Its class.
    entries
        Classes of tables that are made for each file anew, by their headings.
    """

    title: str
    commands: str
    kind: type[Document]
    entries: Mapping[str, type[Document]]


FILES = (
    DescribedFile("A study", "`geocontact cohort` ([guide](../how-to/cohort.md))", StudyFile, {}),
    DescribedFile(
        "Pairs of bodies",
        "`geocontact pairs`, `settle-pairs` ([guide](../how-to/regions_and_sides.md#several-pairs)), such as "
        "`meshes/knee_pairs.toml`, `meshes/resting_knee.toml`",
        PairsDescription,
        {},
    ),
    DescribedFile(
        "A gap case to gather",
        "`geocontact gap gather` ([guide](../how-to/gap.md#from-pressure-mats)), beside the keys of "
        "[case.toml](gap_case.md), of which `layout` and `mesh` are left out",
        Sources,
        {},
    ),
    DescribedFile(
        "A population",
        "`geocontact elbow population` ([guide](../how-to/elbow_design.md)); all of "
        + ", ".join(f"`{name}`" for name in UNITS),
        PopulationDescription,
        {"NAME": QuantityEntry},
    ),
    DescribedFile(
        "Overhead work",
        "`geocontact shoulder study`, `geocontact shoulder optimise --study` ([guide](../how-to/shoulder.md))",
        OverheadStudy,
        {},
    ),
    DescribedFile(
        "A shoulder exoskeleton",
        "`--device` of `geocontact shoulder …`; [its numbers](input_files.md#shoulder-exoskeletons)",
        DeviceDescription,
        {},
    ),
    DescribedFile(
        "A prosthetic foot",
        "`geocontact prosthesis keel`, `--foot` of `geocontact prosthesis …` ([guide](../how-to/prosthesis.md))",
        FootDescription,
        {},
    ),
    DescribedFile(
        "A socket on a residual limb",
        "`--socket-numbers` of `geocontact prosthesis simulate` and `compare`",
        SocketDescription,
        {},
    ),
    DescribedFile(
        "Stances on a prosthetic foot",
        "`geocontact prosthesis compare`, `geocontact prosthesis design` ([guide](../how-to/prosthesis.md))",
        GaitStudy,
        {},
    ),
    DescribedFile(
        "Standing up",
        "`geocontact sit-to-stand calibrate`, `compare`, `predict`, `design` ([guide](../how-to/sit_to_stand.md))",
        StandingStudy,
        {},
    ),
    DescribedFile(
        "A leg exoskeleton",
        "`--device` of `geocontact sit-to-stand calibrate`, `predict`, `compare`, `design`, `device`",
        ExoskeletonDescription,
        {},
    ),
)


@dataclass(frozen=True)
class Row:
    """A key of a table: what it holds, what counts where it is left out, what it means."""

    table: str
    key: str
    holds: str
    default: str
    meaning: str


def descriptions() -> str:
    """The whole page."""
    parts = [INTRODUCTION]
    for file in FILES:
        rows = list(rows_of(file.kind))
        for name, kind in file.entries.items():
            rows += rows_of(kind, name)
        lines: list[str] = []
        above = ""
        for row, alike in groupby(rows, lambda row: replace(row, key="")):
            keys = ", ".join(f"**{one.key}**" if row.default == REQUIRED else one.key for one in alike)
            usual = f", by default {row.default}" if row.default not in ("", REQUIRED) else ""
            if row.table != above:
                lines += ["", f"{row.table}:", ""]
            lines.append(f"- {keys}: {row.holds}{usual}." + (f" {row.meaning}" if row.meaning else ""))
            above = row.table
        parts += [f"## {file.title}", f"{file.commands}.", "\n".join(lines).strip()]
    return "\n\n".join(parts) + "\n"


def rows_of(kind: type[Document], place: str = "", heading: str = "", usual: str = "") -> Iterator[Row]:
    """Every key of a class, those of the tables in it after its own; KeyError for one whose meaning is not stated.

    `usual` is the name of one of them that has none.
    """
    own = {name.split()[0]: one.words for name, one in documented(kind.__doc__ or "").items()}
    table = f"`{heading or f'[{place}]'}`" if place else ""
    further: list[Row] = []
    for name, field in kind.by_key().items():
        marks, inner = taken_apart(field)
        below = f"{place}.{name}" if place else name
        each = next((one for one in (inner, *get_args(inner)) if _is_document(one)), None)
        if each is not None:
            by_name = get_origin(inner) is dict
            form = f"[[{below}]]" if get_origin(inner) is tuple else f"[{below}.NAME]" if by_name else f"[{below}]"
            listed = next((one.usual for one in marks if isinstance(one, Listed)), "")
            further += rows_of(each, f"{below}.NAME" if by_name else below, form, listed)
            continue
        some = next((one for one in marks if isinstance(one, Some)), None)
        if some is not None:
            further += [
                Row(f"`[{below}]`", f"`{key}`", holds(*_split(each)), "", "" if k else own[name])
                for k, (key, each) in enumerate(some.kinds.items())
            ]
            continue
        default = f"`{usual}`" if usual and name == "name" else _default(field)
        yield Row(table, f"`{name}`", holds(marks, inner), default, own[name])
    if kind.model_config["extra"] == "allow":
        value = get_args(get_type_hints(kind, include_extras=True)["__pydantic_extra__"])[1]
        (name,) = own.keys() - kind.by_key().keys()
        yield Row(table, f"`{name}`, any other", holds(*_split(value)), "", own[name])
    yield from further


def _is_document(kind: object) -> bool:
    return isinstance(kind, type) and issubclass(kind, Document)


def taken_apart(field: FieldInfo) -> tuple[list[Any], Any]:
    """Marks of a field of all layers, and its type without them and without None."""
    marks, inner = _split(field.annotation)
    return [*field.metadata, *marks], inner


def _split(kind: Any) -> tuple[list[Any], Any]:
    marks: list[Any] = []
    while True:
        if get_origin(kind) is Annotated:
            kind, *own = get_args(kind)
            marks += [mark for each in own for mark in (each.metadata if isinstance(each, FieldInfo) else [each])]
        elif get_origin(kind) in (Union, UnionType) and NoneType in get_args(kind):
            (kind,) = (each for each in get_args(kind) if each is not NoneType)
        else:
            return marks, kind


def holds(marks: list[Any], kind: Any) -> str:
    """What a key holds, in words."""
    said = next((one.words for one in reversed(marks) if isinstance(one, Holds)), None)
    unit = next((one for one in marks if isinstance(one, WithUnit)), None)
    if said is not None:
        words = said
    elif unit is not None:
        words = f"quantity{' or number' if unit.bare else ''}{_unit(unit)}"
    elif get_origin(kind) is Literal:
        words = ", ".join(f"`{each}`" for each in get_args(kind))
    elif get_origin(kind) is tuple:
        words = f"`[[…]]`, {holds(*_split(get_args(kind)[0]))}"
    elif get_origin(kind) is not None and get_args(kind)[1] is not Any:
        words = f"names, each with {holds(*_split(get_args(kind)[1]))}"
    elif get_origin(kind) is not None:
        words = "names with values"
    else:
        words = {str: "text", bool: "true or false", float: "number", int: "whole number"}[kind]
    return ", ".join([words, *_bounds(marks)])


def _unit(one: WithUnit) -> str:
    if one.si == "-":
        return ""
    if isinstance(one.known, Plausible):
        low, high = one.known.possible
        return f", {low:g} to {high:g} {one.known.unit.name}".rstrip()
    return f", {one.si}"


def _bounds(marks: list[Any]) -> list[str]:
    kinds = {Gt: ("above", "gt"), Ge: ("at least", "ge"), Lt: ("below", "lt"), Le: ("at most", "le")}
    return [f"{kinds[type(one)][0]} {getattr(one, kinds[type(one)][1]):g}" for one in marks if type(one) in kinds]


def _default(field: FieldInfo) -> str:
    """What counts where the key is left out; `REQUIRED` where it may not be."""
    if field.is_required():
        return REQUIRED
    value = field.get_default(call_default_factory=True, validated_data={})
    value = value.value if isinstance(value, StatedNumber) else value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple) and value:
        return f"`[{', '.join(f'{each:g}' for each in value)}]`"
    return f"{value:g}" if isinstance(value, float) else f"`{value}`" if value else ""
