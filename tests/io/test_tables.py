"""Text tables over time: all header forms read, everything doubtful refused with its place."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.plausible import LARGEST_MEANT
from geocontact.io.text.columns import angles_of, lengths, parse_map, resolve
from geocontact.io.text.storage_header import unit_in_text
from geocontact.io.text.tables import TextTable, read_table

ROWS = "time\tknee\tknee_tx\n0.0\t10\t0.1\n0.5\t20\t0.2\n1.0\t30\t0.3\n"
V1 = "Coordinates\nversion=1\nnRows=3\nnColumns=3\ninDegrees={flag}\n{text}endheader\n" + ROWS
V3 = "inDegrees=no\nDataType=double\nversion=3\nOpenSimVersion=4.5\nendheader\n" + ROWS
SIMM = "name a b c.mot\ndatacolumns 3\ndatarows 3\nrange 0.0 1.0\nendheader\n" + ROWS
FORM2 = "\nUnits are S.I. units (second, meters, Newtons, ...)\n{}\n\n"
BOTH = "If the header above contains a line with 'inDegrees', this indicates whether rotational values are in degrees (yes) or radians (no)."  # noqa: E501
CSV = "time [s],knee [deg],knee_tx [mm]\n0.0,10,100\n0.5,20,200\n1.0,30,300\n"


def table(folder: Path, text: str, name: str = "gait.mot") -> TextTable:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return read_table(file)


READABLE = {
    "v1": V1.format(flag="yes", text=""),
    "v1 with blank lines and free text": V1.format(flag="yes", text=FORM2.format("Angles are in degrees.")),
    "v1 with OpenSim's standard sentence": V1.format(flag="yes", text=FORM2.format(BOTH)),
    "text only": V1.format(flag="yes", text="Angles are in degrees.\n").replace("inDegrees=yes\n", ""),
    "spaces for tabs": V1.format(flag="yes", text="").replace("\t", "   "),
    "trailing tabs": V1.format(flag="yes", text="").replace("\n", "\t\t\n"),
    "windows line ends": V1.format(flag="yes", text="").replace("\n", "\r\n"),
    "byte order mark": "\ufeff" + V1.format(flag="yes", text=""),
    "v2 without nRows": V1.format(flag="yes", text="").replace("nRows=3\n", "").replace("version=1", "version=2"),
    "blank line at the end": V1.format(flag="yes", text="") + "\n  \n",
    "spaces around =": V1.format(flag="yes", text="").replace("=", " = "),
}


@pytest.mark.parametrize("text", READABLE.values(), ids=READABLE.keys())
def test_every_header_form_gives_the_same_numbers(tmp_path: Path, text: str) -> None:
    read = table(tmp_path, text)
    assert read.channels == ("knee", "knee_tx")
    np.testing.assert_array_equal(read.time, [0.0, 0.5, 1.0])
    np.testing.assert_array_equal(angles_of(read, ["knee"])[:, 0], np.radians([10.0, 20.0, 30.0]))
    np.testing.assert_array_equal(lengths(read, ["knee_tx"])[:, 0], [0.1, 0.2, 0.3])


def test_version_3_without_counts(tmp_path: Path) -> None:
    read = table(tmp_path, V3.replace("10", ".1").replace("20", ".2").replace("30", ".3"), "a.sto")
    np.testing.assert_array_equal(angles_of(read, ["knee"])[:, 0], [0.1, 0.2, 0.3])


def test_simm_form_asks_for_the_unit_and_names_the_convention(tmp_path: Path) -> None:
    read = table(tmp_path, SIMM)
    with pytest.raises(
        InputError, match=r"gait\.mot: header does not say .* pass `angles` deg or rad \(SIMM .* degrees"
    ):
        angles_of(read, ["knee"])
    np.testing.assert_array_equal(angles_of(read, ["knee"], "deg")[:, 0], np.radians([10.0, 20.0, 30.0]))


def test_csv_takes_units_from_its_headers(tmp_path: Path) -> None:
    read = table(tmp_path, "# point_mm = 0 0 0\n#\n" + CSV, "gait.csv")
    np.testing.assert_allclose(angles_of(read, ["knee"])[:, 0], np.radians([10, 20, 30]), rtol=1e-15)
    np.testing.assert_allclose(lengths(read, ["knee_tx"])[:, 0], [0.1, 0.2, 0.3], rtol=1e-15)


@pytest.mark.parametrize(("unit", "time", "kept"), [("ms", [0.0, 0.0005, 0.001], "s"), ("%", [0.0, 0.5, 1.0], "%")])
def test_csv_time_in_other_units(tmp_path: Path, unit: str, time: list[float], kept: str) -> None:
    read = table(tmp_path, CSV.replace("[s]", f"[{unit}]"), "gait.csv")
    assert (list(read.time), read.time_unit) == (time, kept)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(arrays(np.float64, (5, 3), elements=st.floats(-LARGEST_MEANT, LARGEST_MEANT)))
def test_numbers_survive_writing_and_reading_exactly(tmp_path: Path, values: np.ndarray) -> None:
    rows = ["\t".join(repr(float(x)) for x in [i, *row]) for i, row in enumerate(values)]
    read = table(tmp_path, "x\nversion=1\nnRows=5\nnColumns=4\nendheader\ntime\ta\tb\tc\n" + "\n".join(rows), "x.sto")
    np.testing.assert_array_equal(read.values, values)


GOOD = V1.format(flag="yes", text="")
REFUSED = {
    "empty": ("", "the file is empty"),
    "blank": (" \n\n", "the file is empty"),
    "html": ("<!DOCTYPE html><html></html>", "line 1: HTML or XML, not a table"),
    "binary": ("name\0x", "binary content"),
    "no endheader": (GOOD.replace("endheader\n", ""), "no line 'endheader' found"),
    "nothing after the header": (GOOD.split("time")[0], "line 7: no column labels found"),
    "no rows": (GOOD.split("0.0\t")[0], "line 8: no rows below the column labels"),
    "count is not a number": (GOOD.replace("nRows=3", "nRows=three"), "line 3: 'nRows=three' is not a count"),
    "short row": (GOOD.replace("0.5\t20\t0.2", "0.5\t20"), "line 9: 2 cells where 3 columns are named"),
    "long row": (GOOD.replace("0.5\t20\t0.2", "0.5\t20\t0.2\t7"), "line 9: more cells where 3 columns are named"),
    "word in a cell": (GOOD.replace("20\t", "twenty\t"), "line 9: 'twenty' in column 'knee' is not a number"),
    "decimal comma": (GOOD.replace("0.2", "0,2"), "line 9: '0,2' in column 'knee_tx' is not a number"),
    "underscore in a number": (GOOD.replace("20\t", "2_0\t"), "line 9: '2_0' in column 'knee' is not a number"),
    "no time": (GOOD.replace("time", "t"), "line 7: no columns named 'time'"),
    "time twice": (GOOD.replace("knee\t", "time\t"), "line 7: 2 columns named 'time'"),
    "time is NaN": (GOOD.replace("0.5\t20", "nan\t20"), "line 9: time is nan"),
    "time stands": (GOOD.replace("0.5\t20", "0.0\t20"), "line 9: time 0 does not follow 0; time must increase"),
    "time runs back": (GOOD.replace("1.0\t30", "0.4\t30"), "line 10: time 0.4 does not follow 0.5"),
    "flag is no flag": (GOOD.replace("=yes", "=maybe"), "line 5: inDegrees=maybe is neither yes nor no"),
    "quaternions packed into cells": (V3.replace("double", "Quaternion"), "line 2: DataType=Quaternion cannot be used"),
}


COUNTS = {
    "fewer rows than declared": (GOOD.replace("1.0\t30\t0.3\n", ""), "line 3: header says 'nRows=3' but 2 rows follow"),
    "more rows than declared": (GOOD + "2\t3\t4\n", "line 3: header says 'nRows=3' but 4 rows follow"),
    "columns unlike declared": (
        GOOD.replace("nColumns=3", "nColumns=4"),
        "line 4: header says 'nColumns=4' but 3 column labels",
    ),
    "SIMM rows unlike declared": (
        SIMM.replace("datarows 3", "datarows 9"),
        "line 3: header says 'datarows 9' but 3 rows",
    ),
}


@pytest.mark.parametrize(("text", "message"), COUNTS.values(), ids=COUNTS.keys())
def test_counts_that_do_not_fit_are_warned_of(tmp_path: Path, text: str, message: str) -> None:
    """OpenSim reads on."""
    with pytest.warns(InputWarning, match=message):
        found = table(tmp_path, text)
    assert found.channels == ("knee", "knee_tx") and len(found.time) == text.split("endheader\n")[1].count("\n") - 1


@pytest.mark.parametrize("name", ["gait.mot", "gait.csv"])
def test_bytes_of_older_programs_are_latin_1(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes((GOOD if name.endswith("mot") else CSV).replace("knee", "kn\xe9").encode("latin-1"))
    with pytest.warns(InputWarning, match="is not UTF-8; the file is read as Latin-1"):
        assert read_table(tmp_path / name).channels[0].startswith("kn\xe9")


@pytest.mark.parametrize(("text", "message"), REFUSED.values(), ids=REFUSED.keys())
def test_bad_tables_are_refused_with_their_place(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        table(tmp_path, text)
    line = str(caught.value)
    assert line.startswith(str(tmp_path / "gait.mot")) and "\n" not in line
    assert message in line


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (CSV.replace(",", ";").replace("0.5;20", "0,5;20"), "line 3: '0,5' has a comma and '0.0' in line 2 a point"),
        (CSV.replace("[s]", "[h]"), "time is in 'h'"),
        (CSV.replace("20,", ","), ""),
    ],
    ids=["commas and points", "time in hours", "empty cell"],
)
def test_bad_csv(tmp_path: Path, text: str, message: str) -> None:
    if message:
        with pytest.raises(InputError, match=message.replace("(", r"\(")):
            table(tmp_path, text, "gait.csv")
    else:
        with pytest.raises(InputError, match=r"line 3: column 'knee' is nan in 1 of 3 rows"):
            angles_of(table(tmp_path, text, "gait.csv"), ["knee"])


@pytest.mark.parametrize("name", ["missing.mot", "gait.trc"])
def test_missing_files_and_other_formats(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match=r"there is no such file|is not a table of motion"):
        read_table(tmp_path / name)


def test_stale_column_count_in_version_3_is_only_warned_of(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="line 4: header says 'nColumns=9' but 3 column labels"):
        assert table(tmp_path, V3.replace("OpenSimVersion=4.5", "nColumns=9"), "a.sto").values.shape == (3, 2)


@pytest.mark.parametrize("cell", ["nan", "inf", "1.#QNAN", "-1.#IND"])
def test_gaps_matter_only_where_the_column_is_used(tmp_path: Path, cell: str) -> None:
    read = table(tmp_path, GOOD.replace("0.2", cell))
    assert len(angles_of(read, ["knee"])) == 3
    with pytest.raises(InputError, match=r"line 9: column 'knee_tx' is (nan|inf) in 1 of 3 rows"):
        lengths(read, ["knee_tx"])


def test_unknown_and_repeated_columns_are_refused_when_used(tmp_path: Path) -> None:
    read = table(tmp_path, GOOD.replace("knee_tx", "knee"))
    with pytest.raises(InputError, match="column 'knee' occurs 2 times"):
        read.needed("knee")
    with pytest.raises(InputError, match="no column 'hip'; columns are: knee, knee"):
        read.needed("hip")


@pytest.mark.parametrize(
    ("line", "unit"),
    [
        ("Angles are in degrees.", "deg"),
        ("angles in radians", "rad"),
        (BOTH, None),
        ("Angles are not in degrees.", None),
        ("Units are S.I. units (second, meters, Newtons, ...)", None),
    ],
)
def test_what_free_text_is_evidence(line: str, unit: str | None) -> None:
    assert unit_in_text(line) == unit


@pytest.mark.parametrize(
    ("flag", "text", "message"),
    [
        (
            "no",
            "Angles are in degrees.\n",
            r"line 5: header says inDegrees=no but the text says degrees \(line 6\); pass",
        ),
        (
            "yes",
            "\nAngles are in radians.\n",
            r"line 5: header says inDegrees=yes but the text says radians \(line 7\)",
        ),
        ("yes", "inDegrees=no\n", r"line 5: header says inDegrees=yes but inDegrees=no \(line 6\)"),
    ],
)
def test_contradictory_units_are_refused_until_the_user_decides(
    tmp_path: Path, flag: str, text: str, message: str
) -> None:
    read = table(tmp_path, V1.format(flag=flag, text=text))
    with pytest.raises(InputError, match=message):
        angles_of(read, ["knee"])
    line = message.partition("; pass")[0]
    with pytest.warns(InputWarning, match=rf"^\S*gait\.mot {line}.*; read as deg as asked for$"):
        np.testing.assert_array_equal(angles_of(read, ["knee"], "deg")[:, 0], np.radians([10.0, 20.0, 30.0]))


def said_when_read(read: TextTable, columns: list[str], angles: str) -> list[str]:
    """Warnings when the angles are read as the user says, after which the values are those of the file in that unit."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        values = angles_of(read, columns, angles)
    scale = {"deg": np.pi / 180.0, "rad": 1.0}[angles]
    np.testing.assert_array_equal(values, np.column_stack([read.column(name) for name in columns]) * scale)
    assert all(w.category is InputWarning for w in caught)
    return [str(w.message).replace(read.file, "gait.mot") for w in caught]


