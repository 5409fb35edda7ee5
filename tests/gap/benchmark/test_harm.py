"""Whether an answer makes held-out predictions worse, and how certain a false claim is."""

from __future__ import annotations

from typing import Any

import pytest

from geocontact.gap_benchmark.score import certainty, harmful, score, worse_channels, worse_in_sum

LABEL = {
    "kind": "none",
    "effects": [],
    "nats": {},
    "rmse_before": {"force_x": 10.0, "force_y": 50.0},
    "rmse_after": {"force_x": 10.0, "force_y": 50.0},
    "reduction": {"force_x": 0.0, "force_y": 0.0},
    "floor": {"force_x": 2.0, "force_y": 40.0},
}


def answer(after_x: float, after_y: float, half_width: float = 0.1, effects: tuple[str, ...] = ("damping",)) -> Any:
    def gap(before: float, after: float) -> dict[str, Any]:
        r = 1.0 - after / before
        return {"rmse_before": before, "rmse_after": after, "reduction": r, "ci95": [r - half_width, r + half_width]}

    return {
        "verdict": "explained" if effects else "no_gap",
        "effects": list(effects),
        "probabilities": {**{name: 0.95 / len(effects) for name in effects}, "none": 0.05 if effects else 1.0},
        "ambiguity": list(effects),
        "gap": {"force_x": gap(10.0, after_x), "force_y": gap(50.0, after_y)},
    }


@pytest.mark.parametrize(
    ("after", "channels", "in_sum"),
    [
        ((5.0, 45.0), [], False),
        ((5.0, 60.0), ["force_y"], False),  # 20 % worse where 10 % are uncertain; x shrinks by more floors
        ((5.0, 54.0), [], False),  # 8 % worse
        ((10.5, 50.0), [], True),  # within its interval, but nothing else got better
        ((39.0, 258.0), ["force_x", "force_y"], True),
    ],
)
def test_worse_is_told_by_channel_and_in_units_of_the_floor(
    after: tuple[float, float], channels: list[str], in_sum: bool
) -> None:
    said = answer(*after)
    assert worse_channels(LABEL, said) == channels and worse_in_sum(LABEL, said) is in_sum
    assert harmful(LABEL, said) is (bool(channels) or in_sum)


def test_nothing_named_does_no_harm() -> None:
    said = answer(39.0, 258.0, effects=())
    assert not harmful(LABEL, said) and certainty(said) == 0.0


def test_without_held_out_errors_the_reduction_tells() -> None:
    said = answer(10.0, 50.0)
    said["gap"] = {"force_x": {"reduction": -0.5, "ci95": [-0.6, -0.4]}, "force_y": {"reduction": 0.0, "ci95": None}}
    assert worse_channels(LABEL, said) == ["force_x"] and worse_in_sum(LABEL, said)


def test_a_pair_is_as_certain_as_both_together() -> None:
    assert certainty(answer(5.0, 45.0, effects=("damping", "slip"))) == pytest.approx(0.95)
    assert certainty({"effects": [], "probabilities": {"unknown": 0.97, "none": 0.03}}) == 0.97


def test_harm_and_certain_alarms_are_scored_where_they_can_be() -> None:
    labels = {"a": LABEL, "b": LABEL, "c": LABEL}
    found = score(labels, {"a": answer(39.0, 258.0), "b": answer(5.0, 45.0), "c": answer(10.0, 50.0, effects=())})
    assert (found.false_alarms.hits, found.false_alarms.count) == (2, 3)
    assert (found.sure_alarms.hits, found.sure_alarms.count) == (2, 3)
    assert (found.harm.hits, found.harm.count) == (1, 2)
    assert (found.harm_in_sum.hits, found.harm_in_channel.hits) == (1, 1)
