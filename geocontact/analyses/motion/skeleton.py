"""A model that moves as lines from joint to joint, with markers and forces beside it: what a page shows of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.data.wrench import Wrench
from geocontact.view.page.scene import Linkage, Scene

JOINT, BONE, MARKER, RAY, ROD = 0.02, 0.022, 0.012, 0.005, 0.016
"""Radius of joints and thickness of segments, radius of markers, thickness of what joins them and of forces [m]."""
SHORTEST = 1e-3
"""m; frames of joints that lie closer than this on a body are one point."""
METRES_PER_NEWTON = 1e-3
"""A force of 1000 N is drawn 1 m long."""
LOADED = 20.0
"""N from which a force is drawn: the point of a small one means little."""
TILE, MARGIN = 0.5, 0.5
"""Sizes of the floor [m]."""


def skeleton(model: Multibody, values: Float[np.ndarray, "t n"]) -> Linkage:
    """Segments from joint to joint, along coordinates [rad, m]; a last segment goes to its farthest marker.

    Without markers it goes to its mass centre. Frames in which a coordinate is missing are empty.
    """
    whole = np.isfinite(values).all(axis=1)
    poses = model.poses(values[whole])
    starts = [joint.child_offset.translation for joint in model.joints]  # where the joint turns, in its child body
    places = [poses[joint.child].apply(at) for joint, at in zip(model.joints, starts, strict=True)]
    lines: list[tuple[int, int]] = []
    of = {joint.child: k for k, joint in enumerate(model.joints)}
    for k, joint in enumerate(model.joints):
        if joint.parent != GROUND and _apart(places[of[joint.parent]], places[k]):
            lines.append((of[joint.parent], k))
    for body in model.bodies:
        end = _end(model, body, starts[of[body.name]])
        if end is not None:
            lines.append((of[body.name], len(places)))
            places.append(poses[body.name].apply(end))
    points = np.full((len(values), len(places), 3), np.nan)
    points[whole] = np.stack(places, axis=1)
    return Linkage("segments and joints", points, _pairs(lines), "bone", JOINT, BONE)


def _apart(first: Float[np.ndarray, "t 3"], second: Float[np.ndarray, "t 3"]) -> bool:
    return bool(np.linalg.norm(first - second, axis=1).max(initial=0.0) > SHORTEST)


def _end(model: Multibody, body: Body, start: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"] | None:
    """Where a body that carries no other ends, in its own frame; None for the others and for those without extent."""
    if any(joint.parent == body.name for joint in model.joints):
        return None
    ends = [m.location for m in model.markers if m.body == body.name] or [body.centre]
    far = max(ends, key=lambda place: float(np.linalg.norm(place - start)))
    return far if np.linalg.norm(far - start) > SHORTEST else None


def markers_beside(seen: Float[np.ndarray, "t m 3"], modelled: Float[np.ndarray, "t m 3"]) -> list[Linkage]:
    """Markers as they were seen and as the model has them [m], and what lies between; those that are known."""
    both = np.concatenate([seen, modelled], axis=1)
    count = seen.shape[1]
    between = np.column_stack([np.arange(count), count + np.arange(count)])
    none = np.zeros((0, 2), dtype=np.int64)
    found = [
        ("markers measured", seen, none, "seen", MARKER),
        ("markers of the model", modelled, none, "model", MARKER),
        ("distance between them", both, between, "seen", 0.0),
    ]
    return [
        Linkage(name, points, lines, "model" if tone == "model" else "seen", radius, RAY)
        for name, points, lines, tone, radius in found
        if np.isfinite(points).all(axis=2).any()
    ]


def forces_on(model: Multibody, loads: Mapping[str, Wrench], shown: Int[np.ndarray, " k"]) -> list[Linkage]:
    """Measured forces from the centre of pressure on the floor upwards, 1 m for 1000 N; none below 20 N."""
    up = model.up
    ends = []
    for wrench in loads.values():
        foot = wrench.centre_of_pressure(np.zeros(3), up, LOADED)
        ends += [foot[shown], (foot + METRES_PER_NEWTON * wrench.force)[shown]]
    if not ends or not np.isfinite(np.stack(ends)).all(axis=2).any():
        return []
    lines = np.arange(len(ends)).reshape(-1, 2)
    return [Linkage("measured forces, 1 m for 1000 N", np.stack(ends, axis=1), lines, "force", 0.0, ROD)]


def scene_of(model: Multibody, linkages: Sequence[Linkage]) -> Scene:
    """The picture: linkages over a floor through the ground's origin, seen from a little above and the right."""
    return scene_over(model.up, linkages)


def scene_over(up: Float[np.ndarray, " 3"], linkages: Sequence[Linkage]) -> Scene:
    """The same with a unit vector upwards, along an axis of the ground."""
    k = int(np.argmax(np.abs(up)))
    ways = {f"{sign}{axis}": s * np.eye(3)[j] for j, axis in enumerate("xyz") for s, sign in ((1.0, "+"), (-1.0, "−"))}
    names = {"+x": "front (+x)", "−x": "back (−x)", "+z": "right (+z)", "−z": "left (−z)", "+y": "above (+y)"}
    if k == 1:  # OpenSim's axes: x forward, y up, z to the right
        order = ("+z", "+x", "−z", "−x", "+y")
        directions = {names[way]: tuple(map(float, ways[way])) for way in order}
        view: tuple[float, ...] = (0.45, 0.2, 1.0)
    else:
        directions = {name: tuple(map(float, way)) for name, way in ways.items()}
        view = tuple(float(x) for x in np.ones(3) + up)
    shown = [_floor(linkages, k), *linkages]
    return Scene(directions=directions, up=tuple(map(float, up)), view=view, linkages=shown)


def _floor(linkages: Sequence[Linkage], k: int) -> Linkage:
    """Tiles of half a metre below everything, in the plane through the origin that axis k is across."""
    places = np.concatenate([each.places for each in linkages])
    flat = [axis for axis in range(3) if axis != k]
    low, high = (TILE * np.round((places.min(0) - MARGIN) / TILE), TILE * np.round((places.max(0) + MARGIN) / TILE))
    points: list[Float[np.ndarray, " 3"]] = []
    for along, across in (flat, flat[::-1]):
        for place in np.arange(low[across], high[across] + 0.5 * TILE, TILE):
            for end in (low[along], high[along]):
                point = np.zeros(3)
                point[along], point[across] = end, place
                points.append(point)
    lines = np.arange(len(points)).reshape(-1, 2)
    return Linkage("floor, tiles of 0.5 m", np.array(points)[None], lines, "floor", 0.0, 0.5 * RAY)


def _pairs(lines: Sequence[tuple[int, int]]) -> Int[np.ndarray, "k 2"]:
    return np.array(lines, dtype=np.int64).reshape(-1, 2)
