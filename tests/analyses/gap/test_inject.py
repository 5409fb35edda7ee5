"""A known effect in somebody's own trials, called from Python. All trials are synthetic."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.gap.inject.words import imitated
from tests.cli.calls import call, done
from tests.cli.gap_cases import damped_elbow, known
from tests.unchecked import unchecked


@pytest.mark.slow
def test_a_planted_effect_is_found(tmp_path: Path) -> None:
    case = damped_elbow(tmp_path / "elbow", damping=0.0)
    with unchecked():
        result = gc.inject(case, effect="damping", size=2.0, bare=True)
    assert result.effect.name == "damping" and result.diagnosis.verdict == "explained"
    assert result.diagnosis.effects == ("damping",)
    assert result.planted.size == pytest.approx(2.0, rel=1e-3)
    row = result.table().set_index("parameter").loc["damping.b"]
    planted = row["planted"]
    assert row["unit"] == "N s/m"
    assert row["found"] == pytest.approx(planted, rel=0.1) and row["low"] < planted < row["high"]
    words = repr(result)
    assert f"injected damping (damping.b = {planted:.4g} N s/m" in words and "found: damping; damping.b = " in words
    out = result.write(tmp_path / "out")
    told = json.loads((out / "planted.json").read_text("utf-8"))
    assert told["named"] and told["parameters"]["damping.b"]["value"] == planted
    before, after = (pd.read_csv(home / "trials" / "t01.csv") for home in (case, out / "case"))
    assert list(before.columns) == list(after.columns) and not before["force [N]"].equals(after["force [N]"])
    pd.testing.assert_series_equal(before["beta [rad]"], after["beta [rad]"], rtol=1e-8)
    assert (out / "case" / "case.toml").read_bytes() == (case / "case.toml").read_bytes()


@pytest.mark.slow
def test_what_base_parameters_imitate_is_said_not_to_be_found(tmp_path: Path) -> None:
    case = damped_elbow(tmp_path / "elbow", damping=0.0)
    with unchecked(), pytest.warns(gc.InputWarning, match="the amplitude is as large as its bounds admit"):
        result = gc.inject(case, effect="sensor_gain.force", bare=True)
    assert "not found, base parameters imitate it" in repr(result)
    assert result.record.results["planted"]["absorbed"] is True


def test_a_gap_that_is_there_is_not_called_imitated_because_another_variant_is() -> None:
    sizes = {0.4: False, 1e-4: True, float("nan"): True}
    assert {size: imitated("sensor_gain", size, ("sensor_gain",)) for size in sizes} == sizes
    assert not imitated("damping", 1e-4, ("sensor_gain",))


@pytest.mark.slow
def test_python_and_command_write_the_same_files(tmp_path: Path) -> None:
    case = damped_elbow(tmp_path / "elbow", damping=0.0)
    with known(), unchecked():
        words = ("--effect", "damping", "--value", "damping.b=12.5", "--bare", "--out", tmp_path / "typed")
        done(call("gap", "inject", case, *words))
        called = gc.inject(case, effect="damping", value={"damping.b": 12.5}, bare=True).write(tmp_path / "called")
    names = [p.relative_to(called) for p in called.rglob("*") if p.is_file() and p.name != "run.json"]
    assert len(names) == 11, sorted(map(str, names))
    for name in names:
        assert (tmp_path / "typed" / name).read_bytes() == (called / name).read_bytes(), name
