"""What a shape is fitted to: a surface, the faces of it that count, and the axis that flexion is about."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses import quantities
from geocontact.analyses.bodies import chosen_faces, read_surface
from geocontact.analyses.run_record import Record
from geocontact.analyses.shape.options import NEEDS, ShapeOptions
from geocontact.analyses.shape.patch import Patch
from geocontact.analyses.sides import medial_side, refuse_other_axes
from geocontact.data.errors import InputError
from geocontact.geometry.patch_names import Values, about, about_flexion, about_other
from geocontact.geometry.sagittal import Sagittal
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import Axis
from geocontact.io.text.units import LENGTH
from geocontact.view.surfaces.vtp_series import require_pyvista


@dataclass(frozen=True, eq=False)
class ShapeInputs:
    """A patch, and the axis as given."""

    patch: Patch
    axis: Axis | None


def read(o: ShapeOptions, record: Record) -> ShapeInputs:
    """Everything the options name."""
    if o.paraview:
        require_pyvista()
    with record.listener.preparing():
        surface = read_surface(record, "mesh", o.mesh, o.unit, o.place)
        if surface.inside_out:
            record.warn(f"{surface.name}: faces point inwards; taken the other way round")
        axis = _axis(record, o)
        faces = chosen_faces(record, "`region`", o.region, surface, o.unit, _names(record, surface, axis, o))
    counted = np.ones(len(surface.faces), bool) if faces is None else faces
    if o.split is None:
        return ShapeInputs(Patch(surface, counted, o.points == "vertices", None, 0), axis)
    plane, side = quantities.splitting_plane(o.split, o.unit), medial_side(o.split, o.side, o.medial)
    refuse_other_axes(surface.space, surface.name, o.side, o.medial)
    record.say(f"medial is {side.words} of {surface.name}")
    return ShapeInputs(Patch(surface, counted, o.points == "vertices", plane, side.sign), axis)


def sagittal_about(axis: Axis, o: ShapeOptions) -> Sagittal:
    """Flexion angles about an axis, by the directions given."""
    if o.sagittal is None:
        remedy = "say where 0 and 90 degrees are, for example `sagittal`=-y,x"
        raise InputError("", "`sagittal`", "is missing: which way the mesh's axes point is not known", remedy)
    try:
        return Sagittal(axis, *quantities.directions(o.sagittal, "`sagittal`"))
    except ValueError as error:
        raise InputError("", "`sagittal`", str(error), "name two directions across the axis") from error


def _axis(record: Record, o: ShapeOptions) -> Axis | None:
    if o.axis is None:
        return None
    _note(record, "`axis`", o.axis)
    return quantities.axis(o.axis, o.unit)


def _names(record: Record, surface: Surface, axis: Axis | None, o: ShapeOptions) -> Mapping[str, Values]:
    """Names beside places and normals that a region may use; those that lack an option say which."""
    found: dict[str, Values] = {name: _missing(name, option) for name, option in NEEDS.items()}
    if axis is not None:
        found |= about(surface, axis.point, axis.direction, LENGTH[o.unit])
        if o.sagittal is not None:
            found |= about_flexion(surface, sagittal_about(axis, o))
    if o.centre is not None:
        _note(record, "`centre`", o.centre)
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
    if file is not None:
        record.add_input(option, file)
