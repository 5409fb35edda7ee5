"""Calls from Python: help, arguments that fit no option, files that are not there."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

import geocontact as gc
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.marks import Missing
from geocontact.analyses.frame.options import declared
from geocontact.data.plausible import numbers_in
from tests.analyses.jobs import JOBS

TYPED = [
    pytest.param(one, id=f"{job.command}-{one.name}") for job in JOBS for one in declared(job.options) if one.typed
]
SAMPLES = Path(__file__).parents[2] / "meshes"


@pytest.mark.parametrize("one", TYPED)
def test_what_help_writes_is_a_value_of_the_option(one) -> None:
    value = eval(one.typed.python, {"gc": gc})
    assert one.coerced(value) == value and not isinstance(value, str)
    for _, known, number in numbers_in(one.range, value):
        known.require(number, one.name)


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.command)
def test_help_tells_every_argument_its_type_and_unit(job: Job) -> None:
    told = job.__doc__ or ""
    for one in declared(job.options):
        head = next((line for line in told.splitlines() if line.startswith(f"{one.name} : ")), "")
        assert bool(head) == one.settable
        assert not one.settable or one.typed is None or one.typed.si == "-" or f"[{one.typed.si}]" in head


def test_help_groups_what_belongs_together() -> None:
    lines = (gc.area.__doc__ or "").splitlines()
    headings = [above for above, line in pairwise(lines) if line and not line.strip("-")]
    assert len(headings) == len(set(headings)) > 5


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (
            lambda: gc.area("a.stl", thresholds=(4e-3,)),
            "area: there is no argument `thresholds` (did you mean `threshold`?); `fixed` and `unit` are missing",
        ),
        (
            lambda: gc.area("a.stl", "b.stl", "c", unit="mm"),
            "area: 3 arguments without a name, where only `moving` and `fixed` can do without",
        ),
        (lambda: gc.area("a.stl", "b.stl", moving="c.stl", unit="mm"), "area: `moving` is given twice"),
        (
            lambda: gc.misalignment.design(k=222.0, l=0.1, z=0.1, limit=5.0, rnage=(0.0, 1.0)),
            "elbow design: there is no argument `rnage` (did you mean `range`?); `range` is missing",
        ),
        (
            lambda: gc.inverse_kinematics("a.trc", model="a.osim", zzz=1),
            (
                "ik: there is no argument `zzz` (there are `tasks`, `follow`, `marker_set`, `markers_map`, `naming`, "
                "`model_setup`, `weight`, `hold`, `fill`, `calibration`, `heading`, `knee`, `joint_angles`, "
                "`events`, `part`, `analog`, `bids`, `axes`, `c3d_unit` and `time`)"
            ),
        ),
    ],
)
def test_wrong_arguments_are_named_in_one_line(call, said: str) -> None:
    with pytest.raises(TypeError) as refused:
        call()
    assert str(refused.value) == said


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda there: gc.area("no.stl", there, unit="mm", motion=there), "no.stl: there is no such file"),
        (lambda there: gc.area(there, there, unit="mm", motion="no.csv"), "no.csv: there is no such file"),
        (lambda there: gc.area(there, there, unit="mm", motion=(there, "no.csv")), "no.csv: there is no such file"),
        (lambda there: gc.inverse_kinematics(there, model="no.osim"), "no.osim: there is no such file; check the path"),
        (lambda there: gc.modulus(area=(there, "no.csv"), force=there, radius=0.03), "no.csv: there is no such file"),
        (
            lambda there: gc.diagnose("nothing"),
            "nothing: there is no such folder; name the folder that",
        ),
    ],
)
def test_a_file_that_is_not_there_is_said_before_others_are_read(tmp_path: Path, call, said: str) -> None:
    empty = tmp_path / "empty.stl"
    empty.touch()
    with pytest.raises(gc.InputError, match="there is no such") as refused:
        call(str(empty))
    assert str(refused.value).startswith(said)


def test_a_pattern_is_no_file() -> None:
    options = gc.area.options("a.stl", "b.stl", unit="mm", motion=("walk_*.csv", "run.csv"))
    assert [str(path) for path, _ in options.paths()] == ["a.stl", "b.stl", "run.csv"]


def test_a_name_that_no_file_can_have_is_left_to_who_opens_it() -> None:
    gc.modulus.options(area=("a\0b.csv",), force="c" * 5000, radius=0.03).refuse_missing_files()


def test_a_journal_may_be_new() -> None:
    options = next(job.options for job in JOBS if job.command == "gap benchmark")
    assert (Path("new.json"), Missing("")) in options(seed=1, journal="new.json").paths()
    options(seed=1, journal="new.json").refuse_missing_files()


@pytest.mark.parametrize(
    "words",
    [
        ["area", "no.stl", "no.stl", "--unit", "mm", "--motion", "no.csv"],
        ["ik", "no.trc", "--model", "no.osim"],
        ["gap", "diagnose", "nothing"],
    ],
)
def test_nothing_heavy_is_imported_to_say_that_a_file_is_missing(words: list[str]) -> None:
    program = (
        "import sys; from geocontact.cli.main import run; code = run(sys.argv[1:]); "
        "print(code, *({'numpy', 'scipy', 'numba', 'pandas'} & {name.partition('.')[0] for name in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", program, *words, "--out", "o"], capture_output=True, text=True)
    assert "there is no such" in done.stderr
    assert done.stdout.split() == ["2"]
