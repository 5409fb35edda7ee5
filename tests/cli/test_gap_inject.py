"""`geocontact gap inject`, also `gap plant`: what it writes, and what it refuses. All trials are synthetic."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.calls import Call, call, done, inventory
from tests.cli.gap_cases import damped_elbow, known
from tests.unchecked import unchecked


def plant(case: Path, out: Path, *options: object) -> Call:
    return call("gap", "plant", case, "--bare", "--out", out, *options)


def test_the_case_its_diagnosis_and_the_answer_are_written(tmp_path: Path) -> None:
    case, out = damped_elbow(tmp_path / "elbow", damping=0.0), tmp_path / "out"
    with known(), unchecked():
        said = done(call("gap", "inject", case, "--out", out, "--effect", "damping", "--value", "damping.b=12.5"))
    names = set(inventory(out))
    trials = {f"case/trials/{name}.csv" for name in ("t01", "t02", "t03", "t04")}
    assert {"planted.json", "run.json", "case/case.toml", "diagnosis/report.html", *trials} <= names
    told = json.loads((out / "run.json").read_text("utf-8"))
    assert told["command"] == "gap plant" and told["options"]["value"] == ["damping.b=12.5"]
    assert told["results"]["planted"] == json.loads((out / "planted.json").read_text("utf-8"))
    inner = json.loads((out / "diagnosis" / "run.json").read_text("utf-8"))
    assert inner["options"] == {"case": str(out / "case"), "out": str(out / "diagnosis"), "bare": False}
    assert all(Path(entry["file"]).is_file() for entry in inner["inputs"])
    assert said.out.startswith(
        "injected damping (damping.b = 12.5 N s/m, damping.exponent = 1); it makes a gap of 4.8 times"
    )


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            ("--effect", "rust"),
            "--effect: 'rust' is not an effect of this system; there are time_shift, clock_slip, filter_lag",
        ),
        (("--effect", "unit_error"), "--effect: unit_error has variants; choose one of unit_error.force"),
        (
            ("--effect", "damping", "--value", "b=1"),
            "--value: 'b' is not a parameter of damping; parameters: damping.b",
        ),
        (("--effect", "damping", "--value", "damping.b=x"), "--value: 'x' is not a number; write damping.b=1.5"),
        (("--effect", "damping", "--value", "damping.b=-1"), "--value: damping.b = -1 N s/m is outside of 0 …"),
        (("--effect", "damping", "--trial", "t01"), "--trial: damping is in every trial or in none; leave it out"),
        (("--effect", "sign_flip.beta", "--trial", "t9"), "--trial: there is no trial 't9'; trials are t0"),
        (("--effect", "damping", "--size", "0"), "--size: 0 is not a gap above 0; give for example 1"),
    ],
)
def test_what_cannot_be_planted_is_one_line(tmp_path: Path, options: tuple[str, ...], message: str) -> None:
    case = damped_elbow(tmp_path / "elbow", samples=60)
    made = plant(case, tmp_path / "out", *options)
    assert made.code == 2 and len(made.complaints) == 1 and message in made.err
    assert not (tmp_path / "out").exists()


def test_results_do_not_go_into_the_case_they_copy(tmp_path: Path) -> None:
    case = damped_elbow(tmp_path / "elbow", samples=60)
    for out in (case / "out", case):
        made = plant(case, out, "--effect", "damping")
        assert made.code == 2 and "lies inside the case that is copied there" in made.err
    assert not (case / "out").exists()
