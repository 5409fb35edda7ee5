"""Coordinates of a tree from markers: weighted least squares frame by frame, each from where the last one ended.

Lu & O'Connor (1999), Bone position estimation from skin marker co-ordinates using global optimisation, J Biomech 32.
Newton's steps; the curvature, exact, is kept as long as they shrink fast, and damped after Levenberg and Marquardt
where they do not lead down. Coordinates that the model clamps stay within their limits, locked ones at their default.
A marker that is not seen does not count in that frame.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from geocontact.data.marker_tasks import MarkerTasks
from geocontact.data.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody import Marker
from geocontact.dynamics.marker_fit import MarkerFit, Vector
from geocontact.dynamics.tree import Tree

STEP = 1e-8  # rad or m that the longest step is below when a frame is done
MOST = 200  # steps for a frame
FAST = 0.2  # of the step before that a step is, while the curvature is kept
DAMPED, WILDER = 1e-6, 10.0  # of the curvature's largest entry, once a step led up; times more each time
EVEN = 1e-12  # of the cost that it may rise by rounding


@dataclass(frozen=True)
class Poses:
    """Coordinates over time and how well they fit.

    Parameters
    ----------
    time
        [s].
    names, values
        Coordinates [rad, m].
    markers, distances
        Names and distance of each from where it was seen [m]; NaN where it was not seen or does not count.
    steps
        Taken in each frame.
    settled
        Whether the last step was short enough.
    """

    time: Float[np.ndarray, " t"]
    names: tuple[str, ...]
    values: Float[np.ndarray, "t n"]
    markers: tuple[str, ...]
    distances: Float[np.ndarray, "t m"]
    steps: Int[np.ndarray, " t"]
    settled: Bool[np.ndarray, " t"]


def inverse_kinematics(
    tree: Tree, seen: MarkerTrajectories, tasks: MarkerTasks, progress: Callable[[int], None] = lambda _: None
) -> Poses:
    """Coordinates in each frame.

    Those markers count that model, recording and tasks have; ValueError where there are fewer than three.
    """
    markers = tuple(m for m in tree.model.markers if tasks.markers.get(m.name, 0.0) > 0.0 and m.name in seen.names)
    if len(markers) < 3:
        raise ValueError(f"{len(markers)} markers of the model were recorded and have a weight; three are needed")
    search = _Search(tree, markers, tasks)
    places = seen.of(tuple(m.name for m in markers))
    values, distances = np.zeros((len(seen), len(tree.names))), np.full((len(seen), len(markers)), np.nan)
    steps, settled = np.zeros(len(seen), dtype=np.int64), np.zeros(len(seen), dtype=bool)
    q = search.start
    for frame, observed in enumerate(places):
        q, steps[frame], settled[frame] = search.pose(q, observed)
        values[frame] = q
        distances[frame] = np.linalg.norm(search.fit.places(q) - observed, axis=1)
        progress(frame + 1)
    return Poses(seen.time, tree.names, values, tuple(m.name for m in markers), distances, steps, settled)


class _Search:
    """What is the same in all frames."""

    def __init__(self, tree: Tree, markers: tuple[Marker, ...], tasks: MarkerTasks) -> None:
        self.fit = MarkerFit(tree, markers)
        self.kept: _Kept | None = None
        self.weights = np.array([tasks.markers[m.name] for m in markers])
        coordinates = tree.model.coordinates
        self.start = np.array([c.default for c in coordinates])
        self.low = np.array([c.limits[0] if c.clamped else -np.inf for c in coordinates])
        self.high = np.array([c.limits[1] if c.clamped else np.inf for c in coordinates])
        self.locked = np.array([c.locked for c in coordinates])
        wanted = [tasks.coordinates.get(c.name, (0.0, None)) for c in coordinates]
        self.held = np.array([weight for weight, _ in wanted])
        self.wanted = np.array(
            [c.default if value is None else value for c, (_, value) in zip(coordinates, wanted, strict=True)]
        )

    def pose(self, q: Vector, observed: Float[np.ndarray, "m 3"]) -> tuple[Vector, int, bool]:
        """Coordinates of a frame from a start, steps taken, and whether the last was short enough."""
        there = np.all(np.isfinite(observed), axis=1)
        seen = np.where(there[:, None], observed, 0.0), np.where(there, self.weights, 0.0)
        against = (*seen, self.wanted, self.held)
        gradient, cost = self.fit.slope(q, against)
        damping, before = 0.0, np.inf
        for step in range(1, MOST + 1):
            free = ~self.locked & ~((q <= self.low) & (gradient > 0.0)) & ~((q >= self.high) & (gradient < 0.0))
            if self.kept is None or not self.kept.holds(free, there):
                self.kept = _Kept(self.fit.curvature(q, against), free, there, damping)
            tried = np.clip(q - self.kept.step(gradient), self.low, self.high)
            longest = float(np.max(np.abs(tried - q), initial=0.0))
            if longest < STEP:
                return tried, step, True
            slope, found = self.fit.slope(tried, against)
            if found <= cost + EVEN * abs(cost):
                q, gradient, cost = tried, slope, found
                fast, damping = longest < FAST * before, damping / WILDER
            else:
                fast, damping = False, max(WILDER * damping, DAMPED)
            before = longest
            self.kept = self.kept if fast else None
        return q, MOST, False


class _Kept:
    """A curvature, factorised over the coordinates that are free; raised until it leads down everywhere."""

    def __init__(
        self,
        curvature: Float[np.ndarray, "n n"],
        free: Bool[np.ndarray, " n"],
        there: Bool[np.ndarray, " m"],
        damping: float,
    ) -> None:
        self.free, self.there = free, there
        inner = curvature[np.ix_(free, free)]
        scale = float(np.max(np.abs(np.diag(inner)), initial=1.0))
        while True:
            try:
                raised = inner + damping * scale * np.eye(len(inner))
                self.factor = cho_factor(raised, lower=True, check_finite=False)
                return
            except LinAlgError:
                damping = max(WILDER * damping, DAMPED)

    def holds(self, free: Bool[np.ndarray, " n"], there: Bool[np.ndarray, " m"]) -> bool:
        """Whether the same coordinates are free and the same markers there."""
        return bool(np.array_equal(free, self.free) and np.array_equal(there, self.there))

    def step(self, gradient: Vector) -> Vector:
        """What to go back by [rad, m]."""
        found = np.zeros(len(gradient))
        found[self.free] = cho_solve(self.factor, gradient[self.free], check_finite=False)
        return found
