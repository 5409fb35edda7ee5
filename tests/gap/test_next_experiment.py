"""What to record next: a menu that is what its words say, and the change that theory would choose."""

from __future__ import annotations

import re

import numpy as np
import pytest

from geocontact.data.trial import Trial
from geocontact.gap.experiments import HELD, HOLDS, bench, swap
from geocontact.gap.next_experiment import Rows
from tests.elsewhere import Elsewhere
from tests.gap.told import LAG, on_the_menu, proposed
from tests.systems.examples import KNEE_CONSTANTS, knee, knee_trial


@pytest.fixture(scope="module")
def changes(elsewhere: Elsewhere) -> dict[str, tuple[str, Trial]]:
    return elsewhere(on_the_menu)


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
    loaded = bench([0, 1], [100.0, 50.0])(knee()).simulate(trial, values)
    half = (len(trial) + 1) // 2
    assert set(loaded[:half, 0]) == {100.0} and set(loaded[:half, 1]) == {0.0}
    assert set(loaded[half:, 0]) == {0.0} and set(loaded[half:, 1]) == {50.0}


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


def test_where_nothing_is_found_a_known_weight_shows_what_the_stiffness_swallows(elsewhere: Elsewhere) -> None:
    found = elsewhere(proposed, None)
    assert found is not None
    assert "sensor_gain" in found.separates
    assert "known load" in found.change
    assert found.gain_nats > 5.0
