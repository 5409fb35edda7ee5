"""A best value is told where it can be, and not where it cannot."""

from __future__ import annotations

import numpy as np
import pytest
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.choice import away, choose, choose_pair

VALUES = np.linspace(0.066, 0.151, 9)


def drawn(at: float, spread: float, seed: int = 0) -> Float[np.ndarray, "d n"]:
    """An outcome that rises with the value, and is 1 at a place that is known with an error."""
    place = at + spread * np.random.default_rng(seed).standard_normal(60)
    return np.asarray(1.0 + 20.0 * (VALUES - place[:, None]))


def test_the_interval_is_that_of_the_place() -> None:
    both = np.stack([drawn(0.11, 0.004), drawn(0.112, 0.004, 1), drawn(0.111, 0.004, 2)], axis=1)
    found = choose(VALUES, both, "nearest", 1.0, 0.14, 0.95)
    assert found.told and found.better
    assert found.best == pytest.approx(0.111, abs=2e-3)
    assert found.lower == pytest.approx(0.111 - 2.0 * 0.004, abs=4e-3)
    assert found.upper == pytest.approx(0.111 + 2.0 * 0.004, abs=4e-3)
    median, lower, upper = found.gain["angles kept"]
    assert median == pytest.approx(20.0 * (0.14 - 0.11), rel=0.1)
    assert lower < median < upper


def test_what_is_not_known_is_not_told() -> None:
    wide = np.stack([drawn(0.11, 0.04), drawn(0.11, 0.04, 1), drawn(0.11, 0.04, 2)], axis=1)
    found = choose(VALUES, wide, "nearest", 1.0, 0.14, 0.95)
    assert not found.told and np.isnan(found.best) and not found.better
    assert (found.lower, found.upper) == (VALUES[0], VALUES[-1])


def test_a_value_without_effect_has_no_best() -> None:
    level = np.ones((60, 3, 9)) * np.random.default_rng(0).normal(50.0, 5.0, (60, 1, 1))
    found = choose(VALUES, level, "least", None, 0.1, 0.95)
    assert not found.told and found.why == "no value has any effect"
    half = np.stack([drawn(0.11, 0.004), level[:, 1], drawn(0.11, 0.004, 1)], axis=1)
    only = choose(VALUES, half, "nearest", 1.0, 0.14, 0.95)
    assert only.told and "torque kept it has no effect" in only.why
    assert set(only.gain) == {"angles kept", "joint torques kept"}


def test_a_level_stretch_is_not_a_choice_within_it() -> None:
    """An outcome that hardly changes beyond 0.09 m: whatever each draw's least is there, no value is better."""
    rng = np.random.default_rng(2)
    level = np.where(VALUES < 0.09, 2.0, 1.0) + 1e-4 * rng.standard_normal((60, 3, 9))
    found = choose(VALUES, level, "nearest", 1.0, 0.07, 0.95)
    assert not found.told and "most of the range" in found.why


def test_responses_that_call_for_different_values_give_no_answer() -> None:
    apart = np.stack([drawn(0.072, 0.002), drawn(0.145, 0.002, 1), drawn(0.11, 0.002, 2)], axis=1)
    found = choose(VALUES, apart, "nearest", 1.0, 0.1, 0.95)
    assert not found.told and "angles or torque" in found.why
    assert found.sides["joint torques kept"].best == pytest.approx(0.11, abs=2e-3)


def test_the_present_value_may_be_as_good() -> None:
    both = np.stack([drawn(0.11, 0.01), drawn(0.11, 0.01, 1), drawn(0.11, 0.01, 2)], axis=1)
    found = choose(VALUES, both, "nearest", 1.0, 0.112, 0.95)
    assert found.told and not found.better


def test_senses() -> None:
    outcome = np.array([[1.0, 3.0, 2.0]])
    assert np.argmin(away(outcome, "least", None)) == 0
    assert np.argmin(away(outcome, "most", None)) == 1
    assert np.argmin(away(outcome, "most", 2.1)) == 2
    with pytest.raises(ValueError, match="target"):
        away(outcome, "nearest", None)


def pairs(gain: float) -> Float[np.ndarray, "d m judged n"]:
    """An outcome that is least at 0.11 and, by `gain` of its size, with the foot turned up; known with an error."""
    rng, turns = np.random.default_rng(3), np.array([0.0, -0.5, -1.0])
    bowl = 1.0 + 40.0 * (VALUES - 0.11) ** 2 + gain * turns[:, None]
    each = 1.0 + 0.02 * rng.standard_normal((40, 3, 2, 1)) * np.abs(turns)[:, None, None]
    return np.asarray(bowl[None, :, None] * each)


def test_a_second_change_is_better_only_where_it_gains_surely() -> None:
    turns = np.radians([0.0, 3.0, 6.0])
    surely, hardly = (choose_pair(VALUES, turns, pairs(gain), "least", None, 0.95) for gain in (0.2, 0.005))
    assert surely.better and surely.alignment == turns[2] and surely.value == surely.alone
    assert surely.gain["torque kept"][0] == pytest.approx(0.2, rel=0.1)
    assert surely.alignments == (turns[2], turns[2])
    assert not hardly.better and hardly.alignments[0] == turns[0]
    assert hardly.as_good[0] <= hardly.alone <= hardly.as_good[1]
