"""Load cells from Python: synthetic recordings with known answers, units, weights, cycles and styles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.loadcells.result import LoadcellResult, load_cells
from geocontact.data.errors import InputError, InputWarning
from tests.analyses.loadcells.synthetic_walk import HEAD, LBF, PERIOD, gait, recorded, sides


def forces(*files: Path, **options: object) -> pd.DataFrame:
    """The table of one recording."""
    return load_cells(files, **options).table("forces")


def test_forces_are_the_weighted_cells(tmp_path: Path) -> None:
    result = load_cells(recorded(tmp_path), unit="N")
    table = result.table()
    assert list(table.columns) == ["time [s]", "medial [N]", "lateral [N]", "total [N]"]
    for side, values in sides(gait(table["time [s]"].to_numpy())).items():
        np.testing.assert_allclose(table[f"{side} [N]"], values, rtol=1e-12, err_msg=side)
        np.testing.assert_array_equal(result.recordings[0].forces.curves[side], table[f"{side} [N]"])
    ((name, force),) = result.force.items()
    assert name == result.recordings[0].file.stem and result.peak[name]["total"] == table["total [N]"].max()
    np.testing.assert_array_equal(force["medial"], table["medial [N]"])
    assert list(result.tables()) == ["forces"] and result.warnings == ()


def test_says_what_was_found(tmp_path: Path) -> None:
    result = load_cells(recorded(tmp_path), unit="N", cycles="stride")
    peaks = {side: float(values.max()) for side, values in sides(gait(np.arange(0.0, 5.0, 0.01))).items()}
    told = ", ".join(f"{side} {peak:.1f} N" for side, peak in peaks.items())
    assert str(result) == f"largest forces: {told} (total at 0.53 s)\n4 cycles of walk"
    summary = result.record.results["recording"]
    assert summary["peak_total_N"] == pytest.approx(peaks["total"], rel=1e-6) and summary["frames"] == 500
    assert result.record.results["cycles"] == {"walk": 4}


def test_pounds_by_option_and_by_header_are_newtons(tmp_path: Path) -> None:
    plain = forces(recorded(tmp_path), unit="N")
    head = "Time(sec), PM [lbf], AM [lbf], AL [lbf], PL [lbf]"
    for file, unit in ((recorded(tmp_path, "a.csv", LBF), "lbf"), (recorded(tmp_path, "b.csv", LBF, head), None)):
        pounds = load_cells(file, unit=unit)
        pd.testing.assert_frame_equal(pounds.table(), plain, rtol=1e-9)
        assert pounds.record.inputs[0]["unit"] == "lbf"


def test_recorders_that_end_rows_with_a_comma(tmp_path: Path) -> None:
    plain = forces(recorded(tmp_path), unit="N")
    pd.testing.assert_frame_equal(forces(recorded(tmp_path, "c.csv", end=","), unit="N"), plain, check_exact=True)


def test_other_names_and_signs(tmp_path: Path) -> None:
    plain = forces(recorded(tmp_path), unit="N")
    named = recorded(tmp_path, "d.csv", head="time,F1,F2,F3,F4")
    mapped = forces(named, unit="N", map="PM=F1,AM=F2,AL=F3,PL=F4")
    pd.testing.assert_frame_equal(mapped, plain, check_exact=True)
    turned = recorded(tmp_path, "e.csv", -1.0)
    back = forces(turned, unit="N", map="PM=-PM,AM=-AM,AL=-AL,PL=-PL")
    pd.testing.assert_frame_equal(back, plain, check_exact=True)
    with pytest.warns(InputWarning) as said:
        load_cells(turned, unit="N")
    first, second, third = (str(each.message) for each in said)
    assert "the knee pulls on its tray for 100% of the time" in first  # a result that contradicts says so first
    assert "cells are in tension" in second and "`map` PM=-PM" in second
    assert "if the file is in lbf pass `unit` lbf" in third


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("tray.toml", 'name = "tray"\ncells = ["AL", "PM", "AM", "PL"]\nmedial = [0.1, 0.9, 0.8, 0.0]\n'),
        ("tray.csv", "cell, medial [-], lateral [-]\nAL,0.1,0.9\nPM,0.9,0.1\nAM,0.8,0.2\nPL,0,1\n"),
    ],
)
def test_weights_of_another_tray(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8")
    result = load_cells(recorded(tmp_path), unit="N", matrix=tmp_path / name)
    table = result.table()
    pm, am, al, pl = gait(table["time [s]"].to_numpy()).T
    np.testing.assert_allclose(table["medial [N]"], 0.1 * al + 0.9 * pm + 0.8 * am, rtol=1e-9)
    np.testing.assert_allclose(table["lateral [N]"], 0.9 * al + 0.1 * pm + 0.2 * am + pl, rtol=1e-9)
    assert result.warnings == () and result.regression.name == "tray"
    assert result.recordings[0].by_cell(result.regression)["AL"] == pytest.approx(al, rel=1e-12)


def test_weights_that_lose_force_are_said(tmp_path: Path) -> None:
    matrix = tmp_path / "two.toml"
    matrix.write_text('cells = ["PM", "AM"]\nmedial = [1.0, 0.5]\nlateral = [0.0, 0.4]\n', encoding="utf-8")
    with pytest.warns(InputWarning, match="weights of a cell do not sum to 1: AM 0.9") as said:
        result = load_cells(recorded(tmp_path), unit="N", matrix=matrix)
    assert [str(each.message) for each in said] == list(result.warnings)


def test_strides_of_the_synthetic_walk(tmp_path: Path) -> None:
    result = load_cells(recorded(tmp_path), unit="N", cycles="stride")
    cycles, ensemble = result.table("cycles"), result.table("ensemble")
    np.testing.assert_allclose(cycles["end [s]"] - cycles["start [s]"], PERIOD, atol=2e-3)
    assert len(ensemble) == 101 and set(ensemble["cycles [-]"]) == {len(cycles)} == {4}
    at = cycles["start [s]"][0] + PERIOD * ensemble["cycle [%]"].to_numpy() / 100.0
    for side, values in sides(gait(at)).items():
        np.testing.assert_allclose(ensemble[f"{side}_mean [N]"], values, atol=8.0, err_msg=side)
    assert (ensemble["total_sd [N]"] < 8.0).all()


def test_stance_and_the_first_part_of_a_stride(tmp_path: Path) -> None:
    """Load is above a quarter of its peak for less than the 60 % in which it is there at all."""
    walk = recorded(tmp_path)
    stance = load_cells(walk, unit="N", cycles="stance").table("cycles")
    assert len(stance) == 4 and (stance["end [s]"] - stance["start [s]"]).between(0.35 * PERIOD, 0.6 * PERIOD).all()
    part = load_cells(walk, unit="N", cycles="0.2:1.3,1.3:2.4", part=0.6)
    np.testing.assert_allclose(part.table("cycles")[["start [s]", "end [s]"]], [[0.2, 0.86], [1.3, 1.96]], rtol=1e-12)
    at = 0.2 + 0.6 * PERIOD * np.arange(101) / 100.0
    means = part.table("ensemble")["total_mean [N]"]
    np.testing.assert_allclose(means[1:-1], gait(at).sum(axis=1)[1:-1], atol=1.0)
    level = load_cells(walk, unit="N", cycles="stance", level=900.0).table("cycles")
    assert ((level["end [s]"] - level["start [s]"]) < (stance["end [s]"] - stance["start [s]"]).min()).all()


def styles(folder: Path) -> LoadcellResult:
    """Three cycles of a walk and of one that is 20 % higher."""
    files = (recorded(folder, "normal.csv"), recorded(folder, "bouncy.csv", height=1.2))
    rows = [f"{s},{s},{a},{a + PERIOD}" for s in ("normal", "bouncy") for a in (0.2, 1.3, 2.4)]
    table = folder / "cycles.csv"
    table.write_text("\n".join(["style, recording, start [s], end [s]", *rows]) + "\n", encoding="utf-8")
    return load_cells(files, unit="N", cycles=table)


def test_root_mean_square_between_synthetic_styles(tmp_path: Path) -> None:
    """The second style is the first one 20 % higher, so the difference is 20 % of the root mean square of the first."""
    result = styles(tmp_path)
    assert list(result.tables()) == ["normal/forces", "bouncy/forces", "cycles", "ensemble", "styles", "shifts"]
    table = result.table("styles")
    assert table[["style", "reference"]].to_numpy().tolist() == [["bouncy", "normal"]]
    shifts = result.table("shifts").set_index("side")
    np.testing.assert_allclose(shifts["later [%]"], 0.0, atol=1e-6)
    for side, values in sides(gait(0.2 + PERIOD * np.arange(101) / 100.0)).items():
        assert table[f"rmse_{side} [N]"][0] == pytest.approx(0.2 * np.sqrt(np.mean(values**2)), rel=2e-3)
        assert shifts["peak_to_peak_difference [N]"][side] == pytest.approx(0.2 * np.ptp(values), rel=0.01)
    ratio = result.table("bouncy/forces")["total [N]"] / result.table("normal/forces")["total [N]"]
    np.testing.assert_allclose(ratio, 1.2, rtol=1e-12)


def test_page_of_several_recordings_has_all_their_tables(tmp_path: Path) -> None:
    page = styles(tmp_path).page(tmp_path / "page.html").read_text(encoding="utf-8")
    for words in (
        "Load cells of 2 recordings",
        "bouncy/forces",
        "rmse_total [N]",
        "3 cycles of normal, 3 cycles of bouncy",
    ):
        assert words in page


def test_one_cycle_has_no_spread_and_it_is_said(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="there is no spread to show"):
        result = load_cells(recorded(tmp_path), unit="N", cycles="0.2:1.3")
    assert result.table("ensemble")["total_sd [N]"].isna().all()


def test_more_styles_than_a_figure_tells_apart_are_said_and_kept(tmp_path: Path) -> None:
    rows = [f"style {k},walk,{0.2 + 0.1 * i},{1.3 + 0.1 * i}" for k in range(7) for i in (k, k + 1)]
    table = tmp_path / "cycles.csv"
    table.write_text("\n".join(["style, recording, start [s], end [s]", *rows]) + "\n", encoding="utf-8")
    with pytest.warns(InputWarning, match="7 styles are more than a figure can show"):
        result = load_cells(recorded(tmp_path), unit="N", cycles=table)
    assert result.table("ensemble")["style"].nunique() == 7
    titles = [panel.title for panel in next(iter(result.curves().values())).panels]
    assert titles == ["Contact force", "Total force, each cycle and the mean", "Load cells"], "in place of the mean"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"part": 0.6}, "`part`: has no effect without `cycles` or `events`; say what a cycle is"),
        ({"cycles": "stride", "part": 1.5}, "`part`: 150 % cannot be a share"),
        ({"cycles": "stride", "part": 0.0}, "`part`: 0 % cannot be a share"),
        ({"cycles": "1:2", "level": 400.0}, "`level`: has no effect here: the cycles are given"),
        ({"cycles": "stance", "level": float("nan")}, "`level`: nan is not a finite number"),
    ],
)
def test_refused_before_a_file_is_read(options: dict[str, object], words: str) -> None:
    with pytest.raises(InputError) as refused:
        load_cells("none.csv", **options)
    assert words in str(refused.value)


def test_no_recording_is_refused() -> None:
    with pytest.raises(InputError, match="`recordings`: names no file"):
        load_cells(())


def test_total_without_a_unit_names_the_option_as_python_has_it(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="`unit`: is missing: the file names no unit"):
        load_cells(recorded(tmp_path, head=HEAD))


def with_gap(folder: Path, start: float, end: float) -> Path:
    """The recording without the samples in between."""
    head, *rows = recorded(folder).read_text(encoding="utf-8").splitlines()
    kept = [row for row in rows if not start < float(row.split(",")[0]) < end]
    (folder / "gap.csv").write_text("\n".join([head, *kept]) + "\n", encoding="utf-8")
    return folder / "gap.csv"


def test_samples_missing_inside_a_load_are_not_interpolated_over(tmp_path: Path) -> None:
    """0.3 s around the peak of the second load: its cycle is left out, and the others are what they were."""
    whole = load_cells(recorded(tmp_path), unit="N", cycles="stance").table("cycles")
    with pytest.warns(InputWarning) as said:
        result = load_cells(with_gap(tmp_path, 1.495, 1.805), unit="N", cycles="stance")
    lines = [str(each.message) for each in said]
    assert any("gap.csv: no samples from 1.49 to 1.81 s: the forces there are unknown" in line for line in lines)
    assert "1 of 4 cycles contain gaps of a recording and are left out" in lines
    left = result.table("cycles").drop(columns=["style", "recording"])
    want = whole.drop(index=1).drop(columns=["style", "recording"]).reset_index(drop=True)
    pd.testing.assert_frame_equal(left, want)
    line = result.figures()["loadcells"].axes[0].lines[0]
    assert np.isnan(line.get_ydata()).sum() == 1, "the figure draws no line across"


def test_a_few_samples_missing_are_bridged(tmp_path: Path) -> None:
    assert load_cells(with_gap(tmp_path, 1.495, 1.525), unit="N", cycles="stance").warnings == ()
    with pytest.raises(InputError, match="all contain gaps of the recordings"):
        load_cells(with_gap(tmp_path, 1.495, 1.805), unit="N", cycles="1.2:2.2")


def test_a_cell_without_a_column_says_how_to_name_it(tmp_path: Path) -> None:
    file = tmp_path / "cells.csv"
    file.write_text("time, AM [N], AL [N], PL2 [N]\n0, 1, 2, 3\n0.01, 2, 3, 4\n", encoding="utf-8")
    with pytest.raises(InputError) as refused:
        load_cells(file)
    what = "no column 'PM' for the cell PM; columns are: AM, AL, PL2"
    assert str(refused.value) == f"{file}: {what}; name it, `map` PM=…,PL=…"
