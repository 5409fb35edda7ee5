"""A result that contradicts its data beside inputs that contradict each other: the input is the cause, exit code 2."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from geocontact.analyses.frame.collector import collecting, judge, reserve
from geocontact.analyses.frame.record import Record
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit
from tests.cli.calls import Call, call
from tests.trial_checks.test_commands import LOADED, leg_files

OFF = GoodnessOfFit((Doubt("force: R² is -3", True),), ("force",))


def moved(folder: Path, damage: str) -> Call:
    leg_files(folder)
    LOADED[damage](folder)
    out = folder / "out"
    asked = ("--model", folder / "leg.osim", "--loads", folder / "loads.xml")
    return call("id", folder / "swing.mot", *asked, "--out", out, folder=out)


@pytest.mark.parametrize(
    ("damage", "code", "cause"),
    [
        ("axes of the plate exchanged", 2, "force along the floor is"),
        ("torque in N mm", 2, "its free moment is"),
        ("a jump of an angle", 1, ""),
    ],
)
def test_the_command_ends_with_2_where_its_inputs_are_the_cause(
    damage: str, code: int, cause: str, tmp_path: Path
) -> None:
    """Its first sentence says so, and all is written; a jump of one frame is no cause of half of the motion."""
    done = moved(tmp_path, damage)
    first, fit = done.out.splitlines()[0], json.loads((tmp_path / "out" / "run.json").read_text("utf-8"))["fit"]
    assert done.code == code and first.startswith("the result contradicts its data")
    assert ("its inputs contradict each other" in first) == bool(cause)
    assert bool(cause) == any(cause in line for line in fit.get("inputs contradict", []))
    assert (tmp_path / "out" / "report.html").is_file()


def test_what_fits_has_no_cause() -> None:
    """Inputs that contradict each other are a warning; only beside a result that does, they are its cause."""
    with collecting(Record("test", {})) as record:
        reserve("a: is 2 m, b: is 3 m", cause=True)
        judge(GoodnessOfFit((), ("force",)))
        assert record.causes == record.warnings and not record.judged
        judge(OFF)
        assert record.judged.endswith("its inputs contradict each other: a: is 2 m, b: is 3 m")


@pytest.mark.slow
@pytest.mark.parametrize(("damage", "code"), [("axes of the plate exchanged", 2), ("a jump of an angle", 1)])
def test_a_study_ends_as_its_trials_do(damage: str, code: int, tmp_path: Path) -> None:
    leg_files(tmp_path)
    LOADED[damage](tmp_path)
    (tmp_path / "study.toml").write_text(
        'analysis = "id"\n[options]\nmodel = "leg.osim"\nloads = "loads.xml"\n[sweep]\ncoordinates = ["swing.mot"]\n',
        encoding="utf-8",
    )
    done = call("cohort", tmp_path / "study.toml", "--out", tmp_path / "out", folder=tmp_path / "out")
    assert done.code == code, done.err
