"""A gap case comes in as it was written, in SI units, whatever units, order of columns and line ends its files have."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.gap_case import GapCase
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.io.cases.gap_case import gap_case_folders, read_gap_case
from geocontact.io.text.units import si_unit
from tests.io.gap_case_files import CASE, TRIAL, case_in

EXPECTED = np.array([[0.5, 10.5, 0.01], [0.75, 11.5, np.nan], [1.0, -12.25, 0.03]])


def trials(case: GapCase) -> tuple[Trial, ...]:
    return (*case.calibration, *case.evaluation)


def test_a_case_reads_as_written(tmp_path: Path) -> None:
    case = read_gap_case(case_in(tmp_path))
    assert (case.name, case.system) == ("elbow_1", "elbow")
    assert [t.name for t in case.calibration] == ["t01", "t02"] and [t.name for t in case.evaluation] == ["t03"]
    for trial in trials(case):
        np.testing.assert_array_equal(trial.time, [0.0, 0.1, 0.2])
        np.testing.assert_array_equal(trial.signals.values, EXPECTED)
        assert (trial.signals.channels, trial.signals.units) == (("beta", "force", "cop"), ("rad", "N", "m"))
    first, second, _ = trials(case)
    assert (first.covariates, first.labels) == ({"cuff_pressure": 4000.0, "level": 1.0}, {"condition": "locked"})
    assert (second.covariates, second.labels) == ({}, {})
    assert case.parameters == (
        Parameter("k", "N/m^n", 300.0, 50.0, 1000.0),
        Parameter("z_ex", "m", 0.09, -math.inf, math.inf, fixed=True),
    )
    assert (case.constants, case.noise) == ({"l_ex": 0.17, "turns": 2.0}, {"force": 0.2, "cop": 0.001})
    spheres = {"px [m]": [0.0, 0.5], "py [m]": [0.01, 0.02], "radius [m]": [0.011, 0.012], "zone": ["z1", "2"]}
    assert list(case.tables) == ["spheres"]
    pd.testing.assert_frame_equal(case.tables["spheres"], pd.DataFrame(spheres))


def test_a_case_may_be_little_more_than_its_trials(tmp_path: Path) -> None:
    case = read_gap_case(
        case_in(tmp_path, case='format=1\nsystem="knee"\ncalibration=["t01"]\nevaluation=["t02", "t03"]')
    )
    assert (case.parameters, case.constants, case.noise, case.tables) == ((), {}, {}, {})


def test_trials_keep_the_order_of_the_lists(tmp_path: Path) -> None:
    text = CASE["case.toml"].replace('["t01", "t02"]', '["t03", "t01"]').replace('["t03"]', '["t02"]')
    assert [trial.name for trial in trials(read_gap_case(case_in(tmp_path, case=text)))] == ["t03", "t01", "t02"]


# One dimension each, the units that files come in, and the factor of each by its definition.
IN_OTHER_UNITS = {"time": ("ms", 1e-3), "beta": ("deg", math.pi / 180), "force": ("kN", 1e3), "cop": ("mm", 1e-3)}


def trial_text(values: np.ndarray, units: dict[str, tuple[str, float]]) -> str:
    """A trial whose SI `values` are written in other units."""
    header = ",".join(f"{name} [{unit}]" for name, (unit, _) in units.items())
    factors = [factor for _, factor in units.values()]
    rows = [",".join("" if np.isnan(x) else repr(float(x)) for x in row / factors) for row in values]
    return "\n".join([header, *rows, ""])


SI = {"time": ("s", 1.0), "beta": ("rad", 1.0), "force": ("N", 1.0), "cop": ("m", 1.0)}


def test_the_same_case_in_other_units_is_the_same_case(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    values = np.column_stack([np.linspace(0.0, 2.0, 200), random.normal(size=(200, 3)) * [1.0, 300.0, 0.1]])
    values[20:60, 3] = np.nan
    here, there = (dict.fromkeys(("t01", "t02", "t03"), trial_text(values, units)) for units in (SI, IN_OTHER_UNITS))
    noise = CASE["case.toml"].replace("force = 0.2", "force = 0.2e-3").replace("cop = 0.001", "cop = 1.0")
    spheres = "px [mm],py [cm],radius [in],zone\n0.0,1.0,0.43307086614173228,z1\n500,2.0,0.47244094488188976,2\n"
    first = read_gap_case(case_in(tmp_path / "si", **here))
    second = read_gap_case(case_in(tmp_path / "others", case=noise, spheres=spheres, **there))
    for ours, theirs in zip(trials(first), trials(second), strict=True):
        np.testing.assert_allclose(theirs.time, ours.time, rtol=1e-12, atol=0)
        np.testing.assert_allclose(theirs.signals.values, ours.signals.values, rtol=1e-12, atol=0)
        np.testing.assert_array_equal(ours.signals.values, values[:, 1:])
        assert (ours.signals.channels, ours.signals.units) == (theirs.signals.channels, theirs.signals.units)
    assert second.noise == pytest.approx(first.noise, rel=1e-12)
    pd.testing.assert_frame_equal(second.tables["spheres"], first.tables["spheres"], rtol=1e-12, atol=0)
    assert second.parameters == first.parameters


def test_one_trial_in_other_units_is_the_same_trial(tmp_path: Path) -> None:
    text = TRIAL.replace("[rad]", "[deg]").replace("0.50", repr(math.degrees(0.5)))
    case = read_gap_case(case_in(tmp_path, t02=text.replace("0.75", "90").replace("1.00", "180")))
    np.testing.assert_allclose(case.calibration[1].column("beta"), [0.5, math.pi / 2, math.pi], rtol=1e-15)
    assert case.calibration[1].signals.units == case.calibration[0].signals.units


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=50)
@given(
    arrays(np.float64, (4, 3), elements=st.floats(-1e16, 1e16)),
    st.tuples(*(st.sampled_from(units) for units in (("rad", "deg"), ("N", "kN", "lbf"), ("m", "cm", "mm", "in")))),
)
def test_numbers_survive_writing_in_any_unit(tmp_path: Path, values: np.ndarray, units: tuple[str, ...]) -> None:
    known = [si_unit(unit) for unit in units]
    named = {"time": ("s", 1.0)} | {
        name: (unit, found[1])
        for name, unit, found in zip(("beta", "force", "cop"), units, known, strict=True)
        if found
    }
    text = trial_text(np.column_stack([np.arange(4.0), values]), named)
    read = read_gap_case(case_in(tmp_path, t01=text, t02=text, t03=text, case=QUIET))
    for trial in trials(read):
        np.testing.assert_allclose(trial.signals.values, values, rtol=1e-15, atol=1e-300)


QUIET = 'format = 1\nsystem = "elbow"\ncalibration = ["t01", "t02"]\nevaluation = ["t03"]\n'

SPELLINGS = {
    "windows line ends": TRIAL.replace("\n", "\r\n"),
    "old line ends": TRIAL.replace("\n", "\r"),
    "byte order mark": "\ufeff" + TRIAL,
    "quoted header": '"time [s]","beta [rad]","force [N]","cop [m]"\n' + TRIAL.split("\n", 1)[1],
    "blanks": TRIAL.replace(",", " , ").replace("\n", "  \n").replace("[", "  [ ").replace("]", " ]"),
    "no blank before the unit": TRIAL.replace(" [", "["),
    "quoted numbers": TRIAL.replace("10.5", '"10.5"').replace("0.010", '"0.010"'),
    "no line end at the end": TRIAL.rstrip("\n"),
    "blank lines": TRIAL.replace("0.1,", "\n\n0.1,") + "\n \n",
    "NaN written out": TRIAL.replace("11.5,", "11.5,NaN"),
    "exponents": TRIAL.replace("10.5", "1.05e1").replace("11.5", "+1150E-2"),
    "other columns first": """time [s],cop [m],beta [rad],force [N]
