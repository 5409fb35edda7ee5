"""Shares and sizes as shades: strips of cells along axes, and rows against columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class StripBlock:
    """Cells of all rows along one axis.

    Parameters
    ----------
    name
        Of the axis, with its unit.
    edges
        Of the cells, as printed: one more than there are cells.
    values
        Shade of each cell, 0 … 1; NaN where nothing is known.
    texts
        What a cell says when it is pointed at, and what is read aloud.
    marks
        A sign in a cell; "" for none.
    wide
        It takes the whole width.
    """

    name: str
    edges: Sequence[str]
    values: Float[np.ndarray, "r c"]
    texts: Sequence[Sequence[str]]
    marks: Sequence[Sequence[str]]
    wide: bool = False

    def __post_init__(self) -> None:
        rows, columns = self.values.shape
        if len(self.edges) != columns + 1:
            raise ValueError(f"{self.name}: {len(self.edges)} edges of {columns} cells")
        for part in (self.texts, self.marks):
            if len(part) != rows or any(len(row) != columns for row in part):
                raise ValueError(f"{self.name}: texts or marks that are not {rows} times {columns}")


@dataclass(frozen=True, eq=False)
class Strips:
    """Strips of cells below each other: a block for each axis, a row for each name.

    Parameters
    ----------
    rows
        Names, of the same rows in all blocks.
    scale
        What five shades mean, from none to full.
    words
        What it shows.
    """

    title: str
    unit: str
    rows: Sequence[str]
    blocks: Sequence[StripBlock]
    scale: Sequence[str]
    words: str = ""

    def __post_init__(self) -> None:
        for block in self.blocks:
            if len(block.values) != len(self.rows):
                raise ValueError(f"{block.name}: {len(block.values)} rows, expected {len(self.rows)}")
        _check_scale(self.title, self.scale)


@dataclass(frozen=True, eq=False)
class Matrix:
    """Rows against columns, a shade and a text in each cell.

    Parameters
    ----------
    rows, columns
        Names.
    corner
        What rows and columns are.
    values
        Shades, 0 … 1; NaN where nothing is known.
    texts
        Of the cells.
    scale
        What five shades mean, from none to full.
    words
        What it shows.
    """

    title: str
    unit: str
    rows: Sequence[str]
    columns: Sequence[str]
    corner: str
    values: Float[np.ndarray, "r c"]
    texts: Sequence[Sequence[str]]
    scale: Sequence[str]
    words: str = ""

    def __post_init__(self) -> None:
        shape = (len(self.rows), len(self.columns))
        if self.values.shape != shape or len(self.texts) != shape[0] or any(len(t) != shape[1] for t in self.texts):
            raise ValueError(f"{self.title}: values {self.values.shape}, expected {shape}")
        _check_scale(self.title, self.scale)


SHADES = 5


def _check_scale(title: str, scale: Sequence[str]) -> None:
    if len(scale) != SHADES:
        raise ValueError(f"{title}: {len(scale)} words for {SHADES} shades")


def _shades(values: Float[np.ndarray, "r c"]) -> list[list[float | None]]:
    return [[round(float(v), 4) if np.isfinite(v) else None for v in row] for row in values]


def strips_data(shown: Strips) -> dict[str, object]:
    """What the page's script draws of it."""
    blocks = [
        {
            "name": block.name,
            "edges": list(block.edges),
            "values": _shades(block.values),
            "texts": [list(row) for row in block.texts],
            "marks": [list(row) for row in block.marks],
            "wide": block.wide,
        }
        for block in shown.blocks
    ]
    return {"title": shown.title, "rows": list(shown.rows), "scale": list(shown.scale), "blocks": blocks}


def matrix_data(shown: Matrix) -> dict[str, object]:
    """What the page's script draws of it."""
    return {
        "title": shown.title,
        "rows": list(shown.rows),
        "columns": list(shown.columns),
        "corner": shown.corner,
        "scale": list(shown.scale),
        "values": _shades(shown.values),
        "texts": [list(row) for row in shown.texts],
    }
