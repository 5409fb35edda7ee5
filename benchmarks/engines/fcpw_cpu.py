"""FCPW, float32, vectorised tree: naive and bounded."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from jaxtyping import Float

from benchmarks.engines.engine import FAR, Engine, Query, peer, threshold_and_edge, threshold_only
from benchmarks.pairs import Pair

LARGEST = np.finfo(np.float32).max
"""FCPW's own number for "not found"."""


def build(pair: Pair, bound: Callable[[Pair], float]) -> Query:
    """One call per frame; its answers are objects, read one by one, for the binding has no other way."""
    import fcpw

    scene = fcpw.scene_3D()
    scene.set_object_count(1)
    scene.set_object_vertices(np.asfortranarray(pair.fixed.local, dtype=np.float32), 0)
    scene.set_object_triangles(np.asfortranarray(pair.fixed.faces, dtype=np.int32), 0)
    scene.build(fcpw.aggregate_type.bvh_surface_area, True)
    squared = np.full(len(pair.moving.vertices), min(bound(pair) ** 2, LARGEST), np.float32)

    def query(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        answers = fcpw.interaction_3D_list()
        scene.find_closest_points(np.asfortranarray(points, dtype=np.float32), squared, answers)
        return np.asarray(np.minimum([answer.d for answer in answers], FAR))

    return query


def engines() -> list[Engine]:
    """Naive and bounded."""

    def row(name: str, bound: Callable[[Pair], float], every: int, goal: float) -> Engine:
        return Engine(name, "fcpw", peer(partial(build, bound=bound)), bound=bound, every=every, goal=goal)

    return [
        row("fcpw, naive", lambda pair: np.inf, 5, 15.0),
        row("fcpw, bounded to 4 mm", threshold_only, 1, 1.5),
        row("fcpw, bounded to 4 mm + longest edge", threshold_and_edge, 1, 1.5),
    ]
