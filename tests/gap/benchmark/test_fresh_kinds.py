"""What only fresh kinds of laboratories have: samplers, movements, noises, and channels that are interrupted."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from geocontact.gap_benchmark.drawing import Lot, drawn
from geocontact.gap_benchmark.synthetic.catalogue import SCENES
from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import UNSEEN, sampled_unseen, sampling_gap
from geocontact.gap_benchmark.synthetic.laboratories.kinds import LABORATORY_KINDS, kinds_of
from geocontact.gap_benchmark.synthetic.laboratories.movements import FAMILIES, moving
from geocontact.gap_benchmark.synthetic.noise import PowerLawNoise, Wandering
from geocontact.gap_benchmark.synthetic.plan import NotFoundError
from geocontact.gap_benchmark.synthetic.recording import Clock, Recorder, Sampler
from geocontact.gap_benchmark.synthetic.trials import record
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import write_gap_case
from tests.gap.benchmark.scene_of_kind import scene_of

SAMPLED = [name for name, kind in LABORATORY_KINDS.items() if kind.clock in ("averaging", "lagging")]


def test_a_sample_is_the_mean_over_its_interval() -> None:
    """Of t² over the middle 0.8 of ten steps: the mean is t² + width²/12, but at the ends."""
    time = np.arange(51) * 0.1
    found = Sampler(over=0.8).outputs(np.array([time**2, time]), 10, np.arange(6) * 10)
    exact = np.arange(6.0)
    np.testing.assert_allclose(found[1], exact, atol=1e-12)
    np.testing.assert_allclose(found[0, 1:-1], exact[1:-1] ** 2 + 0.8**2 / 12.0 + 0.1**2 / 6.0, atol=1e-12)
    np.testing.assert_allclose(found[0, [0, -1]], [0.0, 25.0], atol=1e-12)


def test_a_low_pass_makes_every_channel_late_alike() -> None:
    """A ramp, by its time constant; a sine as 1/(1 + i w T) has it, from the start on."""
    time = np.arange(2001) * 0.01
    rows = np.array([3.0 * time + 1.0, np.sin(2.0 * time + 0.3)])
    found = Sampler(lag=0.2).outputs(rows, 10, np.arange(201) * 10)
    at, lasting = time[::10], 0.2 * 10 * 0.01
    np.testing.assert_allclose(found[0], 3.0 * (at - lasting) + 1.0, atol=1e-9)
    response = 1.0 / (1.0 + 2.0j * lasting)
    np.testing.assert_allclose(found[1], (response * np.exp(1j * (2.0 * at + 0.3))).imag, atol=2e-4)


def test_switches_are_read_at_once_and_quotients_of_sampled_parts() -> None:
    rows = np.array([np.arange(21.0), np.repeat([0.0, 1.0], [10, 11])])
    found = Sampler(over=1.0, at_once=(1,)).inputs(rows, 10, np.array([0, 10, 20]))
    np.testing.assert_allclose(found, [[0.0, 10.0, 20.0], [0.0, 1.0, 1.0]])
    force, centre = np.linspace(0.0, 40.0, 21), np.linspace(0.2, 0.1, 21)
    sampled = Sampler(over=1.0).outputs(np.array([force, centre]), 10, np.array([0, 10]), {1: 0})
    around = slice(5, 16)
    assert sampled[1, 1] == pytest.approx(np.trapezoid((force * centre)[around]) / np.trapezoid(force[around]))
    assert sampled[1, 0] == 0.0, "there is no force to divide by"


@pytest.mark.parametrize("name", SAMPLED)
def test_what_is_recorded_went_through_the_sampler(name: str) -> None:
    """Inputs without noise are those that the sampler has of the movement, and not those of the moment."""
    scene = scene_of(name, "knee")
    recorder = replace(scene.laboratory.recorder, input_steps={})
    scene = replace(scene, input_noise=np.zeros(4), laboratory=replace(scene.laboratory, recorder=recorder))
    path = scene.path(np.random.default_rng(0), 0)
    one = record(scene, path, np.random.default_rng(1))
    sampler = scene.laboratory.sampler
    since, weight = np.linspace(-0.5, 0.5, 2001) * sampler.over, np.ones(2001)
    if sampler.lag:
        since = -np.linspace(0.0, 12.0, 2001) * sampler.lag
        weight = np.exp(since / sampler.lag)
    weight[[0, -1]] *= 0.5
    for at in range(5, len(one.time) - 5, 7):
        around = path(one.time[at] + since * scene.step).position @ weight / weight.sum()
        exact = path(one.time[[at]]).position[:, 0]
        off = np.abs(around - exact)
        assert (np.abs(one.inputs[:, at] - around) <= 0.1 * off + 1e-6 * np.abs(exact).max()).all()
        assert not np.array_equal(one.inputs[:, at], exact)


@pytest.mark.parametrize(
    ("name", "system"),
    [
        pytest.param(name, system, marks=[pytest.mark.slow] if system in ("shoulder", "sit_to_stand") else [])
        for name, system in itertools.product(SAMPLED, SCENES)
    ],
)
def test_a_sampler_alone_leaves_no_gap(name: str, system: str) -> None:
    """The base model at the sampled inputs against the sampled truth: less than shows in a movement."""
    scene = scene_of(name, system, 3)
    path = scene.path(np.random.default_rng(0), 0)
    assert sampling_gap(scene, path) < UNSEEN


def test_a_sampler_that_shows_is_dropped() -> None:
    """Outputs alone half a sample late, as no sampler has them that treats all channels alike."""
    scene = scene_of(SAMPLED[0], "knee")
    assert sampled_unseen(np.random.default_rng(0), scene, 2) is scene
    late = replace(scene, laboratory=replace(scene.laboratory, sampler=Sampler(lag=0.5, at_once=(0, 1, 2, 3))))
    with pytest.raises(NotFoundError, match="the sampler alone shows"):
        sampled_unseen(np.random.default_rng(0), late, 2)


def test_a_random_walk_begins_at_zero_and_is_another_one_in_every_trial() -> None:
    noise, rng = Wandering(PowerLawNoise(1e-9), 0.5), np.random.default_rng(0)
    trials = np.array([noise.draw(rng, 401, 0.01) for _ in range(2000)])
    assert np.abs(trials[:, 0]).max() < 1e-7 and noise.sd == 1e-9
    np.testing.assert_allclose(trials[:, [100, 400]].std(axis=0), [0.5, 1.0], rtol=0.06)
    assert abs(np.mean(trials[:, -1])) < 0.1 and np.corrcoef(trials[::2, -1], trials[1::2, -1])[0, 1] < 0.15
    told = noise.covariance(401, 0.01)
    assert (told[100, 400], told[400, 400]) == (pytest.approx(0.25), pytest.approx(1.0))


def test_a_walk_stays_within_the_noise() -> None:
    """At the end of a trial its standard deviation is about that of the noise beside it at most; trials differ."""
    for system in SCENES:
        scene = scene_of("random walk, mixed steps, placed anew", system)
        lasting = scene.path(np.random.default_rng(0), 0)(np.zeros(1)).duration
        for one in scene.noise:
            assert isinstance(one, Wandering) and 0.2 < one.walk * np.sqrt(lasting) / one.beside.sd < 1.3


def test_noise_grows_where_the_signal_changes_quickly() -> None:
    recorder = Recorder(hurry={0: 0.5})
    clean = np.array([[0.0, 0.0, 0.0, 2.0, 6.0, 10.0, 10.0, 10.0, np.nan]])
    mixed = recorder.mixing(clean)[0, 0]
    np.testing.assert_allclose(mixed[[1, 4, 6]], np.sqrt([1.0, 1.0 + (0.5 * 4.0) ** 2, 1.0]))
    noisy = recorder.noisy(clean, np.ones((1, 9)))
    np.testing.assert_allclose((noisy - clean)[0, :8], mixed[:8])


def test_the_third_harmonic_is_three_times_as_quick_as_the_hum() -> None:
    scene = scene_of("harmonics, uneven clock, sines", "elbow")
    (one,) = scene.noise
    drawn_ = np.mean(
        [
            np.abs(np.fft.rfft(replace(one, frequency=5.0).draw(np.random.default_rng(seed), 400, 0.01))) ** 2
            for seed in range(300)
        ],
        axis=0,
    )
    power = drawn_ / np.median(drawn_)
    assert set(np.flatnonzero(power > 5.0)) == {20, 60}  # of 4 s: 5 and 15 Hz
    assert one.frequency in (50.0, 60.0) and 0.3 <= one.third / one.hum <= 0.8


def test_stretches_of_single_outputs_are_missing() -> None:
    clock, rng = Clock(interrupted=0.5), np.random.default_rng(0)
    found = [np.isnan(clock.heard(rng, np.zeros((3, 200)))) for _ in range(400)]
    missing = np.array([one.any(axis=1) for one in found])
    assert missing.mean() == pytest.approx(0.5, abs=0.05) and len({tuple(one) for one in missing.tolist()}) == 8
    for one in found:
        for row in one[one.any(axis=1)]:
            assert 20 <= row.sum() < 40 and np.abs(np.diff(row.astype(int))).sum() <= 2
    scene = scene_of("hurried, interrupted, holds", "knee")
    recordings = [record(scene, scene.path(rng, 0), rng) for _ in range(6)]
    assert any(np.isnan(one.outputs).any() for one in recordings)
    assert all(np.isfinite(one.inputs).all() and np.isfinite(one.outputs).any(axis=1).all() for one in recordings)


@pytest.mark.parametrize("family", FAMILIES)
def test_another_family_moves_along_the_same_way(family: str) -> None:
    """With the rates that it has, from where the movement begins, and never beyond its ends."""
    for seed in range(20):
        pace = FAMILIES[family](np.random.default_rng(seed), 2.0)
        time = np.linspace(0.0, pace.duration, 20001)
        at, speed, change = pace.along(time)
        assert at[0] == pytest.approx(0.0, abs=1e-9) and at.min() > -1e-9 and at.max() < 2.0 + 1e-9
        np.testing.assert_allclose(np.gradient(at, time)[1:-1], speed[1:-1], atol=1e-3)
        np.testing.assert_allclose(np.gradient(speed, time)[1:-1], change[1:-1], atol=0.02 * np.abs(change).max())
        assert np.abs(speed).max() < 3.5, "not much quicker than at home"
        if family == "sweep":
            ends = sorted(speed[[0, -1]])
            assert at[-1] == pytest.approx(2.0) and 4.0 <= ends[1] / ends[0] <= 8.0
        if family == "sines":
            assert speed.min() < -0.3 and np.ptp(at) > 1.0 and speed[0] == 0.0
        if family == "holds":
            assert at[-1] == pytest.approx(2.0) and 0.3 < np.mean(speed == 0.0) < 0.6


def test_a_long_movement_leaves_room_for_samples() -> None:
    """Of an elbow that takes half a minute at home."""
    for family in FAMILIES:
        assert FAMILIES[family](np.random.default_rng(0), 30.0).duration == 30.0
        assert FAMILIES[family](np.random.default_rng(0), 34.0).duration == 34.0
    for seed in range(30):
        assert scene_of("hurried, interrupted, holds", "elbow", seed).step <= 1.0 / 25.0


def test_a_scene_with_another_family_is_the_same_but_for_its_movements() -> None:
    scene = SCENES["elbow"](np.random.default_rng(0), shifted=False)
    assert moving(scene, "usual") is scene
    held = moving(scene, "holds")
    course = held.path(np.random.default_rng(1), 0)(np.linspace(0.0, 60.0, 3001))
    assert np.mean(course.rate[0] == 0.0) > 0.2 and held.body is scene.body


@pytest.mark.slow
@pytest.mark.parametrize("name", kinds_of("fresh"))
def test_a_fresh_case_is_drawn_written_and_read_back(name: str, tmp_path: Path) -> None:
    """As a diagnosis would get it; none is asked."""
    made = drawn(Lot("knee", "none", 20, 0, name))
    write_gap_case(made.case, tmp_path / made.case.name)
    back = read_gap_case(tmp_path / made.case.name)
    assert not made.label.effects and set(made.label.reduction.values()) == {0.0}
    for one, other in zip(
        (*made.case.calibration, *made.case.evaluation), (*back.calibration, *back.evaluation), strict=True
    ):
        np.testing.assert_allclose(other.signals.values, one.signals.values, rtol=1e-5, atol=1e-9)
    for channel, at in made.label.floor.items():  # the refitted base is at its floor
        assert made.label.rmse_before[channel] is not None and made.label.rmse_before[channel] < 2.0 * at
