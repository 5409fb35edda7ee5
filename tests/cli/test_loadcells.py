"""`geocontact loadcells`: synthetic recordings with known answers, cycles and styles, and what it refuses."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.stale_results import NAMES
from geocontact.loads.loadcells import PUBLISHED
from tests.cli.calls import Call, call, done, inventory, written

LBF = 4.4482216152605
FILES = {"forces.csv", "loadcells.png", "loadcells.svg", "report.html", "run.json"}
CYCLES = {"cycles.csv", "ensemble.csv", "ensemble.png", "ensemble.svg"}
CELLS = ("PM", "AM", "AL", "PL")
PERIOD = 1.1
HEAD = "time [s],PM,AM,AL,PL"


def gait(time: np.ndarray, height: float = 1.0, onset: float = 0.2) -> np.ndarray:
    """Synthetic cells [N], (t, 4): loads of 60 % of each stride, of different sizes and shapes."""
    phase = ((time - onset) / PERIOD) % 1.0
    wave = np.where(phase < 0.6, np.sin(np.pi * phase / 0.6), 0.0)
    early = np.where(phase < 0.6, np.sin(np.pi * phase / 0.6) ** 3, 0.0)
    return height * (20.0 + np.column_stack([500 * early, 400 * wave, 150 * wave, 200 * early]))


def recorded(
    folder: Path, name: str = "walk.csv", unit: float = 1.0, head: str = HEAD, end: str = "", **shape: float
) -> Path:
    """A file of four strides at 100 Hz; forces in N over `unit`."""
    time = np.arange(0.0, 5.0, 0.01)
    rows = np.column_stack([time, gait(time, **shape) / unit])
    return written(folder / name, "\n".join([head, *(",".join(map(repr, row)) + end for row in rows.tolist())]) + "\n")


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
    room = "geocontact.analyses.loadcells.write"
    with ExitStack() as stack:
        for name in ("loadcell_figure", "ensemble_figure", "save_both", "write_loadcell_report"):
            stack.enter_context(mock.patch(f"{room}.{name}", return_value=b""))
        yield


def sides(cells: np.ndarray) -> dict[str, np.ndarray]:
    medial, lateral = cells @ np.array(PUBLISHED.medial), cells @ np.array(PUBLISHED.lateral)
    return {"medial": medial, "lateral": lateral, "total": cells.sum(axis=1)}


def test_forces_are_the_weighted_cells(tmp_path: Path) -> None:
    result = done(loadcells(tmp_path, picture=True))
    table = result.table("forces.csv")
    assert list(table.columns) == ["time [s]", "medial [N]", "lateral [N]", "total [N]"]
    for side, values in sides(gait(table["time [s]"].to_numpy())).items():
        np.testing.assert_allclose(table[f"{side} [N]"], values, rtol=1e-9, err_msg=side)
    assert (set(inventory(result.folder)), result.warnings) == (FILES, [])
    record = result.record()
    assert record["results"]["regression"]["cells"] == list(CELLS)
    assert record["results"]["recording"]["peak_total_N"] == pytest.approx(table["total [N]"].max(), rel=1e-6)


def test_pounds_by_option_and_by_header_are_newtons(tmp_path: Path) -> None:
    plain = done(loadcells(tmp_path)).table("forces.csv")
    head = "Time(sec), PM [lbf], AM [lbf], AL [lbf], PL [lbf]"
    for file, unit in ((recorded(tmp_path, "a.csv", LBF), "lbf"), (recorded(tmp_path, "b.csv", LBF, head), None)):
        pounds = done(loadcells(tmp_path, files=(file,), unit=unit))
        pd.testing.assert_frame_equal(pounds.table("forces.csv"), plain, rtol=1e-9)
        assert pounds.record()["inputs"][0]["unit"] == "lbf"


def test_recorders_that_end_rows_with_a_comma(tmp_path: Path) -> None:
    plain = done(loadcells(tmp_path)).bytes("forces.csv")
    assert done(loadcells(tmp_path, files=(recorded(tmp_path, "c.csv", end=","),))).bytes("forces.csv") == plain


def test_other_names_and_signs(tmp_path: Path) -> None:
    plain = done(loadcells(tmp_path)).bytes("forces.csv")
    head = "time,F1,F2,F3,F4"
    mapped = done(
        loadcells(tmp_path, "--map", "PM=F1,AM=F2,AL=F3,PL=F4", files=(recorded(tmp_path, "d.csv", head=head),))
    )
    assert mapped.bytes("forces.csv") == plain
    file = recorded(tmp_path, "e.csv", -1.0)
    turned = done(loadcells(tmp_path, "--map", "PM=-PM,AM=-AM,AL=-AL,PL=-PL", files=(file,)))
    assert turned.bytes("forces.csv") == plain
    assert any("cells are in tension" in line for line in loadcells(tmp_path, files=(file,)).warnings)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("tray.toml", 'name = "tray"\ncells = ["AL", "PM", "AM", "PL"]\nmedial = [0.1, 0.9, 0.8, 0.0]\n'),
        ("tray.csv", "cell, medial [-], lateral [-]\nAL,0.1,0.9\nPM,0.9,0.1\nAM,0.8,0.2\nPL,0,1\n"),
    ],
)
def test_weights_of_another_tray(tmp_path: Path, name: str, text: str) -> None:
    result = done(loadcells(tmp_path, "--matrix", written(tmp_path / name, text)))
    table = result.table("forces.csv")
    pm, am, al, pl = gait(table["time [s]"].to_numpy()).T
    np.testing.assert_allclose(table["medial [N]"], 0.1 * al + 0.9 * pm + 0.8 * am, rtol=1e-9)
    np.testing.assert_allclose(table["lateral [N]"], 0.9 * al + 0.1 * pm + 0.2 * am + pl, rtol=1e-9)
    assert result.warnings == [] and result.record()["results"]["regression"]["name"] == "tray"


def test_weights_that_lose_force_are_said(tmp_path: Path) -> None:
    text = 'cells = ["PM", "AM"]\nmedial = [1.0, 0.5]\nlateral = [0.0, 0.4]\n'
    result = done(loadcells(tmp_path, "--matrix", written(tmp_path / "two.toml", text)))
    assert result.warnings == ["medial and lateral together do not count each cell's force once: AM 0.9"]


def test_strides_of_the_synthetic_walk(tmp_path: Path) -> None:
    result = done(loadcells(tmp_path, "--cycles", "stride", picture=True))
    assert set(inventory(result.folder)) == FILES | CYCLES <= NAMES
    cycles = result.table("cycles.csv")
    np.testing.assert_allclose(cycles["end [s]"] - cycles["start [s]"], PERIOD, atol=2e-3)
    ensemble = result.table("ensemble.csv")
    assert len(ensemble) == 101 and set(ensemble["cycles [-]"]) == {len(cycles)} == {4}
    at = cycles["start [s]"][0] + PERIOD * ensemble["cycle [%]"].to_numpy() / 100.0
    for side, values in sides(gait(at)).items():
        np.testing.assert_allclose(ensemble[f"{side}_mean [N]"], values, atol=8.0, err_msg=side)
    assert (ensemble["total_sd [N]"] < 8.0).all()


def test_stance_and_the_first_part_of_a_stride(tmp_path: Path) -> None:
    """Load is above a quarter of its peak for less than the 60 % in which it is there at all."""
    stance = done(loadcells(tmp_path, "--cycles", "stance")).table("cycles.csv")
    assert len(stance) == 4 and (stance["end [s]"] - stance["start [s]"]).between(0.35 * PERIOD, 0.6 * PERIOD).all()
    part = done(loadcells(tmp_path, "--cycles", "0.2:1.3,1.3:2.4", "--part", "60%"))
    cycles = part.table("cycles.csv")
    np.testing.assert_allclose(cycles[["start [s]", "end [s]"]], [[0.2, 0.86], [1.3, 1.96]], rtol=1e-12)
    at = 0.2 + 0.6 * PERIOD * np.arange(101) / 100.0
    means = part.table("ensemble.csv")["total_mean [N]"]
    np.testing.assert_allclose(means[1:-1], gait(at).sum(axis=1)[1:-1], atol=1.0)
    level = done(loadcells(tmp_path, "--cycles", "stance", "--level", "900")).table("cycles.csv")
    assert ((level["end [s]"] - level["start [s]"]) < (stance["end [s]"] - stance["start [s]"]).min()).all()


def test_root_mean_square_between_synthetic_styles(tmp_path: Path) -> None:
    """The second style is the first one 20 % higher, so the difference is 20 % of the root mean square of the first."""
    files = (recorded(tmp_path, "normal.csv"), recorded(tmp_path, "bouncy.csv", height=1.2))
    rows = [f"{s},{s},{a},{a + PERIOD}" for s in ("normal", "bouncy") for a in (0.2, 1.3, 2.4)]
    text = "\n".join(["style, recording, start [s], end [s]", *rows]) + "\n"
    result = done(loadcells(tmp_path, "--cycles", written(tmp_path / "cycles.csv", text), files=files, picture=True))
    table = result.table("styles.csv")
    assert table[["style", "reference"]].to_numpy().tolist() == [["bouncy", "normal"]]
    for side, values in sides(gait(0.2 + PERIOD * np.arange(101) / 100.0)).items():
        assert table[f"rmse_{side} [N]"][0] == pytest.approx(0.2 * np.sqrt(np.mean(values**2)), rel=2e-3)
    both = {f"{name}/{file}" for name in ("normal", "bouncy") for file in FILES}
    assert set(inventory(result.folder)) == {"normal", "bouncy", "styles.csv", "run.json", *CYCLES, *both}
    assert b"Difference to the first style" in result.bytes("bouncy/report.html")


def test_page_tells_the_peaks_and_the_weights(tmp_path: Path) -> None:
    result = done(loadcells(tmp_path, "--cycles", "stance", picture=True))
    page = result.bytes("report.html").decode()
    peak = result.table("forces.csv")["medial [N]"].max()
    assert f"{peak:.0f} N at" in page and "0.9683" in page and "not a clinical device" in page
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


def test_one_cycle_has_no_spread_and_it_is_said(tmp_path: Path) -> None:
    result = done(loadcells(tmp_path, "--cycles", "0.2:1.3"))
    assert any("there is no spread to show" in line for line in result.warnings)
    assert result.table("ensemble.csv")["total_sd [N]"].isna().all()


def test_newtons_taken_for_pounds_and_pounds_for_newtons(tmp_path: Path) -> None:
    strong = loadcells(tmp_path, files=(recorded(tmp_path, height=5.0),), unit="lbf")
    assert (strong.code, strong.folder.exists()) == (2, False)
    assert "all cells together reach" in strong.complaints[0] and "see --unit" in strong.complaints[0]
    weak = done(loadcells(tmp_path, files=(recorded(tmp_path, unit=LBF),)))
    assert any("if the file is in lbf pass --unit lbf" in line for line in weak.warnings)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--part", "60%"), "--part: does nothing without --cycles"),
        (("--level", "400"), "--level: does nothing without --cycles"),
        (("--cycles", "steps"), "'steps' is neither stride, stance, a file nor start:end"),
        (("--cycles", "1:x"), "'x' is not a finite number"),
        (("--cycles", "2:1"), "'2:1' ends before it starts"),
        (("--cycles", "4:9"), "4 to 9 s of a recording from 0 to 4.99 s"),
        (("--cycles", "1:2", "--level", "400"), "--level: does nothing here"),
        (("--cycles", "stance", "--level", "9000"), "finds no complete stance in walk.csv"),
        (("--cycles", "stance", "--level", "-1"), "-1 is not a force above 0 N"),
        (("--cycles", "stride", "--part", "1.5"), "1.5"),
        (("--map", "PM"), "is not of the form target=column"),
        (("--map", "XX=PM"), "unknown target 'XX'"),
        (("--map", "PM=F1"), "no column 'F1'; columns are: PM, AM, AL, PL"),
        (("--matrix", "none.toml"), "none.toml"),
        (("--matrix", "tray.xlsx"), "is not a file of weights"),
    ],
)
def test_options(tmp_path: Path, options: tuple[str, ...], words: str) -> None:
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
def test_tables(tmp_path: Path, head: str, unit: str | None, words: str) -> None:
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
    assert "times do not say which recording" in loadcells(tmp_path, "--cycles", "1:2", files=two).err
