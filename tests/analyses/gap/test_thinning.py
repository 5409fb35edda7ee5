"""Long recordings: which samples are used, that no phase of a movement is missed, that short ones stay as they are."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.gap import thinning
from geocontact.analyses.gap.thinning import ROWS, STRETCH, measured_rows, read_thinned, stretches, thinned
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.io.cases.gap_case_writer import write_gap_case
from tests.gap.cases import elbow_case


def case_of(samples: int, trials: int = 4) -> GapCase:
    """Trials of one input and two outputs; the second is not measured in a fifth of the samples."""
    time = 0.01 * np.arange(samples)
    made = []
    for k in range(trials):
        values = np.column_stack([np.sin(time + k), np.cos(time), np.cos(2.0 * time)])
        values[::5, 2] = np.nan
        made.append(Trial(f"t{k}", Signals(time, values, ("angle", "force", "torque"), ("rad", "N", "N m"))))
    return GapCase("long", "own", tuple(made[:2]), tuple(made[2:]), (), {}, {}, {})


def test_a_short_recording_is_the_same_object() -> None:
    case = case_of(1000)
    assert measured_rows(case, ("force", "torque")) == 4 * 1800 <= ROWS
    assert thinned(case, ("force", "torque")) is case


@pytest.mark.parametrize("samples", [2_000, 20_000, 100_000])
def test_a_long_one_has_as_many_rows_as_it_may(samples: int) -> None:
    case = case_of(samples)
    fewer = thinned(case, ("force", "torque"))
    used = measured_rows(fewer, ("force", "torque"))
    assert 0.85 * ROWS < used < 1.1 * ROWS
    for before, after in zip(case.calibration, fewer.calibration, strict=True):
        np.testing.assert_array_equal(before.column("angle"), after.column("angle"))
        kept = np.isfinite(after.column("force"))
        np.testing.assert_array_equal(after.column("force")[kept], before.column("force")[kept])


def test_many_short_trials_are_thinned_at_other_places() -> None:
    case = case_of(150, 400)
    fewer = thinned(case, ("force",))
    assert measured_rows(fewer, ("force",)) == 400 * STRETCH
    firsts = [
        int(np.flatnonzero(np.isfinite(one.column("force")))[0]) for one in (*fewer.calibration, *fewer.evaluation)
    ]
    assert np.histogram(firsts, 5, (0, 150 - STRETCH))[0].min() > 30


def test_stretches_of_what_is_measured_now_and_then_are_longer() -> None:
    case = case_of(40_000)
    for trial in (*case.calibration, *case.evaluation):
        trial.signals.values[np.arange(40_000) % 10 != 0, 1:] = np.nan
    fewer = thinned(case, ("force",))
    kept = np.flatnonzero(np.isfinite(fewer.calibration[0].column("force"))) // 10
    runs = np.split(kept, np.flatnonzero(np.diff(kept) > 1) + 1)
    assert len(runs) > 10 and min(map(len, runs)) >= STRETCH


def test_nothing_is_said_where_nothing_was_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = elbow_case("", seed=1)
    write_gap_case(case, tmp_path / "case")
    monkeypatch.setattr(thinning, "ROWS", measured_rows(case, ("force",)) - 1)
    monkeypatch.setattr(thinning, "STRETCH", 10_000)
    given = read_thinned(tmp_path / "case", False)
    assert measured_rows(given.case, ("force",)) == measured_rows(case, ("force",))


@pytest.mark.parametrize("period", [50.0, 97.3, 333.0, 411.7, 1000.0])
@pytest.mark.parametrize("share", [0.1, 0.42])
def test_every_phase_of_a_movement_is_met(period: float, share: float) -> None:
    """Against equally spaced stretches, which miss phases where their distance is a multiple of the period."""
    used = stretches(20_000, share)
    phase = (np.flatnonzero(used) / period % 1.0 * 20.0).astype(int)
    count = np.bincount(phase, minlength=20)
    assert count.min() > 0.3 * count.mean()
    edges = np.flatnonzero(np.diff(used.astype(int), prepend=0, append=0))
    assert np.diff(edges)[::2].min() >= STRETCH and used.mean() == pytest.approx(share, rel=0.1)


def test_stretches_spread_over_the_whole_trial() -> None:
    used = stretches(10_000, 0.2)
    assert all(part.mean() == pytest.approx(0.2, abs=0.1) for part in np.split(used, 10))


def test_a_long_case_is_warned_of_when_it_is_read(tmp_path: Path) -> None:
    case = elbow_case("", seed=1)
    write_gap_case(case, tmp_path / "short")
    assert len(read_thinned(tmp_path / "short", False).case.calibration[0]) == len(case.calibration[0])
    repeats = 1 + 2 * ROWS // measured_rows(case, ("force",))
    calibration, evaluation = (
        tuple(longer(one, repeats) for one in side) for side in (case.calibration, case.evaluation)
    )
    write_gap_case(replace(case, calibration=calibration, evaluation=evaluation), tmp_path / "long")
    with pytest.warns(gc.InputWarning, match="samples of the outputs .* are used, in stretches of 60"):
        given = read_thinned(tmp_path / "long", False)
    assert measured_rows(given.case, ("force",)) < 1.1 * ROWS
    assert len(given.case.calibration[0]) == repeats * len(case.calibration[0])


def longer(trial: Trial, times: int) -> Trial:
    """A synthetic trial, one after the other so many times."""
    step = trial.time[1] - trial.time[0]
    values = np.tile(trial.signals.values, (times, 1))
    return replace(trial, signals=replace(trial.signals, time=step * np.arange(len(values)), values=values))
