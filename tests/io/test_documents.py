"""Descriptions that are declared: what is read, and what is refused at which place."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import pytest
from pydantic import ConfigDict, Field

from geocontact.data.errors import InputError
from geocontact.data.plausible import KG, Plausible
from geocontact.data.text import same_place
from geocontact.io.documents import (
    AnyValue,
    Beside,
    Document,
    File,
    FileName,
    Files,
    Listed,
    Names,
    Rows,
    Some,
    Text,
    Values,
    WithUnit,
    Word,
    checked,
    doubled,
    read_document,
)


class Person(Document):
    mass: Annotated[float, WithUnit(Plausible("the mass of a person", KG, (20.0, 300.0)))]
    side: Literal["right", "left"] = "right"
    share: Annotated[float, WithUnit("-"), Field(gt=0.0, lt=1.0)] | None = None


class Trial(Document):
    name: FileName
    motion: File
    more: Files = ()
    plate: Word | None = None
    start: Annotated[float, WithUnit("s", bare=True)] | None = None
    seated: bool = False


class Study(Document):
    height: Annotated[float, WithUnit("m")]
    tracks: Names | None = None
    noise: Annotated[dict[str, float], Some({"angle": Annotated[float, WithUnit("rad"), Field(gt=0.0)]})] = Field({})
    persons: dict[str, Person]
    trials: Annotated[tuple[Trial, ...], Listed("T{number}", same_place)]


TEXT = """height = { value = 180, unit = "cm", source = "measured", note = "with shoes" }
tracks = ["angle", "force"]
noise = { angle = { value = 180, unit = "deg" } }
[persons.P1]
mass = { value = 70000, unit = "g" }
share = { value = 45, unit = "%" }
[[trials]]
name = "walk_1"
motion = "a.csv"
more = ["a.csv", "b.csv"]
start = 0.5
[[trials]]
motion = "b.csv"
more = "a.csv"
plate = 1
start = { value = 250, unit = "ms" }
seated = true
"""


def study(folder: Path, old: str = "", new: str = "") -> Study:
    for name in ("a.csv", "b.csv"):
        (folder / name).touch()
    assert old in TEXT
    (folder / "study.toml").write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    return read_document(folder / "study.toml", Study)


def test_what_is_read_is_in_si(tmp_path: Path) -> None:
    found = study(tmp_path)
    assert found.height == pytest.approx(1.8, rel=1e-15) and found.tracks == ("angle", "force")
    assert found.noise == pytest.approx({"angle": 3.141592653589793}, rel=1e-15)
    person, (one, other) = found.persons["P1"], found.trials
    assert (person.mass, person.side, person.share) == (pytest.approx(70.0), "right", pytest.approx(0.45))
    a, b = tmp_path / "a.csv", tmp_path / "b.csv"
    assert (one.name, one.motion, one.more, one.plate, one.start, one.seated) == ("walk_1", a, (a, b), None, 0.5, False)
    assert (other.name, other.motion, other.more, other.plate) == ("T2", b, (a,), "1")
    assert (other.start, other.seated) == (0.25, True)


HEIGHT, MASS = 'height = { value = 300, unit = "mm" }', 'mass = { value = …, unit = "kg" }'
REFUSED = {
    # what is replaced, by what, line after the file's name
    "near": ("height", "heigt", "heigt: is not known here; perhaps height"),
    "far": ("tracks", "colour", "colour: is not known here; write height, tracks, noise, persons, trials"),
    "near table": ("[persons.P1]", "[person.P1]", "person: is not known here; perhaps persons"),
    "in a table": ("share", "shar", "[persons.P1] shar: is not known here; perhaps share"),
    "in a row": ("start = 0.5", "stat = 0.5", "[[trials]] 1 stat: is not known here; perhaps start"),
    "in some": ("angle = {", "angles = {", "[noise] angles: is not known here; perhaps angle"),
    "no quantity": (TEXT.splitlines()[0], "", f": no height; add it: {HEIGHT}"),
    "no range": ('mass = { value = 70000, unit = "g" }', "", f"[persons.P1]: no mass; add it: {MASS}"),
    "no file named": ('motion = "b.csv"', "", "[[trials]] 2: no motion; add it"),
    "bare": ('{ value = 70000, unit = "g" }', "70", f"[persons.P1] mass: is not a value with its unit; write {MASS}"),
    "more beside": ("note =", "why =", f"height: is not a value with its unit; write {HEIGHT}"),
    "no number": ("value = 180", "value = true", f"height: True is not a finite number; write {HEIGHT}"),
    "not finite": ("start = 0.5", "start = nan", "[[trials]] 1 start: nan is not a finite number; write start = {"),
    "no mass": ("value = 70000", "value = 7e5", "[persons.P1] mass: 700 kg cannot be the mass of a person: that is 20"),
    "other unit": ('"cm"', '"kg"', "height: 'kg' is not a unit of it; its SI unit is m"),
    "zero": ("{ angle = { value = 180", "{ angle = { value = 0", "[noise] angle: is not above 0; check"),
    "whole": ("value = 45", "value = 100", "[persons.P1] share: is not below 1; check"),
    "none": ("share", 'side = "top"\nshare', "[persons.P1] side: 'top' is none; write right or left"),
    "no flag": ("= true", "= 1", "[[trials]] 2 seated: 1 is neither true nor false; write seated = true"),
    "no names": ('"force"]', "3]", 'tracks: is not a list of names; write tracks = ["…", "…"]'),
    "no word": ("plate = 1", "plate = [1]", "[[trials]] 2 plate: [1] is not a text; write it in quotes"),
    "no file's name": ('"walk_1"', '"walk/1"', "[[trials]] 1 name: 'walk/1' cannot be that of a file; write"),
    "lost": ('"b.csv"]', '"c.csv"]', "[[trials]] 1 more: there is no file c.csv; give its path from"),
    "twice": ('"walk_1"', '"t2"', "trials: two have the name 'T2'; give each its own name"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_is_refused_at_its_place(tmp_path: Path, name: str) -> None:
    old, new, line = REFUSED[name]
    with pytest.raises(InputError) as error:
        study(tmp_path, old, new)
    assert str(error.value).removeprefix(str(tmp_path / "study.toml")).lstrip(" ").startswith(line)


@pytest.mark.parametrize(
    ("content", "line"),
    [
        ({"persons": {}}, "study.toml: no [persons.NAME]; write one for each, with mass, side, share"),
        ({"persons": [{}]}, "study.toml: no [persons.NAME]"),
        ({"persons": {"P1": 3}}, "study.toml [persons] P1: is not a table; write mass, side, share"),
        ({"trials": []}, "study.toml: no [[trials]]; write one for each, with name, motion, more"),
        ({"trials": {"T1": {}}}, "study.toml: no [[trials]]"),
        ({"trials": [3]}, "study.toml [[trials]] 1: is not a table; write name, motion"),
        ({"noise": 3}, "study.toml noise: is not a table; write angle"),
        ({"a" * 1000: 3}, f"study.toml {'a' * 80}: is not known here; write height"),
        ({"a\x00\n": 3}, "study.toml a: is not known here; write height"),
    ],
)
def test_tables_that_are_none(content: dict[str, object], line: str) -> None:
    whole = {"height": {"value": 1, "unit": "m"}, "persons": {"P1": {"mass": {"value": 70, "unit": "kg"}}}}
    with pytest.raises(InputError) as error:
        checked(Path("study.toml"), Study, {**whole, "trials": [{"motion": __file__}], **content})
    assert str(error.value).startswith(line) and len(str(error.value)) < 300


def test_the_first_name_that_stands_twice() -> None:
    assert doubled(["a", "b", "A", "b", "a"]) == "a" and doubled(["a", "A"]) is None


class Spread(Document):
    mean: float
    sd: Annotated[float, Field(gt=0.0)]


class Site(Document):
    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Beside]
    inputs: Annotated[Text, Field(examples=['"a.csv"'])]


class Loose(Document):
    """Keys of other names, tables that must be there, and values of any kind."""

    sources: Annotated[dict[str, Site], Field(alias="from")]
    spread: Spread
    vary: Annotated[dict[str, Values], Field()] = Field({})
    leave_out: Annotated[tuple[dict[str, AnyValue], ...], Rows] = ()


WHOLE: dict[str, object] = {
    "from": {"t01": {"inputs": "a.csv", "thigh": "results/thigh"}},
    "spread": {"mean": 1, "sd": 2.5},
    "vary": {"side": ["left", 2, True]},
    "leave_out": [{"side": "left", "trial": 3}],
}


def test_further_keys_are_read_as_their_type() -> None:
    found = checked(Path("home/study.toml"), Loose, WHOLE)
    site = found.sources["t01"]
    assert site.inputs == "a.csv" and site.__pydantic_extra__ == {"thigh": Path("home/results/thigh")}
    assert found.vary == {"side": ("left", 2, True)} and found.leave_out == ({"side": "left", "trial": 3},)
    assert found.vary["side"][2] is True and isinstance(found.spread.mean, float)


@pytest.mark.parametrize(
    ("content", "line"),
    [
        ({"from": {}}, "no [from.NAME]; write one for each, with inputs"),
        ({"from": {"t01": {"thigh": "b"}}}, '[from.t01]: no inputs; add it: inputs = "a.csv"'),
        ({"from": {"t01": {"inputs": " "}}}, "[from.t01] inputs: is empty; write a text in quotes"),
        ({"from": {"t01": {"inputs": "a", "thigh": 3}}}, "[from.t01] thigh: 3 is not a path; write it in quotes"),
        ({"spread": None}, "no [spread]; add it, with mean, sd"),
        ({"spread": {"mean": True, "sd": 1}}, "[spread] mean: True is not a finite number; write mean = 1.5"),
        ({"spread": {"mean": 0, "sd": 0}}, "[spread] sd: is not above 0"),
        ({"vary": []}, "vary: is not a table"),
        ({"vary": {"side": []}}, '[vary] side: is not a list of values; write side = ["one", "other"]'),
        ({"vary": {"side": [["a"]]}}, "[vary] side: is not a list of values"),
        ({"vary": {"side": [1, "1"]}}, "[vary] side: has a value twice"),
        ({"leave_out": [{}]}, "leave_out: is not a list of tables; write it in double brackets"),
        ({"leave_out": [{"a": 1}, {"a": [1]}]}, "[[leave_out]] 2 a: [1] is not a value"),
        ({"leave_out": [{"a": float("nan")}]}, "[[leave_out]] 1 a: nan is not a value"),
        ({"form": {}}, "form: is not known here; write from, spread, vary, leave_out"),
    ],
)
def test_what_further_keys_cannot_be(content: dict[str, object], line: str) -> None:
    with pytest.raises(InputError) as error:
        checked(Path("study.toml"), Loose, {**WHOLE, **content})
    assert str(error.value).removeprefix("study.toml").lstrip(": ").startswith(line)


def test_tables_of_some_keys_are_in_the_declared_order(tmp_path: Path) -> None:
    """Neither in that of the file nor in one that differs between processes."""
    names = [f"k{number}" for number in range(12)]
    kind = Annotated[dict[str, float], Some({name: Annotated[float, Field(gt=0.0)] for name in names})]
    assert list(checked(tmp_path, kind, dict.fromkeys(reversed(names[2:]), 1.0))) == names[2:]
