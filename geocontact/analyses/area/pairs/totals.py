"""What several pairs have together: areas and least distances by pair with their sums, and the loads on each body."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.contact import MotionResult
from geocontact.analyses.area.pairs.bodies import TouchingBodies, TouchingPair
from geocontact.data.evolution import MM, MM2


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


def body_loads(pairs: TouchingBodies, motions: Sequence[MotionResult]) -> dict[str, Float[np.ndarray, "t 6"]]:
    """Force [N] and moment about the common frame's origin [N m] that contacts put on each body, in that frame.

    A pair's load F, M on FIXED (about FIXED's origin, in its frame) is R F and R M + t x R F with the pose R, t of
    FIXED; MOVING bears the opposite. Bodies of no pair with a layer are not among them.
    """
    found: dict[str, Float[np.ndarray, "t 6"]] = {}
    for pair, one in zip(pairs.pairs, motions, strict=True):
        if one.pressure is None:
            continue
        pose = pairs.poses(pair.fixed)
        wrenches = [load.wrench.moved_to(np.zeros(3)) for load in one.pressure.loads]
        force = pose.rotation.apply([each.force for each in wrenches])
        moment = pose.rotation.apply([each.moment for each in wrenches]) + np.cross(pose.translation, force)
        load = np.hstack([force, moment])
        for body, sign in ((pair.fixed, 1.0), (pair.moving, -1.0)):
            found[body] = found.get(body, np.zeros_like(load)) + sign * load
    return found


def loads_table(loads: dict[str, Float[np.ndarray, "t 6"]], time: Float[np.ndarray, " t"]) -> pd.DataFrame:
    """A row per frame, with the six numbers of each body."""
    names = [f"{kind}{axis} [{unit}]" for kind, unit in (("f", "N"), ("m", "N m")) for axis in "xyz"]
    columns = {f"{body}_{name}": load[:, k] for body, load in loads.items() for k, name in enumerate(names)}
    return pd.DataFrame({"time [s]": time, **columns})


def counted_twice(pairs: Sequence[TouchingPair]) -> list[tuple[str, str, str]]:
    """Body and two pairs that have a face of it in common, on which the sum of the areas would count contact twice."""
    found = []
    for k, one in enumerate(pairs):
        for other in pairs[k + 1 :]:
            if one.fixed != other.fixed:
                continue
            every = np.ones(len(one.bodies.fixed.faces), bool)
            masks = [each.bodies.settings.fixed_faces for each in (one, other)]
            if np.logical_and(*(every if mask is None else mask for mask in masks)).any():
                found.append((one.fixed, one.name, other.name))
    return found