def test_degrees_declared_as_radians_are_noticed(tmp_path: Path) -> None:
    read = table(tmp_path, V1.format(flag="no", text=""))
    with pytest.raises(InputError, match=r"line 10: column 'knee' reaches 30, .*pass `angles` deg or rad"):
        angles_of(read, ["knee"])
    assert lengths(read, ["knee"])[2, 0] == 30.0  # only a rotation is judged by its size


def test_radians_declared_as_degrees_are_only_warned_of(tmp_path: Path) -> None:
    read = table(tmp_path, GOOD.replace("0.2", "0.12").replace("0.3", "0.15"))
    with pytest.warns(InputWarning, match=r"no angle exceeds 0\.15 deg; if they are radians pass `angles` rad"):
        angles_of(read, ["knee_tx"])
    angles_of(read, ["knee", "knee_tx"])  # a small angle beside a large one is normal


def test_a_whole_motion_within_two_degrees_is_warned_of(tmp_path: Path) -> None:
    """Three columns of 0.1 to 1.3, as walking has them in radians; two such columns may be degrees."""
    head = "c\nversion=1\nnRows=2\nnColumns=4\ninDegrees=yes\nendheader\ntime\thip\tknee\tankle\n"
    read = table(tmp_path, head + "0\t0.3\t0.1\t-0.2\n0.1\t-0.4\t1.3\t0.2\n")
    with pytest.warns(InputWarning, match=r"no angle exceeds 1\.3 deg; if they are radians pass `angles` rad"):
        angles_of(read, ["hip", "knee", "ankle"])
    angles_of(read, ["hip", "knee"])
    angles_of(read, ["hip", "knee", "ankle"], "deg")  # on the user's word


