"""Stiffness and damping of five zones out of one stance's vertical load."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.keel_stance import LEVEL, Stance, stance
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of
from geocontact.below_knee_prosthesis.keel.vsf_foot import vsf_foot
from geocontact.below_knee_prosthesis.keel.zone_numbers import zone_numbers

STIFFNESS = {"heel_back": 12e3, "heel_middle": 18e3, "heel_front": 20e3, "midfoot": 11e3, "forefoot": 45e3}
DAMPING = {"heel_back": 200.0, "heel_middle": 400.0, "heel_front": 300.0, "midfoot": 250.0, "forefoot": 350.0}


@pytest.fixture(scope="module")
def one() -> Stance:
    return stance(vsf_foot(), fulcrum_of("medium"))


def test_planted_numbers_come_back(one: Stance) -> None:
    foot, fulcrum = vsf_foot(), fulcrum_of("medium")
    stiffness, damping = (np.array([each[z] for z in foot.sole.spheres.zone]) for each in (STIFFNESS, DAMPING))
    planted = replace(foot, law=replace(foot.law, stiffness=stiffness, damping=damping)).at(fulcrum)
    load = planted.solve(one.poses, LEVEL, rate=one.rate, time=one.time).force[:, 1]
    found = zone_numbers(foot.at(fulcrum), one.poses, one.rate, one.time, LEVEL, load)
    assert found.converged
    assert found.residual[0] > 20.0
    assert found.residual[-1] < 0.05
    assert found.stiffness == pytest.approx(STIFFNESS, rel=1e-3)
    assert found.damping == pytest.approx(DAMPING, rel=1e-3)


def test_a_zone_that_is_never_loaded_keeps_its_numbers(one: Stance) -> None:
    """The first quarter of a stance loads heel and midfoot only."""
    foot, fulcrum = vsf_foot(), fulcrum_of("medium")
    few = slice(0, 12)
    still = foot.at(fulcrum)
    load = still.solve(one.poses[few], LEVEL, rate=one.rate[few], time=one.time[few]).force[:, 1]
    softer = replace(still, law=replace(still.law, stiffness=0.9 * still.law.stiffness))
    found = zone_numbers(softer, one.poses[few], one.rate[few], one.time[few], LEVEL, load)
    assert found.stiffness["forefoot"] == pytest.approx(0.9 * still.law.stiffness[-1], rel=1e-12)
    assert found.damping["forefoot"] == still.law.damping[-1]
