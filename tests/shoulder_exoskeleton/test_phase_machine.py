"""ToolWork phases from angle, rate and current: in their order, causal, without chatter, nearly right under noise."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.support.phase_machine import (
    LIFT,
    LOWER,
    ONSET,
    REST,
    SCREW,
    PhaseCheck,
    Sensing,
    Thresholds,
    detected,
    phase_check,
    phases_by_onset,
    sensed,
)
from geocontact.shoulder_exoskeleton.synthetic import (
    CONDITIONS,
    PARTICIPANTS,
    TASKS,
    OverheadTrial,
    minimum_jerk,
    synthetic_trial,
)

ORDER = [REST, LIFT, SCREW, LIFT, LOWER, REST]
TIME = np.arange(801) / 100.0
EXACT = Sensing(noise=0.0, step=0.0, delay=0.0, current_noise=0.0)


@pytest.fixture(scope="module")
def trials() -> list[OverheadTrial]:
    return [synthetic_trial(*each) for each in product(PARTICIPANTS, TASKS, CONDITIONS)]


def course(*changes: tuple[float, float, float]) -> np.ndarray:
    """Elevation from 0.16 rad by minimum jerk: how much, from when, until when."""
    return np.full(len(TIME), 0.16) + sum(size * minimum_jerk(TIME, start, stop) for size, start, stop in changes)


def current(start: float, stop: float) -> np.ndarray:
    return np.where((start <= TIME) & (stop > TIME), 4.0, 0.3)


def order(phases: np.ndarray) -> list[int]:
    return phases[np.r_[True, np.diff(phases) != 0]].tolist()


def test_phases_of_a_task_come_in_their_order() -> None:
    found = detected(TIME, course((1.8, 1.0, 2.5), (-1.8, 6.0, 7.5)), current(3.0, 5.5))
    assert order(found) == ORDER
    assert TIME[found == SCREW][[0, -1]] == pytest.approx([3.0, 5.49], abs=1e-9)
    assert 1.0 < TIME[found == LIFT][0] < 1.15 and 6.0 < TIME[found == LOWER][0] < 6.25


def test_nothing_after_a_sample_counts() -> None:
    """What has been detected until a moment is the same whatever follows."""
    angle, tool = course((1.8, 1.0, 2.5), (-1.8, 6.0, 7.5)), current(3.0, 5.5)
    whole = detected(TIME, angle, tool)
    for end in (120, 260, 310, 640, 700):
        np.testing.assert_array_equal(detected(TIME[:end], angle[:end], tool[:end]), whole[:end])


def test_arms_that_are_raised_slowly_or_again_are_lifted() -> None:
    slowly = detected(TIME, 0.16 + 0.08 * np.maximum(TIME - 0.5, 0.0), current(9.0, 9.0), Thresholds(high=0.8))
    assert order(slowly) == [REST]
    slowly = detected(TIME, 0.16 + 0.08 * np.maximum(TIME - 0.5, 0.0), current(9.0, 9.0), Thresholds(high=0.5))
    assert order(slowly) == [REST, LIFT]
    again = detected(TIME, course((1.8, 1.0, 2.5), (-1.0, 3.5, 4.5), (1.0, 4.6, 5.6)), current(6.0, 7.0))
    assert order(again) == [REST, LIFT, LOWER, LIFT, SCREW, LIFT]


def test_a_tool_that_runs_at_rest_is_no_screwing() -> None:
    assert order(detected(TIME, course(), current(1.0, 3.0))) == [REST]


def test_a_glitch_is_not_confirmed() -> None:
    angle = course()
    angle[200] += 0.02
    assert order(detected(TIME, angle, current(9.0, 9.0), Thresholds(confirmed=0.05))) == [REST]
    assert order(detected(TIME, angle, current(9.0, 9.0), Thresholds(confirmed=0.0))) != [REST]


def test_a_noisy_current_between_both_thresholds_changes_nothing() -> None:
    """Hysteresis: with one threshold in the middle of the noise the phase would change at every sample."""
    angle = course((1.8, 1.0, 2.5))
    tool = current(3.0, 9.0)
    tool[320:] = 2.0 + 0.4 * np.sin(1e4 * TIME[320:])
    assert order(detected(TIME, angle, tool)) == [REST, LIFT, SCREW]
    narrow = Thresholds(on=2.001, off=2.0)
    assert len(order(detected(TIME, angle, tool, narrow))) > 50


def test_a_device_that_sinks_as_the_tool_stops_is_not_lowered() -> None:
    """Less support lets it sink by 2 degrees in a tenth of a second; a lowering begins later all the same."""
    angle, tool = course((1.8, 1.0, 2.5), (-0.035, 5.5, 5.6), (-1.76, 6.0, 7.5)), current(3.0, 5.5)
    assert order(detected(TIME, angle, tool)) == ORDER
    quick = detected(TIME, angle, tool, Thresholds(settled=0.0))
    assert TIME[quick == LOWER][0] < 5.6 < 6.0 < TIME[detected(TIME, angle, tool) == LOWER][0]


def test_a_slip_at_the_end_of_a_lowering_is_no_lift() -> None:
    angle, tool = course((1.8, 1.0, 2.5), (-1.8, 6.0, 7.5)), current(3.0, 5.5)
    angle += np.interp(TIME, [6.97, 7.0, 7.03], [0.0, 0.15, 0.0])
    assert order(detected(TIME, angle, tool)) == ORDER
    assert len(order(detected(TIME, angle, tool, Thresholds(turned=0.01)))) > len(ORDER)


@pytest.mark.parametrize(
    ("numbers", "what"),
    [
        ({"low": 1.0, "high": 0.9}, "low must be below high"),
        ({"on": 1.0}, "off must be below on"),
        ({"down": -0.1}, "must be positive"),
    ],
)
def test_thresholds_without_hysteresis_are_refused(numbers: dict[str, float], what: str) -> None:
    with pytest.raises(ValueError, match=what):
        Thresholds(**numbers)


def checks(trials: list[OverheadTrial], sensing: Sensing, onset: float = ONSET) -> tuple[list[PhaseCheck], float]:
    """Beside truth; and the mean share of samples that perfect sensors would give another phase."""
    found, changed = [], []
    for trial, angles in ((each, angles) for each in trials for angles in each.courses.values()):
        time, angle = trial.markers.time, angles.elevation
        true = phases_by_onset(time, angle, trial.phase, onset)
        ideal = detected(time, angle, trial.current)
        for seed in range(2):
            rng = np.random.default_rng(seed)
            phases = detected(time, *sensed(time, angle, trial.current, sensing, rng))
            found.append(phase_check(time, phases, true))
            changed.append(np.mean(phases != ideal))
    return found, float(np.mean(changed))


def test_noise_and_delay_cost_one_per_cent_and_no_chatter(trials: list[OverheadTrial]) -> None:
    """72 detections: 0.8 % of the time beside perfect sensors, 1.6 % beside truth, most as a lowering begins."""
    found, changed = checks(trials, Sensing())
    assert not any(each.chatter for each in found)
    assert changed < 0.01
    assert np.mean([each.wrong for each in found]) < 0.018
    latencies = np.median([each.latencies for each in found], axis=0)
    assert latencies.argmax() == 3 and latencies[3] < 0.12, "that a lowering has begun is hardest to tell from tremor"
    earlier, _ = checks(trials, Sensing(), onset=0.05)
    assert 0.02 < np.mean([each.wrong for each in earlier]) < 0.025


def test_delay_costs_what_it_lasts(trials: list[OverheadTrial]) -> None:
    late = Sensing(noise=0.0, step=0.0, delay=0.05, current_noise=0.0)
    (now, _), (then, changed) = checks(trials, EXACT), checks(trials, late)
    length = np.mean([trial.times.end for trial in trials])
    assert changed == pytest.approx(5.0 * 0.05 / length, rel=0.1), "five changes"
    assert np.mean([each.wrong for each in then]) > np.mean([each.wrong for each in now])


def test_true_phases_begin_with_the_movement() -> None:
    """Minimum jerk reaches a tenth of its peak rate, 15/8 of the mean one, at s²(1 - s)² = 0.1/16."""
    time = np.arange(2001) / 1000.0
    planned = np.where(time < 0.5, REST, LIFT)
    true = phases_by_onset(time, minimum_jerk(time, 0.5, 1.5), planned)
    s = 0.5 - np.sqrt(0.25 - np.sqrt(0.1 / 16.0))
    assert time[true == LIFT][0] == pytest.approx(0.5 + s, abs=2e-3)


def test_a_check_counts() -> None:
    true = np.array([REST, REST, LIFT, LIFT, LIFT, REST])
    late = phase_check(np.arange(6) / 10.0, np.array([REST, REST, REST, LIFT, LIFT, REST]), true)
    assert late.wrong == pytest.approx(1 / 6) and late.latencies == pytest.approx((0.1, 0.0)) and not late.chatter
    other = phase_check(np.arange(6) / 10.0, np.array([REST, LIFT, REST, LIFT, LIFT, REST]), true)
    assert other.chatter and other.latencies == ()
