"""How an angle follows its target, and what goes with the force over trials: against numbers planted and by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy import stats

import geocontact as gc
from geocontact.analyses.misalignment.identify.tracking import performance_of, performance_tables, read_scores
from geocontact.axis_misalignment.tracking import goes_with, tracking_of
from geocontact.data.elbow_recording import ElbowRecording

TIME = np.arange(0.0, 30.0, 0.01)


def target_at(time: np.ndarray) -> np.ndarray:
    return np.asarray(0.9 + 0.3 * np.sin(2.0 * np.pi * 0.21 * time) + 0.2 * np.sin(2.0 * np.pi * 0.34 * time + 1.0))


def trial(name: str, gain: float, delay: float, noise: float, force: float) -> ElbowRecording:
    rng = np.random.default_rng(round(1000.0 * (gain + delay)))
    beta = 0.05 + gain * target_at(TIME - delay) + noise * rng.standard_normal(len(TIME))
    return ElbowRecording(
        name, TIME, beta, force * np.sin(TIME), pressure=np.full(len(TIME), 4000.0), target=target_at(TIME)
    )


def test_delay_gain_and_rest_are_those_planted() -> None:
    r = trial("a", 0.9, 0.153, 0.01, 5.0)
    found = tracking_of(r)
    assert found.delay == pytest.approx(0.153, abs=0.003) and found.gain == pytest.approx(0.9, abs=0.003)
    assert found.rest == pytest.approx(0.01, rel=0.05)
    assert found.rmse == pytest.approx(np.sqrt(np.mean((r.beta - target_at(TIME)) ** 2)))
    assert found.bias == pytest.approx(np.mean(r.beta - target_at(TIME)))
    assert found.rms_force == pytest.approx(5.0 / np.sqrt(2.0), rel=0.02)


def test_without_a_target_only_the_force_is_known() -> None:
    found = tracking_of(ElbowRecording("a", TIME, target_at(TIME), np.sin(TIME)))
    assert np.isnan([found.rmse, found.delay, found.pressure]).all() and found.peak_force == pytest.approx(
        1.0, abs=1e-3
    )


def test_slope_and_rank_agree_with_scipy() -> None:
    rng = np.random.default_rng(4)
    x = rng.uniform(1.0, 9.0, 12)
    y = 0.4 * x + rng.standard_normal(12)
    (one,) = goes_with({"y": y}, {"x": x})
    line = stats.linregress(x, y)
    half = stats.t.ppf(0.975, 10) * line.stderr
    np.testing.assert_allclose([one.slope, one.lower, one.upper], [line.slope, line.slope - half, line.slope + half])
    rank = stats.spearmanr(x, y)
    assert one.rank == pytest.approx(rank.statistic) and one.p == pytest.approx(rank.pvalue, abs=0.01)
    assert not goes_with({"y": y[:3]}, {"x": x[:3]}), "three trials say nothing"


def test_error_and_scores_stand_beside_the_force(tmp_path: Path) -> None:
    locked = [trial(f"l{k}", 0.8 - 0.02 * k, 0.2, 0.01, 6.0 + k) for k in range(3)]
    free = [trial(f"f{k}", 0.97 - 0.01 * k, 0.1, 0.01, 1.0 + k) for k in range(3)]
    file = tmp_path / "scores.csv"
    names = [r.name for r in [*locked, *free]]
    pd.DataFrame({"trial": names, "comfort [-]": [3, 2, 1, 6, 5, 4]}).to_csv(file, index=False)
    found = performance_of({"locked": locked, "free": free}, read_scores(file, [*locked, *free]))
    assert found is not None
    tables = performance_tables(found)
    by_condition = tables["tracking_conditions"].set_index(["condition", "measure"])
    assert by_condition.loc[("locked", "comfort [-]"), "mean"] == 2.0 and by_condition["trials"].eq(3).all()
    errors = by_condition.xs("tracking rmse [deg]", level="measure")["mean"]
    assert errors["locked"] > 2.0 * errors["free"]
    related = tables["performance"].set_index("measure")
    assert related.loc["tracking rmse [deg]", "lower"] > 0.0 and related.loc["comfort [-]", "spearman"] < -0.999
    assert set(tables["performance"]["over"]) == {"rms force [N]"}, "the pressure did not change"


def test_scores_of_no_trial_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "scores.csv"
    file.write_text("trial,comfort [-]\nnobody,3\n")
    with pytest.raises(gc.InputError, match="'nobody' is not a recording here"):
        read_scores(file, [trial("a", 0.9, 0.1, 0.0, 1.0)])
