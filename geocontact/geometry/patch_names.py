"""What a condition on faces may speak of beside places and normals: an axis or a centre, flexion, another body."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from jaxtyping import Float

from geocontact.geometry.sagittal import Sagittal, Vector
from geocontact.geometry.surface import Surface

Values = Callable[[], Float[np.ndarray, " m"]]


def about(
    surface: Surface, point: Vector, along: Vector | None = None, metres_per_unit: float = 1.0
) -> Mapping[str, Values]:
    """`radial`, distance of a face's centroid from an axis (a point if not `along`), and `outward`.

    `outward` is the cosine between the face's normal and the way from there: the bearing surface of a condyle and the
    back of a cup look outwards (near 1), a box for the bone and the cavity of a cup inwards (near -1).
    """

    def offset() -> Float[np.ndarray, "m 3"]:
        way = _centroids(surface) - np.asarray(point)
        if along is None:
            return np.asarray(way)
        unit = np.asarray(along, float) / np.linalg.norm(along)
        return np.asarray(way - (way @ unit)[:, None] * unit)

    def radial() -> Float[np.ndarray, " m"]:
        return np.asarray(np.linalg.norm(offset(), axis=1) / metres_per_unit)

    def outward() -> Float[np.ndarray, " m"]:
        way = offset()
        size = np.maximum(np.linalg.norm(way, axis=1), 1e-300)
        return np.asarray(np.einsum("ij,ij->i", way, surface.face_normal) / size)

    return {"radial": radial, "outward": outward}


def about_flexion(surface: Surface, sagittal: Sagittal) -> Mapping[str, Values]:
    """`flexion`, angle at which a face's centroid lies [deg]."""
    return {"flexion": lambda: np.degrees(sagittal.angle(_centroids(surface)))}


def about_other(surface: Surface, other: Surface, metres_per_unit: float = 1.0) -> Mapping[str, Values]:
    """`distance` of a face's centroid to another body, negative inside a closed one."""
    return {"distance": lambda: np.asarray(other.proximity(_centroids(surface)).distance / metres_per_unit)}


def _centroids(surface: Surface) -> Float[np.ndarray, "m 3"]:
    return np.asarray(surface.vertices[surface.faces].mean(axis=1))
