"""Warnings of one kind are one line on the terminal and the page; `run.json` and the page's folded table keep all."""

from __future__ import annotations

import re

import numpy as np
import pytest

from geocontact.analyses.frame.pages import finished
from geocontact.analyses.frame.record import Listener, Record
from geocontact.analyses.frame.warning_kinds import merged
from geocontact.view.page.content import Page, Table


class Heard(Listener):
    def __init__(self) -> None:
        self.lines: list[str] = []

    def warn(self, line: str) -> None:
        self.lines.append(line)


def stops(count: int) -> list[str]:
    return [f"P{k}_low: passive_1 is at a stop for {40 + k} % of the time" for k in range(count)]


ONE = "P0_low, P1_low and 46 others: passive_1 is at a stop for 40 … 87 % of the time (48 times)"


SIZES = [
    "f.stl: bounding box 48 x 60.2 x 42.9 cm is 899 mm across, unusual for an implant or a bone; check `unit`",
    "i.stl: bounding box 74 x 12 x 48.1 cm is 1061 mm across, unusual for an implant or a bone; check `unit`",
]


@pytest.mark.parametrize(
    ("lines", "shown"),
    [
        (stops(48), ONE),
        (["walk: it is open", "run: it is open"], "walk, run: it is open (2 times)"),
        (["off by -3.5 mm^2.", "off by −1e2 mm^2.", "off by 4 mm^2."], "off by −1e2 … 4 mm^2 (3 times)."),
        (["8% of hip_r", "10% of hip_r"], "8 … 10% of hip_r (2 times)"),
        (["a: 3 of 8", "b: 4 of 9", "a: 3 of 8"], "a: 3 of 8 (2 times)|b: 4 of 9"),  # two numbers belong together
        (["a: 3 of 8", "b: 4 of 8"], "a, b: 3 … 4 of 8 (2 times)"),
        (SIZES, "|".join(SIZES)),
        (["a.stl has 3 holes", "a.stl has 3 edges"], "a.stl has 3 holes|a.stl has 3 edges"),
        (["3 mm^2 of it", "4 cm^2 of it"], "3 mm^2 of it|4 cm^2 of it"),
        (["left: a", "the right hip: a"], "left: a|the right hip: a"),
    ],
)
def test_lines_that_differ_in_names_and_numbers_are_one(lines: list[str], shown: str) -> None:
    assert "|".join(merged(lines)) == shown


def test_a_stage_shows_each_kind_once_and_keeps_all() -> None:
    heard = Heard()
    record = Record("area", {}, listener=heard)
    with record.stage():
        for line in stops(48):
            record.warn(line)
        assert heard.lines == []
    assert heard.lines == [ONE] and record.warnings == stops(48)
    record.warn("at once")
    assert heard.lines[-1] == "at once"


def test_a_stage_that_fails_shows_its_warnings() -> None:
    heard = Heard()
    record = Record("area", {}, listener=heard)

    def fail() -> None:
        with record.stage(), record.stage():
            record.warn("the surface is open")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    assert heard.lines == ["the surface is open"]


def test_a_page_shows_one_line_and_all_of_them_folded() -> None:
    page = finished(Page("a", "", np.zeros(1), ""), Record("area", {}), "", ["it is open", *stops(3)])
    assert list(page.reservations) == [
        "it is open",
        ONE.replace("40 … 87", "40 … 42")
        .replace("48 times", "3 times")
        .replace("P0_low, P1_low and 46 others", "P0_low, P1_low, P2_low"),
    ]
    table = next(each for each in page.sections if isinstance(each, Table) and each.title == "All warnings")
    assert table.folded and [row[0] for row in table.rows] == ["it is open", *stops(3)]
    alone = finished(Page("a", "", np.zeros(1), ""), Record("area", {}), "", ["it is open"])
    assert not any(re.match("All warnings", getattr(each, "title", "")) for each in alone.sections)
