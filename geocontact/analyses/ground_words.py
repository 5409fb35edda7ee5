"""A plane or stairs as an option writes them."""

from __future__ import annotations

from geocontact.analyses.frame.quantities import number
from geocontact.data.errors import InputError
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Stairs, plane_of

LEVEL = "plane:0,1,0,0"


def plane_or_stairs(text: str) -> HalfSpace | Stairs | None:
    """The ground of plane:nx,ny,nz,offset or stairs:h0,x1:h1 [m]; None for anything else, InputError for what is
    neither.
    """
    kind, colon, rest = text.partition(":")
    if not colon or kind not in ("plane", "stairs"):
        return None
    return _plane(text, rest) if kind == "plane" else _stairs(text, rest)


def _plane(text: str, rest: str) -> HalfSpace:
    parts = rest.split(",")
    if len(parts) != 4:
        raise InputError(
            "", "`ground`", f"{text!r} has {len(parts)} numbers", f"write plane:nx,ny,nz,offset as {LEVEL}"
        )
    x, y, z, offset = (number(part, "`ground`", LEVEL) for part in parts)
    try:
        return plane_of((x, y, z), offset)
    except ValueError as error:
        raise InputError(
            "", "`ground`", f"the normal in {text!r} has no length", f"write for example {LEVEL}"
        ) from error


def _stairs(text: str, rest: str) -> Stairs:
    example = "stairs:0,0.3:0.15,0.6:0.3"
    first, *others = rest.split(",")
    pairs = [part.partition(":") for part in others]
    if not all(colon for _, colon, _ in pairs):
        raise InputError("", "`ground`", f"{text!r} is not a flight of stairs", f"write heights [m] as {example}")
    edges = tuple(number(edge, "`ground`", example) for edge, _, _ in pairs)
    heights = (number(first, "`ground`", example), *(number(height, "`ground`", example) for _, _, height in pairs))
    try:
        return Stairs(edges, heights)
    except ValueError as error:
        raise InputError("", "`ground`", f"{text!r}: {error}", f"write for example {example}") from error
