"""PLY, ASCII and binary of both byte orders: checked and made plain, then read by trimesh.

trimesh 5.2 refuses binary files that mix triangles and quads, appends the halves of such quads to ASCII ones, splits
vertices at texture seams, and takes edges for a path. It is given the vertices and triangles alone, under a header of
our own; the rows of a binary file of triangles are handed over as they are.
"""

from __future__ import annotations

from io import BytesIO

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io.mesh.ply_ascii import plain_ascii
from geocontact.io.mesh.ply_binary import plain_binary
from geocontact.io.mesh.ply_preflight import Element, Property, read_header
from geocontact.io.mesh.polygons import triangles

INDEX_LISTS = ("vertex_indices", "vertex_index")
"""Names under which writers store the corners of a face."""


def read_ply(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices of a PLY file in its own unit and precision, and its faces; other elements are skipped."""
    from trimesh.exchange.ply import load_ply  # half a second

    header = read_header(data, file)
    elements = {element.name: element for element in header.elements}
    coordinates = [_property(elements["vertex"], (name,), False, file) for name in "xyz"]
    corner_list = _property(elements["face"], INDEX_LISTS, True, file)
    if corner_list.dtype.kind == "f":
        raise InputError(file, "element face", "has vertex indices that are no integers", "export it again")
    plain = (plain_binary if header.byte_order else plain_ascii)(data, header, corner_list.name, file)
    with np.errstate(over="ignore"):  # a number too large for the declared type becomes infinite, and is refused later
        mesh = load_ply(BytesIO(plain), skip_materials=True, fix_texture=False)
    kind = np.float32 if all(p.dtype.str[1:] == "f4" for p in coordinates) else np.float64
    vertices, corners = np.asarray(mesh["vertices"]), np.asarray(mesh["faces"])
    if len(vertices) != elements["vertex"].rows or len(corners) < elements["face"].rows:
        raise InputError(file, "", "trimesh read fewer vertices or faces than the file holds", "export it again")
    sizes = np.full(len(corners), 3)
    faces = triangles(corners.reshape(-1).astype(np.int64), sizes, len(vertices), file)
    return vertices.astype(kind), faces


def _property(element: Element, names: tuple[str, ...], is_list: bool, file: str) -> Property:
    for candidate in element.properties:
        if candidate.name in names and (candidate.length is not None) == is_list:
            return candidate
    kind = "list " if is_list else ""
    what = f"has no {kind}property {' or '.join(names)}"
    raise InputError(file, f"element {element.name}", what, "export it again as a triangle surface")