0.0,0.010,0.50,10.5
0.1,,0.75,11.5
0.2,0.030,1.00,-12.25
""",
    "Time": TRIAL.replace("time", "Time"),
}


@pytest.mark.parametrize("text", SPELLINGS.values(), ids=SPELLINGS.keys())
def test_how_a_trial_is_spelt_changes_nothing(tmp_path: Path, text: str) -> None:
    case = read_gap_case(case_in(tmp_path, t02=text))
    trial = case.calibration[1]
    np.testing.assert_array_equal(trial.time, [0.0, 0.1, 0.2])
    np.testing.assert_array_equal(trial.signals.values, EXPECTED)
    assert trial.signals.channels == case.calibration[0].signals.channels


def test_how_settings_and_tables_are_spelt_changes_nothing(tmp_path: Path) -> None:
    plain = read_gap_case(case_in(tmp_path / "plain"))
    case = "\ufeff" + CASE["case.toml"].replace("\n", "\r\n")
    spheres = "\ufeff" + CASE["spheres.csv"].replace("z1", '"z1" ').replace("px [m]", '"px [m]"').replace("\n", "\r\n")
    other = read_gap_case(case_in(tmp_path / "other", case=case, spheres=spheres))
    pd.testing.assert_frame_equal(other.tables["spheres"], plain.tables["spheres"])
    assert (other.parameters, other.noise, other.constants) == (plain.parameters, plain.noise, plain.constants)


def test_a_trial_wrong_by_a_thousand_is_not_refused(tmp_path: Path) -> None:
    """Mistakes inside the data are effects to be diagnosed, not the reader's to judge."""
    text = TRIAL.replace("10.5", "1.05e7").replace("11.5", "1.15e7").replace("0.50", "5e4").replace("0.1,", "100,")
    case = read_gap_case(case_in(tmp_path, t03=text.replace("0.2,", "200,")))
    assert case.evaluation[0].column("force")[0] == 1.05e7 and case.evaluation[0].time[2] == 200.0