def test_user_overrules_the_header_with_a_warning(tmp_path: Path) -> None:
    read = table(tmp_path, GOOD)
    assert said_when_read(read, ["knee_tx"], "rad") == ["gait.mot: says deg, read as rad as asked for"]
    assert said_when_read(read, ["knee", "knee_tx"], "deg") == []
    with pytest.raises(InputError, match="`angles`: 'turns' is not a unit"):
        angles_of(read, ["knee"], "turns")


def test_user_overrules_one_of_the_headers_of_a_csv(tmp_path: Path) -> None:
    read = table(tmp_path, CSV.replace("knee_tx [mm]", "turn [rad]").replace("300", "3"), "gait.csv")
    (line,) = said_when_read(read, ["knee", "turn"], "deg")
    assert line.endswith("says rad, read as deg as asked for")


def test_degrees_read_as_radians_on_the_users_word_are_noticed_by_size(tmp_path: Path) -> None:
    """Beyond a turn (2 pi) in any column; a file that says nothing is the usual case."""
    silent = GOOD.replace("inDegrees=yes\n", "")
    line = "column 'knee' reaches 30, much for radians; if these are degrees pass `angles` deg"
    assert said_when_read(table(tmp_path, silent), ["knee_tx", "knee"], "rad") == [f"gait.mot line 9: {line}"]
    assert said_when_read(table(tmp_path, silent), ["knee"], "deg") == []
    for most, count in (("6.28", 0), ("-6.28", 0), ("6.29", 1), ("-6.29", 1)):
        text = silent.replace("20", "2").replace("30", "3").replace("10", most)
        assert len(said_when_read(table(tmp_path, text), ["knee"], "rad")) == count, most


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("knee_tx", "column 'knee_tx' has no unit; write e.g."),
        ("knee_tx [furlong]", "column 'knee_tx' is in 'furlong'"),
    ],
)
def test_csv_lengths_need_a_unit(tmp_path: Path, header: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        lengths(table(tmp_path, CSV.replace("knee_tx [mm]", header), "gait.csv"), ["knee_tx"])


def test_csv_angles_need_a_unit(tmp_path: Path) -> None:
    read = table(tmp_path, CSV.replace(" [deg]", ""), "gait.csv")
    with pytest.raises(
        InputError, match="column 'knee' does not say whether angles are degrees or radians; pass `angles`"
    ):
        angles_of(read, ["knee"])
    with pytest.raises(InputError, match="angle column 'knee' is in 'turn'"):
        angles_of(table(tmp_path, CSV.replace("[deg]", "[turn]"), "gait.csv"), ["knee"])


def test_coordinates_are_found_by_name_and_by_path(tmp_path: Path) -> None:
    for column in ("knee", "/jointset/knee_r/knee/value", "knee_r/knee/value"):
        read = table(tmp_path, GOOD.replace("knee\t", f"{column}\t"))
        assert resolve(read, "knee", "knee_r") == resolve(read, "knee") == column
    assert resolve(read, "knee", "knee_l") is None
    assert resolve(read, "hip") is None
    with pytest.raises(InputError, match="'knee' is in several columns: knee, knee_r/knee/value"):
        resolve(table(tmp_path, GOOD.replace("knee_tx", "knee_r/knee/value")), "knee", "knee_r")


def test_map_keeps_order_and_sign() -> None:
    targets = ("rx", "ry", "rz", "tx")
    assert parse_map("rz=a, rx=-b ,tx=+c", targets) == {"rz": (1.0, "a"), "rx": (-1.0, "b"), "tx": (1.0, "c")}
    assert list(parse_map("rz=a,rx=b", targets)) == ["rz", "rx"]


@pytest.mark.parametrize("text", ["", "rz", "rz=", "=a", "rw=a", "rz=a,rz=b", "rz=-", "rz=a,,tx=b"])
def test_malformed_maps_are_refused(text: str) -> None:
    with pytest.raises(InputError, match="`map`"):
        parse_map(text, ("rz", "tx"))


@pytest.mark.parametrize(("name", "head"), [("gait.csv", "time, knee [deg]"), ("gait.mot", None)])
def test_a_cycle_in_per_cent_without_a_unit_is_told(tmp_path: Path, name: str, head: str | None) -> None:
    """0, 1, ... 100 in 101 rows; with a unit, or a row less, the file is believed."""
    start = f"{head}\n" if head else "inDegrees=yes\nendheader\ntime\tknee\n"
    mark = "," if head else "\t"
    rows = "".join(f"{k}{mark}{k % 7}\n" for k in range(101))
    with pytest.warns(InputWarning, match="time without a unit is 0, 1, … 100: taken as per cent of a cycle"):
        assert table(tmp_path, start + rows, name).time_unit == "%"
    assert table(tmp_path, start.replace("time", "time(s)") + rows, name).time_unit == "s"
    assert table(tmp_path, start + rows.rsplit("\n", 2)[0] + "\n", name).time_unit == "s"


@pytest.mark.parametrize("name", ["gait cycle", "cycle", "Gait Cycle", "stance phase", "gait"])
def test_a_place_in_the_cycle_is_the_time(tmp_path: Path, name: str) -> None:
    """As gait software and this package's own tables call it; beside a time it is a column like others."""
    file = tmp_path / "cycle.csv"
    file.write_text(f"{name} [%],knee [deg]\n0,1\n50,2\n100,3\n", encoding="utf-8")
    table = read_table(file)
    assert table.time.tolist() == [0.0, 50.0, 100.0] and table.time_unit == "%" and table.channels == ("knee",)
    file.write_text(f"time [s],{name} [%],knee [deg]\n0,0,1\n1,50,2\n2,100,3\n", encoding="utf-8")
    assert read_table(file).time_unit == "s" and read_table(file).channels == (name, "knee")
    file.write_text(f"{name} [deg],knee [deg]\n0,1\n50,2\n", encoding="utf-8")
    with pytest.raises(InputError, match="no columns named 'time'"):
        read_table(file)
