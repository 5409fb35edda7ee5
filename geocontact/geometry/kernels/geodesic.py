"""Straightest lines over a triangle mesh: straight inside a face, straight across an edge when it is laid flat.

Polthier and Schmies, Straightest geodesics on polyhedral surfaces, 1998. The sheet is (vertices, faces, neighbour):
neighbour[f, k] is the face across the edge from corner k to corner k + 1, -1 where the surface ends. A place is a face
and a point on it; a direction is a unit vector in the plane of that face. A line that meets a corner goes on through
the face that it enters there as if the corner were flat.
"""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import inner, kernel

FLAT = 1e-13  # height of a triangle over its longest edge below which a line crosses it without moving
CROSSINGS = 100000  # edges that one line may cross
SHOTS = 40  # attempts to hit a place
CLOSE = 1e-13  # miss over length at which a place counts as hit
GAIN = 0.999  # a shot that does not miss by less than this times the best is not tried further from


@kernel
def traced(vertices, faces, neighbour, face, point, direction, stations):
    """Places and directions at the stations (ascending lengths, none negative) of each of n lines; face -1 beyond.

    Shapes: face (n), point and direction (n, 3), stations (s); results (n, s), (n, s, 3), (n, s, 3).
    """
    n, s = len(face), len(stations)
    faces_at = np.full((n, s), -1)
    points_at = np.full((n, s, 3), np.nan)
    directions_at = np.full((n, s, 3), np.nan)
    p = np.empty(3)
    d = np.empty(3)
    for i in range(n):
        f = face[i]
        p[:] = point[i]
        d[:] = direction[i]
        gone = 0.0
        entry = -1
        for j in range(s):
            if f >= 0:
                f, entry = _walk(vertices, faces, neighbour, f, entry, p, d, stations[j] - gone)
            if f < 0:
                break
            gone = stations[j]
            faces_at[i, j] = f
            points_at[i, j] = p
            directions_at[i, j] = d
    return faces_at, points_at, directions_at


@kernel
def moved(vertices, faces, neighbour, face, point, shift):
    """Places reached from each of n places by the vectors `shift` in the planes of their faces; face -1 if beyond."""
    n = len(face)
    faces_at = np.full(n, -1)
    points_at = np.full((n, 3), np.nan)
    p = np.empty(3)
    for i in range(n):
        length = np.sqrt(_dot(shift[i], shift[i]))
        f = face[i]
        p[:] = point[i]
        if f >= 0 and length > 0.0:
            f, _ = _walk(vertices, faces, neighbour, f, -1, p, shift[i] / length, length)
        if f >= 0:
            faces_at[i] = f
            points_at[i] = p
    return faces_at, points_at


@kernel
def joined(vertices, faces, neighbour, face, point, goal_face, goal):
    """Straightest line from each place to a near one, found by shooting at it and correcting the miss.

    Length, unit directions at start and goal, and the miss that is left, NaN where none was found: the first shot goes
    along the chord; sideways a line of length L is turned by miss / L, as in the plane.
    """
    n = len(face)
    length = np.full(n, np.nan)
    leaving = np.full((n, 3), np.nan)
    arriving = np.full((n, 3), np.nan)
    left = np.full(n, np.nan)
    p, d, first, aim = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for i in range(n):
        if face[i] < 0 or goal_face[i] < 0:
            continue
        normal = _normal(vertices, faces, face[i])
        chord = goal[i] - point[i]
        far = np.sqrt(_dot(chord, chord))
        if far == 0.0:
            length[i], left[i] = 0.0, 0.0
            continue
        first[:] = chord
        _into_plane(first, normal)
        reach = far
        best = np.inf
        for _ in range(SHOTS):
            p[:] = point[i]
            d[:] = first
            f, _ = _walk(vertices, faces, neighbour, face[i], -1, p, d, reach)
            if f < 0:
                break
            miss = goal[i] - p
            size = np.sqrt(_dot(miss, miss))
            if not size < GAIN * best:
                break
            best = size
            aim[:] = d
            _laid_into(vertices, faces, neighbour, f, goal_face[i], aim)
            ahead = _dot(miss, d)
            length[i], left[i] = reach + ahead, size
            leaving[i] = first
            arriving[i] = aim
            if size <= CLOSE * far:
                break
            turn = _dot(miss, np.cross(_normal(vertices, faces, f), d)) / reach
            reach = max(reach + ahead, 0.5 * reach)
            first[:] = first + turn * np.cross(normal, first)
            _into_plane(first, normal)
    return length, leaving, arriving, left


@inner
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inner
def _normal(vertices, faces, f):
    a = vertices[faces[f, 0]]
    n = np.cross(vertices[faces[f, 1]] - a, vertices[faces[f, 2]] - a)
    size = np.sqrt(_dot(n, n))
    if size > 0.0:
        n /= size
    return n