def test_a_channel_may_be_missing_from_one_trial_only(tmp_path: Path) -> None:
    case = read_gap_case(case_in(tmp_path, t02=TRIAL.replace("0.010", "").replace("0.030", "")))
    assert np.isnan(case.calibration[1].column("cop")).all()


def test_noise_of_zero_counts_as_not_known(tmp_path: Path) -> None:
    home = case_in(tmp_path, case=CASE["case.toml"].replace("force = 0.2", "force = 0"))
    with pytest.warns(InputWarning, match=r"case\.toml \[noise\] force: is 0; taken as not known"):
        assert read_gap_case(home).noise == {"cop": 0.001}


def test_files_that_are_not_listed_are_warned_of_once(tmp_path: Path) -> None:
    home = case_in(tmp_path, {"trials/t09.csv": "anything", "trials/notes.txt": "x", "trials/t08.csv": ""})
    with pytest.warns(InputWarning) as caught:
        assert len(trials(read_gap_case(home))) == 3
    (line,) = [str(w.message) for w in caught]
    assert line == f"{home / 'trials'}: not listed in case.toml and not used: t08.csv, t09.csv"


LAYOUT = "id,x [mm],y [mm],z [mm],area [cm^2]\n0,10,20,30,1.5\n1,11,21,31,1.5\n"
CELLS = "time [s],c1 [kPa],c0 [Pa]\n0,1,2\n0.15,3,4\n0.2,,6\n"


def cells_in(folder: Path, layout: str = LAYOUT, cells: str = CELLS, site: str = "cuff") -> Path:
    """The case with a mat of two cells, in two of its three trials."""
    text = CASE["case.toml"].replace("spheres =", f'layout = {{{site} = "mats/cuff.csv"}}\nspheres =')
    files = {"mats/cuff.csv": layout, f"trials/t01_{site}_cells.csv": cells, f"trials/t03_{site}_cells.csv": cells}
    return case_in(folder, files, case=text)


