"""Options: one declaration for Python, the command line and the documentation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, Literal

import pytest

import geocontact as gc
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.marks import (
    Excludes,
    Length,
    Lengths,
    Millimetres,
    Needs,
    Requires,
    Spelled,
    TimeSpan,
    Typed,
)
from geocontact.analyses.frame.options import Declared, Options, declared
from geocontact.cli.command import option, speller
from geocontact.data.errors import InputError
from tests.analyses.jobs import JOBS

EVERY = [pytest.param(job, one, id=f"{job.command}-{one.name}") for job in JOBS for one in declared(job.options)]


@dataclass(frozen=True)
class Example(Options):
    """An example.

    Parameters
    ----------
    files
        What is read.
    depth
        How deep [m],
        on two lines.
    levels
        Of `depth`.
    kind, other
        Which.
    course
        A file, or coefficients.
    span
        From when to when.
    """

    files: tuple[Path, ...]
    _: KW_ONLY
    depth: Length | None = None
    levels: Annotated[Lengths, Spelled(default="4,5mm")] = (4e-3, 5e-3)
    radius: Annotated[Millimetres | None, Spelled("radius-mm", "radius_mm"), Requires("depth")] = None
    kind: Literal["a", "b"] = "a"
    other: Annotated[str | None, Excludes("radius"), Needs("depth", "give 4mm")] = None
    span: TimeSpan | None = None
    course: Annotated[Path | Mapping[str, tuple[float, ...]] | None, Typed("m", "misalignment.planar:drift", "")] = None

    def refuse_impossible(self) -> None:
        if self.depth is not None and not self.depth > 0.0:
            raise InputError("", "`depth`", f"{self.depth:g} m is none", "give more")


def of(name: str) -> Declared:
    return next(one for one in declared(Example) if one.name == name)


def test_a_declaration_holds_type_unit_words_and_default() -> None:
    depth, levels, radius = of("depth"), of("levels"), of("radius")
    assert (depth.kind, depth.optional, depth.typed and depth.typed.si) == (float, True, "m")
    assert depth.words == "How deep [m], on two lines."
    assert (levels.several, levels.default, levels.spelled.default) == (True, (4e-3, 5e-3), "4,5mm")
    assert (option(radius), radius.spelled.key, radius.required) == ("radius-mm", "radius_mm", False)
    assert of("files").required and of("files").positional and not depth.positional
    assert of("kind").words == of("other").words == "Which."


def test_values_are_coerced() -> None:
    assert Example("a.csv", depth=1.0).files == (Path("a.csv"),)
    assert Example(["a.csv", Path("b.csv")]).files == (Path("a.csv"), Path("b.csv"))
    assert Example("a.csv", levels=gc.mm(3)).levels == (3e-3,)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"kind": "c"}, "`kind`: 'c' is not a choice; one of a, b"),
        ({"radius": 1.0}, "`radius`: has no effect without `depth`; give `depth`"),
        ({"depth": 1.0, "radius": 1.0, "other": "x"}, "`other`: has no effect with `radius`; leave it out"),
        ({"other": ("x", "y")}, '`other`: is 2 values where one text is asked for; write "x,y"'),
        ({"other": "x"}, "`depth`: is missing with `other`; give 4mm"),
        ({"depth": 0.0}, "`depth`: 0 m is none; give more"),
        (
            {"span": "0-0.2"},
            "`span`: '0-0.2' is not a span; write for example 0.4:1.6",
        ),  # read as typed
        ({"span": (0.1, 0.2, 0.3)}, "`span`: (0.1, 0.2, 0.3) is not 2 numbers; give 2 numbers: (0.4, 1.6)"),
        ({"span": 0.2}, "`span`: 0.2 is not 2 numbers; give 2 numbers: (0.4, 1.6)"),
        ({"span": (0.1, "x")}, "`span`: (0.1, 'x') is not 2 numbers; give 2 numbers: (0.4, 1.6)"),
    ],
)
def test_what_has_no_effect_is_refused(given: dict, said: str) -> None:
    with pytest.raises(InputError) as refused:
        Example("a.csv", **given)
    assert str(refused.value) == said


def test_an_option_may_be_one_of_several_types_and_read_by_any_module() -> None:
    course = of("course")
    assert course.optional and Example("a.csv", course="b.csv").course == Path("b.csv")
    assert Example("a.csv", course={"x": (0.0, 1e-3)}).course == {"x": (0.0, 1e-3)}
    assert course.read("x=0:1,y=2") == {"x": (0.0, 1e-3), "y": (2e-3,)} and course.read("c.csv") == Path("c.csv")


def test_messages_are_spelled_as_the_user_wrote_them() -> None:
    spelled = speller(declared(Example))
    assert spelled("`radius`: has no effect without `depth` in `FILE`") == (
        "--radius-mm: has no effect without --depth in `FILE`"
    )
    assert spelled("`files` and `out`") == "FILES and --out"


def test_what_is_typed_becomes_si() -> None:
    assert of("depth").read("0.4 cm") == pytest.approx(4e-3, rel=1e-15)
    assert of("levels").read("4,5mm") == of("levels").default
    assert of("radius").read(37.0) == gc.mm(37)
    with pytest.raises(InputError, match="`depth`: 'deep' is not a finite number"):
        of("depth").read("deep")


def test_units_are_in_the_names_of_what_is_recorded() -> None:
    told = Example("a.csv", depth=gc.mm(4)).in_si()
    assert told == {"files": (Path("a.csv"),), "depth [m]": 4e-3, "levels [m]": (4e-3, 5e-3), "kind": "a"}


@pytest.mark.parametrize(("job", "one"), EVERY)
def test_every_option_is_documented(job: Job, one: Declared) -> None:
    assert one.words, f"{job.command}: {one.name} has no words"
    assert "--" not in one.words, "Python's spelling, which the command line turns into its own"


def test_headings_of_the_docstring_are_sections() -> None:
    sections = {one.name: one.section for one in declared(gc.area.options)}
    assert sections["unit"] == "" and sections["osim"] == "Motion" and sections["poisson"].startswith("Pressure")
    assert {one.section for one in declared(gc.pressure.options) if one.name == "poisson"} == {sections["poisson"]}


@pytest.mark.parametrize(("job", "one"), EVERY)
def test_every_default_that_is_typed_is_the_default(job: Job, one: Declared) -> None:
    """And every default is finite, so that no NaN stands for a missing value."""
    if one.spelled.default is not None:
        assert one.read(one.spelled.default) == one.default, job.command
    if isinstance(one.default, float):
        assert math.isfinite(one.default)


@pytest.mark.parametrize(("job", "one"), EVERY)
def test_rules_name_options_that_there_are(job: Job, one: Declared) -> None:
    names = {other.name for other in declared(job.options)}
    spoken = {rule.other for rule in one.rules} | {r.alternative for r in one.rules if isinstance(r, Requires)} - {""}
    assert spoken <= names - {one.name}


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.command)
def test_no_two_options_are_spelled_alike(job: Job) -> None:
    known = [one for one in declared(job.options) if not one.positional]
    spelled = [option(one) for one in known]
    assert len(set(spelled)) == len(spelled) and "out" not in spelled
