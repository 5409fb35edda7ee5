"""The part of a surface that a shape is fitted to, as the command line names it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses import quantities
from geocontact.analyses.bodies import chosen_faces, read_surface
from geocontact.analyses.run_record import Record
from geocontact.cli.fit import FitOptions
from geocontact.data.errors import InputError
from geocontact.geometry.patch_names import Values, about, about_flexion, about_other
from geocontact.geometry.plane import Plane
from geocontact.geometry.sagittal import Sagittal
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import Axis
from geocontact.io.text.units import LENGTH

NEEDS = {
    "radial": "--axis or --centre",
    "outward": "--axis or --centre",
    "flexion": "--axis and --sagittal",
    "distance": "--other",
}


@dataclass(frozen=True, eq=False)
class Patch:
    """A surface and the faces of it that count, with the two sides of it where it is split."""

    surface: Surface
    faces: Bool[np.ndarray, " m"]
    at_vertices: bool
    split: Plane | None
    medial: int

    @property
    def points(self) -> Float[np.ndarray, "n 3"]:
        """What the shape is fitted to [m]."""
        if self.at_vertices:
            return np.asarray(self.surface.vertices[self.vertices])
        return np.asarray(self.surface.vertices[self.surface.faces[self.faces]].mean(axis=1))

    @property
    def vertices(self) -> Bool[np.ndarray, " n"]:
        """Vertices of the faces that count."""
        used = np.zeros(len(self.surface.vertices), bool)
        used[self.surface.faces[self.faces]] = True
        return used

    @property
    def sides(self) -> Mapping[str, tuple[Plane, int]]:
        """Plane and side of it by name; empty without a split."""
        if self.split is None:
            return {}
        return {"medial": (self.split, self.medial), "lateral": (self.split, -self.medial)}


def patch_given(record: Record, mesh: Path, o: FitOptions) -> Patch:
    """Read the surfaces and choose the faces."""
    surface = read_surface(record, "mesh", mesh, o.unit, o.place)
    if surface.inside_out:
        record.warn(f"{surface.name}: faces point inwards; taken the other way round")
    faces = chosen_faces(record, "--region", o.region, surface, o.unit, _names(record, surface, o))
    split = None if o.split is None else quantities.splitting_plane(o.split, o.unit)
    counted = np.ones(len(surface.faces), bool) if faces is None else faces
    return Patch(surface, counted, o.points == "vertices", split, 1 if o.medial == "+" else -1)


def axis_given(record: Record, o: FitOptions) -> Axis | None:
    """The axis of --axis; a file is noted."""
    if o.axis is None:
        return None
    _note(record, "--axis", o.axis)
    return quantities.axis(o.axis, o.unit)


def sagittal_about(axis: Axis, o: FitOptions) -> Sagittal:
    """Flexion angles about an axis, by the directions of --sagittal."""
    if o.sagittal is None:
        remedy = "say where 0 and 90 degrees are, for example --sagittal=-y,x"
        raise InputError("", "--sagittal", "is missing: which way the mesh's axes point is not known", remedy)
    try:
        return Sagittal(axis, *quantities.directions(o.sagittal, "--sagittal"))
    except ValueError as error:
        raise InputError("", "--sagittal", str(error), "name two directions across the axis") from error


def _names(record: Record, surface: Surface, o: FitOptions) -> Mapping[str, Values]:
    """Names beside places and normals that --region may use; those that lack an option say which."""
    found: dict[str, Values] = {name: _missing(name, option) for name, option in NEEDS.items()}
    axis = axis_given(record, o)
    if axis is not None:
        found |= about(surface, axis.point, axis.direction, LENGTH[o.unit])
        if o.sagittal is not None:
            found |= about_flexion(surface, sagittal_about(axis, o))
    if o.centre is not None:
        _note(record, "--centre", o.centre)
        found |= about(surface, quantities.centre(o.centre, o.unit), None, LENGTH[o.unit])
    if o.other is not None:
        other = read_surface(record, "other", o.other, o.unit, o.place_other)
        found |= about_other(surface, other, LENGTH[o.unit])
        if not other.closed and o.region is not None and "distance" in o.region:
            record.warn(f"{other.name} is open ({other.topology.why_open}): distance to it has no sign")
    return found


def _missing(name: str, option: str) -> Values:
    def refuse() -> Float[np.ndarray, " m"]:
        raise ValueError(f"{name} needs {option}")

    return refuse


def _note(record: Record, option: str, text: str) -> None:
    file = quantities.named_file(text)
    if file is not None and all(entry["role"] != option for entry in record.inputs):
        record.add_input(option, file)