@inner
def _into_plane(d, normal):
    """Turn d into the plane and make it a unit vector, in place; what stands on the plane stays as it is."""
    d -= _dot(d, normal) * normal
    size = np.sqrt(_dot(d, d))
    if size > 0.0:
        d /= size


@inner
def _laid_into(vertices, faces, neighbour, f, goal, d):
    """Turn d from face f into the plane of the face `goal`, in place: about their common edge, else straight down."""
    for k in range(3):
        if f != goal and neighbour[f, k] == goal:
            a = vertices[faces[f, k]]
            along = vertices[faces[f, (k + 1) % 3]] - a
            along /= np.sqrt(_dot(along, along))
            out = _dot(d, np.cross(along, _normal(vertices, faces, f)))
            d[:] = _dot(d, along) * along + out * np.cross(along, _normal(vertices, faces, goal))
    _into_plane(d, _normal(vertices, faces, goal))


@inner
def _walk(vertices, faces, neighbour, f, entry, p, d, length):
    """Go on along d by `length` from p on face f, which was entered by its edge `entry` (-1: from inside).

    p and d are changed in place. Returns the face reached and its entry edge; face -1 where the surface ended.
    """
    left = length
    along = np.empty(3)
    side = np.empty(3)
    for _ in range(CROSSINGS):
        t, k = _way_out(vertices, faces, f, entry, p, d)
        if k < 0 or t >= left:
            p += left * d
            return f, entry
        a = vertices[faces[f, k]]
        b = vertices[faces[f, (k + 1) % 3]]
        along[:] = b - a
        edge = np.sqrt(_dot(along, along))
        along /= edge
        at = min(max(_dot(p + t * d - a, along), 0.0), edge)
        p[:] = a + at * along
        left -= t
        tangent = _dot(d, along)
        across = max(_dot(d, np.cross(along, _normal(vertices, faces, f))), 0.0)
        f, entry = _across(vertices, faces, neighbour, f, k, p)
        if f < 0:
            return -1, -1
        _inwards(vertices, faces, f, entry, along, side)
        d[:] = tangent * along + across * side
        d /= np.sqrt(_dot(d, d))
    return -1, -1


@inner
def _way_out(vertices, faces, f, entry, p, d):
    """Length to the first edge that the line leaves through, and the edge; never the one it came in by."""
    normal = _normal(vertices, faces, f)
    best, found = np.inf, -1
    for k in range(3):
        if k == entry:
            continue
        a = vertices[faces[f, k]]
        out = np.cross(vertices[faces[f, (k + 1) % 3]] - a, normal)
        speed = _dot(d, out)
        if speed > 0.0:
            t = max(_dot(a - p, out) / speed, 0.0)
            if t < best:
                best, found = t, k
    return best, found


@inner
def _across(vertices, faces, neighbour, f, k, p):
    """The face with area across edge k of f, and its edge there; faces without area are crossed at the point p."""
    for _ in range(CROSSINGS):
        g = neighbour[f, k]
        if g < 0:
            return -1, -1
        entry = 0
        while faces[g, entry] != faces[f, (k + 1) % 3] or faces[g, (entry + 1) % 3] != faces[f, k]:
            entry += 1
        if _height(vertices, faces, g) > FLAT:
            return g, entry
        f, k = g, _other_side(vertices, faces, g, entry, p)
    return -1, -1


@inner
def _height(vertices, faces, f):
    """Height of a face over its longest edge, as a share of that edge."""
    longest = 0.0
    for k in range(3):
        edge = vertices[faces[f, (k + 1) % 3]] - vertices[faces[f, k]]
        longest = max(longest, _dot(edge, edge))
    a = vertices[faces[f, 0]]
    n = np.cross(vertices[faces[f, 1]] - a, vertices[faces[f, 2]] - a)
    return np.sqrt(_dot(n, n)) / longest if longest > 0.0 else 0.0


@inner
def _other_side(vertices, faces, f, entry, p):
    """Edge by which a line that entered a face without area at p leaves it: one on which p lies, not the entry."""
    found, least = -1, np.inf
    for k in range(3):
        if k == entry:
            continue
        a = vertices[faces[f, k]]
        b = vertices[faces[f, (k + 1) % 3]]
        away = np.sqrt(_dot(p - a, p - a)) + np.sqrt(_dot(p - b, p - b)) - np.sqrt(_dot(b - a, b - a))
        if away < least:
            found, least = k, away
    return found


@inner
def _inwards(vertices, faces, f, k, along, side):
    """Unit vector in face f across its edge k, pointing into the face; `along` is the edge's unit vector."""
    side[:] = vertices[faces[f, (k + 2) % 3]] - vertices[faces[f, k]]
    side -= _dot(side, along) * along
    side /= np.sqrt(_dot(side, side))
