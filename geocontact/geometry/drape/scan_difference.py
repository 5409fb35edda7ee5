"""Where a mat lies on a body, found from a scan with it and one without: the region that stands off."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from geocontact.geometry.drape.mat import Marks, Mat
from geocontact.geometry.drape.spread import Anchor, Geodesics, spread
from geocontact.geometry.surface import Surface

STEP = 0.005  # m, of the lines that carry the plane's coordinates over the surface
ROOM = 1.5  # times half the largest extent, how far the lines go
RECTANGLE_ROUNDS = 8
SETTLED = 1e-5  # m and rad
NEAR_CORNER = 0.08  # of a side's length at each end, where a scan rounds the corner
ROBUST = 1e-3  # m, beyond which a point of the outline pulls less
TURNS = 46  # between 0 and 90 degrees, for the first guess
TRIMMED = 2.0  # per cent of the outline at each end that the first guess leaves out
PLANE = Mat(1, 1, (1.0, 1.0))
FITS = 0.12  # of a side's length, by which the region may be longer or shorter than the mat


@dataclass(frozen=True, eq=False)
class Rectangle:
    """Four corners, counter-clockwise seen from outside.

    Parameters
    ----------
    corners
        On the surface [m].
    sides
        Lengths from each corner to the next, along the surface [m].
    rms
        Root mean square distance of the outline from the sides [m].
    """

    corners: Float[np.ndarray, "4 3"]
    sides: Float[np.ndarray, " 4"]
    rms: float

    def first_corners(self, mat: Mat, within: float = FITS) -> list[int]:
        """Corners that may be that of the mat's first cell; none where the mat has other sides.

        Rows run from it along one side and columns along the other, in the order that `mat.hand` says; both are as long
        as those sides up to the share `within`. An oblong mat leaves two, a square one four.
        """
        down, across = mat.rows * mat.pitch[0], mat.columns * mat.pitch[1]
        ahead, behind = self.sides, np.roll(self.sides, 1)
        by_row, by_column = (behind, ahead) if mat.mirrored else (ahead, behind)
        fits = (np.abs(by_row / down - 1.0) < within) & (np.abs(by_column / across - 1.0) < within)
        return [int(k) for k in np.flatnonzero(fits)]

    def marks(self, mat: Mat, first: int) -> Marks:
        """The four corners as marks of a mat whose first cell lies at corner `first`; points [m] as `corners`."""
        hand = -1 if mat.mirrored else 1
        rows, columns = float(mat.rows), float(mat.columns)
        order = [first, (first + hand) % 4, (first - hand) % 4, (first + 2) % 4]
        cells = np.array([[0.0, 0.0], [rows, 0.0], [0.0, columns], [rows, columns]])
        return Marks(cells, self.corners[order], ("first corner", "end of column 1", "end of row 1", "last corner"))


def rectangle_on(
    geodesics: Geodesics, outline: Float[np.ndarray, "n 3"], length: Float[np.ndarray, " n"], edge: float = 0.0
) -> Rectangle:
    """The rectangle whose sides an outline follows.

    Points are read in geodesic parallel coordinates about the rectangle's middle (`spread`), where a mat's sides are
    straight; a line is fitted to each side, weighted with the length of the outline's pieces, far ones less (Huber),
    corners left out; the middle and the direction of the coordinates follow the lines until they stand.

    Parameters
    ----------
    outline, length
        Points on the surface [m] and how much of the outline each stands for [m].
    edge
        Width that is taken off all around [m]: of a mat's border without cells.
    """
    middle = length @ outline / length.sum()
    arms = outline - middle
    anchor = Anchor.at(geodesics, middle, np.linalg.svd(arms, full_matrices=False)[2][0])
    reach = ROOM * float(np.linalg.norm(arms, axis=1).max())
    anchor = anchor.turned(geodesics, _first_turn(_flat(geodesics, anchor, outline, reach)))
    lines = np.zeros((4, 3))
    for _ in range(RECTANGLE_ROUNDS):
        plane = _flat(geodesics, anchor, outline, reach)
        lines = _lines(plane, length)
        corners = _corners(lines, 0.0)
        centre = corners.mean(axis=0)
        ways = corners[[1, 2]] - corners[[0, 3]]
        turn = float(np.arctan2(ways[:, 1].sum(), ways[:, 0].sum()))
        if max(np.abs(centre).max(), abs(turn)) < SETTLED:
            break
        anchor = anchor.carried(geodesics, float(centre[0]), float(centre[1])).turned(geodesics, turn)
        if not anchor.place.on[0]:
            raise ValueError("the outline runs off the scan")
    plane = _flat(geodesics, anchor, outline, reach)
    lines = _lines(plane, length)
    off = np.abs(_off(lines, plane)).min(axis=1)
    corners = _corners(lines, edge)
    each = np.arange(4)
    there = spread(geodesics, anchor, PLANE, corners[:, 0], corners[:, 1]).point[each, each]
    if not np.isfinite(there).all():
        raise ValueError("a corner of the outline lies beyond the edge of the scan")
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    return Rectangle(there, sides, float(np.sqrt(length @ off**2 / length.sum())))


def _flat(
    geodesics: Geodesics, anchor: Anchor, points: Float[np.ndarray, "n 3"], reach: float
) -> Float[np.ndarray, "n 2"]:
    """Coordinates (ahead, aside) of points about the anchor [m], linear about the nearest crossing of the lines."""
    count = max(int(np.ceil(reach / STEP)), 4)
    line = np.linspace(-reach, reach, 2 * count + 1)
    grid = spread(geodesics, anchor, PLANE, line, line).point
    ahead, aside = (np.gradient(grid, line, axis=k) for k in (0, 1))
    known = np.isfinite(grid + ahead + aside).all(axis=2)
    u, v = np.meshgrid(line, line, indexing="ij")
    at = np.column_stack([u[known], v[known]])
    _, nearest = cKDTree(grid[known]).query(points)
    frame = np.stack([ahead[known][nearest], aside[known][nearest]], axis=2)
    away = np.einsum("nij,ni->nj", frame, points - grid[known][nearest])
    metric = np.einsum("nij,nik->njk", frame, frame)
    return np.asarray(at[nearest] + np.linalg.solve(metric, away[..., None])[..., 0])


def _first_turn(plane: Float[np.ndarray, "n 2"]) -> float:
    """Turn [rad] of the smallest box around the points, stray ones left out."""
    turns = np.linspace(0.0, 0.5 * np.pi, TURNS, endpoint=False)
    sizes = []
    for turn in turns:
        along = plane @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        low, high = np.percentile(along, [TRIMMED, 100.0 - TRIMMED], axis=0)
        sizes.append(float(np.prod(high - low)))
    return float(turns[int(np.argmin(sizes))])


def _lines(plane: Float[np.ndarray, "n 2"], length: Float[np.ndarray, " n"]) -> Float[np.ndarray, "4 3"]:
    """Sides behind, to the right, ahead, to the left: axis, offset along it, slope against the other."""
    from scipy.optimize import least_squares

    low, high = np.percentile(plane, [TRIMMED, 100.0 - TRIMMED], axis=0)
    to = np.abs(np.stack([plane[:, 0] - low[0], plane[:, 1] - low[1], plane[:, 0] - high[0], plane[:, 1] - high[1]]))
    side = to.argmin(axis=0)
    found = []
    for k in range(4):
        axis = k % 2
        other = 1 - axis
        margin = NEAR_CORNER * (high[other] - low[other])
        mine = (side == k) & (plane[:, other] > low[other] + margin) & (plane[:, other] < high[other] - margin)
        if mine.sum() < 2:
            raise ValueError("the outline of what stands off has no four sides")
        x, y, root = plane[mine, other], plane[mine, axis], np.sqrt(length[mine])
        start = [float(np.median(y)), 0.0]
        fit = least_squares(_beside, start, loss="huber", f_scale=ROBUST * float(root.mean()), args=(x, y, root))
        found.append([float(axis), *fit.x])
    return np.array(found)


def _beside(
    line: Float[np.ndarray, " 2"], x: Float[np.ndarray, " m"], y: Float[np.ndarray, " m"], root: Float[np.ndarray, " m"]
) -> Float[np.ndarray, " m"]:
    return np.asarray((line[0] + line[1] * x - y) * root)


def _off(lines: Float[np.ndarray, "4 3"], plane: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n 4"]:
    """Distance of each point from each line [m]."""
    columns = []
    for axis, offset, slope in lines:
        a = int(axis)
        columns.append((plane[:, a] - offset - slope * plane[:, 1 - a]) / np.hypot(1.0, slope))
    return np.stack(columns, axis=1)


def _corners(lines: Float[np.ndarray, "4 3"], edge: float) -> Float[np.ndarray, "4 2"]:
    """Where neighbouring sides meet once `edge` is taken off: (-, -), (+, -), (+, +), (-, +)."""
    behind, right, ahead, left = (line[1:] for line in lines)
    inset = [(behind, edge), (right, edge), (ahead, -edge), (left, -edge)]
    behind, right, ahead, left = (np.array([o + e * np.hypot(1.0, s), s]) for (o, s), e in inset)
    found = []
    for across, along in ((behind, right), (ahead, right), (ahead, left), (behind, left)):
        # u = across[0] + across[1] v and v = along[0] + along[1] u
        u = (across[0] + across[1] * along[0]) / (1.0 - across[1] * along[1])
        found.append([u, along[0] + along[1] * u])
    return np.array(found)


THIN, THICK = 1e-3, 1e-2  # m, of mats
NORMAL = 1.4826  # standard deviation of normal deviations over their median size
CLEAR = 3.0  # standard deviations of the scan's noise that a region stands off by at least
ROUNDS = 4


@dataclass(frozen=True, eq=False)
class ScanDifference:
    """The largest region of one scan that stands off another.

    Parameters
    ----------
    thickness
        Median height of the region [m].
    noise
        Standard deviation of the heights elsewhere [m].
    area
        Of the region, at half its height [m^2].
    outline
        Middles of the pieces of its edge at half the thickness, laid down onto the other scan [m].
    length
        Of each piece [m].
    """

    thickness: float
    noise: float
    area: float
    outline: Float[np.ndarray, "n 3"]
    length: Float[np.ndarray, " n"]


def scan_difference(with_mat: Surface, bare: Surface) -> ScanDifference:
    """The mat on a scan that lies in the frame of the bare one.

    Heights of the vertices over the bare scan are signed by its faces. Of all that is higher than half the thickness
    the largest connected piece counts; thickness and piece are found in turns. A step that a scanner rounds off, or
    that is one triangle wide, is crossed at half height about where the mat ends.
    """
    found = bare.proximity(with_mat.vertices)
    off = with_mat.vertices - found.closest
    sign = np.where(np.einsum("ij,ij->i", off, bare.face_normal[found.face]) < 0.0, -1.0, 1.0)
    height = sign * np.abs(found.distance)
    noise = NORMAL * float(np.median(np.abs(height - np.median(height))))
    level, thickness = max(0.5 * THIN, CLEAR * noise), 0.0
    faces = with_mat.topology.merged[with_mat.faces]
    for _ in range(ROUNDS):
        inside = _largest(with_mat, faces, (height > level) & (height < 1.5 * THICK))
        if not inside.any():
            raise ValueError(
                f"nothing on {with_mat.name} stands off {bare.name} by {level * 1e3:.1f} mm or more; is the mat on it?"
            )
        weight = np.bincount(with_mat.faces.ravel(), np.repeat(with_mat.face_area / 3.0, 3), len(height)) * inside
        thickness = _median(height[inside], weight[inside])
        level = 0.5 * thickness
    if not THIN <= thickness <= THICK:
        raise ValueError(
            f"what stands off {bare.name} is {thickness * 1e3:.1f} mm high, and a mat {THIN * 1e3:g} to "
            f"{THICK * 1e3:g} mm"
        )
    points, length = _edge(with_mat, faces, height - level, inside)
    ground = bare.proximity(points).closest
    whole = inside[with_mat.faces].all(axis=1)
    return ScanDifference(thickness, noise, float(with_mat.face_area[whole].sum()), ground, length)


def _largest(surface: Surface, faces: np.ndarray, high: Bool[np.ndarray, " n"]) -> Bool[np.ndarray, " n"]:
    """Vertices of the connected piece of faces with high corners that has the largest area."""
    whole = high[surface.faces].all(axis=1)
    if not whole.any():
        return np.zeros(len(high), bool)
    own = faces[whole]
    start, goal = own.ravel(), own[:, [1, 2, 0]].ravel()
    graph = coo_array((np.ones(len(start)), (start, goal)), shape=(len(high), len(high)))
    _, piece = connected_components(graph, directed=False)
    area = np.bincount(piece[own[:, 0]], surface.face_area[whole], piece.max() + 1)
    return np.asarray((piece == int(np.argmax(area)))[surface.topology.merged] & high)


def _median(values: Float[np.ndarray, " n"], weight: Float[np.ndarray, " n"]) -> float:
    order = np.argsort(values)
    total = np.cumsum(weight[order])
    return float(values[order][int(np.searchsorted(total, 0.5 * total[-1]))])


def _edge(
    surface: Surface, faces: np.ndarray, over: Float[np.ndarray, " n"], inside: Bool[np.ndarray, " n"]
) -> tuple[Float[np.ndarray, "k 3"], Float[np.ndarray, " k"]]:
    """Middles and lengths of the pieces in which the faces at the region's edge are crossed at zero."""
    corner = surface.faces
    some = inside[corner].any(axis=1) & (over[corner] <= 0.0).any(axis=1)
    corner = corner[some]
    ends = []
    for a, b in ((0, 1), (1, 2), (2, 0)):
        i, j = corner[:, a], corner[:, b]
        crossed = (over[i] > 0.0) != (over[j] > 0.0)
        share = np.where(crossed, over[i] / np.where(crossed, over[i] - over[j], 1.0), np.nan)
        ends.append(surface.vertices[i] + share[:, None] * (surface.vertices[j] - surface.vertices[i]))
    points = np.stack(ends, axis=1)
    two = np.isfinite(points[..., 0]).sum(axis=1) == 2
    points = points[two]
    pairs = points[np.isfinite(points[..., 0])].reshape(-1, 2, 3)
    length = np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1)
    return pairs.mean(axis=1), length
