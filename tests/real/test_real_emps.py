"""A linear drive whose dry friction is known, and withheld from its model: recorded at 1 kHz, diagnosed as it came."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import emps
from geocontact.data.gap.diagnosis import Diagnosis
from tests.elsewhere import Elsewhere


@pytest.fixture(scope="module")
def emps_dir(data_dir: Path) -> Path:
    if not (data_dir / "emps").is_dir():
        pytest.skip(f"no EMPS recording in {data_dir}")
    return data_dir


@pytest.mark.slow
def test_friction_that_is_withheld_is_named(emps_dir: Path, elsewhere: Elsewhere) -> None:
    found: Diagnosis = elsewhere(emps.said, emps_dir, rubbing=False)
    assert found.effects == ("dry_friction",)
    assert found.gap["force"].rmse_after < 0.65 * found.gap["force"].rmse_before
    (limit,) = [one for name, one in found.parameters.items() if name.endswith(".limit")]
    assert 0.6 * emps.COULOMB < limit.value < 1.2 * emps.COULOMB, "too low: slow noise takes its share of each reversal"


@pytest.mark.slow
def test_nothing_is_named_where_the_base_has_friction(emps_dir: Path, elsewhere: Elsewhere) -> None:
    """Two or three newtons repeat from cycle to cycle, which no effect of the table explains."""
    found: Diagnosis = elsewhere(emps.said, emps_dir, rubbing=True)
    assert found.effects == ()
