"""A triangle mesh as it comes from a file: vertices in metres, faces, and where it came from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

AXES = {"LPS": "x to the left, y to the back, z up", "RAS": "x to the right, y to the front, z up"}
"""Anatomical axes of scans, of a patient who stands: LPS as in DICOM, RAS as in 3D Slicer."""


@dataclass(frozen=True)
class Mesh:
    """Indexed triangle mesh.

    Parameters
    ----------
    vertices
        Vertex positions in the mesh's own frame [m]; coincident vertices merged.
    faces
        Vertex indices of each triangle, counter-clockwise seen from outside.
    name
        Short name for messages and pictures; the file name when read from a file.
    unit
        Unit the file was declared to be in ("mm"); vertices are in metres whatever it says.
    sha256
        Hash of the file's bytes, empty when the mesh does not come from a file.
    space
        Anatomical axes that the file says it is in, a key of `AXES`; empty where it says nothing, and once the mesh is
        placed in the frame of its body.
    """

    vertices: Float[np.ndarray, "n 3"]
    faces: Int[np.ndarray, "m 3"]
    name: str = "surface"
    unit: str = "m"
    sha256: str = ""
    space: str = ""
