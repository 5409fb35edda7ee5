"""The mat before it is laid down: how many cells, how far apart, which way up; and where marks on it touch a body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Mat:
    """A grid of cells. Positions on it are counted in cells: (0, 0) is the outer corner of the first cell.

    Parameters
    ----------
    rows, columns
        Cells along each direction.
    pitch
        Distance between neighbouring rows and between neighbouring columns [m].
    mirrored
        False: seen from outside the body rows run down and columns to the right, as the cells are printed.
        True: columns run to the left.
    """

    rows: int
    columns: int
    pitch: tuple[float, float]
    mirrored: bool = False

    def __post_init__(self) -> None:
        if self.rows < 1 or self.columns < 1 or not min(self.pitch) > 0.0:
            raise ValueError("a mat needs at least one row and one column, and a positive pitch")

    @property
    def hand(self) -> float:
        """1 where rows x columns points out of the body, -1 where the mat is mirrored."""
        return -1.0 if self.mirrored else 1.0

    @property
    def cell_area(self) -> float:
        """Area of a cell while the mat is flat [m^2]."""
        return self.pitch[0] * self.pitch[1]

    @property
    def middle(self) -> Float[np.ndarray, " 2"]:
        """Middle of the mat, in cells."""
        return np.array([0.5 * self.rows, 0.5 * self.columns])

    def away(self, cells: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "k 2"]:
        """Positions from the middle of the flat mat [m]; `cells` counts in cells."""
        return np.asarray((cells - self.middle) * np.array(self.pitch))

    def flat(self) -> Float[np.ndarray, "r1 c1 3"]:
        """Corners of the cells of the flat mat about its middle [m]: rows along x, columns along y, z outside."""
        row, column = np.meshgrid(np.arange(self.rows + 1.0), np.arange(self.columns + 1.0), indexing="ij")
        x, y = self.away(np.column_stack([row.ravel(), column.ravel()])).T
        return np.column_stack([x, self.hand * y, np.zeros(len(x))]).reshape(self.rows + 1, self.columns + 1, 3)


@dataclass(frozen=True, eq=False)
class Marks:
    """Points of the mat that were found on the body.

    Parameters
    ----------
    cells
        Row and column of each, counted in cells from the outer corner of the first one; halves are cell centres.
    points
        The same on the body [m].
    names
        For messages.
    """

    cells: Float[np.ndarray, "k 2"]
    points: Float[np.ndarray, "k 3"]
    names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not (np.isfinite(self.cells).all() and np.isfinite(self.points).all()):
            raise ValueError("marks of the mat must be finite")
        if self.names and len(self.names) != len(self.cells):
            raise ValueError(f"{len(self.cells)} marks of the mat but {len(self.names)} names")

    def name(self, k: int) -> str:
        """Name of mark k."""
        return self.names[k] if self.names else f"mark {k + 1}"

    @property
    def in_line(self) -> bool:
        """Whether the cells lie on one line of the mat: such marks fit either side of it to the body."""
        arms = self.cells - self.cells.mean(axis=0)
        return bool(np.linalg.matrix_rank(arms, 1e-6 * float(np.abs(arms).max())) < 2)

    def on(self, mat: Mat) -> None:
        """Refuse marks that are not on the mat, and too few of them."""
        if len(self.cells) < 2 or np.ptp(self.cells, axis=0).max() == 0.0:
            raise ValueError("laying a mat needs two marks at least, at different cells")
        off = np.flatnonzero((self.cells < 0.0).any(axis=1) | (self.cells > [mat.rows, mat.columns]).any(axis=1))
        if len(off):
            row, column = self.cells[off[0]]
            raise ValueError(
                f"{self.name(int(off[0]))} is at row {row:g}, column {column:g}; the mat has {mat.rows} rows and "
                f"{mat.columns} columns"
            )
