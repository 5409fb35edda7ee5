"""A mat beside the same mat as closest points would have laid it: how far force and centre of pressure are apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.closest_point import project
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Geodesics
from geocontact.geometry.surface import Surface
from geocontact.loads.mat_load import MatLoad, mat_load
from geocontact.loads.mat_map import MatMap, mat_map


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

    @property
    def force_apart(self) -> Float[np.ndarray, " t"]:
        """Length of the difference of both forces [N]."""
        return np.asarray(np.linalg.norm(self.projected.wrench.force - self.used.wrench.force, axis=1))

    @property
    def centre_apart(self) -> Float[np.ndarray, " t"]:
        """Distance of both centres of pressure [m]; NaN where one is below the gate."""
        return np.asarray(np.linalg.norm(self.projected.centre - self.used.centre, axis=1))


def beside_closest_point(
    surface: Surface, mat: Mat, marks: Marks, cells: MatMap, frames: PressureFrames, gate: float = 0.0
) -> ClosestPoint:
    """The same marks and pressures on a mat that is pushed down flat (`project`), beside the mat as it is laid.

    Parameters
    ----------
    surface
        That both lie on; its frame is that of both loads.
    mat, marks
        The flat mat, and where its places were seen [m]; ValueError for fewer than three, which do not place it, and
        where no cell reaches the surface.
    cells
        The mat as it is laid.
    frames
        Pressures [Pa], working cells and their areas.
    gate
        Pressing [N] below which there is no centre of pressure.
    """
    flat = project(Geodesics(surface), mat, marks)
    there = mat_map(surface, flat.nodes, frames.valid & flat.covered, frames.cell_area)
    used, projected = (
        mat_load(each, each.of(frames.pressure), np.zeros(3), surface.name, gate) for each in (cells, there)
    )
    return ClosestPoint(flat, used, projected)
