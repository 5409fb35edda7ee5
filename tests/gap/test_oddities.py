"""Lines, bursts, held samples and coarse steps are seen; noise is none of them."""

from __future__ import annotations

import numpy as np
import pytest
from tests.gap.cases import Change, elbow_case

from geocontact.gap.contest import base_contender
from geocontact.gap.oddities import oddities
from geocontact.gap.problem import problem_of
from geocontact.systems.catalogue import system_of


def found(change: Change | None, after: Change | None = None) -> dict[str, float]:
    case = elbow_case(seed=8, duration=24.0, change=change)
    if after:
        for trial in case.calibration + case.evaluation:
            column = trial.signals.values[:, 1]
            trial.signals.values[:, 1] = after(trial.name, trial.time, column)
    problem = problem_of(case, system_of(case))
    return {each.words: each.nats for each in oddities(problem, base_contender(problem).judged)}


def test_noise_is_not_odd() -> None:
    assert max(found(None).values()) < 4.0


def test_a_tremor_is_a_line_at_its_frequency() -> None:
    seen = found(lambda _, time, force: force + 0.25 * np.sin(2.0 * np.pi * 7.0 * time))
    words, nats = max(seen.items(), key=lambda each: each[1])
    assert nats > 20.0
    assert float(words.split()[3]) == pytest.approx(7.0, abs=0.3)


def test_a_knock_in_one_trial_is_a_burst() -> None:
    def knock(name: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        ringing = 1.5 * np.exp(-(time - 9.0) / 0.3) * np.sin(40.0 * time) * (time > 9.0)
        return force + ringing * (name == "t02")

    assert found(knock)["a burst"] > 15.0


def test_samples_that_are_held() -> None:
    def held(_: str, __: np.ndarray, force: np.ndarray) -> np.ndarray:
        out = force.copy()
        for start in range(20, len(out) - 5, 40):
            out[start + 1 : start + 4] = out[start]
        return out

    seen = found(None, held)
    assert any("repeat the last" in words and nats > 20.0 for words, nats in seen.items())


def test_coarse_steps() -> None:
    seen = found(None, lambda _, __, force: np.round(force / 0.2) * 0.2)
    assert any(words.startswith("it comes in steps of 0.2") for words in seen)
