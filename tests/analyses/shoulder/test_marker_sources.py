"""Markers that a simulation starts from besides a .trc file: a .c3d file, and an OpenSim model that moves."""

from __future__ import annotations

import shutil
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.profiles import read as read_workers
from geocontact.analyses.shoulder.study.cases import read as read_study
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.io.mocap.markers import read_markers
from geocontact.io.mocap.trc import write_trc
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, smoothed_motion
from geocontact.shoulder_exoskeleton.device import Wearer, lucy
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from tests.analyses.shoulder.test_simulate import TRIAL, simulated
from tests.shoulder_exoskeleton.arms import SHOULDER, raised

BODY = """<Body name="{name}"><mass>1</mass><mass_center>0 0 0</mass_center><inertia>1 1 1 0 0 0</inertia></Body>
"""
JOINTS = """<WeldJoint name="trunk"><socket_parent_frame>/ground</socket_parent_frame>
<socket_child_frame>/bodyset/torso</socket_child_frame></WeldJoint>
<PinJoint name="shoulder"><socket_parent_frame>in</socket_parent_frame>
<socket_child_frame>/bodyset/humerus_r</socket_child_frame>
<coordinates><Coordinate name="flexion"/></coordinates><frames><PhysicalOffsetFrame name="in">
<socket_parent>/bodyset/torso</socket_parent><translation>0 1.38 0.18</translation></PhysicalOffsetFrame>
</frames></PinJoint>
"""
MARKER = """<Marker name="{name}"><socket_parent_frame>/bodyset/{body}</socket_parent_frame>
<location>{place}</location></Marker>
"""
MARKERS = (
    ("Lucy_MC", "torso", "-0.12 1.4 0"),
    ("Lucy_Mleft", "torso", "-0.12 1.4 -0.1"),
    ("T10", "torso", "-0.12 1.15 0"),
    ("humerus_rup", "humerus_r", "0 -0.03 0"),
    ("humerus_rdn", "humerus_r", "0 -0.19 0"),
)
"""OpenSim's axes: x forwards, y up, z to the right. The shoulder is where `arms.SHOULDER` has it."""


def model_of_an_arm(folder: Path) -> Path:
    """A trunk that stands still, with the markers of the device, and an arm that is raised forwards."""
    bodies = "".join(BODY.format(name=name) for name in ("torso", "humerus_r"))
    markers = "".join(MARKER.format(name=name, body=body, place=place) for name, body, place in MARKERS)
    file = folder / "arm.osim"
    file.write_text(
        '<?xml version="1.0"?>\n<OpenSimDocument Version="40000"><Model name="arm"><gravity>0 -9.80665 0</gravity>'
        f'<Ground name="ground"/><BodySet><objects>{bodies}</objects></BodySet>'
        f"<JointSet><objects>{JOINTS}</objects></JointSet>"
        f"<MarkerSet><objects>{markers}</objects></MarkerSet></Model></OpenSimDocument>\n",
        encoding="utf-8",
    )
    return file


def test_virtual_markers_of_a_model_move_the_device(tmp_path: Path) -> None:
    """As the same motion does that is written down: the chain `geocontact markers`, `geocontact shoulder simulate`."""
    time = np.arange(601) / 100.0
    angle = raised(time)
    table = np.column_stack([time, np.degrees(angle)])
    np.savetxt(tmp_path / "raised.csv", table, fmt="%.9f", delimiter=",", header="time [s],flexion [deg]", comments="")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        made = gc.virtual_markers(tmp_path / "raised.csv", model=model_of_an_arm(tmp_path)).write(tmp_path / "markers")
        found = gc.shoulder.simulate(made / "markers.trc", level=0.5)
    along = np.column_stack([0.0 * angle, -np.sin(angle), -np.cos(angle)])
    gravity = np.array([0.0, 0.0, -9.80665])
    motion = ArmMotion("right", time, SHOULDER + 0.19 * along, SHOULDER + 0.03 * along, angle, gravity)
    wanted = simulate_arm(smoothed_motion(motion, 6.0, 0.2), lucy(), Wearer(), 0.5)
    (arm,) = found.arms
    np.testing.assert_allclose(np.degrees(arm.simulation.elevation), np.degrees(wanted.elevation), atol=0.01)
    np.testing.assert_allclose(arm.simulation.supporting, wanted.supporting, atol=0.1)
    assert np.ptp(wanted.elevation) > 1.0 and wanted.supporting.max() > 5.0
    assert any("only the right arm was recorded" in line for line in found.warnings)


