"""A triangle surface with its tree: built once, queried many times; normals of its edges and corners, and its rim."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int, Int32

from geocontact.data.mesh import Mesh, MeshFile, mesh_words, repeated_faces
from geocontact.geometry.inside_outside import doubtful_faces, normals_agree, resolve_inside_outside
from geocontact.geometry.shapes import Proximity
from geocontact.geometry.topology import Topology, neighbours, signed_volume, topology

if TYPE_CHECKING:
    import igl

    from geocontact.geometry.kernels.binary import Binary
    from geocontact.geometry.kernels.tree import BoxTree

EDGES = ((0, 1), (0, 2), (1, 2))
"""Corners of the record that each edge joins, in the order of `closest_point`."""
BLOCK = 1 << 18
"""Faces that are taken together: what is needed of them meanwhile stays small."""


def pseudonormals(
    records: Float[np.ndarray, "m 16"], faces: Int[np.ndarray, "m 3"], merged: Int[np.ndarray, " n"]
) -> tuple[Float[np.ndarray, "k 3"], Int32[np.ndarray, "m 6"]]:
    """Unit normals, and which of them the three edges and three corners of each face have (order of `closest_point`).

    Edges take the sum of their two faces' normals, corners the sum weighted by the faces' angles. Features that touch
    a face without area get no normal (zero): a side read from them would depend on rounding. The last one is zero.
    """
    shift = records[:, 15].astype(np.int64)
    turned = merged[np.take_along_axis(faces, (shift[:, None] + np.arange(3)) % 3, axis=1)]  # A, B, C of the record
    flat = records[:, 14] == 0.0
    unit = np.where(flat[:, None], 0.0, records[:, 3:6])
    row = np.empty((len(faces), 6), np.int32)
    of_edges, row[:, :3] = _edge_normals(turned, unit, flat)
    of_corners = _corner_normals(turned, records, unit, flat, len(merged))
    row[:, 3:] = len(of_edges) + turned
    normals = np.concatenate([of_edges, of_corners, np.zeros((1, 3))])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, length, out=np.zeros_like(normals), where=length > 1e-12), row


def _edge_normals(
    turned: Int[np.ndarray, "m 3"], unit: Float[np.ndarray, "m 3"], flat: np.ndarray
) -> tuple[Float[np.ndarray, "q 3"], Int[np.ndarray, "m 3"]]:
    """Sum of the normals at each edge, and the edges of each face."""
    most = np.int64(turned.max()) + 1
    ends = [(turned[:, start], turned[:, end]) for start, end in EDGES]
    keys = np.concatenate([np.minimum(a, b) * most + np.maximum(a, b) for a, b in ends])
    edge = np.unique(keys, return_inverse=True)[1].reshape(3, -1)
    total = np.zeros((edge.max() + 1, 3))
    doubtful = np.zeros(len(total), bool)
    for each in edge:
        np.add.at(total, each, unit)
        doubtful[each[flat]] = True
    total[doubtful] = 0.0
    return total, edge.T


def _corner_normals(
    turned: Int[np.ndarray, "m 3"],
    records: Float[np.ndarray, "m 16"],
    unit: Float[np.ndarray, "m 3"],
    flat: np.ndarray,
    count: int,
) -> Float[np.ndarray, "n 3"]:
    """Sum of the normals at each vertex, weighted by the faces' angles there."""
    total = np.zeros((count, 3))
    for start in range(0, len(turned), BLOCK):
        here = slice(start, start + BLOCK)
        length, cx, cy = records[here, 12], records[here, 13], records[here, 14]
        at_a, at_b = np.arctan2(cy, cx), np.arctan2(cy, length - cx)
        angle = np.stack([at_a, at_b, np.pi - at_a - at_b], axis=1)
        np.add.at(total, turned[here].ravel(), (angle[:, :, None] * unit[here, None, :]).reshape(-1, 3))
    total[turned[flat].ravel()] = 0.0
    return total


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangle surface in its own frame; float64 throughout, held about its centre so that far offsets cost nothing.

    Parameters
    ----------
    vertices
        Vertex positions [m].
    faces
        Corner indices, counter-clockwise seen from outside. Degenerate faces count as the segment or point they are.
    name
        For messages and pictures.
    assume_closed
        Trust the caller that the surface bounds a body although its edges do not show it: sides then come from the
        winding number, and points where it is undecided are reported.
    space
        Anatomical axes that its file says it is in, as in `Mesh`.
    file
        The file that it was read from, and its placement; None where it was made or moved since.

    Examples
    --------
    >>> import geocontact as gc, numpy as np
    >>> corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    >>> body = gc.Surface(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    >>> body.closed, float(body.face_area.sum().round(3))
    (True, 2.366)
    """

    vertices: Float[np.ndarray, "n 3"]
    faces: Int[np.ndarray, "m 3"]
    name: str = "surface"
    assume_closed: bool = False
    space: str = ""
    file: MeshFile | None = None

    def __post_init__(self) -> None:
        if len(self.faces) == 0:
            raise ValueError(f"{self.name}: a surface needs at least one face")
        if not np.isfinite(self.vertices).all():
            raise ValueError(f"{self.name}: vertices must be finite")
        if self.faces.min() < 0 or self.faces.max() >= len(self.vertices):
            raise ValueError(f"{self.name}: a face names a vertex that is not there")

    def __repr__(self) -> str:
        """Name, size of the box, points and faces, whether it is closed: one line."""
        return f"<Surface {self.name}, {mesh_words(self.vertices, self.faces)}, {'closed' if self.closed else 'open'}>"

    @classmethod
    def of(cls, mesh: Mesh, assume_closed: bool = False) -> Surface:
        """Surface of a mesh as read from a file."""
        return cls(mesh.vertices, mesh.faces, mesh.name, assume_closed, mesh.space, mesh.file)

    @cached_property
    def topology(self) -> Topology:
        """Shared, open and irregular edges."""
        return topology(self.vertices, self.faces)

    @cached_property
    def closed(self) -> bool:
        """Whether inside and outside exist, by the edges or by the caller's word."""
        return self.topology.closed or self.assume_closed

    @cached_property
    def inside_out(self) -> bool:
        """Whether the faces of a surface that is closed, or would be without doubled faces, point inwards.

        Sides and normals are turned over then.
        """
        return (self.closed or self.topology.closed_once) and signed_volume(self.vertices, self.enclosing) < 0.0

    @property
    def enclosing(self) -> Int[np.ndarray, "k 3"]:
        """Faces that say what is inside: all, but doubled ones once where these alone keep the surface open."""
        return self.faces if self.topology.closed or not self.topology.closed_once else self.faces[~self.repeated]

    @cached_property
    def centre(self) -> Float[np.ndarray, " 3"]:
        """Middle of the bounding box of the faces [m]; the tree is held about it."""
        used = self.vertices[self.faces.ravel()]
        return np.asarray(0.5 * (used.min(axis=0) + used.max(axis=0)))

    @cached_property
    def local(self) -> Float[np.ndarray, "n 3"]:
        """Vertices about the centre [m]."""
        return np.asarray(self.vertices - self.centre)

    @property
    def corners(self) -> Float[np.ndarray, "m 3 3"]:
        """Corner positions of each face about the centre [m]; not kept, as they are more than all the rest."""
        return np.asarray(self.local[self.faces])

    def corners_of(self, face: Int[np.ndarray, " k"]) -> Float[np.ndarray, "k 3 3"]:
        """Those of some faces."""
        return np.asarray(self.local[self.faces[face]])

    @cached_property
    def face_area(self) -> Float[np.ndarray, " m"]:
        """Area of each face [m^2]."""
        c = self.corners
        return np.asarray(0.5 * np.linalg.norm(np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]), axis=1))

    @cached_property
    def repeated(self) -> Bool[np.ndarray, " m"]:
        """Faces with the same three corners as an earlier one: the same piece of surface, which counts once."""
        return repeated_faces(self.topology.merged[self.faces])

    @cached_property
    def face_normal(self) -> Float[np.ndarray, "m 3"]:
        """Unit normal of each face, zero where it has no area."""
        from geocontact.geometry.kernels.triangle import triangle_frames  # late: numba, for jobs without a surface

        records = triangle_frames(self.local, self.faces)
        return np.where(records[:, 14:15] > 0.0, records[:, 3:6], 0.0) * (-1.0 if self.inside_out else 1.0)

    @cached_property
    def edge_length(self) -> Float[np.ndarray, "m 3"]:
        """Length of the edge opposite to each corner [m]."""
        a, b, c = (self.local[corner] for corner in self.faces.T)
        return np.stack([np.linalg.norm(one - other, axis=1) for one, other in ((b, c), (c, a), (a, b))], axis=1)

    @cached_property
    def reach(self) -> Float[np.ndarray, " n"]:
        """Longest edge at each vertex [m]: how far its faces extend from it."""
        reach = np.zeros(len(self.vertices))
        for corner in range(3):
            for edge in ((corner + 1) % 3, (corner + 2) % 3):
                np.maximum.at(reach, self.faces[:, corner], self.edge_length[:, edge])
        return reach

    @cached_property
    def used(self) -> Bool[np.ndarray, " n"]:
        """Vertices that belong to a face."""
        used = np.zeros(len(self.vertices), bool)
        used[self.faces.ravel()] = True
        return used

    @cached_property
    def tree(self) -> BoxTree:
        """The bounded tree over the faces, about the centre."""
        from geocontact.geometry.kernels.binary import build
        from geocontact.geometry.kernels.tree import BoxTree
        from geocontact.geometry.kernels.triangle import LEAF
        from geocontact.geometry.kernels.wide import ROWS

        binary = build(*_boxes(self.corners))
        order = binary.order
        normals, row, boxes, child, leaves, slots, fill = self._laid_out(binary)
        if self.topology.closed:
            doubtful = doubtful_faces(self, binary)[order]
            row[doubtful] = len(normals) - 1
            leaves.reshape(-1, ROWS, LEAF)[:, ROWS - 1][doubtful[slots].reshape(-1, LEAF)] = 0.0
        return BoxTree(binary.root, boxes, child, leaves, slots, fill, order, normals.ravel(), row.ravel())

    def _laid_out(self, binary: Binary) -> tuple[np.ndarray, ...]:
        """Normals and their rows, boxes, children, leaves, slots and fill, where no face is in doubt."""
        from geocontact.geometry.kernels.triangle import triangle_frames
        from geocontact.geometry.kernels.wide import widen

        faces = np.ascontiguousarray(self.faces[binary.order])
        records = triangle_frames(self.local, faces)
        normals, row = pseudonormals(records, faces, self.topology.merged)
        outside = -1.0 if self.inside_out else 1.0
        return outside * normals, row, *widen(binary, records, np.where(records[:, 14] > 0.0, outside, 0.0))

    @cached_property
    def walk(self) -> Int[np.ndarray, " n"]:
        """All vertices that belong to a face, neighbours close together in the list."""
        along = self.faces[self.tree.face].ravel()
        _, first = np.unique(along, return_index=True)
        return np.asarray(along[np.sort(first)])

    @cached_property
    def normals_trusted(self) -> bool:
        """Whether sides may be read from normals; otherwise winding numbers decide, which is slower."""
        trusted = self.topology.closed and normals_agree(self)
        if trusted:
            vars(self).pop("winding", None)  # as large as the tree, and hardly asked again
        return trusted

    @cached_property
    def winding(self) -> igl.FastWindingNumberBVH:
        """libigl's fast winding number about the centre (Barill et al., ACM TOG 37(4), 2018)."""
        import igl

        bvh = igl.FastWindingNumberBVH()
        bvh.init(self.local, self.enclosing.astype(np.int64))
        return bvh

    def proximity(self, points: Float[np.ndarray, "n 3"], limit: float = np.inf) -> Proximity:
        """Nearest point of the surface to each point, signed where the surface is closed.

        Points farther than `limit` [m] get an infinite distance (negative deep inside), which is many times faster
        than finding out how far they are. NaN among the points is refused.
        """
        from geocontact.geometry.kernels.batch import chunk_spheres, signed_distances

        points = np.ascontiguousarray(points, float)
        if not np.isfinite(points).all():
            raise ValueError("query points must be finite")
        local = points - self.centre
        limits = np.full(len(points), float(limit))
        spheres = chunk_spheres(local, limits)
        distance, side, slot, closest = signed_distances(self.tree, local, limits, spheres, self.closed)
        side, _ = resolve_inside_outside(self, local, side, distance)
        found = slot >= 0
        signed = np.where(found, distance, np.inf) * side
        face = np.where(found, self.tree.face[slot], -1)
        normal = _outward(local - closest, signed, self.face_normal[face])
        normal[~found] = np.nan
        return Proximity(signed, closest + self.centre, normal, face, self.closed)


