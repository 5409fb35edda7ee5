"""python-fcl, float64: distance of a vanishing sphere to the surface, one call per point."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from benchmarks.engines.engine import Engine, Query, peer
from benchmarks.pairs import Pair

RADIUS = 1e-12
"""Radius of the sphere that stands for a point [m]; added back to the answer."""


def build(pair: Pair) -> Query:
    """fcl.distance in a Python loop; 0 where the sphere meets a face."""
    import fcl

    vertices, faces = np.ascontiguousarray(pair.fixed.local), pair.fixed.faces
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(vertices, faces)
    model.endModel()
    body, point = fcl.CollisionObject(model), fcl.CollisionObject(fcl.Sphere(RADIUS))
    request = fcl.DistanceRequest()

    def query(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        out = np.empty(len(points))
        for i, position in enumerate(points):
            point.setTranslation(position)
            out[i] = fcl.distance(point, body, request, fcl.DistanceResult())
        return np.maximum(out + RADIUS, 0.0)

    return query


def engines() -> list[Engine]:
    """One naive use."""
    return [Engine("fcl, sphere of no radius", "python-fcl", peer(build), every=25, goal=80.0)]
