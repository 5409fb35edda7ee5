"""What is asked of a mesh once it is parsed, the largest that is read, and its polygons made plain."""

from __future__ import annotations

import warnings

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.mesh import repeated_faces
from geocontact.io.text.units import LENGTH, MESH_UNITS

MAX_FACES = 20_000_000
"""Most triangles of one mesh; a binary STL of that size has 1 GB."""

MAX_VERTICES = 3 * MAX_FACES
"""Most vertices of one mesh: three of its own for every triangle."""


def require_count(count: int, limit: int, noun: str, file: str) -> None:
    """Refuse `count` things called `noun` when there are none of them or more than `limit`."""
    if count <= 0:
        raise InputError(file, "", f"no {noun}", "export it again as a triangle surface")
    require_at_most(count, limit, noun, file)


def require_at_most(count: int, limit: int, noun: str, file: str) -> None:
    """Refuse `count` things called `noun` when there are more than `limit`."""
    if count > limit:
        raise InputError(file, "", f"{count} {noun}, more than the {limit} that are read", "decimate the mesh first")


def triangles(
    corners: Int[np.ndarray, " k"], sizes: Int[np.ndarray, " p"], vertex_count: int, file: str
) -> Int[np.ndarray, "m 3"]:
    """Fan triangles of polygons, polygon after polygon, each from its first corner.

    Triangles stay as they are: then triangle i is face i of the file. A polygon of n corners becomes n − 2
    consecutive triangles (warned about: the numbers of later faces move, and a concave polygon comes out wrong).

    Parameters
    ----------
    corners
        Vertex indices of all polygons, one polygon after the other, 0-based.
    sizes
        Number of corners of each polygon; 3 at least, else refused.
    vertex_count
        Vertices there are; an index outside 0 … vertex_count − 1 is refused.
    """
    _require_valid(corners, sizes, vertex_count, file)
    split = int(np.count_nonzero(sizes > 3))
    if split == 0:
        return corners.reshape(-1, 3)
    each = sizes - 2
    require_count(int(each.sum()), MAX_FACES, "faces", file)
    first = np.repeat(np.cumsum(sizes) - sizes, each)
    step = np.arange(len(first)) - np.repeat(np.cumsum(each) - each, each)
    noun = "polygon" if split == 1 else "polygons"
    message = f"{file}: {split} {noun} with more than 3 corners cut into triangles; face numbers count triangles"
    warnings.warn(InputWarning(message), stacklevel=2)
    return np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1)


def _require_valid(corners: Int[np.ndarray, " k"], sizes: Int[np.ndarray, " p"], vertex_count: int, file: str) -> None:
    require_count(len(sizes), MAX_FACES, "faces", file)
    if sizes.min() < 3:
        face = int(np.argmax(sizes < 3))
        raise InputError(file, f"face {face}", f"has {sizes[face]} corners, 3 are needed", "export it again")
    bad = (corners < 0) | (corners >= vertex_count)
    if bad.any():
        corner = int(np.argmax(bad))
        face = int(np.searchsorted(np.cumsum(sizes), corner, side="right"))
        what = f"vertex index {corners[corner]} is outside 0 to {vertex_count - 1}"
        raise InputError(file, f"face {face}", what, "the file is damaged, export it again")


FLAT = 1e-12
"""A face is degenerate when its height is below this fraction of its longest edge: rounding, not shape."""

_IN_WORDS = {"m": "metres", "cm": "centimetres", "mm": "millimetres", "in": "inches"}
SIZES = (5e-3, 2.5)
"""Smallest and largest diagonal [m] of an implant, a bone or a body."""
STRETCHED = 3.5
"""Largest diagonal [m] of a body in metres, a tall person with stretched arms; other units keep the narrower limit."""
_LIKELY = (10e-3, 2.5)
_USUAL = (10e-3, 0.7)
_COMMON_FIRST = ("mm", "m", "cm", "in")
_BLOCK = 1 << 18


def require_finite(vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], file: str) -> None:
    """Refuse nan and infinite coordinates, naming the first such vertex and the first face that uses it."""
    bad = ~np.isfinite(vertices).all(axis=1)
    if not bad.any():
        return
    vertex = int(np.argmax(bad))
    users = (faces == vertex).any(axis=1)
    place = f"face {int(np.argmax(users))} (vertex {vertex})" if users.any() else f"vertex {vertex}"
    x, y, z = vertices[vertex]
    what = f"coordinates {x:g} {y:g} {z:g} are not finite"
    raise InputError(file, place, what, "repair the mesh or export it again")


