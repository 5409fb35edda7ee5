"""Open3D's RaycastingScene (Embree), float32."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from benchmarks.engines.engine import Engine, Query, peer
from benchmarks.pairs import Pair


def build(pair: Pair) -> Query:
    """compute_distance on one thread; unbounded, for the scene has no bound."""
    import open3d

    scene = open3d.t.geometry.RaycastingScene(nthreads=1)
    vertices = open3d.core.Tensor(pair.fixed.local.astype(np.float32))
    scene.add_triangles(vertices, open3d.core.Tensor(pair.fixed.faces.astype(np.uint32)))

    def query(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        tensor = open3d.core.Tensor(points.astype(np.float32))
        closest = scene.compute_closest_points(tensor, nthreads=1)["points"].numpy()
        return np.asarray(np.linalg.norm(points - closest, axis=1))

    return query


def engines() -> list[Engine]:
    """One naive use."""
    return [Engine("open3d RaycastingScene", "open3d", peer(build), every=10, goal=30.0)]
