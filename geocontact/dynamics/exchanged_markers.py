"""Markers whose names are exchanged: with each at the place of the other the model fits far better."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.sides import differ_by_side
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import Tree

Pairs = tuple[tuple[str, str], ...]

FRAMES = 2  # that exchanges are tried in
NEAR = 6  # pairs tried besides right and left, those that gain most where the model stands
MOST = 6  # exchanges of one recording
BETTER = 0.6  # of the root mean square before, that an exchange has to leave less of
EXPLAINED = 0.5  # of the first root mean square, that all of them have to leave less of


@dataclass(frozen=True)
class Exchanged:
    """Pairs of markers, and the root mean square of all distances from the model in the frames tried.

    Parameters
    ----------
    pairs
        Names, of which each has the place of the other.
    before, after
        Distances with the names as they are and exchanged [m].
    """

    pairs: Pairs
    before: float
    after: float


def exchanged_markers(
    tree: Tree, seen: MarkerTrajectories, tasks: MarkerTasks, found: Poses, rms: float, largest: float
) -> Exchanged | None:
    """Pairs whose exchange explains most of large distances, one after the other; None where there are none.

    Tried in two frames, each beginning at the model's default pose: right for left in all names, right for left in
    one, and the six pairs that gain most where the model stands. An exchange has to leave less than 0.6 of the root
    mean square before it, all of them less than half of the first.

    Parameters
    ----------
    tree
        Of the model that has the markers.
    seen, tasks
        Markers as they were recorded, and their weights.
    found
        Inverse kinematics of all frames with the names as they are.
    rms, largest
        Root mean square and largest distance of markers from a model [m] up to which nothing is searched.
    """
    if _within(found, rms, largest):
        return None
    frames = _well_marked_frames(found)
    part = MarkerTrajectories(seen.time[frames], seen.positions[frames], seen.names, seen.source)
    poses = inverse_kinematics(tree, part, tasks)
    first = _rms(poses)
    exchanged: Pairs = ()
    sides = _sides(poses.markers)
    for _ in range(MOST):
        tried: list[Pairs] = [(pair,) for pair in dict.fromkeys((*sides, *_gaining(tree, part, poses)))]
        tried += [sides] if not exchanged and len(sides) > 1 else []
        if _within(poses, rms, largest) or not tried:
            break
        each = [inverse_kinematics(tree, _with(part, pairs), tasks) for pairs in tried]
        best = int(np.argmin([_rms(one) for one in each]))
        if _rms(each[best]) >= BETTER * _rms(poses):
            break
        part, poses = _with(part, tried[best]), each[best]
        exchanged += tried[best]
    return Exchanged(exchanged, first, _rms(poses)) if exchanged and _rms(poses) < EXPLAINED * first else None


def _well_marked_frames(found: Poses) -> list[int]:
    """Frames, spread over the recording, that show most markers."""
    shown = np.isfinite(found.distances).sum(axis=1)
    whole = np.flatnonzero(shown == shown.max())
    return sorted({int(whole[k]) for k in np.linspace(0, len(whole) - 1, FRAMES).astype(int)})


def _sides(names: tuple[str, ...]) -> Pairs:
    """Names that differ by right and left alone: RASI and LASI, knee_r and knee_l."""
    return tuple((one, other) for one, other in combinations(names, 2) if differ_by_side(one, other))


def _gaining(tree: Tree, seen: MarkerTrajectories, poses: Poses) -> Pairs:
    """Pairs that would be nearer to each other's place, those that gain most first."""
    places = seen.of(poses.markers)
    own = tuple(m.name for m in tree.model.markers)
    modelled = tree.model.marker_places(np.nan_to_num(poses.values))[:, [own.index(name) for name in poses.markers]]
    square = np.sum((modelled[:, :, None] - places[:, None, :]) ** 2, axis=3)
    now = np.einsum("tii->ti", square)
    gain = np.mean(now[:, :, None] + now[:, None, :] - square - square.swapaxes(1, 2), axis=0)
    i, j = np.triu_indices(len(poses.markers), 1)
    first = np.argsort(-np.nan_to_num(gain[i, j]), kind="stable")[:NEAR]
    return tuple((poses.markers[i[k]], poses.markers[j[k]]) for k in first if gain[i[k], j[k]] > 0.0)


def _with(seen: MarkerTrajectories, pairs: Pairs) -> MarkerTrajectories:
    """Each marker of a pair at the place of the other."""
    names = {a: b for one, other in pairs for a, b in ((one, other), (other, one))}
    return MarkerTrajectories(seen.time, seen.renamed(names).of(seen.names), seen.names, seen.source)


def _within(poses: Poses, rms: float, largest: float) -> bool:
    return _rms(poses) <= rms and float(np.nanmax(poses.distances)) <= largest


def _rms(poses: Poses) -> float:
    return float(np.sqrt(np.nanmean(poses.distances**2)))
