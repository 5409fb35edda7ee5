"""Motions as finite-element programs take them: whole turns, tumbling, and odd times, against a second derivation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError
from geocontact.io.finite_elements.rigid_pair import RigidPair
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.mesh.stl import write_stl
from geocontact.io.opensim.osim import mesh_placements
from geocontact.io.opensim.osim_attached import write_with_meshes
from meshes.simple_shapes import block
from tests import opensim_oracle
from tests.elsewhere import Elsewhere
from tests.io.test_osim import VISIBLE, joint4, model3, model4, written

BODY = (np.eye(3), np.array([[0, 1, 2]]))


def moved(rotations: Rotation, time: np.ndarray | None = None) -> RigidPair:
    """A triangle turned about its origin, which moves along a helix."""
    count = len(rotations)
    clock = np.linspace(2.0, 3.0, count) if time is None else time
    shifts = np.column_stack([np.cos(clock), np.sin(clock), clock]) * 0.01
    return RigidPair(clock, RigidTransform.from_components(shifts, rotations), BODY, BODY)


def test_two_whole_turns_about_an_axis_are_a_straight_line() -> None:
    angles = np.linspace(0.0, 4.0 * np.pi, 41)
    axis = np.array([1.0, 2.0, -2.0]) / 3.0
    start = Rotation.from_euler("XYZ", [0.3, -0.8, 1.1])
    pair = moved(Rotation.from_rotvec(angles[:, None] * axis) * start)
    np.testing.assert_allclose(pair.rotation, angles[:, None] * axis, atol=1e-12)
    back = moved(Rotation.from_rotvec(-angles[:, None] * axis) * start)
    np.testing.assert_allclose(back.rotation, -angles[:, None] * axis, atol=1e-12)


def test_rotation_vectors_of_a_tumbling_body_have_no_jump_and_are_its_rotations() -> None:
    s = np.linspace(0.0, 1.0, 400)
    rotations = Rotation.from_euler("ZXZ", np.column_stack([7.0 * s, 1.0 + s, 5.0 * s]))
    pair = moved(rotations)
    raw = (rotations * rotations[0].inv()).as_rotvec()
    assert np.linalg.norm(np.diff(raw, axis=0), axis=1).max() > 5.0  # what a program would interpolate through
    assert np.linalg.norm(np.diff(pair.rotation, axis=0), axis=1).max() < 0.2
    again = Rotation.from_rotvec(pair.rotation) * rotations[0]
    np.testing.assert_allclose(again.as_matrix(), rotations.as_matrix(), atol=1e-12)


def test_velocities_carry_a_body_over_uneven_times() -> None:
    time = np.array([0.5, 0.6, 1.0, 1.1])
    rotations = Rotation.from_euler("XYZ", [[0.0, 0.1, 0.2], [0.5, 0.0, 0.3], [1.0, -0.5, 0.2], [1.2, -0.6, 0.9]])
    pair = moved(rotations, time)
    np.testing.assert_allclose(pair.clock, time - 0.5)
    turn, place = rotations[0], pair.centre
    for k, lasting in enumerate(np.diff(time)):
        turn = Rotation.from_rotvec(pair.angular_velocity[k] * lasting) * turn
        place = place + pair.velocity[k] * lasting
        np.testing.assert_allclose(turn.as_matrix(), rotations[k + 1].as_matrix(), atol=1e-12)
        np.testing.assert_allclose(place, pair.poses.translation[k + 1] * 1e3, atol=1e-12)


def test_a_written_stl_is_read_again(tmp_path: Path) -> None:
    corners, faces = block(40.0, 30.0, 20.0, 2)
    write_stl(tmp_path / "block.stl", corners[faces], "solid of a kind")
    mesh = read_mesh(tmp_path / "block.stl", "mm")
    assert len(mesh.faces) == len(faces)
    np.testing.assert_allclose(mesh.vertices[mesh.faces] * 1e3, corners[faces], atol=1e-5)


OLD_MODEL = VISIBLE.replace("<transform>0.7 0.8 0.9 1 2 3</transform>", "")


@pytest.mark.parametrize("text", [OLD_MODEL, ""], ids=["drawn", "not drawn"])
def test_a_mesh_of_an_old_model_is_drawn_in_the_bodys_frame(tmp_path: Path, opensim: Elsewhere, text: str) -> None:
    """Scale factors of the body's picture do not count; OpenSim's own conversion is the second opinion."""
    source = written(tmp_path, model3("PinJoint", "", ("a",), "false", text))
    write_with_meshes(source, tmp_path / "copy.osim", {"c": ("ours", "ours.stl"), "p": ("p", "p.stl")}, 1e-3)
    opensim(opensim_oracle.converted, tmp_path / "copy.osim", tmp_path / "converted.osim")
    for file in ("copy.osim", "converted.osim"):
        found = mesh_placements(tmp_path / file, "c")
        np.testing.assert_allclose(found["ours.stl"], np.diag([1e-3, 1e-3, 1e-3, 1.0]), atol=1e-12)
        assert len(found) == 1 + text.count("<DisplayGeometry>")
        assert set(mesh_placements(tmp_path / file, "p")) == {"p.stl"}


def test_models_that_cannot_take_a_mesh(tmp_path: Path) -> None:
    source = written(tmp_path, model4(joint4("PinJoint", "", ("a",))))
    with pytest.raises(InputError, match="no body 'femur'; bodies are: "):
        write_with_meshes(source, tmp_path / "copy.osim", {"femur": ("n", "n.stl")}, 1e-3)
    turned = written(tmp_path, model3("PinJoint", "", ("a",), "false", VISIBLE))
    with pytest.raises(InputError, match="drawn in a frame that is not its own"):
        write_with_meshes(turned, tmp_path / "copy.osim", {"c": ("n", "n.stl")}, 1e-3)
    assert not (tmp_path / "copy.osim").exists()


@pytest.mark.parametrize("text", [model3("PinJoint", "", ("a",), "false"), model4(joint4("PinJoint", "", ("a",)))])
def test_a_mesh_of_an_earlier_copy_is_replaced(tmp_path: Path, text: str) -> None:
    """On the other body too, and nothing else with it."""
    source = written(tmp_path, text)
    write_with_meshes(source, tmp_path / "one.osim", {"c": ("ours", "a.stl"), "p": ("other", "b.stl")}, 1e-3)
    write_with_meshes(tmp_path / "one.osim", tmp_path / "two.osim", {"p": ("ours", "c.stl")}, 1e-3)
    own = {body: set(mesh_placements(source, body)) for body in "pc"}
    assert set(mesh_placements(tmp_path / "two.osim", "p")) == own["p"] | {"b.stl", "c.stl"}
    assert set(mesh_placements(tmp_path / "two.osim", "c")) == own["c"]
