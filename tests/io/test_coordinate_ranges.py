"""Degrees in a file that says radians, found by the ranges of the coordinates: every way in for a model's motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.motion.motion import read_motion
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import read_table

MESHES = Path(__file__).resolve().parents[2] / "meshes"
KNEE, LEG = MESHES / "knee.osim", MESHES / "leg.osim"


def called_radians(folder: Path, rows: int = 6, first: int = 0) -> Path:
    """Some rows of the shipped gait cycle, flexion 6.6 to 9.5 degrees in the first six, with the wrong flag."""
    head, table = (MESHES / "gait.mot").read_text(encoding="utf-8").split("endheader\n")
    names, *lines = table.splitlines()
    head = head.replace("inDegrees=yes", "inDegrees=no").replace("nRows=101", f"nRows={rows}")
    file = folder / "gait.mot"
    text = "\n".join([f"{head}endheader", names, *lines[first : first + rows]])
    file.write_text(text + "\n", encoding="utf-8")
    return file


def leg_motion(folder: Path, knee: str, turn: str = "0") -> Path:
    head = "c\nversion=1\nnRows=2\nnColumns=4\ninDegrees=no\nendheader\ntime knee ankle turn\n"
    (folder / "leg.mot").write_text(f"{head}0 0 0 0\n1 {knee} 0 {turn}\n", encoding="utf-8")
    return folder / "leg.mot"


def test_degrees_within_a_turn_of_radians_are_refused(tmp_path: Path) -> None:
    file = called_radians(tmp_path)
    with pytest.raises(InputError, match=r"gait\.mot line \d+: column 'knee_flexion' reaches 9\.45"):
        read_motion(file, osim=KNEE, joint="knee_r")
    text = file.read_text(encoding="utf-8")
    for degrees in ("6.603143", "6.763506", "7.133036", "7.710681", "8.489180", "9.451766"):
        text = text.replace(degrees, f"{float(degrees) / 2.0:.6f}")
    file.write_text(text, encoding="utf-8")
    said = r"line \d+: column 'knee_flexion' is 3\.3 to 4\.73: as radians beyond the range -2\.1 to 2\.1"
    with pytest.raises(InputError, match=f"{said} of knee_flexion, within it as degrees; pass `angles` deg or rad"):
        read_motion(file, osim=KNEE, joint="knee_r")
    with pytest.warns(InputWarning, match="as radians beyond the range .*; read as rad as asked for"):
        taken = read_motion(file, osim=KNEE, joint="knee_r", angles="rad")
    assert taken.poses.rotation.magnitude().max() > 1.0
    with pytest.warns(InputWarning, match="says rad, read as deg as asked for"):
        assert read_motion(file, osim=KNEE, joint="knee_r", angles="deg").poses.rotation.magnitude().max() < 0.1


def test_a_model_without_ranges_has_joints_of_half_a_turn(tmp_path: Path) -> None:
    """`id` and `markers` read so. A subject may face anywhere: the joint to the ground is not judged."""
    model = read_multibody(LEG)
    with pytest.raises(InputError, match=r"column 'knee' is 0 to 4\.5: as radians beyond the half turn of a joint"):
        motion_of(read_table(leg_motion(tmp_path, "4.5")), model)
    with pytest.warns(InputWarning, match="default taken"):
        values = motion_of(read_table(leg_motion(tmp_path, "2.5", turn="5")), model)
    names = [c.name for c in model.coordinates]
    np.testing.assert_allclose(values[1, [names.index("knee"), names.index("turn")]], [2.5, 5.0])
