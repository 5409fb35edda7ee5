"""Which faces meet at which edges: closed or not, and why not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.mesh import first_of_coincident, repeated_faces


def neighbours(faces: Int[np.ndarray, "m 3"]) -> Int[np.ndarray, "m 3"]:
    """The face across the edge from corner k to corner k + 1 of each face, -1 where the surface ends.

    It ends where an edge belongs to one face only, to more than two, or to two that are turned against each other. A
    face with two equal corners is no part of it: its neighbours meet.
    """
    proper = np.flatnonzero((faces != np.roll(faces, -1, axis=1)).all(axis=1))
    start = faces[proper].ravel()
    end = np.roll(faces[proper], -1, axis=1).ravel()
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((start > end, high, low))
    same = (low[order][1:] == low[order][:-1]) & (high[order][1:] == high[order][:-1])
    opens = np.concatenate([[True], ~same])
    run = np.cumsum(opens) - 1
    pairs = np.flatnonzero(opens)[np.bincount(run) == 2]
    first, second = order[pairs], order[pairs + 1]
    opposite = start[first] == end[second]
    first, second = first[opposite], second[opposite]
    across = np.full(faces.size, -1, np.int64)
    owner = 3 * proper[:, None] + np.arange(3)
    edge = owner.ravel()
    across[edge[first]], across[edge[second]] = edge[second] // 3, edge[first] // 3
    return across.reshape(faces.shape)


@dataclass(frozen=True)
class Topology:
    """Edge count of a surface after merging coincident vertices; faces with two equal corners are left out.

    `open_edges` belong to one face only, `irregular_edges` to more than two or to two of the same direction;
    `closed_once` says whether there are none of either where each doubled face counts once.
    """

    edges: int
    open_edges: int
    irregular_edges: int
    duplicate_faces: int
    merged: Int[np.ndarray, " n"]
    closed_once: bool

    @property
    def closed(self) -> bool:
        """Every edge belongs to two faces of opposite direction, so inside and outside exist."""
        return self.edges > 0 and self.open_edges == 0 and self.irregular_edges == 0

    @property
    def why_open(self) -> str:
        """What keeps the surface from being closed, in words; empty when it is closed."""
        reasons = []
        if self.open_edges:
            reasons.append(f"{self.open_edges} open edges")
        if self.irregular_edges:
            reasons.append(f"{self.irregular_edges} edges shared by more than two faces or by two of one direction")
        if self.duplicate_faces:
            reasons.append(f"{self.duplicate_faces} doubled faces")
        return ", ".join(reasons)


def topology(vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> Topology:
    """Count shared, open and irregular edges."""
    merged = first_of_coincident(vertices)
    f = merged[faces]
    f = f[(f[:, 0] != f[:, 1]) & (f[:, 1] != f[:, 2]) & (f[:, 2] != f[:, 0])]
    again = repeated_faces(f)
    edges, ends, irregular = _edges(f, len(vertices))
    once = _edges(f[~again], len(vertices)) if again.any() else (edges, ends, irregular)
    return Topology(edges, ends, irregular, int(again.sum()), merged, once[0] > 0 and once[1:] == (0, 0))


def _edges(f: Int[np.ndarray, "m 3"], vertex_count: int) -> tuple[int, int, int]:
    """How many there are, how many belong to one face only, and how many are irregular."""
    start = f.ravel()
    end = np.roll(f, -1, axis=1).ravel()
    low, high = np.minimum(start, end), np.maximum(start, end)
    key = low * np.int64(vertex_count) + high
    forward = (start < end).astype(np.int64)
    _, inverse, count = np.unique(key, return_inverse=True, return_counts=True)
    ahead = np.bincount(inverse, weights=forward, minlength=len(count))
    regular = (count == 2) & (ahead == 1)
    return len(count), int((count == 1).sum()), int((~regular & (count != 1)).sum())


def signed_volume(vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> float:
    """Volume enclosed [m^3]; negative when the faces point inwards. Divergence theorem, about the first vertex."""
    a, b, c = (vertices[faces[:, k]] - vertices[faces[0, 0]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)
