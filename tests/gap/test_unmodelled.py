"""What no effect is, described: a zero of each trial's own, lost samples, a load by its place. Data are synthetic."""

from __future__ import annotations

import re
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest

from geocontact.analyses.gap.thinning import thinned_and_said
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.gap.attribute import Attribution
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import Measured, Refit
from geocontact.gap.diagnose import diagnose
from geocontact.gap.reduction.repeats import shared
from geocontact.gap.selection.evidence import Judged
from geocontact.gap.selection.model_comparison import Contender
from geocontact.gap.selection.verdict import Answer
from geocontact.gap.slips import share_of_time, slip_of
from geocontact.gap.unmodelled import (
    AnswerResiduals,
    loads_by_place,
    lost_samples,
    regions,
    wandering_zero,
)
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.test_discrepancy_by_hand import bare
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


def two_lost(name: str, torque: Column) -> Column:
    """Half-way of one trial."""
    at = len(torque) // 2
    return np.concatenate([torque[:at], torque[at + 2 :], np.full(2, torque[-1])]) if name == "t3" else torque


CASES: dict[str, Callable[[], GapCase]] = {
    "zero": lambda: altered(joint_case(spring), lambda name, torque: torque + ZEROS[name]),
    "lost": lambda: altered(joint_case(spring), without),
    "load": lambda: joint_case(wander),
    "nothing": lambda: joint_case(spring),
}


def said(sort: str) -> Diagnosis:
    """Diagnosis of a case of this sort."""
    case = CASES[sort]()
    return diagnose(case, system_of(case)).diagnosis


def fitted(sort: str) -> tuple[Attribution, AnswerResiduals]:
    """The spring fitted to the calibration trials of a case by a straight line, and what it leaves of all trials."""
    case = CASES[sort]()
    system = system_of(case).scaled(case.calibration)
    angle, torque = (np.concatenate([t.column(name) for t in case.calibration]) for name in ("angle", "torque"))
    slope, level = np.polyfit(angle, torque, 1)
    values = {"k": float(slope), "angle0": float(-level / slope)}
    recorded = Measured.of(system, case.calibration + case.evaluation, np.array([0.1]))
    residuals = recorded.residuals(system, values)
    jacobian = [
        np.stack([t.column("angle") - values["angle0"], np.full(len(t), -slope)], axis=-1)[:, None]
        for t in recorded.trials
    ]
    problem = bare(Problem, system=system, recorded=recorded)
    judged = bare(Judged, model=bare(Refit, jacobian=jacobian))
    answer = bare(Answer, chosen=bare(Contender, judged=judged))
    usual = np.array([0.04 * slope, 0.0087])
    rest = AnswerResiduals(residuals, recorded.present, [j * usual for j in jacobian], np.array([0.1]))
    return bare(Attribution, problem=problem, answer=answer), rest


def size_of(rest: AnswerResiduals) -> float:
    return sum(float((r**2).sum()) for r in rest.residuals)


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


def test_a_long_trial_takes_little_memory() -> None:
    """24,000 samples with a slip of 150 of them: a table of all moves had 2.4 GB."""
    n = 24_000
    predicted = np.cumsum(np.random.default_rng(7).standard_normal(n))
    measured = np.where(np.arange(n) > 9000, np.roll(predicted, -150), predicted)
    measured += np.random.default_rng(8).standard_normal(n)
    tracemalloc.start()
    found = slip_of(measured, predicted, 200)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found is not None and found.samples == 150 and abs(found.place - 9000) < 20
    assert most < 100 * 8 * n


def test_a_slip_beside_a_hole_is_compared_on_the_same_samples() -> None:
    """A large misfit near a hole has no part in what a slip takes."""
    rng, n = np.random.default_rng(2), 400
    predicted = 10.0 * np.sin(0.06 * np.arange(n + 20))
    measured = np.concatenate([predicted[:100], predicted[106 : n + 6]]) + 0.3 * rng.standard_normal(n)
    predicted = predicted[:n].copy()
    measured[300:304], predicted[300:304] = np.nan, np.nan
    measured[296:300] += 60.0
    found = slip_of(measured, predicted, 15)
    assert found is not None and found.samples == 6
    near = (np.arange(n) >= 300 - 15) & (np.arange(n) < 304 + 15)
    plain = float(((measured - predicted)[~near] ** 2).sum())
    assert found.unmoved == pytest.approx(plain) and found.after < 0.2 * plain


