"""Noise of measured inputs: seen in the spectrum, taken off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, filtfilt

from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.gap.inputs.denoise import bins_wide, denoised, highest_noise, left, seen_noise, shaken
from geocontact.gap.inputs.spectrum import spectrum, switches
from geocontact.identify.signals.low_pass import LowPass

STEP = 0.02


def trial(noise: float, speed: float, seed: int, lost: bool = False, corner: float = 6.0) -> tuple[Trial, np.ndarray]:
    rng = np.random.default_rng(seed)
    time = STEP * np.arange(1000)
    clean = 0.5 * np.sin(2.0 * np.pi * speed * time) + 0.2 * np.sin(2.0 * np.pi * 0.6 * speed * time + 1.0)
    raw = filtfilt(*butter(2, corner, fs=1.0 / STEP), rng.standard_normal(len(time) + 200))[100:-100]
    values = clean + noise * raw / raw.std()
    keep = rng.random(len(time)) > 0.02 if lost else np.ones(len(time), bool)
    return Trial("t", Signals(time[keep], values[keep, None], ("u",), ("rad",))), clean[keep]


def test_noise_of_a_slow_movement_shows() -> None:
    trials = [trial(0.004, 0.25, seed)[0] for seed in range(3)]
    assert seen_noise(trials, "u", LowPass(6.0, STEP)) == pytest.approx(0.004, rel=0.25)


def test_noise_is_looked_for_below_the_corner_of_its_filter() -> None:
    trials = [trial(0.004, 0.25, seed, corner=14.0)[0] for seed in range(3)]
    assert seen_noise(trials, "u", LowPass(14.0, STEP)) == pytest.approx(0.004, rel=0.25)


def test_a_fast_movement_hides_it() -> None:
    assert seen_noise([trial(0.0001, 2.2, seed)[0] for seed in range(3)], "u", LowPass(6.0, STEP)) is None


def test_no_input_is_noisier_than_the_quietest_band_of_its_spectrum() -> None:
    """Nor is the limit below the noise where the corner is taken for too high by half."""
    slow = [trial(0.004, 0.25, seed)[0] for seed in range(3)]
    assert 0.004 < highest_noise(slow, "u", LowPass(6.0, STEP)) < 0.008
    assert highest_noise(slow, "u", LowPass(9.0, STEP)) > 0.004
    fast = [trial(0.0001, 2.2, seed)[0] for seed in range(3)]
    assert 0.0001 < highest_noise(fast, "u", LowPass(6.0, STEP)) < 0.1


@pytest.mark.parametrize(("count", "samples"), [(1, 50), (1, 100), (3, 50), (5, 200)])
def test_noise_is_hardly_ever_louder_than_its_limit(count: int, samples: int) -> None:
    """Nothing but noise, few and short trials: the quietest of the bands is quiet by chance."""
    over = 0
    for seed in range(60):
        trials = []
        for k in range(count):
            raw = filtfilt(
                *butter(2, 6.0, fs=1.0 / STEP), np.random.default_rng([seed, k]).standard_normal(samples + 200)
            )
            values = 0.004 * raw[100:-100] / raw.std()
            trials.append(Trial("t", Signals(STEP * np.arange(samples), values[:, None], ("u",), ("rad",))))
        over += highest_noise(trials, "u", LowPass(6.0, STEP)) < 0.004
    assert over <= 3


def test_trials_too_short_for_a_spectrum_set_no_limit() -> None:
    whole = trial(0.004, 0.25, 0)[0]
    few = Trial("t", Signals(whole.time[:20], whole.signals.values[:20], ("u",), ("rad",)))
    assert highest_noise([few], "u", LowPass(6.0, STEP)) == np.inf


@pytest.mark.parametrize("lost", [False, True])
def test_most_of_the_noise_goes_and_the_movement_stays(lost: bool) -> None:
    recorded, clean = trial(0.004, 0.25, 4, lost)
    better = denoised(recorded, {"u": 0.004}, {"u": LowPass(6.0, STEP)}).column("u")
    inside = slice(20, -20)
    assert np.std((better - clean)[inside]) < 0.6 * np.std((recorded.column("u") - clean)[inside])


def test_both_sides_of_a_pause_are_taken_for_themselves() -> None:
    """As two trials are: a straight line over a pause is no movement."""
    whole, _ = trial(0.01, 0.5, 1)
    rows = [slice(0, 450), slice(450, 1000)]
    time = whole.time + np.where(np.arange(1000) < 450, 0.0, 30.0)
    paused = replace(part(whole, time, slice(None)), pieces=((time[0], time[449]), (time[450], time[-1])))
    passed, sides = LowPass(6.0, STEP), [part(whole, time, own) for own in rows]
    calm = [denoised(one, {"u": 0.01}, {"u": passed}).column("u") for one in (paused, *sides)]
    np.testing.assert_allclose(calm[0], np.concatenate(calm[1:]), atol=1e-12)
    assert np.abs(calm[0] - whole.column("u")).max() > 0.005
    assert seen_noise([paused], "u", passed) == pytest.approx(seen_noise(sides, "u", passed))
    kept, by_sides = (left(trials, "u", 0.01, passed) for trials in ([paused], sides))
    assert kept is not None and by_sides is not None
    np.testing.assert_allclose(kept.share, by_sides.share)


def test_a_spectrum_is_of_the_long_runs_of_a_trial() -> None:
    whole, _ = trial(0.01, 0.5, 1)
    time = whole.time + np.where(np.arange(1000) < 800, 0.0, 30.0)
    paused = replace(part(whole, time, slice(None)), pieces=((time[0], time[799]), (time[800], time[-1])))
    seen, long = (spectrum([one], "u", STEP) for one in (paused, part(whole, time, slice(0, 800))))
    assert seen is not None and long is not None
    np.testing.assert_allclose(seen.power, long.power)


def part(whole: Trial, time: np.ndarray, rows: slice) -> Trial:
    """Some rows of a trial, at these times."""
    return replace(whole, signals=replace(whole.signals, time=time[rows], values=whole.signals.values[rows]))


def test_without_noise_nothing_changes() -> None:
    recorded, _ = trial(0.004, 0.25, 5)
    same = denoised(recorded, {"u": 1e-9}, {"u": LowPass(6.0, STEP)}).column("u")
    assert np.abs(same - recorded.column("u")).max() < 1e-6


def test_what_sets_out_sharply_after_a_rest_stays_sharp() -> None:
    """One spectrum for a whole trial would take what is fast at the few onsets for noise."""
    time = STEP * np.arange(1000)
    share = np.clip((time[:, None] - np.array([4.0, 9.0, 14.0])) / 0.5, 0.0, 1.0)
    clean = (np.array([1.2, -1.2, 1.2]) * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)).sum(axis=1)
    moves = ((share > 0.0) & (share < 1.0)).any(axis=1)
    rest = []
    for seed in range(6):
        raw = filtfilt(*butter(2, 6.0, fs=1.0 / STEP), np.random.default_rng(seed).standard_normal(len(time) + 200))
        recorded = clean + 0.002 * raw[100:-100] / raw.std()
        trial = Trial("t", Signals(time, recorded[:, None], ("u",), ("rad",)))
        rest.append(denoised(trial, {"u": 0.002}, {"u": LowPass(6.0, STEP)}).column("u") - clean)
    assert np.std(np.array(rest)[:, ~moves]) < 0.75 * 0.002
    assert np.std(np.array(rest)[:, moves]) < 0.002


def test_what_is_left_of_the_noise_is_told_by_frequency() -> None:
    trials = [trial(0.004, 0.25, seed)[0] for seed in range(4)]
    kept = left(trials, "u", 0.004, LowPass(6.0, STEP))
    assert kept is not None
    assert kept(np.array([0.0]))[0] > 0.99, "what a cubic follows stays"
    assert kept(np.array([4.0]))[0] < 0.6
    off = np.concatenate(
        [
            denoised(t, {"u": 0.004}, {"u": LowPass(6.0, STEP)}).column("u") - trial(0.004, 0.25, seed)[1]
            for seed, t in enumerate(trials)
        ]
    )
    grid = np.linspace(0.0, 10.0, 400)
    power = LowPass(6.0, STEP).power(grid)
    share = float((power * kept(grid)).sum() / power.sum())
    assert float(off.std()) == pytest.approx(0.004 * np.sqrt(share), rel=0.25)


def test_as_much_noise_again_is_as_much_as_is_left() -> None:
    rng, off, more = np.random.default_rng(0), [], []
    for seed in range(6):
        recorded, clean = trial(0.004, 0.25, seed)
        better = denoised(recorded, {"u": 0.004}, {"u": LowPass(6.0, STEP)}).column("u")
        off.append(better - clean)
        more.append(shaken(recorded, {"u": 0.004}, {"u": LowPass(6.0, STEP)}, rng).column("u") - better)
    assert float(np.std(more)) == pytest.approx(float(np.std(off)), rel=0.25)
    assert abs(float(np.corrcoef(np.ravel(more), np.ravel(off))[0, 1])) < 0.2


def test_an_input_that_never_moves_leaves_no_more_than_there_was() -> None:
    still = [Trial("t", Signals(STEP * np.arange(500), np.full((500, 1), 1.0), ("u",), ("m",)))]
    kept = left(still, "u", 0.004, LowPass(6.0, STEP))
    assert kept is not None
    assert kept.share.min() >= 0.0
    assert kept.share.max() <= 1.0


@pytest.mark.parametrize(("values", "flag"), [([0.0, 1.0], True), ([0.3], True), ([0.0, 0.1, 1.0], False)])
def test_what_goes_on_and_off_is_no_measurement(values: list[float], flag: bool) -> None:
    column = np.resize(values, 100)
    recorded = Trial("t", Signals(STEP * np.arange(100), column[:, None], ("u",), ("-",)))
    assert switches([recorded], "u") is flag


def test_bins_that_a_window_makes_one_of() -> None:
    """Blackman's window has the noise of 1.73 bins in each, no window that of one (Harris 1978, table 1)."""
    assert bins_wide(np.blackman(10_000)) == pytest.approx(1.73, abs=0.005)
    assert bins_wide(np.ones(100)) == pytest.approx(1.0)
