"""Long recordings: which samples are used, that no phase of a movement is missed, that short ones stay as they are."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.gap import thinning
from geocontact.analyses.gap.thinning import (
    BEGINNING,
    ROWS,
    STRETCH,
    measured_rows,
    reaches,
    read_thinned,
    rows_around,
    stretches,
    thinned,
    thinned_and_said,
    turning_points,
    with_inputs_around,
)
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap.levels import FEWEST
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.systems.catalogue import system_of
from tests.gap.cases import TRUE, elbow_case
from tests.systems.examples import measured, shoulder, shoulder_trial


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


def test_stretches_are_longer_where_many_inputs_stay_around_them() -> None:
    """At 200 Hz 1.59 s around each are 318 samples, five times as many as a stretch of 60 has."""
    case = case_of(100_000, 5)
    quick = tuple(replace(one, signals=replace(one.signals, time=0.5 * one.time)) for one in case.calibration)
    case = replace(case, calibration=quick, evaluation=())
    rows = {}
    for around in (0.0, 1.59):
        (few, *_) = thinned(case, ("force",), around).calibration
        edges = np.flatnonzero(np.diff(np.isfinite(few.column("force")).astype(int), prepend=0, append=0))
        lengths = np.diff(edges)[::2]
        assert lengths.min() == lengths.max() == (60 if around == 0.0 else round(318 / 2.2))
        assert lengths.sum() == pytest.approx(0.5 * ROWS, rel=0.03)
        rows[around] = len(lengths) * (lengths[0] + 318)
    assert rows[1.59] < 0.52 * rows[0.0]


def test_a_trial_has_five_stretches_where_so_many_fit() -> None:
    """Of 2 s around each, a stretch would be 182 samples long at 200 Hz; a fifth of the 700 in use is 140."""
    case = case_of(100_000, 12)
    quick = tuple(replace(one, signals=replace(one.signals, time=0.5 * one.time)) for one in case.calibration)
    case = replace(case, calibration=6 * quick, evaluation=())
    for few in thinned(case, ("force",), 2.0).calibration:
        edges = np.diff(np.isfinite(few.column("force")).astype(int), prepend=0, append=0)
        assert (edges == 1).sum() == 5 and (edges != 0).sum() == 10


def test_nothing_is_said_where_nothing_was_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = elbow_case("", seed=1)
    write_gap_case(case, tmp_path / "case")
    monkeypatch.setattr(thinning, "ROWS", measured_rows(case, ("force",)) - 1)
    monkeypatch.setattr(thinning, "STRETCH", 10_000)
    given = read_thinned(tmp_path / "case", False)
    assert measured_rows(given.case, ("force",)) == measured_rows(case, ("force",))


LEAD, AHEAD = 60, 64
"""Samples before and behind a stretch, at 25 Hz."""
TIME = 0.04 * np.arange(20_000)


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


def test_inputs_stay_around_every_stretch_and_sparsely_between() -> None:
    measured = np.zeros(20_000, dtype=bool)
    measured[5000:5060] = measured[5100:5160] = measured[19_000:19_060] = True
    rows = np.flatnonzero(np.any(rows_around(TIME, measured, 0.04 * LEAD, 0.04 * AHEAD), axis=0))
    whole = [(0, BEGINNING), (5000 - LEAD, 5160 + AHEAD), (19_000 - LEAD, 19_060 + AHEAD), (19_999, 20_000)]
    for first, last in whole:
        assert np.isin(np.arange(first, last), rows).all()
    for (_, first), (last, _) in pairwise(whole):
        there = rows[(rows >= first) & (rows < last)]
        steps = np.diff([first - 1, *there, last])
        assert steps.min() >= FEWEST and steps[-1] == FEWEST and len(there) < 25
        assert (np.diff(steps[1:]) < 0).all() and np.ptp(steps[1:-1] / steps[2:]) < 0.1


def test_a_short_pause_between_stretches_is_none() -> None:
    measured = np.zeros(3_000, dtype=bool)
    measured[700:760] = measured[904:964] = True  # 760 + AHEAD to 904 - LEAD are 20 samples: nothing is left out there
    kept, sparse = rows_around(TIME[:3_000], measured, 0.04 * LEAD, 0.04 * AHEAD)
    rows = np.flatnonzero(kept)
    assert not (kept & sparse).any() and np.isin(np.arange(700 - LEAD, 964 + AHEAD), rows).all() and len(rows) < 1_000


@pytest.mark.parametrize(
    ("effect", "values", "most"),
    [
        ("", {}, 1e-6),
        ("damping", {"damping.b": 40.0, "damping.exponent": 1.0}, 1e-6),
        ("play.beta", {"play.beta.width": 0.05, "play.beta.start": 0.4}, 1e-6),
        ("filter_lag", {"filter_lag.lag": 0.2, "filter_lag.order": 2.0}, 1e-6),
        ("time_shift", {"time_shift.delay": 0.3}, 1e-6),
        ("relaxation", {"relaxation.ratio": 0.5, "relaxation.tau": 0.6}, 1e-3),
        ("relaxation", {"relaxation.ratio": 0.5, "relaxation.tau": 6.0}, 0.015),
        ("relaxation", {"relaxation.ratio": 0.5, "relaxation.tau": 300.0}, 0.03),
        ("sensor_drift.force", {"sensor_drift.force.rate": 0.02, "sensor_drift.force.bend": 1.0}, 1e-6),
    ],
)
def test_pieces_are_simulated_as_in_the_whole_trial(effect: str, values: dict[str, float], most: float) -> None:
    """What a model predicts of the samples in use, against its prediction from all inputs."""
    case = elbow_case("", seed=3, duration=1200.0)
    system = system_of(case).scaled(case.calibration, TRUE)
    model = next((one.apply(system) for one in candidates(system) if one.label == effect), system)
    assert bool(effect) == (model is not system)
    with patch.object(thinning, "ROWS", 2_000):
        fewer = with_inputs_around(thinned(case, ("force",)), ("force",), ("beta",))
    for whole, pieces in zip(case.calibration, fewer.calibration, strict=True):
        assert len(pieces) < 0.2 * len(whole) and pieces.time[-1] == whole.time[-1]
        expected, found = (model.simulate(one, {**TRUE, **values}) for one in (whole, pieces))
        used = np.isfinite(pieces.column("force"))
        off = found[used] - expected[np.searchsorted(whole.time, pieces.time[used])]
        assert np.sqrt(np.mean(off**2)) < most * expected.std()


def test_an_arm_that_swings_is_where_it_is_in_the_whole_trial() -> None:
    """The shoulder has a motion of its own, which goes on between two pieces along the means of its input."""
    system = shoulder()
    whole = measured(system, shoulder_trial("t1", 1.0, 0.5, duration=300.0))
    case = GapCase("long", "shoulder", (whole,), (), (), {}, {}, {})
    with patch.object(thinning, "ROWS", 800):
        (pieces,) = with_inputs_around(thinned(case, system.outputs), system.outputs, system.inputs).calibration
    assert len(pieces) < 0.15 * len(whole)
    expected, found = (system.simulate(one, system.start) for one in (whole, pieces))
    used = np.isfinite(pieces.column("force"))
    off = found[used] - expected[np.searchsorted(whole.time, pieces.time[used])]
    assert used.sum() > 300 and (np.sqrt(np.mean(off**2, axis=0)) < 3e-3 * expected.std(axis=0)).all()


def arm(rate: float, lasts: float, holds: bool = False, empty: float = 0.0) -> Trial:
    """An elbow in two sines, or in bursts of 1 Hz and holds of 15 s; a share of cells is empty."""
    rng, time = np.random.default_rng(0), np.arange(round(lasts * rate)) / rate
    beta = 0.2 * np.sin(2.0 * np.pi * 0.8 * time) + 0.1 * np.sin(2.0 * np.pi * 0.23 * time)
    if holds:
        turns = np.cumsum(time % 17.0 < 2.0) / rate
        beta = 0.2 * np.sin(2.0 * np.pi * 1.0446 * turns) * (0.5 + 0.5 * np.sin(0.01 * time) ** 2)
    beta[rng.random(len(time)) < empty] = np.nan
    signals = Signals(time, np.column_stack([beta, np.zeros(len(time))]), ("beta", "force"), ("rad", "N"))
    return Trial(f"{rate:g} Hz", signals)


def in_pieces(rows: int, *trials: Trial) -> GapCase:
    case = replace(elbow_case("", seed=3), calibration=trials, evaluation=())
    with patch.object(thinning, "ROWS", rows):
        return with_inputs_around(thinned(case, ("force",)), ("force",), ("beta",))


def misses(case: GapCase, trials: tuple[Trial, ...], effect: str, values: dict[str, float]) -> np.ndarray:
    """Rms of what predictions from pieces miss those from whole trials by [N], and standard deviation of the latter."""
    system = system_of(case).scaled(trials, TRUE)
    model = next(one.apply(system) for one in candidates(system) if one.label == effect)
    found = []
    for whole, pieces in zip(trials, case.calibration, strict=True):
        expected, seen = (model.simulate(one, {**TRUE, **values}) for one in (whole, pieces))
        used = np.isfinite(pieces.column("force"))
        off = seen[used] - expected[np.searchsorted(whole.time, pieces.time[used])]
        found.append((np.sqrt(np.mean(off**2)), expected.std()))
    return np.array(found).T


@pytest.mark.parametrize(
    ("effect", "values", "most"),
    [
        ("clock_slip.once", {"clock_slip.once.delay": -0.5, "clock_slip.once.when": 0.5}, 1e-6),
        ("clock_slip.once", {"clock_slip.once.delay": 0.5, "clock_slip.once.when": 0.5}, 1e-6),
        ("filter_lag", {"filter_lag.lag": 0.5, "filter_lag.order": 2.0}, 5e-3),
        ("relaxation", {"relaxation.ratio": 0.5, "relaxation.tau": 4.0}, 0.03),
        ("relaxation", {"relaxation.ratio": 0.5, "relaxation.tau": 60.0}, 0.04),
    ],
)
def test_pieces_of_quicker_recordings_are_as_good(effect: str, values: dict[str, float], most: float) -> None:
    """At 100 Hz; effects at the ends of their ranges."""
    trial = arm(100.0, 600.0)
    case = in_pieces(700, trial)
    missed, size = misses(case, (trial,), effect, values)
    assert len(case.calibration[0]) < 0.1 * len(trial) and (missed < most * size).all()


def test_lags_of_mixed_rates_are_those_of_the_slower() -> None:
    trials = arm(1000.0, 40.0), arm(100.0, 200.0), arm(100.0, 200.0)
    case = in_pieces(2_000, *trials)
    assert all(len(few) < 0.8 * len(whole) for few, whole in zip(case.calibration, trials, strict=True))
    for effect, values in (
        ("clock_slip.once", {"clock_slip.once.delay": -0.5, "clock_slip.once.when": 0.5}),
        ("play.beta", {"play.beta.width": 0.1, "play.beta.start": 0.0}),
    ):
        missed, size = misses(case, trials, effect, values)
        assert (missed < 1e-3 * size).all(), effect


def test_the_rate_of_a_clock_is_sought_as_far_as_inputs_reach() -> None:
    """-0.05 % over 1000 s of 100 Hz, half of the lags that inputs stay for; whole trials have the former range."""
    trial = arm(100.0, 1000.0)
    case = in_pieces(1_200, trial)
    (own,) = (one for one in candidates(system_of(case).scaled(case.calibration)) if one.label == "clock_slip.steady")
    (rate,) = own.parameters
    assert rate.upper == -rate.lower == pytest.approx(50 * 0.01 / 1000.0, rel=1e-3)
    missed, size = misses(case, (trial,), "clock_slip.steady", {rate.name: rate.lower})
    assert missed[0] < 1e-6 * size[0]
    (own,) = (one for one in candidates(system_of(case).scaled((trial,))) if one.label == "clock_slip.steady")
    assert own.parameters[0].upper == 0.1


def test_play_and_friction_remember_from_which_side_a_hold_was_reached() -> None:
    """Synthetic: limits in shares of a noise of 0.12 N; means alone were off by one to four times as much."""
    trial = arm(100.0, 1000.0, holds=True)
    case = in_pieces(1_200, trial)
    for effect, values in (
        ("play.beta", {"play.beta.width": 0.1, "play.beta.start": 0.0}),
        ("dry_friction.stroke", {"dry_friction.stroke.limit": 2.0, "dry_friction.stroke.reach": 0.01}),
    ):
        missed, _ = misses(case, (trial,), effect, values)
        assert missed[0] < 0.25 * 0.12, effect


def test_turning_points_are_those_that_hysteresis_keeps() -> None:
    """Of 3 (wiped out by 5), 5, -4, 2 (by 3), -1 (by -2), 3, -2, and the value at the end, 0."""
    stops = np.array([0.0, 3.0, -3.0, 5.0, -4.0, 2.0, -1.0, 3.0, -2.0, 0.0])
    values = np.interp(np.arange(91), 10 * np.arange(10), stops)
    values[[5, 35]] = np.nan
    found = turning_points(values, 1e-3)
    assert sorted(values[found]) == [-4.0, -2.0, 3.0, 5.0]
    assert not len(turning_points(np.full(20, np.nan), 0.0)) and not len(turning_points(np.ones(20), 0.0))


def test_a_cell_that_was_not_measured_is_not_made_up() -> None:
    """One of a hundred is empty, as where a marker is hidden: nearly every mean has one in it."""
    trial = arm(100.0, 600.0, empty=0.01)
    case = in_pieces(700, trial)
    beta = case.calibration[0].column("beta")
    system = system_of(case)
    few, whole = (system.scaled(one).scale.span["beta"] for one in (case.calibration, (trial,)))
    assert np.isfinite(beta).mean() > 0.98 and few == pytest.approx(whole, rel=0.05)
    missed, size = misses(case, (trial,), "relaxation", {"relaxation.ratio": 0.5, "relaxation.tau": 60.0})
    assert missed[0] < 0.05 * size[0]


def test_where_a_trial_moves_most_stays_whole() -> None:
    """Seven seconds of rest first; spectra, half-ranges and the next experiment are taken from there."""
    trial = arm(100.0, 600.0)
    trial.signals.values[:700, 0] *= 1e-3
    (few,) = in_pieces(700, trial).calibration
    long = [rows for rows in few.runs if rows.start and rows.stop - rows.start >= BEGINNING]
    assert len(long) == 1 and np.std(few.column("beta")[long[0]]) > 0.9 * np.std(trial.column("beta"))
    assert reaches(replace(elbow_case(""), calibration=(trial,), evaluation=())) == pytest.approx((1.2, 0.64))


def test_simulators_of_others_see_all_inputs() -> None:
    own, others = "geocontact.systems.elastic_joint:JOINT", "lab.models:JOINT"
    said = {}
    for system in (own, others, "command"):
        case = replace(case_of(20_000), system=system)
        fewer, said[system] = thinned_and_said(case, joint_of(case))
        assert (len(fewer.calibration[0]) < 20_000) == (system == own)
    assert len(said[others]) == len(said["command"]) == len(said[own]) - 1


def joint_of(case: GapCase) -> System:
    """An elastic joint that predicts the torque of `case_of`."""
    joint = replace(
        case, system="geocontact.systems.elastic_joint:JOINT", parameters=(Parameter("k", "N m/rad", 20.0, 5.0, 80.0),)
    )
    return system_of(joint)


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
    whole, used = given.case.calibration[0], longer(case.calibration[0], repeats)
    assert (whole.time[0], whole.time[-1]) == pytest.approx((used.time[0], used.time[-1]))


def longer(trial: Trial, times: int) -> Trial:
    """A synthetic trial, one after the other so many times."""
    step = trial.time[1] - trial.time[0]
    values = np.tile(trial.signals.values, (times, 1))
    return replace(trial, signals=replace(trial.signals, time=step * np.arange(len(values)), values=values))


def test_a_column_that_the_model_does_not_use_decides_nothing() -> None:
    """Of a large unit, and recorded for the first minute only."""
    plain = arm(100.0, 600.0)
    spare = np.where(plain.time < 60.0, 1e4 * np.sin(plain.time), np.nan)
    values = np.column_stack([plain.signals.values, spare])
    signals = Signals(plain.time, values, (*plain.signals.channels, "emg"), (*plain.signals.units, "V"))
    (alone,), (beside,) = (in_pieces(700, one).calibration for one in (plain, replace(plain, signals=signals)))
    assert np.array_equal(alone.time, beside.time)
    assert np.array_equal(alone.column("beta"), beside.column("beta"))


def test_an_input_s_unit_decides_nothing() -> None:
    """An angle beside a force that is a million times as large, and moves little while the angle swings."""
    angle = arm(100.0, 600.0)
    slow = 1e6 * np.clip(angle.time / 600.0, 0.0, 1.0)
    values = np.column_stack([angle.signals.values, slow])
    signals = Signals(angle.time, values, ("beta", "force", "load"), ("rad", "N", "N"))
    case = replace(elbow_case("", seed=3), calibration=(replace(angle, signals=signals),), evaluation=())
    with patch.object(thinning, "ROWS", 700):
        (both,) = with_inputs_around(thinned(case, ("force",)), ("force",), ("beta", "load")).calibration
    middle = both.column("beta")[~np.isin(both.time, angle.time)]  # means lie between the samples
    assert len(middle) > 20 and np.ptp(middle) > 0.2


def test_a_long_trial_in_which_nothing_moves_stays_beside_one_that_does() -> None:
    still = arm(100.0, 600.0)
    values = np.column_stack([np.full(len(still), 0.1), np.zeros(len(still))])
    held = replace(still, signals=replace(still.signals, values=values))
    _, found = in_pieces(700, still, held).calibration
    assert len(found) < 0.2 * len(held) and (found.column("beta") == 0.1).all()


def test_inputs_reach_further_where_a_trial_is_longer_or_slower_than_the_fitted_ones() -> None:
    """50 steps of a clock over the fitted 60 s are 500 over 600 s; a trial at 25 Hz has steps of 40 ms."""
    fitted = replace(elbow_case("", seed=3), calibration=(arm(100.0, 60.0),), evaluation=())
    ahead = [reaches(replace(fitted, evaluation=each))[1] for each in ((), (arm(100.0, 600.0),), (arm(25.0, 60.0),))]
    assert ahead == pytest.approx([0.64, 0.5 * 599.99 / 59.99 + 0.14, 2.0 + 0.56], rel=1e-3)
