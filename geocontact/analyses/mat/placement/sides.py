"""Which side of the mat, and which side of the scan: what landmarks and shape can tell of it, and what they cannot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks

HOLLOW = -0.1
"""Mean cosine between the cells' normals and their directions from the middle of the mat; -1 inside a ball."""


def outwards(surface: Surface, o: MatOptions) -> Surface:
    """The scan with its faces turned over where `inwards` says that they look into the body."""
    if not o.inwards:
        return surface
    if surface.closed:
        raise InputError("", "`inwards`", "has no effect on a closed scan: its sides are known", "leave it out")
    return replace(surface, faces=np.ascontiguousarray(surface.faces[:, ::-1]))


def say_which_side(record: Record, surface: Surface, laid: Drape, marks: MatLandmarks, o: MatOptions) -> None:
    """Warn where landmarks cannot show the side, and where an open scan looks as if it were seen from inside."""
    arms = marks.place - marks.place.mean(axis=0)
    if o.landmarks is not None and np.linalg.matrix_rank(arms, 1e-6 * float(np.abs(arms).max())) < 2:
        record.warn(
            f"the landmarks lie on one line of the mat: they do not show which side of it faces the body, and "
            f"`seen_from` {o.seen_from} is believed"
        )
    if not surface.closed and _bulge(laid) < HOLLOW:
        record.warn(
            "the scan is hollow under the mat, as its faces look: if they look into the body, every force has the "
            "wrong sign; pass `inwards` then"
        )


def _bulge(laid: Drape) -> float:
    """How much the cells' normals point away from the middle of the mat: 1 on a ball, 0 on a plane, -1 in a bowl."""
    inside = laid.covered
    centre = laid.centre[inside]
    arm = centre - centre.mean(axis=0)
    size = float(np.linalg.norm(arm, axis=-1).sum())
    return float(np.einsum("ij,ij->", arm, laid.normal[inside])) / size if size > 0.0 else 0.0