def _boxes(corners: Float[np.ndarray, "m 3 3"]) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]]:
    """Lower and upper corner of the box of each face."""
    return corners.min(axis=1), corners.max(axis=1)


def _outward(
    offset: Float[np.ndarray, "n 3"], signed: Float[np.ndarray, " n"], spare: Float[np.ndarray, "n 3"]
) -> Float[np.ndarray, "n 3"]:
    """Gradient of the distance; the face normal where the point lies on the surface."""
    with np.errstate(invalid="ignore", divide="ignore"):
        gradient = offset / signed[:, None]
    on_it = np.abs(signed) < 1e-12
    gradient[on_it] = spare[on_it]
    return np.asarray(gradient)


NEAR = 1e-9  # of a face's longest edge: a point so near to an edge lies on it


def on_boundary(
    surface: Surface, points: Float[np.ndarray, "n 3"], face: Int[np.ndarray, " n"]
) -> Bool[np.ndarray, " n"]:
    """Which points [m] of the surface, each on its face, lie on an edge or a corner where the surface ends."""
    faces = surface.topology.merged[surface.faces]
    ends = neighbours(faces) < 0
    corner = np.zeros(len(surface.vertices), bool)
    corner[faces[ends]] = True
    corner[np.roll(faces, -1, axis=1)[ends]] = True
    near = NEAR * surface.edge_length[face].max(axis=1)
    found = np.zeros(len(points), bool)
    for k in range(3):
        a, b = (surface.vertices[surface.faces[face, m % 3]] for m in (k, k + 1))
        along = b - a
        share = np.einsum("ij,ij->i", points - a, along) / np.maximum(np.einsum("ij,ij->i", along, along), 1e-300)
        foot = a + np.clip(share, 0.0, 1.0)[:, None] * along
        found |= ends[face, k] & (np.linalg.norm(points - foot, axis=1) <= near)
        found |= corner[faces[face, k]] & (np.linalg.norm(points - a, axis=1) <= near)
    return found
