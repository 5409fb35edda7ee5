"""Two recordings compared: what must agree, what is left out, what is only told; and the table of runs."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from benchmarks.page_pictures.kinds import EVERY, KINDS
from benchmarks.same_outputs.comparing import compared
from benchmarks.same_outputs.inputs import make
from benchmarks.same_outputs.recording import ROOT, RUNS, first_run, runs, wanted
from geocontact.analyses.catalogue import ENTRIES
from geocontact.cli.main import OWN

RUN = {
    "geocontact": "0.1.0",
    "options": {"unit": "mm", "threshold": "4"},
    "inputs": [{"role": "moving", "sha256": "ab"}],
    "versions": {"numpy": "2.4.6"},
    "seconds": 1.25,
    "files": ["area.csv", "run.json"],
    "sha256": {"report.html": "cd"},
}


@pytest.fixture
def both(tmp_path: Path) -> tuple[Path, Path]:
    """Recordings of one run in two folders; a table, JSON, a motion, arrays, a page, and what was said."""
    before = tmp_path / "before"
    out = before / "area_split" / "out"
    out.mkdir(parents=True)
    write(before / "recording.json", {"folder": str(before), "checkout": "/old"})
    write(before / "inputs" / "gait.csv", "time [s]\n0\n")
    write(out.parent / "call.json", {"arguments": ["area"], "code": 0})
    write(out.parent / "stdout.txt", f"results in {before}/out\n")
    write(out / "area.csv", "time [s],area_fixed [mm^2]\n0,2310.5\n0.1,2275\n")
    write(out / "cases.csv", "case,brier [-],cpu [s],wall [s],words\na,0.5,1.25,2.5,told\n")
    write(out / "run.json", RUN)
    sides = [{"seconds": 3, "rms_mm": 1e-3, "file": "out/.geocontact-0123456789abcdef/x.toml"}]
    sides += [{"page": f"results/{'0a' * 16}/report.html"}]
    write(out / "fit.json", {"radius_mm": 37.0, "sides": sides})
    write(out.parent / "said.md", "Seed 7, 2026-11-24, 5 cases\n9 seconds of one core per case\n")
    write(out / "ik.mot", "ik\nendheader\ntime\tknee\n0\t1.5\n")
    write(out / "report.html", "<p>one</p>")
    np.savez(out / "distances.npz", distance=np.arange(3.0))
    shutil.copytree(before, tmp_path / "after")
    write(tmp_path / "after" / "recording.json", {"folder": str(tmp_path / "after"), "checkout": "/new"})
    write(tmp_path / "after" / "area_split" / "stdout.txt", f"results in {tmp_path / 'after'}/out\n")
    return before, tmp_path / "after"


def write(file: Path, content: object) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(content if isinstance(content, str) else json.dumps(content, indent=1), encoding="utf-8")


def replaced(name: str, old: str, new: str) -> Callable[[Path], None]:
    """Change a text in one file of a recording; it must be there."""

    def change(folder: Path) -> None:
        text = (folder / name).read_text("utf-8")
        assert old in text
        (folder / name).write_text(text.replace(old, new), encoding="utf-8")

    return change


def test_equal_recordings_agree(both: tuple[Path, Path], capsys: pytest.CaptureFixture[str]) -> None:
    """The folders' own names in a text are no difference."""
    assert compared(*both) == 0
    said = capsys.readouterr().out.splitlines()
    assert said == ["same inputs: 1 files", "same area_split: 10 files", "2 runs, 11 files compared; 0 runs differ"]


OUT = "area_split/out"
FAILURES: dict[str, tuple[Callable[[Path], None], str]] = {
    "a byte of a table": (replaced(f"{OUT}/area.csv", "2275", "2276"), f"{OUT}/area.csv: differs in line 3"),
    "a column": (replaced(f"{OUT}/cases.csv", "0.5,1.25", "0.6,1.25"), f"{OUT}/cases.csv: differs in line 2"),
    "a number": (replaced(f"{OUT}/fit.json", "0.001", "0.0010"), f"{OUT}/fit.json: differs in line 5"),
    "a motion": (replaced(f"{OUT}/ik.mot", "1.5", "1.50"), f"{OUT}/ik.mot: differs in line 4"),
    "an option": (replaced(f"{OUT}/run.json", '"4"', '"5"'), f"{OUT}/run.json: differs in line 4"),
    "a key of a result": (replaced(f"{OUT}/fit.json", '"rms_mm"', '"x": 1, "rms_mm"'), f"{OUT}/fit.json: differs"),
    "a key of run.json is gone": (replaced(f"{OUT}/run.json", '"role": "moving",', ""), f"{OUT}/run.json: differs"),
    "an array": (
        lambda folder: np.savez(folder / OUT / "distances.npz", distance=np.array([0.0, 1.0, 2.5])),
        f"{OUT}/distances.npz: differs in line 1",
    ),
    "a file is gone": (lambda folder: (folder / OUT / "ik.mot").unlink(), f"{OUT}/ik.mot: is missing"),
    "the exit code": (replaced("area_split/call.json", '"code": 0', '"code": 2'), "area_split/call.json: differs"),
    "the whole run": (lambda folder: shutil.rmtree(folder / "area_split"), "area_split/call.json: is missing"),
    "the digest of an input": (replaced(f"{OUT}/run.json", '"ab"', '"ac"'), f"{OUT}/run.json: differs"),
    "an input": (replaced("inputs/gait.csv", "0\n", "1\n"), "inputs/gait.csv: differs in line 2"),
}


