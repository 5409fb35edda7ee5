"""trimesh.proximity.closest_point, float64: too slow for the whole job, so a sample of vertices is scaled up."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from benchmarks.engines.engine import Engine, Query, peer
from benchmarks.pairs import Pair

POINTS = 600
MILLIMETRES = 1e3
"""trimesh is asked in mm: in m its fixed tolerance of 1e-8 on squared distances costs up to 0.1 mm."""


def build(pair: Pair) -> Query:
    """One call per frame."""
    import rtree  # noqa: F401  (trimesh asks for it only at the first query)
    import trimesh

    mesh = trimesh.Trimesh(MILLIMETRES * pair.fixed.local, pair.fixed.faces, process=False)
    _ = mesh.triangles_tree

    def query(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        return np.asarray(trimesh.proximity.closest_point(mesh, MILLIMETRES * points)[1]) / MILLIMETRES

    return query


def engines() -> list[Engine]:
    """One naive use."""
    return [Engine("trimesh.closest_point", "trimesh", peer(build, POINTS), every=34, points=POINTS, goal=4000.0)]
