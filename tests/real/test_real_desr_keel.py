"""Loops of a prosthetic ankle by the keel's beam theory beside the base model, at settings that were not fitted to."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from benchmarks.devices import desr
from benchmarks.devices.desr_keel import compared

BETWEEN, BEYOND = ("x10", "x25", "x35"), "x45"
SLOPE, WORK = "stiffness over that of the setting alone, less 1", "work measured, simulated [J]"


@pytest.fixture(scope="module")
def found(data_dir: Path) -> dict[str, Any]:
    file = data_dir / desr.FILE
    if not file.is_file():
        pytest.skip(f"no real data: {file} is absent")
    return compared(file, ("none", "dry_friction.stroke"))


@pytest.mark.parametrize("support", ["pinned", "clamped"])
def test_stiffness_between_settings_is_predicted_better_than_by_a_growth(found: dict[str, Any], support: str) -> None:
    """Within 3.5 % where the base model with as many numbers is off by up to 5.3 %; beyond them it is the other way."""
    keel, base = (found[f"{name}; none"]["predicted"][SLOPE] for name in (f"keel, {support}", "elastic_joint"))
    worst = {name: max(abs(each[setting]) for setting in BETWEEN) for name, each in (("keel", keel), ("base", base))}
    assert worst["keel"] < 0.035
    assert worst["keel"] < 0.7 * worst["base"]
    assert abs(keel[BEYOND]) < 0.06


@pytest.mark.parametrize("support", ["pinned", "clamped"])
def test_friction_that_grows_with_the_stiffness_predicts_the_loops_work_better(
    found: dict[str, Any], support: str
) -> None:
    """Neither crosses itself as the loops do, whose foot changes cams; so the torque gains a few per cent only."""
    keel, base = (found[f"{name}; dry_friction.stroke"]["predicted"] for name in (f"keel, {support}", "elastic_joint"))
    missed = [sum(abs(two - one) for one, two in each[WORK].values()) for each in (keel, base)]
    assert missed[0] < 0.6 * missed[1]
    assert keel["rmse [N m]"] < base["rmse [N m]"]
