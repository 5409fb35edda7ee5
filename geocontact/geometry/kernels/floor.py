"""Which triangles can hold a point with a signed distance below a given one."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import kernel


@kernel
def promising(faces, points, closest, signed, bar):
    """Faces that may reach below `bar` and, for each, a value that no point of it is below.

    signed (n,) is infinite beyond a point's limit, and such a point is outside by more than any edge at it.
    """
    keep = np.empty(len(faces), np.int64)
    floors = np.empty(len(faces))
    count = 0
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        e0 = _apart(points, j, k)
        e1 = _apart(points, k, i)
        e2 = _apart(points, i, j)
        low = max(
            signed[i] - max(e1, e2),
            signed[j] - max(e2, e0),
            signed[k] - max(e0, e1),
        )  # 1-Lipschitz
        if low >= bar:
            continue
        # the distance to one point of the other surface is convex, so its largest value is at a corner
        depth = min(_farthest(points, closest, i, j, k, i), _farthest(points, closest, i, j, k, j))
        depth = min(depth, _farthest(points, closest, i, j, k, k))
        low = max(low, -depth)
        if low < bar:
            keep[count] = f
            floors[count] = low
            count += 1
    return keep[:count].copy(), floors[:count].copy()


@kernel
def _apart(points, i, j):
    return np.sqrt(
        (points[i, 0] - points[j, 0]) ** 2 + (points[i, 1] - points[j, 1]) ** 2 + (points[i, 2] - points[j, 2]) ** 2
    )


@kernel
def _farthest(points, closest, i, j, k, foot):
    far2 = 0.0
    for v in (i, j, k):
        d2 = 0.0
        for x in range(3):
            d2 += (points[v, x] - closest[foot, x]) ** 2
        far2 = max(far2, d2)
    return np.sqrt(far2)
