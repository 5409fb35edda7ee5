"""One residual limb for one person: a cone's frustum by numerical integration, and the same in both commands."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.scale.result import read as read_stood
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import read as read_walk
from geocontact.analyses.prosthesis.simulate.walk import walk_of
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.standing import standing_amputee
from tests.analyses.prosthesis.test_simulate import GIVEN, TRIAL
from tests.below_knee_prosthesis.model.legs import a_leg
from tests.cli.calls import MESHES
from tests.recording import opened


def test_it_is_the_upper_part_of_de_leva_s_shank() -> None:
    """A man of 77.3 kg, 45 % of a shank of 0.42 m: 4.33 % of him and the centre at 44.59 % of the whole shank."""
    long, radius, cut = 0.42, 0.055, 0.45 * 0.42

    def moment(power: int, end: float, ratio: float, of: int = 2) -> float:
        return quad(lambda x: x**power * (radius * (1.0 + (ratio - 1.0) * x / long)) ** of, 0.0, end)[0]

    ratio = brentq(lambda r: moment(1, long, r) / moment(0, long, r) - 0.4459 * long, 0.1, 2.0)
    density = 0.0433 * 77.3 / (np.pi * moment(0, long, ratio))
    mass = density * np.pi * moment(0, cut, ratio)
    centre = moment(1, cut, ratio) / moment(0, cut, ratio)
    along = density * np.pi * 0.5 * moment(0, cut, ratio, of=4)
    across = density * np.pi * (0.25 * moment(0, cut, ratio, of=4) + moment(2, cut, ratio)) - mass * centre**2
    found = a_leg().residual_body()
    assert found[0] == pytest.approx(mass, rel=1e-9)
    assert found[0] == pytest.approx(1.777, abs=1e-3)
    np.testing.assert_allclose(found[1], [0.0, -centre, 0.0], atol=1e-9)
    np.testing.assert_allclose(found[2], np.diag([across, along, across]), rtol=1e-9)


def test_one_person_has_one_residual_limb_in_both_commands() -> None:
    """1.915 kg in `simulate` and 1.801 kg in `scale` where each had a taper of its own."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        o = ProsthesisSimulateOptions(TRIAL / "walking.trc", **GIVEN)
        opened(Record("simulate", {}))
        walk = walk_of(read_walk(o), o)
        standing = MESHES / "amputee_P1" / "standing.trc"
        stood = read_stood(ProsthesisScaleOptions(standing, mass=77.3))
    made = standing_amputee(stood.seen, stood.person, stood.foot, stood.fulcrum, 0.03)
    tibia = next(body for body in amputee_tree(made).bodies if body.name == "tibia_r")
    assert tibia.mass == pytest.approx(walk.leg.residual_body()[0], rel=1e-12)
    assert made.numbers()["prosthetic residual_mass"].value == tibia.mass