def test_cells_come_in_si_units_in_the_order_of_the_layout(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match=r"no t02_cuff_cells\.csv: cells of cuff are not used there"):
        cells = read_gap_case(cells_in(tmp_path)).cells["cuff"]
    assert (cells.channel, cells.ids) == ("force", ("0", "1")) and list(cells.trials) == ["t01", "t03"]
    np.testing.assert_allclose(cells.place, [[0.01, 0.02, 0.03], [0.011, 0.021, 0.031]], rtol=1e-15)
    np.testing.assert_allclose(cells.area, 1.5e-4, rtol=1e-15)
    np.testing.assert_array_equal(cells.trials["t01"].time, [0.0, 0.15, 0.2])
    np.testing.assert_array_equal(cells.trials["t01"].pressure, [[2.0, 1000.0], [4.0, 3000.0], [6.0, np.nan]])


def test_forces_of_cells_are_straight_between_frames_and_none_beyond(tmp_path: Path) -> None:
    with pytest.warns(InputWarning):
        cells = read_gap_case(cells_in(tmp_path)).cells["cuff"]
    force = cells.forces("t01", np.array([0.0, 0.075, 0.15, 0.3]))
    expected = 1.5e-4 * np.array([[2.0, 1000.0], [3.0, 2000.0], [4.0, 3000.0], [np.nan, np.nan]])
    np.testing.assert_allclose(force, expected, rtol=1e-12)


def test_the_sites_own_channel_comes_before_force(tmp_path: Path) -> None:
    with pytest.warns(InputWarning):
        assert read_gap_case(cells_in(tmp_path, site="cop")).cells["cop"].channel == "cop"


@pytest.mark.parametrize(
    ("layout", "cells", "message"),
    [
        (LAYOUT.replace("area [cm^2]", "size [cm^2]"), CELLS, r"cuff\.csv line 1: no column area \[m\^2\]"),
        (LAYOUT.replace("1,11", "0,11"), CELLS, r"cuff\.csv: cell 0 is listed 2 times"),
        (LAYOUT.replace("30,1.5", "30,-1.5"), CELLS, r"cuff\.csv: the area of cell 0 is not positive"),
        (LAYOUT, CELLS.replace("c1", "c2"), r"t01_cuff_cells\.csv line 1: no column c1"),
        (LAYOUT + "2,12,22,32,1.5\n", CELLS, r"t01_cuff_cells\.csv line 1: no column c2"),
        (LAYOUT.replace("1,11,21,31,1.5\n", ""), CELLS, r"line 1: the layout has no cell c1"),
        (LAYOUT, CELLS.replace("[kPa]", "[N]"), r"t01_cuff_cells\.csv line 1: 'c1' is in N; cells are pressures"),
        (LAYOUT, CELLS.replace("0.15", "0.25"), r"t01_cuff_cells\.csv line 4: time 0\.2 s does not follow 0\.25 s"),
    ],
)
def test_cells_that_cannot_be_used_are_refused(tmp_path: Path, layout: str, cells: str, message: str) -> None:
    with pytest.raises(InputError, match=message), warnings.catch_warnings(action="ignore"):
        read_gap_case(cells_in(tmp_path, layout, cells))


def test_cells_need_a_channel_that_they_add_up_to(tmp_path: Path) -> None:
    trial = TRIAL.replace("force", "moment")
    home = cells_in(tmp_path)
    for name in ("t01", "t02", "t03"):
        (home / "trials" / f"{name}.csv").write_text(trial, encoding="utf-8")
    settings = (home / "case.toml").read_text("utf-8").replace("force = 0.2\n", "")
    (home / "case.toml").write_text(settings, encoding="utf-8")
    with pytest.raises(InputError, match=r"layout\.cuff: no trial has a channel cuff_force that the cells of cuff"):
        read_gap_case(home)


def test_tables_of_an_own_model(tmp_path: Path) -> None:
    text = (
        CASE["case.toml"]
        .replace('"elbow"', '"lab.models:Wrist"')
        .replace("spheres =", 'curve = "more/Curve.CSV"\nspheres =')
    )
    case = read_gap_case(
        case_in(tmp_path, {"more/Curve.CSV": "turn [deg],torque [N mm],gain [%]\n180,2500,50\n"}, case=text)
    )
    assert case.system == "lab.models:Wrist" and set(case.tables) == {"curve", "spheres"}
    np.testing.assert_allclose(case.tables["curve"][["turn [rad]", "torque [N m]", "gain [-]"]], [[math.pi, 2.5, 0.5]])


