"""Largest sizes that a listed system says are plausible, worked out from its trials by hand."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from geocontact.chain.system import System
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from tests.systems.examples import KNEE_CONSTANTS, SHOULDER_CONSTANTS, example

ANGLES = {("elbow", "beta"): 0.35, ("shoulder", "arm"): 0.35, ("foot", "pitch"): 0.15}
HALF_RANGES = {("foot", "y"): 0.16, ("knee", "area_medial"): 0.8, ("knee", "area_lateral"): 0.8}
HALF_RANGES |= {("sit_to_stand", f"{site}_normal"): 2.5 for site in ("pelvis", "thigh", "shank")}


@cache
def known(name: str) -> tuple[System, tuple[Trial, ...]]:
    return example(name)


@cache
def largest(name: str) -> dict[str, tuple[float, str]]:
    """Upper bound and unit of every amplitude by the candidate's label."""
    some = [one for one in candidates(known(name)[0]) if one.parameters]
    return {one.label: (one.parameters[0].upper, one.parameters[0].unit) for one in some}


def column(name: str, channel: str) -> np.ndarray:
    return np.concatenate([trial.column(channel) for trial in known(name)[1]])


@pytest.mark.parametrize("name", ["elbow", "foot", "shoulder", "knee", "sit_to_stand"])
def test_bias_of_an_input(name: str) -> None:
    expected = {one: most for (system, one), most in ANGLES.items() if system == name}
    for (system, one), most in HALF_RANGES.items():
        if system == name:
            expected[one] = most * 0.5 * np.ptp(column(name, one))
    found = {
        label.removeprefix("motion_offset."): most for label, (most, _) in largest(name).items() if "motion" in label
    }
    assert found == pytest.approx(expected, rel=5e-2)  # inputs are smoothed before their range is taken


def test_spring_in_series() -> None:
    """0.4 rad of the elbow, thrice the deflection of sole and cuff, a strap's once, at the largest load."""
    per_load = {}
    for name, load in (("elbow", "force"), ("foot", "force_y"), ("shoulder", "force")):
        most, unit = largest(name)["series_compliance"]
        per_load[name] = most * np.nanmax(np.abs(column(name, load))), unit
    assert per_load["elbow"] == (pytest.approx(0.4, rel=1e-12), "rad/N")
    for name in ("foot", "shoulder"):
        assert per_load[name] == (pytest.approx(3.0 * known(name)[0].scale.deflection, rel=1e-12), "m/N")
    strap = known("sit_to_stand")[0].at("thigh").scale
    most, unit = largest("sit_to_stand")["series_compliance.thigh"]
    assert (most * np.abs(column("sit_to_stand", "thigh_force")).max(), unit) == (
        pytest.approx(strap.deflection, rel=1e-12),
        "m/N",
    )


def test_axis_that_moves() -> None:
    lengths = {"elbow": 0.3 * 0.185, "shoulder": 0.2 * SHOULDER_CONSTANTS["L_h"], "knee": 2.0 * KNEE_CONSTANTS["R"]}
    assert {name: largest(name)["axis_migration"][0] for name in lengths} == pytest.approx(lengths, rel=1e-12)
    lever, half = 0.15, 0.5 * np.ptp(column("sit_to_stand", "thigh_rotation"))
    assert largest("sit_to_stand")["axis_migration.thigh"][0] == pytest.approx(lever / half, rel=5e-2)
