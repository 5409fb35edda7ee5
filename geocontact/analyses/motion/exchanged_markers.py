"""Markers whose names are exchanged: with each at the place of the other the model fits far better."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from geocontact.analyses.motion.marker_tasks import MOVING, MarkerErrors
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import Tree

Pairs = tuple[tuple[str, str], ...]

FRAMES = 2  # that exchanges are tried in
NEAR = 6  # pairs tried besides right and left, those that gain most where the model stands
MOST = 6  # exchanges of one recording
BETTER = 0.6  # of the root mean square before, that an exchange has to leave less of
NAMED = 3  # pairs; the map has all of them
EXPLAINED = 0.5  # of the first root mean square, that all of them have to leave less of


@dataclass(frozen=True)
class Exchanged:
    """Pairs of markers, and root mean square distances of all from the model before and after [m]."""

    pairs: Pairs
    before: float
    after: float

    @property
    def words(self) -> str:
        """A question to whoever named the markers."""
        named = ", ".join(f"{one} and {other}" for one, other in self.pairs[:NAMED])
        named += f" and {len(self.pairs) - NAMED} more pairs" if len(self.pairs) > NAMED else ""
        number = f"{1e3 * self.after:.1f} mm in place of {1e3 * self.before:.1f} mm"
        mapped = ",".join(f"{one}={other},{other}={one}" for one, other in self.pairs)
        return f"are markers {named} exchanged? That would leave {number}: try `markers_map` {mapped}"


def exchanged_markers(tree: Tree, seen: MarkerTrajectories, tasks: MarkerTasks, found: Poses) -> Exchanged | None:
    """Pairs whose exchange explains most of large distances, one after the other; None where there are none.

    Tried in a few frames, each beginning at the model's default pose: right for left in all names, right for left in
    one, and the pairs that gain most where the model stands.
    """
    errors = MarkerErrors.of(found)
    if errors.within(MOVING):
        return None
    frames = _telling(found)
    part = MarkerTrajectories(seen.time[frames], seen.positions[frames], seen.names, seen.source)
    poses = inverse_kinematics(tree, part, tasks)
    first = _rms(poses)
    exchanged: Pairs = ()
    sides = _sides(poses.markers)
    for _ in range(MOST):
        tried: list[Pairs] = [(pair,) for pair in dict.fromkeys((*sides, *_gaining(tree, part, poses)))]
        tried += [sides] if not exchanged and len(sides) > 1 else []
        if MarkerErrors.of(poses).within(MOVING) or not tried:
            break
        each = [inverse_kinematics(tree, _with(part, pairs), tasks) for pairs in tried]
        best = int(np.argmin([_rms(one) for one in each]))
        if _rms(each[best]) >= BETTER * _rms(poses):
            break
        part, poses = _with(part, tried[best]), each[best]
        exchanged += tried[best]
    return Exchanged(exchanged, first, _rms(poses)) if exchanged and _rms(poses) < EXPLAINED * first else None


def _telling(found: Poses) -> list[int]:
    """Frames, spread over the recording, that show most markers."""
    shown = np.isfinite(found.distances).sum(axis=1)
    whole = np.flatnonzero(shown == shown.max())
    return sorted({int(whole[k]) for k in np.linspace(0, len(whole) - 1, FRAMES).astype(int)})


def _sides(names: tuple[str, ...]) -> Pairs:
    """Names that differ by right and left alone: RASI and LASI, knee_r and knee_l."""
    return tuple((one, other) for one, other in combinations(names, 2) if _other_side(one, other))


def _other_side(one: str, other: str) -> bool:
    a, b = one.lower().replace("right", "r"), other.lower().replace("left", "l")
    if "left" in one.lower() or "right" in other.lower():
        a, b = other.lower().replace("right", "r"), one.lower().replace("left", "l")
    differing = [{x, y} for x, y in zip(a, b, strict=False) if x != y]
    return len(a) == len(b) and differing == [{"r", "l"}]


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


def _rms(poses: Poses) -> float:
    return float(np.sqrt(np.nanmean(poses.distances**2)))
