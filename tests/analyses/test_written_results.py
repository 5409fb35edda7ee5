"""What the frame writes of a result: tables, figures and pages by name, and what it adds to every page."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from geocontact.analyses.frame.pages import INPUTS, OPTIONS, Thinned, finished, options_table
from geocontact.analyses.frame.record import Record
from geocontact.analyses.frame.result import Part, Result
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION
from geocontact.io.text.results import CASES
from geocontact.view.page.content import Page, Picture, Table, Words
from geocontact.view.page.write import page_html

LINE = pd.DataFrame({"time [s]": [0.0, 1.0], "force [N]": [2.0, 3.0]})
AREA = "area [m^2]"


def page(title: str, *sections: Picture | Table | Words, warnings: tuple[str, ...] = ()) -> Page:
    return Page(title, "", np.zeros(1), "", reservations=warnings, sections=sections)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Walks(Result):
    """Two recordings with a folder each."""

    elsewhere = frozenset({"held"})

    @property
    def folders(self) -> tuple[str, ...]:
        return ("", "left", "right")

    def tables(self) -> dict[str, pd.DataFrame]:
        cases = pd.DataFrame({AREA: [1.0]})
        return {"left/forces": LINE, "right/forces": LINE, "cells": cases, "held": pd.DataFrame({"x [ft]": [1.0]})}

    def figures(self) -> dict[str, Figure]:
        return {name: Figure() for name in ("both", "left/forces", "right/forces")}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        return {
            f"{side}/report.html": page(f"The {side}", Picture("Forces", "", drawings[f"{side}/forces"]))
            for side in ("left", "right")
        }

    def reservations(self, folder: str) -> tuple[str, ...]:
        return (f"the {folder} one is short",)

    def units(self, table: str) -> Mapping[str, str]:
        return CASES if table == "cells" else super().units(table)

    def refers_to(self, table: str) -> Mapping[str, object] | None:
        return {"frame": "tray"} if table.endswith("forces") else None


def record(tmp_path: Path) -> Record:
    """Two files, one of them of the left recording alone."""
    found = Record("walks", {"unit": "N"})
    for name, folder in (("both.csv", None), ("left.csv", "left")):
        (tmp_path / name).write_text(name, encoding="utf-8")
        found.add_input("recording", tmp_path / name, **({} if folder is None else {"folder": folder}))
    found.say("two walks were recorded")
    return found


def test_everything_stands_where_its_name_says(tmp_path: Path) -> None:
    out = Walks(record=record(tmp_path)).write(tmp_path / "out")
    drawn = {f"{name}.{ending}" for name in ("both", "left/forces", "right/forces") for ending in ("png", "svg")}
    files = {file.relative_to(out).as_posix() for file in out.rglob("*") if file.is_file()}
    runs = {"run.json", "left/run.json", "right/run.json"}
    reports = {"left/report.html", "right/report.html"}
    assert files == {"left/forces.csv", "right/forces.csv", "cells.csv", *drawn, *reports, *runs}
    pd.testing.assert_frame_equal(pd.read_csv(out / "right/forces.csv"), LINE, check_dtype=False)
    told = json.loads((out / "run.json").read_text(encoding="utf-8"))["tables"]
    assert told == {f"{side}/forces.csv": {"frame": "tray"} for side in ("left", "right")}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Elsewhere(Walks):
    """A table whose name leads out of the folder, as one that is made of an input's text might."""

    name: str

    def tables(self) -> dict[str, pd.DataFrame]:
        return {self.name: LINE}


@pytest.mark.parametrize("name", ["../escaped", "/tmp/escaped", "a/../../escaped"])
def test_a_name_that_leads_elsewhere_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="is not a name of results"):
        Elsewhere(record=record(tmp_path), name=name).write(tmp_path / "out")
    assert not list(tmp_path.glob("**/escaped*")) and not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("part", "files"),
    [
        ("tables", {"cells.csv", "left/forces.csv", "right/forces.csv"}),
        ("figures", {f"{name}.{end}" for name in ("both", "left/forces", "right/forces") for end in ("png", "svg")}),
        ("pages", {"report.html"}),
    ],
)
def test_parts_that_a_result_leaves_out_are_not_written(tmp_path: Path, part: Part, files: set[str]) -> None:
    """The page of a result that has none of its own is one of figure and tables, whether these are files or not."""

    class Whole(Walks):
        def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
            return {}

    class Partial(Whole):
        @property
        def parts(self) -> frozenset[Part]:
            return frozenset((part,))

    def left(result: Result, folder: str) -> set[str]:
        out = tmp_path / folder
        out.mkdir()
        result.write_files(out)
        return {file.relative_to(out).as_posix() for file in out.rglob("*") if file.is_file()}

    assert left(Partial(record=record(tmp_path)), "part") == files
    assert files < left(Whole(record=record(tmp_path)), "whole")


