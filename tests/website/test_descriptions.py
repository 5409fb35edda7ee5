"""The table of keys says everything that the classes declare."""

from __future__ import annotations

import tomllib
from typing import Annotated

import pytest
from pydantic import Field

from geocontact.io.documents import Document, FileName, Listed, WithUnit, doubled
from tests.io.test_wrong_kinds import DESCRIPTIONS, places
from website.descriptions import FILES, DescribedFile, descriptions, rows_of


class Person(Document):
    """A person.

    Parameters
    ----------
    name
        Its name.
    mass
        Body mass.
    """

    name: FileName
    mass: Annotated[float, WithUnit("kg"), Field(gt=0.0)] | None = None


class Study(Document):
    """A study.

    Parameters
    ----------
    persons
        All of them.
    seated
        Whether they sit.
    """

    persons: Annotated[tuple[Person, ...], Listed("P{number}", doubled)]
    seated: bool = False


def test_a_key_says_what_it_holds_and_what_counts_without_it() -> None:
    rows = [(row.table, row.key, row.holds, row.default, row.meaning) for row in rows_of(Study)]
    assert rows == [
        ("", "`seated`", "true or false", "false", "Whether they sit."),
        ("`[[persons]]`", "`name`", "letters, digits, - and _", "`P{number}`", "Its name."),
        ("`[[persons]]`", "`mass`", "quantity, kg, above 0", "", "Body mass."),
    ]


def test_a_key_without_a_meaning_is_noticed() -> None:
    class Mute(Document):
        """No word of its keys."""

        width: float

    with pytest.raises(KeyError, match="width"):
        list(rows_of(Mute))


SAMPLES = (
    "study",
    "pairs",
    "gathering",
    "population",
    "overhead",
    "device",
    "foot",
    "socket",
    "gait",
    "standing",
    "exoskeleton",
)
"""Descriptions of `tests.io.test_wrong_kinds` in the order of the page."""
OTHERS = {"foot": ("foot on foam",)}
"""Further descriptions of the same file, for keys that exclude each other."""


@pytest.mark.parametrize(("what", "file"), list(zip(SAMPLES, FILES, strict=True)))
def test_every_key_that_is_declared_is_given_wrong_values_by_a_test(what: str, file: DescribedFile) -> None:
    rows = [row for kind in (file.kind, *file.entries.values()) for row in rows_of(kind)]
    declared = {row.key.strip("`") for row in rows if not row.key.endswith("any other")}
    optional = {"length", "rate", "force", "centre", "torque"}  # of [noise], all declared as `angle` is
    optional |= {"foot_plate", "thigh", "module", "turning_damping", "energy", "foot_jerk", "joint_jerk"}  # as theirs
    texts = [DESCRIPTIONS[name].text for name in (what, *OTHERS.get(what, ()))]
    given = {place[-1] for text in texts for place, _ in places(tomllib.loads(text))}
    assert len(declared) >= 3 and declared - given <= (optional if what == "standing" else set())


def test_headings_of_the_page_are_the_files() -> None:
    page = descriptions()
    assert [line.removeprefix("## ") for line in page.splitlines() if line.startswith("## ")] == [
        file.title for file in FILES
    ]
