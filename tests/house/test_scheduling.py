"""How tests are dealt out to several processes."""

from __future__ import annotations

from pathlib import Path

from tests.scheduling import ONE_BY_ONE, ROOT, FileByFile, lasting_first


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
