"""Landmarks picked on a surface, where they name a region, an axis or a centre: read, and checked against the mesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.quantities import length, named_file
from geocontact.data.errors import InputError
from geocontact.geometry.picked_regions import faces_near, faces_within
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.landmarks import Landmarks, read_landmarks

OFF = 1e-3
"""Share of the diagonal of the mesh's box by which a landmark may be off its surface."""
POLYGON, SPHERE = "polygon:", "sphere:"
"""Words before the file of a region."""
TABLES = (".csv", ".xlsx")
"""Files of landmarks."""
REGION = "write polygon:FILE.csv, or sphere:FILE.csv:NAME:12mm"


@dataclass(frozen=True)
class Picked:
    """A file of landmarks and the names of some of them, as typed: FILE.csv, FILE.csv:A or FILE.csv:A:B."""

    file: Path
    names: tuple[str, ...]


def picked(text: str) -> Picked | None:
    """The file that a text names, and names of landmarks; None where it names no table, InputError for none there."""
    parts = text.split(":")
    for count in range(len(parts), 0, -1):  # a file name may hold a colon
        file = named_file(":".join(parts[:count]))
        if file is not None:
            return Picked(file, tuple(parts[count:])) if file.suffix.lower() in TABLES else None
    for count in range(1, len(parts) + 1):
        name = ":".join(parts[:count])
        if name.lower().endswith(TABLES):
            raise InputError(name, "", "there is no such file", "check the folder and the spelling")
    return None


def landmarks_on(option: str, file: Path, surface: Surface, unit: str) -> Landmarks:
    """Landmarks of a file; InputError where it says another mesh or unit, a reservation where one is off the surface.

    Their points are in the frame of the mesh file: `points_of` brings them into that of the body.
    """
    found = read_landmarks(file)
    add_input(option, file, landmarks=len(found.names), **({"mesh": found.mesh} if found.mesh else {}))
    check_mesh(found, surface, unit)
    return found


def check_mesh(found: Landmarks, surface: Surface, unit: str) -> None:
    """Refuse landmarks of another mesh or unit; a reservation for those that are off the surface."""
    unit = unit if surface.file is None else surface.file.unit
    if found.unit and found.unit != unit:
        remedy = "pick them again on the page of this mesh and unit, or correct `unit`"
        raise InputError(found.path, "", f"was picked in {found.unit}, and the mesh is read in {unit}", remedy)
    if found.sha256 and surface.file is not None and found.sha256 != surface.file.sha256:
        what = f"was picked on {found.mesh or 'another mesh'} ({found.sha256[:12]}…)"
        mine = f"{surface.name} ({surface.file.sha256[:12]}…)"
        remedy = "pick them again, or take off the line mesh_sha256 where both are the same body in the same frame"
        raise InputError(found.path, "", f"{what}, not on {mine}", remedy)
    off = np.abs(surface.proximity(points_of(found, surface)).distance)
    worst = int(np.argmax(off))
    if off[worst] > OFF * float(np.linalg.norm(np.ptp(surface.vertices, axis=0))):
        reserve(f"landmark {found.names[worst]} of {found.path.name} is {1e3 * off[worst]:.3g} mm off {surface.name}")


def check_picked(found: Landmarks, surface: Surface, unit: str) -> None:
    """`check_mesh` of a file that says which mesh it was picked on; one written by hand is judged by its reader."""
    if found.sha256:
        check_mesh(found, surface, unit)


def points_of(found: Landmarks, surface: Surface) -> Float[np.ndarray, "n 3"]:
    """Landmarks in the frame of the body [m]."""
    return found.points if surface.file is None else surface.file.placed(found.points)


def region_kind(text: str) -> tuple[str, str]:
    """ "polygon:" or "sphere:" and what follows, of a region that is given by landmarks; "" and the text of another."""
    kind = next((word for word in (POLYGON, SPHERE) if text.startswith(word)), "")
    return kind, text.removeprefix(kind)


def faces_of_landmarks(option: str, text: str, surface: Surface, unit: str) -> Bool[np.ndarray, " f"]:
    """Faces inside `polygon:FILE.csv`, or within `sphere:FILE.csv:NAME:RADIUS` of a landmark."""
    kind, file = region_kind(text)
    name, radius = "", 0.0
    if kind == SPHERE:
        file, _, last = file.rpartition(":")
        file, _, name = file.rpartition(":")
        if not (file and name):
            raise InputError("", option, f"{text!r} names no file, landmark and radius", REGION)
        radius = length(last, option, unit)
        if not radius > 0.0:
            raise InputError("", option, f"the radius {last} is not positive", REGION)
    path = named_file(file)
    if path is None:
        raise InputError("", option, f"there is no file {file!r}", REGION)
    found = landmarks_on(option, path, surface, unit)
    points = points_of(found, surface)
    try:
        if name:
            found.point(name)
            chosen = faces_near(surface, points[found.names.index(name)], radius)
        else:
            chosen = faces_within(surface, points)
    except InputError:
        raise
    except ValueError as error:
        raise InputError(path, "", str(error), "pick them again") from error
    if not chosen.any():
        remedy = "pick landmarks farther apart" if not name else "give a larger radius"
        raise InputError("", option, f"{text!r} holds no face of {surface.name}", remedy)
    return chosen


def points_named(
    option: str, given: Picked, count: int, surface: Surface, unit: str
) -> list[tuple[float, float, float]]:
    """Landmarks that are named, else all of the file, in the frame of the body [m]; InputError unless `count`."""
    found = landmarks_on(option, given.file, surface, unit)
    names = given.names or found.names
    if len(names) != count:
        needed = "one landmark is needed" if count == 1 else f"{count} landmarks are needed"
        example = ":".join([given.file.name, "A", "B"][: count + 1])
        raise InputError(given.file, "", f"{needed} here, not {len(names)}", f"name them, as {option} {example}")
    points = points_of(found, surface)
    for name in names:
        found.point(name)
    rows = [points[found.names.index(name)] for name in names]
    return [(float(x), float(y), float(z)) for x, y, z in rows]
