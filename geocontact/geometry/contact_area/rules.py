"""Ways of counting a contact area, the crude ones included, because papers seldom say which they used."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.contact_area.sampled import Distances, Sampled, measure
from geocontact.geometry.surface import Surface

REFINED = "refined"  # cut along the iso-line, triangles divided until the area has settled
CLIP = "clip"  # cut along the iso-line on the triangles as given: second order
ALL_VERTICES = "all-vertices"  # whole faces, all three corners within: first order, low
ANY_VERTEX = "any-vertex"  # whole faces, any corner within: first order, high
CENTROID = "centroid"  # whole faces, centroid within: erratic
RULES = (REFINED, CLIP, ALL_VERTICES, ANY_VERTEX, CENTROID)


def counted_area(
    sampled: Sampled, other: Surface, distances: Distances, threshold: float, rule: str
) -> tuple[float, np.ndarray, float]:
    """Area [m^2] of the whole faces that a crude rule counts, its first moment (about the surface's own centre) [m^3]
    and the part on the negative side of the splitting plane [m^2].
    """
    inside = _counts(sampled, other, distances, threshold, rule)
    return (
        float(sampled.area[inside].sum()),
        sampled.moment[inside].sum(axis=0),
        float(sampled.negative[inside].sum()),
    )


def _counts(sampled: Sampled, other: Surface, d: Distances, threshold: float, rule: str) -> np.ndarray:
    if rule == CENTROID:
        middle = d.points[sampled.faces].mean(axis=1)
        return measure(other, middle, np.full(len(middle), 2.0 * threshold + 1e-12)).signed <= threshold
    corners = (d.signed <= threshold)[sampled.faces]
    if rule == ALL_VERTICES:
        return np.asarray(corners.all(axis=1))
    if rule == ANY_VERTEX:
        return np.asarray(corners.any(axis=1))
    raise ValueError(f"rule must be one of {', '.join(RULES)}, not {rule!r}")