def test_a_c3d_file_gives_what_the_same_trc_file_gives(tmp_path: Path) -> None:
    """Of a laboratory whose z is up, with a subject before each name; a marker that was not seen is bridged."""
    ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    seen = read_markers(TRIAL / "markers.trc")
    places = 1e3 * seen.positions[..., [0, 2, 1]] * [1.0, -1.0, 1.0]  # ours x, y, z are theirs x, z, -y
    content = ezc3d.c3d()
    content["parameters"]["POINT"]["RATE"]["value"] = [1.0 / (seen.time[1] - seen.time[0])]
    content["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    content["parameters"]["POINT"]["LABELS"]["value"] = [f"P1:{name}" for name in seen.names]
    points = np.ones((4, len(seen.names), len(seen)))
    points[:3] = np.moveaxis(places, 2, 0).swapaxes(1, 2)
    points[:3, seen.names.index("humerus_rup"), 100:104] = np.nan
    content["data"]["points"] = points
    content.write(str(tmp_path / "lift.c3d"))
    options = {"tool": TRIAL / "tool.csv", "upright": (0.0, 0.5), "side": "right", "level": 0.5}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.shoulder.simulate(tmp_path / "lift.c3d", axes="x,z,-y", **options).arms[0].simulation
    wanted = simulated(side="right", level=0.5).arms[0].simulation
    assert len(found.motion.time) == len(wanted.motion.time)
    np.testing.assert_allclose(np.degrees(found.elevation), np.degrees(wanted.elevation), atol=0.01)
    np.testing.assert_allclose(found.supporting, wanted.supporting, atol=0.2)


STUDY = """\
[tasks.T1]
tool = { value = 1.3, unit = "kg" }
push = { value = 35, unit = "N" }

[persons.P1]
mass = { value = 82, unit = "kg" }
sex = "male"
dominant = "right"

[[trials]]
person = "P1"
task = "T1"
markers = "lift.trc"
tool = "tool.csv"
level = "100%"
"""


@pytest.mark.parametrize(
    ("options", "read"),
    [(StudyOptions, read_study), (ShoulderOptimiseOptions, read_workers)],
    ids=["study", "optimise"],
)
def test_a_study_maps_and_turns_its_markers(tmp_path: Path, options: Any, read: Any) -> None:
    """As `simulate` does: with other names, where z is up, every trial is what it was."""
    shutil.copy(TRIAL / "tool.csv", tmp_path / "tool.csv")
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    shutil.copy(TRIAL / "markers.trc", tmp_path / "lift.trc")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        wanted = arms_read(read(options(tmp_path / "study.toml")))
        seen = read_markers(TRIAL / "markers.trc")
        turned = replace(seen, positions=seen.positions[..., [0, 2, 1]] * [1.0, -1.0, 1.0])
        write_trc(tmp_path / "lift.trc", turned.renamed({"humerus_rup": "UP", "Lucy_MC": "MC"}))
        told = {"axes": "x,z,-y", "markers_map": "UP=humerus_rup,MC=Lucy_MC"}
        found = arms_read(read(options(tmp_path / "study.toml", **told)))
    for one, two in zip(found, wanted, strict=True):
        np.testing.assert_allclose(one.interface, two.interface, atol=1e-7)
        np.testing.assert_allclose(one.elevation, two.elevation, atol=1e-6)


def arms_read(found: Any) -> list[ArmMotion]:
    """Of the only trial."""
    if isinstance(found, tuple):
        return list(found[0].within.arms)
    return [trial.motion for trial in found.trials]
