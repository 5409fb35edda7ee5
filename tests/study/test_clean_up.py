"""What is cleared is what no description asks for, and nothing else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from geocontact.study.clean_up import ASKED, clear, not_asked_for, note_asked
from geocontact.study.description import StudyFile, read_study_file
from geocontact.study.store import REPORT, Store
from tests.cli.calls import Call, call
from tests.study.chained import NUMBERS, chain


def cohort(file: Path, out: Path, scheduler: str, *more: str) -> Call:
    return call("cohort", file, "--run-simulator", "--scheduler", scheduler, "--out", out, *more, folder=out)


def results(out: Path) -> set[str]:
    return {each.parent.name for each in out.glob(f"results/*/{REPORT}")}


@pytest.fixture
def store(tmp_path: Path) -> Store:
    """Four results and the logs of two trials that failed."""
    found = Store(tmp_path / "out" / "results")
    for k in range(4):
        found.place(f"{k}" * 32).mkdir(parents=True)
        (found.place(f"{k}" * 32) / REPORT).write_text("{}", encoding="utf-8")
    for k in (4, 5):
        found.write_log(f"{k}" * 32, "Traceback")
    return found


def described(folder: Path, name: str, home: Path | None = None) -> StudyFile:
    (folder / name).write_text('analysis = "area"\n', encoding="utf-8")
    return read_study_file(folder / name, home)


def addresses(*numbers: int) -> list[str]:
    return [f"{k}" * 32 for k in numbers]


def test_what_one_asked_for_stays_where_its_next_run_knows_less(tmp_path: Path, store: Store) -> None:
    """Evaluations without an address may be those of earlier runs; where all have one, the list is theirs."""
    one, other = described(tmp_path, "one.toml"), described(tmp_path, "other.toml")
    note_asked(store, one, addresses(0, 1))
    note_asked(store, one, [*addresses(0), ""])
    assert [*not_asked_for(store, other, addresses(2))] == addresses(3)
    note_asked(store, one, addresses(0))
    assert [*not_asked_for(store, other, addresses(2))] == addresses(1, 3)


def test_a_description_of_two_folders_asks_twice(tmp_path: Path, store: Store) -> None:
    first, second = (described(tmp_path, "study.toml", tmp_path / each) for each in ("d1", "d2"))
    plain = described(tmp_path, "study.toml")
    for k, each in enumerate((first, second, plain)):
        note_asked(store, each, addresses(k))
    assert {*json.loads((store.folder / ASKED).read_text("utf-8"))} == {
        "../../study.toml",
        "../../study.toml from ../../d1",
        "../../study.toml from ../../d2",
    }
    assert [*not_asked_for(store, second, addresses(1))] == addresses(3)
    plain.path.unlink()
    assert [*not_asked_for(store, second, addresses(1))] == addresses(0, 2, 3)


def test_logs_that_nobody_asks_for_go_too(tmp_path: Path, store: Store) -> None:
    one, other = described(tmp_path, "one.toml"), described(tmp_path, "other.toml")
    note_asked(store, one, addresses(0, 4))
    assert [*clear(store, other, addresses(1, 2))] == addresses(3)
    assert store.addresses() == addresses(0, 1, 2) and store.logs() == addresses(4)


def test_the_results_of_a_study_with_a_broken_file_outlive_the_clean_up_of_another(
    tmp_path: Path, scheduler: str
) -> None:
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    assert cohort(file, out, scheduler).code == 0
    whole = results(out)
    (tmp_path / "B_still.txt").write_text("wrong", encoding="utf-8")
    assert cohort(file, out, scheduler).code == 2
    other = tmp_path / "other.toml"
    other.write_text(
        'analysis = "tests.study.chained:add"\n[options]\nfiles = ["A_1.txt", "A_2.txt"]\n', encoding="utf-8"
    )
    cleaned = cohort(other, out, scheduler, "--clean-up")
    assert cleaned.code == 0 and "removed what no description asks for: 0 results" in cleaned.out, cleaned.err
    assert results(out) > whole
