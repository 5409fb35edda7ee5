"""First look at all faces of a surface: which are surely within the threshold, which surely not, which need a look."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.certify import bounds
from geocontact.geometry.kernels.compile import kernel


@kernel
def sort_faces(faces, points, distance, side, slot, closest, threshold, signed, area, moment, negative):  # type: ignore[no-untyped-def]
    """Sums over the faces that lie wholly within the threshold, and the numbers of the undecided faces.

    area (m,), moment (m, 3) first moment, negative (m,) area on the negative side of the splitting plane, of whole
    faces. Returns totals (5,) = area, moment, negative, and the undecided face numbers.
    """
    totals = np.zeros(5)
    undecided = np.empty(len(faces), np.int64)
    count = 0
    corner = np.empty((3, 3))
    foot = np.empty((3, 3))
    d = np.empty(3)
    s = np.empty(3, np.int8)
    t = np.empty(3, np.int64)
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if slot[i] < 0 and slot[j] < 0 and slot[k] < 0 and side[i] > 0 and side[j] > 0 and side[k] > 0:
            continue
        for c in range(3):
            v = faces[f, c]
            d[c] = distance[v]
            s[c] = side[v]
            t[c] = slot[v]
            for x in range(3):
                corner[c, x] = points[v, x]
                foot[c, x] = closest[v, x]
        lower, upper = bounds(corner, foot, d, s, t, threshold, signed)
        if lower >= 1.0:
            totals[0] += area[f]
            totals[1] += moment[f, 0]
            totals[2] += moment[f, 1]
            totals[3] += moment[f, 2]
            totals[4] += negative[f]
        elif upper > 0.0:
            undecided[count] = f
            count += 1
    return totals, undecided[:count].copy()


@kernel
def quarter(corner):  # type: ignore[no-untyped-def]
    """Midpoints of the edges opposite to each corner, (k, 3, 3)."""
    out = np.empty_like(corner)
    for i in range(len(corner)):
        for c in range(3):
            for x in range(3):
                out[i, c, x] = 0.5 * (corner[i, (c + 1) % 3, x] + corner[i, (c + 2) % 3, x])
    return out
