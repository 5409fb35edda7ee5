"""What to record next: a menu that is what its words say, and the change that theory would choose."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.trial import Trial
from geocontact.gap.experiment.menu import HELD, HOLDS, _settings, bench, liveliest_piece, menu, swap
from geocontact.gap.experiment.proposal import Rows
from tests.elsewhere import Elsewhere
from tests.gap.identifiability_cases import LAG, on_the_menu, proposed
from tests.systems.examples import KNEE_CONSTANTS, example, knee, knee_trial


@pytest.fixture(scope="module")
def changes(elsewhere: Elsewhere) -> dict[str, tuple[str, Trial]]:
    return elsewhere(on_the_menu)


def test_what_is_changed_is_the_liveliest_piece_of_a_trial() -> None:
    """After a rest at the beginning, and not the rest; of a trial with uneven steps all."""
    trial, system = knee_trial("t01", 1.0), knee()
    assert liveliest_piece(system, trial) is trial
    count, signals = len(trial), trial.signals
    first = int(np.ceil(0.6 * count))
    time = signals.time + 100.0 * (np.arange(count) >= first)
    values = np.where(np.arange(count)[:, None] < first, signals.values[0], signals.values)
    resting = replace(trial, signals=replace(signals, time=time, values=values))
    assert liveliest_piece(system, resting) is resting
    pieces = (time[0], time[first - 1]), (time[first], time[-1])
    later = liveliest_piece(system, replace(resting, pieces=pieces))
    np.testing.assert_array_equal(later.time, time[first:])
    np.testing.assert_array_equal(later.signals.values, values[first:])
    assert not later.pieces


def test_a_faster_trial_goes_the_same_way_in_the_time_that_its_words_say(
    changes: dict[str, tuple[str, Trial]],
) -> None:
    words, quick = changes["faster"]
    factor = float(re.findall(r"([\d.]+) times as fast", words)[0])
    before = changes["as it was"][1]
    ratio = (before.time[-1] - before.time[0]) / (quick.time[-1] - quick.time[0])
    assert factor > 1.25 and ratio == pytest.approx(factor, rel=0.05)
    went = np.interp(before.time[0] + (before.time[-1] - before.time[0]) * np.linspace(0, 0.98, 50), before.time,
                     before.column("beta"))  # fmt: skip
    goes = np.interp(ratio * np.linspace(0, 0.98, 50) * (quick.time[-1]), ratio * quick.time, quick.column("beta"))
    assert np.corrcoef(went, goes)[0, 1] > 0.99
    low, high = map(float, re.findall(r"at ([\d.]+)–([\d.]+) Hz", words)[0])
    assert 0.05 * factor < low < high < 0.6 * factor


def test_steps_are_held(changes: dict[str, tuple[str, Trial]]) -> None:
    words, held = changes["step and hold"]
    rate = np.abs(np.gradient(held.column("beta"), held.time))
    still = rate < 1e-6
    assert still.mean() * (held.time[-1] - held.time[0]) == pytest.approx(HOLDS * HELD, rel=0.1)
    levels = [float(each) for each in re.findall(r"-?[\d.]+", words.split(" at ")[1])][:HOLDS]
    for level in levels:
        assert np.abs(held.column("beta")[still] - level).min() < 0.06


def test_a_smaller_movement_is_half_as_large_about_the_same_middle(changes: dict[str, tuple[str, Trial]]) -> None:
    small, whole = changes["smaller"][1].column("beta"), changes["as it was"][1].column("beta")
    assert np.ptp(small) == pytest.approx(0.5 * np.ptp(whole), rel=1e-6)
    assert small.mean() == pytest.approx(whole.mean(), rel=1e-9)


def test_weights_and_exchanged_sensors() -> None:
    trial, values = knee_trial("t", 2.0), {**KNEE_CONSTANTS, "E_star": 1e8}
    plain = knee().simulate(trial, values)
    exchanged = swap(0, 1)(knee()).simulate(trial, values)
    assert np.array_equal(exchanged, plain[:, ::-1])
    loaded = bench([0, 1], {1: 50.0})(knee()).simulate(trial, values)
    assert set(loaded[:, 0]) == {0.0} and set(loaded[:, 1]) == {50.0}


EVERYWHERE = {"slower", "step and hold", "unloaded zero", "static weight"}
OFFERED = {
    "elbow": EVERYWHERE | {"faster", "smaller"},
    "foot": EVERYWHERE,  # walking is as fast as it can be, contact is made by its size, one plate has both forces
    "shoulder": EVERYWHERE | {"faster", "smaller", "other setting"},
    "knee": EVERYWHERE | {"smaller", "swapped sensors"},
    "sit_to_stand": EVERYWHERE | {"faster", "smaller", "swapped sensors"},
}


@pytest.mark.parametrize("name", OFFERED)
def test_every_change_of_the_menu_does_something_to_the_systems_it_is_for(name: str) -> None:
    system, trials = example(name)
    before = sorted(trials, key=len)[len(trials) // 2]
    plain = system.simulate(before, system.start)
    changes = menu(system, trials)
    assert {one.name for one in changes} == OFFERED[name]
    for one in changes:
        made = one.staged(system).simulate(one.trial, system.start)
        again = system.simulate(one.trial, system.start)
        if one.name in ("unloaded zero", "static weight"):
            assert np.array_equal(made, np.broadcast_to(made[0], made.shape), equal_nan=True), "it lies still"
            heavy = np.nan_to_num(made[0]) > 0.0
            assert heavy.sum() == (one.name == "static weight")
            known = [c for c, n in enumerate(system.outputs) if system.unit(n) in ("N", "rad")]
            assert one.name == "static weight" or np.isfinite(made[:, known]).all()
        elif one.name == "swapped sensors":
            assert not np.allclose(made, again)
        elif one.name in ("smaller", "other setting"):
            assert not np.allclose(np.nan_to_num(made), np.nan_to_num(plain[: len(made)]), rtol=1e-3)
        else:
            least = min(len(made), len(plain))
            assert not np.allclose(np.nan_to_num(made[:least]), np.nan_to_num(plain[:least]), rtol=1e-3)


def test_an_event_is_no_movement_that_could_be_smaller() -> None:
    system, trials = example("shoulder")
    small = next(one.trial for one in menu(system, trials) if one.name == "smaller")
    assert set(small.column("event")) == {0.0, 1.0}
    assert np.ptp(small.column("arm")) < 0.6 * max(np.ptp(t.column("arm")) for t in trials)


def test_other_settings_are_such_as_the_device_has() -> None:
    _, trials = example("shoulder")
    settings = [replace(t, covariates={"level": level}) for t in trials for level in (0.0, 0.5, 1.0)]
    for template in (0.5, 1.0):
        ordered = sorted(settings, key=lambda t: t.covariates["level"] != template)
        offered = {one.trial.covariates["level"] for one in _settings(ordered[0], settings)}
        assert offered == {0.0, 0.25, 1.0} - {template}


def test_what_the_imitator_leaves_is_the_projection_where_its_prior_is_wide() -> None:
    rng = np.random.default_rng(0)
    moved, directions = rng.standard_normal(40), rng.standard_normal((40, 3))
    left = moved - directions @ np.linalg.lstsq(directions, moved, rcond=None)[0]
    assert Rows(moved, 1e5 * directions).nats == pytest.approx(0.5 * left @ left, rel=1e-6)
    assert Rows(moved, 0.0 * directions).nats == pytest.approx(0.5 * moved @ moved)
    twice = Rows(moved, 1e5 * directions).with_(Rows(moved, 1e5 * directions), 3)
    assert twice.nats == pytest.approx(2.0 * left @ left, rel=1e-6)


def test_a_delay_and_a_filter_are_told_apart_by_moving_faster(elsewhere: Elsewhere) -> None:
    found = elsewhere(proposed, {"time_shift.delay": LAG})
    assert found is not None
    assert set(found.separates) == {"time_shift", "filter_lag"}
    assert "times as fast" in found.change or "quick steps" in found.change
    assert found.gain_nats > 20.0


def test_where_no_change_promises_enough_none_is_proposed(elsewhere: Elsewhere) -> None:
    assert elsewhere(proposed, {"time_shift.delay": LAG}, 1e6) is None


def test_a_slower_trial_goes_the_first_half_of_the_way_in_the_same_time(changes: dict[str, tuple[str, Trial]]) -> None:
    words, slow = changes["slower"]
    before = changes["as it was"][1]
    assert "half as fast" in words and np.ptp(slow.time) == pytest.approx(np.ptp(before.time), rel=0.01)
    went = np.interp(before.time[0] + 0.5 * slow.time, before.time, before.column("beta"))
    assert np.abs(slow.column("beta") - went).max() < 0.02 * np.ptp(went)


def test_where_nothing_is_found_a_known_weight_shows_what_the_stiffness_swallows(elsewhere: Elsewhere) -> None:
    found = elsewhere(proposed, None)
    assert found is not None
    assert "sensor_gain" in found.separates
    assert "known load" in found.change
    assert found.gain_nats > 5.0
