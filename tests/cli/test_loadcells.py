"""`geocontact loadcells`: synthetic recordings with known answers, cycles and styles, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import pytest

from geocontact.analyses.loadcells.result import load_cells
from geocontact.data.errors import InputWarning
from tests.analyses.loadcells.synthetic_walk import CELLS, HEAD, LBF, PERIOD, recorded
from tests.cli.calls import MESHES, Call, call, done, inventory, written
from tests.drawing import unwritten

FILES = {"forces.csv", "loadcells.png", "loadcells.svg", "report.html", "run.json"}
CYCLES = {"cycles.csv", "ensemble.csv", "ensemble.png", "ensemble.svg"}


def loadcells(
    folder: Path, *options: object, files: tuple[Path, ...] = (), unit: str | None = "N", picture: bool = False
) -> Call:
    """The command, most of whose time are figures and pages, which only some tests look at."""
    if not picture:
        with unpictured():
            return loadcells(folder, *options, files=files, unit=unit, picture=True)
    given = files or (recorded(folder),)
    units = () if unit is None else ("--unit", unit)
    return call("loadcells", *given, "--out", folder / "out", *units, *options, folder=folder / "out")


@contextmanager
def unpictured() -> Iterator[None]:
    """Neither figures nor pages are made."""
    room = "geocontact.analyses.loadcells.result"
    with ExitStack() as stack:
        stack.enter_context(mock.patch(f"{room}.LoadcellResult.figures", return_value={}))
        stack.enter_context(unwritten())
        yield


def test_writes_what_python_writes(tmp_path: Path) -> None:
    """Files by name, tables byte for byte, options as typed and in SI."""
    typed = ("--cycles", "stride", "--part", "60%", "--map", "PM=PM,PL=-PL", "--parquet")
    walk = recorded(tmp_path)
    result = done(loadcells(tmp_path, *typed, files=(walk,), picture=True))
    tables = {f"{name}.{ending}" for name in ("forces", "cycles", "ensemble") for ending in ("csv", "parquet")}
    assert set(inventory(result.folder)) == FILES | CYCLES | tables
    with pytest.warns(InputWarning, match="in tension"):
        python = load_cells(walk, unit="N", cycles="stride", part=0.6, map="PM=PM,PL=-PL")
    python.write(tmp_path / "python", parquet=True)
    for name in tables:
        assert (tmp_path / "python" / name).read_bytes() == result.bytes(name), name
    record = result.record()
    assert record["options"] == {
        "recordings": [str(walk)],
        "unit": "N",
        "map": "PM=PM,PL=-PL",
        "cycles": "stride",
        "part": "60%",
        "parquet": True,
        "out": str(result.folder),
    }
    assert record["options_si"]["part"] == 0.6 and record["results"]["regression"]["cells"] == list(CELLS)
    assert result.out.splitlines()[:-1] == list(python.sentences)
    assert result.warnings == [line.replace("`map`", "--map") for line in python.warnings] != []


def test_several_recordings_have_a_folder_each(tmp_path: Path) -> None:
    files = (recorded(tmp_path, "normal.csv"), recorded(tmp_path, "bouncy.csv", height=1.2))
    rows = [f"{s},{s},{a},{a + PERIOD}" for s in ("normal", "bouncy") for a in (0.2, 1.3, 2.4)]
    text = "\n".join(["style, recording, start [s], end [s]", *rows]) + "\n"
    table = written(tmp_path / "cycles.csv", text)
    result = done(loadcells(tmp_path, "--cycles", table, files=files, picture=True))
    both = {f"{name}/{file}" for name in ("normal", "bouncy") for file in FILES}
    assert set(inventory(result.folder)) == {"normal", "bouncy", "styles.csv", "run.json", "shifts.csv", *CYCLES, *both}
    assert b"Difference to the first style" in result.bytes("bouncy/report.html")
    assert set(json.loads(result.bytes("bouncy/run.json"))["files"]) == FILES
    roles = {entry["role"]: entry["file"] for entry in result.record()["inputs"]}
    assert roles == {"recording": str(files[1]), "--cycles": str(table)}


def test_page_tells_the_peaks_and_the_weights(tmp_path: Path) -> None:
    result = done(loadcells(tmp_path, "--cycles", "stance", picture=True))
    page = result.bytes("report.html").decode()
    peak = result.table("forces.csv")["medial [N]"].max()
    assert f"{peak:.0f} N at" in page.replace("\u00a0", " ") and "0.9683" in page and "not a clinical device" in page
    assert len(page) < 5_000_000 and "http://" not in page.replace("http://www.w3.org", "")


def test_a_second_run_leaves_nothing_of_the_first(tmp_path: Path) -> None:
    done(loadcells(tmp_path, "--cycles", "stance", "--parquet", picture=True))
    again = done(loadcells(tmp_path, picture=True))
    assert set(inventory(again.folder)) == FILES


def test_same_call_gives_the_same_bytes(tmp_path: Path) -> None:
    names = (FILES | CYCLES) - {"run.json"}
    runs = []
    for _ in range(2):
        result = done(loadcells(tmp_path, "--cycles", "stance", picture=True))
        runs.append({name: result.bytes(name) for name in names})
    assert [name for name in names if runs[0][name] != runs[1][name]] == []


def test_newtons_taken_for_pounds_and_pounds_for_newtons(tmp_path: Path) -> None:
    strong = loadcells(tmp_path, files=(recorded(tmp_path, height=5.0),), unit="lbf")
    assert (strong.code, strong.folder.exists()) == (2, False)
    assert "all cells together reach" in strong.complaints[0] and "see --unit" in strong.complaints[0]
    weak = done(loadcells(tmp_path, files=(recorded(tmp_path, unit=LBF),)))
    assert any("if the file is in lbf pass --unit lbf" in line for line in weak.warnings)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--part", "60%"), "--part: has no effect without --cycles"),
        (("--level", "400"), "--level: has no effect without --cycles"),
        (("--cycles", "steps"), "'steps' is neither stride, stance, a file nor start:end"),
        (("--cycles", "1:x"), "'x' is not a finite number"),
        (("--cycles", "2:1"), "'2:1' ends before it starts"),
        (("--cycles", "4:9"), "4 to 9 s of a recording from 0 to 4.99 s"),
        (("--cycles", "1:2", "--level", "400"), "--level: has no effect here"),
        (("--cycles", "stance", "--level", "9000"), "finds no complete stance in walk.csv"),
        (("--cycles", "stance", "--level", "-1"), "-1 N cannot be the force at which load sets in"),
        (("--cycles", "stride", "--part", "150%"), "--part: 150 % cannot be a share"),
        (("--map", "PM"), "is not of the form target=column"),
        (("--map", "XX=PM"), "unknown target 'XX'"),
        (("--map", "PM=F1"), "no column 'F1' for the cell PM; columns are: PM, AM, AL, PL"),
        (("--matrix", "none.toml"), "none.toml"),
        (("--matrix", str(MESHES / "leg.osim")), "is not a file of weights"),
    ],
)
def test_options_refused(tmp_path: Path, options: tuple[str, ...], words: str) -> None:
    result = loadcells(tmp_path, *options)
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False), result.err
    assert words in result.complaints[0]


@pytest.mark.parametrize(
    ("head", "unit", "words"),
    [
        (HEAD, None, "--unit: is missing: the file names no unit"),
        (HEAD.replace("PM", "PM [N]"), "lbf", "column 'PM' is in N, not in lbf"),
        (HEAD.replace("PM", "PM [kPa]"), "N", "column 'PM' is in 'kPa'"),
        (HEAD.replace("PM", "XX"), "N", "no column 'PM'"),
        (HEAD.replace("time [s]", "time [%]"), "N", "time is in per cent"),
        (HEAD.replace("time [s]", "Time(min)"), "N", "time is in 'min'"),
        (HEAD.replace("AM", "PM"), "N", "column 'PM' occurs 2 times"),
    ],
)
def test_tables_refused(tmp_path: Path, head: str, unit: str | None, words: str) -> None:
    result = loadcells(tmp_path, files=(recorded(tmp_path, head=head),), unit=unit)
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False), result.err
    assert words in result.complaints[0]


def test_a_gap_in_a_cell_is_refused_with_its_line(tmp_path: Path) -> None:
    file = recorded(tmp_path)
    lines = file.read_text().splitlines()
    lines[7] = "0.06,nan,1,1,1"
    result = loadcells(tmp_path, files=(written(file, "\n".join(lines) + "\n"),))
    assert (result.code, result.folder.exists()) == (2, False) and "line 8: column 'PM' is nan" in result.err


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.toml", "medial = [1.0]\n", "cells: field required"),
        ("a.toml", "cells = [", "is not TOML"),
        ("a.toml", 'cells = ["PM"]\nmedial = [1.0, 2.0]\n', "1 cells, 2 medial and 2 lateral weights"),
        ("a.toml", 'cells = ["PM"]\nmedial = [1.0]\nweight = 3\n', "weight: is not known here"),
        ("a.toml", 'cells = ["PM", "PM"]\nmedial = [1.0, 1.0]\n', "a cell occurs twice"),
        ("a.csv", "cell, lateral [-]\nPM,1\n", "no column medial [-]; columns are: cell, lateral [-]"),
    ],
)
def test_files_of_weights(tmp_path: Path, name: str, text: str, words: str) -> None:
    result = loadcells(tmp_path, "--matrix", written(tmp_path / name, text))
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False), result.err
    assert words in result.complaints[0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("style, start [s]\na,1\n", "no column end [s]"),
        ("style, start [s], end [s]\na,2,1\n", "row 1: a cycle from 2 to 1 s"),
        ("style, recording, start [s], end [s]\na,run,1,2\n", "recording 'run' is not among those given: walk"),
    ],
)
def test_tables_of_cycles(tmp_path: Path, text: str, words: str) -> None:
    result = loadcells(tmp_path, "--cycles", written(tmp_path / "cycles.csv", text))
    assert (result.code, len(result.complaints), result.folder.exists()) == (2, 1, False), result.err
    assert words in result.complaints[0]


def test_recordings_of_one_name_and_times_for_several_are_refused(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    same = (recorded(tmp_path), recorded(tmp_path / "b"))
    assert "recording 'walk' cannot have a sub-folder of its own" in loadcells(tmp_path, files=same).err
    two = (recorded(tmp_path), recorded(tmp_path, "run.csv"))
    assert "it is unclear to which recording the times belong" in loadcells(tmp_path, "--cycles", "1:2", files=two).err
