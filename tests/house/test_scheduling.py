"""How tests are dealt out to several processes."""

from __future__ import annotations

from pathlib import Path

from tests.scheduling import ONE_BY_ONE, ROOT, FileByFile, lasting_first, run_before


def test_lasting_tests_go_to_any_process_and_others_by_file() -> None:
    assert all((ROOT / file).is_file() for file in ONE_BY_ONE)
    by = object.__new__(FileByFile)
    lasting = [f"{ONE_BY_ONE[0]}::test_page[{k}]" for k in range(3)]
    assert [by._split_scope(each) for each in lasting] == lasting
    assert {by._split_scope(f"tests/gap/test_hidden.py::test_{k}") for k in "ab"} == {"tests/gap/test_hidden.py"}


def test_what_lasts_comes_first() -> None:
    slow, fast = ROOT / "tests/gap/test_hidden.py", ROOT / "tests/gap/test_verdict.py"
    files: list[Path] = [fast, slow, *(ROOT / file for file in ONE_BY_ONE)]
    found = sorted(files, key=lambda path: lasting_first({slow, *files[2:]}, path))
    assert found == [*files[2:], slow, fast]


def test_only_quick_tests_of_the_rooms_that_were_checked_were_run_before() -> None:
    rooms = frozenset({"loads", "house/test_wheel.py"})
    files = ("loads/mat/test_map.py", "house/test_wheel.py", "house/test_portable.py", "view/loads/test_x.py")
    assert [run_before(ROOT / "tests" / file, False, rooms) for file in files] == [True, True, False, False]
    assert not run_before(ROOT / "tests" / files[0], True, rooms), "slow tests are not among those with checks"
