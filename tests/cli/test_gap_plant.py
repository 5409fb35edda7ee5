"""`geocontact gap plant`: a known effect in somebody's own trials, and what is said of it. All trials are synthetic."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

from geocontact.analyses.gap.inject.run import _imitated
from tests.cli.calls import Call, call, done
from tests.cli.gap_cases import damped_elbow
from tests.elsewhere import Elsewhere


def plant(case: Path, out: Path, *options: object) -> Call:
    return call("gap", "plant", case, "--bare", "--out", out, *options)


def test_a_planted_effect_is_found(tmp_path: Path, elsewhere: Elsewhere) -> None:
    case, out = damped_elbow(tmp_path / "elbow", damping=0.0), tmp_path / "out"
    said = done(elsewhere(plant, case, out, "--effect", "damping", "--size", 2)).out
    told = json.loads((out / "planted.json").read_text("utf-8"))
    assert (told["effect"], told["named"], told["verdict"]) == ("damping", True, "explained")
    assert told["gap_over_floor"] == pytest.approx(2.0, rel=1e-3)
    planted = told["parameters"]["damping.b"]["value"]
    diagnosis = json.loads((out / "diagnosis" / "diagnosis.json").read_text("utf-8"))
    assert diagnosis["effects"] == ["damping"]
    assert diagnosis["parameters"]["damping.b"]["value"] == pytest.approx(planted, rel=0.1)
    before, after = (pd.read_csv(home / "trials" / "t01.csv") for home in (case, out / "case"))
    assert list(before.columns) == list(after.columns) and not before["force [N]"].equals(after["force [N]"])
    pd.testing.assert_series_equal(before["beta [rad]"], after["beta [rad]"], rtol=1e-8)
    assert (out / "case" / "case.toml").read_bytes() == (case / "case.toml").read_bytes()
    assert f"planted damping (damping.b = {planted:.4g} N s/m" in said and "found: damping; damping.b = " in said


def test_what_base_parameters_imitate_is_said_not_to_be_found(tmp_path: Path, elsewhere: Elsewhere) -> None:
    case = damped_elbow(tmp_path / "elbow", damping=0.0)
    made = done(elsewhere(plant, case, tmp_path / "out", "--effect", "sensor_gain.force"))
    assert "not found, base parameters imitate it" in made.out
    assert made.warnings == ["the amplitude is as large as its bounds admit; base parameters imitate the rest"]
    assert json.loads((tmp_path / "out" / "planted.json").read_text("utf-8"))["absorbed"] is True


def test_a_gap_that_is_there_is_not_called_imitated_because_another_variant_is() -> None:
    sizes = {0.4: False, 1e-4: True, float("nan"): True}
    assert {size: _imitated("sensor_gain", size, ("sensor_gain",)) for size in sizes} == sizes
    assert not _imitated("damping", 1e-4, ("sensor_gain",))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--effect", "rust"), "--effect: 'rust' is no effect of this system; there are time_shift, filter_lag"),
        (("--effect", "unit_error"), "--effect: unit_error has variants; choose one of unit_error.force"),
        (("--effect", "damping", "--value", "b=1"), "--value: 'b' is no parameter of damping; parameters: damping.b"),
        (("--effect", "damping", "--value", "damping.b=x"), "--value: 'x' is no number; write damping.b=1.5"),
        (("--effect", "damping", "--value", "damping.b=-1"), "--value: damping.b = -1 N s/m is outside of 0 …"),
        (("--effect", "damping", "--trial", "t01"), "--trial: damping is in every trial or in none; leave it out"),
        (("--effect", "sign_flip.beta", "--trial", "t9"), "--trial: there is no trial 't9'; trials are t0"),
        (("--effect", "damping", "--size", "0"), "--size: 0 is not a gap above 0; give for example 1"),
    ],
)
def test_what_cannot_be_planted_is_one_line(tmp_path: Path, options: tuple[str, ...], message: str) -> None:
    case = damped_elbow(tmp_path / "elbow", samples=60)
    made = plant(case, tmp_path / "out", *options)
    assert made.code == 2 and len(made.complaints) == 1 and message in made.err
    assert not (tmp_path / "out").exists()


def test_results_do_not_go_into_the_case_they_copy(tmp_path: Path) -> None:
    case = damped_elbow(tmp_path / "elbow", samples=60)
    for out in (case / "out", case):
        made = plant(case, out, "--effect", "damping")
        assert made.code == 2 and "lies inside the case that is copied there" in made.err
    assert not (case / "out").exists()
