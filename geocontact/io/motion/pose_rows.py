"""Poses as matrices: one frame in each row of a file, 16 or 12 numbers, or columns r11 … r33 of a table."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from os import PathLike, fspath
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.magnitude import LARGEST_MEANT
from geocontact.data.motion import Motion
from geocontact.io.text.tables import LARGEST_FILE, TextTable
from geocontact.io.text.units import LENGTH

ENTRIES = tuple(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3))
"""Columns of a rotation matrix in a table, row by row."""
SIZES = (16, 12)
"""Numbers in a row: 4x4, or 3x4 without the last row."""
ROUNDED = 1e-4
"""How far off orthonormal a matrix may be without a word: files often have five digits."""
ROUGH = 2e-2
"""How far it may be with a warning: recorders interpolate entries of matrices, which bends them."""
_SPLIT = re.compile(r"[,;\s]+")
_COMMENT = "#"


def is_pose_rows(path: str | PathLike[str]) -> bool:
    """Whether the first row of a text file is a matrix: 16 or 12 numbers and no header."""
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as stream:
            first = next((line for line in stream if line.strip() and not line.lstrip().startswith(_COMMENT)), "")
    except OSError:
        return False  # told by who reads it
    cells = _cells(first)
    return len(cells) in SIZES and all(map(_is_number, cells))


def motion_from_rows(path: str | PathLike[str], unit: str | None, rate: float | None) -> Motion:
    """Motion in a file whose rows are matrices, one frame each, without a header.

    Parameters
    ----------
    path
        Text; numbers separated by commas or blanks: the 4x4 pose row by row, or its first three rows, translation in
        the last column. Rows that are empty or begin with # are passed over.
    unit
        Unit of the translations.
    rate
        Frames per second [Hz]: such a file holds no times. 1 numbers the frames.
    """
    file = fspath(path)
    if unit not in LENGTH:
        raise InputError(
            file,
            "",
            "rows of poses do not say in which unit they are",
            "pass `unit`, or name columns in a header: time [s], r11, …, tx [mm], …",
        )
    if rate is None:
        remedy = "pass `rate`, the frames per second in Hz; 1 numbers the frames"
        raise InputError(file, "", "rows of poses hold no times", remedy)
    values, lines = _read(file)
    matrices = np.zeros((len(values), 4, 4))
    matrices[:, 3, 3] = 1.0
    matrices[:, : values.shape[1] // 4] = values.reshape(len(values), -1, 4)
    rotation = rotations(matrices, file, [f"line {line}" for line in lines], ROUGH)
    poses = RigidTransform.from_components(matrices[:, :3, 3] * LENGTH[unit], rotation)
    return Motion(np.arange(len(values)) / rate, poses, file, heeded=frozenset({"rate"}))


def rotations_of(table: TextTable) -> Rotation:
    """Rotations in the columns r11 … r33 of a table."""
    entries = np.column_stack([table.needed(name) for name in ENTRIES]).reshape(-1, 3, 3)
    matrices = np.tile(np.eye(4), (len(entries), 1, 1))
    matrices[:, :3, :3] = entries
    return rotations(matrices, table.file, [f"line {line}" for line in table.lines], ROUGH)


def rotations(matrices: Float[np.ndarray, "t 4 4"], file: str, places: Sequence[str], rough: float) -> Rotation:
    """The rotations nearest to matrices that are rigid poses within `rough`; InputError at the place of others."""
    turn = matrices[:, :3, :3]
    off = np.abs(np.swapaxes(turn, 1, 2) @ turn - np.eye(3)).max(axis=(1, 2))
    worst = int(np.argmax(off))
    foot = np.abs(matrices[:, 3] - [0.0, 0.0, 0.0, 1.0]).max(axis=1)
    lowest = int(np.argmax(foot))
    if foot[lowest] > 1e-6:
        across = np.abs(matrices[lowest, :, 3] - [0.0, 0.0, 0.0, 1.0]).max() <= 1e-6
        remedy = "write it row by row, not column by column" if across else "write the translation in the last column"
        raise InputError(file, places[lowest], "the last row of the matrix is not 0 0 0 1", remedy)
    if off[worst] > rough:
        what = f"rotation part is off orthonormal by {off[worst]:.2g}"
        raise InputError(file, places[worst], what, "scale or shear is not a pose")
    mirrored = np.flatnonzero(np.linalg.det(turn) < 0.0)
    if len(mirrored):
        what = "rotation part mirrors (determinant -1)"
        raise InputError(file, places[mirrored[0]], what, "mirror the mesh instead")
    if off[worst] > ROUNDED:
        count = np.count_nonzero(off > ROUNDED)
        what = f"rotation parts are off orthonormal in {count} of {len(off)} frames, by up to {off[worst]:.2g}"
        what += f" ({places[worst]}); the nearest rotations are taken"
        warnings.warn(InputWarning(f"{file}: {what}"), stacklevel=4)
    return Rotation.from_matrix(turn)


def _read(file: str) -> tuple[Float[np.ndarray, "t c"], list[int]]:
    rows: list[list[float]] = []
    lines: list[int] = []
    size = Path(file).stat().st_size
    if size > LARGEST_FILE:
        raise InputError(file, "", f"{size / 1e6:.0f} MB is more than the {LARGEST_FILE / 1e6:.0f} MB limit", "cut it")
    with open(file, encoding="utf-8-sig", errors="replace") as stream:
        for number, line in enumerate(stream, 1):
            if line.strip() and not line.lstrip().startswith(_COMMENT):
                rows.append(_row(line, file, number, len(rows[0]) if rows else 0))
                lines.append(number)
    return np.array(rows), lines


def _row(line: str, file: str, number: int, size: int) -> list[float]:
    cells = _cells(line)
    if len(cells) != (size or len(cells)) or not all(map(_is_number, cells)):
        what = f"{len(cells)} cells where {size} numbers are a pose"
        raise InputError(file, f"line {number}", what, "give every frame all of its numbers")
    values = [float(cell) for cell in cells]
    if not (np.abs(values) <= LARGEST_MEANT).all():
        raise InputError(file, f"line {number}", "the pose is not finite or too large", "fill the gap or cut the frame")
    return values


def _cells(line: str) -> list[str]:
    return [cell for cell in _SPLIT.split(line.strip()) if cell]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
