"""A residual limb by its measured length."""

from __future__ import annotations

import pytest

from geocontact.below_knee_prosthesis.leg import RESIDUAL
from geocontact.below_knee_prosthesis.recorded_walk import with_residual
from geocontact.data.errors import InputError
from tests.below_knee_prosthesis.model.legs import a_leg


def test_a_measured_length_is_a_share_of_the_own_shank() -> None:
    """150 mm of a shank: the bushing is half-way down, the cut frustum is as long, and its mass is by that share."""
    leg = a_leg()
    cut = leg.with_residual(0.150)
    assert -cut.bushing[1] == pytest.approx(0.075, rel=1e-12)
    assert cut.person.residual * cut.shank == pytest.approx(0.150, rel=1e-12)
    assert cut.residual_body()[0] < leg.residual_body()[0] or RESIDUAL * leg.shank < 0.150
    assert cut.numbers()["residual_share"].source == "option"
    assert leg.numbers()["residual_share"].source == "invented"


def test_a_length_that_is_the_usual_share_changes_nothing() -> None:
    leg = a_leg()
    same = leg.with_residual(leg.person.residual * leg.shank)
    assert same.residual_body()[0] == pytest.approx(leg.residual_body()[0], rel=1e-12)


def test_a_limb_that_is_no_shorter_than_the_shank_is_refused() -> None:
    with pytest.raises(InputError, match="a residual limb of 500 mm is not shorter than the shank"):
        with_residual(a_leg(), 0.5)
