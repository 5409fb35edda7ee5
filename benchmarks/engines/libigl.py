"""libigl's AABB tree, float64: also the reference that every other engine's distances are held against."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from benchmarks.engines.engine import Engine, Query, peer
from benchmarks.pairs import Pair


def build(pair: Pair) -> Query:
    """Unbounded squared distances."""
    import igl

    vertices, faces = np.ascontiguousarray(pair.fixed.local), pair.fixed.faces.astype(np.int64)
    tree = igl.AABB()
    tree.init(vertices, faces)

    def query(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        return np.asarray(np.sqrt(tree.squared_distance(vertices, faces, points)[0]))

    return query


def engines() -> list[Engine]:
    """One naive use; the Python binding has no bound."""
    return [Engine("libigl AABB", "libigl", peer(build), every=10, goal=40.0)]
