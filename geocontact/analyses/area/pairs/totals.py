"""What several pairs have together: areas and least distances by pair with their sums, and the loads on each body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.contact import MotionResult
from geocontact.analyses.area.pairs.bodies import TouchingBodies, TouchingPair
from geocontact.data.evolution import MM, MM2

WRENCH = tuple(f"{kind}{axis} [{unit}]" for kind, unit in (("f", "N"), ("m", "N m")) for axis in "xyz")
"""Columns of force and moment."""


def total_area(motions: Sequence[MotionResult]) -> Float[np.ndarray, "t k"]:
    """Sum over the pairs of the contact area on FIXED [m^2]."""
    return np.asarray(np.sum([one.evolution.fixed.area for one in motions], axis=0))


def totals_table(motions: Sequence[MotionResult], time: Float[np.ndarray, " t"]) -> pd.DataFrame:
    """A row per frame and threshold: area on FIXED of each pair and of all, the least distance and whose it is."""
    thresholds = np.asarray(motions[0].evolution.thresholds)
    count = len(thresholds)
    columns: dict[str, object] = {
        "time [s]": np.repeat(time, count),
        "threshold [mm]": np.tile(thresholds * MM, len(time)),
        "area_total [mm^2]": total_area(motions).ravel() * MM2,
    }
    for one in motions:
        columns[f"area_{one.name} [mm^2]"] = one.evolution.fixed.area.ravel() * MM2
    distances = np.array([one.evolution.min_distance for one in motions])
    columns["min_distance [mm]"] = np.repeat(distances.min(axis=0), count) * MM
    columns["nearest"] = np.repeat(np.array([one.name for one in motions])[distances.argmin(axis=0)], count)
    for one in motions:
        if one.pressure is not None:
            columns[f"force_{one.name} [N]"] = np.repeat(one.pressure.pressing, count)
    return pd.DataFrame(columns)


def pair_loads(pairs: TouchingBodies, motions: Sequence[MotionResult]) -> dict[str, Float[np.ndarray, "t 6"]]:
    """Force [N] and moment about the common frame's origin [N m] on FIXED of each pair with a layer, in that frame.

    A pair's load F, M on FIXED (about FIXED's origin, in its frame) is R F and R M + t x R F with the pose R, t of
    FIXED; MOVING bears the opposite.
    """
    found: dict[str, Float[np.ndarray, "t 6"]] = {}
    for pair, one in zip(pairs.pairs, motions, strict=True):
        if one.pressure is None:
            continue
        pose = pairs.poses(pair.fixed)
        wrenches = [load.wrench.moved_to(np.zeros(3)) for load in one.pressure.loads]
        force = pose.rotation.apply([each.force for each in wrenches])
        moment = pose.rotation.apply([each.moment for each in wrenches]) + np.cross(pose.translation, force)
        found[pair.name] = np.hstack([force, moment])
    return found


def body_loads(
    loads: Mapping[str, Float[np.ndarray, "t 6"]], bodies: Mapping[str, tuple[str, str]]
) -> dict[str, Float[np.ndarray, "t 6"]]:
    """Sum over the contacts of each body, of the loads on FIXED by pair; MOVING bears the opposite.

    `bodies` has FIXED and MOVING of each pair. Bodies of no pair with a layer are not among them.
    """
    found: dict[str, Float[np.ndarray, "t 6"]] = {}
    for name, load in loads.items():
        for body, sign in zip(bodies[name], (1.0, -1.0), strict=True):
            found[body] = found.get(body, np.zeros_like(load)) + sign * load
    return found


def pair_loads_table(
    loads: Mapping[str, Float[np.ndarray, "t 6"]],
    bodies: Mapping[str, tuple[str, str]],
    time: Float[np.ndarray, " t"],
) -> pd.DataFrame:
    """Rows of each pair, one per frame and body: what the contact puts on FIXED, and on MOVING."""
    rows = []
    for name, load in loads.items():
        for body, sign in zip(bodies[name], (1.0, -1.0), strict=True):
            columns: dict[str, object] = {"pair": name, "on": body, "time [s]": time}
            rows.append(pd.DataFrame(columns | {column: sign * load[:, k] for k, column in enumerate(WRENCH)}))
    return pd.concat(rows, ignore_index=True)


def loads_table(loads: dict[str, Float[np.ndarray, "t 6"]], time: Float[np.ndarray, " t"]) -> pd.DataFrame:
    """A row per frame, with the six numbers of each body."""
    columns = {f"{body}_{name}": load[:, k] for body, load in loads.items() for k, name in enumerate(WRENCH)}
    return pd.DataFrame({"time [s]": time, **columns})


def counted_twice(pairs: Sequence[TouchingPair]) -> list[tuple[str, str, str, str]]:
    """Body, two pairs that have faces of it in common, and which sums have contact twice where both pairs touch there.

    Two pairs with one FIXED have its faces in common. Where they are the same two bodies in reverse, the area on one
    and that on the other are one contact if faces of both are in common. Loads are doubled where the same two bodies
    have a layer in both pairs; other bodies on the same faces press by themselves.
    """
    found = []
    for k, one in enumerate(pairs):
        for other in pairs[k + 1 :]:
            bodies = {one.moving, one.fixed} if one.moving == other.fixed else {one.fixed}
            same = {one.moving, one.fixed} == {other.moving, other.fixed}
            if not (same or one.fixed == other.fixed) or not all(_in_common(body, one, other) for body in bodies):
                continue
            loads = same and one.options.pressure and other.options.pressure
            found.append((one.fixed, one.name, other.name, "the total and loads have" if loads else "the total has"))
    return found


def _in_common(body: str, one: TouchingPair, other: TouchingPair) -> bool:
    """Whether both pairs count some face of the body."""
    counted = []
    for bodies, fixed in ((pair.bodies, pair.fixed == body) for pair in (one, other)):
        surface = bodies.fixed if fixed else bodies.moving
        mask = bodies.settings.fixed_faces if fixed else bodies.settings.moving_faces
        counted.append(np.ones(len(surface.faces), bool) if mask is None else mask)
    return bool(np.logical_and(*counted).any())
