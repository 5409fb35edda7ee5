"""Connected pieces of a triangle surface, and which of them are closed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from geocontact.geometry.surface import Surface


@dataclass(frozen=True, eq=False)
class ClosedPieces:
    """Pieces of a surface that hang together by edges.

    Parameters
    ----------
    piece
        Number of the piece of each face.
    closed
        Whether each piece bounds a body by itself: all its edges belong to two faces of opposite direction.
    """

    piece: Int[np.ndarray, " m"]
    closed: Bool[np.ndarray, " p"]

    @property
    def count(self) -> int:
        """Closed pieces."""
        return int(self.closed.sum())

    def boxes(self, corners: Float[np.ndarray, "m 3 3"]) -> tuple[Float[np.ndarray, "p 3"], Float[np.ndarray, "p 3"]]:
        """Lower and upper corner of the box of each piece [m], from the corners of all faces."""
        low, high = np.full((len(self.closed), 3), np.inf), np.full((len(self.closed), 3), -np.inf)
        np.minimum.at(low, self.piece, corners.min(axis=1))
        np.maximum.at(high, self.piece, corners.max(axis=1))
        return low, high


def closed_pieces(surface: Surface) -> ClosedPieces:
    """Pieces of a surface; two that share a corner only are two, faces with two equal corners belong to none closed."""
    faces = surface.topology.merged[surface.faces]
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(faces)), 3)
    flat = (faces == np.roll(faces, -1, axis=1)).any(axis=1)
    kept = ~flat[owner]
    start, end, owner = start[kept], end[kept], owner[kept]
    key = np.minimum(start, end) * np.int64(len(surface.vertices)) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    key, owner, ahead = key[order], owner[order], (start < end)[order]
    _, first, inverse, count = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
    link = coo_array((np.ones(len(owner), np.int8), (owner, owner[first][inverse])), shape=(len(faces),) * 2)
    number, piece = connected_components(link, directed=False)
    regular = (count == 2) & (np.bincount(inverse, weights=ahead) == 1)
    closed = np.ones(number, bool)
    closed[piece[owner[~regular[inverse]]]] = False
    closed[piece[flat]] = False
    return ClosedPieces(np.asarray(piece), closed)
