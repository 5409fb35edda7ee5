"""Which faces meet at which edges: closed or not, and why not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.coincident import first_of_coincident, repeated_faces


@dataclass(frozen=True)
class Topology:
    """Edge count of a surface after merging coincident vertices; faces with two equal corners are left out.

    `open_edges` belong to one face only, `irregular_edges` to more than two or to two of the same direction.
    """

    edges: int
    open_edges: int
    irregular_edges: int
    duplicate_faces: int
    merged: Int[np.ndarray, " n"]

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
    start = f.ravel()
    end = np.roll(f, -1, axis=1).ravel()
    low, high = np.minimum(start, end), np.maximum(start, end)
    key = low * np.int64(len(vertices)) + high
    forward = (start < end).astype(np.int64)
    _, inverse, count = np.unique(key, return_inverse=True, return_counts=True)
    ahead = np.bincount(inverse, weights=forward, minlength=len(count))
    regular = (count == 2) & (ahead == 1)
    return Topology(
        edges=len(count),
        open_edges=int((count == 1).sum()),
        irregular_edges=int((~regular & (count != 1)).sum()),
        duplicate_faces=int(repeated_faces(f).sum()),
        merged=merged,
    )


def signed_volume(vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> float:
    """Volume enclosed [m^3]; negative when the faces point inwards. Divergence theorem, about the first vertex."""
    a, b, c = (vertices[faces[:, k]] - vertices[faces[0, 0]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)
