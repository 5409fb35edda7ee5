"""Options that read landmarks picked on the surface of a field."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from geocontact.analyses.shape.options import NEEDS

Kind = Literal["region", "named region", "line", "point", "table"]
REGION: Kind = "region"
NAMED_REGION: Kind = "named region"
LINE: Kind = "line"
POINT: Kind = "point"
TABLE: Kind = "table"


@dataclass(frozen=True)
class Use:
    """An option, and how it names landmarks: faces inside or near them, from one to another, one of them, or all."""

    field: str
    kind: Kind


_USES: dict[tuple[str, str], tuple[Use, ...]] = {
    ("area", "fixed"): (Use("region", REGION),),
    ("area", "moving"): (Use("region_moving", REGION), Use("axis", LINE)),
    ("fit", "mesh"): (Use("region", REGION), Use("axis", LINE), Use("centre", POINT)),
    ("knee settle", "fixed"): (Use("region", REGION),),
    ("knee settle", "moving"): (Use("load_point", POINT),),
    ("mat", "surface"): (Use("landmarks", TABLE), Use("segment", NAMED_REGION), Use("first_corner", POINT)),
    ("mat", "body"): (Use("picked_on_body", TABLE),),
}


ELSEWHERE = {"fit": tuple(NEEDS)}
"""Names that a region may use and that depend on more than its surface, by analysis."""


def uses_of(command: str, surface: str) -> tuple[Use, ...]:
    """Options of an analysis that read landmarks picked on the surface of a field."""
    return _USES.get((command, surface), ())


def region_of(command: str, surface: str) -> str:
    """The option whose faces are those of this surface; "" where there is none."""
    return next((use.field for use in uses_of(command, surface) if use.kind == REGION), "")
