"""Forces are linear in stiffness and damping at held depths; zone numbers go into a law and come back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.calibration.calibrate import bounded_fit, linear_rows
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.calibration.stances import FACTORS, planted, recorded


def test_zone_numbers_go_into_a_law_and_come_back() -> None:
    zones, values = planted()
    law = zones.law(values)
    np.testing.assert_allclose(zones.values_of(law), values, rtol=1e-14)
    usual = zones.usual
    np.testing.assert_allclose(law.static / law.kinetic, np.asarray(usual.static) / np.asarray(usual.kinetic))
    assert zones.names[4] == "stiffness.forefoot"
    assert law.stiffness[-1] == pytest.approx(FACTORS[4] * usual.stiffness[-1])


def test_rows_give_the_forces_of_the_model() -> None:
    """At the numbers with which the keel was solved, rows times numbers are its forces and its centre is met."""
    stance, foot = recorded(0.0), vsf_foot()
    zones, values = planted()
    keel = replace(foot, law=zones.law(values)).at(stance.fulcrum)
    noise = np.full((len(stance.time), 4), 2.0)
    matrix, target = linear_rows(stance, keel, stance.solved(keel), noise)
    off = matrix @ values[:10] - target
    assert np.abs(target).max() > 300.0
    np.testing.assert_allclose(off, 0.0, atol=1e-8)


def test_bounded_fit_keeps_what_no_row_tells() -> None:
    rng = np.random.default_rng(0)
    usual, now = np.full(4, 10.0), np.array([8.0, 12.0, 9.0, 20.0])
    matrix = rng.random((30, 4))
    matrix[:, 3] = 0.0
    true = np.array([14.0, 6.0, 11.0, 1.0])
    found = bounded_fit(1e4 * matrix, 1e4 * matrix @ true, now, np.ones(4), usual, np.full(4, np.log(3.0)))
    np.testing.assert_allclose(found, [14.0, 6.0, 11.0, 20.0], rtol=1e-6)
    edge = bounded_fit(1e4 * matrix, 4e4 * matrix @ true, now, np.ones(4), usual, np.full(4, np.log(3.0)))
    assert edge[0] == pytest.approx(30.0)


def test_a_law_without_friction_has_no_factor() -> None:
    from dataclasses import replace

    foot = vsf_foot()
    smooth = replace(foot.law, kinetic=0.0 * np.asarray(foot.law.kinetic), static=0.0 * np.asarray(foot.law.static))
    with pytest.raises(ValueError, match="needs damping and friction"):
        ZoneParameters(foot.sole, smooth)
