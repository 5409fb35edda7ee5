"""A schedule over strides by hand: places by stride, speed, time and phase, how fast an actuator must be, refusals."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.leg_tree import RECORDED, LegMotion
from geocontact.below_knee_prosthesis.schedule import (
    FulcrumSchedule,
    ScheduledPlace,
    fastest,
    never_reached,
    strides_by,
)
from tests.below_knee_prosthesis.model.legs import a_leg

STANCES = [(0.2, 0.9), (1.3, 2.0), (2.4, 3.1)]
"""Touch-down and toe-off [s]: 0.4 s of swing between."""
LOW, HIGH = 0.066, 0.151


def motion(*speeds: float) -> LegMotion:
    """A pelvis that walks at each speed up to the end of a stance [m/s]."""
    time = np.linspace(0.0, 3.5, 3501)
    ends = [0.0, *(off for _, off in STANCES[: len(speeds) - 1]), 3.5]
    speed = np.array(speeds)[np.searchsorted(ends[1:-1], time, side="right")]
    values = np.zeros((len(time), len(RECORDED)))
    values[:, RECORDED.index("pelvis_tx")] = np.concatenate([[0.0], np.cumsum(0.001 * speed[:-1])])
    return LegMotion(a_leg(), time, values)


def schedule(by: Literal["stride", "time", "speed", "phase"], *rows: tuple[float, str]) -> FulcrumSchedule:
    places = {"low": LOW, "high": HIGH}
    return FulcrumSchedule(by, tuple(ScheduledPlace(float(start), name, places[name]) for start, name in rows))


def names(by: Literal["stride", "time", "speed", "phase"], *rows: tuple[float, str], speeds: Any = (1.2,)) -> list[str]:
    return [each.place.name for each in strides_by(schedule(by, *rows), STANCES, motion(*speeds))]


def test_places_by_hand() -> None:
    assert names("stride", (1, "low"), (3, "high")) == ["low", "low", "high"]
    assert names("time", (0.0, "low"), (0.95, "high"), (2.1, "low")) == ["low", "high", "low"]
    # up to the first toe-off 1.1 m/s, to the second 1.5 m/s: that of the swing is not known yet when the fulcrum moves
    assert names("speed", (0.0, "low"), (1.3, "high"), speeds=(1.1, 1.5, 1.2)) == ["low", "low", "high"]
    assert names("phase", (0.0, "high")) == ["high"] * 3
    assert names("phase", (0.70, "low"), (0.85, "high")) == ["high"] * 3  # low in swing alone


def test_a_move_has_the_swing_and_asks_its_way_over_that() -> None:
    found = strides_by(schedule("stride", (1, "low"), (2, "high")), STANCES, motion(1.2))
    worst = fastest(found)
    assert worst is not None
    assert (worst[0].number, worst[1].travel) == (2, pytest.approx(0.085))
    assert worst[1].speed == pytest.approx(0.085 / 0.4)
    assert np.isnan(found[0].speed)
    assert [each.speed for each in found[1:]] == pytest.approx([1.2] * 2, rel=1e-3)
    late = strides_by(schedule("time", (0.0, "low"), (1.1, "high")), STANCES, motion(1.2))
    assert late[1].moves[0].speed == pytest.approx(0.085 / 0.2)  # commanded 0.2 s after toe-off
    there_and_back = strides_by(schedule("phase", (0.70, "low"), (0.85, "high")), STANCES, motion(1.2))
    # strides of 1.1 s: low from 0.97 to 1.135 s, high until touch-down at 1.3 s
    assert [each.speed for each in there_and_back[1].moves] == pytest.approx([0.085 / 0.165] * 2)
    assert fastest(strides_by(schedule("stride", (1, "low")), STANCES, motion(1.2))) is None


@pytest.mark.parametrize(
    ("by", "rows", "words"),
    [
        ("time", [(0.0, "low"), (1.5, "high")], r"at 1.50 s, in stance 2 \(1.30 to 2.00 s\): under load it cannot"),
        ("phase", [(0.0, "low"), (0.5, "high")], "in stance 1"),
        ("time", [(0.5, "low")], "begins later than stride 1"),
        ("stride", [(2, "low")], "begins later than stride 1"),
        ("speed", [(1.5, "low")], "begins later than stride 2, walked at 1.20 m/s"),
    ],
)
def test_refused(by: Any, rows: list[tuple[float, str]], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        strides_by(schedule(by, *rows), STANCES, motion(1.2))


def test_phases_need_a_whole_stride() -> None:
    with pytest.raises(ValueError, match="one stance has no stride"):
        strides_by(schedule("phase", (0.0, "low")), STANCES[:1], motion(1.2))


def test_the_same_place_again_is_no_move_and_may_be_said_in_stance() -> None:
    assert names("time", (0.0, "low"), (0.5, "low"), (1.0, "high")) == ["low", "high", "high"]


@pytest.mark.parametrize(
    ("by", "rows", "missed"),
    [
        ("stride", [(1, "low"), (3, "high")], []),
        ("stride", [(1, "low"), (4, "high")], [4]),
        ("speed", [(1.1, "low"), (1.4, "high")], [1.4]),
        ("speed", [(0.5, "high"), (1.1, "low")], []),  # the first row is that of the first stride
        ("time", [(-1.0, "low"), (0.1, "high"), (2.5, "high")], [2.5]),
        ("phase", [(0.70, "low"), (0.85, "high")], []),
    ],
)
def test_rows_that_no_stride_comes_to(by: Any, rows: list[tuple[float, str]], missed: list[float]) -> None:
    of = schedule(by, *rows)
    assert [each.start for each in never_reached(of, strides_by(of, STANCES, motion(1.2)))] == missed
