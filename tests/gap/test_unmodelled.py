"""What no effect is, described: a zero of each trial's own, lost samples, a load by its place. Data are synthetic."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.diagnose import diagnose
from geocontact.gap.unmodelled import regions, slip_of
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.test_slip_and_play import joint_case, wander

Column = np.ndarray
ZEROS = {"t0": 2.5, "t1": -3.0, "t2": 1.0, "t3": -2.0, "t4": 3.5}
"""Of each trial [N m], many times what zeros and placement usually differ by."""
LOST = {"t0": (7, 0.45), "t1": (0, 0.0), "t2": (5, 0.6), "t3": (8, 0.3), "t4": (6, 0.7)}
"""Samples that the torque of each trial lost, and at which share of it."""


def spring(_: Column, angle: Column) -> Column:
    return 31.0 * (angle - 0.05)


def altered(case: GapCase, change: Callable[[str, Column], Column]) -> GapCase:
    """The torque of each trial as `change` has it."""

    def of(trial: Trial) -> Trial:
        values = trial.signals.values.copy()
        values[:, 1] = change(trial.name, values[:, 1])
        return replace(trial, signals=replace(trial.signals, values=values))

    return replace(case, calibration=tuple(map(of, case.calibration)), evaluation=tuple(map(of, case.evaluation)))


def without(name: str, torque: Column) -> Column:
    """Samples lost, the file filled up with the last one."""
    count, share = LOST[name]
    at = round(share * len(torque))
    return np.concatenate([torque[:at], torque[at + count :], np.full(count, torque[-1])])


def said(sort: str) -> Diagnosis:
    """Diagnosis of a case of this sort."""
    case = {
        "zero": lambda: altered(joint_case(spring), lambda name, torque: torque + ZEROS[name]),
        "lost": lambda: altered(joint_case(spring), without),
        "load": lambda: joint_case(wander),
        "nothing": lambda: joint_case(spring),
    }[sort]()
    return diagnose(case, system_of(case)).diagnosis


def test_a_slip_is_found_at_its_place_and_number() -> None:
    """Beside all places and numbers, one after the other."""
    rng, n = np.random.default_rng(2), 240
    predicted = np.cumsum(rng.standard_normal(n + 20))[: n + 20]
    measured = np.concatenate([predicted[:100], predicted[106 : n + 6]]) + 0.3 * rng.standard_normal(n)
    measured[30:40] = np.nan
    found = slip_of(measured, predicted[:n], 15)
    assert found is not None and (found.samples, found.place) == (6, 99)
    costs = {}
    for m in range(-15, 16):
        for place in range(n):
            at = np.arange(n)
            at = np.clip(at + np.where(at > place, m, 0), 0, n - 1)
            costs[m, place] = float(np.nansum((measured - predicted[:n][at]) ** 2))
    least = min(costs, key=lambda key: costs[key])
    assert least == (6, 99) and found.after == pytest.approx(costs[least])
    assert found.before == pytest.approx(min(costs[m, 0] for m in range(-15, 16)), rel=0.05)


def test_noise_and_a_constant_delay_have_no_slip() -> None:
    rng, n = np.random.default_rng(3), 240
    predicted = np.sin(0.1 * np.arange(n))
    for measured in (predicted, np.roll(predicted, 3)):
        assert slip_of(measured + 0.1 * rng.standard_normal(n), predicted, 15) is None


def test_sums_of_regions_are_those_of_their_samples() -> None:
    rng, n = np.random.default_rng(4), 200
    residuals, present = [rng.standard_normal(n) for _ in range(2)], [rng.random(n) > 0.1 for _ in range(2)]
    phase = [np.minimum((np.arange(n) / n * 20).astype(int), 19)] * 2
    state = [rng.integers(0, 8, n) for _ in range(2)]
    found = regions(residuals, present, {"phase": phase, "angle": state})
    for place in rng.integers(0, found.sums.shape[-1], 40):
        (begin, end), (name, quarter, way) = found.of(int(place))
        for i in range(2):
            inside = present[i] & (phase[i] >= begin) & (phase[i] < end)
            if name:
                inside &= (state[i] // 2 == quarter) & ((way < 0) | (state[i] % 2 == way))
            assert found.counts[i, place] == inside.sum()
            assert found.sums[i, :, place].sum() == pytest.approx(residuals[i][inside].sum())


@pytest.mark.slow
def test_a_zero_of_each_trials_own_is_described(elsewhere: Elsewhere) -> None:
    d = elsewhere(said, "zero")
    assert d.verdict == "unknown" and d.effects == ()
    (one,) = d.unmodelled
    assert one.kind == "wandering_zero" and one.channel == "torque" and one.share > 0.8
    mean = sum(ZEROS.values()) / len(ZEROS)
    for name, size in ZEROS.items():
        assert one.trials[name] == pytest.approx(size - mean, abs=0.15)
    assert one.told.startswith("zero of torque differs from trial to trial")


@pytest.mark.slow
def test_lost_samples_are_counted_in_each_trial(elsewhere: Elsewhere) -> None:
    d = elsewhere(said, "lost")
    assert d.verdict in ("unknown", "partly_explained")
    (one,) = d.unmodelled
    assert one.kind == "lost_samples" and one.share > 0.5
    assert one.trials == {name: float(count) for name, (count, _) in LOST.items() if count}


@pytest.mark.slow
def test_a_load_that_was_not_recorded_has_its_place(elsewhere: Elsewhere) -> None:
    """Bumps of 1.2 N m at 30 and 70 % of every trial: two places, either with its sign."""
    d = elsewhere(said, "load")
    up, down = sorted(d.unmodelled, key=lambda one: one.phase or (0.0, 0.0))
    assert {one.kind for one in d.unmodelled} == {"unrecorded_load"}
    assert up.phase and down.phase and up.phase[0] < 0.3 < up.phase[1] and down.phase[0] < 0.7 < down.phase[1]
    assert ": +" in up.words and ": -" in down.words


@pytest.mark.slow
def test_where_nothing_is_missing_nothing_is_described(elsewhere: Elsewhere) -> None:
    d = elsewhere(said, "nothing")
    assert (d.verdict, d.unmodelled) == ("no_gap", ())
