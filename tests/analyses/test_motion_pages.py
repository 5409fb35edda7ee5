"""What the pages of `ik` and `id` show: the skeleton with markers and forces, right and left together."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from geocontact.analyses.motion.inverse_dynamics import show as id_page
from geocontact.analyses.motion.inverse_kinematics.show import answer
from geocontact.analyses.motion.panels import panels_of
from geocontact.analyses.motion.skeleton import forces_on, markers_beside, scene_of, skeleton
from geocontact.data.multibody.joint import gimbal, revolute
from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.data.wrench import Wrench
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.dynamics.residuals import GeneralisedForces
from geocontact.view.page.content import Curves, Scale, Table
from tests import legs


def lengths(points: np.ndarray, lines: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points[:, lines[:, 0]] - points[:, lines[:, 1]], axis=2)


def test_segments_run_from_joint_to_joint_and_keep_their_length(tmp_path: Path) -> None:
    """Pelvis to hip, thigh, shank, and the foot to its farthest marker, whatever the pose."""
    _, model, _, values = legs.planted(tmp_path)
    bones = skeleton(model, values)
    found = lengths(bones.points, bones.lines)
    far = max(np.linalg.norm(m.location) for m in model.markers if m.body == "foot_r")
    np.testing.assert_allclose(found, np.broadcast_to([np.hypot(0.1, 0.1), 0.4, 0.4, far], found.shape), atol=1e-12)
    poses = model.poses(values)
    np.testing.assert_allclose(bones.points[:, 2], poses["tibia_r"].translation, atol=1e-12)
    values[3, 4] = np.nan
    gone = skeleton(model, values).known
    assert not gone[3].any() and gone[[2, 4]].all()


def test_markers_stand_beside_those_of_the_model(tmp_path: Path) -> None:
    _, model, _, values = legs.planted(tmp_path)
    modelled = model.marker_places(values)
    seen = modelled + np.array([0.0, 0.0, 0.01])
    seen[5, 2] = np.nan
    measured, own, between = markers_beside(seen, modelled)
    assert (measured.tone, own.tone) == ("seen", "model") and not measured.known[5, 2]
    np.testing.assert_allclose(lengths(between.points, between.lines)[6], 0.01, atol=1e-12)
    scene = scene_of(model, [measured, own])
    assert scene.linkages[0].name.startswith("floor") and scene.linkages[0].points[..., 1].max() == 0.0


def test_a_force_is_drawn_from_its_centre_of_pressure(tmp_path: Path) -> None:
    """600 N upwards 0.2 m ahead, 0.6 m long; none in the frame with 5 N."""
    _, model, _, _ = legs.planted(tmp_path)
    force = np.array([[0.0, 600.0, 0.0], [0.0, 5.0, 0.0]])
    moment = np.cross([0.2, 0.0, 0.0], force)
    (ray,) = forces_on(model, {"foot_r": Wrench(force, moment, np.zeros((2, 3)), "ground")}, np.arange(2))
    np.testing.assert_allclose(ray.points[0], [[0.2, 0.0, 0.0], [0.2, 0.6, 0.0]], atol=1e-12)
    assert not ray.known[1].any() and forces_on(model, {}, np.arange(2)) == []


def test_right_and_left_share_a_panel() -> None:
    """Knees side by side, the right one first and in the first colour; the back's three angles together."""
    axis = np.array([0.0, 0.0, 1.0])
    joints = [gimbal("back", GROUND, "torso"), *(revolute(f"knee_{s}", "torso", f"shank_{s}", axis) for s in "lr")]
    model = Multibody("two knees", (), tuple(joints), (), np.zeros(3))
    values = np.arange(10.0).reshape(2, 5)
    back, knees = panels_of(model, "N m", values, np.ones(5, bool), Scale("N m/kg", 0.5))
    assert isinstance(back, Curves) and isinstance(knees, Curves)
    assert (back.title, [c.name for c in back.curves]) == ("back", ["back_rx", "back_ry", "back_rz"])
    assert (knees.title, [c.name for c in knees.curves]) == ("knee", ["knee_r", "knee_l"])
    np.testing.assert_array_equal(knees.curves[0].values, [4.0, 9.0])
    (alone,) = panels_of(model, "N m", values, np.arange(5) == 4)
    assert isinstance(alone, Curves) and alone.title == "knee_r"


def test_the_page_of_moments_opens_at_the_largest_and_says_it(tmp_path: Path) -> None:
    """Of 2001 frames every second is shown: the 1401st is the 701st of them."""
    _, model, _, _ = legs.planted(tmp_path)
    names = [c.name for c in model.coordinates]
    values = np.zeros((2001, len(names)))
    values[1400, names.index("knee")] = -55.0
    values[:, names.index("ty")] = 40.0
    forces = GeneralisedForces(np.arange(2001) / 100.0, model, values, 800.0, 0.9)
    turning = np.array([c.kind == "rotational" for c in model.coordinates]) & ~forces.at_ground
    assert id_page.answer(forces, turning) == [
        "knee needs the largest moment, 55.0 N m at 14 s.",
        "Residual force 40 N at 0 s = 5.0 % of the largest plate force (limit 5 %).",
        "Residual moment 0 N m at 0 s = 0.0 % of force × height of the mass centre (limit 1 %; Hicks 2015).",
    ]
    (table,) = id_page._residuals(forces)
    assert isinstance(table, Table) and table.header[-1] == "OpenSim's grade (after residual reduction)"
    assert id_page._start(forces, turning, id_page.thinned(2001)) == 700


def test_the_page_of_angles_says_how_well_the_markers_fit() -> None:
    """Three distances of 0.3, 0.4 and 1.2 mm: root mean square 0.751 mm by hand."""
    off = 1e-3 * np.array([[0.3, 0.4], [np.nan, 1.2]])
    poses = Poses(
        np.array([0.0, 0.36]),
        ("knee", "hip"),
        np.zeros((2, 2)),
        ("pelvis", "femur_r1"),
        off,
        np.ones(2, np.int64),
        np.ones(2, bool),
        np.ones((2, 2), bool),
    )
    fit = "Markers fit within 0.8 mm RMS; worst femur_r1, 1.2 mm at 0.36 s."
    assert answer(poses) == [fit]
    lost = replace(poses, determined=np.array([[True, False], [True, False]]))
    assert answer(lost) == ["1 of 2 coordinates are not determined.", fit]