@pytest.mark.parametrize(("change", "said"), FAILURES.values(), ids=FAILURES.keys())
def test_a_difference_fails_and_names_the_place(
    both: tuple[Path, Path], capsys: pytest.CaptureFixture[str], change: Callable[[Path], None], said: str
) -> None:
    change(both[1])
    assert compared(*both) == 1
    printed = capsys.readouterr().out
    assert said in printed and "1 runs differ" in printed


NOTES: dict[str, tuple[Callable[[Path], None], str]] = {
    "seconds": (replaced(f"{OUT}/run.json", "1.25", "9.75"), ""),
    "versions": (replaced(f"{OUT}/run.json", "2.4.6", "2.5.0"), ""),
    "seconds in a result": (replaced(f"{OUT}/fit.json", '"seconds": 3', '"seconds": 4'), ""),
    "the time that cases took": (replaced(f"{OUT}/cases.csv", "1.25,2.5", "1.5,2.75"), ""),
    "a new key": (replaced(f"{OUT}/run.json", '"unit"', '"argv": ["x"], "si": 1, "unit"'), "new keys options.si"),
    "dates and loads in words": (replaced("area_split/said.md", "Seed 7, 2026", "Seed 7, 2027"), "0 runs differ"),
    "names that are drawn": (replaced(f"{OUT}/fit.json", "0123456789abcdef", "f" * 16), "0 runs differ"),
    "where a study's trials lie": (replaced(f"{OUT}/fit.json", "0a" * 16, "0b" * 16), "0 runs differ"),
    "the digest of a page": (replaced(f"{OUT}/run.json", '"cd"', '"ce"'), "0 runs differ"),
    "words": (replaced("area_split/stdout.txt", "results", "tables"), "stdout.txt: words differ in line 1"),
    "a page": (replaced(f"{OUT}/report.html", "one", "two"), f"{OUT}/report.html: differs"),
    "a new file": (lambda folder: write(folder / OUT / "more.csv", "a\n"), f"{OUT}/more.csv: new file"),
    "a new run": (lambda folder: write(folder / "cop" / "call.json", {}), "new run cop"),
}


@pytest.mark.parametrize(("change", "said"), NOTES.values(), ids=NOTES.keys())
def test_what_may_differ_is_left_out_or_told(
    both: tuple[Path, Path], capsys: pytest.CaptureFixture[str], change: Callable[[Path], None], said: str
) -> None:
    change(both[1])
    assert compared(*both) == 0
    assert said in capsys.readouterr().out


def test_further_keys_may_be_left_out(both: tuple[Path, Path]) -> None:
    replaced(f"{OUT}/run.json", '"4"', '"0.004"')(both[1])
    assert (compared(*both), compared(*both, ("threshold",))) == (1, 0)


def test_an_empty_folder_is_no_recording(tmp_path: Path) -> None:
    assert compared(tmp_path, tmp_path) == 1


def test_runs_come_after_those_that_they_read() -> None:
    text = "late: cop a.csv --motion=early/out/b.csv\nearly [first]: fit a.stl\n    --unit mm\nfirst: mat c.csv\n"
    every = runs(text)
    assert list(every) == ["first", "early", "late"]
    assert every["early"].arguments == ("fit", "a.stl", "--unit", "mm", "--out", "early/out")
    assert [run.name for run in wanted(every, ["early"])] == ["first", "early"]


def test_every_command_is_run() -> None:
    every = runs(RUNS.read_text("utf-8")).values()
    typed = [entry for entry in ENTRIES if entry.command]
    assert [entry.command for entry in typed if not first_run(every, entry)] == []
    assert set(OWN) <= {run.arguments[0] for run in every}


def test_runs_are_of_commands_that_are_there() -> None:
    for run in runs(RUNS.read_text("utf-8")).values():
        known = run.arguments[0] in (*OWN, "--help") or any(entry.calls(run.arguments) for entry in ENTRIES)
        assert known, run.name


def test_a_page_of_every_kind_is_of_a_run() -> None:
    assert set(KINDS.values()) <= set(EVERY)
    assert (KINDS["area"], KINDS["sit_to_stand_predict"], KINDS["cop"]) == (
        "area_split",
        "standing_predict",
        "cop_compare",
    )


def test_inputs_are_there_and_the_same_each_time(tmp_path: Path) -> None:
    folders = [tmp_path / name for name in ("one", "two")]
    for folder in folders:
        make(folder / "inputs", ROOT / "meshes")
    one, two = ({p.relative_to(f): p.read_bytes() for p in f.rglob("*") if p.is_file()} for f in folders)
    assert one == two
    words = {word for run in runs(RUNS.read_text("utf-8")).values() for word in run.arguments}
    named = {word.rpartition("=")[2].partition(":")[0] for word in words}
    missing = {word for word in named if word.startswith("inputs/") and not (folders[0] / word).exists()}
    assert missing == {"inputs/meshes/no.stl"}
