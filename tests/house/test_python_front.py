"""What every analysis is to somebody who calls it from Python: its help, its numbers, its names, its units."""

from __future__ import annotations

import re
from inspect import signature
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import declared
from geocontact.analyses.frame.record import Record
from geocontact.analyses.frame.result import WIDEST, Result
from geocontact.io.text.units import si_unit
from tests.analyses.jobs import JOBS
from tests.analyses.main_numbers import WRITTEN, unlike
from website.api.entries import JOBS as OF_JOBS
from website.api.entries import entries

PUBLIC: dict[str, Job[Any, Any]] = {each.name: each.thing for each in entries() if each.group == OF_JOBS}
UNIT = re.compile(r"\[([^]]+)\]")
KNOWN = {"J", "nats", "m/N", "BW", "N m/kg", "N/kg", "N/m^n", "kg m", "1/Pa", "share of the foot", "mm"}
"""Units beyond those of files; `rms_mm` and `markers_mm` have theirs in their names."""


def units_of(words: str) -> list[str]:
    """What stands in brackets, code aside."""
    return ", ".join(UNIT.findall(re.sub(r"`[^`]*`", "", words))).split(", ") if UNIT.search(words) else []


def numbers_of(job: Job[Any, Any]) -> dict[str, str]:
    """Attributes that the help of a job shows with a unit, and what it says of them."""
    returns = (job.__doc__ or "").partition("\nReturns\n")[2].partition("\nExamples\n")[0]
    said = dict(re.findall(r"^    (\w+) : (.+)$", returns, re.MULTILINE))
    return {name: words for name, words in said.items() if units_of(words)}


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.command)
def test_results_have_numbers_with_their_units(job: Job[Any, Any]) -> None:
    found = numbers_of(job)
    assert found
    for words in found.values():
        for unit in units_of(words):
            assert si_unit(unit) is not None or unit in KNOWN or unit.startswith("SI unit"), words


@pytest.mark.parametrize("name", PUBLIC)
def test_numbers_of_results_are_compared_with_their_files(name: str) -> None:
    compared, shown = WRITTEN[name], numbers_of(PUBLIC[name])
    assert compared and set(compared) <= set(shown)


def test_a_number_that_is_not_what_is_written_is_seen() -> None:
    assert unlike({"a": np.array([1.0, np.nan])}, {"a": [1.0, np.nan]}) == ""
    assert unlike({"a": 1.0}, {"a": 1.001}) == "a: 1.0 is not 1.001"
    assert unlike({"a": 1.0}, {"b": 1.0}) == "['a'] are not ['b']"
    assert "is not" in unlike(np.zeros(2), np.zeros(3))


@pytest.mark.parametrize("name", PUBLIC)
def test_help_shows_the_example_that_runs(name: str) -> None:
    told = PUBLIC[name].__doc__ or ""
    assert re.search(rf"\nExamples\n--------\n>>> import geocontact as gc(.|\n)*gc\.{name}\(", told)
    assert not re.search(r"exit 1|exit code|--[a-z]{2}|\btyped\b|Also write", told.partition("\nExamples\n")[0])


@pytest.mark.parametrize("room", ["knee", "misalignment", "prosthesis", "shoulder", "sit_to_stand"])
def test_tab_lists_jobs_only(room: str) -> None:
    place = getattr(gc, room)
    names = [name for name in dir(place) if not name.startswith("_")]
    assert names == sorted(name.partition(".")[2] for name in PUBLIC if name.startswith(f"{room}."))
    assert all(isinstance(getattr(place, name), Job) for name in names)


def test_tab_lists_public_names_and_no_module_of_the_inside() -> None:
    assert {name for name in dir(gc) if not name.startswith("_")} == set(gc.__all__)
    assert {name for name in PUBLIC if "." not in name} <= set(dir(gc))


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.command)
def test_every_number_with_a_unit_has_a_range(job: Job[Any, Any]) -> None:
    names = set(signature(job).parameters)
    assert [
        one.name
        for one in declared(job.options)
        if one.name in names and one.typed is not None and one.typed.si != "-" and one.range is None
    ] == []


class Said(Result):
    """A result that says what it is made with."""

    def tables(self) -> dict[str, Any]:
        return {}


def test_a_result_is_its_first_sentence_in_one_line() -> None:
    record = Record("said", {}, {})
    record.say("area of FIXED within 4 mm: 1773.3 … 2484.0 mm^2")
    record.say("medial is +z")
    assert repr(Said(record=record)) == "<Said: area of FIXED within 4 mm: 1773.3 … 2484.0 mm^2>"
    record.warn("the bodies overlap")
    assert repr(Said(record=record)).endswith("mm^2; 1 warning>")
    assert str(Said(record=record)).splitlines()[1:] == ["medial is +z", "warning: the bodies overlap"]


@pytest.mark.parametrize(
    ("sentences", "shown"),
    [
        (["medial is -z (right side)", "area of FIXED within 4 mm: 1796.3 … 2505.0 mm^2"], 1),
        (["101 frames, 16 markers: named P1_2", "it removes 86 % of the error"], 1),
        (["k 201.8 N/m (95 % 117.8 … 262.9)", "x 52.31 mm"], 0),
        (["4 of 4 trials have results", "the bodies touch"], 0),
    ],
)
def test_a_result_shows_the_first_sentence_with_a_quantity(sentences: list[str], shown: int) -> None:
    record = Record("said", {}, {})
    for each in sentences:
        record.say(each)
    assert repr(Said(record=record)) == f"<Said: {sentences[shown]}>"


def test_tab_of_a_result_offers_what_users_need() -> None:
    offered = dir(Said(record=Record("said", {}, {})))
    assert {"table", "tables", "page", "write", "sentences", "warnings", "record"} <= set(offered)
    assert not set(offered) & {"put", "elsewhere", "refers_to", "parts", "reservations"}


@pytest.mark.parametrize("words", ["", "of 12 frames " * 40, "first\nsecond " * 30])
def test_a_result_has_no_line_longer_than_a_prompt_shows(words: str) -> None:
    record = Record("said", {}, {})
    record.say(words)
    record.warn("one")
    record.warn("two")
    line = repr(Said(record=record))
    assert len(line) <= WIDEST and "\n" not in line and line.endswith("2 warnings>") and line.startswith("<Said: ")
