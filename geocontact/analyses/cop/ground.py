"""The ground as the option names it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.analyses.bodies import warn_of_inner_surfaces
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.ground_words import LEVEL, plane_or_stairs
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from geocontact.loads.ground import Ground, Sheet

SIZES = (50e-3, 100.0)  # m; diagonals of a ground's mesh that are plausible, from a plate to a walkway


def ground_of(record: Record, o: CopOptions) -> Ground:
    """The plane, stairs or mesh that the option names."""
    text = LEVEL if o.ground is None else o.ground
    written = plane_or_stairs(text)
    if written is not None:
        if o.unit is not None:
            raise InputError("", "`unit`", "has no effect here: only a mesh needs a unit", "leave it out")
        return written
    path = Path(text)
    if not path.suffix:
        what = f"{text!r} is neither a file nor of a known form"
        raise InputError("", "`ground`", what, "write plane:nx,ny,nz,offset, stairs:h0,x1:h1, or name a mesh")
    if o.unit is None:
        raise InputError("", "`unit`", "is missing: mesh files carry no unit", "pass `unit` mm, cm, m or in")
    return _mesh(record, path, o.unit)


def _mesh(record: Record, path: Path, unit: str) -> Ground:
    mesh = read_mesh(path, unit, plausible=SIZES)
    surface = Surface.of(mesh)
    record.add_input(
        "ground", path, sha256=mesh.sha256, unit=unit, faces=len(mesh.faces), closed=surface.topology.closed
    )
    warn_of_inner_surfaces(record, surface)
    if surface.inside_out:
        record.warn(f"{surface.name}: faces point inwards; taken the other way round")
    if surface.closed:
        return surface
    up = np.einsum("f,fi->i", surface.face_area, surface.face_normal)
    up /= max(float(np.linalg.norm(up)), 1e-30)
    record.warn(
        f"{surface.name} is open ({surface.topology.why_open}): taken as a sheet, above is where its faces look, "
        f"on the whole ({up[0]:.2f}, {up[1]:.2f}, {up[2]:.2f})"
    )
    return Sheet(surface)
