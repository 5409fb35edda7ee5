"""Words for units of length: one table for every reader, in any case, in full or cut short; metres by definition."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mats.layout import length_unit as mat_length
from geocontact.io.mocap.c3d_markers import read_c3d_markers
from geocontact.io.mocap.markers import read_csv_markers, read_markers
from geocontact.io.mocap.trc import read_trc
from geocontact.io.motion.poses import motion_from_csv
from geocontact.io.recordings.spheres import read_spheres
from geocontact.io.text.csv_text import open_csv
from geocontact.io.text.units import LENGTH, length_unit, si_unit

WORDS = {
    "m": 1.0,
    "M": 1.0,
    "meter": 1.0,
    "meters": 1.0,
    "Metre": 1.0,
    "METRES": 1.0,
    "METERS": 1.0,
    "mete": 1.0,  # c3d.org's sample 15: cut to four letters
    "metr": 1.0,
    "mm": 1e-3,
    "MM": 1e-3,
    "Mm": 1e-3,
    "mm.": 1e-3,
    " mm ": 1e-3,
    "millimeter": 1e-3,
    "Millimeters": 1e-3,
    "millimetre": 1e-3,
    "MILLIMETRES": 1e-3,
    "mill": 1e-3,
    "cm": 1e-2,
    "CM": 1e-2,
    "centimeters": 1e-2,
    "centimetre": 1e-2,
    "cent": 1e-2,
    "in": 0.0254,
    "IN": 0.0254,
    "inch": 0.0254,
    "Inches": 0.0254,
    "um": 1e-6,
    "µm": 1e-6,
    "μm": 1e-6,
    "micrometres": 1e-6,
    "micr": 1e-6,
}
NONE = ("", " ", "ft", "feet", "met", "mil", "metersx", "metric", "min", "N", "mmHg", "mm^2", "mN", "mega", "unknown")
TRC = (
    "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\n"
    "100\t100\t2\t1\t{}\t100\nFrame#\tTime\tA\t\t\n\t\tX1\tY1\tZ1\n1\t0.00\t1\t2\t4\n2\t0.01\t1\t2\t4\n"
)


def c3d(folder: Path, unit: str | None) -> Path:
    """One marker at 1 2 4 in two frames; None leaves UNITS out."""
    ezc3d = pytest.importorskip("ezc3d")
    content = ezc3d.c3d()
    point = content["parameters"]["POINT"]
    point["LABELS"]["value"], point["RATE"]["value"] = ["A"], [100.0]
    if unit is None:
        point["UNITS"]["value"] = []
    else:
        point["UNITS"]["value"] = [unit]
    content["data"]["points"] = np.tile(np.array([1.0, 2.0, 4.0, 1.0])[:, None, None], (1, 1, 2))
    file = folder / "a.c3d"
    content.write(str(file))
    return file


@pytest.mark.parametrize("word", WORDS)
def test_a_word_is_one_unit_for_every_reader(word: str, tmp_path: Path) -> None:
    unit = length_unit(word)
    assert unit is not None and LENGTH[unit] == WORDS[word]
    assert mat_length(word) == WORDS[word]
    assert si_unit(word) == ("m", WORDS[word])
    expected = WORDS[word] * np.array([1.0, 2.0, 4.0])
    trc = tmp_path / "a.trc"
    trc.write_text(TRC.format(word), encoding="utf-8")
    np.testing.assert_allclose(read_trc(trc).positions[1, 0], expected, rtol=1e-15)
    markers = tmp_path / "a.csv"
    head = ",".join(f"A_{axis} [{word}]" for axis in "xyz")
    markers.write_text(f"time [s],{head}\n0,1,2,4\n1,1,2,4\n", encoding="utf-8")
    np.testing.assert_allclose(read_csv_markers(markers).positions[0, 0], expected, rtol=1e-15)


@pytest.mark.parametrize("word", ["meters", "METERS", "mete", "M", "MM", "Millimeters", "mill", "cm", "Inches"])
def test_markers_of_a_c3d_file_in_words(word: str, tmp_path: Path) -> None:
    seen = read_c3d_markers(c3d(tmp_path, word))
    np.testing.assert_allclose(seen.positions[1, 0], WORDS[word] * np.array([1.0, 2.0, 4.0]), rtol=1e-6)


@pytest.mark.parametrize("unit", ["", "  ", None])
def test_a_c3d_file_without_a_unit_is_refused_unless_it_is_stated(unit: str | None, tmp_path: Path) -> None:
    """It was taken as mm."""
    file = c3d(tmp_path, unit)
    with pytest.raises(InputError, match=r"POINT:UNITS: is empty: .* is unknown; state it with `c3d_unit` m, cm, mm"):
        read_c3d_markers(file)
    for stated in ("mm", "m", "in"):
        seen = read_markers(file, stated)
        np.testing.assert_allclose(seen.positions[1, 0], LENGTH[stated] * np.array([1.0, 2.0, 4.0]), rtol=1e-6)


def test_a_stated_unit_does_not_count_where_the_file_has_its_own(tmp_path: Path) -> None:
    file = c3d(tmp_path, "cm")
    with pytest.warns(InputWarning, match="POINT:UNITS is 'cm' and is used; `c3d_unit` mm is for files"):
        seen = read_markers(file, "mm")
    np.testing.assert_allclose(seen.positions[1, 0], [0.01, 0.02, 0.04], rtol=1e-6)
    np.testing.assert_allclose(read_markers(file, "cm").positions[1, 0], [0.01, 0.02, 0.04], rtol=1e-6)


def test_a_c3d_file_in_feet_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="POINT:UNITS: is 'feet'; expected one of m, cm, mm, in, um"):
        read_c3d_markers(c3d(tmp_path, "feet"))


@pytest.mark.parametrize("word", NONE)
def test_what_is_no_length_is_none(word: str) -> None:
    assert length_unit(word) is None
    assert mat_length(word) is None


def test_an_empty_unit_of_a_trc_file_is_refused_as_such(tmp_path: Path) -> None:
    file = tmp_path / "a.trc"
    file.write_text(TRC.format(""), encoding="utf-8")
    with pytest.raises(InputError, match="line 3: unit is ''; expected one of m, cm, mm"):
        read_trc(file)


def test_columns_of_places_without_a_unit_are_refused(tmp_path: Path) -> None:
    """Of markers, of spheres, of poses."""
    file = tmp_path / "a.csv"
    file.write_text("time [s],A_x,A_y,A_z\n0,1,2,4\n1,1,2,4\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"column 'A_x': unit is ''; write one of m, cm, mm, in, um in square"):
        read_csv_markers(file)
    file.write_text("px,py,pz,radius,zone\n0.1,0.2,0.3,0.02,heel\n", encoding="utf-8")
    with pytest.raises(InputError, match="write"):
        read_spheres(file)
    file.write_text("time [s],tx,ty,tz,qw,qx,qy,qz\n0,1,2,3,1,0,0,0\n1,1,2,3,1,0,0,0\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"'tx' has no unit; write e\.g\. `tx \[mm\]`"):
        motion_from_csv(file, None, None)


def test_words_in_a_table_of_spheres_and_in_a_csv_header(tmp_path: Path) -> None:
    file = tmp_path / "spheres.csv"
    file.write_text("px [Meters],py [M],pz [MM],radius [centimeters],zone\n0.1,0.2,300,3,heel\n", encoding="utf-8")
    spheres = read_spheres(file)
    np.testing.assert_allclose(spheres.centre, [[0.1, 0.2, 0.3]])
    np.testing.assert_allclose(spheres.radius, [0.03])
    with open_csv(file, 10_000) as (_, columns, _):
        assert [(column.si, column.factor) for column in columns[:4]] == [
            ("m", 1.0),
            ("m", 1.0),
            ("m", 1e-3),
            ("m", 1e-2),
        ]
