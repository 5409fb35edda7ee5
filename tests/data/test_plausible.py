"""What values can be and mostly are, and what may have been meant."""

from __future__ import annotations

import math
import warnings

import pytest

import geocontact as gc
from geocontact.analyses.misalignment.law_numbers import NUMBERS
from geocontact.data import plausible as ranges
from geocontact.data.errors import InputError
from geocontact.data.plausible import Plausible, numbers_in

EVERY = {name: one for name, one in vars(ranges).items() if isinstance(one, Plausible)}


@pytest.mark.parametrize("known", EVERY.values(), ids=EVERY)
def test_what_is_usual_is_possible_and_the_ends_count(known: Plausible) -> None:
    low, high = known.possible
    usual = known.usual or known.possible
    assert low <= usual[0] < usual[1] <= high
    for end in (*known.possible, *usual):
        assert known.refusal(known.unit(end)) is None
    assert all(known.doubt(known.unit(end)) is None for end in usual)
    width = 1e-6 * (high - low)
    assert known.refusal(known.unit(low - width)) and known.refusal(known.unit(high + width))
    assert known.refusal(math.nan) and known.refusal(math.inf)


@pytest.mark.parametrize(
    ("known", "value", "question"),
    [
        (ranges.THRESHOLD, 4.0, "is 4 mm meant?"),
        (ranges.THRESHOLD, gc.mm(0.004), "is 0.004 m meant?"),
        (ranges.THRESHOLD, gc.mm(60), ""),
        (ranges.ATTACHMENT, 0.22, "is 0.22 N/mm meant?"),
        (ranges.YOUNG, 50.0, "is 50 MPa meant?"),
        (ranges.TURN, 2.0, "is 2 deg meant?"),
        (ranges.JOINT_ANGLE, math.radians(1000.0 / 7.0) * 8.0, ""),
        (ranges.MASS, 72_600.0, "is 72600 g meant?"),
    ],
)
def test_a_number_of_another_unit_is_recognised(known: Plausible, value: float, question: str) -> None:
    said = known.refusal(value)
    assert (said[1] if said else known.doubt(value) or "").endswith(question)
    assert question or "meant?" not in (said[1] if said else known.doubt(value) or "")


def test_zero_may_stand_for_none() -> None:
    assert ranges.THRESHOLD.doubt(0.0) is None and ranges.CUTOFF.doubt(0.0) is None
    assert ranges.LAYER.refusal(0.0)


def test_numbers_are_found_by_name_and_by_place() -> None:
    found = {name: one.shown(value) for name, one, value in numbers_in(NUMBERS, {"k": 0.22, "l": 0.169, "new": 1.0})}
    assert found == {"k": "0.22 N/m", "l": "169 mm"}
    pair = [one.shown(value) for _, one, value in numbers_in(ranges.DISPLACEMENT, (1e-3, math.radians(2.0)))]
    assert pair == ["1 mm", "2 deg"]
    assert not list(numbers_in(ranges.LAYER, "rays")) and not list(numbers_in(ranges.LAYER, None))


def test_settings_of_the_geometry_know_their_threshold() -> None:
    with pytest.raises(InputError, match=r"`thresholds`: 4000 mm cannot be a threshold of contact.*is 4 mm meant\?"):
        gc.Settings(thresholds=(4.0,))


def test_what_is_unusual_is_a_reservation_of_the_result() -> None:
    design = {"l": gc.mm(169), "z": gc.mm(127), "range": gc.deg(0, 90), "step": gc.mm(20)}
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", gc.InputWarning)
        result = gc.misalignment.design(k=4.0, limit=5.0, **design)
    line = (
        "`k`: 4 N/m is unusual for the stiffness of an attachment, which mostly is 10 to 100000 N/m; is 4 N/mm meant?"
    )
    assert line in result.record.warnings and line in [str(one.message) for one in said]
