"""What a person states of the body is confronted with the table."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest

import geocontact as gc
from geocontact.analyses.person import person_segments
from geocontact.data.body_segments import BodySegments
from geocontact.io.documents import checked
from geocontact.io.recordings.overhead_study import StudyPerson

AT = "study.toml", "[persons.P1]"


def said(*given: object) -> tuple[BodySegments, list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = person_segments(*given, at=AT)  # type: ignore[arg-type]
    return found, [str(each.message) for each in caught]


def test_usual_people_are_not_doubted() -> None:
    own = {"upper_arm": {"mass": 2.1, "length": 0.3, "centre": 0.17, "gyration": 0.08}, "foot": {"mass": 0.9}}
    assert said("male", None, 73.0, 1.75, own)[1] == []
    assert said("female", 40.0, 55.0, 1.6, {})[1] == []
    for age, mass in ((6.0, 21.0), (9.0, 29.0), (12.0, 41.0), (15.0, 56.0), (17.0, 65.0)):
        found, (line,) = said("male", age, mass, None, {})
        assert found.age == age and line.startswith("study.toml [persons.P1] age: masses of segments of boys")


@pytest.mark.parametrize(
    ("age", "mass", "height", "own", "line"),
    [
        (72.0, 21.0, 1.15, {}, "21 kg at 72 years: is the age in years, not in months?"),
        (9.0, 150.0, None, {}, "150 kg at 9 years: is the age in years and the mass in kg?"),
        (None, 73.0, 1.75, {"thigh": {"mass": 20.7}}, "thigh: its mass is 2 times that of a person of 73 kg"),
        (None, 73.0, 1.75, {"hand": {"length": 0.86}}, "hand: its length is 9.9 times"),
        (None, 73.0, 1.75, {"shank": {"centre": 0.48}}, "shank: its centre is 1.1 times its length"),
        (None, 73.0, 1.75, {"shank": {"gyration": 0.4}}, "shank: its gyration is 0.92 times its length"),
    ],
)
def test_odd_values_are_doubted(
    age: float | None, mass: float, height: float | None, own: dict[str, dict[str, float]], line: str
) -> None:
    assert line in said("male", age, mass, height, own)[1][-1]


@pytest.mark.parametrize(
    ("own", "line"),
    [
        ({"thigh": {"mass": 20.0}, "shank": {"mass": 10.0}}, "the trunk -"),
        (
            {"trunk": {"mass": 20.0}},
            "all segments have 61.3 kg, the trunk 20, of 73 kg; masses of limbs are of one side",
        ),
    ],
)
def test_masses_that_make_no_body_are_refused(own: dict[str, dict[str, float]], line: str) -> None:
    with pytest.raises(gc.InputError, match=r"study.toml \[persons.P1\]") as error:
        person_segments("male", None, 73.0, 1.75, own, AT)
    assert line in str(error.value)


def test_a_centre_needs_a_length() -> None:
    with pytest.raises(gc.InputError, match="needs its length, or the height of the body; write length or height"):
        person_segments("male", None, 73.0, None, {"foot": {"centre": 0.1}}, AT)


@pytest.mark.parametrize(
    ("key", "value", "line"),
    [
        ("age", {"value": 108, "unit": "months"}, "'months' is not a unit of it"),
        ("age", 9, "age: is not a value with its unit"),
        ("age", {"value": 4, "unit": "years"}, "4 years cannot be the age of a person"),
        ("segments", {"upper_arms": {"mass": {"value": 2, "unit": "kg"}}}, "a body has no upper_arms; it has head"),
        ("segments", {"hand": {"centre": {"value": 48, "unit": "%"}}}, "centre: '%' is not a unit of it"),
        ("segments", {"hand": {"centre": {"value": 48, "unit": "m"}}}, "48 m cannot be a length of a segment"),
        ("segments", {"hand": {"mass": {"value": 0, "unit": "kg"}}}, "mass: is not above 0"),
    ],
)
def test_what_a_description_cannot_say(key: str, value: object, line: str) -> None:
    content = {"mass": {"value": 73, "unit": "kg"}, "sex": "male", "dominant": "right", key: value}
    with pytest.raises(gc.InputError) as error:
        checked(Path("study.toml"), StudyPerson, content)
    assert line in str(error.value)
