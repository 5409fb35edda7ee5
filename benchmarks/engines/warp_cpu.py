"""NVIDIA Warp on the CPU, float32: naive, and bounded by a careful user; best of its tree builders (SAH)."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
from jaxtyping import Float

from benchmarks.engines.engine import FAR, Engine, Query, peer, threshold_and_edge, threshold_only
from benchmarks.engines.warp_kernels import load
from benchmarks.pairs import Pair


@cache
def kernels() -> Any:
    """Compiled once per process."""
    return load()


def build(pair: Pair, bound: Callable[[Pair], float], signed: bool) -> Query:
    """One launch per frame on preallocated output."""
    wp, plain, with_sign = kernels()
    vertices = wp.array(pair.fixed.local.astype(np.float32), dtype=wp.vec3, device="cpu")
    faces = wp.array(pair.fixed.faces.astype(np.int32).ravel(), dtype=wp.int32, device="cpu")
    mesh = wp.Mesh(vertices, faces, bvh_constructor="sah")
    n = len(pair.moving.vertices)
    out = wp.empty(n, dtype=float, device="cpu")
    largest = min(bound(pair), 1e6)

    def query(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        where = wp.array(points.astype(np.float32), dtype=wp.vec3, device="cpu", copy=False)
        inputs = [mesh.id, where, largest, FAR]
        wp.launch(with_sign if signed else plain, dim=n, inputs=inputs, outputs=[out], device="cpu")
        return np.asarray(out.numpy())

    return query


def engines() -> list[Engine]:
    """Naive and bounded, unsigned as the fastest use; one signed row as its price."""

    def row(name: str, bound: Callable[[Pair], float], every: int, goal: float | None, signed: bool = False) -> Engine:
        steps = peer(partial(build, bound=bound, signed=signed))
        return Engine(name, "warp-lang", steps, bound=bound, every=every, goal=goal)

    return [
        row("warp (CPU), naive", lambda pair: np.inf, 5, 15.0),
        row("warp (CPU), bounded to 4 mm", threshold_only, 1, 1.5),
        row("warp (CPU), bounded to 4 mm + longest edge", threshold_and_edge, 1, 1.5),
        row("warp (CPU), signed, bounded to 4 mm + longest edge", threshold_and_edge, 1, None, signed=True),
    ]
