"""Budgets of the practice cases beside the repository, whose effects and true reductions are known."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import pytest

import geocontact as gc

SHARED = Path(__file__).resolve().parents[2].parent / "shared"
PRACTICE = SHARED / "gap" / "practice"
NAMED = ("elbow_02", "foot_01", "knee_01")


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMED)
def test_the_share_of_a_named_effect_holds_the_true_one(name: str) -> None:
    """1 - (after/before)² of the case's label, which a simulator elsewhere made, is inside in every channel."""
    if not PRACTICE.is_dir():
        pytest.skip("no practice cases: ../shared/gap/practice is absent")
    label = json.loads((PRACTICE / "labels.json").read_text())[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.diagnose(PRACTICE / name, bare=True).diagnosis
    alike = {*found.effects, *(name for group in found.one_law for name in group)}
    assert set(label["effects"]) <= alike, "named, or one law with what is"
    for channel, parts in found.budget.items():
        true = 1.0 - (label["rmse_after"][channel] / label["rmse_before"][channel]) ** 2
        low, high = parts["effects"].ci95
        assert low - 0.01 <= true <= high + 0.01, channel
        assert sum(part.share for part in parts.values()) == pytest.approx(1.0)
        assert parts["unexplained"].ci95[0] < 0.1, "nothing but the effect is missing"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "effect", "parameter", "size", "near"),
    [
        ("gap_01", "clock_slip", "clock_slip.once.delay", 0.09, 0.003),
        ("gap_02", "play", "play.angle.width", 0.08, 0.003),
    ],
)
def test_a_slip_and_play_are_named_at_their_size(
    name: str, effect: str, parameter: str, size: float, near: float
) -> None:
    """A clock that slips half-way and play: 1.66 N m and 1.09 N m of error where 0.1 N m of noise are stated."""
    case = SHARED / "cases" / name
    if not case.is_dir():
        pytest.skip("no cases: ../shared/cases is absent")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.diagnose(case, bare=True).diagnosis
    assert (found.verdict, found.effects) == ("explained", (effect,))
    assert found.parameters[parameter].value == pytest.approx(size, abs=near)
    assert found.budget["torque"]["effects"].share > 0.95 and found.budget["torque"]["sensor"].share < 0.02
