"""What repeats from trial to trial: a shared wave is found at its size, slow noise of each trial's own is not."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.reduction.repeats import axes_of, repeats
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case

N, TRIALS = 400, 5
PHASE = np.arange(N) / N
AXES = {"phase": [np.minimum((PHASE * 20).astype(int), 19)] * TRIALS}
THERE = [np.ones(N, bool)] * TRIALS


def slow_noise(rng: np.random.Generator) -> np.ndarray:
    """Autoregressive, remembered over 12 samples, standard deviation 1."""
    memory, steps = np.exp(-1.0 / 12.0), rng.standard_normal(N)
    out = np.zeros(N)
    for k in range(1, N):
        out[k] = memory * out[k - 1] + np.sqrt(1.0 - memory**2) * steps[k]
    return out


def test_a_wave_that_all_trials_share_is_found_at_its_size() -> None:
    """Of a wave of two periods with a variance of 1 beside white noise of 0.5 two thirds repeat, but for what is lost
    inside a bin: sin(x)/x of half its width, squared.
    """
    rng = np.random.default_rng(1)
    wave = np.sqrt(2.0) * np.sin(4.0 * np.pi * PHASE)
    found = repeats([wave + np.sqrt(0.5) * rng.standard_normal(N) for _ in range(TRIALS)], THERE, AXES)
    assert found.axis == "phase"
    assert found.share == pytest.approx(np.sinc(0.1) ** 2 / 1.5, abs=0.03)
    assert 0.1 < found.sure < found.share
    whole = repeats([wave] * TRIALS, THERE, AXES)
    assert whole.share == pytest.approx(np.sinc(0.1) ** 2, abs=0.01)


def test_the_share_is_that_of_products_of_different_trials_by_hand() -> None:
    """Constants 1 and 3 in two trials: product 3, of a mean square of 5; of opposite sign nothing repeats."""
    flat = {"phase": [np.zeros(N, int)] * 2}
    assert repeats([np.full(N, 1.0), np.full(N, 3.0)], THERE[:2], flat).share == pytest.approx(0.6)
    assert repeats([np.full(N, 1.0), np.full(N, -3.0)], THERE[:2], flat).share == 0.0
    assert repeats([np.full(N, 1.0)], THERE[:1], {"phase": [np.zeros(N, int)]}).share == 0.0


def test_slow_noise_of_each_trial_seldom_repeats() -> None:
    rng = np.random.default_rng(2)
    sure = [repeats([slow_noise(rng) for _ in range(TRIALS)], THERE, AXES).sure for _ in range(60)]
    assert np.mean(np.array(sure) > 0.1) <= 0.05, sorted(sure)[-5:]


def test_axes_are_the_phase_and_each_input_up_and_down() -> None:
    case = elbow_case(seed=2)
    system = system_of(case)
    found = axes_of(case.calibration, system)
    assert list(found) == ["phase", *system.inputs]
    trial, bins = case.calibration[0], found["beta"][0]
    rising = np.gradient(trial.column("beta"), trial.time) > 0.2
    assert (bins[rising] % 2 == 1).mean() > 0.98
    counts = np.bincount(np.concatenate(found["beta"]) // 2)
    assert len(counts) == 4 and counts.max() < 1.3 * counts.min()
