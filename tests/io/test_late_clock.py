"""Times of a clock that counts from 1970 keep their milliseconds in everything that is written."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.data.motion import Signals
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.text import seconds
from geocontact.data.trial import Trial
from geocontact.io.cases.gap_case_writer import write_trials
from geocontact.io.cases.trial_table import read_trial
from geocontact.io.mocap.trc import read_trc, write_trc
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.results import write_table
from geocontact.io.text.tables import read_table
from tests.io.test_gap_case_writer import planted

EPOCH = 1.76e9 + np.arange(20) * 1e-3
VALUES = np.linspace(0.0, 1.0, len(EPOCH))


def by_table(folder: Path) -> np.ndarray:
    rows = pd.DataFrame({"time [s]": EPOCH, "force [N]": VALUES})
    write_table(rows, folder, "forces")
    return read_table(folder / "forces.csv").time


def by_storage(folder: Path) -> np.ndarray:
    write_storage(folder / "id.sto", EPOCH, ["knee"], VALUES[:, None], title="id", degrees=False)
    return read_table(folder / "id.sto").time


def by_markers(folder: Path) -> np.ndarray:
    write_trc(folder / "seen.trc", MarkerTrajectories(EPOCH, np.ones((len(EPOCH), 1, 3)), ("heel",)))
    return read_trc(folder / "seen.trc").time


def by_case(folder: Path) -> np.ndarray:
    trial = Trial("t01", Signals(EPOCH, VALUES[:, None], ("force",), ("N",)))
    write_trials(replace(planted("elbow"), calibration=(trial,), evaluation=()), folder)
    return read_trial(folder / "trials" / "t01.csv").signals.time


@pytest.mark.parametrize("written", [by_table, by_storage, by_markers, by_case])
def test_milliseconds_stay(tmp_path: Path, written: Callable[[Path], np.ndarray]) -> None:
    np.testing.assert_allclose(written(tmp_path) - EPOCH, 0.0, atol=1e-6)


def test_times_that_need_no_more_digits_are_written_as_they_were(tmp_path: Path) -> None:
    time = np.array([0.1 + 0.2, 12.3456789012345, 999999.123456])
    rows = pd.DataFrame({"time [s]": time, "force [N]": [1.76e9 + 1e-3, np.nan, 1.0]})
    write_table(rows, tmp_path, "forces")
    lines = (tmp_path / "forces.csv").read_text(encoding="utf-8").splitlines()
    assert lines[1:] == ["0.3,1760000000", "12.3456789012,", "999999.123456,1"]


@pytest.mark.parametrize(("value", "text"), [(1.76e9 + 0.125, "1760000000.125"), (1.76e9, "1760000000"), (0.3, "0.3")])
def test_a_time_in_words(value: float, text: str) -> None:
    assert seconds(value) == text
