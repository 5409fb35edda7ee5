"""A study that is killed, or loses a worker, comes to the same tables; long: benchmarks/cohort_kills.py."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from benchmarks.cohort_kills import disturb, prepare


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.slow
@pytest.mark.long
def test_tables_after_kills_are_those_of_an_undisturbed_run(tmp_path: Path) -> None:
    found = disturb(prepare(tmp_path, 6), tmp_path, 3, seed=11)
    assert sum(found.kills.values()) == 3 and found.ended >= 1
    assert (found.different, found.left_running) == (0, 0), found
