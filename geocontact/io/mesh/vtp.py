"""VTP (VTK XML PolyData): checked by us, then read by VTK, which comes with pyvista.

Points and polygons are read; lines, single points and data arrays are passed over.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from typing import TypeVar
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io.mesh import limits
from geocontact.io.mesh.polygons import triangles
from geocontact.io.mesh.vtp_arrays import require_integers, require_values
from geocontact.io.mesh.vtp_preflight import Document, Piece, plain_document, read_document
from geocontact.io.text.text_lines import remedy

_Checked = TypeVar("_Checked")
_AGAIN = "the file is damaged, save it again"


def read_vtp(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices in the file's own unit and precision and the faces of all pieces, in the order of the file."""
    document = read_document(data, file)
    points, corners, sizes, before = [], [], [], 0
    for piece in document.pieces:
        arrays = _checked_arrays(piece, document, file)
        if not piece.points and not piece.polygons:
            continue
        found, ends, indices = _parsed(plain_document(document, piece, arrays), file)
        if (len(found), len(ends) - 1) != (piece.points, piece.polygons):
            what = "VTK read another number of points or polygons than the file holds"
            raise InputError(file, "", what, _AGAIN)
        lowest, highest = (int(indices.min()), int(indices.max())) if len(indices) else (0, 0)
        if lowest < 0 or highest >= piece.points:
            what = f"vertex index {lowest if lowest < 0 else highest} is outside 0 to {piece.points - 1}"
            raise InputError(file, "Polys connectivity", what, _AGAIN)
        points.append(found)
        corners.append(indices + before)
        sizes.append(np.diff(ends))
        before += piece.points
    vertices = np.concatenate(points)
    return vertices, triangles(np.concatenate(corners), np.concatenate(sizes), len(vertices), file)


def _checked_arrays(piece: Piece, document: Document, file: str) -> dict[str, Element]:
    """The arrays of a surface, each of which holds as many numbers as the others ask for."""
    arrays = {}
    if piece.points:
        arrays["Points"], _ = _checked(require_values, piece, "Points", None, 3 * piece.points, document, file)
    if piece.polygons:
        arrays["offsets"], ends = _checked(require_integers, piece, "Polys", "offsets", piece.polygons, document, file)
        if np.diff(ends, prepend=0).min() < 0:
            raise InputError(file, "Polys offsets", "do not ascend", _AGAIN)
        total = int(ends[-1])
        limits.require_at_most(total, 3 * limits.MAX_FACES, "polygon corners", file)
        arrays["connectivity"], _ = _checked(require_integers, piece, "Polys", "connectivity", total, document, file)
    return arrays


def _checked(
    check: Callable[[Element, int, Document], _Checked],
    piece: Piece,
    group: str,
    name: str | None,
    count: int,
    document: Document,
    file: str,
) -> tuple[Element, _Checked]:
    place = " ".join(part for part in (group, name) if part)
    element = _find(piece.element, group, name)
    if element is None:
        raise InputError(file, place, "is missing", _AGAIN)
    try:
        return element, check(element, count, document)
    except (ValueError, zlib.error) as error:
        raise InputError(file, place, f"cannot be read: {error}", remedy(error, _AGAIN)) from error


def _find(piece: Element, group: str, name: str | None) -> Element | None:
    for element in piece.iterfind(f"{group}/DataArray"):
        if name is None or element.get("Name") == name:
            return element
    return None


def _parsed(
    document: bytes, file: str
) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, " p1"], Int[np.ndarray, " k"]]:
    """Points, ends of the polygons (0 before the first) and their corners as VTK reads them."""
    try:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    except ImportError as error:
        what = f".vtp is read by VTK, which comes with pyvista and cannot be used here ({error})"
        raise InputError(file, "", what, "pip install 'geocontact[view]', or convert it to .stl or .ply") from error
    reader, complaints = vtkXMLPolyDataReader(), []
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append("error"))
    reader.ReadFromInputStringOn()
    reader.SetInputString(document)  # type: ignore[call-overload]  # a std::string, which takes bytes
    reader.Update()
    surface = reader.GetOutput()
    if complaints or surface.GetPoints() is None:
        raise InputError(file, "", "VTK cannot read its numbers", _AGAIN)
    points = vtk_to_numpy(surface.GetPoints().GetData())
    polygons = surface.GetPolys()
    ends, corners = (vtk_to_numpy(a) for a in (polygons.GetOffsetsArray(), polygons.GetConnectivityArray()))
    kind = np.float32 if points.dtype == np.float32 else np.float64
    return points.astype(kind), ends.astype(np.int64), corners.astype(np.int64)
