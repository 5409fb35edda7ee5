"""VTP (VTK XML PolyData): points and polygons; lines, single points and data arrays are passed over."""

from __future__ import annotations

import zlib
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io import limits
from geocontact.io.polygons import triangles
from geocontact.io.vtp_arrays import array_values
from geocontact.io.vtp_preflight import Document, Piece, read_document


def read_vtp(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices in the file's own unit and precision and the faces of all pieces, in the order of the file."""
    document = read_document(data, file)
    points, corners, sizes, before = [], [], [], 0
    for piece in document.pieces:
        points.append(_points(piece, document, file))
        ends = _array(piece, "Polys", "offsets", piece.polygons, document, file).astype(np.int64)
        lengths = np.diff(ends, prepend=0)
        total = int(ends[-1]) if len(ends) else 0
        if len(lengths) and lengths.min() < 0:
            raise InputError(file, "Polys offsets", "do not ascend", "the file is damaged, save it again")
        limits.require_at_most(total, 3 * limits.MAX_FACES, "polygon corners", file)
        found = _array(piece, "Polys", "connectivity", total, document, file).astype(np.int64, copy=False)
        if len(found) and (found.min() < 0 or found.max() >= piece.points):
            what = f"vertex index {found.min() if found.min() < 0 else found.max()} is outside 0 to {piece.points - 1}"
            raise InputError(file, "Polys connectivity", what, "the file is damaged, save it again")
        corners.append(found + before if before else found)
        sizes.append(lengths)
        before += piece.points
    vertices = _joined(points)
    return vertices, triangles(_joined(corners), _joined(sizes), len(vertices), file)


def _joined(parts: list[np.ndarray]) -> np.ndarray:
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _points(piece: Piece, document: Document, file: str) -> Float[np.ndarray, "n 3"]:
    values = _array(piece, "Points", None, 3 * piece.points, document, file)
    kind = np.float32 if values.dtype.itemsize <= 4 and values.dtype.kind == "f" else np.float64
    return values.astype(kind, copy=False).reshape(-1, 3)


def _array(piece: Piece, group: str, name: str | None, count: int, document: Document, file: str) -> np.ndarray:
    place = " ".join(part for part in (group, name) if part)
    element = _find(piece.element, group, name)
    if element is None:
        if count == 0:
            return np.empty(0, np.int64)
        raise InputError(file, place, "is missing", "the file is damaged, save it again")
    try:
        return array_values(element, count, document)
    except (ValueError, zlib.error) as error:
        raise InputError(file, place, f"cannot be read: {error}", "the file is damaged, save it again") from error


def _find(piece: Element, group: str, name: str | None) -> Element | None:
    for element in piece.iterfind(f"{group}/DataArray"):
        if name is None or element.get("Name") == name:
            return element
    return None
