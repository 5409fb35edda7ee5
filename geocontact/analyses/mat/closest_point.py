"""What the plain way would have given beside the drape: a flat mat, every corner put onto its closest point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placed import PlacedMat, mat_and_marks
from geocontact.analyses.run_record import Record
from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.closest_point import project
from geocontact.geometry.drape.geodesics import Geodesics
from geocontact.loads.mat.load import MatLoad, mat_load
from geocontact.loads.mat.map import MatMap, mat_map

MM = 1e3
HERE = "closest_point_projection"


@dataclass(frozen=True, eq=False)
class ClosestPoint:
    """The same mat as the closest points would have laid it.

    Parameters
    ----------
    drape
        Cells on their closest points.
    used, projected
        Loads of the mat as it is laid, and of this one; both about the origin of the scan, in its axes.
    """

    drape: Drape
    used: MatLoad
    projected: MatLoad

    @property
    def frame(self) -> int:
        """Where the ways are put beside each other: the frame with the largest force."""
        return int(np.argmax(self.used.pressing))

    @property
    def distortion(self) -> Float[np.ndarray, "r c"]:
        """Area of each cell of the grid over that of the flat cell, minus 1; so -1 where it is not on the scan."""
        return np.where(self.drape.covered, self.drape.distortion, -1.0)


def closest_point(record: Record, p: PlacedMat, frames: PressureFrames, o: MatOptions) -> ClosestPoint | None:
    """The same marks and pressures on a mat that is pushed down flat; how it differs goes to the record.

    None where the mat is laid that way, or where it cannot be: two marks do not place a flat mat.
    """
    if o.lay == "closest":
        return None
    mat, marks = mat_and_marks(frames, p.landmarks, o)
    try:
        flat = project(Geodesics(p.surface), mat, marks)
        there = mat_map(p.surface, flat.nodes, frames.valid & flat.covered, frames.cell_area)
    except ValueError as error:
        record.results[HERE] = {"not_possible": str(error)}
        return None
    used, projected = (_load(p, each, frames, o) for each in (p.cells, there))
    found = ClosestPoint(flat, used, projected)
    _tell(record, found, frames)
    return found


def _load(p: PlacedMat, cells: MatMap, frames: PressureFrames, o: MatOptions) -> MatLoad:
    """In the frame of the scan, about its origin: differences are the same in any frame."""
    return mat_load(cells, cells.of(frames.pressure), np.zeros(3), p.surface.name, o.gate)


def _tell(record: Record, found: ClosestPoint, frames: PressureFrames) -> None:
    at, flat = found.frame, found.drape
    force = np.linalg.norm(found.projected.wrench.force - found.used.wrench.force, axis=1)
    centre = np.linalg.norm(found.projected.centre - found.used.centre, axis=1) * MM
    known = np.abs(flat.distortion[flat.covered & frames.valid])
    record.results[HERE] = {
        "area_distortion_largest": float(known.max()),
        "area_distortion_rms": float(np.sqrt(np.mean(known**2))),
        "uncovered_cells": int((frames.valid & ~flat.covered).sum()),
        "force_differs_N": float(force[at]),
        "force_differs_at_most_N": float(force.max()),
        "centre_of_pressure_differs_mm": float(centre[at]) if np.isfinite(centre[at]) else None,
        "centre_of_pressure_differs_at_most_mm": float(np.nanmax(centre)) if np.isfinite(centre).any() else None,
    }