def require_plausible(vertices: Float[np.ndarray, "n 3"], unit: str, plausible: tuple[float, float], file: str) -> None:
    """Refuse a bounding box whose diagonal is outside `plausible` [m], and name the unit that would fit.

    `vertices` are in the `unit` given. A unit fits when it makes the diagonal 10 mm to 2.5 m long; of several that fit
    the commonest is named (mm, m, cm, in). A box that is not 10 mm to 0.7 m long is warned about (InputWarning) where a
    commoner unit would make it that: it may be a body scan, but more likely is an implant in another unit.
    """
    with np.errstate(over="ignore"):
        box = vertices.max(axis=0).astype(float) - vertices.min(axis=0)
        diagonal = float(np.hypot(np.hypot(box[0], box[1]), box[2]))
    metres = diagonal * LENGTH[unit]
    shown = " x ".join(f"{side:.0f}" if 100 <= side < 1e7 else f"{side:.3g}" for side in box)
    largest = STRETCHED if plausible == SIZES and unit == "m" else plausible[1]
    if plausible[0] <= metres <= largest:
        if plausible == SIZES:
            _warn_of_size(diagonal, unit, f"{file}: bounding box {shown} {unit}")
        return
    size = "too small for an implant" if metres < plausible[0] else "too large for an implant or a body"
    fitting = [u for u in fitting_units(diagonal) if u != unit]
    remedy = f"the file looks like {_IN_WORDS[fitting[0]]}, pass `unit` {fitting[0]}" if fitting else "check the unit"
    raise InputError(file, "", f"bounding box {shown} {unit} is {size}", remedy)


def fitting_units(diagonal: float) -> list[str]:
    """Units in which a bounding box with this diagonal would be 10 mm to 2.5 m long, the commonest first."""
    return [u for u in _COMMON_FIRST if _LIKELY[0] <= diagonal * LENGTH[u] <= _LIKELY[1]]


def _warn_of_size(diagonal: float, unit: str, box: str) -> None:
    """An unusual size that would be usual in a commoner unit; `diagonal` is in the unit given."""
    metres = diagonal * LENGTH[unit]
    commoner = _COMMON_FIRST[: _COMMON_FIRST.index(unit)] if metres > _USUAL[1] else _COMMON_FIRST
    likely = [u for u in commoner if u != unit and _USUAL[0] <= diagonal * LENGTH[u] <= _USUAL[1]]
    if _USUAL[0] <= metres <= _USUAL[1] or not likely:
        return
    meant = f"{likely[0]} would make it {diagonal * LENGTH[likely[0]] * 1e3:.0f} mm"
    what = f"{box} is {metres * 1e3:.0f} mm across, unusual for an implant or a bone; {meant}: check `unit`"
    warnings.warn(InputWarning(what), stacklevel=4)


def metres_per(unit: str, file: str) -> float:
    """Metres per `unit` of a mesh file; InputError that lists the units when it is none of them."""
    if unit not in MESH_UNITS:
        what = f"unknown unit '{unit}'"
        raise InputError(file, "", what, f"pass `unit` {', '.join(MESH_UNITS[:-1])} or {MESH_UNITS[-1]}")
    return LENGTH[unit]


def check_faces(vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], file: str) -> None:
    """Refuse a mesh none of whose faces has an area.

    Some faces without area, and faces with the same three vertices as an earlier one, are warned about.
    """
    flat = degenerate(vertices, faces)
    if flat.all():
        what = f"none of its faces ({len(faces)}) has an area: the corners of each lie on one line"
        raise InputError(file, "", what, "export the surface again")
    _warn(flat, "degenerate faces (zero area), ignored in areas", file)
    _warn(repeated_faces(faces), "duplicate faces (same three vertices as an earlier face)", file)


def degenerate(vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> Bool[np.ndarray, " m"]:
    """Which faces have coincident or collinear corners (height below `FLAT` of the longest edge)."""
    flat = np.empty(len(faces), dtype=bool)
    for start in range(0, len(faces), _BLOCK):
        a, b, c = vertices[faces[start : start + _BLOCK]].swapaxes(0, 1)
        longest = np.max([np.sum(edge * edge, axis=1) for edge in (b - a, c - b, a - c)], axis=0)
        normal = np.cross(b - a, c - a)
        flat[start : start + _BLOCK] = np.sum(normal * normal, axis=1) <= (FLAT * longest) ** 2
    return flat


def _warn(which: Bool[np.ndarray, " m"], what: str, file: str) -> None:
    count = int(np.count_nonzero(which))
    if count:
        what = what if count > 1 else what.replace("faces", "face", 1)
        warnings.warn(InputWarning(f"{file}: {count} {what}; first is face {int(np.argmax(which))}"), stacklevel=4)
