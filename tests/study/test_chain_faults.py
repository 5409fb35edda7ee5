"""A study of three steps mends what was damaged, and nothing else; faults of the machine: benchmarks/robustness."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.robustness.chain_faults import FAULTS, Measured, finished_study, outcome, typed_here


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory, scheduler: str) -> Path:
    """Two subjects with all results."""
    return finished_study(tmp_path_factory.mktemp("finished"), lambda file, out: typed_here(file, out, scheduler))


@pytest.mark.parametrize("fault", [name for name, one in FAULTS.items() if one.damage is not None])
def test_tables_are_those_of_a_study_without_a_fault(
    tmp_path: Path, finished: Path, scheduler: str, fault: str
) -> None:
    """Exactly the evaluations whose results were damaged are new, and all tables equal to the byte."""

    def typed(file: Path, out: Path) -> Measured:
        return typed_here(file, out, scheduler)

    found = outcome(FAULTS[fault], finished, tmp_path, typed)
    assert found["right"], found
