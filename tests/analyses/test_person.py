"""What a person states of the body is confronted with the table."""

from __future__ import annotations

import warnings
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import get_args, get_type_hints

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.options import Options
from geocontact.analyses.person import SHANK, person_segments
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.walk.options import ProsthesisWalkOptions
from geocontact.analyses.sit_to_stand.coordinates.result import BY_LEGS
from geocontact.below_knee_prosthesis.leg import taper
from geocontact.data.body_segments import BodySegments
from geocontact.data.plausible import TALL, Plausible
from geocontact.io.documents import checked
from geocontact.io.recordings.gait_study import GaitPerson
from geocontact.io.recordings.overhead_study import StudyPerson
from geocontact.io.recordings.standing_study import StandingStudy
from geocontact.trial_checks.recorded import TrialInputs
from geocontact.trial_checks.table import contradictions

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
        (None, 73.0, 1.75, {"thigh": {"centre": 0.48}}, "thigh: its centre is 1.1 times its length"),
        (None, 73.0, None, {"upper_arm": {"length": 0.711}}, "own lengths of segments, 4.39"),
        (None, 73.0, None, {"upper_arm": {"length": 0.028}}, "own lengths of segments, 0.173"),
        (None, 73.0, 1.75, {"upper_arm": {"length": 0.2, "centre": 0.17}}, "its centre is at 0.85 of its length, 0.58"),
        (None, 73.0, 1.75, {"shank": {"gyration": 0.4}}, "shank: its gyration is 0.92 times its length"),
    ],
)
def test_odd_values_are_doubted(
    age: float | None, mass: float, height: float | None, own: dict[str, dict[str, float]], line: str
) -> None:
    assert line in said("male", age, mass, height, own)[1][-1]


def test_a_child_without_an_age_is_doubted() -> None:
    assert "21 kg without an age have segments of an adult" in said("male", None, 21.0, None, {})[1][0]
    assert "40 kg and 1.16 m without an age" in said("male", None, 40.0, 1.16, {})[1][0]


CHILD: dict[str, object] = {"mass": {"value": 19, "unit": "kg"}, "age": {"value": 6, "unit": "years"}}
CHILDREN: dict[str, tuple[type[StudyPerson | GaitPerson], dict[str, object]]] = {
    "overhead": (StudyPerson, CHILD | {"sex": "male", "dominant": "right"}),
    "gait": (GaitPerson, CHILD | {"static": "study.toml"}),
}


@pytest.mark.parametrize("kind", CHILDREN)
def test_children_of_six_are_described(kind: str, tmp_path: Path) -> None:
    of, content = CHILDREN[kind]
    (tmp_path / "study.toml").touch()
    assert checked(tmp_path / "study.toml", of, content).mass == 19.0
    with pytest.raises(gc.InputError, match="9 kg cannot be the mass of a person"):
        checked(tmp_path / "study.toml", of, content | {"mass": {"value": 9, "unit": "kg"}})


def test_children_of_six_stand_up(tmp_path: Path) -> None:
    (tmp_path / "c.sto").touch()
    (tmp_path / "r.sto").touch()
    trial = {"name": "T1", "coordinates": "c.sto", "rates": "r.sto"}
    content = {"mass": CHILD["mass"], "height": {"value": 1.16, "unit": "m"}, "trials": [trial]}
    content["person"] = {"age": CHILD["age"]}
    assert checked(tmp_path / "study.toml", StandingStudy, content).mass == 19.0


@pytest.mark.parametrize("of", [ProsthesisScaleOptions, ProsthesisWalkOptions, ProsthesisSimulateOptions])
def test_options_leave_a_small_mass_to_the_age(of: type[Options]) -> None:
    """A usual range that knows no age warned of each child; with an age `doubt_age` does."""
    hints = get_type_hints(of, include_extras=True)
    for name, value in (("mass", 19.0), ("height", 1.16)):
        for known in (each for each in get_args(hints.get(name)) if isinstance(each, Plausible)):
            assert known.refusal(value) is None and known.doubt(value) is None, (name, known)


@pytest.mark.parametrize(("mass", "height"), [(18.0, 1.16), (20.5, 1.21)])
def test_slim_children_are_not_doubted_as_adults_are(mass: float, height: float) -> None:
    child = TrialInputs(mass=mass, height=height, age=6.0)
    assert not contradictions(child) and mass / height**2 < 14.1
    assert [check.name for check, _ in contradictions(replace(child, mass=15.5, height=1.21))] == ["mass and height"]
    assert not contradictions(TrialInputs(mass=12.5 * (0.2 / 0.186) ** 2, upper_arm=0.2, age=6.0))


def test_an_adult_of_a_childs_build_is_doubted() -> None:
    for age in (None, 18.0):
        assert contradictions(TrialInputs(mass=18.0, height=1.16, age=age))


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


@pytest.mark.parametrize("centre", [0.10, 0.40])
def test_a_shank_that_no_frustum_is_is_refused(centre: float) -> None:
    """The frustum of a residual limb has its centre between 1/4 and 3/4: `taper` had no root."""
    own = {"shank": {"length": 0.43, "centre": centre}}
    with pytest.raises(gc.InputError, match=rf"the shank's centre is at {centre / 0.43:.2f} of its length, not 0.26"):
        person_segments("male", None, 73.0, 1.75, own, AT)


def test_any_shank_that_is_not_refused_has_a_taper() -> None:
    for share in SHANK:
        ratio = taper(share)
        x = np.linspace(0.0, 1.0, 200_001)
        area = (1.0 + (ratio - 1.0) * x) ** 2
        assert np.trapezoid(x * area, x) / np.trapezoid(area, x) == pytest.approx(share, abs=1e-6)


def test_two_lengths_of_one_upper_arm_are_refused() -> None:
    content: dict[str, object] = {"mass": {"value": 73, "unit": "kg"}, "sex": "male", "dominant": "right"}
    content["upper_arm"] = {"value": 0.3, "unit": "m"}
    for length, refused in ((0.2, True), (0.28, False)):
        content["segments"] = {"upper_arm": {"length": {"value": length, "unit": "m"}}}
        with pytest.raises(gc.InputError, match=r"upper_arm is 0.3 m") if refused else nullcontext():
            checked(Path("study.toml"), StudyPerson, content)


def test_a_man_of_two_metres_is_not_doubted() -> None:
    assert TALL.doubt(2.0) is None and TALL.doubt(2.1) is not None and BY_LEGS.doubt(2.04) is not None
