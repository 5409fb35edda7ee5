"""Pairs of markers whose names are exchanged: with each at the place of the other the model fits far better."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.motion.marker_errors import MOVING, MarkerErrors
from geocontact.data.multibody.marker_tasks import MarkerTasks
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import Tree

FRAMES = 3  # that exchanges are tried in
TRIED = 12  # pairs, those that gain most where the model stands
MOST = 6  # pairs exchanged in one recording
BETTER = 0.6  # of the root mean square before, that an exchange has to leave less of
EXPLAINED = 0.5  # of the first root mean square, that all of them have to leave less of


@dataclass(frozen=True)
class Exchanged:
    """Pairs of markers, and root mean square distances of all from the model before and after [m]."""

    pairs: tuple[tuple[str, str], ...]
    before: float
    after: float

    @property
    def words(self) -> str:
        """A question to whoever named the markers."""
        named = ", ".join(f"{one} and {other}" for one, other in self.pairs)
        number = f"{1e3 * self.after:.1f} mm in place of {1e3 * self.before:.1f} mm"
        mapped = ",".join(f"{one}={other},{other}={one}" for one, other in self.pairs)
        return f"are markers {named} exchanged? That would leave {number}: try `markers_map` {mapped}"


def exchanged_markers(tree: Tree, seen: MarkerTrajectories, tasks: MarkerTasks, found: Poses) -> Exchanged | None:
    """Pairs whose exchange explains most of large distances, one after the other; None where there are none.

    Tried in a few frames: the pairs that gain most at the pose found, each with the pose found anew.
    """
    errors = MarkerErrors.of(found)
    if errors.rms <= MOVING.rms and errors.largest <= MOVING.largest:
        return None
    frames = _telling(found)
    part = MarkerTrajectories(seen.time[frames], seen.positions[frames], seen.names, seen.source)
    pose = _part(found, frames)
    first = now = _rms(pose.distances)
    pairs: list[tuple[str, str]] = []
    while len(pairs) < MOST:
        tried = _gaining(tree, part, pose)
        if not tried:
            break
        poses = _each(tree, part, tasks, tried)
        best = int(np.argmin([_rms(each.distances) for each in poses]))
        if _rms(poses[best].distances) >= BETTER * now:
            break
        pairs.append(tried[best])
        part, pose = _with(part, tried[best]), poses[best]
        now = _rms(pose.distances)
    return Exchanged(tuple(pairs), first, now) if pairs and now < EXPLAINED * first else None


def _telling(found: Poses) -> list[int]:
    """Frames, spread over the recording, that show most markers."""
    shown = np.isfinite(found.distances).sum(axis=1)
    whole = np.flatnonzero((shown == shown.max()) & np.isfinite(found.values).all(axis=1))
    if not len(whole):
        whole = np.flatnonzero(shown == shown.max())
    return sorted({int(whole[k]) for k in np.linspace(0, len(whole) - 1, FRAMES).astype(int)})


def _part(found: Poses, frames: list[int]) -> Poses:
    return replace(
        found,
        time=found.time[frames],
        values=found.values[frames],
        distances=found.distances[frames],
        steps=found.steps[frames],
        settled=found.settled[frames],
        determined=found.determined[frames],
    )


def _gaining(tree: Tree, seen: MarkerTrajectories, pose: Poses) -> list[tuple[str, str]]:
    """Pairs that would be nearer to each other's place, those that gain most first."""
    places = seen.of(pose.markers)
    own = tuple(m.name for m in tree.model.markers)
    modelled = tree.model.marker_places(np.nan_to_num(pose.values))[:, [own.index(name) for name in pose.markers]]
    square = np.sum((modelled[:, :, None] - places[:, None, :]) ** 2, axis=3)
    gains = []
    for i, j in combinations(range(len(pose.markers)), 2):
        gain = np.nanmean(square[:, i, i] + square[:, j, j] - square[:, i, j] - square[:, j, i])
        if gain > 0.0:
            gains.append((float(gain), pose.markers[i], pose.markers[j]))
    return [(one, other) for _, one, other in sorted(gains, reverse=True)[:TRIED]]


def _each(tree: Tree, seen: MarkerTrajectories, tasks: MarkerTasks, pairs: list[tuple[str, str]]) -> list[Poses]:
    """Poses with each of the pairs exchanged, found in one go: frames of one pair after those of another."""
    count = len(seen)
    positions = np.concatenate([_with(seen, pair).positions for pair in pairs])
    several = MarkerTrajectories(np.arange(len(positions), dtype=float), positions, seen.names, seen.source)
    found = inverse_kinematics(tree, several, tasks)
    return [_part(found, list(range(k * count, (k + 1) * count))) for k in range(len(pairs))]


def _with(seen: MarkerTrajectories, pair: tuple[str, str]) -> MarkerTrajectories:
    one, other = pair
    return MarkerTrajectories(seen.time, seen.renamed({one: other, other: one}).of(seen.names), seen.names, seen.source)


def _rms(distances: Float[np.ndarray, "t m"]) -> float:
    return float(np.sqrt(np.nanmean(distances**2)))
