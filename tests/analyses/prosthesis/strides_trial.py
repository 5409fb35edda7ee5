"""A synthetic walk of two strides: the shipped trial twice, one stride further on, with a smooth swing between."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from tests.cli.calls import MESHES

TRIAL, STRIDE = MESHES / "gait_P1_medium_1", 1.2
"""s; from one touch-down to the next."""


def written(folder: Path) -> dict[str, Path]:
    """walking.trc and plates.mot of both strides, by the options that take them."""
    head, rows = _table(TRIAL / "walking.trc", 6)
    rows, step = rows[:, 1:], rows[1, 1] - rows[0, 1]
    shift = np.zeros(rows.shape[1])
    shift[1::3] = 1000.0 * 1.25 * STRIDE
    both = _twice(rows, shift, step)
    lines = [
        "\t".join([str(k), f"{row[0]:.3f}", *(f"{each:.2f}" for each in row[1:])])
        for k, row in enumerate(both, start=1)
    ]
    counts = head[2].split("\t")
    counts[2] = counts[7] = str(len(both))
    head[2] = "\t".join(counts)
    (folder / "walking.trc").write_text("\n".join([*head, *lines, ""]))
    head, rows = _table(TRIAL / "plates.mot", 7)
    names = head[-1].split("\t")
    shift = np.array([1.25 * STRIDE * name.endswith("_px") for name in names])
    both = _twice(rows, shift, rows[1, 0] - rows[0, 0])
    own = [name.startswith("own_force_v") for name in names]
    between = (both[:, 0] > rows[-1, 0] + 1e-6) & (both[:, 0] < rows[0, 0] + STRIDE - 1e-6)
    both[np.ix_(between, own)] = 0.0
    head[2] = f"nRows={len(both)}"
    (folder / "plates.mot").write_text(
        "\n".join([*head, *("\t".join(f"{each:.4f}" for each in row) for row in both), ""])
    )
    return {"markers": folder / "walking.trc", "plates": folder / "plates.mot"}


def _table(file: Path, above: int) -> tuple[list[str], np.ndarray]:
    """Lines above the numbers, and the numbers."""
    lines = file.read_text().splitlines()
    return lines[:above], np.array([[float(each) for each in line.split("\t")] for line in lines[above:] if line])


def _twice(rows: np.ndarray, shift: np.ndarray, step: float) -> np.ndarray:
    """Rows with their time first, the gap on splines through both of its ends, and the same again."""
    later = rows + shift
    later[:, 0] = rows[:, 0] + STRIDE
    count = round((later[0, 0] - rows[-1, 0]) / step)
    time = rows[-1, 0] + step * np.arange(1, count)
    ends = np.array([rows[-1, 0], later[0, 0]])
    slopes = [(each[b, 1:] - each[a, 1:]) / (each[b, 0] - each[a, 0]) for each, a, b in ((rows, -6, -1), (later, 0, 5))]
    across = CubicHermiteSpline(ends, [rows[-1, 1:], later[0, 1:]], slopes)(time)
    return np.vstack([rows, np.column_stack([time, across]), later])
