"""OpenSim's ScapulothoracicJoint: on the ellipsoid, and winging about an axis in the scapula's plane."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.data.errors import InputError
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.tree import tree_of
from geocontact.io.opensim.osim import read_joint
from geocontact.io.opensim.osim_multibody import read_multibody

RADII = np.array([0.08, 0.2, 0.09])
ORIGIN, DIRECTION = np.array([0.01, -0.03]), 0.4
NAMES = ("abduction", "elevation", "upward", "winging")
MODEL = """<?xml version="1.0"?>
<OpenSimDocument Version="40000"><Model name="scapula"><Ground name="ground"/>
<BodySet><objects><Body name="scapula"><mass>0.5</mass><mass_center>0 0 0</mass_center>
<inertia>0.001 0.001 0.001 0 0 0</inertia></Body></objects></BodySet>
<JointSet><objects><ScapulothoracicJoint name="st">
<socket_parent_frame>thorax_offset</socket_parent_frame><socket_child_frame>scapula_offset</socket_child_frame>
<coordinates>{coordinates}</coordinates><frames>
<PhysicalOffsetFrame name="thorax_offset"><socket_parent>/ground</socket_parent>
<translation>{place}</translation><orientation>{turn}</orientation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="scapula_offset"><socket_parent>/bodyset/scapula</socket_parent>
<translation>0.02 0 -0.01</translation><orientation>-0.5 -1.1 -0.3</orientation></PhysicalOffsetFrame></frames>
<thoracic_ellipsoid_radii_x_y_z>{radii}</thoracic_ellipsoid_radii_x_y_z>
<scapula_winging_axis_origin>0.01 -0.03</scapula_winging_axis_origin>
<scapula_winging_axis_direction>0.4</scapula_winging_axis_direction>
</ScapulothoracicJoint></objects></JointSet></Model></OpenSimDocument>
"""


def file_in(folder: Path, names: tuple[str, ...] = NAMES) -> Path:
    file = folder / "scapula.osim"
    coordinates = "".join(f'<Coordinate name="{name}"/>' for name in names)
    numbers = {"place": "-0.03 -0.02 0.07", "turn": "0.1 -1.07 0.2", "radii": "0.08 0.2 0.09"}
    file.write_text(MODEL.format(coordinates=coordinates, **numbers), encoding="utf-8")
    return file


@pytest.fixture
def model(tmp_path: Path) -> Multibody:
    return read_multibody(file_in(tmp_path))


def in_thorax(model: Multibody, q: np.ndarray) -> tuple[np.ndarray, Rotation]:
    """The joint's frame on the scapula in that on the thorax, whose axes are those of the ellipsoid."""
    scapula = model.poses(q)["scapula"]
    joint = model.joints[-1].child_offset.translation
    assert joint is not None
    thorax = Rotation.from_euler("XYZ", [0.1, -1.07, 0.2])
    own = Rotation.from_euler("XYZ", [-0.5, -1.1, -0.3])
    place = scapula.apply([0.02, 0.0, -0.01]) - [-0.03, -0.02, 0.07]
    return thorax.inv().apply(place), thorax.inv() * scapula.rotation * own


def test_it_is_two_joints_and_a_body_without_mass(model: Multibody) -> None:
    assert tuple(c.name for c in model.coordinates) == NAMES
    assert [joint.child for joint in model.joints] == ["st_on_ellipsoid", "scapula"]
    assert model.mass == 0.5
    assert all(c.kind == "rotational" for c in model.coordinates)


def test_the_scapula_glides_on_the_ellipsoid(model: Multibody) -> None:
    q = np.random.default_rng(1).uniform(-1.2, 1.2, (50, 4))
    q[:, 3] = 0.0
    place, turn = in_thorax(model, q)
    np.testing.assert_allclose(np.sum((place / RADII) ** 2, axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(place, RADII * turn.as_matrix()[:, :, 2], atol=1e-12)


def test_coordinates_turn_as_simbody_does(model: Multibody) -> None:
    """Body-fixed x, y, z of a frame a quarter turn away; winging about an axis in the scapula's plane."""
    q = np.random.default_rng(2).uniform(-1.0, 1.0, (20, 4))
    place, turn = in_thorax(model, q)
    quarter = Rotation.from_euler("z", 90.0, degrees=True)
    axis = np.array([-np.sin(DIRECTION), np.cos(DIRECTION), 0.0])
    wing = Rotation.from_rotvec(q[:, 3:] * axis)
    glide = quarter * Rotation.from_euler("XYZ", q[:, :3]) * quarter.inv()
    np.testing.assert_allclose((glide * wing).as_matrix(), turn.as_matrix(), atol=1e-12)
    hinge = np.array([*ORIGIN, 0.0])
    np.testing.assert_allclose(
        place, RADII * glide.as_matrix()[:, :, 2] + glide.apply(hinge - wing.apply(hinge)), atol=1e-12
    )


def test_symbols_move_as_numbers(model: Multibody) -> None:
    """Places and velocities of the tree are those of poses and of their differences."""
    import casadi

    tree = tree_of(model)
    frame = tree.bodies["scapula"]
    at = casadi.Function("f", [tree.q, tree.u, tree.a], [frame.place, frame.speed])
    rng = np.random.default_rng(3)
    q, u = rng.uniform(-1.0, 1.0, 4), rng.uniform(-2.0, 2.0, 4)
    place, speed = (np.array(each)[:, 0] for each in at(q, u, np.zeros(4)))
    places = model.poses(np.stack((q, q + 1e-6 * u, q - 1e-6 * u)))["scapula"].translation
    np.testing.assert_allclose(place, places[0], atol=1e-14)
    np.testing.assert_allclose(speed, (places[1] - places[2]) / 2e-6, atol=1e-8)


def test_other_coordinates_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="3 coordinates, not 4"):
        read_multibody(file_in(tmp_path, NAMES[:3]))
    with pytest.raises(InputError, match="this kind of joint is not supported"):
        read_joint(file_in(tmp_path), "st")
