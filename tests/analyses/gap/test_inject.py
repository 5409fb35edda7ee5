"""A known effect in somebody's own trials, called from Python. All trials are synthetic."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.gap.inject.injection import sentences
from geocontact.data.diagnosis import Diagnosis, Estimate
from geocontact.data.gap_case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.gap.inject import Injected, judged
from geocontact.systems.elastic_joint import JOINT
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
    words = str(result)
    assert (
        f"injected damping (damping.b = {planted:.4g} N s/m" in words and "identified: damping; damping.b = " in words
    )
    assert f"injected {planted:.4g})" in words, "beside the interval"
    assert "(95 % " in words and " -," not in words and not words.endswith(" -"), "a number without a unit has none"
    page = result.page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "<bdi>What was injected</bdi>" in page and '<p class="answer"><bdi>Identified: damping; damping.b = ' in page
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
    assert "not identified, base parameters imitate it" in str(result)
    assert result.record.results["planted"]["absorbed"] is True


def answered(value: float, sd: float, *effects: str) -> Diagnosis:
    """A diagnosis that names these effects, with a damping and its 95 % interval."""
    found = Estimate(value, (value - 1.96 * sd, value + 1.96 * sd), "N s/m", True)
    return Diagnosis("case", "elbow", "explained", effects, {}, (), (), (), {}, {"damping.b": found}, 0.0, "")


NOTHING = Diagnosis("case", "elbow", "no_gap", (), {}, (), (), (), {}, {}, 0.0, "")


@pytest.mark.parametrize(
    ("nats", "before", "after", "status", "change", "holds"),
    [
        (900.0, NOTHING, answered(41.0, 2.0, "damping"), "found", 41.0, True),
        (900.0, NOTHING, answered(67.6, 5.0, "damping"), "found", 67.6, False),
        (900.0, answered(28.0, 3.0, "damping"), answered(68.0, 4.0, "damping"), "found", 40.0, True),
        (900.0, answered(28.0, 3.0, "damping"), answered(29.0, 4.0, "damping"), "there_before", 1.0, False),
        (900.0, answered(28.0, 20.0, "damping"), answered(28.0, 20.0, "damping"), "there_before", 0.0, True),
        (1e-9, answered(28.0, 3.0, "damping"), answered(28.0, 3.0, "damping"), "too_small", None, None),
        (900.0, answered(28.0, 3.0, "damping"), NOTHING, "not_found", None, None),
        (900.0, NOTHING, answered(1.0, 1.0, "dry_friction"), "not_found", None, None),
    ],
)
def test_an_effect_is_judged_by_the_change_against_the_case_before(
    nats: float, before: Diagnosis, after: Diagnosis, status: str, change: float | None, holds: bool | None
) -> None:
    """40.9 N s/m are injected; the interval of the change is that of two independent estimates, by hand."""
    joint = JOINT.build((gc.Parameter("k", "N m/rad", 30.0, 5.0, 80.0),), {}, {})
    damping = next(one for one in candidates(joint) if one.name == "damping")
    made = Injected(GapCase("case", "elbow", (), (), ()), {"damping.b": 40.9, "damping.exponent": 1.0}, 2.0, nats)
    found = judged(damping, made, before, after)
    assert (found.status, found.holds) == (status, holds)
    assert found.before == (before is not NOTHING)
    if change is None:
        assert found.change is None and found.change_ci95 is None
        return
    sds = [each.parameters["damping.b"].ci95 for each in (before, after) if each.parameters]
    half = float(np.hypot(*[0.5 * (high - low) for low, high in [*sds, (0.0, 0.0)][:2]]))
    assert found.change == pytest.approx(change)
    assert found.change_ci95 == pytest.approx((change - half, change + half))
    (said,) = list(sentences(damping, made, after, found))[1:]
    assert ("which excludes the 40.9 injected" in said) == (holds is False)
    assert ("and 0 as well" in said) == (status == "there_before" and holds is True)
    assert said.startswith("identified: damping" if status == "found" else "not identified: damping was missing before")


@pytest.mark.slow
def test_what_the_case_lacked_before_is_not_found_for_having_been_injected(tmp_path: Path) -> None:
    """1e-6 N s/m make 2e-8 of the noise floor in trials that lack a damping of 25 N s/m anyway."""
    case = damped_elbow(tmp_path / "elbow", damping=25.0)
    with unchecked():
        result = gc.inject(case, effect="damping", value={"damping.b": 1e-6}, bare=True)
    assert result.judgement.status == "too_small" and result.judgement.before
    assert "not identified: all trials together hold" in str(result)
    assert "damping is missing from the base model without it, too" in str(result)


@pytest.mark.slow
def test_python_and_command_write_the_same_files(tmp_path: Path) -> None:
    case = damped_elbow(tmp_path / "elbow", damping=0.0)
    with known(), unchecked():
        words = ("--effect", "damping", "--value", "damping.b=12.5", "--bare", "--out", tmp_path / "typed")
        done(call("gap", "inject", case, *words))
        called = gc.inject(case, effect="damping", value={"damping.b": 12.5}, bare=True).write(tmp_path / "called")
    names = [p.relative_to(called) for p in called.rglob("*") if p.is_file() and p.name != "run.json"]
    assert len(names) == 12, sorted(map(str, names))
    for name in names:
        assert (tmp_path / "typed" / name).read_bytes() == (called / name).read_bytes(), name
