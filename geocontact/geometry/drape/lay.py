"""Laying a mat onto a surface so that its cells keep their size."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.drape.anchor import anchored
from geocontact.geometry.drape.cells import Drape, measured
from geocontact.geometry.drape.geodesics import Geodesics
from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.positions import between
from geocontact.geometry.drape.relax import relaxed
from geocontact.geometry.drape.spread import Anchor, Way, spread


def lay(geodesics: Geodesics, mat: Mat, at: Marks | Anchor, belt: Way | None = None, settle: bool = True) -> Drape:
    """The mat on the surface: spread along straightest lines from its middle, then evened out; marks hold it there.

    Parameters
    ----------
    at
        Two marks or more of the mat on the body, or where its middle lies and which way its rows run.
    belt
        The direction of the mat that goes once around the body and meets itself; its end is put onto its beginning.
        None: the mat has two ends, which may lie on each other on a thin body; such cells are reported as folded.
    settle
        Whether the spread mat is evened out. Where the surface can be laid flat there is nothing to even out.
    """
    spine: Way = _spine(mat, belt)
    anchor = at if isinstance(at, Anchor) else anchored(geodesics, mat, at, spine)
    if not anchor.place.on[0]:
        raise ValueError("the middle of the mat is not on the surface")
    row, column = np.arange(mat.rows + 1.0), np.arange(mat.columns + 1.0)
    ahead = (row - mat.middle[0]) * mat.pitch[0]
    aside = (column - mat.middle[1]) * mat.pitch[1]
    nodes = spread(geodesics, anchor, mat, ahead, aside, spine)
    if settle or belt:
        nodes = relaxed(geodesics, mat, nodes, belt, at if isinstance(at, Marks) else None)
    misses = None
    if isinstance(at, Marks):
        misses = np.linalg.norm(between(nodes, at.cells) - at.points, axis=1)
    return measured(geodesics, mat, nodes, misses)


def _spine(mat: Mat, belt: Way | None) -> Way:
    """Ribs are the short side of the mat, where they drift apart least; those of a belt go around."""
    if belt is not None:
        return "columns" if belt == "rows" else "rows"
    return "rows" if mat.rows * mat.pitch[0] >= mat.columns * mat.pitch[1] else "columns"
