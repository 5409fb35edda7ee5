"""Where cells come to lie by layout.toml, and what of it is refused."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mats.catalogue import read_mat
from geocontact.io.mats.layout import area_unit, length_unit, pressure_unit
from tests.io.mats.samples import GRID, GRID_LAYOUT, TEKSCAN, layout, write

# Ids of the cells of a 2 x 3 mat, as one draws them seen from the pressed side.
DRAWN = {
    "": [[1, 2, 3], [4, 5, 6]],
    'order = "column"': [[1, 3, 5], [2, 4, 6]],
    "serpentine = true": [[1, 2, 3], [6, 5, 4]],
    'order = "column"\nserpentine = true': [[1, 4, 5], [2, 3, 6]],
    'origin = "top-right"': [[3, 2, 1], [6, 5, 4]],
    'origin = "bottom-left"': [[4, 5, 6], [1, 2, 3]],
    'origin = "bottom-right"': [[6, 5, 4], [3, 2, 1]],
    "mirrored = true": [[3, 2, 1], [6, 5, 4]],
    'mirrored = "rows"': [[3, 2, 1], [6, 5, 4]],
    'mirrored = "columns"': [[4, 5, 6], [1, 2, 3]],
    'mirrored = "both"': [[6, 5, 4], [3, 2, 1]],
    'origin = "bottom-left"\nmirrored = "columns"': [[1, 2, 3], [4, 5, 6]],
    'order = "column"\nmirrored = "columns"': [[2, 4, 6], [1, 3, 5]],
    'origin = "top-right"\nmirrored = true': [[1, 2, 3], [4, 5, 6]],
    'origin = "bottom-left"\nserpentine = true': [[6, 5, 4], [1, 2, 3]],
    'order = "column"\norigin = "bottom-right"': [[6, 4, 2], [5, 3, 1]],
    "[sensors]\nmat = [[1,2],[0,0],[1,1],[0,1],[1,0],[0,2]]": [[2, 4, 6], [5, 3, 1]],
}


@pytest.mark.parametrize("said", DRAWN)
def test_cells_lie_where_the_layout_draws_them(tmp_path: Path, said: str) -> None:
    (mat,) = read_mat(write(tmp_path, GRID), layout(tmp_path, GRID_LAYOUT + said))
    np.testing.assert_allclose(mat.pressure[1], 1e4 * np.array(DRAWN[said]), rtol=1e-15)


def test_columns_are_found_by_their_ids(tmp_path: Path) -> None:
    shuffled = "time [ms];c6 [psi];c1 [psi];c5 [psi];c2 [psi];c4 [psi];c3 [psi]\n0;6,5;1,5;5,5;2,5;4,5;3,5\n"
    (mat,) = read_mat(write(tmp_path, shuffled), layout(tmp_path, GRID_LAYOUT.replace('unit = "kPa"', "")))
    np.testing.assert_allclose(mat.pressure[0], 6894.757293168361 * np.array([[1.5, 2.5, 3.5], [4.5, 5.5, 6.5]]))


def test_the_layout_says_how_cells_are_written_where_the_file_leaves_it_in_doubt(tmp_path: Path) -> None:
    """Semicolons, and commas that may be decimal or may part thousands."""
    text = write(tmp_path, "time [s];1;2;3;4;5;6\n0;1,5;2;3;4;5;6\n")
    (plain,) = read_mat(text, layout(tmp_path, GRID_LAYOUT))
    (said,) = read_mat(text, layout(tmp_path, GRID_LAYOUT + 'delimiter = ";"\ndecimal = ","'))
    np.testing.assert_array_equal(said.pressure, plain.pressure)
    assert said.pressure[0, 0, 0] == pytest.approx(1500.0)
    with pytest.raises(InputError, match="'1,5' in cell 1 is not a number with a decimal point"):
        read_mat(text, layout(tmp_path, GRID_LAYOUT + 'decimal = "."'))
    with pytest.raises(InputError):
        read_mat(text, layout(tmp_path, GRID_LAYOUT + 'delimiter = "tab"'))


def test_cells_that_are_not_in_the_file_are_absent(tmp_path: Path) -> None:
    text = "time [s]\t0\t2\t5\n0,5\t1,5\t2\t3\n1,5\t4\t5,25\t6\n"
    with pytest.warns(InputWarning, match="3 of 6 cells of 'mat' are not in the file; taken as absent"):
        (mat,) = read_mat(write(tmp_path, text), layout(tmp_path, GRID_LAYOUT + "first_id = 0"))
    np.testing.assert_array_equal(mat.time, [0.5, 1.5])
    expected = [[4e3, math.nan, 5.25e3], [math.nan, math.nan, 6e3]]
    np.testing.assert_allclose(mat.pressure[1], expected, rtol=1e-15)
    np.testing.assert_array_equal(mat.valid, ~np.isnan(expected))


def test_masked_and_dead_cells_are_not_valid_whatever_they_hold(tmp_path: Path) -> None:
    text = GRID.replace("60", "nan").replace("1.5", "-7000")
    said = "masked = [[0, 2]]\ndead = [[1, 2]]"
    (mat,) = read_mat(write(tmp_path, text), layout(tmp_path, GRID_LAYOUT + said))
    assert np.argwhere(~mat.valid).tolist() == [[0, 2], [1, 2]]
    assert np.isnan(mat.pressure[:, [0, 1], 2]).all()
    assert mat.force == pytest.approx([(0.5 + 1 + 2 + 2.5) * 0.2, (10 + 20 + 40 + 50) * 0.2], rel=1e-12)


def test_areas_of_cells_follow_their_ids(tmp_path: Path) -> None:
    said = 'cell_area_mm2 = [10, 20, 30, 40, 50, 60]\norigin = "bottom-right"'
    (mat,) = read_mat(write(tmp_path, GRID), layout(tmp_path, GRID_LAYOUT + said))
    np.testing.assert_allclose(mat.cell_area, 1e-6 * np.array([[60, 50, 40], [30, 20, 10]]), rtol=1e-12)
    assert mat.force[1] == pytest.approx(1e4 * 1e-6 * 10 * sum(k * k for k in range(1, 7)), rel=1e-12)


def test_cells_of_a_given_area_are_square_without_a_pitch(tmp_path: Path) -> None:
    (mat,) = read_mat(
        write(tmp_path, GRID), layout(tmp_path, GRID_LAYOUT.replace("pitch_mm = [10, 20]", "cell_area_mm2 = 200"))
    )
    assert mat.pitch == pytest.approx((math.sqrt(200) * 1e-3,) * 2, rel=1e-12)
    np.testing.assert_allclose(mat.cell_area, 2e-4, rtol=1e-12)


def test_frames_without_time_follow_the_rate(tmp_path: Path) -> None:
    text = "1,2,3,4,5,6\n1,2,3,4,5,6\n1,2,3,4,5,6\n"
    (mat,) = read_mat(write(tmp_path, text), layout(tmp_path, GRID_LAYOUT + "rate_Hz = 50"))
    np.testing.assert_allclose(mat.time, [0.0, 0.02], rtol=1e-15)


def test_cells_clip_at_the_level_in_another_unit(tmp_path: Path) -> None:
    """30 psi and 206.842718795 kPa are one level; conversion rounds them apart."""
    text = GRID.replace("60", "30").replace("50", "29.9")
    said = GRID_LAYOUT.replace("kPa", "psi") + "saturation_kPa = 206.84271879505083"
    (mat,) = read_mat(write(tmp_path, text), layout(tmp_path, said))
    assert mat.saturated[1].tolist() == [[False, False, True], [True, False, True]]


def test_factors_of_units_are_exact() -> None:
    pound_force, inch = 0.45359237 * 9.80665, 0.0254
    known = {
        "KPa": 1e3,
        "MPA": 1e6,
        "Pa": 1.0,
        "bar": 1e5,
        "mbar": 1e2,
        "hPa": 1e2,
        "PSI": pound_force / inch**2,
        "mmHg": 13595.1 * 9.80665e-3,
        "N/cm2": 1e4,
        "N/cm²": 1e4,
        "kg/cm2": 98066.5,
        "g/cm^2": 98.0665,
    }
    assert {unit: pressure_unit(unit) for unit in known} == pytest.approx(known, rel=1e-15)
    lengths = {"mm": 1e-3, "millimeters": 1e-3, "cm": 1e-2, "Centimetres": 1e-2, "inches": inch, "in": inch, "m": 1.0}
    assert {unit: length_unit(unit) for unit in lengths} == pytest.approx(lengths, rel=1e-15)
    areas = {"mm2": 1e-6, "cm²": 1e-4, "in²": inch**2, "in^2": inch**2, "sq. in": inch**2, "sq mm": 1e-6}
    assert {unit: area_unit(unit) for unit in areas} == pytest.approx(areas, rel=1e-15)
    assert [pressure_unit("raw"), pressure_unit("mm"), length_unit("kPa"), area_unit("mm")] == [None] * 4
    ordered = sorted(map(pressure_unit, ("Pa", "mmHg", "psi", "N/cm2", "kg/cm2", "bar", "MPa")))
    assert all(one < other for one, other in pairwise(ordered))


def test_mirrored_rows_of_tekscan_are_turned_back_when_the_layout_says_so(tmp_path: Path) -> None:
    mirrored = write(tmp_path, TEKSCAN.replace("MIRROR_ROW 0", "MIRROR_ROW 1"), "m.asf")
    (plain,) = read_mat(write(tmp_path, TEKSCAN, "seat.asf"))
    (kept,) = read_mat(mirrored, layout(tmp_path, "mirrored = false"))
    (turned,) = read_mat(mirrored, layout(tmp_path, "mirrored = true"))
    np.testing.assert_array_equal(kept.pressure, plain.pressure)
    np.testing.assert_array_equal(turned.pressure, plain.pressure[:, :, ::-1])


@pytest.mark.parametrize(
    ("named", "turned"),
    [(("ROW",), np.s_[:, :, ::-1]), (("COL",), np.s_[:, ::-1]), (("ROW", "COL"), np.s_[:, ::-1, ::-1])],
)
def test_tekscan_turns_back_what_its_file_names(tmp_path: Path, named: tuple[str, ...], turned: object) -> None:
    text = TEKSCAN
    for axis in named:
        text = text.replace(f"MIRROR_{axis} 0", f"MIRROR_{axis} 1")
    mirrored = write(tmp_path, text, "m.asf")
    (plain,) = read_mat(write(tmp_path, TEKSCAN, "seat.asf"))
    (kept,) = read_mat(mirrored, layout(tmp_path, "mirrored = false"))
    (back,) = read_mat(mirrored, layout(tmp_path, "mirrored = true"))
    (both,) = read_mat(mirrored, layout(tmp_path, 'mirrored = "both"'))
    np.testing.assert_array_equal(kept.pressure, plain.pressure)
    np.testing.assert_array_equal(back.pressure, plain.pressure[turned])
    np.testing.assert_array_equal(both.pressure, plain.pressure[:, ::-1, ::-1], "what the layout names goes first")
    assert not back.valid[0 if "COL" not in named else -1, 0]


BAD = {
    "empty": ("", "the file is empty"),
    "html": ("<!DOCTYPE html><html>", "is not a TOML file: it looks like an HTML page"),
    "syntax": ("rows: 2", "is not TOML: Expected '=' after a key"),
    "deep": ("masked = " + "[" * 5000 + "]" * 5000, "is nested too deeply"),
    "unknown key": ("row = 2", "unknown key 'row'; keys are rows, columns, pitch_mm"),
    "no such key": ('file = "x"', "file: is not a key of a layout"),
    "rows 0": ("rows = 0", "rows: is 0; input should be greater than or equal to 1"),
    "rows huge": ("rows = 100000", "rows: is 100000; input should be less than or equal to 1000"),
    "rows real": ("rows = 2.5", "rows: is 2.5; input should be a valid integer"),
    "pitch 0": ("pitch_mm = 0", "pitch_mm: is 0; expected a positive number"),
    "pitch nan": ("pitch_mm = nan", "pitch_mm: is nan; expected a positive number"),
    "pitch of three": ("pitch_mm = [1, 2, 3]", "pitch_mm: is [1, 2, 3]; expected one number, or [between rows"),
    "area true": ("cell_area_mm2 = true", "cell_area_mm2: is True; expected a positive number"),
    "area too large": ("pitch_mm = 10\ncell_area_mm2 = 200", "cell_area_mm2: a cell of 200 mm^2 does not fit"),
    "areas only": ("cell_area_mm2 = [1, 2]", "cell_area_mm2: areas differ by cell, so they give no pitch"),
    "order": ('order = "rows"', "order: is 'rows'; input should be 'row' or 'column'"),
    "origin": ('origin = "left"', "origin: is 'left'; input should be 'top-left'"),
    "mirrored": ('mirrored = "yes"', "mirrored: is 'yes'; input should be a valid boolean"),
    "unit": ('unit = "mm"', "unit: is 'mm'; expected a unit of pressure: Pa, kPa, mmHg, psi"),
    "saturation": ("saturation_kPa = -1", "saturation_kPa: is -1; expected a positive number"),
    "rate": ("rate_Hz = inf", "rate_Hz: is inf; expected a positive number"),
    "delimiter": ('delimiter = "|"', "delimiter: is '|'; input should be ',', ';' or 'tab'"),
    "masked": ("masked = [1, 2]", "masked: is [1, 2]; expected cells as [[row, column], ...]"),
    "dead negative": ("dead = [[0, -1]]", "dead: is [[0, -1]]; expected cells as [[row, column], ...]"),
    "dead twice": ("dead = [[0, 1], [0, 1]]", "dead: is [[0, 1], [0, 1]]; a cell is listed twice"),
    "outside": ("rows = 2\ncolumns = 2\ndead = [[2, 0]]", "dead: cell [2, 0] is outside the 2 x 2 grid"),
    "sensor outside": (
        "rows = 2\ncolumns = 2\nsensors.left = [[0, 2]]",
        "sensors.left: cell [0, 2] is outside the 2 x 2 grid",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_layouts_that_cannot_be_used(tmp_path: Path, case: str) -> None:
    text, expected = BAD[case]
    with pytest.raises(InputError) as caught:
        layout(tmp_path, text)
    line = str(caught.value).replace(f"{tmp_path}/layout.toml", "").strip(": ")
    assert line.startswith(expected), line
    assert "\n" not in line and len(line) < 500


def test_the_layout_in_the_documentation_is_one(tmp_path: Path) -> None:
    page = (Path(__file__).parents[3] / "docs/reference/mat_files.md").read_text(encoding="utf-8")
    example = page.split("```toml\n")[1].split("```")[0]
    said = layout(tmp_path, example)
    assert (said.rows, said.columns, said.dead, said.saturation) == (16, 8, ((5, 3),), 60e3)
    assert set(said.model_fields_set) == set(type(said).model_fields), "every key is shown"
