"""Interleaved repeated runs of the job and the check of every answer against libigl."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from benchmarks.engines import libigl
from benchmarks.engines.clip import clipped_area
from benchmarks.engines.engine import Engine, Step, sample
from benchmarks.pairs import THRESHOLD, Pair

CHECKED = 5
"""Frames, spread over the motion, whose answers are compared with the reference."""


@dataclass
class Row:
    """Seconds for the whole job, one entry per round; errors in m and relative to the area."""

    engine: Engine
    frames: int
    skipped: str = ""
    cpu: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)
    map_cpu: list[float] = field(default_factory=list)
    distance_error: float = np.nan
    area_error: float = np.nan

    def ratio(self, ours: Row) -> float:
        """Median over the rounds of this engine's CPU time over ours in the same round."""
        return float(np.median(np.array(self.cpu) / np.array(ours.cpu)))


def measured(pair: Pair, engines: Sequence[Engine], rounds: int, say: Callable[[str], None]) -> list[Row]:
    """All engines in one process, turn by turn, so that a busy machine slows all of them alike."""
    rows, steps = [], {}
    for engine in engines:
        row = Row(engine, len(pair.rotation[:: engine.every]))
        rows.append(row)
        try:
            step = engine.prepare(pair)
            step(0)  # trees, compilation, caches: not measured
        except (ImportError, OSError) as error:
            row.skipped = str(error).splitlines()[0]
            say(f"{engine.name}: skipped, {row.skipped}")
            continue
        steps[engine.name] = step
        row.distance_error, row.area_error = errors(pair, engine, step)
        say(f"{engine.name}: ready, distance error {1e3 * row.distance_error:.1e} mm")
    for turn in range(rounds):
        for row in rows:
            if row.engine.name in steps:
                _run(pair, row, steps[row.engine.name])
        say(f"round {turn + 1} of {rounds} done")
    return rows


def _run(pair: Pair, row: Row, step: Step) -> None:
    cpu, wall, mapped = time.process_time(), time.perf_counter(), 0.0
    for k in range(0, len(pair.rotation), row.engine.every):
        mapped += step(k).map_seconds
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    scale = len(pair.rotation) / row.frames
    if row.engine.points:
        scale *= len(pair.moving.vertices) / row.engine.points
    row.cpu.append(cpu * scale)
    row.wall.append(wall * scale)
    row.map_cpu.append(mapped * scale)


def errors(pair: Pair, engine: Engine, step: Step) -> tuple[float, float]:
    """Largest error of a distance within the engine's bound [m], and of the clipped area relative to the exact clip."""
    reference = libigl.build(pair)
    chosen = sample(pair, engine.points)
    worst, off = 0.0, 0.0
    for k in np.linspace(0, len(pair.rotation) - 1, 1 if engine.points else CHECKED).astype(int):
        truth = reference(pair.moved(k))
        area = clipped_area(pair.moving.faces, pair.moving.face_area, truth, THRESHOLD)
        frame = step(int(k))
        asked = truth[chosen] <= engine.bound(pair) * (1.0 - 1e-5)
        difference = np.abs(np.abs(engine.distances(frame)) - truth[chosen])[asked]
        worst = max(worst, float(difference.max(initial=0.0)))
        off = max(off, abs(frame.area - area) / area) if np.isfinite(frame.area) else np.nan
    return worst, off
