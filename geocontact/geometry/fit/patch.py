"""A part of a surface that a shape is fitted to, and the fit of that part and of its sides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.geometry.fit.found import ShapeFit
from geocontact.geometry.fit.profile import SagittalProfile
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface


@dataclass(frozen=True, eq=False)
class Patch:
    """Part of a surface that a shape is fitted to.

    Parameters
    ----------
    surface
        In its own frame [m].
    faces
        Marks those that count.
    at_vertices
        Whether the shape is fitted to the vertices of these faces; to their middles otherwise.
    split, medial
        Plane that parts two sides, and the sign of the heights above it that are medial; None and 0 without.
    """

    surface: Surface
    faces: Bool[np.ndarray, " m"]
    at_vertices: bool
    split: Plane | None
    medial: int

    @property
    def points(self) -> Float[np.ndarray, "n 3"]:
        """What the shape is fitted to [m]."""
        if self.at_vertices:
            return np.asarray(self.surface.vertices[self.vertices])
        return np.asarray(self.surface.vertices[self.surface.faces[self.faces]].mean(axis=1))

    @property
    def vertices(self) -> Bool[np.ndarray, " n"]:
        """Vertices of the faces that count."""
        used = np.zeros(len(self.surface.vertices), bool)
        used[self.surface.faces[self.faces]] = True
        return used

    @property
    def sides(self) -> Mapping[str, tuple[Plane, int]]:
        """Plane and side of it by name; empty without a split."""
        if self.split is None:
            return {}
        return {"medial": (self.split, self.medial), "lateral": (self.split, -self.medial)}


@dataclass(frozen=True, eq=False)
class Fitting:
    """A shape fitted to a patch.

    Parameters
    ----------
    patch
        What it is fitted to.
    whole, sides
        Shape of all of it, and of each side; no sides without a split.
    profiles
        Radius over flexion, by side.
    """

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
        area = self.patch.surface.face_area[self.patch.faces]
        return "convex" if float(np.sign(looks(self.patch, self.whole)) @ area) >= 0.0 else "concave"


def looks(patch: Patch, fit: ShapeFit) -> Float[np.ndarray, " k"]:
    """Cosine between the normal of each face that counts and the way away from the centre, or from the axis."""
    surface, faces = patch.surface, patch.faces
    way = surface.vertices[surface.faces[faces]].mean(axis=1) - fit.point
    if fit.axis is not None:
        way = way - (way @ fit.axis)[:, None] * fit.axis
    size = np.maximum(np.linalg.norm(way, axis=1), np.finfo(float).tiny)
    return np.asarray(np.einsum("ij,ij->i", way, surface.face_normal[faces]) / size)
