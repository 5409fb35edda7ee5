"""Passive forces of a model in `id`: they act unless left out, and the results say which."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.motion.inverse_dynamics.result import IdResult
from geocontact.data.errors import InputError, InputWarning
from meshes.leg_files import leg_model
from tests.cli.calls import MESHES

LIMIT = """<CoordinateLimitForce name="knee_stop"><coordinate>knee</coordinate><upper_stiffness>1</upper_stiffness>
<upper_limit>0</upper_limit><lower_stiffness>2</lower_stiffness><lower_limit>-40</lower_limit><damping>0</damping>
<transition>0</transition></CoordinateLimitForce>"""
CONTACT = '<HuntCrossleyForce name="sole"/>'


def moments(folder: Path, forces: str, **options: object) -> IdResult:
    """Of the shipped leg swing, with these forces in the model."""
    model = folder / "leg.osim"
    model.write_text(leg_model().replace("<JointSet>", f"<ForceSet><objects>{forces}</objects></ForceSet><JointSet>"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)  # nothing but gravity acts on this leg
        return gc.inverse_dynamics(MESHES / "leg_swing.mot", model=model, cutoff=0.0, **options)


def test_a_limit_of_the_knee_takes_its_part_of_the_moment(tmp_path: Path) -> None:
    """2 N m per degree beyond 40 degrees of flexion, by hand."""
    acting = moments(tmp_path, LIMIT)
    without = moments(tmp_path, LIMIT, exclude=["knee_stop"])
    flexion = np.degrees(acting.coordinates[:, [c.name for c in acting.forces.model.coordinates].index("knee")])
    pushes = 2.0 * np.maximum(-40.0 - flexion, 0.0)
    assert pushes.max() > 40.0
    column = "knee_moment [N m]"
    np.testing.assert_allclose(without.table()[column] - acting.table()[column], pushes, atol=1e-9)
    assert any("act together with muscles: knee_stop" in line for line in acting.sentences)
    acting.write(tmp_path / "out")
    assert json.loads((tmp_path / "out" / "id.json").read_text())["passive_forces"] == ["knee_stop"]
    assert json.loads((tmp_path / "out" / "run.json").read_text())["results"]["passive_forces_left_out"] == []
    assert without.summary["passive_forces_left_out"] == ["knee_stop"]


def test_forces_of_other_kinds_are_named(tmp_path: Path) -> None:
    found = moments(tmp_path, CONTACT)
    assert any("not read do not act here" in line and "HuntCrossleyForce sole" in line for line in found.warnings)
    assert found.summary["passive_forces_left_out"] == ["HuntCrossleyForce sole"]
    with pytest.raises(InputError, match="is neither a force nor a group"):
        moments(tmp_path, LIMIT, exclude=["hip_stop"])
