"""Every public name has a page; its example runs and prints what the page shows."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import chdir, contextmanager
from functools import cache
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import Result
from geocontact.gap.diagnose import diagnose
from tests.analyses.main_numbers import WRITTEN, unlike
from tests.house.first_screens import agrees
from website.api.entries import JOBS, UNITS, Entry, entries
from website.api.pages import FOLDER, api_pages
from website.examples import differences

ENTRIES = entries()
LONG = {  # more than three CPU seconds
    "cohort",
    "diagnose",
    "discriminability",
    "inject",
    "mat",
    "knee.settle",
    "misalignment.compare",
    "misalignment.design",
    "misalignment.identify",
    "pressure",
    "prosthesis.calibrate",
    "prosthesis.compare",
    "prosthesis.design",
    "prosthesis.scale",
    "prosthesis.simulate",
    "prosthesis.walk",
    "shoulder.optimise",
    "sit_to_stand.calibrate",
    "sit_to_stand.compare",
    "sit_to_stand.design",
    "sit_to_stand.predict",
}
LONGEST = {
    "prosthesis.calibrate",
    "prosthesis.compare",
    "prosthesis.design",
    "prosthesis.simulate",
    "prosthesis.walk",
    "shoulder.optimise",
    "sit_to_stand.calibrate",
    "sit_to_stand.compare",
    "sit_to_stand.design",
    "sit_to_stand.predict",
}
"""More than four CPU seconds; tests/analyses makes the same calls and looks at what they say."""
DIAGNOSES = "geocontact.analyses.gap.diagnose.result.findings_of"
OF_THE_SAME_CASE = {
    "discriminability": ("geocontact.gap.identifiability.discriminability.attribute", "attribution"),
    "inject": (DIAGNOSES, None),
}
"""Examples that begin with a diagnosis of the case that the one of `diagnose` makes: where it is called, which part of
the findings they need; what `inject` finds is not shown."""
WITHOUT_PARAMETERS = {
    "InputWarning",
    *(f"chain.{name}" for name in ("CONTACT_LAW", "ContactSites", "Geometry", "INTERFACE_LAW")),
}
SILENT = ["require_numbers"]  # says nothing where all is well
WITHOUT_FORMULA = ["cohort", "load_cells"]


Diagnosed = Callable[[], tuple[str, Any]]
"""What the example of `diagnose` prints otherwise than it shows, and its findings."""


def name(entry: Entry) -> str:
    return entry.name


def marked(entry: Entry) -> object:
    marks = [pytest.mark.slow] * (entry.name in LONG) + [pytest.mark.long] * (entry.name in LONGEST)
    return pytest.param(entry, marks=marks) if marks else entry


@pytest.mark.parametrize("entry", [marked(one) for one in ENTRIES if one.group != UNITS], ids=name)
def test_an_example_prints_what_it_shows(entry: Entry, tmp_path: Path, diagnosed: Diagnosed) -> None:
    made = results_of(entry)
    with known(entry.name, diagnosed), made as kept:
        told = diagnosed()[0] if entry.name == "diagnose" else differences(entry.name, entry.example, tmp_path, agrees)
    assert told == ""
    if kept:
        assert numbers_unlike_files(entry, kept[-1], tmp_path) == {}


@contextmanager
def results_of(entry: Entry) -> Iterator[list[Result]]:
    """Results that the example of a job makes of that job, which is called as ever."""
    call, kept = Job.__call__, list[Result]()

    def called(job: Job[Any, Any], *inputs: Any, **options: Any) -> Result:
        result = call(job, *inputs, **options)
        if job is entry.thing:
            kept.append(result)
        return result

    with mock.patch.object(Job, "__call__", called):
        yield kept


def numbers_unlike_files(entry: Entry, result: Result, folder: Path) -> dict[str, str]:
    """Attributes of a result that differ from what is written, each with both values; tables alone are written."""
    kind = type(result)
    parts = mock.patch.object(kind, "parts", property(lambda one, all_of=kind.parts: all_of.fget(one) & {"tables"}))
    with parts, chdir(folder), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        out = folder / result.write("files")
    found = {name: unlike(getattr(result, name), read(out)) for name, read in WRITTEN[entry.name].items()}
    return {name: words for name, words in found.items() if words}


@pytest.fixture(scope="module")
def diagnosed(tmp_path_factory: pytest.TempPathFactory) -> Diagnosed:
    """Made once, where it is asked for first."""

    @cache
    def made() -> tuple[str, Any]:
        (entry,) = (one for one in ENTRIES if one.name == "diagnose")
        with mock.patch(DIAGNOSES, side_effect=lambda *given: kept.append(diagnose(*given)) or kept[0]):
            told = differences(entry.name, entry.example, tmp_path_factory.mktemp("diagnose"), agrees)
        return told, kept[0]

    kept: list[Any] = []
    return made


@contextmanager
def known(name: str, diagnosed: Diagnosed) -> Iterator[None]:
    """An example of the same case is given its findings instead of making them again."""
    if name not in OF_THE_SAME_CASE:
        yield
        return
    place, part = OF_THE_SAME_CASE[name]
    findings = diagnosed()[1]
    with mock.patch(place, return_value=findings if part is None else getattr(findings, part)) as instead:
        yield
    instead.assert_called()


def test_examples_of_one_case_make_the_same_one() -> None:
    made = {one.name: one.example for one in ENTRIES if one.name in ("diagnose", *OF_THE_SAME_CASE)}
    cases = {text.partition('>>> _ = Path("case/case.toml").write_text(text)')[0] for text in made.values()}
    assert len(made) == 3 and len(cases) == 1


def test_an_example_that_prints_something_else_is_told(tmp_path: Path) -> None:
    assert "Expected" in differences("sum", ">>> 1 + 1\n3", tmp_path, agrees)


def test_every_public_name_has_an_example_with_an_output() -> None:
    assert [one.name for one in ENTRIES if not one.example] == []
    assert [one.name for one in ENTRIES if one.example.splitlines()[-1].startswith((">>>", "..."))] == SILENT


def test_the_page_of_a_job_names_where_its_formulas_are_from() -> None:
    pages = api_pages()
    jobs = [one.name for one in ENTRIES if one.group == JOBS]
    assert [one for one in jobs if "/theory/" not in pages[f"{FOLDER}/{one}.md"]] == WITHOUT_FORMULA


def test_every_public_name_has_a_page_with_its_parameters() -> None:
    pages = api_pages()
    for one in ENTRIES:
        text = pages[f"{FOLDER}/{'units' if one.group == UNITS else one.name}.md"]
        assert "## Source" in text or one.group == UNITS
        assert one.group == UNITS or re.search(r"^## Example$", text, re.MULTILINE)
        assert f"gc.{one.name}" in text
        assert "## Parameters" in text or one.name in WITHOUT_PARAMETERS or one.group == UNITS, one.name
