"""Some of the faults of a machine, the quickest ones; all of them: benchmarks/robustness/faults.py."""

from __future__ import annotations

import sys

import pytest


@pytest.mark.skipif(sys.platform != "linux", reason="read-only folders and locales of Linux")
@pytest.mark.slow
@pytest.mark.long
def test_a_machine_with_a_fault_gives_the_same_tables_or_one_line() -> None:
    from benchmarks.robustness.faults import run

    found = run(["decimal commas", "another time zone", "another order of sets", "the folder is read-only"])
    assert len(found) == 5 and all(each["right"] for each in found.values()), found
