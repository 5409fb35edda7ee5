"""Synthetic recordings of four load cells over four strides, with forces that are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.loads.loadcells import PUBLISHED

LBF = 4.4482216152605
CELLS = ("PM", "AM", "AL", "PL")
PERIOD = 1.1
HEAD = "time [s],PM,AM,AL,PL"


def gait(time: np.ndarray, height: float = 1.0, onset: float = 0.2) -> np.ndarray:
    """Synthetic cells [N], (t, 4): loads of 60 % of each stride, of different sizes and shapes."""
    phase = ((time - onset) / PERIOD) % 1.0
    wave = np.where(phase < 0.6, np.sin(np.pi * phase / 0.6), 0.0)
    early = np.where(phase < 0.6, np.sin(np.pi * phase / 0.6) ** 3, 0.0)
    return height * (20.0 + np.column_stack([500 * early, 400 * wave, 150 * wave, 200 * early]))


def recorded(
    folder: Path, name: str = "walk.csv", unit: float = 1.0, head: str = HEAD, end: str = "", **shape: float
) -> Path:
    """A file of four strides at 100 Hz; forces in N over `unit`."""
    time = np.arange(0.0, 5.0, 0.01)
    rows = np.column_stack([time, gait(time, **shape) / unit])
    text = "\n".join([head, *(",".join(map(repr, row)) + end for row in rows.tolist())]) + "\n"
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def sides(cells: np.ndarray) -> dict[str, np.ndarray]:
    """Forces of the compartments by the published weights [N]."""
    medial, lateral = cells @ np.array(PUBLISHED.medial), cells @ np.array(PUBLISHED.lateral)
    return {"medial": medial, "lateral": lateral, "total": cells.sum(axis=1)}
