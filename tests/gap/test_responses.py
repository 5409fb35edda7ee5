"""Noise of the recorded arm as the exoskeleton's own motion passes it on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geocontact.chain.system import System
from geocontact.data.trial import Trial
from geocontact.gap.case.whitening import propagated_input_noise
from geocontact.gap.inputs.denoise import drawn as noise
from geocontact.gap_benchmark.drawing import Lot, drawn
from geocontact.identify.noise.input_noise import Lasting
from geocontact.identify.signals.low_pass import LowPass
from geocontact.systems.catalogue import system_of

SD = 1e-3
"""Of the arm's noise [rad]."""


def scene() -> tuple[System, Trial, dict[str, float], LowPass]:
    case = drawn(Lot("shoulder", "none", 20260101, 0)).case
    system = system_of(case)
    trial = case.calibration[0]
    return system, trial, dict(system.start), LowPass(6.0, float(np.median(np.diff(trial.time))))


@pytest.mark.slow
def test_covariance_is_that_of_simulated_noise() -> None:
    system, trial, values, passed = scene()
    assert system.dynamic
    rng, plain = np.random.default_rng(0), system.simulate(trial, values)
    column = trial.signals.channels.index("arm")
    even = np.arange(trial.time[0], trial.time[-1] + 0.5 * passed.step, passed.step)
    made = []
    for _ in range(400):
        shaken = trial.signals.values.copy()
        shaken[:, column] += np.interp(trial.time, even, noise(rng, len(even), passed.step, SD, passed))
        moved = replace(trial, signals=replace(trial.signals, values=shaken))
        made.append((system.simulate(moved, values) - plain)[200:230])
    together = np.array(made).transpose(0, 2, 1).reshape(400, -1)
    seen = together.T @ together / 400.0
    at, channel = np.tile(np.arange(200, 230), 2), np.repeat([0, 1], 30)
    expected = (
        SD**2
        * propagated_input_noise(system, trial, values, dict.fromkeys(system.inputs, passed), {}).covariance(
            at, channel
        )[0]
    )
    for c in (0, 1):
        own = np.flatnonzero(channel == c)
        assert_allclose(np.diag(seen)[own], np.diag(expected)[own], rtol=0.35)
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert np.abs((seen - expected) / scale).max() < 0.25
    assert np.abs(expected / scale)[:30, 30:].max() > 0.5, "angle and force feel the same noise"


def test_without_a_motion_of_its_own_the_force_would_hardly_feel_it() -> None:
    """What a resting arm says is not what a shaken one does."""
    system, trial, values, passed = scene()
    at, channel = np.arange(200, 230), np.ones(30, int)
    lasting = propagated_input_noise(system, trial, values, dict.fromkeys(system.inputs, passed), {}).covariance(
        at, channel
    )[0]
    instant = propagated_input_noise(
        replace(system, dynamic=False), trial, values, dict.fromkeys(system.inputs, passed), {}
    ).covariance(at, channel)[0]
    assert np.abs(np.diag(lasting) / np.diag(instant) - 1.0).min() > 0.3


def test_a_dropout_is_filled_from_both_sides() -> None:
    """Rates within it come from samples far away; they are not put on other samples."""
    system, trial, values, passed = scene()
    signals = trial.signals
    gone = signals.values.copy()
    column = signals.channels.index("arm")
    gone[200:230, column] = np.nan
    broken = replace(trial, signals=replace(signals, values=gone))
    found = propagated_input_noise(system, broken, values, dict.fromkeys(system.inputs, passed), {})
    assert isinstance(found, Lasting)
    step = 1e-4
    moved = gone.copy()
    moved[230, column] += step
    other = replace(broken, signals=replace(signals, values=moved))
    answer = (system.simulate(other, values) - system.simulate(broken, values)) / step
    stored = np.array([found.response[0, i, :, i - 230 + found.ahead] for i in range(200, 240)])
    assert_allclose(stored, answer[200:240], rtol=0.02, atol=0.02 * np.abs(answer).max())
