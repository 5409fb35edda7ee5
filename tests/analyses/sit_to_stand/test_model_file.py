"""The written model against OpenSim itself: it loads, and moves by the same forces."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from geocontact.analyses.sit_to_stand.model_file import write_standing_model
from geocontact.dynamics.smooth_sphere_contact import OpenSimSphereLaw
from geocontact.dynamics.tree import Moving
from geocontact.geometry.shapes import HalfSpace
from geocontact.standing_up import feet
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, WORN_PARAMETERS, with_exoskeleton
from geocontact.standing_up.feet import EVERY_PLANTED
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

if TYPE_CHECKING:
    from casadi import SX

P = np.r_[EVERY_PLANTED, STRAP_PLANTED]


NAMES = with_exoskeleton(Subject()).equations.names
POSTURE = np.array([0.0, 0.083, 0.0, -0.3, 1.2, -1.6, -0.3, 1.2, -1.6])


def midway(body: Moving, centre: SX, law: OpenSimSphereLaw, ground: HalfSpace) -> tuple[SX, SX]:
    """OpenSim's contact of a sphere with y = 0: it slides and is pressed half of its depth below the ground."""
    from casadi import cross, mtimes, sqrt, vertcat

    arm = mtimes(body.rotation, centre)
    depth = law.radius - body.place[1] - arm[1]
    lower = arm - vertcat(0.0, law.radius - 0.5 * depth, 0.0)
    velocity = body.speed + cross(body.spin, lower)
    speed = sqrt(velocity[0] ** 2 + velocity[2] ** 2 + law.still**2)
    pressing = law.pressing(depth, -velocity[1])
    rubbing = -pressing * law.friction(speed) / speed
    force = vertcat(rubbing * velocity[0], pressing, rubbing * velocity[2])
    return force, cross(body.place + lower, force)


def written(file: Path) -> Path:
    """The model of planted parameters."""
    values = {each.name: each.value(float(p)) for each, p in zip(WORN_PARAMETERS, P, strict=True)}
    write_standing_model(file, Subject(), values, worn=True)
    return file


@pytest.mark.oracle
def test_opensim_accelerates_the_written_chains_as_the_equations_do(
    opensim: Elsewhere, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a standing foot and on one that moves, with the strap displaced and turned.

    On a standing one as it is. On one that moves OpenSim's point of contact must be told: forces act half of the depth
    deeper than here, which turns a foot of little inertia by tens of rad/s^2.
    """
    file, rng = written(tmp_path / "standing.osim"), np.random.default_rng(4)
    q = POSTURE + rng.normal(size=(4, 9)) * np.r_[np.full(3, 1e-3), np.full(6, 1e-2)]
    u = 0.1 * rng.normal(size=(4, 9))
    still = u.copy()
    still[:, :3] = 0.0
    theirs = opensim(opensim_oracle.accelerations, file, NAMES, np.vstack([q, q]), np.vstack([still, u]))

    def ours(rates: np.ndarray) -> np.ndarray:
        own = with_exoskeleton(Subject()).equations.accelerations()
        return np.array([own(a, b, [], np.zeros(6), P).full().ravel() for a, b in zip(q, rates, strict=True)])

    np.testing.assert_allclose(theirs[:4], ours(still), rtol=1e-6, atol=1e-5)
    apart = np.abs(theirs[4:] - ours(u)).max()
    assert apart > 1.0
    monkeypatch.setattr(feet, "smooth_sphere_wrench", midway)
    np.testing.assert_allclose(theirs[4:], ours(u), rtol=1e-6, atol=1e-5)
