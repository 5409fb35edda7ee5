"""What a fit finds: the shape of the whole patch and of its sides, and the radius over flexion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.shape.patch import Patch
from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.profile import SagittalProfile


@dataclass(frozen=True, eq=False)
class Fitting:
    """A patch, the shape fitted to all of it and to its sides, and its profiles, both by side."""

    patch: Patch
    whole: ShapeFit
    sides: Mapping[str, ShapeFit]
    profiles: Mapping[str, SagittalProfile]

    @property
    def residual(self) -> Float[np.ndarray, " n"]:
        """Signed distance of every vertex of the surface to the shape [m]; NaN off the patch."""
        return np.where(self.patch.vertices, self.whole.distance(self.patch.surface.vertices), np.nan)

    @property
    def facing(self) -> str | None:
        """Whether the faces look away from the centre of curvature, by area: convex or concave; None for a plane."""
        if self.whole.radius is None:
            return None
        surface, faces = self.patch.surface, self.patch.faces
        way = surface.vertices[surface.faces[faces]].mean(axis=1) - self.whole.point
        if self.whole.axis is not None:
            way = way - (way @ self.whole.axis)[:, None] * self.whole.axis
        looks = np.einsum("ij,ij->i", way, surface.face_normal[faces])
        return "convex" if float(np.sign(looks) @ surface.face_area[faces]) >= 0.0 else "concave"
