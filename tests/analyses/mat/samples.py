"""Small inputs of a mat, and the analysis called on them. All recordings are synthetic."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.mat.result import MatResult, mat
from geocontact.data.errors import InputError
from tests.cli.calls import MESHES, written
from tests.drawing import unwritten

ROWS, COLS, PITCH = 4, 3, 10.0
"""A mat of 40 × 30 mm on a plate of 100 × 100 mm, its first corner at (20, 30)."""
LAYOUT = f'rows = {ROWS}\ncolumns = {COLS}\npitch_mm = {PITCH}\nunit = "kPa"\norder = "row"\n'
THIGH = MESHES / "mat_thigh_16x8"
FORCE, MOMENT = [f"f{a} [N]" for a in "xyz"], [f"m{a} [N m]" for a in "xyz"]
CENTRE = [f"cop_{a} [mm]" for a in "xyz"]


def called(frames: Path, **options: Any) -> MatResult:
    """`gc.mat`; what it warns of is in the result."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return mat(frames, **{"unit": "mm", "cutoff": 0.0, **options})


def flat(folder: Path, pressure: np.ndarray, layout: str = LAYOUT, **options: Any) -> MatResult:
    """A mat on a plane, with `pressure` [kPa] of frames × rows × columns."""
    return called(frames(folder, pressure), **{**on_plane(folder, layout), **options})


def on_plane(folder: Path, layout: str = LAYOUT) -> dict[str, Any]:
    """Files of the mat on a plane."""
    folder.mkdir(exist_ok=True)
    return {
        "layout": written(folder / "layout.toml", layout),
        "surface": scan(folder),
        "landmarks": marks(folder),
    }


def shipped(given: Path = THIGH, frames: str = "frames", **options: Any) -> MatResult:
    """A shipped recording, the thigh's unless told."""
    files = {"layout": "layout.toml", "landmarks": "landmarks.csv"}
    return called(
        given / f"{frames}.csv",
        **{**{option: given / name for option, name in files.items()}, "surface": MESHES / "thigh.stl", **options},
    )


def truth(given: Path = THIGH) -> pd.DataFrame:
    """Resultants of a shipped recording in closed form."""
    return pd.read_csv(given / "truth.csv", comment="#", skipinitialspace=True)


def scan(folder: Path) -> Path:
    """A flat piece of skin in the plane z = 0, outwards +z."""
    lines = [f"v {x} {y} 0" for x in range(0, 101, 20) for y in range(0, 101, 20)]
    for k in (6 * a + b + 1 for a in range(5) for b in range(5)):
        lines += [f"f {k} {k + 6} {k + 7}", f"f {k} {k + 7} {k + 1}"]
    return written(folder / "skin.obj", "\n".join(lines) + "\n")


def marks(folder: Path, *rows: str, name: str = "landmarks.csv") -> Path:
    """Rows of the mat run along x, columns along y: rows × columns points outwards."""
    rows = rows or ("a,0,0,20,30,0", "b,4,0,60,30,0", "c,0,3,20,60,0", "d,4,3,60,60,0")
    return written(folder / name, "\n".join(["id, row, column, x [mm], y [mm], z [mm]", *rows]) + "\n")


def frames(folder: Path, pressure: np.ndarray, step: float = 0.02) -> Path:
    """A recording of frames × rows × columns [kPa]."""
    folder.mkdir(exist_ok=True)
    names = [f"r{r}c{c}" for r in range(pressure.shape[1]) for c in range(pressure.shape[2])]
    rows = [",".join(f"{v:.10g}" for v in (k * step, *p.ravel())) for k, p in enumerate(pressure)]
    return written(folder / "frames.csv", "\n".join([",".join(["time [s]", *names]), *rows]) + "\n")


def uniform(count: int = 50, kpa: float = 10.0) -> np.ndarray:
    """The same pressure on every cell in every frame."""
    return np.full((count, ROWS, COLS), kpa)


def refusal(said: str) -> Any:
    """A block that must be refused, with these words in the line."""
    return pytest.raises(InputError, match=re.escape(said))


@contextmanager
def unpictured() -> Iterator[None]:
    """Neither figure nor page are made."""
    with mock.patch("geocontact.analyses.mat.result.mat_figure", return_value=None), unwritten():
        yield
