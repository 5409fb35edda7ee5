"""What the annotation of an option says of it beyond its type, and kinds of options that many analyses have.

The unit (`Typed`), how the command line spells it (`Spelled`), with which other options it has an effect (`Requires`,
`Excludes`, `Needs`), of which files it is (`ForFiles`), and what is said of a path that leads nowhere (`Missing`).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from geocontact.data.plausible import CLOCK


@dataclass(frozen=True)
class Typed:
    """The SI unit of an option's value, and how the command line reads what is typed.

    Parameters
    ----------
    si
        SI unit, "-" for none.
    python
        A value as Python writes it, for the help of the call.
    read
        Function of `analyses.frame.quantities` that takes the text and the option's name and gives the value in SI; as
        "misalignment.law_numbers:numbers" of another module of the analyses.
    hint
        What the help of the command line says of units.
    kind
        Type of what is typed.
    """

    si: str
    read: str
    python: str
    hint: str = ""
    kind: Any = str


@dataclass(frozen=True)
class Spelled:
    """How the command line spells an option, where that does not follow from its name.

    Parameters
    ----------
    name
        Without the two dashes; that of the field with dashes for underscores by default.
    key
        Name in `run.json`; that of the field by default.
    default
        The default as it is typed, where that is not the default in SI.
    dashed
        A value may begin with a minus.
    each
        May be given again and again, one value each time.
    keyword
        An option there, although in Python it may be given by its place.
    rest
        Arguments without a name that are left are added to it.
    """

    name: str = ""
    key: str = ""
    default: Any = None
    dashed: bool = False
    each: bool = False
    keyword: bool = False
    rest: bool = False


@dataclass(frozen=True)
class Requires:
    """The option has no effect unless the other one is given, or `alternative` where there is one.

    `remedy` is what to do, "give `other`" by default.
    """

    other: str
    remedy: str = ""
    alternative: str = ""


@dataclass(frozen=True)
class Excludes:
    """The option has no effect, or contradicts, where the other one is given; `why` is added to the message."""

    other: str
    why: str = ""
    remedy: str = "leave it out"


@dataclass(frozen=True)
class Needs:
    """Where this option is given the other one is needed too; `remedy` gives an example."""

    other: str
    remedy: str = ""


@dataclass(frozen=True)
class ForFiles:
    """The option has no effect unless one of the paths that are given ends so: that of such a file, or of one that
    names it.
    """

    endings: tuple[str, ...]


@dataclass(frozen=True)
class Missing:
    """What is said of a path that leads nowhere, and the remedy; nothing is said where there is no `what`."""

    what: str = "there is no such file"
    remedy: str = "check the path"


MeshUnit = Literal["m", "cm", "mm", "in"]
ForceUnit = Literal["lbf", "N", "kN", "mN", "kgf"]
AngleUnit = Literal["deg", "rad"]
LengthUnit = Literal["m", "cm", "mm", "in", "um"]
C3dUnit = Annotated[LengthUnit | None, ForFiles((".c3d", ".toml", ".xml"))]
"""Unit of places in .c3d files whose own is empty."""
CaseFolder = Annotated[Path, Missing("there is no such folder", "name the folder that holds case.toml")]
Length = Annotated[float, Typed("m", "length", "gc.mm(4)", "mm unless a unit is written")]
PartLength = Annotated[float, Typed("m", "length", "gc.mm(100)", "mm unless a unit is written")]
Lengths = Annotated[tuple[float, ...], Typed("m", "lengths", "gc.mm(1, 4)", "mm unless a unit is written")]
Millimetres = Annotated[float, Typed("m", "millimetres", "gc.mm(30)", "[mm]", float)]
BodyMass = Annotated[float, Typed("kg", "body_mass", "77.3", "kg unless a unit is written")]
PartMass = Annotated[float, Typed("kg", "body_mass", "1.5", "kg unless a unit is written")]
Degrees = Annotated[float, Typed("rad", "degrees", "gc.deg(5)", "[deg]", float)]
Fraction = Annotated[float, Typed("-", "fraction", "0.02")]
Pressure = Annotated[float, Typed("Pa", "pressure", "gc.MPa(0.5)")]
WearRate = Annotated[float, Typed("m^2/N", "wear_factor", "1e-16")]
TimeSpan = Annotated[tuple[float, float], Typed("s", "time_span", "(0.4, 1.6)"), CLOCK, Spelled(dashed=True)]
Expression = Annotated[str, Spelled(dashed=True)]
Texts = Annotated[tuple[str, ...], Spelled(dashed=True, each=True)]
