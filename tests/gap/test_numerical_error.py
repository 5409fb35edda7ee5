"""Predictions from rates are off where sampling is coarse for the movement; that is allowed for, and told."""

from __future__ import annotations

import re

import numpy as np
import pytest

import geocontact as gc
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.gap.case.noise_sources import coarse_rates, error_of_rates
from geocontact.gap.case.placement import placement
from geocontact.gap.case.preparation import problem_of

STEP, NOISE = 0.01, 0.02
MASS = gc.Parameter("m", "kg", 1.0, 0.1, 10.0)


def run(time: np.ndarray, inputs: np.ndarray, numbers: dict, law: gc.chain.ActingLaw) -> np.ndarray:
    """A mass that is moved."""
    return numbers["m"] * law.acceleration


def carriage() -> System:
    base = gc.simulator_base("carriage", {"q": "m"}, {"force": "N"}, run, dynamic=True, acts_on="q")
    return base.build((MASS,), {}, {}).reaching(2.5 * STEP)


def trial(q: np.ndarray, force: np.ndarray) -> Trial:
    time = STEP * np.arange(len(q))
    return Trial("t", Signals(time, np.column_stack([q, force]), ("q", "force"), ("m", "N")))


@pytest.mark.parametrize("cycles", [4.0, 8.0, 12.0])
def test_the_error_of_a_sine_is_what_its_derivatives_say(cycles: float) -> None:
    """Of 4, 8 and 12 Hz at 100 Hz, away from the ends."""
    time, pace = STEP * np.arange(200), 2.0 * np.pi * cycles
    q = np.sin(pace * time)
    made = trial(q, -(pace**2) * q)
    system = carriage()
    off = (system.simulate(made, {"m": 1.0}) - made.column("force")[:, None])[20:-20]
    told = error_of_rates(system, made, {"m": 1.0})[20:-20]
    ratio = float((told * off).sum() / (off * off).sum())
    assert 0.6 < ratio < 1.4 and np.std(told - ratio * off) < 0.05 * np.std(told)


def told(swinging: float) -> tuple[str, ...]:
    """Of carriages that move slowly and swing out beside it, so far at first [m]."""
    time, rng = STEP * np.arange(150), np.random.default_rng(1)
    decay = -25.0 + 2j * np.pi * 12.0
    trials = []
    for k in range(4):
        slow, swing = 0.1 * np.sin((3.0 + 0.3 * k) * time), swinging * np.exp(decay * time)
        force = -((3.0 + 0.3 * k) ** 2) * slow + (decay**2 * swing).real
        trials.append(trial(slow + swing.real, force + rng.normal(0.0, NOISE, 150)))
    case = GapCase("carriages", "carriage", tuple(trials[:2]), tuple(trials[2:]), (MASS,), {}, {"force": NOISE})
    return coarse_rates(problem_of(case, carriage()))


def test_where_it_is_far_above_noise_is_told() -> None:
    """Where the swinging begins; a slow movement alone is sampled well."""
    (words,) = told(0.01)
    found = re.fullmatch(
        r"rates of the inputs are recorded too coarsely: at (\S+) s of t force is off by (\S+) times its noise or more",
        words,
    )
    assert found and float(found[1]) < 0.1 and float(found[2]) > 10.0
    assert told(0.0) == ()


def test_the_error_is_allowed_for_beside_what_differs_between_trials() -> None:
    made = trial(np.sin(30.0 * STEP * np.arange(100)), np.zeros(100))
    columns = placement(carriage(), [made], {"m": 1.0}, [], np.array([1.0]))[0]
    np.testing.assert_array_equal(columns[..., -1], error_of_rates(carriage(), made, {"m": 1.0}))
    assert np.abs(columns[..., -1]).max() > 0.0
