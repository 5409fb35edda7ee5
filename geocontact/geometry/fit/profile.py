"""Radius as a function of flexion: circles fitted to windows of the silhouette that a component has from the side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.geometry.fit.circle import LEAST, CircleFit, fit_circle
from geocontact.geometry.plane import Plane
from geocontact.geometry.sagittal import Sagittal
from geocontact.geometry.surface import Surface

PER_WINDOW = 61  # places of the silhouette that a circle is fitted to
FILLED = 0.8  # share of them that must be there


@dataclass(frozen=True, eq=False)
class SagittalProfile:
    """Crest of a condyle and the radius of its sagittal outline, by flexion angle; NaN where there is no face.

    Parameters
    ----------
    angle
        Flexion angle of the place, about the axis [rad].
    crest
        Point of the patch farthest from the axis at that angle [m].
    radius, rms
        Of the circle fitted to the outline within half a window to either side [m].
    half_width
        Half the 95 % interval of the radius [m].
    centre
        Of the circle, at the height of the crest [m].
    normal
        Angle at which the outward normal of the circle points there [rad]: the flexion at which a flat plateau that
        faces 0 touches this place. It equals `angle` where the axis is the centre of the circle.
    """

    angle: Float[np.ndarray, " k"]
    crest: Float[np.ndarray, "k 3"]
    radius: Float[np.ndarray, " k"]
    half_width: Float[np.ndarray, " k"]
    rms: Float[np.ndarray, " k"]
    centre: Float[np.ndarray, "k 3"]
    normal: Float[np.ndarray, " k"]


def sagittal_profile(
    surface: Surface,
    chosen: Bool[np.ndarray, " m"] | None,
    sagittal: Sagittal,
    angle: Float[np.ndarray, " k"],
    window: float,
    side: tuple[Plane, int] | None = None,
) -> SagittalProfile:
    """Radius of the outline at each angle.

    A condyle is curved across as well, so a cylinder through all of its faces mixes two radii. The outline (the crest,
    farthest from the axis at each angle) has the sagittal one alone, as the section of a torus through its crown has.

    Parameters
    ----------
    surface, chosen
        The component, and the faces that count (None: all).
    sagittal
        Flexion axis and where 0 and 90 degrees are.
    angle
        Angles to tell the radius at [rad].
    window
        Angle about the axis over which a circle is fitted [rad]; where the radius changes within it, the circle has one
        between. The error where it changes smoothly goes with the square of the window.
    side
        Plane and -1 or 1: only points on the negative or positive side of it.
    """
    edges = _edges(surface, chosen)
    here = crest(edges, sagittal, angle, side)
    step = window / PER_WINDOW
    along = np.arange(angle.min() - 0.5 * window + 0.5 * step, angle.max() + 0.5 * window, step)
    outline = crest(edges, sagittal, along, side)
    there = np.isfinite(outline[:, 0])
    radius, half, rms, normal = np.full((4, len(angle)), np.nan)
    centre = np.full((len(angle), 3), np.nan)
    for k, middle in enumerate(angle):
        near = there & (np.abs(along - middle) <= 0.5 * window)
        if near.sum() < max(LEAST, FILLED * PER_WINDOW) or not np.isfinite(here[k, 0]):
            continue
        fit = fit_circle(np.ascontiguousarray(outline[near, :2]))
        radius[k], half[k], rms[k] = fit.radius, fit.quality.half_widths[-1], _rms(fit)
        centre[k] = [*fit.centre, here[k, 2]]
        normal[k] = np.arctan2(here[k, 1] - fit.centre[1], here[k, 0] - fit.centre[0])
    return SagittalProfile(angle, sagittal.placed(here), radius, half, rms, sagittal.placed(centre), normal)


def crest(
    edges: Float[np.ndarray, "e 2 3"],
    sagittal: Sagittal,
    angle: Float[np.ndarray, " k"],
    side: tuple[Plane, int] | None = None,
) -> Float[np.ndarray, "k 3"]:
    """Point of the edges farthest from the axis in the half-plane at each angle, local coordinates; NaN where none is.

    A half-plane cuts a triangle along a segment, whose farthest end lies on an edge: the crest is exact for the mesh.
    """
    found = np.full((len(angle), 3), np.nan)
    first, second = (sagittal.local(edges[:, end]) for end in (0, 1))
    for k, (c, s) in enumerate(zip(np.cos(angle), np.sin(angle), strict=True)):
        off = [c * end[:, 1] - s * end[:, 0] for end in (first, second)]
        cut = np.flatnonzero((off[0] <= 0.0) != (off[1] <= 0.0))
        share = (off[0][cut] / (off[0][cut] - off[1][cut]))[:, None]
        points = first[cut] + share * (second[cut] - first[cut])
        out = points[:, 0] * c + points[:, 1] * s
        counts = out > 0.0
        if side is not None:
            counts &= side[0].height(sagittal.placed(points)) * side[1] >= 0.0
        if counts.any():
            found[k] = points[int(np.argmax(np.where(counts, out, -np.inf)))]
    return found


def _edges(surface: Surface, chosen: Bool[np.ndarray, " m"] | None) -> Float[np.ndarray, "e 2 3"]:
    """Ends of the edges of the chosen faces, each edge once [m]."""
    faces = surface.faces if chosen is None else surface.faces[chosen]
    pairs = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.asarray(surface.vertices[np.unique(pairs, axis=0)])


def _rms(fit: CircleFit) -> float:
    return float(np.sqrt(np.mean(fit.quality.residual**2)))
