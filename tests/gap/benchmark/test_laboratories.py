"""Laboratories that synthetic cases come from: what each records, and that the home one is what it always was."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import solve_triangular
from scipy.stats import kurtosis

from geocontact.gap_benchmark.drawing import ABROAD, HOME, Lot, drawn, lots
from geocontact.gap_benchmark.synthetic import LABORATORIES, cases, synthetic_case
from geocontact.gap_benchmark.synthetic.catalogue import SCENES
from geocontact.gap_benchmark.synthetic.hooks import BASE
from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import ANGLE, GAIN, LENGTH, placement_of, sizes
from geocontact.gap_benchmark.synthetic.laboratories.kinds import kinds_of
from geocontact.gap_benchmark.synthetic.laboratories.movements import Pace
from geocontact.gap_benchmark.synthetic.laboratories.recorder import harmonics, other_filters, starts
from geocontact.gap_benchmark.synthetic.laboratory import Placement
from geocontact.gap_benchmark.synthetic.noise import PowerLawNoise
from geocontact.gap_benchmark.synthetic.plan import NotFoundError
from geocontact.gap_benchmark.synthetic.recording import Clock, Quotient, Recorder
from geocontact.gap_benchmark.synthetic.scene import SyntheticScene
from geocontact.gap_benchmark.synthetic.trials import as_measured, record, samples, sensed
from geocontact.gap_benchmark.synthetic.visibility import jacobian, whitener

AS_BEFORE = {
    "elbow": (751, 30.0, [1.3513326655091888, 7.964386163376955], 0.3494051452490011),
    "foot": (150, 0.745, [4377.680280044274, 0.11018758675923644], 9.255550297829357),
    "shoulder": (776, 7.75, [1.5075705438572318, 17.853458655723077], 0.002615007571912584),
    "knee": (120, 1.19, [711.2759086310139, 482.0273942060999], 14.934541194103515),
    "sit_to_stand": (104, 2.06, [63.42484688010436, 49.6206601039658], 1.1736860508220301),
}
"""Seed 20261145 before there were laboratories: samples and end [s] of the last trial, two values half-way, a floor."""


def scene_of(laboratory: str, system: str, seed: int) -> SyntheticScene:
    """The first one from a seed on that is not dropped."""
    for attempt in range(20):
        rng = np.random.default_rng([seed, attempt])
        try:
            return LABORATORIES[laboratory](rng, SCENES[system](rng, shifted=False))
        except NotFoundError:
            continue
    raise AssertionError("none of 20 draws")


@pytest.mark.slow
@pytest.mark.parametrize("system", AS_BEFORE)
def test_at_home_everything_is_as_it_was(system: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cases, "FRESH", 1)
    made = synthetic_case(system, "none", 20261145)
    trial, (count, end, values, floor) = made.case.calibration[-1], AS_BEFORE[system]
    assert (len(trial), trial.time[-1]) == (count, pytest.approx(end, rel=1e-12))
    half = trial.signals.values[count // 2]
    np.testing.assert_allclose(half[np.isfinite(half)][-2:], values, rtol=1e-9)
    assert next(iter(made.label.floor.values())) == pytest.approx(floor, rel=1e-9)


@pytest.mark.parametrize("laboratory", ABROAD)
def test_a_seed_is_a_laboratory(laboratory: str) -> None:
    one, same, other = (scene_of(laboratory, "knee", seed) for seed in (1, 1, 2))
    for name in ("laboratory", "noise", "filters", "step", "parameters"):
        assert getattr(one, name) == getattr(same, name)
    np.testing.assert_array_equal(one.theta, same.theta)
    assert one.laboratory != other.laboratory or one.filters != other.filters
    home = SCENES["knee"](np.random.default_rng([1, 0]), shifted=False)
    assert not np.allclose(one.theta, home.theta) and one.parameters != home.parameters


def test_laboratories_take_turns_and_leave_the_home_cases_alone() -> None:
    abroad = list(lots(("elbow",), 7, ("none",), 3, ABROAD))
    assert [one.laboratory for one in abroad] == [*ABROAD, *ABROAD, ABROAD[0]]
    assert [one.place for one in abroad] == [0, 0, 0, 1, 1, 1, 2]
    assert all(one.laboratory == HOME for one in lots(("elbow",), 4, ("none",), 3))


def test_numbers_are_multiples_of_a_step_noise_and_all() -> None:
    scene = scene_of("recorder", "knee", 4)
    recorder = scene.laboratory.recorder
    assert set(recorder.output_steps) == {0, 1} and set(recorder.input_steps) == {0, 1, 2, 3}
    one = record(scene, scene.path(np.random.default_rng(0), 0), np.random.default_rng(1))
    for rows, steps in ((one.outputs, recorder.output_steps), (one.inputs, recorder.input_steps)):
        for row, step in steps.items():
            np.testing.assert_allclose(rows[row] / step, np.round(rows[row] / step), atol=1e-6)
    for row, step in recorder.output_steps.items():
        assert 0.05 <= step / scene.noise[row].sd <= 2.0


def test_a_quotient_has_noise_as_one_over_its_divisor() -> None:
    """Noise of the moment alone, then of the divisor alone, against the linear mixture at small noise."""
    recorder = Recorder(quotients={1: Quotient(0, 100.0)})
    force = np.array([50.0, 100.0, 200.0])
    clean = np.array([force, [0.1, 0.2, 0.3]])
    of_moment = recorder.noisy(clean, np.array([np.zeros(3), np.full(3, 0.01)]))
    np.testing.assert_allclose(of_moment[1] - clean[1], 0.01 * 100.0 / force)
    small = 1e-6
    of_force = recorder.noisy(clean, np.array([np.full(3, small), np.zeros(3)]))
    np.testing.assert_allclose((of_force[1] - clean[1]) / small, -clean[1] / force, rtol=1e-5)
    np.testing.assert_allclose(recorder.mixing(clean)[1], [-clean[1] / force, 100.0 / force])


def test_noise_grows_with_what_is_measured() -> None:
    recorder = Recorder(growth={0: 0.5})
    noise = np.ones((1, 3))
    grown = recorder.noisy(np.array([[0.0, 2.0, -4.0]]), noise) - np.array([[0.0, 2.0, -4.0]])
    np.testing.assert_allclose(grown, np.sqrt([[1.0, 2.0, 5.0]]))


@pytest.mark.parametrize("noise", [PowerLawNoise(2.0, 1.0, 0.5, 0.3), PowerLawNoise(2.0, 0.5)])
def test_noise_of_a_power_law_has_the_covariance_that_it_states(noise: PowerLawNoise) -> None:
    rng = np.random.default_rng(0)
    drawn_ = np.array([noise.draw(rng, 30, 0.02) for _ in range(8000)])
    np.testing.assert_allclose(np.cov(drawn_.T), noise.covariance(30, 0.02), atol=0.35)


def test_one_over_f_and_heavy_tails() -> None:
    rng = np.random.default_rng(0)
    pink = np.array([PowerLawNoise(1.0, 1.0, 100.0).draw(rng, 4096, 0.01) for _ in range(60)])
    power = np.mean(np.abs(np.fft.rfft(pink * np.hanning(4096), axis=1)) ** 2, axis=0)
    frequency = np.fft.rfftfreq(4096, 0.01)
    heard = (frequency > 0.3) & (frequency < 30.0)
    slope = np.polyfit(np.log(frequency[heard]), np.log(power[heard]), 1)[0]
    assert slope == pytest.approx(-1.0, abs=0.05)
    tailed, normal = (PowerLawNoise(1.0, freedom=f).draw(rng, 20000, 0.01) for f in (4.0, np.inf))
    assert kurtosis(tailed) > 2.0 > 0.3 > abs(kurtosis(normal)) and np.std(tailed) == pytest.approx(1.0, abs=0.05)


def test_an_uneven_clock_is_early_and_late_but_ends_in_time() -> None:
    late = Clock(uneven=0.3).late(np.random.default_rng(0), 5000, 10)
    assert set(late) == set(range(-3, 4)) and late[0] == late[-1] == 0
    assert not Clock().late(np.random.default_rng(0), 50, 10).any()


@pytest.mark.parametrize("count", [14, 500])
def test_rows_are_lost_but_never_most_of_a_trial(count: int) -> None:
    clock = Clock(losing=1.0, alone=0.05, longest=12)
    kept = [clock.kept(np.random.default_rng(seed), count) for seed in range(200)]
    assert all(rows[0] == 0 and rows[-1] == count - 1 and len(rows) > 0.4 * count for rows in kept)
    assert np.mean([len(rows) for rows in kept]) < 0.95 * count + 1
    assert max(np.diff(rows).max() for rows in kept) <= 2 * max(12, count // 5)


@pytest.mark.parametrize("system", ["elbow", "shoulder"])
def test_what_an_uneven_clock_records_is_the_movement_at_its_times(system: str) -> None:
    """Times come with their inputs, and the base model takes them as they are."""
    scene = SCENES[system](np.random.default_rng(3), shifted=False)
    scene = replace(scene, laboratory=replace(scene.laboratory, clock=Clock(uneven=0.3, losing=0.0)))
    path = scene.path(np.random.default_rng(0), 0)
    one = record(replace(scene, input_noise=0.0 * scene.input_noise), path, np.random.default_rng(1))
    assert np.ptp(np.diff(one.time)) > 0.2 * scene.step
    np.testing.assert_allclose(one.inputs, path(one.time).position, atol=1e-12)
    even = record(replace(scene, laboratory=replace(scene.laboratory, clock=Clock())), path, np.random.default_rng(1))
    predicted, there = (scene.base_model(as_measured(each))(scene.theta)[0] for each in (one, even))
    np.testing.assert_allclose(predicted, np.interp(one.time, even.time, there), atol=0.02 * np.ptp(there))


def test_placement_is_off_by_nothing_on_average_and_by_about_a_millimetre() -> None:
    scene = SCENES["shoulder"](np.random.default_rng(0), shifted=False)
    care = 0.8
    placement = placement_of(scene, sizes(scene, scene.path(np.random.default_rng(1), 0)), care)
    assert placement.constants["L_h"] == care * LENGTH and set(placement.constants) == {"L_h", "o_x", "o_y", "l_c"}
    assert placement.inputs == {0: pytest.approx(care * ANGLE)}  # no zero of a flag
    assert placement.gains == pytest.approx({0: care * GAIN, 1: care * GAIN})
    rng = np.random.default_rng(2)
    trials = [placement.drawn(rng) for _ in range(3000)]
    for part in ("constants", "inputs", "gains", "zeros"):
        for key, sd in getattr(placement, part).items():
            off = np.array([getattr(one, part)[key] for one in trials])
            assert abs(off.mean()) < 4.0 * sd / np.sqrt(3000) and off.std() == pytest.approx(sd, rel=0.06)


def test_what_is_measured_is_what_moves_elsewhere_makes() -> None:
    scene = SCENES["elbow"](np.random.default_rng(0), shifted=False)
    path = scene.path(np.random.default_rng(1), 0)
    count = samples(scene, path)
    off = Placement({"l_ex": 1e-3}, {0: 0.01}, {0: 0.02}, {0: 0.3})
    got = sensed(scene, path, count, scene.theta, BASE, 10, placed=off)
    course = path(np.arange(count) * scene.step)
    constants = {**scene.constants, "l_ex": scene.constants["l_ex"] + 1e-3}
    true = scene.body.base_model(replace(course, position=course.position + 0.01), constants)(scene.theta)
    np.testing.assert_allclose(got, 1.02 * true + 0.3, rtol=1e-9)


@pytest.mark.parametrize("speed", [lambda r: harmonics(r, 2.0, 11.0), lambda r: starts(r, 2.0, 0.03)])
def test_another_pace_goes_the_same_way(speed: object) -> None:
    """From the same begin to the same end, never back, with the rates that it has."""
    pace = Pace.of(2.0, speed(np.random.default_rng(0)))  # type: ignore[operator]
    time = np.linspace(0.0, 2.0, 20001)
    at, rate, change = pace.along(time)
    assert at[[0, -1]] == pytest.approx([0.0, 2.0], abs=1e-9) and (rate > 0.0).all()
    np.testing.assert_allclose(np.gradient(at, time)[1:-1], rate[1:-1], atol=1e-3)
    np.testing.assert_allclose(np.gradient(rate, time)[1:-1], change[1:-1], atol=0.02 * np.abs(change).max())
    assert rate.max() - rate.min() > 0.5


def test_harmonics_reach_what_a_filter_at_6_hz_would_take_away() -> None:
    time = np.arange(0.0, 8.0, 0.005)
    speed = harmonics(np.random.default_rng(3), 8.0, 11.0)(time) - 1.0
    power = np.abs(np.fft.rfft(speed * np.hanning(len(time)))) ** 2
    frequency = np.fft.rfftfreq(len(time), 0.005)
    assert power[(frequency > 9.8) & (frequency < 11.1)].max() > 1e3 * power[frequency > 14.0].max()


def test_every_input_may_have_a_filter_of_its_own() -> None:
    found = other_filters(np.random.default_rng(0), "each", 4, 0.005)
    assert len({one.corner for one in found}) == 4 and {one.order for one in found} <= {1, 2, 3, 4}
    assert len({one.order for one in found}) > 1
    assert {one.corner for one in other_filters(np.random.default_rng(0), "raw", 4, 0.005)} == {100.0}


def every_one_abroad() -> Iterator[object]:
    """Every laboratory with every system; two systems of each, and each system with some, are not long."""
    for k, laboratory in enumerate([*ABROAD, *kinds_of("fresh")]):
        for j, system in enumerate(SCENES):
            marks = [pytest.mark.long] if (k + j) % len(SCENES) not in (0, 2) else []
            yield pytest.param(laboratory, system, marks=marks)


@pytest.mark.slow
@pytest.mark.parametrize(("laboratory", "system"), list(every_one_abroad()))
def test_what_is_recorded_abroad_has_the_covariance_that_labels_are_told_by(laboratory: str, system: str) -> None:
    """Chi squared over its degrees of freedom; at the foot placement and quotients are not quite linear.

    Labels are told as if the clock were even: between uneven samples noise of inputs has larger rates. Constants that
    are told wrong are no part of the covariance; a case is drawn with less of them than shows.
    """
    scene, rng = scene_of(laboratory, system, 7), np.random.default_rng(8)
    clock = Clock(trigger=scene.laboratory.clock.trigger)
    scene = replace(scene, laboratory=replace(scene.laboratory, clock=clock, standing=Placement()))
    total, count = 0.0, 0
    for turn in range(2):
        one = whitener(scene, scene.path(rng, turn))
        for _ in range(max(3, int(np.ceil(1500 / one.outputs.size)))):  # of few samples many, or chance decides
            recording = record(scene, one.path, rng)
            base = scene.base_model(as_measured(recording))(scene.theta)
            there = np.isfinite(one.outputs) & np.isfinite(recording.outputs) & np.isfinite(base)
            gap = np.where(there, recording.outputs - base, 0.0).ravel()
            by = np.where(there[..., None], jacobian(one.model, scene.theta), 0.0).reshape(gap.size, -1)
            moved = np.where(there[..., None], one.placed, 0.0).reshape(gap.size, -1)
            varied = np.column_stack([by @ np.linalg.cholesky(scene.spread), moved])
            white, spread = (solve_triangular(one.factor, part, lower=True) for part in (gap, varied))
            inner = np.eye(spread.shape[1]) + spread.T @ spread
            total += white @ white - (spread.T @ white) @ np.linalg.solve(inner, spread.T @ white)
            count += int(there.sum())
    assert total / count == pytest.approx(1.0, abs=0.25 if system == "foot" else 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("laboratory", ABROAD)
def test_a_case_of_every_laboratory_says_that_it_lacks_nothing(laboratory: str) -> None:
    made = drawn(Lot("sit_to_stand", "none", 20, 0, laboratory))
    assert made.label.kind == "none" and not made.label.effects and not made.label.nats
    assert set(made.label.reduction.values()) == {0.0}
    for name, floor in made.label.floor.items():  # the refitted base is at its floor
        assert made.label.rmse_before[name] < 2.0 * floor
    assert made.case.name != drawn(Lot("sit_to_stand", "none", 20, 0)).case.name


@pytest.mark.slow
@pytest.mark.parametrize("laboratory", ABROAD)
def test_effects_are_planted_abroad_too(laboratory: str) -> None:
    label = synthetic_case("knee", "single", 2, "sensor_drift", 80.0, laboratory).label
    assert label.effects == ("sensor_drift",) and label.nats["sensor_drift"] == pytest.approx(80.0, rel=0.12)


def test_a_laboratory_that_does_not_exist_is_named() -> None:
    with pytest.raises(ValueError, match="unknown laboratory 'moon'; laboratories are home, recorder"):
        synthetic_case("knee", "none", 0, laboratory="moon")


@pytest.mark.slow
def test_a_gain_is_hardly_visible_beside_what_gains_usually_differ_by() -> None:
    """Of the knee's gain 1 % differs from trial to trial as it is; a delay looks like nothing that does."""
    gain, late = (synthetic_case("knee", "single", 3, name, 20.0).label for name in ("sensor_gain", "time_shift"))
    assert gain.nats_anew is not None and late.nats_anew is not None
    assert gain.nats_anew < 0.3 * gain.nats["sensor_gain"]
    assert 0.9 * late.nats["time_shift"] < late.nats_anew <= 1.001 * late.nats["time_shift"]


@pytest.mark.slow
def test_in_a_laboratory_that_places_all_anew_labels_know_it_already() -> None:
    label = synthetic_case("knee", "single", 5, "relaxation", 60.0, laboratory="placement").label
    assert label.nats_anew == pytest.approx(label.nats["relaxation"], rel=0.3), "its care is within 30 % of the usual"
