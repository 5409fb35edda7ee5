"""How tests are dealt out to several processes: file by file, and one by one where each lasts and shares nothing."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from xdist.scheduler import LoadScopeScheduling

ROOT = Path(__file__).resolve().parents[1]
ONE_BY_ONE = ("tests/house/test_command_lines.py", "tests/notebooks/test_notebooks.py")
"""Files whose tests last longest. Their tests come first: what lasts and comes last keeps one process busy alone."""


ONE_BY_ONE_FILES = frozenset(ROOT / each for each in ONE_BY_ONE)


class FileByFile(LoadScopeScheduling):
    """Tests of a file go to one process, which makes its fixtures once; those of ONE_BY_ONE go to any."""

    def _split_scope(self, nodeid: str) -> str:
        return nodeid if nodeid.partition("::")[0] in ONE_BY_ONE else super()._split_scope(nodeid)


def run_before(path: Path, slow: bool, rooms: frozenset[str]) -> bool:
    """Whether a test was run with shapes checked: quick, in one of these folders or files below tests."""
    return not slow and not rooms.isdisjoint(_places(path))


@cache
def _places(path: Path) -> frozenset[str]:
    """A file of tests and the folders that it lies in, from the folder of tests; found once for all tests of a file."""
    below = path.relative_to(ROOT / "tests")
    return frozenset(each.as_posix() for each in (below, *below.parents))


def lasting_first(slow: set[Path], path: Path) -> tuple[bool, bool]:
    """What a file is sorted by: slow ones come first, and of these the ones dealt out one by one."""
    return path not in slow, path not in ONE_BY_ONE_FILES
