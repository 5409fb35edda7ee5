"""Rows as markdown and as JSON."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.area.measure import Row
from benchmarks.engines.ours import OURS
from benchmarks.pairs import Pair
from benchmarks.whole_command import Whole

HEAD = (
    "engine",
    "frames done",
    "µs / unbounded query",
    "map [s]",
    "map + area [s]: min",
    "median",
    "wall [s]",
    "÷ ours",
    "goal",
    "max distance error [mm]",
    "area error [%]",
)


def markdown(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def speed_table(pair: Pair, rows: Sequence[Row]) -> str:
    """CPU seconds of the whole job; ratios are medians over rounds."""
    ours = next(row for row in rows if row.engine.name == OURS)
    return markdown(HEAD, [_cells(pair, row, ours) for row in rows])


def _cells(pair: Pair, row: Row, ours: Row) -> list[str]:
    engine, t = row.engine, len(pair.rotation)
    if row.skipped:
        return [engine.name, f"skipped: {row.skipped}", *[""] * (len(HEAD) - 2)]
    bounded = np.isfinite(engine.bound(pair))
    done = f"{row.frames} of {t}" + (f", {engine.points} vertices, map only" if engine.points else "")
    done += f", {engine.note}" if engine.note else ""
    mapped = float(np.median(row.map_cpu))
    return [
        engine.name,
        done + (", scaled" if engine.every > 1 else ""),
        "" if bounded else f"{1e6 * mapped / (t * len(pair.moving.vertices)):.3g}",
        f"{mapped:.3g}" if mapped > 0.0 else "",
        f"{min(row.cpu):.3g}",
        f"{np.median(row.cpu):.3g}",
        f"{np.median(row.wall):.3g}",
        f"{row.ratio(ours):.3g}",
        "" if engine.goal is None else f"≥ {engine.goal:g}",
        f"{1e3 * row.distance_error:.1e}",
        "" if np.isnan(row.area_error) else f"{100 * row.area_error:.1e}",
    ]


def whole_table(whole: Whole, ours: Row, both: Row, rows: Sequence[Row]) -> str:
    """The whole command beside what peers need for the map of one body and its clipped area alone."""
    head = ("", "CPU [s]: min", "median", "÷ map + clip of one body", "of both bodies")
    one, two, all_ = (float(np.median(each)) for each in (ours.cpu, both.cpu, whole.all))
    cells = [["whole `area` command", f"{min(whole.all):.3g}", f"{all_:.3g}", f"{all_ / one:.3g}", f"{all_ / two:.3g}"]]
    for name, seconds in whole.parts.items():
        middle = float(np.median(seconds))
        cells.append(
            [f"  of it {name}", f"{min(seconds):.3g}", f"{middle:.3g}", f"{middle / one:.3g}", f"{middle / two:.3g}"]
        )
    for row in rows:
        if row.cpu and row.engine.package != "geocontact":
            middle = float(np.median(row.cpu))
            cells.append(
                [f"{row.engine.name}, map + clip of one body ÷ whole command", "", f"{middle / all_:.3g}", "", ""]
            )
    return markdown(head, cells)


def memory_table(peaks: dict[str, float]) -> str:
    """Peak resident memory of each engine's own process."""
    bare = peaks.get("", np.nan)
    rows = [[name or "(the pair alone)", f"{p:.0f}", f"{p - bare:.0f}" if name else ""] for name, p in peaks.items()]
    return markdown(("engine", "peak [MB]", "above the pair alone [MB]"), rows)


def record(pair: Pair, rows: Sequence[Row]) -> list[dict[str, object]]:
    """Every round of every row."""
    ours = next(row for row in rows if row.engine.name == OURS)
    return [
        {
            "engine": row.engine.name,
            "skipped": row.skipped,
            "frames_done": row.frames,
            "bound_m": None if np.isinf(row.engine.bound(pair)) else row.engine.bound(pair),
            "cpu_s": row.cpu,
            "wall_s": row.wall,
            "map_cpu_s": row.map_cpu,
            "ratio_to_ours": row.ratio(ours) if row.cpu else None,
            "goal": row.engine.goal,
            "max_distance_error_m": None if np.isnan(row.distance_error) else row.distance_error,
            "relative_area_error": None if np.isnan(row.area_error) else row.area_error,
        }
        for row in rows
    ]
