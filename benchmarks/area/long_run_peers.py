"""A long run against other libraries: `python -m benchmarks.area.long_run --peers`.

The knee of `benchmarks.pairs` (47 276 x 52 392 faces) through its gait cycle, interpolated to 1001 poses. geocontact
does every frame: all that `area` finds of both bodies, and, as the same work that peers do, the map of A's vertices
with its clipped area. Peers do every 50th frame, their time is scaled. Engines take turns every 50 frames, so that a
busy machine slows all of them alike; areas of each 50th frame are compared with that of libigl's distances.
"""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from jaxtyping import Float

from benchmarks.engines.all import all_engines
from benchmarks.engines.engine import Engine, Step
from benchmarks.engines.ours import FRAMES, OURS
from benchmarks.pairs import ROOT, Pair, knee
from geocontact.io.motion.poses import motion_from_csv

WARP = "warp (CPU), bounded to 4 mm + longest edge"
LIBIGL, OPEN3D = "libigl AABB", "open3d RaycastingScene"
AIMS = {LIBIGL: (FRAMES, 12.0), OPEN3D: (FRAMES, 10.0), WARP: (OURS, 1.0)}
"""Of each peer: the row of geocontact that it is compared with, and how many times as long it should take."""
SAME = 0.1
"""Per cent that areas may differ by."""


def long_pair(faces: int, frames: int) -> Pair:
    """The knee with `frames` poses spread evenly over its gait cycle, those between two recorded ones interpolated."""
    cycle = motion_from_csv(ROOT / "meshes" / "gait.csv")
    poses = cycle.at(np.linspace(cycle.time[0], cycle.time[-1], frames)).poses
    rotation = np.ascontiguousarray(poses.rotation.as_matrix().reshape(-1, 3, 3))
    translation = np.ascontiguousarray(np.asarray(poses.translation).reshape(-1, 3))
    return dataclasses.replace(knee(faces, 2), rotation=rotation, translation=translation)


def engines() -> list[Engine]:
    """The two rows of geocontact first, then the peers."""
    every = {engine.name: engine for engine in all_engines()}
    return [every[name] for name in (OURS, FRAMES, *AIMS)]


def measured(pair: Pair, rows: Sequence[Engine], every: int, say: Callable[[str], None]) -> dict[str, dict[str, Any]]:
    """CPU seconds of the run, scaled where only some frames are done, and area [m^2] of every `every`-th frame."""
    steps: dict[str, Step] = {}
    found: dict[str, dict[str, Any]] = {}
    for engine in rows:
        try:
            steps[engine.name] = engine.prepare(pair)
            steps[engine.name](0)  # trees, compilation, caches: not measured
        except (ImportError, OSError) as error:
            steps.pop(engine.name, None)
            say(f"{engine.name}: skipped, {str(error).splitlines()[0]}")
            continue
        found[engine.name] = {"cpu_s": 0.0, "frames": 0, "area": []}
    frames = len(pair.rotation)
    for first in range(0, frames, every):
        for name, step in steps.items():
            row = found[name]
            last = min(first + every, frames) if name in (OURS, FRAMES) else first + 1
            start = time.process_time()
            row["area"].append(step(first).area)
            for k in range(first + 1, last):
                step(k)
            row["cpu_s"] += time.process_time() - start
            row["frames"] += last - first
        say(f"frame {first} of {frames}")
    for row in found.values():
        row["cpu_s"] *= frames / row["frames"]
        row["area"] = np.array(row["area"])
    return found


def compared(found: Mapping[str, Mapping[str, Any]], reference: str) -> dict[str, dict[str, Any]]:
    """Of each engine CPU seconds, largest difference of an area from `reference`'s [%]; of peers the ratio and aims."""
    table: dict[str, dict[str, Any]] = {}
    for name, row in found.items():
        off = largest_difference(row["area"], found[reference]["area"])
        table[name] = {"cpu_s": row["cpu_s"], "frames_done": row["frames"], "largest_area_difference_percent": off}
        if name in AIMS:
            ours, aim = AIMS[name]
            ratio = row["cpu_s"] / found[ours]["cpu_s"]
            same = max(off, largest_difference(found[ours]["area"], found[reference]["area"])) <= SAME
            table[name] |= {"ratio_to_map_and_clip": row["cpu_s"] / found[OURS]["cpu_s"]}
            table[name] |= {"compared_with": ours, "ratio": ratio, "aim": aim, "met": bool(ratio >= aim and same)}
    return table


def largest_difference(area: Float[np.ndarray, " k"], reference: Float[np.ndarray, " k"]) -> float:
    """Largest |area - reference| over the frames, in per cent of the reference; infinite where that alone is 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.where(area == reference, 0.0, np.abs(area - reference) / reference)
    return float(100.0 * off.max())
