"""PLY, ASCII and binary of both byte orders: vertices and polygons.

trimesh 5.2 refuses binary files that mix triangles and quads and believes the corner count of the first face for all.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.io.ply_ascii import read_ascii
from geocontact.io.ply_binary import read_binary
from geocontact.io.ply_preflight import Element, Property, read_header
from geocontact.io.polygons import triangles

INDEX_LISTS = ("vertex_indices", "vertex_index")
"""Names under which writers store the corners of a face."""


def read_ply(data: bytes, file: str) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    """Vertices of a PLY file in its own unit and precision, and its faces; other elements are skipped."""
    header = read_header(data, file)
    elements = {element.name: element for element in header.elements}
    for name in "xyz":
        _property(elements["vertex"], (name,), False, file)
    corner_list = _property(elements["face"], INDEX_LISTS, True, file)
    if corner_list.dtype.kind == "f":
        raise InputError(file, "element face", "has vertex indices that are no integers", "export it again")
    read = read_binary if header.byte_order else read_ascii
    vertices, corners, sizes = read(data, header, corner_list.name, file)
    return vertices, triangles(corners, sizes, len(vertices), file)


def _property(element: Element, names: tuple[str, ...], is_list: bool, file: str) -> Property:
    for candidate in element.properties:
        if candidate.name in names and (candidate.length is not None) == is_list:
            return candidate
    kind = "list " if is_list else ""
    what = f"has no {kind}property {' or '.join(names)}"
    raise InputError(file, f"element {element.name}", what, "export it again as a triangle surface")
