"""The sample total knee at a named resolution: fixed tibial insert and moving femoral component (synthetic, mm)."""

from __future__ import annotations

import numpy as np

from meshes.femoral_component import Grid, femoral_component
from meshes.solids import mirrored
from meshes.stl import snapped
from meshes.tibial_insert import tibial_insert

RESOLUTIONS = {"coarse": 1.0, "medium": 2.0, "fine": 3.7, "finest": 7.5}
"""Cells per edge relative to the coarse mesh: about 3.5e3, 1.4e4, 5e4 and 2e5 faces on each body."""

Body = tuple[np.ndarray, np.ndarray]
"""Vertices [mm] (n, 3) and faces (m, 3)."""


def total_knee(refinement: float, side: str = "right") -> tuple[Body, Body]:
    """Insert (frame T) and femoral component (frame F), faces growing with the square of `refinement`.

    The left knee is the right one reflected in z = 0; in both, z points to the subject's right.
    """
    bodies = (
        tibial_insert(max(2, round(16 * refinement)), max(1, round(4 * refinement))),
        femoral_component(Grid().refined(refinement)),
    )
    insert, femoral = (mirrored(*body) if side == "left" else body for body in bodies)
    return (snapped(insert[0]), insert[1]), (snapped(femoral[0]), femoral[1])
