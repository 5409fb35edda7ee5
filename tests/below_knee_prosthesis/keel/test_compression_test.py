"""Simulated compression over the whole range of the fulcrum, beside what low, medium and high say."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.keel.compression import (
    TRAVEL,
    Compressed,
    calibrated_on_sole,
    pressed_sole,
    pressed_tip,
)
from geocontact.below_knee_prosthesis.keel.sections import SUPPORTS, Support
from geocontact.below_knee_prosthesis.keel.vsf import SETTINGS, compression, fulcrum_of, vsf_foot, vsf_keel

RANGE = np.linspace(0.066, 0.151, 12)
GONE = np.array([TRAVEL])


@pytest.mark.parametrize("support", SUPPORTS)
def test_plate_on_the_tip_is_within_a_thousandth(support: Support) -> None:
    fit, keel = compression(support), vsf_keel(support)
    for fulcrum in RANGE:
        force = pressed_tip(keel, fulcrum, fit.series, GONE)[0]
        assert force / TRAVEL == pytest.approx(fit.stiffness(fulcrum), rel=1e-3)


@pytest.mark.parametrize("support", SUPPORTS)
def test_plate_on_the_sole_is_within_one_per_cent(support: Support) -> None:
    foot, fit = vsf_foot(support), compression(support)
    stiffness = [pressed_sole(foot.keel, f, foot.sole, foot.law, GONE)[0] / TRAVEL for f in RANGE]
    assert stiffness == pytest.approx([fit.stiffness(fulcrum) for fulcrum in RANGE], rel=0.01)
    for name, measured in SETTINGS.items():
        force = pressed_sole(foot.keel, fulcrum_of(name, support), foot.sole, foot.law, GONE)[0]
        assert force / TRAVEL == pytest.approx(measured, rel=0.01)


def test_two_compressions_are_met() -> None:
    """Round trip: what another keel on another forefoot gives is given again, with its own numbers."""
    foot = vsf_foot()
    planted = calibrated_on_sole(foot.keel, foot.sole, foot.law, [Compressed(0.07, 12e3), Compressed(0.14, 30e3)])
    forces = [pressed_sole(planted[0], f, foot.sole, planted[1], GONE)[0] for f in (0.08, 0.13)]
    seen = [Compressed(f, force / TRAVEL) for f, force in zip((0.08, 0.13), forces, strict=True)]
    found = calibrated_on_sole(foot.keel, foot.sole, foot.law, seen)
    assert found[0].bending == pytest.approx(planted[0].bending, rel=1e-6)
    assert found[1].stiffness == pytest.approx(planted[1].stiffness, rel=1e-6)
