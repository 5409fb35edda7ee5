"""What the plain way would have given beside the drape: a flat mat, every corner put onto its closest point."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.mat.write import Beside, Result
from geocontact.analyses.run_record import Record
from geocontact.cli.mat import MatOptions
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.closest_point import project
from geocontact.geometry.drape.geodesics import Geodesics
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.loads.mat.load import MatLoad, mat_load
from geocontact.loads.mat.map import MatMap, mat_map
from geocontact.view.page.content import Table

MM = 1e3
HERE = "closest_point_projection"


def projection_beside(record: Record, r: Result, o: MatOptions) -> Beside | None:
    """The same marks and pressures on a mat laid by `--lay closest`; its differences from the drape go to run.json.

    None where the mat is laid that way, or where it cannot be: two marks do not place a flat mat.
    """
    if o.lay == "closest":
        return None
    frames = r.seen.frames
    mat = Mat(frames.rows, frames.columns, frames.pitch, mirrored=o.seen_from == "body")
    try:
        flat = project(Geodesics(r.surface), mat, Marks(r.marks.place, r.marks.point, r.marks.name))
        there = mat_map(r.surface, flat.nodes, frames.valid & flat.covered, frames.cell_area)
    except ValueError as error:
        record.results[HERE] = {"not_possible": str(error)}
        return None
    draped, projected = (_load(r, each, o) for each in (r.map, there))
    at = int(np.argmax(draped.pressing))
    force = np.linalg.norm(projected.wrench.force - draped.wrench.force, axis=1)
    centre = np.linalg.norm(projected.centre - draped.centre, axis=1)
    known = [np.abs(each.distortion[each.covered & frames.valid]) for each in (r.laid, flat)]
    record.results[HERE] = {
        "area_distortion_largest": float(known[1].max()),
        "area_distortion_rms": float(np.sqrt(np.mean(known[1] ** 2))),
        "uncovered_cells": int((frames.valid & ~flat.covered).sum()),
        "force_differs_N": float(force[at]),
        "force_differs_at_most_N": float(force.max()),
        "centre_of_pressure_differs_mm": _or_none(centre[at] * MM),
        "centre_of_pressure_differs_at_most_mm": _or_none(np.nanmax(centre) * MM)
        if np.isfinite(centre).any()
        else None,
    }
    return Beside(np.where(flat.covered, flat.distortion, -1.0), _table(r, flat, draped, projected, at))


def _load(r: Result, placed: MatMap, o: MatOptions) -> MatLoad:
    """In the frame of the scan, about its origin: differences are the same in any frame."""
    return mat_load(placed, placed.of(r.seen.frames.pressure), np.zeros(3), r.surface.name, o.gate)


def _or_none(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _table(r: Result, flat: Drape, draped: MatLoad, projected: MatLoad, at: int) -> Table:
    rows = [
        ("area of a cell, largest change", *(f"{_largest(r, each):.1%}" for each in (r.laid, flat))),
        ("cells beside the scan", *(str(int((r.seen.frames.valid & ~each.covered).sum())) for each in (r.laid, flat))),
        *(
            (f"force {axis} [N]", *(f"{each.wrench.force[at, k]:.2f}" for each in (draped, projected)))
            for k, axis in enumerate("xyz")
        ),
        *(
            (f"centre of pressure {axis} [mm]", *(f"{each.centre[at, k] * MM:.1f}" for each in (draped, projected)))
            for k, axis in enumerate("xyz")
        ),
    ]
    title = f"Laid along the surface, and pushed straight down (frame {at + 1}, axes of the scan)"
    return Table(title, ("", "along the surface (used)", "closest points"), rows)


def _largest(r: Result, laid: Drape) -> float:
    return float(np.abs(laid.distortion[laid.covered & r.seen.frames.valid]).max())
