"""Shapes that can be fitted, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

from geocontact.geometry.fit.cylinder import fit_cylinder
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.plane import fit_plane
from geocontact.geometry.fit.sphere import fit_sphere

SHAPES: Mapping[str, Callable[[Float[np.ndarray, "n 3"], bool], ShapeFit]] = {
    "cylinder": fit_cylinder,
    "sphere": fit_sphere,
    "plane": fit_plane,
}
