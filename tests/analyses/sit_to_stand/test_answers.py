"""Answers of comparison and choice in words, from numbers that were thought up here."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.compare.result import compared_tiles, nearer_than_both
from geocontact.analyses.sit_to_stand.design.answer import AnsweredDesign, answer, at_bounds, tiles
from geocontact.analyses.sit_to_stand.design.show import shown
from geocontact.analyses.sit_to_stand.predict.predictions import warn_of_known

WHAT = "peak force of the strap"
WORN = AnsweredDesign("without help", float("nan"), 40.9, 1.0)
ALONE = AnsweredDesign("share alone", 0.8, 17.6, 0.8)
CHOSEN = AnsweredDesign("chosen", 0.8, 7.0, 0.8)
LOOSE = [
    AnsweredDesign("", 0.95, 3.55, 0.844),
    AnsweredDesign("", 0.9, 3.55, 0.844),
    AnsweredDesign("", 0.85, 3.6, 0.844),
]

NONE: dict[str, Any] = {"strap": None, "torque": None, "force": None}
"""Channels of a stand-in that has coordinates alone."""


def test_the_first_line_is_the_aim_and_the_second_the_bargain() -> None:
    lines = answer(WHAT, "N", [WORN, ALONE, CHOSEN], LOOSE)
    assert lines == [
        f"the {WHAT} is 7 N (40.9 N without help, 17.6 N with share alone), with the knee at 80% of its peak",
        "with the knee at 84% instead of 80% it is 3.6 N",
        "the limit of the knee has no effect above 84.4%",
    ]


def test_nothing_is_said_of_a_front_that_saves_nothing() -> None:
    front = [AnsweredDesign("", 0.9, 6.9, 0.9)]
    assert len(answer(WHAT, "N", [WORN, CHOSEN], front)) == len(answer(WHAT, "N", [WORN, CHOSEN], [])) == 1


def test_tiles_are_aim_knee_and_chosen_numbers_in_mm() -> None:
    found = tiles(WHAT, "N", [WORN, CHOSEN], [("share", 0.61, ""), ("place", 0.34, "m")])
    assert found == [
        (WHAT, "7 N (40.9 N without help)"),
        ("true peak of the knee", "80.0% of that without help"),
        ("share", "0.61"),
        ("place", "340 mm"),
    ]


def test_a_number_at_a_bound_is_named_with_the_bound() -> None:
    chosen = [("share", 0.6, ""), ("place", 0.34, "m"), ("normal", 1e3, "N/m")]
    room = {"share": (0.0, 1.5), "place": (0.1, 0.34), "normal": (1e3, 2e4)}
    assert at_bounds(chosen, [False, True, True], room) == [
        "place is at its upper bound 340 mm",
        "normal is at its lower bound 1000 N/m",
    ]


def test_tables_of_a_choice_have_one_unit_for_a_length_and_no_empty_columns() -> None:
    table = pd.DataFrame({"name": ["place", "normal"], "unit": ["m", "N/m"], "value": [0.34, 2e3]})
    found = shown(table.assign(least=[0.1, 1e3], most=[0.34, 2e4], sd=np.nan))
    assert found.iloc[0].tolist() == ["place", "mm", 340.0, 100.0, 340.0]
    assert found.iloc[1, 0] == "normal stiffness" and "sd" not in found
    steps = pd.DataFrame({"number": ["a"], "per": ["1 m"], "change [N]": [-414.0], "step": ["+1 mm"]})
    found = shown(steps.assign(**{"change by a step [N]": -0.414}))
    assert list(found) == ["number", "step", "change by a step [N]"]


def errors() -> pd.DataFrame:
    rows = []
    for predictor, strap, knee, torque in (
        ("all given", 7.68, 0.42, 0.1),
        ("mean of the calibration", 5.66, 0.58, 9.0),
        ("nearest of the calibration", 6.09, 0.51, 8.0),
    ):
        for quantity, unit, given, rmsd in (
            ("strap", "N", "no", strap), ("knee", "deg", "no", knee), ("knee torque", "N m", "yes", torque)
        ):  # fmt: skip
            known = given if predictor == "all given" else "no"
            told = {"trial": "P1", "predictor": predictor, "quantity": quantity, "unit": unit, "given": known}
            rows.append({**told, "rmsd": rmsd})
    return pd.DataFrame(rows)


def test_channels_that_are_given_do_not_count_for_the_prediction() -> None:
    assert nearer_than_both(errors()) == (1, 2), "the knee; the strap is nearer by both; the torque is given"
    assert compared_tiles(errors()) == [
        ("channels nearer than both baselines", "1 of 2"),
        ("strap, RMSD (better baseline)", "7.68 N (5.66 N)"),
        ("knee, RMSD (better baseline)", "0.42 ° (0.51 °)"),
    ]


@pytest.mark.parametrize(("shift", "count"), [(0.0, 1), (1e-3, 0)])
def test_a_held_out_trial_that_is_one_of_the_calibration_is_noticed(shift: float, count: int) -> None:
    q = np.linspace(0.0, 1.0, 12).reshape(3, 4)
    held_out: Any = SimpleNamespace(name="P1", q=q, **NONE)
    known: Any = [SimpleNamespace(name="T9", q=q[:2], **NONE), SimpleNamespace(name="T2", q=q + shift, **NONE)]
    with collecting(Record("sit-to-stand compare", {})) as record:
        warn_of_known([held_out], known)
    assert len(record.warnings) == count
    if count:
        assert record.warnings[0].startswith("P1: the same recording is T2 in `against`: it is not held out")
