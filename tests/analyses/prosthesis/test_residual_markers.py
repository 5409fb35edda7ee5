"""Markers at the ends of a residual limb: named as on the person's own side, of a left prosthesis as of a right one."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.analyses.prosthesis.recorded_files import residual_of
from geocontact.below_knee_prosthesis.from_markers import as_right
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories

HEIGHTS = {"KNE": 0.5, "SO3": 0.35, "ANK": 0.3}
"""m; below the knee 150 mm of the own side to its end, 170 mm of the other side to the ankle."""


def standing(side: Side) -> MarkerTrajectories:
    """As of a right prosthesis: the end of the limb is on that side alone."""
    own, other = ("R", "L") if side == "right" else ("L", "R")
    names = (f"{own}KNE", f"{own}SO3", f"{own}ANK", f"{other}KNE", f"{other}ANK")
    heights = [HEIGHTS[name[1:]] for name in names[:3]] + [0.5, 0.33]
    places = np.zeros((3, 5, 3))
    places[:, :, 1] = heights
    return as_right(MarkerTrajectories(np.arange(3.0), places, names, "standing.trc"), side)


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_limb_of_the_own_side_is_measured(side: Side) -> None:
    """The intact shank, 170 mm, is not."""
    first = side[0].upper()
    assert residual_of(standing(side), None, f"{first}KNE,{first}SO3", side) == pytest.approx(0.15)
    assert residual_of(standing(side), None, f"{first}KNE,{first}ANK", side) == pytest.approx(0.2)
    with pytest.raises(InputError, match=f"no marker {first}END in the standing trial"):
        residual_of(standing(side), None, f"{first}KNE,{first}END", side)
