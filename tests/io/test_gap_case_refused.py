"""What cannot be used of a gap case is refused in one line: file, place, what is wrong, remedy."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.io.cases import trial_table
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.text import side_table
from tests.io.gap_case_files import CASE, TRIAL, case_in

SETTINGS = CASE["case.toml"]
SPHERES = CASE["spheres.csv"]
HTML = "<!DOCTYPE html>\n<html><body>Sign in</body></html>\n"
LAYOUT = 'layout = {pelvis = "pelvis.csv"}\nspheres ='


def refusal(home: Path) -> str:
    """The line that a case is refused with, paths relative to its folder."""
    with pytest.raises(InputError) as caught:
        read_gap_case(home)
    line = str(caught.value)
    assert "\n" not in line and line.isprintable() and len(line) < 800
    assert str(home) in line, "the file is named"
    return line.replace(f"{home}/", "").replace(str(home), "elbow_1")


# What is replaced by what in case.toml, and how the line begins.
BAD_SETTINGS = {
    "no TOML": ("format = 1", "format: 1", "case.toml: is not TOML: Expected '=' after a key"),
    "quote left open": ('"elbow"', '"elbow', "case.toml: is not TOML: "),
    "a key twice": ("[constants]", "[noise]", "case.toml: is not TOML: "),
    "thousands of digits": ("start = 300.0", "start = " + "3" * 5000, "case.toml: is not TOML: "),
    "deep nesting": ('["t03"]', "[" * 5000 + "]" * 5000, "case.toml: is nested too deeply"),
    "HTML": (SETTINGS, HTML, "case.toml: is not a TOML file: it looks like an HTML page"),
    "empty": (SETTINGS, "", "case.toml: the file is empty"),
    "blank": (SETTINGS, " \n \n", "case.toml: the file is empty"),
    "format missing": ("format = 1", "", "case.toml format: is 'missing'; write format = 1"),
    "format 2": ("format = 1", "format = 2", "case.toml format: is 2; write format = 1"),
    "format true": ("format = 1", "format = true", "case.toml format: is True; write format = 1"),
    "format 1.0": ("format = 1", "format = 1.0", "case.toml format: is 1.0; write format = 1"),
    "format in words": ("format = 1", 'format = "1"', "case.toml format: is '1'; write format = 1"),
    "unknown system": (
        '"elbow"',
        '"elbwo"',
        "case.toml system: 'elbwo' is unknown; write one of elbow, foot, shoulder, knee, sit_to_stand, and \"p",
    ),
    "own system without object": ('"elbow"', '"lab.models:"', "case.toml system: 'lab.models:' is unknown"),
    "own system as a path": ('"elbow"', '"../lab:Wrist"', "case.toml system: '../lab:Wrist' is unknown"),
    "system is a number": ('"elbow"', "3", "case.toml system: is 3; input should be a valid string"),
    "no system": ('system = "elbow"', "", "case.toml: no key 'system'; keys here are format, system, calibration"),
    "no calibration": (
        "calibration =",
        "calibration_ =",
        "case.toml: unknown key 'calibration_'; keys here are format,",
    ),
    "no evaluation": ('evaluation = ["t03"]', "", "case.toml: no key 'evaluation'"),
    "empty calibration": ('["t01", "t02"]', "[]", "case.toml calibration: is []; tuple should have at least 1 item"),
    "empty evaluation": ('["t03"]', "[]", "case.toml evaluation: is []; tuple should have at least 1 item"),
    "calibration is not a list": (
        '["t01", "t02"]',
        '"t01"',
        "case.toml calibration: is 't01'; input should be a valid tuple",
    ),
    "ids are numbers": ('["t03"]', "[3]", "case.toml evaluation.0: is 3; input should be a valid string"),
    "trial twice": ('["t03"]', '["t03", "t03"]', "case.toml evaluation: 't03' is listed 2 times"),
    "trial on both sides": ('["t03"]', '["t02", "t03"]', "case.toml evaluation: 't02' is listed in calibration too"),
    "trial without file": ('["t03"]', '["t03", "t04"]', "case.toml evaluation: no file trials/t04.csv; delete it"),
    "id leads up": ('["t03"]', '["../t03"]', "case.toml evaluation.0: is '../t03'; expected letters"),
    "id has dots": ('["t03"]', '["a..b"]', "case.toml evaluation.0: is 'a..b'; expected letters"),
    "id is dots": ('["t03"]', '[".."]', "case.toml evaluation.0: is '..'; expected letters"),
    "id with separator": ('["t03"]', '["a/t03"]', "case.toml evaluation.0: is 'a/t03'; expected letters"),
    "id with backslash": ('["t03"]', "['a\\t03']", "case.toml evaluation.0: is 'a\\\\t03'; expected letters"),
    "id is empty": ('["t03"]', '[""]', "case.toml evaluation.0: is ''; expected letters"),
    "id with a control sign": ('["t03"]', '["t\\u001b03"]', "case.toml evaluation.0: is 't\\x1b03'; expected letters"),
    "id with NUL": ('["t03"]', '["t\\u0000"]', "case.toml evaluation.0: is 't\\x00'; expected letters"),
    "unknown key": ("[constants]", "[constant]", "case.toml: unknown key 'constant'; keys here are format, system"),
    "key that is inner": ("spheres =", "tables = {}\nspheres =", "case.toml: unknown key 'tables'; keys here are"),
    "string that is no table": ('"spheres.csv"', '"spheres.txt"', "case.toml: unknown key 'spheres'; keys here are"),
    "table leads up": (
        '"spheres.csv"',
        '"../spheres.csv"',
        "case.toml spheres: '../spheres.csv' cannot be used; name a",
    ),
    "table is absolute": (
        '"spheres.csv"',
        '"/etc/spheres.csv"',
        "case.toml spheres: '/etc/spheres.csv' cannot be used",
    ),
    "table on a drive": ('"spheres.csv"', "'C:\\spheres.csv'", "case.toml spheres: 'C:\\\\spheres.csv' cannot be used"),
    "table is missing": ('"spheres.csv"', '"sphere.csv"', "sphere.csv: there is no such file; check the path"),
    "layout is not a table": (
        "spheres =",
        'layout = "p.csv"\nspheres =',
        "case.toml layout: is 'p.csv'; input should be",
    ),
    "layout leads up": (
        "spheres =",
        LAYOUT.replace('"p', '"../p'),
        "case.toml layout.pelvis: '../pelvis.csv' cannot be used",
    ),
    "noise of no channel": (
        "force = 0.2",
        "forc = 0.2",
        "case.toml [noise]: no trial has a channel 'forc'; channels are: b",
    ),
    "noise is negative": (
        "force = 0.2",
        "force = -0.2",
        "case.toml [noise] force: is -0.2; a standard deviation is pos",
    ),
    "noise is NaN": ("force = 0.2", "force = nan", "case.toml noise.force: is nan; input should be a finite number"),
    "noise in words": (
        "force = 0.2",
        'force = "0.2"',
        "case.toml noise.force: is '0.2'; input should be a valid number",
    ),
    "constant is infinite": ("l_ex = 0.17", "l_ex = inf", "case.toml constants.l_ex: is inf; input should be a finite"),
    "constant is true": (
        "l_ex = 0.17",
        "l_ex = true",
        "case.toml constants.l_ex: is True; input should be a valid num",
    ),
    "constant is a list": (
        "l_ex = 0.17",
        "l_ex = [0.17]",
        "case.toml constants.l_ex: is [0.17]; input should be a valid",
    ),
    "name is blank": ("l_ex = 0.17", '" " = 0.17', "case.toml constants. : is ' '; expected a name of printable"),
    "constant and parameter": ("l_ex = 0.17", "k = 0.17", "case.toml [parameters.k]: is in [constants] too; keep"),
    "parameter without start": (
        "start = 300.0",
        "",
        "case.toml parameters.k: no key 'start'; keys here are start, lower",
    ),
    "parameter without bound": (
        "upper = 1000.0",
        "",
        "case.toml [parameters.k]: no key 'upper'; write lower and upper",
    ),
    "parameter below": (
        "start = 300.0",
        "start = 3.0",
        "case.toml [parameters.k]: k: start 3 is not between 50 and 1000",
    ),
    "bound is NaN": (
        "lower = 50.0",
        "lower = nan",
        "case.toml [parameters.k]: k: start 300 is not between nan and 1000",
    ),
    "parameter key": (
        "lower = 50.0",
        "low = 50.0",
        "case.toml parameters.k: unknown key 'low'; keys here are start, lo",
    ),
    "start in words": ("start = 300.0", 'start = "300"', "case.toml parameters.k.start: is '300'; input should be a"),
    "fixed in words": ("fixed = true", 'fixed = "yes"', "case.toml parameters.z_ex.fixed: is 'yes'; input should be a"),
    "covariates of no trial": (
        "[trial.t01]",
        "[trial.t1]",
        "case.toml [trial.t1]: neither calibration nor evaluation li",
    ),
    "covariate is a list": (
        "level = 1",
        "level = [1]",
        "case.toml trial.t01.level: is [1]; expected a finite number or",
    ),
    "covariate is true": (
        "level = 1",
        "level = true",
        "case.toml trial.t01.level: is True; expected a finite number or",
    ),
    "covariate is NaN": ("level = 1", "level = nan", "case.toml trial.t01.level: is nan; expected a finite number or"),
    "covariate is a date": (
        "level = 1",
        "level = 2024-01-01",
        "case.toml trial.t01.level: is datetime.date(2024, 1, 1)",
    ),
    "covariate of two kinds": (
        "level = 1",
        'level = 1\n[trial.t02]\nlevel = "1"',
        "case.toml [trial.t02]: 'level' is a word here and a number in trial t01",
    ),
}


@pytest.mark.parametrize(("old", "new", "line"), BAD_SETTINGS.values(), ids=BAD_SETTINGS.keys())
def test_settings_are_refused(tmp_path: Path, old: str, new: str, line: str) -> None:
    assert old in SETTINGS
    assert refusal(case_in(tmp_path, case=SETTINGS.replace(old, new, 1))).startswith(line)


BODY = TRIAL.split("\n", 1)[1]

# What is replaced by what in trials/t02.csv, and how the line begins after the file.
BAD_TRIALS = {
    "empty": (TRIAL, "", ": the file is empty"),
    "blank": (TRIAL, "\n\n  \n", ": the file is empty"),
    "HTML": (TRIAL, HTML, ": is not a CSV table: it looks like an HTML page; fetch the file itself"),
    "HTML after a mark": (TRIAL, "\ufeff" + HTML, ": is not a CSV table: it looks like an HTML page"),
    "LFS pointer": (TRIAL, "version https://git-lfs.github.com/spec/v1\n", ": is not a CSV table: it looks like a Git"),
    "binary": ("10.5", "\0", ": is not a CSV table: it looks like binary data"),
    "no header": (TRIAL, BODY, " line 1: numbers where the header should be; one row of `name [unit]` is needed"),
    "blank first line": (TRIAL, "\n" + TRIAL, " line 1: no column names; one row of `name [unit]` is needed above"),
    "header alone": (BODY, "", " line 2: no rows below the column labels"),
    "one row": (BODY, BODY.split("\n")[0], ": 1 row; a trial needs at least 2"),
    "time alone": (TRIAL, "time [s]\n0\n1\n", " line 1: time is the only column"),
    "no time": ("time [s]", "beat [s]", " line 1: the first column is 'beat'; put `time [s]` first"),
    "time is second": ("time [s],beta [rad]", "beta [rad],time [s]", " line 1: the first column is 'beta'; put `time"),
    "time has no unit": ("time [s]", "time", " line 1: column 'time' has no unit; write for example `time [s]`"),
    "time in per cent": ("time [s]", "time [%]", " line 1: time is in '%'; write `time [s]` or [ms]"),
    "time in newtons": ("time [s]", "time [N]", " line 1: time is in 'N'; write `time [s]` or [ms]"),
    "time in hours": ("time [s]", "time [h]", " line 1, column 1: 'time' is in 'h', which is not a unit known here"),
    "no unit": ("force [N]", "force", " line 1: column 'force' has no unit; write for example `force [N]`, [-] for a"),
    "empty unit": ("force [N]", "force []", " line 1: column 'force' has no unit"),
    "bracket left open": ("force [N]", "force [N", " line 1: column 'force [N' has no unit"),
    "unknown unit": ("force [N]", "force [newton]", " line 1, column 3: 'force' is in 'newton', which is not a unit k"),
    "unit in capitals": ("force [N]", "force [KN]", " line 1, column 3: 'force' is in 'KN', which is not a unit known"),
    "label for a unit": ("force [N]", "force [N/m^n]", " line 1, column 3: 'force' is in 'N/m^n', which is not a unit"),
    "ambiguous unit": ("force [N]", "force [m N]", " line 1, column 3: 'force' is in 'm N', which is not a unit known"),
    "another dimension": ("force [N]", "force [m]", " line 1: 'force' is in 'm', in t01.csv it is in 'N'; units of on"),
    "column twice": ("cop [m]", "force [N]", " line 1: column 'force' occurs 2 times; give each column a name of its"),
    "column twice, two units": ("cop [m]", "force [kN]", " line 1: column 'force' occurs 2 times"),
    "column without name": ("force [N]", "[N]", " line 1, column 3: has no name; write `name [unit]`"),
    "trailing comma": ("cop [m]", "cop [m],", " line 1, column 5: has no name"),
    "control sign in a name": ("force [N]", "for\x1bce [N]", " line 1, column 3: 'for\\x1bce' is not a name of printa"),
    "long name": ("force [N]", "f" * 101 + " [N]", " line 1, column 3: '" + "f" * 40 + "' is not a name of printable"),
    "quote left open": ("force [N]", '"force [N]', " line 1: a quote is left open; check the quotes"),
    "too many columns": ("force [N]", ",".join(f"f{i} [N]" for i in range(1000)), " line 1: 1003 columns are more tha"),
    "missing column": (TRIAL, "time [s],beta [rad],force [N]\n0,1,1\n1,1,1\n", " line 1: no column cop, unl"),
    "additional column": (TRIAL, "time [s],a [N],beta [rad],force [N],cop [m]\n0,1,1,1,1\n1,1,1,1,1\n", " line 1: col"),
    "another column": ("cop [m]", "cop_x [m]", " line 1: no column cop, unlike t01.csv; all trials need the same colu"),
    "semicolons, commas and points": (TRIAL, TRIAL.replace(",", ";").replace("11.5", "11,5"), " line 3: '11,5' has a"),
    "tabs": (TRIAL, TRIAL.replace(",", "\t"), " line 1: columns are separated by tabs; save it with commas"),
    "decimal commas": (BODY, BODY.replace(".", ","), " line 2: 8 cells where 4 columns are named (decimal c"),
    "decimal comma later": ("11.5,", "11,5,", " line 3: more cells where 4 columns are named (decimal commas?); write"),
    "decimal comma in quotes": ("11.5", '"11,5"', ' line 3: decimal comma in "11,5"; write decimal points'),
    "thousands": ("11.5", '"1,150"', ' line 3: decimal comma in "1,150"; write decimal points'),
    "short row": ("11.5,", "11.5", " line 3: 3 cells where 4 columns are named; rows must be as long as the header"),
    "long first row": ("0.010", "0.010,7", " line 2: 5 cells where 4 columns are named (decimal commas?); write"),
    "word": ("11.5", "eleven", " line 3: 'eleven' in column 'force' is not a number"),
    "spreadsheet error": ("11.5", "#DIV/0!", " line 3: '#DIV/0!' in column 'force' is not a number"),
    "underscore": ("11.5", "1_1.5", " line 3: '1_1.5' in column 'force' is not a number"),
    "other digits": ("11.5", "１１", " line 3: '１１' in column 'force' is not a number"),
    "hexadecimal": ("11.5", "0x11", " line 3: '0x11' in column 'force' is not a number"),
    "infinite": ("11.5", "inf", " line 3: 'force' is infinite or too large; leave cells empty"),
    "beyond float": ("11.5", "-1e999", " line 3: 'force' is infinite or too large"),
    "beyond float in SI": (TRIAL, TRIAL.replace("[N]", "[kN]").replace("11.5", "1e307"), " line 3: 1e+307 in"),
    "time is empty": ("0.1,", ",", " line 3: time is missing; every row needs its time"),
    "time is NaN": ("0.1,", "nan,", " line 3: time is missing; every row needs its time"),
    "time is infinite": ("0.2,", "inf,", " line 4: 'time' is infinite or too large"),
    "time stands": ("0.1,", "0.0,", " line 3: time 0 s does not follow 0 s; time must increase from row to row"),
    "time runs back": ("0.2,", "0.05,", " line 4: time 0.05 s does not follow 0.1 s; time must increase"),
    "row of commas": ("0.2,", ",,,\n0.2,", " line 4: time is missing"),
    "second header": ("0.1,", TRIAL.split("\n")[0] + "\n0.1,", " line 3: 'time [s]' in column 'time' is not a number"),
    "NaN throughout": (BODY, "0,,,\n1,nan,,\n", ": every channel is empty in every row; delete the trial from case.to"),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "line"), BAD_TRIALS.values(), ids=BAD_TRIALS.keys())
def test_trials_are_refused(tmp_path: Path, old: str, new: str, line: str) -> None:
    assert old in TRIAL
    assert refusal(case_in(tmp_path, t02=TRIAL.replace(old, new, 1))).startswith(f"trials/t02.csv{line}")


BAD_TABLES = {
    "empty": (SPHERES, "", ": the file is empty"),
    "HTML": (SPHERES, HTML, ": is not a CSV table: it looks like an HTML page"),
    "no rows": (SPHERES, "px [m],py [m],radius [m],zone\n", " line 2: no rows below the column names"),
    "unknown unit": ("[m]", "[furlong]", " line 1, column 1: 'px' is in 'furlong', which is not a unit known here"),
    "column twice": ("py", "px", " line 1: column 'px' occurs 2 times"),
    "short row": (",z1", "", " line 2: 3 cells where 4 columns are named"),
    "long row": (",2\n", ",2,3\n", " line 3: 5 cells where 4 columns are named"),
    "empty number": (
        "0.02",
        "",
        " line 3: '' in column 'py' is not a finite number; write decimal points and leave no",
    ),
    "word for a number": ("0.02", "small", " line 3: 'small' in column 'py' is not a finite number"),
    "NaN": ("0.02", "nan", " line 3: 'nan' in column 'py' is not a finite number"),
    "infinite": ("0.02", "1e999", " line 3: '1e999' in column 'py' is not a finite number"),
    "underscore": ("0.02", "0_2", " line 3: '0_2' in column 'py' is not a finite number"),
    "empty word": (",z1", ",", " line 2: '' in column 'zone' is not a word of printable characters"),
    "line end in a word": ("z1", '"z\n1"', " line 3: 'z\\n1' in column 'zone' is not a word of printable characters"),
    "quote left open": ("z1", '"z1', " line 3: 'z1\\n0.5,0.02,0.012,2\\n' in column 'zone' is not a word"),
    "decimal commas": ("0.0,0.01", "0,0,0,01", " line 2: 6 cells where 4 columns are named (decimal commas?); write"),
    "decimal comma in quotes": ("0.02", '"0,02"', ' line 3: decimal comma in "0,02"; write decimal points'),
    "thousands or decimals": (SPHERES, "px [m];py [m]\n1,234;5,678\n", " line 2: '1,234' may be thousands or have a"),
}


@pytest.mark.parametrize(("old", "new", "line"), BAD_TABLES.values(), ids=BAD_TABLES.keys())
def test_tables_are_refused(tmp_path: Path, old: str, new: str, line: str) -> None:
    assert old in SPHERES
    assert refusal(case_in(tmp_path, spheres=SPHERES.replace(old, new, 1))).startswith(f"spheres.csv{line}")


@pytest.mark.parametrize("encoding", ["latin-1", "utf-16"])
@pytest.mark.parametrize("name", ["case.toml", "spheres.csv", "trials/t02.csv"])
def test_other_encodings_are_refused(tmp_path: Path, name: str, encoding: str) -> None:
    texts = {
        "case.toml": SETTINGS.replace('"locked"', '"gelöst"'),
        "spheres.csv": SPHERES.replace("z1", "Zöhe"),
        "trials/t02.csv": TRIAL.replace("beta", "Neigung_größer"),
    }
    home = case_in(tmp_path)
    (home / name).write_bytes(texts[name].encode(encoding))
    line = {"case.toml": 27, "spheres.csv": 2, "trials/t02.csv": 1}[name]
    expected = {
        "latin-1": f"{name} line {line}: byte 0xf6 is not UTF-8; save it as UTF-8",
        "utf-16": f"{name}: is not a ",
    }
    assert refusal(home).startswith(expected[encoding])


def test_labels_in_utf_8_are_fine(tmp_path: Path) -> None:
    case = read_gap_case(case_in(tmp_path, case=SETTINGS.replace('"locked"', '"gelöst"')))
    assert case.calibration[0].labels == {"condition": "gelöst"}


def test_a_channel_empty_in_all_trials_is_refused(tmp_path: Path) -> None:
    text = TRIAL.replace("0.010", "").replace("0.030", "")
    line = refusal(case_in(tmp_path, t01=text, t02=text, t03=text))
    assert line.startswith("trials: column 'cop' is empty in all trials; delete the column from all trials")


def test_noise_in_two_units_is_refused(tmp_path: Path) -> None:
    line = refusal(case_in(tmp_path, t03=TRIAL.replace("[N]", "[kN]")))
    assert line.startswith("case.toml [noise]: force is in N in t02.csv and in kN in t03.csv, so the unit of its noise")


def test_equal_bounds_ask_for_fixed(tmp_path: Path) -> None:
    text = SETTINGS.replace("lower = 50.0", "lower = 300.0").replace("upper = 1000.0", "upper = 300.0")
    line = refusal(case_in(tmp_path, case=text))
    assert line.startswith("case.toml [parameters.k]: k: lower and upper bound are equal; say fixed = true instead")


@pytest.mark.parametrize(
    ("missing", "line"),
    [
        ("case.toml", "case.toml: there is no such file"),
        (
            "trials/t02.csv",
            "case.toml calibration: no file trials/t02.csv; delete it or add the file; there are t01, t03",
        ),
        (
            "trials/t03.csv",
            "case.toml evaluation: no file trials/t03.csv; delete it or add the file; there are t01, t02",
        ),
        ("spheres.csv", "spheres.csv: there is no such file"),
    ],
)
def test_missing_files_are_refused(tmp_path: Path, missing: str, line: str) -> None:
    home = case_in(tmp_path)
    (home / missing).unlink()
    assert refusal(home).startswith(line)


def test_a_case_without_trials_is_refused(tmp_path: Path) -> None:
    home = case_in(tmp_path)
    (home / "trials").rename(home / "Versuche")
    assert refusal(home) == "elbow_1: no folder 'trials' in it; put the trials there, as trials/<id>.csv"


@pytest.mark.parametrize("name", ["case.toml", "spheres.csv", "trials/t02.csv"])
def test_folders_in_place_of_files_are_refused(tmp_path: Path, name: str) -> None:
    home = case_in(tmp_path)
    (home / name).unlink()
    (home / name).mkdir()
    assert refusal(home) == f"{name}: is a folder; name a file"


def test_a_link_out_of_the_case_is_refused(tmp_path: Path) -> None:
    home = case_in(tmp_path)
    (home / "spheres.csv").rename(tmp_path / "elsewhere.csv")
    (home / "spheres.csv").symlink_to(tmp_path / "elsewhere.csv")
    assert refusal(home).startswith("case.toml spheres: 'spheres.csv' leads out of the folder of the case")


def test_a_circle_of_links_is_refused(tmp_path: Path) -> None:
    home = case_in(tmp_path)
    (home / "spheres.csv").unlink()
    (home / "spheres.csv").symlink_to(home / "spheres.csv")
    assert refusal(home).startswith(("case.toml spheres: ", "spheres.csv: cannot be read"))


@pytest.mark.parametrize(
    ("name", "largest"), [("case.toml", 1_000_000), ("spheres.csv", 8_000_000), ("trials/t02.csv", 64_000_000)]
)
def test_large_files_are_refused_before_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, largest: int
) -> None:
    home = case_in(tmp_path)
    os.truncate(home / name, largest + 1)  # a hole: takes no room
    opened = Path.open
    monkeypatch.setattr(Path, "open", lambda path, *how, **more: None if path == home / name else opened(path, *how))
    expected = (
        f"{name}: {largest / 1e6:.1f} MB is more than the {largest / 1e6:.0f} MB that are read; cut or resample it"
    )
    assert refusal(home) == expected


def test_many_large_trials_are_refused_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("geocontact.io.cases.case_settings.MOST_BYTES", 3 * len(TRIAL) - 1)
    assert refusal(case_in(tmp_path)).startswith("trials: the trials have 0 MB, more than the 0 MB that are read")


def test_a_header_that_does_not_end_is_refused(tmp_path: Path) -> None:
    line = refusal(case_in(tmp_path, t02="time [s]," + "x" * 2_000_000))
    assert line == "trials/t02.csv line 1: the header does not end; one row of `name [unit]` is needed"


def test_limits_are_of_a_size_that_recordings_fit_in() -> None:
    """Ten columns of ten characters at 1 kHz: ten minutes of a trial; three numbers of ten for 1e5 cells of a mat."""
    assert trial_table.LARGEST_TRIAL >= 600 * 1000 * 10 * 10 and side_table.LARGEST_TABLE >= 1e5 * 3 * 10


@pytest.mark.parametrize("name", ["case.toml", "spheres.csv", "trials/t02.csv"])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_damaged_files_are_read_or_refused_and_nothing_else(tmp_path: Path, name: str, seed: int) -> None:
    """Bytes cut, doubled, exchanged: a case whose numbers are finite or missing, or one line."""
    random, home = np.random.default_rng(seed), case_in(tmp_path)
    whole = (home / name).read_bytes()
    for _ in range(100):
        (home / name).write_bytes(damaged(whole, random))
        case = case_or_line(home)
        if isinstance(case, str):
            assert "\n" not in case
            continue
        trials = (*case.calibration, *case.evaluation)
        assert trials and not any(np.isinf(trial.signals.values).any() for trial in trials)
        assert all(np.all(np.diff(trial.time) > 0.0) for trial in trials)


def case_or_line(home: Path) -> GapCase | str:
    try:
        return read_gap_case(home)
    except InputError as error:
        return str(error)


def damaged(whole: bytes, random: np.random.Generator) -> bytes:
    """The bytes with one to three places spoilt."""
    data = bytearray(whole)
    for _ in range(random.integers(1, 4)):
        start, stop = sorted(int(i) for i in random.integers(0, len(data) + 1, 2))
        match random.integers(4):
            case 0:
                del data[start : min(stop, start + 20)]
            case 1:
                data[start:start] = data[start : min(stop, start + 20)]
            case 2:
                data[start : start + 1] = bytes([random.choice(list(b'",;.\n\r\t []={}-+eE0_#\0\x1b\xe9'))])
            case _:
                data[start : start + 1] = random.bytes(1)
    return bytes(data)