def test_noise_and_a_constant_delay_have_no_slip() -> None:
    rng, n = np.random.default_rng(3), 240
    predicted = np.sin(0.1 * np.arange(n))
    for measured in (predicted, np.roll(predicted, 3)):
        found = slip_of(measured + 0.1 * rng.standard_normal(n), predicted, 15)
        assert found is None or found.nats < 0.0


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


def test_a_zero_of_each_trials_own_has_its_size() -> None:
    found, rest = fitted("zero")
    one = wandering_zero(found, rest, 0)
    assert one is not None and one.kind == "wandering_zero" and one.share > 0.9 * size_of(rest)
    mean = sum(ZEROS.values()) / len(ZEROS)
    for name, size in ZEROS.items():
        assert one.trials[name] == pytest.approx(size - mean, abs=0.1)


def test_lost_samples_are_counted_in_each_trial() -> None:
    """Each has its own number at its own place, one has lost none."""
    found, rest = fitted("lost")
    one = lost_samples(found, rest, 0)
    assert one is not None and one.share > 0.8 * size_of(rest)
    assert one.trials == {name: float(count) for name, (count, _) in LOST.items() if count}
    assert "7 in t0 at 44%" in one.words or "7 in t0 at 45%" in one.words


def in_pieces(change: Callable[[str, Column], Column]) -> tuple[Diagnosis, int]:
    """Of trials of 20,000 samples, a seventieth of which is used; how many samples of the inputs are."""
    case = altered(joint_case(spring, lasts=400.0), change)
    with patch("geocontact.analyses.gap.thinning.ROWS", 2400):
        case, _ = thinned_and_said(case, system_of(case))
    return diagnose(case, system_of(case)).diagnosis, len(case.calibration[0])


@pytest.mark.slow
def test_lost_samples_are_counted_in_pieces_of_long_trials(elsewhere: Elsewhere) -> None:
    """The place of each to one piece of eight."""
    d, samples = elsewhere(in_pieces, without)
    assert samples < 2500 and d.verdict == "unknown"
    (one,) = d.unmodelled
    assert one.kind == "lost_samples" and one.share > 0.9
    assert one.trials == {name: float(count) for name, (count, _) in LOST.items() if count}
    for count, name, place in re.findall(r"(\d+) in (t\d) at (\d+)%", one.words):
        assert (int(count), float(place)) == (LOST[name][0], pytest.approx(100.0 * LOST[name][1], abs=12.5))


def test_the_place_of_a_slip_is_moved_at_the_end_of_a_piece_only() -> None:
    """Measured rows 10 to 39 and 60 to 89 of 100, two pieces around them with a pause of 50 s between."""
    time = np.arange(100.0) + 50.0 * (np.arange(100) >= 50)
    there = np.zeros(100, dtype=bool)
    there[10:40] = there[60:90] = True
    signals = Signals(time, np.zeros((100, 1)), ("u",), ("rad",))
    paused = Trial("t", signals, pieces=((0.0, 49.0), (100.0, 149.0)))
    for place, at in ((20, 20.0), (39, 0.5 * (39.0 + 110.0)), (45, 0.5 * (45.0 + 110.0)), (70, 120.0), (89, 139.0)):
        assert share_of_time(paused, there, place) == pytest.approx(at / 149.0), place
    assert share_of_time(Trial("t", signals), there, 39) == 39 / 99


def test_lost_samples_take_what_they_cause_where_the_stiffness_is_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """k is off by 15 %, one trial lost two samples, which make 42 % of the error: no more is theirs."""
    monkeypatch.setitem(CASES, "two", lambda: altered(joint_case(spring), two_lost))
    found, rest = fitted("two")
    right = lost_samples(found, rest, 0)
    assert right is not None
    off = [4.6 * j[:, :, 0] for j in found.answer.chosen.judged.model.jacobian]
    stiffer = replace(rest, residuals=[r + each for r, each in zip(rest.residuals, off, strict=True)])
    one = lost_samples(found, stiffer, 0)
    assert one is not None and one.trials == {"t3": 2.0}
    assert one.share == pytest.approx(right.share, rel=0.2)
    assert one.share < 0.6 * size_of(stiffer)


