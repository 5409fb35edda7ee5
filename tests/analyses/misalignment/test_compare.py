"""A law or a simulation beside recordings."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.misalignment.compare.pairs import Pair
from geocontact.analyses.misalignment.compare.result import goodness_of
from geocontact.identify.signals.agreement import agreement
from tests.analyses.misalignment.trials import STROKE, changed, free, locked, quietly, recorded

TRUTH = {"k_N_per_m": 222.43, "x_mm": 48.0, "y_mm": 59.0, "l_mm": 169.0, "z_mm": 127.0}
TRUTH |= {"b_N_s_per_m": 0.0, "s_per_mmHg": 0.0}


def law(folder: Path, pressure: float | None = None, **numbers: float) -> Path:
    """elbow.json with the true numbers, or others."""
    file = folder / "elbow.json"
    file.write_text(json.dumps({"numbers": TRUTH | numbers, "pressure_mmHg": pressure}))
    return file


def compare(*recordings: Path, **options: Any) -> Any:
    return quietly(gc.misalignment.compare, *recordings, **options)


def test_a_law_is_compared_trial_by_trial_and_channel_by_channel(tmp_path: Path, made: Path) -> None:
    result = compare(*free(made), fit=law(tmp_path), stroke=STROKE)
    table = result.table()
    assert list(table["channel"]) == ["force", "displacement"] * 3 and list(table["unit"]) == ["N", "mm"] * 3
    force, slide = table[table["channel"] == "force"], table[table["channel"] == "displacement"]
    np.testing.assert_allclose(force["rmse"], 0.2, rtol=0.2)  # the noise alone
    assert (force["mae"] < force["rmse"]).all() and (slide["r2 [-]"] > 0.9999).all() and (slide["rmse"] < 0.1).all()
    first = result.pairs[0].agreement
    assert str(result).startswith(f"free_1, force: MAE {first.mae:.3g}, RMSE {first.rmsd:.3g} N, R² {first.r2:.3f}")
    with pytest.raises(KeyError, match="there are force, displacement"):
        result.figure("pressure")


def test_two_sets_of_recordings_are_compared(made: Path) -> None:
    one = locked(made)[0]
    (pair,) = compare(one, simulated=(one,)).pairs
    assert pair.agreement.mae == 0.0 and pair.agreement.r2 == 1.0


def test_a_stiffness_that_follows_the_pressure_counts_it_from_where_the_law_says(tmp_path: Path) -> None:
    design: dict[str, Any] = {
        "noise": 0.01,
        "bits": 0,
        "pressure": gc.mmHg(10, 60),
        "numbers": {"s": 0.01 / gc.mmHg(1)},
    }
    files = locked(recorded(tmp_path, **design))
    right = compare(*files, fit=law(tmp_path, pressure=35.0, s_per_mmHg=0.01)).table()
    np.testing.assert_allclose(right["rmse"], 0.01, rtol=0.5)
    moved = compare(*files, fit=law(tmp_path, pressure=55.0, s_per_mmHg=0.01)).table()
    assert (moved["rmse"] > 0.3).all(), "20 mmHg of 0.01 each are a fifth of the force"
    assert (moved["r2 [-]"] > 0.5).all()


def test_what_does_worse_than_a_constant_is_warned_of(tmp_path: Path, made: Path) -> None:
    noise = changed(locked(made)[2], tmp_path, "noise.csv", force=lambda t: 8.0 * np.sin(9.0 * t["time [s]"]) + 5.0)
    result = compare(noise, fit=law(tmp_path))
    # more than a warning: a law that a constant beats is contradicted by the recording
    assert result.fit_outcome == "contradicts" and "R² is below 0 in noise (-" in result.sentences[0]


def test_comparisons_that_cannot_be_are_refused(tmp_path: Path, made: Path) -> None:
    one, two, _ = locked(made)
    bare = tmp_path / "bare.csv"
    pd.read_csv(one)[["time [s]", "beta [deg]", "force [N]"]].to_csv(bare, index=False)
    cases: list[tuple[Path, dict[str, Any], str]] = [
        (one, {}, "`fit`: or `simulated`: exactly one is compared with"),
        (one, {"simulated": (one, two)}, "`simulated`: is given 2 times for 1 recording"),
        (one, {"simulated": (two,)}, "degrees, root mean square, from that of the model's recording"),
        (one, {"simulated": (one,), "stroke": STROKE}, "`stroke`: has no effect without `fit`"),
        (bare, {"fit": law(tmp_path, 30.0, s_per_mmHg=0.01)}, "follows the cuff's pressure"),
    ]
    for recording, options, said in cases:
        with pytest.raises(gc.InputError, match=said):
            compare(recording, **options)


def test_factors_that_differ_are_no_gain_of_all_trials() -> None:
    """1.35 in both trials is one gain; 1.35 and 0.7 have no cause in common, nor have 1.35 and 1.8."""
    time = 0.01 * np.arange(101)
    force = 20.0 * np.sin(2.0 * np.pi * time)

    def said(*gains: float) -> bool:
        pairs = [
            Pair(f"t{k}", "force", time, time, gain * force, force, agreement(force, gain * force, 0.01))
            for k, gain in enumerate(gains)
        ]
        return any("times the model's in every trial" in each.what for each in goodness_of(pairs).doubts)

    assert said(1.35, 1.35) and said(1.35, 1.5)
    assert not said(1.35, 0.7) and not said(1.35, 1.8)