def test_known_systems_are_the_callers(tmp_path: Path) -> None:
    home = case_in(tmp_path, case=CASE["case.toml"].replace('"elbow"', '"wrist"'))
    assert read_gap_case(home, ("wrist", "elbow")).system == "wrist"
    with pytest.raises(
        InputError, match=r"system: 'wrist' is unknown; write one of hip, knee, and \"package\.module:OBJECT"
    ):
        read_gap_case(home, ("hip", "knee"))


def test_the_name_is_the_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(case_in(tmp_path))
    assert [read_gap_case(folder).name for folder in (".", "trials/..", "../elbow_1/")] == ["elbow_1"] * 3


def test_cases_are_the_sub_folders_with_settings(tmp_path: Path) -> None:
    for name in ("b", "a", "c"):
        case_in(tmp_path / name).rename(tmp_path / f"case_{name}")
    assert gap_case_folders(tmp_path) == [tmp_path / f"case_{name}" for name in "abc"]
    (tmp_path / "case_b" / "case.toml").unlink()
    (tmp_path / "case.toml").touch()
    assert gap_case_folders(str(tmp_path)) == [tmp_path / "case_a", tmp_path / "case_c"]


@pytest.mark.parametrize(
    ("folder", "message"),
    [
        ("nowhere", "nowhere: there is no such folder; name the folder that holds case.toml"),
        ("elbow_1/case.toml", "case.toml: is not a folder"),
        ("elbow_1/trials", "trials: no sub-folder has a case.toml; name the folder that holds the cases"),
        ("elbow_1", "elbow_1: no sub-folder has a case.toml; it is a case itself"),
        ("a\0b", "cannot be opened: embedded null byte|there is no such folder"),
        ("x" * 5000, "cannot be opened: .*too long"),
    ],
)
def test_folders_without_cases(tmp_path: Path, folder: str, message: str) -> None:
    case_in(tmp_path)
    with pytest.raises(InputError, match=message):
        gap_case_folders(tmp_path / folder)


PROGRAM = 'simulate = "wrist {params} {trial} {out}"\ninputs = ["beta"]\noutputs = ["force"]\nspheres ='


def simulated(folder: Path, program: str = PROGRAM, system: str = "command") -> Path:
    text = CASE["case.toml"].replace('"elbow"', f'"{system}"').replace("spheres =", program)
    return case_in(folder, case=text)


def test_a_program_is_not_run_unasked(tmp_path: Path) -> None:
    home = simulated(tmp_path)
    with pytest.raises(
        InputError, match=r"case\.toml simulate: would run 'wrist \{params\} \{trial\} \{out\}'; a case"
    ):
        read_gap_case(home)
    own = read_gap_case(home, run_programs=True).simulator
    assert own is not None
    assert (own.inputs, own.outputs, own.units) == (("beta",), ("force",), {"beta": "rad", "force": "N"})


@pytest.mark.parametrize(
    ("program", "system", "message"),
    [
        ("spheres =", "command", "system command needs the key 'simulate'"),
        (PROGRAM.replace('inputs = ["beta"]\n', ""), "command", "system command needs the key 'inputs'"),
        (PROGRAM, "elbow", "simulate: does nothing for the system elbow"),
        (PROGRAM.replace('["force"]', '["beta"]'), "command", "outputs: beta is among the inputs too"),
        (PROGRAM.replace('["force"]', '["moment"]'), "command", r"no column 'moment', which case\.toml names"),
        (PROGRAM.replace(" {trial}", ""), "command", r"simulate: has no \{trial\}; write for example"),
        (PROGRAM.replace("wrist {", "'wrist {"), "command", "simulate: No closing quotation"),
    ],
)
def test_a_program_that_cannot_be_used_is_refused(tmp_path: Path, program: str, system: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_gap_case(simulated(tmp_path, program, system), run_programs=True)
