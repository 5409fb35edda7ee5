"""What is measured of an engine: one frame of the job, its map and its area timed apart."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from benchmarks.engines.clip import clipped_area
from benchmarks.pairs import THRESHOLD, Pair

Query = Callable[[Float[np.ndarray, "n 3"]], Float[np.ndarray, " n"]]
"""Distances [m] of points given about the centre of B."""


class Frame(NamedTuple):
    """Distance of A's vertices, in the engine's own order and unit of storage, area [m^2], CPU seconds of the map."""

    distance: object
    area: float
    map_seconds: float


Step = Callable[[int], Frame]


@dataclass(frozen=True)
class Engine:
    """One row of the table.

    Parameters
    ----------
    name
        What stands in the row.
    package
        Distribution whose version is recorded.
    prepare
        Builds the engine for a pair and returns the function that does frame k.
    distances
        Distance of A's vertices in their given order [m] from a frame; NaN or infinite where the engine says "farther".
    bound
        Largest distance asked for [m], given the pair; infinite for a naive use.
    every
        Only every n-th frame is done and the time scaled.
    points
        Only this many vertices are asked for and the time scaled; no area then.
    goal
        Factor by which ours should be faster.
    """

    name: str
    package: str
    prepare: Callable[[Pair], Step]
    distances: Callable[[Frame], Float[np.ndarray, " n"]] = lambda frame: np.asarray(frame.distance, float)
    bound: Callable[[Pair], float] = lambda pair: np.inf
    every: int = 1
    points: int | None = None
    goal: float | None = None
    note: str = ""


def peer(build: Callable[[Pair], Query], points: int | None = None) -> Callable[[Pair], Step]:
    """The job with a peer's distances: vertices moved with numpy, queried, and clipped by the same numpy function."""

    def prepare(pair: Pair) -> Step:
        query = build(pair)
        chosen = sample(pair, points)
        faces, area = pair.moving.faces, pair.moving.face_area

        def step(k: int) -> Frame:
            start = time.process_time()
            distance = query(pair.moved(k)[chosen])
            seconds = time.process_time() - start
            return Frame(distance, np.nan if points else clipped_area(faces, area, distance, THRESHOLD), seconds)

        return step

    return prepare


FAR = 1.0
"""Stands for the distance of a vertex that a bounded peer did not find [m]."""


def sample(pair: Pair, points: int | None) -> slice | np.ndarray:
    """All vertices, or `points` of them spread over the list."""
    n = len(pair.moving.vertices)
    return slice(None) if points is None else np.linspace(0, n - 1, min(points, n)).astype(int)


def threshold_only(pair: Pair) -> float:
    """Bound of a user who asks for the threshold and no more: cut triangles lose nearly all of their part."""
    return THRESHOLD


def threshold_and_edge(pair: Pair) -> float:
    """Bound of a user who cuts at the iso-line rightly: every corner of a cut triangle is found."""
    return THRESHOLD + float(pair.moving.edge_length.max())
