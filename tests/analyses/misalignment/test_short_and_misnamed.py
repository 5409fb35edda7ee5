"""Trials of unequal length, recordings that are too short, and displacements in another unit than their header says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from tests.analyses.misalignment.trials import KNOWN, STROKE, changed, free, locked, quietly, recorded

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def long(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two locked and two free trials of 30 s whose disturbances last."""
    return recorded(tmp_path_factory.mktemp("long"), seconds=30.0, memory=0.3, trials=2, stroke=STROKE)


def identify(*recordings: Path, **options: Any) -> Any:
    return quietly(gc.misalignment.identify, *recordings, **{**KNOWN, **options})


def shortened(file: Path, to: Path, seconds: float, samples: int, until: float = 4.0) -> Path:
    """The first `until` seconds of a recording, played in `seconds`."""
    table = pd.read_csv(file)
    table = table[table["time [s]"] <= until]
    table["time [s]"] *= seconds / until
    table.iloc[:: max(len(table) // samples, 1)].to_csv(to, index=False)
    return to


def width(result: Any, name: str) -> float:
    """Of the interval of a number."""
    (one,) = (each for each in result.fit.intervals if each.key == name)
    return float(one.upper - one.lower)


def test_a_short_trial_beside_long_ones_does_not_shrink_the_intervals(long: Path, tmp_path: Path) -> None:
    """0.6 s of it set the length of all stretches to 0.1 s, as if 600 of them were independent."""
    alone = identify(*locked(long))
    beside = identify(*locked(long), shortened(locked(long)[0], tmp_path / "short.csv", 0.6, 200))
    assert beside.fit.stretches <= alone.fit.stretches + 2
    for name in ("k", "x", "y"):
        assert width(beside, name) > 0.8 * width(alone, name), name


def test_a_recording_too_short_for_its_bins_is_refused(long: Path, tmp_path: Path) -> None:
    table = pd.read_csv(locked(long)[0])
    few = table[~(table["beta [deg]"] // 2.0).duplicated()].iloc[::2].copy()  # one sample in a bin
    few["time [s]"] = np.linspace(0.0, 0.8, len(few))
    few.to_csv(tmp_path / "few.csv", index=False)
    with pytest.raises(gc.InputError, match=r"few.csv: \d+ samples in \d+ bins show no noise"):
        identify(tmp_path / "few.csv")
    fast = shortened(locked(long)[0], tmp_path / "fast.csv", 0.1, 200)
    with pytest.raises(gc.InputError, match=r"no bin of 2 degrees is held for 0.02 s .*: 0.1 s are too short"):
        identify(fast)


def test_metres_called_millimetres_are_refused(long: Path, tmp_path: Path) -> None:
    files = [changed(file, tmp_path, displacement=lambda t: 1e-3 * t["displacement [mm]"]) for file in free(long)]
    with pytest.raises(gc.InputError, match=r"slides by 0.0\d+ mm in it, .*; is its column in m, and not in mm\?"):
        identify(*locked(long), unlocked=files)


@pytest.mark.parametrize("factor", [0.1, 10.0])
def test_a_stroke_that_the_geometry_does_not_ask_for_is_doubted(long: Path, tmp_path: Path, factor: float) -> None:
    files = [changed(file, tmp_path, displacement=lambda t: factor * t["displacement [mm]"]) for file in free(long)]
    (doubt,) = (w for w in identify(*locked(long), unlocked=files).warnings if "the free joint slides by" in w)
    assert float(doubt.split("slides by ")[1].split()[0]) == pytest.approx(factor, rel=0.1)
    assert "is the displacement in another unit than its header says?" in doubt


def test_a_stroke_as_the_geometry_asks_for_is_not(long: Path) -> None:
    assert not any("slides by" in line for line in identify(*locked(long), unlocked=free(long)).warnings)
