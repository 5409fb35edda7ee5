"""A linear drive whose dry friction is known, and withheld from its model: recorded at 1 kHz, diagnosed as it came."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.devices import emps
from geocontact.data.diagnosis import Diagnosis
from tests.elsewhere import Elsewhere


@pytest.fixture(scope="module")
def emps_dir(data_dir: Path) -> Path:
    if not (data_dir / "emps").is_dir():
        pytest.skip(f"no EMPS recording in {data_dir}")
    return data_dir


@pytest.fixture(scope="module")
def withheld(emps_dir: Path, elsewhere: Elsewhere) -> Diagnosis:
    """Of a base without friction."""
    found: Diagnosis = elsewhere(emps.said, emps_dir, rubbing=False)
    return found


@pytest.mark.slow
def test_friction_that_is_withheld_is_named(withheld: Diagnosis) -> None:
    assert withheld.effects == ("dry_friction",)
    assert withheld.gap["force"].rmse_after < 0.65 * withheld.gap["force"].rmse_before


@pytest.mark.slow
def test_its_limit_is_that_of_the_drive(withheld: Diagnosis) -> None:
    (limit,) = [one for name, one in withheld.parameters.items() if name.endswith(".limit")]
    assert limit.value == pytest.approx(emps.COULOMB, rel=0.2)


@pytest.mark.slow
def test_nothing_is_named_where_the_base_has_friction(emps_dir: Path, elsewhere: Elsewhere) -> None:
    """Two or three newtons repeat from cycle to cycle, which no effect of the table explains."""
    found: Diagnosis = elsewhere(emps.said, emps_dir, rubbing=True)
    assert found.effects == ()