def test_a_load_that_was_not_recorded_has_its_place() -> None:
    """Bumps of 1.2 N m at 30 and 70 % of every trial: two places, either with its sign."""
    found, rest = fitted("load")
    up, down = sorted(loads_by_place(found, rest.cleared(), 0, size_of(rest)), key=lambda one: one.phase or (0.0, 0.0))
    assert up.phase and down.phase and up.phase[0] < 0.3 < up.phase[1] and down.phase[0] < 0.7 < down.phase[1]
    assert ": +" in up.words and ": -" in down.words and max(up.p_value, down.p_value) < 0.05
    assert up.words.startswith("a load that was not recorded, or the model's form, in torque, phase")


def slow(rng: np.random.Generator, count: int, memory: float) -> Column:
    """Noise of variance 1 whose correlation falls to 1/e within so many samples (Ornstein & Uhlenbeck 1930)."""
    alike, made = np.exp(-1.0 / memory), [rng.standard_normal()]
    for step in rng.standard_normal(count - 1) * np.sqrt(1.0 - alike**2):
        made.append(alike * made[-1] + step)
    return np.array(made)


@pytest.mark.parametrize("memory", [0.05, 0.1, 0.25])
def test_slow_noise_is_neither_a_load_nor_a_zero(memory: float) -> None:
    """Four trials whose noise remembers so much of a trial: 17, 27 and 43 % had a load, 10, 33 and 68 % zeros."""
    rng, n, cases = np.random.default_rng(1), 400, 20
    phase = np.minimum((np.arange(n) / n * 20).astype(int), 19)
    x = np.sin(4.0 * np.pi * np.arange(n) / n)
    state = 2 * np.searchsorted(np.quantile(x, [0.25, 0.5, 0.75]), x) + (np.gradient(x) > 0)
    found, _ = fitted("nothing")
    four = replace(found.problem.recorded, trials=found.problem.recorded.trials[:4])
    of_four = bare(Attribution, problem=bare(Problem, system=found.problem.system, recorded=four), answer=found.answer)
    loads = zeros = 0
    for _ in range(cases):
        noise = [slow(rng, n, memory * n) for _ in range(4)]
        square = sum(float(each @ each) for each in noise)
        there = [np.ones(n, bool)] * 4
        all_of = regions(noise, there, {"phase": [phase] * 4, "angle": [state] * 4})
        size = shared(all_of.sums.sum(axis=1)[None], all_of.counts)[0] / square
        loads += bool(((all_of.p_values() <= 0.05) & (size >= 0.1)).any())
        rest = AnswerResiduals(
            [e[:, None] for e in noise], [np.ones((n, 1), bool)] * 4, [np.zeros((n, 1, 1))] * 4, np.ones(1)
        )
        zero = wandering_zero(of_four, rest, 0)
        zeros += zero is not None and zero.share >= 0.1 * square
    assert max(loads, zeros) <= 0.05 * cases


def test_of_noise_nothing_is_described() -> None:
    found, rest = fitted("nothing")
    assert wandering_zero(found, rest, 0) is None and lost_samples(found, rest, 0) is None
    assert not list(loads_by_place(found, rest.cleared(), 0, size_of(rest)))


@pytest.mark.slow
def test_a_diagnosis_describes_a_zero_of_each_trials_own(elsewhere: Elsewhere) -> None:
    d = elsewhere(said, "zero")
    assert d.effects == ()
    (one,) = d.unmodelled
    assert one.told.startswith("zero of torque differs from trial to trial")


@pytest.mark.slow
def test_lost_samples_are_not_named_a_slip_that_imitates_them(elsewhere: Elsewhere) -> None:
    """They make all of the error; one slip that all trials have alike was named beside them, with 28 % of it."""
    d = elsewhere(said, "lost")
    assert (d.verdict, d.effects) == ("unknown", ())
    (one,) = d.unmodelled
    assert one.kind == "lost_samples" and one.share > 0.9
    assert d.probabilities["unknown"] > 0.5
    assert any("clock_slip" in each and "may imitate it" in each for each in d.remarks)


@pytest.mark.slow
def test_a_load_that_repeats_is_described_at_its_places(elsewhere: Elsewhere) -> None:
    d = elsewhere(said, "load")
    assert (d.verdict, d.effects) == ("unknown", ())
    assert d.unmodelled and all(one.kind == "unrecorded_load" for one in d.unmodelled)
    assert any(one.phase[0] < 0.3 < one.phase[1] or one.phase[0] < 0.7 < one.phase[1] for one in d.unmodelled)
