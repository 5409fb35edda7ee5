"""A name that stands twice where one value is meant: refused, and neither the first nor the last is taken."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from geocontact.analyses.catalogue import ENTRIES
from geocontact.analyses.frame.options import declared
from geocontact.analyses.motion.marker_tasks import weights_typed
from geocontact.data.errors import InputError
from geocontact.io.recordings.device_numbers import read_device_numbers
from geocontact.io.recordings.spheres import read_contact_intervals, read_contact_parameters, read_spheres
from geocontact.io.recordings.tool_folder import _session, _subject
from geocontact.io.text.csv_text import dict_rows
from geocontact.io.text.file_preflight import read_json
from geocontact.io.text.results import read_frame
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import read_table


def of_options() -> list[Any]:
    """Options that take numbers by name, of all analyses."""
    by_name = ("named_numbers", "numbers", "springs")
    return [
        pytest.param(one, id=f"{entry.command} {one.name}")
        for entry in ENTRIES
        for one in declared(entry.load_options())
        if one.typed is not None and one.typed.read.rpartition(":")[2] in by_name
    ]


@pytest.mark.parametrize("one", of_options())
def test_a_number_of_an_option(one: Any) -> None:
    typed = ("k=1", "k=2") if one.spelled.each else "k=1,k=2"
    with pytest.raises(InputError, match=rf"`{one.name}`: k is given twice; give each once"):
        one.read(typed)
    once = one.read(("k=1",) if one.spelled.each else "k=1")
    assert list(once) == ["k"]


def test_options_with_numbers_by_name_are_found() -> None:
    assert {"gap init number", "gap inject value", "sit-to-stand predict perturb", "elbow fit known"} <= {
        each.id for each in of_options()
    }


def test_a_weight() -> None:
    with pytest.raises(InputError, match="heel is given twice"):
        weights_typed(("heel=3", "toe=1", "heel=3"), {"heel", "toe"}, "heel=10")
    assert weights_typed(("heel=3", "toe=1"), {"heel", "toe"}, "heel=10") == {"heel": 3.0, "toe": 1.0}


@pytest.mark.parametrize("text", ['{"a": 1, "b": 2, "a": 1}', '[{"c": {"b": 0, "a": 1, "a": 2}}]'])
def test_a_key_of_json(tmp_path: Path, text: str) -> None:
    """At any depth, whatever its values are."""
    file = tmp_path / "run.json"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r'run.json: the key "a" is there twice; keep one of them'):
        read_json(file)
    file.write_text('[{"a": 1}, {"a": {"a": 2}}]', encoding="utf-8")
    assert read_json(file) == [{"a": 1}, {"a": {"a": 2}}]


def test_a_key_of_a_subject(tmp_path: Path) -> None:
    file = tmp_path / "subject.json"
    file.write_text('{"massKg": 70, "massKg": 80}', encoding="utf-8")
    with pytest.raises(InputError, match='"massKg" is there twice'):
        _subject(file)
    session = tmp_path / "sessionMetadata.yaml"
    session.write_text("mass_kg: 70\nheight_m: 1.8\nmass_kg: 80\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"mass_kg: is there twice"):
        _session(session)


TWICE: dict[str, tuple[Callable[[Path], Any], str]] = {
    "side table": (read_side_table, "px [m],px [mm]\n0,1\n"),
    "spheres": (read_spheres, "px [m],py [m],radius [m],radius [mm]\n0,0,0.01,10\n"),
    "table over time": (lambda file: read_table(file).column("px"), "time [s],px [m],px [mm]\n0,1,2\n1,1,2\n"),
    "results": (lambda file: read_frame(file, (), "give another"), "# of a run\npx, a, px\n1,2,3\n"),
    "device": (lambda file: read_device_numbers(file, ()), "number,value,note,px,value,px\nheight,1.8,,,1.7,\n"),
    "parameters": (
        lambda file: read_contact_parameters(file, {"k": "N"}, {"k": (0.0, 9.0)}),
        "parameter,unit,value,px,px\nk,N,1,2,3\n",
    ),
    "intervals": (lambda file: read_contact_intervals(file, ["k"]), "parameter,lower,upper,px,px\nk,1,2,1,3\n"),
}


@pytest.mark.parametrize("what", TWICE)
def test_a_column(tmp_path: Path, what: str) -> None:
    read, text = TWICE[what]
    file = tmp_path / "table.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"table.csv.*column '(px|radius|value)' occurs 2 times"):
        read(file)


def test_a_column_that_nobody_asks_for_may_stand_twice(tmp_path: Path) -> None:
    """Recorders write such columns; those that are read are there once."""
    file = tmp_path / "table.csv"
    file.write_text("time [s],px [m],note [-],note [-]\n0,1,2,3\n1,1,2,3\n", encoding="utf-8")
    assert list(read_table(file).column("px")) == [1.0, 1.0]


@pytest.mark.parametrize("text", [f"{'x' * 200_000}\n1\n", f'number,value\n1,"{"x," * 100_000}\n'])
def test_a_cell_that_does_not_end_is_one_line(tmp_path: Path, text: str) -> None:
    """Names are split to be counted: what `csv` refuses there is said of the file."""
    file = tmp_path / "numbers.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"numbers\.csv"):
        read_frame(file, ("number",), "give another one")
    with pytest.raises(InputError, match=r"numbers\.csv line \d: field larger than"):
        dict_rows(file, 1_000_000, "a table of numbers")


def test_a_remark_behind_the_names_is_none_of_them(tmp_path: Path) -> None:
    file = tmp_path / "numbers.csv"
    file.write_text("number,value# a remark,number\n1,2\n", encoding="utf-8")
    assert list(read_frame(file, (), "give another one")) == ["number", "value"]
