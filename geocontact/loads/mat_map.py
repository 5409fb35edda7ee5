"""A pressure mat on a surface: where each cell presses, which way, and on which faces.

Each cell is cut into n × n parts along straight lines between its corners, the corners of the parts are laid onto the
surface at its closest points, and each part presses against half the cross product of its diagonals, its vector area.
The parts of a cell share the cell's sensing area in proportion to theirs. So a cell with pressure p presses with p A
against the mean of its normals, which is shorter than 1 where the surface bends under it. Errors fall with n².
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.frame_blocks import worked
from geocontact.geometry.surface import Surface

if TYPE_CHECKING:
    from scipy.sparse import csr_array

PARTS, MOST_PARTS = 4, 24  # per side of a cell
PER_EDGE = 2.5  # parts per shortest edge of a face, so that no face under a cell is passed over
ROUNDS = 30  # of proportional fitting


@dataclass(frozen=True, eq=False)
class MatMap:
    """What one pascal on each cell does to the body, in the surface's frame.

    Parameters
    ----------
    cell
        Row and column of each cell that lies on the surface.
    area
        Sensing area of each [m^2].
    force
        Force of one pascal [m^2]: against the normal, not longer than the area.
    moment
        Its moment about the origin of the frame [m^3].
    centre
        Where it acts, the mean of the parts [m].
    share
        Part of each cell's pressing that each face takes, faces × cells; columns sum to 1.
    left_out
        Working cells that do not lie on the surface.
    """

    cell: Int[np.ndarray, "n 2"]
    area: Float[np.ndarray, " n"]
    force: Float[np.ndarray, "n 3"]
    moment: Float[np.ndarray, "n 3"]
    centre: Float[np.ndarray, "n 3"]
    share: csr_array
    left_out: Bool[np.ndarray, "r c"]

    @property
    def middle(self) -> Float[np.ndarray, " 3"]:
        """Where equal pressures act: mean of the centres, weighted with the areas [m]."""
        return np.asarray((self.area @ self.centre) / self.area.sum())

    def lying_on(self, faces: Bool[np.ndarray, " f"]) -> Bool[np.ndarray, " n"]:
        """Cells that press on these faces of the surface with half of their load or more."""
        return np.asarray(self.share.T @ np.asarray(faces, float) >= 0.5)

    def of(self, pressure: Float[np.ndarray, "t r c"]) -> Float[np.ndarray, "t n"]:
        """Pressures of these cells [Pa]; what reads below zero stays, so that noise of unloaded cells averages out."""
        place = self.cell[:, 0] * pressure.shape[2] + self.cell[:, 1]
        if np.array_equal(place, np.arange(pressure.shape[1] * pressure.shape[2])):  # all of them: no second copy
            return pressure.reshape(len(pressure), -1)
        return worked(lambda part: part[:, self.cell[:, 0], self.cell[:, 1]], pressure)

    def face_pressure(
        self, pressure: Float[np.ndarray, "t n"], face_area: Float[np.ndarray, " f"]
    ) -> Float[np.ndarray, "t f"]:
        """Mean pressure on each face [Pa]: sum of pressure times area over the faces is that over the cells."""
        pressing = (self.share @ (pressure * self.area).T).T
        return np.asarray(np.divide(pressing, face_area, out=np.zeros_like(pressing), where=face_area > 0.0))


def mat_map(
    surface: Surface,
    nodes: Float[np.ndarray, "r1 c1 3"],
    valid: Bool[np.ndarray, "r c"],
    cell_area: Float[np.ndarray, "r c"],
    parts: int | None = None,
) -> MatMap:
    """Cells whose corners `nodes` [m] lie on a surface, as loads on it.

    Parameters
    ----------
    nodes
        Corners of the cells, in the surface's frame; NaN where the mat hangs over its edge.
    valid
        Cells that there are and that work.
    cell_area
        Sensing area of each cell [m^2].
    parts
        Per side of a cell; as many as the surface's faces ask for without.
    """
    whole = np.isfinite(nodes).all(axis=2)
    lying = valid & whole[:-1, :-1] & whole[1:, :-1] & whole[:-1, 1:] & whole[1:, 1:]
    if not lying.any():
        raise ValueError(f"{surface.name}: no cell of the mat lies on it")
    row, column = np.nonzero(lying)
    corners = np.stack(
        [nodes[row, column], nodes[row, column + 1], nodes[row + 1, column], nodes[row + 1, column + 1]], axis=1
    )
    n = parts_of(surface, corners) if parts is None else parts
    area, centre = _laid(surface, corners, n)
    size = np.linalg.norm(area, axis=2)
    flat = centre.reshape(-1, 3)
    face = surface.proximity(flat).face
    outward = surface.face_normal[face].reshape(area.shape)
    area *= np.where(np.einsum("nki,nki->nk", area, outward) < 0.0, -1.0, 1.0)[..., None]
    whole_size = size.sum(axis=1)
    if not (whole_size > 0.0).all():
        at = int(np.argmin(whole_size))
        raise ValueError(f"cell in row {row[at]}, column {column[at]} has no area on {surface.name}")
    sensing = cell_area[row, column]
    each = -area * (sensing / whole_size)[:, None, None]
    weight = size / whole_size[:, None]
    return MatMap(
        np.column_stack([row, column]),
        sensing,
        each.sum(axis=1),
        np.cross(centre, each).sum(axis=1),
        np.einsum("nk,nki->ni", weight, centre),
        _shares(face, weight, sensing, surface.face_area),
        valid & ~lying,
    )


def parts_of(surface: Surface, corners: Float[np.ndarray, "n 4 3"]) -> int:
    """Parts per side of a cell, so that they are smaller than the faces under them, within limits."""
    sides = corners[:, [1, 2]] - corners[:, [0, 0]]
    cell = float(np.median(np.linalg.norm(sides, axis=2).max(axis=1)))
    near = surface.proximity(corners.mean(axis=1)).face
    edge = float(np.median(surface.edge_length[near].min(axis=1)))
    return int(np.clip(np.ceil(PER_EDGE * cell / edge), PARTS, MOST_PARTS))


def _laid(
    surface: Surface, corners: Float[np.ndarray, "n 4 3"], n: int
) -> tuple[Float[np.ndarray, "n k 3"], Float[np.ndarray, "n k 3"]]:
    """Vector areas [m^2] and middles [m] of the parts."""
    along = np.linspace(0.0, 1.0, n + 1)
    v, u = np.meshgrid(along, along, indexing="ij")
    weights = np.stack([(1.0 - v) * (1.0 - u), (1.0 - v) * u, v * (1.0 - u), v * u], axis=-1)
    points = np.einsum("abk,nki->nabi", weights, corners)
    laid = surface.proximity(points.reshape(-1, 3)).closest.reshape(points.shape)
    a, b, c, d = laid[:, :-1, :-1], laid[:, :-1, 1:], laid[:, 1:, :-1], laid[:, 1:, 1:]
    area = 0.5 * np.cross(d - a, c - b)
    middle = 0.25 * (a + b + c + d)
    return area.reshape(len(corners), -1, 3), middle.reshape(len(corners), -1, 3)


def _shares(
    face: Int[np.ndarray, " p"],
    weight: Float[np.ndarray, "n k"],
    area: Float[np.ndarray, " n"],
    face_area: Float[np.ndarray, " f"],
) -> csr_array:
    """Part of each cell that each face carries; columns sum to 1.

    Parts are points, so a small face may get more of them than lie on its area. Rows are scaled down to the face's area
    and columns back to 1, in turns (iterative proportional fitting: Deming & Stephan 1940, Ann. Math. Stat. 11:427),
    until a uniform pressure is uniform on the faces that cells cover.
    """
    from scipy.sparse import coo_array, diags_array

    cells = np.repeat(np.arange(len(weight)), weight.shape[1])
    share = coo_array((weight.ravel(), (face, cells)), shape=(len(face_area), len(weight))).tocsr()
    for _ in range(ROUNDS):
        carried = share @ area
        fits = np.divide(face_area, carried, out=np.ones_like(carried), where=carried > face_area)
        share = diags_array(fits) @ share
        share = share @ diags_array(1.0 / share.sum(axis=0))
    return share.tocsr()
