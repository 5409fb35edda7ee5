"""Dead cells of a mat: found, told, and left as they are, left out or filled, as is asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.run_record import Record
from geocontact.data.pressure_frames import PressureFrames
from geocontact.loads.mat.dead_cells import dead_cells
from geocontact.loads.mat.fill import Hole, filled, holes

NAMED = 8  # cells in a warning; run.json has them all
MM2 = 1e6

Way = Literal["warn", "mask", "fill"]


@dataclass(frozen=True, eq=False)
class Treated:
    """Pressures after dead cells were seen to.

    Parameters
    ----------
    pressure
        [Pa]
    valid
        Cells that count.
    declared
        Cells that the layout lists as dead.
    gaps
        What was filled; empty unless asked for.
    """

    pressure: Float[np.ndarray, "t r c"]
    valid: Bool[np.ndarray, "r c"]
    declared: Bool[np.ndarray, "r c"]
    gaps: tuple[Hole, ...] = ()

    @property
    def guessed(self) -> Bool[np.ndarray, "r c"]:
        """Cells that were filled."""
        found = np.zeros(self.valid.shape, bool)
        for hole in self.gaps:
            found[hole.cell[:, 0], hole.cell[:, 1]] = True
        return found


def treated(
    record: Record,
    read: PressureFrames,
    pressure: Float[np.ndarray, "t r c"],
    declared: tuple[tuple[int, int], ...],
    way: Way,
    touched: float,
) -> Treated:
    """Dead cells by `way`: found in `read`, or `declared` in the layout, which leaves those out of `read` already.

    Only found ones are warned of; declared ones are filled too where that is asked for. `touched` [Pa] is the pressure
    from which a cell counts as loaded.
    """
    found = dead_cells(read, touched)
    listed = np.zeros_like(found)
    for row, column in declared:
        listed[row, column] = True
    if not (found | listed).any():
        return Treated(pressure, read.valid, listed)
    dead = found | listed
    gaps = holes(pressure, read.valid, dead, read.pitch)
    result = _by(way, read, pressure, found, listed, gaps)
    _tell(record, read, pressure, found, result, gaps, way)
    _warn(record, read, found, result, way)
    return result


def _by(
    way: Way,
    read: PressureFrames,
    pressure: Float[np.ndarray, "t r c"],
    found: Bool[np.ndarray, "r c"],
    listed: Bool[np.ndarray, "r c"],
    gaps: tuple[Hole, ...],
) -> Treated:
    if way == "warn":
        return Treated(pressure, read.valid, listed)
    if way == "mask":
        return Treated(pressure, read.valid & ~found, listed)
    whole = Treated(filled(pressure, gaps), read.valid & ~found, listed, gaps)
    return replace(whole, valid=whole.valid | whole.guessed)


def _tell(
    record: Record,
    read: PressureFrames,
    pressure: Float[np.ndarray, "t r c"],
    found: Bool[np.ndarray, "r c"],
    result: Treated,
    gaps: tuple[Hole, ...],
    way: Way,
) -> None:
    """run.json has every cell, and what the cells would have carried in the frame with the largest force."""
    whole = filled(pressure, gaps)
    heaviest = int(np.argmax((whole * read.cell_area).sum(axis=(1, 2))))
    dead = np.argwhere(found | result.declared).tolist()
    record.results["dead_cells"] = {
        "way": way,
        "cells": [
            {
                "row": r,
                "column": c,
                "known_by": "its readings" if found[r, c] else "the layout",
                "reads_kPa": float(read.pressure[0, r, c]) * 1e-3 if found[r, c] else None,
                "filled": bool(result.guessed[r, c]),
            }
            for r, c in dead
        ],
        "area_left_out_mm2": float(read.cell_area[(found | result.declared) & ~result.valid].sum()) * MM2,
        "force_by_filling_N": sum(float(whole[heaviest, r, c] * read.cell_area[r, c]) for r, c in dead),
        "force_as_read_N": sum(float(pressure[heaviest, r, c] * read.cell_area[r, c]) for r, c in dead),
        "filling_is_off_by_share": [round(hole.share, 6) for hole in gaps],
    }


def _warn(record: Record, read: PressureFrames, found: Bool[np.ndarray, "r c"], result: Treated, way: Way) -> None:
    alone = (found | result.declared) & ~result.guessed
    if way == "fill" and alone.any():
        record.warn(f"{int(alone.sum())} dead cells have no working cell beside them and are left out")
    if not found.any():
        return
    cells = [f"row {r} column {c} ({read.pressure[0, r, c] * 1e-3:g} kPa)" for r, c in np.argwhere(found)]
    named = ", ".join(cells[:NAMED]) + (f" and {len(cells) - NAMED} more" if len(cells) > NAMED else "")
    lost, whole = (float(read.cell_area[which].sum()) * MM2 for which in (found, read.valid))
    done = {
        "warn": "used as they read; `dead` mask leaves them out, `dead` fill takes them from their neighbours",
        "mask": f"left out, {lost:.0f} of {whole:.0f} mm²",
        "fill": "filled from their neighbours",
    }[way]
    record.warn(f"cells that never change while those around them do seem dead: {named}; {done}")
