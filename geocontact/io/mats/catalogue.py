"""Readers by key, and which of them a file is for, by its content."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.pressure_frames import PressureFrames
from geocontact.io.mats import grid_csv, pedar, tekscan, xsensor
from geocontact.io.mats.layout import MatLayout
from geocontact.io.mats.text import MatText, read_mat_text


@dataclass(frozen=True)
class Reader:
    """A reader of one format: whether a text is of it, and its mats."""

    suits: Callable[[MatText], bool]
    read: Callable[[MatText, MatLayout | None], tuple[PressureFrames, ...]]


READERS: dict[str, Reader] = {
    tekscan.KIND: Reader(tekscan.is_tekscan, tekscan.read_tekscan),
    pedar.KIND: Reader(pedar.is_pedar, pedar.read_pedar),
    xsensor.KIND: Reader(xsensor.is_xsensor, xsensor.read_xsensor),
    grid_csv.KIND: Reader(grid_csv.is_grid, grid_csv.read_grid),
}
"""In the order in which a file's content is tried."""


def read_mat(path: Path, layout: MatLayout | None = None, kind: str | None = None) -> tuple[PressureFrames, ...]:
    """Frames of every mat in a recording, in SI.

    Parameters
    ----------
    layout
        What the file does not say (`layout.read_layout`); plain grids and pedar need one.
    kind
        Key of the reader; by the content of the file where none is given.
    """
    if kind is not None and kind not in READERS:
        raise InputError(path, "", f"'{kind}' is not a kind of recording", f"kinds are {', '.join(READERS)}")
    text = read_mat_text(path)
    kind = kind or next((key for key, reader in READERS.items() if reader.suits(text)), None)
    if kind is None:
        what = "is not a recording of a mat that is known here"
        remedy = f"kinds are {', '.join(READERS)}; a plain grid has one row `time [s], 1, 2, ...` above its frames"
        raise InputError(path, "", what, remedy)
    return READERS[kind].read(text, layout)


def read_shear_grid(path: Path, layout: MatLayout | None = None) -> PressureFrames:
    """Shear stress of each cell along one direction over time [Pa], from a plain grid; no other format has any.

    InputError for another kind of file, and as of `read_mat`.
    """
    text = read_mat_text(path)
    if not grid_csv.is_grid(text):
        raise InputError(path, "", "is no plain grid of cells", "export shear as `time [s], 1 [kPa], 2 [kPa], ...`")
    return grid_csv.read_grid(text, layout, signed=True)[0]
