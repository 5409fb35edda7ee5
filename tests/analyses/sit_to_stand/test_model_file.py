"""The written model against OpenSim itself: it loads, and moves by the same forces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.sit_to_stand.model_file import write_standing_model
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, WORN_PARAMETERS, with_exoskeleton
from geocontact.standing_up.feet import EVERY_PLANTED
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

P = np.r_[EVERY_PLANTED, STRAP_PLANTED]


@pytest.mark.oracle
def test_opensim_accelerates_the_written_chains_as_the_equations_do(opensim: Elsewhere, tmp_path: Path) -> None:
    """On a standing foot, with the strap displaced and turned: smooth spheres, bushing, masses and joints."""
    model, file = with_exoskeleton(Subject()), tmp_path / "standing.osim"
    values = {each.name: each.value(float(p)) for each, p in zip(WORN_PARAMETERS, P, strict=True)}
    write_standing_model(file, Subject(), values, worn=True)
    rng = np.random.default_rng(4)
    names = model.equations.names
    posture = np.array([0.0, 0.083, 0.0, -0.3, 1.2, -1.6, -0.3, 1.2, -1.6])
    q = posture + rng.normal(size=(4, 9)) * np.r_[np.full(3, 1e-3), np.full(6, 1e-2)]
    u = 0.1 * rng.normal(size=(4, 9))
    u[:, :3] = 0.0  # of a foot that slides OpenSim lets friction act at another height, within the depth
    own = model.equations.accelerations()
    ours = np.array([own(a, b, [], np.zeros(6), P).full().ravel() for a, b in zip(q, u, strict=True)])
    np.testing.assert_allclose(opensim(opensim_oracle.accelerations, file, names, q, u), ours, rtol=1e-6, atol=1e-5)
