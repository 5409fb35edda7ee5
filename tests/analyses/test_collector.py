"""What an analysis has to say arrives in its record from wherever it arises, and nowhere else."""

from __future__ import annotations

import warnings
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from pathlib import Path

import pytest

import geocontact as gc
from geocontact.analyses.frame.collector import (
    add_input,
    collecting,
    current,
    listener,
    note,
    reserve,
    results_place,
    say,
    spelled,
)
from geocontact.analyses.frame.record import Record


def test_everything_arrives_in_the_record_that_is_open(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("time [s]\n", encoding="utf-8")
    with collecting(Record("job", {}, out=tmp_path)) as record:
        reserve("twice")
        reserve("twice")
        say("one body")
        note("area", 2.0)
        add_input("mesh", file, unit="mm")
        warnings.warn("from a reader", gc.InputWarning, stacklevel=1)
        assert results_place() == tmp_path and current() is record
    assert record.warnings == ["twice", "from a reader"]
    assert record.sentences == ["one body"] and record.results == {"area": 2.0}
    assert record.inputs[0]["file"] == str(file) and record.inputs[0]["unit"] == "mm"


def test_without_one_a_warning_is_that_of_python_and_all_else_is_nothing(tmp_path: Path) -> None:
    with pytest.warns(gc.InputWarning, match="rough"):
        reserve("rough")
    say("nobody hears")
    note("key", 1)
    add_input("mesh", tmp_path / "is_not_there.stl")
    assert current().sentences == [] and current().results == {} and results_place() is None
    assert spelled("`unit`") == "`unit`"
    with listener().progress("frames", 2) as step:
        step()


def test_the_record_inside_is_closed_again() -> None:
    with collecting(Record("outer", {})) as outer:
        with collecting(Record("inner", {})) as inner:
            reserve("inside")
        reserve("outside")
    assert inner.warnings == ["inside"] and outer.warnings == ["outside"]


def test_it_is_closed_where_something_fails() -> None:
    with pytest.raises(KeyError), collecting(Record("job", {})):
        raise KeyError("x")
    with pytest.warns(gc.InputWarning, match="alone"):
        reserve("alone")


def test_each_line_of_a_pool_arrives_once() -> None:
    """Started in a copy of the context a thread collects; without it, its warning comes by way of Python's."""
    with collecting(Record("job", {})) as record, ThreadPoolExecutor(4) as pool:
        begun = [pool.submit(copy_context().run, reserve, f"line {k}") for k in range(20)]
        begun += [pool.submit(reserve, f"other {k}") for k in range(20)]
        for each in begun:
            each.result()
    expected = [f"{word} {k}" for word in ("line", "other") for k in range(20)]
    assert sorted(record.warnings) == sorted(expected)
