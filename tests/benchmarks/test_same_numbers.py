"""Numbers of two recordings compared apart from words and names; which differ, by how much, and why."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.same_outputs.comparing import Recording, compared
from benchmarks.same_outputs.numbers import (
    BYTE,
    DIFFERS,
    EQUAL,
    MEANT,
    Change,
    Meant,
    figures,
    files_compared,
    numbers_compared,
)
from benchmarks.same_outputs.numbers import compared as of_files
from benchmarks.same_outputs.recording import RUNS, runs

OUT = "fit/out"
NAMES = {"told": "identified", "sd believed [m]": "sd prior [m]"}


@pytest.fixture
def both(tmp_path: Path) -> tuple[Path, Path]:
    """Recordings of one run in two folders."""
    out = tmp_path / "before" / OUT
    out.mkdir(parents=True)
    (out.parent / "call.json").write_text(json.dumps({"arguments": ["fit"], "code": 0}))
    (out / "numbers.csv").write_text("number,told,sd believed [m],value\nheel,by itself,0.5,200\ntoe,in sums,0.25,-3\n")
    (out / "fit.json").write_text(json.dumps({"told": {"rms_mm": [0.5, 2.0]}, "words": "2 of 3", "seconds": 4}))
    (out / "ik.mot").write_text("ik\nnRows=2\nendheader\ntime\tknee\n0\t1.5\n0.1\t2.5\n")
    (out / "model.osim").write_text("<mass>2.5</mass><name>a1</name>")
    (out / "report.html").write_text("<p>7</p>")
    np.savez(out / "map.npz", distance=np.array([0.0, 1.0, np.nan]))
    shutil.copytree(tmp_path / "before", tmp_path / "after")
    for side in ("before", "after"):
        (tmp_path / side / "recording.json").write_text(json.dumps({"commit": side}))
    return tmp_path / "before", tmp_path / "after"


def replaced(name: str, old: str, new: str) -> Callable[[Path], None]:
    """Change a text in one file of a recording; it must be there."""

    def change(folder: Path) -> None:
        text = (folder / OUT / name).read_text("utf-8")
        assert old in text
        (folder / OUT / name).write_text(text.replace(old, new), encoding="utf-8")

    return change


SAME: dict[str, Callable[[Path], None]] = {
    "a renamed column": replaced("numbers.csv", "told,sd believed", "identified,sd prior"),
    "a word": replaced("numbers.csv", "by itself", "alone"),
    "a number written otherwise": replaced("numbers.csv", "-3\n", "-3.0\n"),
    "a new column": replaced("ik.mot", "knee\n0\t1.5\n0.1\t2.5", "knee\tankle\n0\t1.5\t8\n0.1\t2.5\t9"),
    "a new row": replaced("numbers.csv", "toe,", "arch,by itself,0.1,7\ntoe,"),
    "a renamed key": replaced("fit.json", '"told"', '"identified"'),
    "a sentence with a number": replaced("fit.json", "2 of 3", "3 of 3"),
    "a time that it took": replaced("fit.json", "4", "5"),
    "the head of a motion": replaced("ik.mot", "nRows=2", "nRows=2\ninDegrees=yes"),
    "a name in a model": replaced("model.osim", "a1", "a2"),
    "a page": replaced("report.html", "7", "8"),
}


@pytest.mark.parametrize("change", SAME.values(), ids=SAME.keys())
def test_words_and_names_are_no_difference(
    both: tuple[Path, Path], capsys: pytest.CaptureFixture[str], change: Callable[[Path], None]
) -> None:
    change(both[1])
    assert numbers_compared(*both, Meant(NAMES)) == 0
    assert "0 files differ without a reason" in capsys.readouterr().out


DIFFERENT: dict[str, tuple[Callable[[Path], None], str]] = {
    "a value": (replaced("numbers.csv", ",200", ",150"), "1 of 4 numbers differ, 0 are gone, 0 are new; at most 0.25"),
    "its place": (replaced("numbers.csv", ",200", ",150"), "value[0]: 200 → 150"),
    "a renamed and changed one": (
        replaced(
            "numbers.csv",
            "told,sd believed [m],value\nheel,by itself,0.5",
            "identified,sd prior [m],value\nheel,by itself,0.4",
        ),
        "sd prior [m][0]: 0.5 → 0.4",
    ),
    "a value among new rows": (
        replaced("numbers.csv", "toe,in sums,0.25,-3", "arch,a,1,7\ntoe,in sums,0.25,-4"),
        "value[toe]: -3 → -4",
    ),
    "a sign": (replaced("ik.mot", "\t2.5", "\t-2.5"), "at most 2 (2 of the column), knee[1]: 2.5 → -2.5"),
    "one that became a word": (replaced("numbers.csv", "0.25,-3", "0.25,none"), "0 of 4 numbers differ, 1 are gone"),
    "a column that is gone": (replaced("ik.mot", "knee", "hip"), "0 of 4 numbers differ, 2 are gone, 2 are new"),
    "a number of a result": (replaced("fit.json", "2.0", "2.5"), "told.rms_mm[1]: 2 → 2.5"),
    "one of a model": (replaced("model.osim", "2.5", "2.6"), "number[0]: 2.5 → 2.6"),
    "one that is none": (replaced("numbers.csv", ",200", ",nan"), "value[0]: 200 → nan"),
    "a file": (lambda folder: (folder / OUT / "fit.json").unlink(), f"{OUT}/fit.json: is missing"),
    "an array": (
        lambda folder: np.savez(folder / OUT / "map.npz", distance=np.array([0.0, 1.0, 4.0])),
        "distance[2]: nan → 4",
    ),
}


@pytest.mark.parametrize(("change", "said"), DIFFERENT.values(), ids=DIFFERENT.keys())
def test_a_number_that_differs_fails_and_is_named(
    both: tuple[Path, Path], capsys: pytest.CaptureFixture[str], change: Callable[[Path], None], said: str
) -> None:
    change(both[1])
    assert numbers_compared(*both, Meant(NAMES if "renamed" in said or "prior" in said else {})) == 1
    printed = capsys.readouterr().out
    assert said in printed and "1 files differ without a reason" in printed


def test_a_reason_is_said_and_holds_for_its_files_alone(
    both: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    meant = Meant(changes=[Change(("fit/*/ik.mot",), "abc1234", "the knee is mended")])
    replaced("ik.mot", "\t2.5", "\t2.6")(both[1])
    assert numbers_compared(*both, meant) == 0
    assert "abc1234: the knee is mended" in capsys.readouterr().out
    replaced("fit.json", "0.5", "0.6")(both[1])
    assert numbers_compared(*both, meant) == 1


def test_a_file_is_found_under_its_new_name(both: tuple[Path, Path]) -> None:
    (both[1] / OUT / "ik.mot").rename(both[1] / OUT / "pose.mot")
    assert numbers_compared(*both, Meant()) == 1
    assert numbers_compared(*both, Meant(files={f"{OUT}/ik.mot": f"{OUT}/pose.mot"})) == 0


def test_outcomes_of_files(both: tuple[Path, Path]) -> None:
    before, after = (folder / OUT / "numbers.csv" for folder in both)
    assert (of_files(before, after, Meant()).outcome, of_files(before, after, Meant()).numbers) == (BYTE, 4)
    replaced("numbers.csv", "by itself", "alone")(both[1])
    assert of_files(before, after, Meant()).outcome == EQUAL
    replaced("numbers.csv", "-3", "-3.0000001")(both[1])
    found = of_files(before, after, Meant())
    assert (found.outcome, found.different) == (DIFFERS, 1)
    np.testing.assert_allclose((found.largest, found.of_column), (1e-7 / 3, 1e-7 / 200), rtol=1e-6)


def test_what_is_kept_names_differences_and_runs_that_are_missing(both: tuple[Path, Path]) -> None:
    replaced("ik.mot", "\t2.5", "\t2.6")(both[1])
    old, new = map(Recording.of, both)
    files = files_compared(old, new, "fit", Meant(changes=[Change(("fit/*",), "abc1234", "mended")]))
    kept = figures({"fit": files}, {DIFFERS: 1})
    assert kept["outcomes"]["fit"]["outcome"] == DIFFERS
    assert kept["outcomes"]["fit"][BYTE] == len(files) - 1
    assert kept["outcomes"]["fit"]["differ"] == {
        f"{OUT}/ik.mot": {
            "numbers": 4,
            "different": 1,
            "gone": 0,
            "new": 0,
            "largest": 0.0385,
            "of_column": 0.04,
            "at": "knee[1]: 2.5 → 2.6",
            "why": ["abc1234: mended"],
        }
    }
    assert kept["not compared"] == list(runs(RUNS.read_text("utf-8")))


def test_it_is_no_wider_than_the_comparison_of_bytes(both: tuple[Path, Path]) -> None:
    """What the bytes do not tell apart, the numbers do not."""
    assert (compared(*both), numbers_compared(*both, Meant())) == (0, 0)


def test_what_was_meant_is_of_runs_that_are_there() -> None:
    meant, names = Meant.of(MEANT), set(runs(RUNS.read_text("utf-8")))
    assert meant.names
    for change in meant.changes:
        assert change.commit and change.why
    for file in [one for change in meant.changes for one in change.files]:
        run = file.partition("/")[0]
        assert run in names or "*" in run, file


def test_the_page_has_the_kept_comparison() -> None:
    """Runs without a difference and largest differences of the page are those of the results that are kept."""
    root = Path(__file__).parents[2]
    kept = json.loads((root / "benchmarks/results/same_numbers.json").read_text("utf-8"))
    figures, page = kept["figures"], (root / "docs/reference/accuracy.md").read_text("utf-8")
    counts, outcomes = figures["runs"], figures["outcomes"]
    assert not figures["not compared"]
    asked = kept["asked"]
    assert f"All {sum(counts.values()) - 1} runs of" in page and f"at {asked['before']} and {asked['after']} (" in page
    differ = {run: one["differ"] for run, one in outcomes.items() if one["outcome"] == DIFFERS}
    assert f"| {len(outcomes) - 1 - len(differ)} | none |" in page and "differ" not in outcomes["inputs"]
    assert all(each["why"] for files in differ.values() for each in files.values())
    most = {run: max(each.get("of_column") or 0.0 for each in files.values()) for run, files in differ.items()}
    shoulders = [f"shoulder_{name}" for name in ("simulate", "half", "study", "compare")]
    assert max(most[name] for name in shoulders) <= 2e-10 and most["shoulder_led"] <= 0.003
    areas = [name for name in most if name.startswith(("area", "cohort", "demo"))]
    assert len(areas) == 7
    for name in areas:
        for file in differ[name].values():
            assert file["largest"] <= 5.1e-12 or _apart(file) <= 2e-15
    gaps = {name for name in most if name.startswith("gap_")}
    moved = {"gap_joint", "gap_confuse_foot"}
    tied = "figures.elbow.regression"  # a peer whose two best are as good as each other
    for name in gaps - moved:
        for file in differ[name].values():
            little = (file.get("of_column") or 0.0) <= 3.1e-7 or _apart(file) <= 1e-16
            assert little or file["at"].startswith(tied), name
    assert len(gaps - moved) == 8
    standing = {name for name in most if name.startswith("standing_")}
    assert len(standing) == 5 and max(most[name] for name in standing - {"standing_predict"}) <= 0.04
    numbers = [
        file["of_column"]
        for name in standing
        for path, file in differ[name].items()
        if file.get("of_column") and not path.endswith(("certificate.csv", "run.json"))
    ]
    assert max(numbers) <= 5.4e-5
    rest = {"shoulder_led", "shoulder_optimise", "joint", "app", "thickness"}
    assert set(most) == {*shoulders, *areas, *gaps, *standing, *rest}


def _apart(file: Mapping[str, Any]) -> float:
    """Difference of the two numbers of a file that differ most, of themselves."""
    before, after = (float(part) for part in file["at"].rpartition(": ")[2].split(" → "))
    return abs(before - after)
