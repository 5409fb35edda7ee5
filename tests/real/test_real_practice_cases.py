"""The practice cases beside the repository read, with as many trials, rows, parameters and tables as they hold."""

from __future__ import annotations

import csv
import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from geocontact.io.cases.gap_case import gap_case_folders, read_gap_case

PRACTICE = Path(__file__).resolve().parents[2].parent / "shared" / "gap" / "practice"

# Channels, parameters, tables with rows and columns; the same for the four cases of a system.
SYSTEMS: dict[str, tuple[int, int, dict[str, tuple[int, int]]]] = {
    "elbow": (2, 3, {}),
    "foot": (6, 10, {"spheres": (15, 4)}),
    "shoulder": (4, 3, {"support": (18, 2)}),
    "knee": (6, 1, {}),
    "sit_to_stand": (12, 6, {}),
}
NAMES = [f"{system}_{number:02d}" for system in SYSTEMS for number in range(1, 5)]


@pytest.fixture(scope="module")
def practice() -> Path:
    if not PRACTICE.is_dir():
        pytest.skip("no practice cases: ../shared/gap/practice is absent")
    return PRACTICE


def test_all_practice_cases_are_found(practice: Path) -> None:
    found = [folder.name for folder in gap_case_folders(practice)]
    assert found == sorted(NAMES) == sorted(json.loads((practice / "labels.json").read_text(encoding="utf-8")))


@pytest.mark.parametrize("name", NAMES)
def test_practice_cases_hold_what_their_files_hold(practice: Path, name: str) -> None:
    case = read_gap_case(practice / name)
    told = tomllib.loads((practice / name / "case.toml").read_text(encoding="utf-8"))
    channels, parameters, tables = SYSTEMS[case.system]
    assert (case.name, case.system) == (name, name[:-3])
    assert [len(case.calibration), len(case.evaluation), len(case.parameters)] == [3, 2, parameters]
    assert {key: table.shape for key, table in case.tables.items()} == tables
    assert (case.constants, case.noise) == (told["constants"], told.get("noise", {}))
    for parameter in case.parameters:
        given = told["parameters"][parameter.name]
        assert given == {key: getattr(parameter, key) for key in given}
    for trial in (*case.calibration, *case.evaluation):
        assert trial.covariates == told["trial"][trial.name]
        assert trial.signals.values.shape[1] == channels
        assert_is_the_file(trial.time, trial.signals.values, practice / name / "trials" / f"{trial.name}.csv")


def assert_is_the_file(time: np.ndarray, values: np.ndarray, file: Path) -> None:
    """Read once more by the csv module; the practice cases use deg and mm besides SI."""
    with file.open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    factors = [{"deg": math.pi / 180, "mm": 1e-3}.get(cell.split("[")[1].rstrip("]"), 1.0) for cell in header]
    expected = np.array([[float(cell or "nan") for cell in row] for row in rows]) * factors
    np.testing.assert_allclose(np.column_stack([time, values]), expected, rtol=1e-15, atol=0)


def test_some_practice_cases_have_gaps_and_other_units(practice: Path) -> None:
    """So that the comparison above is one of more than plain SI numbers."""
    trials = [file.read_text(encoding="utf-8") for file in practice.glob("*/trials/*.csv")]
    assert sum("[deg]" in text.split("\n", 1)[0] for text in trials) == 10
    assert sum("[mm]" in text.split("\n", 1)[0] for text in trials) == 5
    assert sum(",\n" in text for text in trials) >= 5
