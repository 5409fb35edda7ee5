"""Surface meshes: STL, PLY, OBJ, OFF, VTP and STEP to vertices in metres and faces."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from os import PathLike, fspath
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.data.mesh import Mesh
from geocontact.data.plausible import MERGED
from geocontact.io.mesh.merging import merge_close, merge_coincident
from geocontact.io.mesh.mesh_checks import (
    SIZES,
    check_faces,
    metres_per,
    require_finite,
    require_plausible,
)
from geocontact.io.mesh.obj import read_obj
from geocontact.io.mesh.off import read_off
from geocontact.io.mesh.ply import read_ply
from geocontact.io.mesh.step import read_step, require_unit_of_step
from geocontact.io.mesh.stl import read_stl, space_of_stl
from geocontact.io.mesh.vtp import read_vtp
from geocontact.io.text.file_preflight import read_bytes

_Reader = Callable[[bytes, str], tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]]
READERS: dict[str, _Reader] = {
    ".stl": read_stl,
    ".ply": read_ply,
    ".obj": read_obj,
    ".off": read_off,
    ".vtp": read_vtp,
    ".step": read_step,
    ".stp": read_step,
}
"""Reader of each file name extension; no other file is opened."""
TABLES = (".csv", ".txt", ".xyz")


def read_mesh(
    path: str | PathLike[str],
    unit: str,
    *,
    plausible: tuple[float, float] = SIZES,
    merge_tolerance: float | None = None,
) -> Mesh:
    """Read a triangle surface; vertices come back in metres.

    Face i of the mesh is face i of the file (polygons become consecutive triangles, with a warning). Coincident
    vertices are merged when all bits of the file's own values agree. Degenerate and duplicate faces stay and are
    warned about (InputWarning).

    Parameters
    ----------
    path
        `.stl` (ASCII, binary), `.ply` (ASCII, binary), `.obj`, `.off` (ASCII), `.vtp`, `.step` or `.stp` (extra
        `step`, cut into triangles within 0.01 mm); the content must be what the name says.
    unit
        Unit of the file's numbers: m, cm, mm or in. Never guessed; that of a STEP file must be the one it states.
    plausible
        Smallest and largest diagonal of the bounding box [m]; outside, the unit is taken to be wrong.
    merge_tolerance
        Distance [m] within which vertices are merged into their mean (`merge_close`), with a warning; only those that
        are equal by default.

    Raises
    ------
    InputError
        The file cannot be used: not there, damaged, not finite, without faces or area, too large (`limits`),
        absurd unit.

    Examples
    --------
    >>> import geocontact as gc
    >>> mesh = gc.read_mesh("meshes/sphere_r20.stl", "mm")
    >>> mesh.vertices.shape, float(abs(mesh.vertices).max().round(4))
    ((1442, 3), 0.02)
    """
    if merge_tolerance is not None:
        MERGED.require(merge_tolerance, "`merge_tolerance`")
    name = Path(fspath(path)).name
    scale = metres_per(unit, name)
    reader = _reader_of(path)
    try:
        vertices, faces, sha256, space = _surface_in(path, reader, unit, name)
        vertices, faces = merge_coincident(vertices, faces, name)
        if merge_tolerance is not None:
            vertices, faces = merge_close(vertices, faces, merge_tolerance, scale, name)
    except MemoryError as error:
        raise InputError(name, "", "does not fit into memory", "decimate the mesh first") from error
    require_plausible(vertices, unit, plausible, name)
    metres = vertices.astype(np.float64) * scale
    check_faces(metres, faces, name)
    return Mesh(metres, faces, name, unit, sha256, space)


def _surface_in(
    path: str | PathLike[str], reader: _Reader, unit: str, name: str
) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"], str, str]:
    """Vertices as the file has them, faces, its SHA-256 and the anatomical space that it states."""
    data = read_bytes(path)
    space = space_of_stl(data) if reader is read_stl else ""
    sha256 = hashlib.sha256(data).hexdigest()
    if reader is read_step:
        require_unit_of_step(data, unit, name)
    vertices, faces = reader(data, name)
    require_finite(vertices, faces, name)
    return vertices, faces, sha256, space


def _reader_of(path: str | PathLike[str]) -> _Reader:
    """What reads a file of that ending; InputError where nothing does."""
    ending = Path(fspath(path)).suffix.lower()
    if ending in READERS:
        return READERS[ending]
    what = f"is not one of the formats that are read ({', '.join(READERS)})"
    remedy = "convert it, or correct the file name's ending"
    if ending in TABLES:
        what, remedy = "is a table, not a surface of triangles", "make triangles of its points first"
    raise InputError(fspath(path), "", what, remedy)
