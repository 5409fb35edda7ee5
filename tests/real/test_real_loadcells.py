"""Load cells of the 4th Grand Challenge's subject: the recording as it comes, in pound-force."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.cli.calls import Call, call, done, written


@pytest.fixture(scope="module")
def og3(data_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Call:
    out = tmp_path_factory.mktemp("og3") / "out"
    file = data_dir / "gc4_jw_knee" / "knee_forces" / "jw_ngait_og3_knee_forces.csv"
    return done(call("loadcells", file, "--unit", "lbf", "--cycles", "stance", "--out", out, folder=out))


def test_peaks_of_normal_gait(og3: Call) -> None:
    """Total 1601 N as in the project's notes. The notes' medial 1076 and lateral 597 N are not what the regression
    gives on this file (1025 and 594 N); the two medial cells alone reach 1042 N."""
    peaks = og3.table("forces.csv").max()
    assert peaks["total [N]"] == pytest.approx(1601.0, abs=1.0)
    assert peaks["medial [N]"] == pytest.approx(1024.9, abs=0.5)
    assert peaks["lateral [N]"] == pytest.approx(594.2, abs=0.5)
    assert og3.warnings == []


def test_two_stances_of_a_plausible_length(og3: Call) -> None:
    """Load for 0.81 s of strides of 1.16 s; the gait cycles of this subject that are in print last 1.08 to 1.16 s."""
    cycles = og3.table("cycles.csv")
    assert len(cycles) == 2
    assert (cycles["end [s]"] - cycles["start [s]"]).between(0.79, 0.83).all()
    assert np.diff(cycles["start [s]"]) == pytest.approx([1.16], abs=0.01)
    ensemble = og3.table("ensemble.csv")
    assert ensemble["medial_mean [N]"].max() == pytest.approx(985.0, abs=10.0)
    np.testing.assert_allclose(
        ensemble["medial_mean [N]"] + ensemble["lateral_mean [N]"], ensemble["total_mean [N]"], rtol=1e-9
    )


def test_compartments_that_are_given_already(data_dir: Path, tmp_path: Path) -> None:
    """KCF_ref.mot names medial and lateral: weights of one and nought only change the unit."""
    tray = written(tmp_path / "as_is.toml", 'cells = ["medial", "lateral"]\nmedial = [1.0, 0.0]\n')
    file = data_dir / "gc4_jw_predsim_workshop" / "KCF_ref.mot"
    out = tmp_path / "out"
    result = done(call("loadcells", file, "--unit", "lbf", "--matrix", tray, "--out", out, folder=out))
    table = result.table("forces.csv")
    assert len(table) == 327
    assert table["medial [N]"][0] == pytest.approx(228.033906 * 4.4482216, rel=1e-6)
    assert table["total [N]"].max() == pytest.approx(1740.3, abs=0.5)