def test_a_table_in_units_of_its_own_is_refused_where_they_are_not_said(tmp_path: Path) -> None:
    with mock.patch.object(Walks, "units", Result.units), pytest.raises(ValueError, match="cells: area"):
        Walks(record=record(tmp_path)).write(tmp_path / "out")


def test_a_page_shows_files_and_reservations_of_its_own_part(tmp_path: Path) -> None:
    out = Walks(record=record(tmp_path)).write(tmp_path / "out")
    left, right = ((out / side / "report.html").read_text(encoding="utf-8") for side in ("left", "right"))
    assert "both.csv" in left and "left.csv" in left and "both.csv" in right and "left.csv" not in right
    assert "the left one is short" in left and "the right one is short" in right
    assert "geocontact walks" in left and "SHA-256" in left


def test_the_page_of_several_parts_is_figure_and_tables(tmp_path: Path) -> None:
    told = record(tmp_path)
    told.warn("no one walked fast")
    text = Walks(record=told).page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "is short" not in text, "that is said on the page of each part"
    for words in (
        "geocontact walks",
        "Two walks were recorded.",
        "left/forces",
        "held",
        "no one walked fast",
        "left.csv",
        "both.csv",
    ):
        assert words in text


def test_a_page_alone_draws_only_what_it_shows(tmp_path: Path) -> None:
    class One(Walks):
        def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
            both = [Picture("Both", "", drawings["both"]) for _ in range(2)]
            return {"report.html": page("One", *both)}

    with mock.patch(
        "geocontact.analyses.frame.pages.save", side_effect=lambda _, path: path.write_text("<svg/>")
    ) as saved:
        One(record=record(tmp_path)).page(tmp_path / "page.html")
    assert saved.call_count == 1, "and that once"


def test_reservations_that_writing_brings_up_are_on_the_page(tmp_path: Path) -> None:
    class Further(Walks):
        def reservations(self, folder: str) -> tuple[str, ...]:
            return self.warnings

        def write_files(self, folder: Path) -> None:
            self.record.warn("no colours in this file")
            super().write_files(folder)

    out = Further(record=record(tmp_path)).write(tmp_path / "out")
    assert "no colours in this file" in (out / "left/report.html").read_text(encoding="utf-8")


def test_how_it_was_made_names_version_units_and_how_to_run_again() -> None:
    known = Record("area", {"depth": "4", "rule": "clip", "rays": 8}, {"depth [m]": [0.004], "rule": "clip", "rays": 8})
    rows = dict(options_table(known).rows)
    assert rows["geocontact"] == VERSION and rows["command"] == "geocontact area"
    assert rows["run again"] == "geocontact rerun run.json"
    assert rows["depth"] == "4 (in SI: 0.004 m)" and (rows["rule"], rows["rays"]) == ("clip", "8")
    python = Record("area", {"depth [m]": 0.004}, {"depth [m]": 0.004})
    assert dict(options_table(python).rows)["depth [m]"] == "0.004"


def test_inputs_and_options_stand_where_the_page_has_a_place_for_them(tmp_path: Path) -> None:
    """A place is exchanged one for one, so that sections which a choice exchanges keep their numbers."""
    words, own = Words("End", ["of the page"]), ("short",)
    done = finished(page("", OPTIONS, words, warnings=own), record(tmp_path), "", ("long",))
    assert [getattr(section, "title", "") for section in done.sections] == ["How it was made", "End", "Input files"]
    assert done.sections[0] is not OPTIONS and len(done.sections[2].rows) == 2
    assert done.reservations == ("long", "short")
    both = finished(page("", INPUTS, OPTIONS, words), record(tmp_path), "left", ())
    assert [len(section.rows) for section in both.sections[:1]] == [2] and both.sections[2] is words
    assert "both.csv" in page_html(both) and "left.csv" in page_html(both)
    assert len(finished(page("", INPUTS), record(tmp_path), "right", ()).sections[0].rows) == 1


def test_a_long_page_shows_fewer_frames_until_its_file_is_small(tmp_path: Path) -> None:
    shown: list[int] = []

    def of(most: int) -> Page:
        shown.append(most)
        return Page("", "", np.arange(float(most)), "", sections=(Words("", ["words"] * most),))

    class Long(Walks):
        def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Thinned]:
            return {"report.html": Thinned(of, 100, 20)}

    walks = Long(record=record(tmp_path))
    walks.page(tmp_path / "small.html")
    assert shown == [100]
    with mock.patch("geocontact.analyses.frame.pages.LARGEST_FILE", 1000):
        walks.page(tmp_path / "page.html")
    assert shown[1:] == [100, 50, 25], "below twenty it is thinned no further"
