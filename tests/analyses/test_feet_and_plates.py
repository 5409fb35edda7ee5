"""Loads of two bodies that are exchanged, which no residual shows."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.analyses.frame.record import Record
from geocontact.analyses.motion.inverse_dynamics.loads import warn_of_other_feet
from geocontact.data.wrench import Wrench
from geocontact.io.opensim.osim_multibody import read_multibody
from tests.cli.calls import MESHES
from tests.recording import opened

BODIES = ("pelvis", "foot_r")


@pytest.mark.parametrize("exchanged", [False, True])
def test_loads_that_act_under_the_other_body_are_told(exchanged: bool) -> None:
    model = read_multibody(MESHES / "leg.osim")
    values = np.zeros((20, len(model.coordinates)))
    values[:, [c.name for c in model.coordinates].index("hip_z")] = 0.5  # the foot well ahead of the pelvis
    poses = model.poses(values)
    under = BODIES[::-1] if exchanged else BODIES
    up = np.broadcast_to([0.0, 400.0, 0.0], (20, 3))
    loads = {
        body: Wrench(up, np.zeros((20, 3)), poses[where].translation, "ground")
        for body, where in zip(BODIES, under, strict=True)
    }
    record = opened(Record("id", {}, {}))
    warn_of_other_feet(model, values, loads)
    assert len(record.warnings) == (2 if exchanged else 0)
    if exchanged:
        assert "are the loads of the two exchanged?" in record.warnings[0]
