"""A recording that does not fit into one part: the same results to 1e-12, in memory that its length does not change."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.mat.result import MatResult
from geocontact.data import frame_blocks
from tests.analyses.mat.samples import COLS, LAYOUT, ROWS, flat, written
from tests.analyses.mat.test_motion import poses

COUNT = 240
TIME = 0.02 * np.arange(COUNT)


def pressures() -> np.ndarray:
    """Presses that wander over a mat at rest for its first second, with noise; one cell of the inner four is dead."""
    rng = np.random.default_rng(58)
    row, column = np.meshgrid(np.arange(ROWS), np.arange(COLS), indexing="ij")
    height = 30.0 * np.maximum(np.sin(2.0 * np.pi * (TIME - 1.0)), 0.0)
    place = 1.0 + np.sin(0.7 * TIME)
    found = height[:, None, None] * np.exp(-((row - place[:, None, None]) ** 2) - 0.3 * (column - 1.0) ** 2)
    return np.asarray(found + rng.normal(0.3, 0.1, found.shape))


def long_one(folder: Path, **options: object) -> MatResult:
    """Offset, low-pass, a cell that clips, a cell without readings, a named part, errors, shear of both axes."""
    folder.mkdir()
    pressure = pressures()
    layout = f"{LAYOUT}saturation_kPa = 27\nmasked = [[3, 2]]\n"
    files = {}
    for name, share in (("rows", 0.3), ("columns", -0.2)):
        (folder / name).mkdir()
        files[f"shear_{name}"] = table(folder / name, share * pressure)
    return flat(
        folder,
        np.minimum(pressure, 27.0),
        layout,
        cutoff=6.0,
        unloaded=((0.0, 0.6),),
        segment=("near=x < 45",),
        gain=0.02,
        registration=(2e-3, 0.02),
        **files,
        **options,
    )


def table(folder: Path, values: np.ndarray) -> Path:
    rows = [",".join(f"{v:.10g}" for v in (t, *p.ravel())) for t, p in zip(TIME, values, strict=True)]
    names = [f"r{r}c{c}" for r in range(ROWS) for c in range(COLS)]
    return written(folder / "shear.csv", "\n".join([",".join(["time [s]", *names]), *rows]) + "\n")


@pytest.mark.parametrize("moved", [False, True])
def test_parts_of_any_size_give_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moved: bool) -> None:
    """Parts of three frames, in temporary files, beside the whole in memory: tables, files and warnings."""
    options: dict[str, object] = {}
    if moved:
        options = {"motion": poses(tmp_path, 0.5, 1.5, 3.0, 4.5)}
    found = {}
    for at_once in (frame_blocks.AT_ONCE, 37):
        monkeypatch.setattr(frame_blocks, "AT_ONCE", at_once)
        result = long_one(tmp_path / f"in{at_once}", **options)
        result.write(tmp_path / f"out{at_once}", parquet=True, netcdf=True)
        found[at_once] = result
        assert bool(frame_blocks._MAPPED) == (at_once == 37)
    whole, parted = found.values()
    for name, wanted in whole.tables().items():
        pd.testing.assert_frame_equal(parted.tables()[name], wanted, rtol=1e-12, atol=1e-12)
        read = pd.read_parquet(tmp_path / "out37" / f"{name}.parquet")
        pd.testing.assert_frame_equal(read, wanted, rtol=1e-12, atol=1e-12)
    short, long = ([line.replace(f"in{k}", "") for line in one.warnings] for k, one in found.items())
    assert short == long


def test_what_was_kept_in_files_is_what_numpy_and_scipy_get(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Second derivation: offset, filter and sums of the typed pressures by hand."""
    from scipy.signal import butter, sosfiltfilt

    monkeypatch.setattr(frame_blocks, "AT_ONCE", 37)
    found = flat(tmp_path, pressures(), cutoff=6.0, unloaded=((0.0, 0.6),))
    pressure = np.array([[float(f"{v:.10g}") for v in p.ravel()] for p in pressures()])
    pressure -= pressure[:31].mean(axis=0)
    corner = np.arctan(np.tan(np.pi * 6.0 * 0.02) / (2.0**0.5 - 1.0) ** 0.25) / (np.pi * 0.02)
    smooth = sosfiltfilt(butter(2, corner, fs=50.0, output="sos"), pressure, axis=0)
    np.testing.assert_allclose(found.normal_force, smooth.sum(axis=1) * 1e3 * 1e-4, rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose(found.peak, smooth.max(axis=0) * 1e3, rtol=1e-11)


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_pages_are_given_back(monkeypatch: pytest.MonkeyPatch) -> None:
    """Thirty parts of 1 MB, written and read through: no more memory than a few parts."""

    def resident() -> int:
        text = Path("/proc/self/status").read_text(encoding="ascii")
        return int(text.split("VmRSS:")[1].split()[0]) * 1024

    monkeypatch.setattr(frame_blocks, "AT_ONCE", 1 << 17)
    rows = 30 * frame_blocks.AT_ONCE // 64
    before = resident()
    values = frame_blocks.room((rows, 64))
    for (part,) in frame_blocks.parts(values):
        part[:] = 1.0
    total = frame_blocks.worked(lambda part: part.sum(axis=1), values)
    assert total.sum() == values.size
    frame_blocks.release()
    assert resident() - before < 0.2 * values.nbytes
