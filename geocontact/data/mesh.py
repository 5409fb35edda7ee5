"""A triangle mesh as it comes from a file: vertices in metres, faces, source, and vertices at the same place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int


def first_of_coincident(vertices: Float[np.ndarray, "n 3"]) -> Int[np.ndarray, " n"]:
    """For each vertex the lowest index of a vertex that equals it to the last bit; -0 equals 0. Must be finite."""
    values = vertices + vertices.dtype.type(0)  # -0 + 0 is +0
    order = np.lexsort(values.T)
    opens = np.zeros(len(order), dtype=bool)  # whether a vertex differs from the one before it in that order
    opens[:1] = True
    for column in values.T:
        ranked = column[order]
        opens[1:] |= ranked[1:] != ranked[:-1]
    first = order[opens]  # the sort is stable: the first of equals has the smallest index
    representative = np.empty(len(order), dtype=np.int64)
    representative[order] = first[np.cumsum(opens) - 1]
    return representative


def repeated_faces(faces: Int[np.ndarray, "m 3"]) -> Bool[np.ndarray, " m"]:
    """Which faces have the same three vertices, in any order, as a face before them."""
    corners = faces.astype(np.int32)
    corners.sort(axis=1)
    order = np.lexsort(corners.T)
    same = np.ones(max(len(faces) - 1, 0), dtype=bool)
    for column in corners.T:
        ranked = column[order]
        same &= ranked[1:] == ranked[:-1]
    again = np.zeros(len(faces), dtype=bool)
    again[order[1:]] = same
    return again


AXES = {"LPS": "x to the left, y to the back, z up", "RAS": "x to the right, y to the front, z up"}
"""Anatomical axes of scans, of a patient who stands: LPS as in DICOM, RAS as in 3D Slicer."""


@dataclass(frozen=True, eq=False)
class MeshFile:
    """The file that a surface was read from, and how its points [m] were placed in the frame of the body.

    Parameters
    ----------
    sha256, unit
        Hash of the file's bytes, and the unit of length that its numbers were read in.
    placement
        4 x 4 matrix from the file's frame to the body's, both in m; None where they are the same.
    """

    sha256: str
    unit: str
    placement: Float[np.ndarray, "4 4"] | None = None

    def placed(self, points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
        """Points of the file's frame [m] in the body's frame [m]."""
        if self.placement is None:
            return points
        return np.asarray(points @ self.placement[:3, :3].T + self.placement[:3, 3])


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
    placement
        4 x 4 matrix [m] that placed it there; None for a mesh in the frame of its file.
    """

    vertices: Float[np.ndarray, "n 3"]
    faces: Int[np.ndarray, "m 3"]
    name: str = "surface"
    unit: str = "m"
    sha256: str = ""
    space: str = ""
    placement: Float[np.ndarray, "4 4"] | None = None

    @property
    def file(self) -> MeshFile | None:
        """The file that it was read from; None where it does not come from one."""
        return MeshFile(self.sha256, self.unit, self.placement) if self.sha256 else None

    def __repr__(self) -> str:
        return f"<Mesh {self.name}, {mesh_words(self.vertices, self.faces)}>"


def mesh_words(vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> str:
    """How many points [m] and faces, and the bounding box of the points in millimetres: one line."""
    box = " x ".join(f"{1e3 * side:.3g}" for side in np.ptp(vertices, axis=0)) if len(vertices) else "no"
    return f"{len(vertices)} points, {len(faces)} faces, {box} mm"
