"""Compile or load every kernel on a problem of two tetrahedra."""

from __future__ import annotations

from functools import cache

import numpy as np

from geocontact.geometry.contact_area.evolution import ContactPair, Settings
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface


@cache
def warm_up() -> None:
    """Run a small overlap and a gap, so that kernels are compiled (once on a machine) or loaded before time counts.

    Once in a process is enough.
    """
    vertices = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) * 1e-2
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    tetrahedron = Surface(vertices, faces, "tetrahedron")
    split = Plane.across("x", 1e-3)
    settings = Settings(thresholds=(1e-3,), sensitivity=(1e-3,), split=split, medial_side=1)
    pair = ContactPair(tetrahedron, tetrahedron, settings)
    for shift in (1e-3, 2e-2):
        pair.at(np.eye(3), np.full(3, shift))
