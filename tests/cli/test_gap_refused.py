"""What `geocontact gap diagnose` refuses: one line that says what and where, exit 2, nothing left behind."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.calls import call, inventory
from tests.cli.gap_cases import SETTINGS, damped_elbow, foot_case, spoilt


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A good elbow and a good foot."""
    folder = tmp_path_factory.mktemp("good")
    return {"elbow": damped_elbow(folder / "elbow"), "foot": foot_case(folder / "foot")}


def refused(case: Path, out: Path, *options: object) -> str:
    """The one line that a call is refused with; nothing was written."""
    before = inventory(out.parent)
    result = call("gap", "diagnose", case, "--out", out, *options)
    assert result.code == 2, result.err
    assert result.out == ""
    (line,) = result.complaints
    assert inventory(out.parent) == before
    return line


K = '[parameters.k]\nstart = 280.0\nlower = 50.0\nupper = 1000.0\nunit = "N/m"\n'
WRONG = {
    # system, file, what is replaced by what, words of the line
    "unknown system": ("elbow", "case.toml", '"elbow"', '"ankle"', "case.toml system: 'ankle' is unknown; write one"),
    "no table": ("elbow", "case.toml", '"elbow"', '"shoulder"', "shoulder: the table of support torques is missing"),
    "own module": ("elbow", "case.toml", '"elbow"', '"no_such:MODEL"', "module no_such cannot be imported"),
    "constant missing": ("elbow", "case.toml", "\nl = ", "\nl_in = ", "elbow: l is missing; give it as a parameter"),
    "parameter missing": ("elbow", "case.toml", K, "", "elbow: k is missing; give it as a parameter or as a constant"),
    "two meanings": ("elbow", "case.toml", "\nl = ", "\nk = 2.0\nl = ", "[parameters.k]: is in [constants] too"),
    "overlap": ("elbow", "case.toml", "['t03', 't04']", "['t02', 't04']", "evaluation: 't02' is listed in calibration"),
    "one to fit": ("elbow", "case.toml", "['t01', 't02']", "['t01']", "calibration: 1 trial to fit to: how much"),
    "one held out": ("elbow", "case.toml", "['t03', 't04']", "['t03']", "evaluation: 1 trial held out: how much"),
    "no such trial": ("elbow", "case.toml", "'t04'", "'t09'", "evaluation: no file trials/t09.csv"),
    "noise of nothing": ("elbow", "case.toml", "force = ", "torque = ", "[noise]: no trial has a channel 'torque'"),
    "noise below zero": ("elbow", "case.toml", "force = ", "force = -", "[noise] force: is -0.15; a standard deviatio"),
    "start out of bounds": ("elbow", "case.toml", "start = 280.0", "start = 9e9", "[parameters.k]: k: start 9e+09 is"),
    "unknown key": ("elbow", "case.toml", "[constants]", "[constant]", "case.toml: unknown key 'constant'"),
    "future format": ("elbow", "case.toml", "format = 1", "format = 2", "case.toml format: is 2; write format = 1"),
    "other channel": ("elbow", "trials/*", "force [N]", "torque [N]", "[noise]: no trial has a channel 'force'"),
    "input missing": ("elbow", "trials/*", "beta [rad]", "gamma [rad]", "needs channel beta, which trial t01 lacks; i"),
    "wrong dimension": ("elbow", "trials/*", "beta [rad]", "beta [m]", "needs beta in rad, trial t01 gives m; correct"),
    "pure number": ("elbow", "trials/*", "beta [rad]", "beta [-]", "needs beta in rad, trial t01 gives -"),
    "unit in one trial": ("elbow", "trials/t02.csv", "[rad]", "[s]", "t02.csv line 1: 'beta' is in 's', in t01.csv it"),
    "unknown unit": ("elbow", "trials/t02.csv", "force [N]", "force [n]", "t02.csv line 1, column 3: 'force' is in 'n"),
    "no unit": ("elbow", "trials/t02.csv", "force [N]", "force", "t02.csv line 1: column 'force' has no unit"),
    "word": ("elbow", "trials/t03.csv", "\n0.04,", "\nsoon,", "t03.csv line 3: 'soon' in column 'time' is not a numbe"),
    "time runs back": ("elbow", "trials/t03.csv", "\n0.04,", "\n0.0,", "t03.csv line 3: time 0 s does not follow 0 s"),
    "no spheres": ("foot", "case.toml", 'spheres = "spheres.csv"\n', "", "foot: the table of spheres is missing; name"),
    "no such table": ("foot", "case.toml", '"spheres.csv"', '"balls.csv"', "balls.csv: there is no such file"),
    "column of spheres": ("foot", "spheres.csv", "radius [m]", "r [m]", "foot: the spheres have no column 'radius [m]"),
    "zone without k": ("foot", "case.toml", "[parameters.k_z2]", "[parameters.k_z9]", "foot: k_z2 is missing; give it"),
    "foot constant": ("foot", "case.toml", "mu_k = ", "mu = ", "foot: mu_k is missing"),
    "foot output": ("foot", "trials/*", "cop_x [m]", "cop_z [m]", "needs channel cop_x, which trial t01 lacks; it has"),
    "foot output's unit": ("foot", "trials/*", "cop_x [m]", "cop_x [N]", "needs cop_x in m, trial t01 gives N"),
    "foot input": ("foot", "trials/*", "pitch [rad]", "roll [rad]", "needs channel pitch, which trial t01 lacks"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_one_line_and_nothing_left(cases: dict[str, Path], tmp_path: Path, name: str) -> None:
    system, file, old, new, words = WRONG[name]
    folder = tmp_path / "case"
    files = [f"trials/{p.name}" for p in (cases[system] / "trials").iterdir()] if file == "trials/*" else [file]
    spoilt(cases[system], folder, files[0], old, new)
    for other in files[1:]:
        text = (folder / other).read_text(encoding="utf-8")
        (folder / other).write_text(text.replace(old, new), encoding="utf-8")
    line = refused(folder, tmp_path / "out")
    assert words in line and "case" in line


def rewritten(case: Path, trial: str, change: str) -> None:
    """Cells of a column emptied, or the trial cut short."""
    path = case / "trials" / f"{trial}.csv"
    head, *rows = path.read_text(encoding="utf-8").splitlines()
    cells = [row.split(",") for row in rows]
    if change == "short":
        cells = cells[:5]
    for row in cells[8:] if change == "most" else cells:
        for column in {"all": (1, 2), "beta": (1,), "most": (1,), "force": (2,)}.get(change, ()):
            row[column] = ""
    for row in cells:
        if change in ("still", "off"):
            row[1 if change == "still" else 2] = "0.5"
    path.write_text("\n".join([head, *(",".join(row) for row in cells)]) + "\n", encoding="utf-8")


@pytest.mark.parametrize(
    ("trials", "change", "words"),
    [
        (["t02"], "all", "t02.csv: every channel is empty in every row; delete the trial from case.toml"),
        (["t02"], "beta", "fails on trial t02: ValueError: input beta has no value in this trial"),
        (["t02"], "most", "case.toml trial t02: input beta has fewer than 20 measured values"),
        (["t01", "t02"], "force", "case.toml calibration: force has 0 measured values in the calibration trials"),
        (["t03", "t04"], "force", "case.toml evaluation: force has 0 measured values in the evaluation trials"),
        (["t01", "t02", "t03", "t04"], "force", "trials: column 'force' is empty in all trials"),
        (["t01", "t02"], "still", "case.toml calibration: no input changes in the calibration trials (beta); choose"),
        (["t01", "t02"], "off", "case.toml calibration: force never changes in the calibration trials; was the sensor"),
        (["t04"], "short", "case.toml trial t04: 5 samples; at least 20 are needed"),
    ],
)
def test_too_little_was_measured(
    cases: dict[str, Path], tmp_path: Path, trials: list[str], change: str, words: str
) -> None:
    folder = spoilt(cases["elbow"], tmp_path / "case", "case.toml", "format = 1", "format = 1")
    for name in trials:
        rewritten(folder, name, change)
    assert words in refused(folder, tmp_path / "out")


def test_a_copy_of_a_trial_is_refused(cases: dict[str, Path], tmp_path: Path) -> None:
    """What is held out would confirm anything that was fitted to it."""
    folder = spoilt(cases["elbow"], tmp_path / "case", "case.toml", "format = 1", "format = 1")
    (folder / "trials" / "t03.csv").write_bytes((folder / "trials" / "t01.csv").read_bytes())
    line = refused(folder, tmp_path / "out")
    assert line.endswith(
        "case.toml trial t03: force is the same as in trial t01, sample by sample; give each trial its own recording"
    )


def test_folders_that_are_none(cases: dict[str, Path], tmp_path: Path) -> None:
    assert "nowhere: there is no such folder; name the folder" in refused(tmp_path / "nowhere", tmp_path / "out")
    file = tmp_path / "case.toml"
    file.write_text(SETTINGS)
    assert "case.toml: is not a folder" in refused(file, tmp_path / "out")
    (tmp_path / "empty").mkdir()
    assert "case.toml: there is no such file" in refused(tmp_path / "empty", tmp_path / "out")
    assert "no sub-folder has a case.toml" in refused(tmp_path / "empty", tmp_path / "out", "--many")
    line = refused(cases["elbow"], tmp_path / "out", "--many")
    assert "no sub-folder has a case.toml; it is a case itself" in line


def test_an_out_that_is_a_file(cases: dict[str, Path], tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    assert "out: is a file; --out names a folder" in refused(cases["elbow"], tmp_path / "out")


def test_options_without_effect(cases: dict[str, Path], tmp_path: Path) -> None:
    assert "--workers: has no effect without --many; give --many" in refused(
        cases["elbow"], tmp_path / "out", "--workers", 2
    )
    line = refused(cases["elbow"].parent, tmp_path / "out", "--many", "--workers", 0)
    assert "--workers: 0 is less than one process; give 1 or more" in line


def test_many_wrong_cases_only(cases: dict[str, Path], tmp_path: Path) -> None:
    for name in "ab":
        spoilt(cases["elbow"], tmp_path / "cases" / name, "case.toml", "[constants]", "[constant]")
    result = call("gap", "diagnose", tmp_path / "cases", "--many", "--workers", 1, "--out", tmp_path / "out")
    assert (result.code, result.out) == (2, "")
    first, second, last = result.complaints
    assert "a/case.toml" in first and "b/case.toml" in second and "none of the 2 cases could be diagnosed" in last
    assert {p.name for p in tmp_path.iterdir()} == {"cases"}
