"""Scaling, inverse kinematics, inverse dynamics and virtual markers called from Python, beside their commands."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from tests.cli.calls import MESHES, call, done

LEG, SWING = MESHES / "leg.osim", MESHES / "leg_swing.mot"
KNEE = ("right=femur_r,tibia_r",)


@pytest.fixture(scope="module")
def markers(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Virtual markers of the shipped swing."""
    return gc.virtual_markers(SWING, model=LEG).write(tmp_path_factory.mktemp("markers")) / "markers.trc"


def test_the_chain_returns_to_where_it_began(markers: Path, tmp_path: Path) -> None:
    angles = gc.inverse_kinematics(markers, model=LEG, knee=KNEE)
    found = angles.table("coordinates")
    swing = np.loadtxt(SWING, skiprows=7)
    np.testing.assert_allclose(found.to_numpy(), swing, atol=1e-4)
    assert angles.rms_mm < 1e-3 and "16 markers" in str(angles)
    np.testing.assert_allclose(angles.time, swing[:, 0], atol=1e-9)
    np.testing.assert_allclose(angles.coordinates["knee"], np.radians(found["knee [deg]"]), atol=1e-12)
    np.testing.assert_allclose(angles.table("knees")["right_flexion [deg]"], -found["knee [deg]"], atol=1e-4)
    with pytest.warns(gc.InputWarning, match="only gravity acts"):
        moments = gc.inverse_dynamics(angles.write(tmp_path / "ik") / "ik.mot", model=LEG)
    assert moments.table()["ty_force [N]"].mean() == pytest.approx(23.0 * 9.80665, rel=0.02), "nothing else carries it"
    np.testing.assert_array_equal(moments.moments["knee_moment"], moments.table()["knee_moment [N m]"])
    np.testing.assert_array_equal(moments.time, moments.table()["time [s]"])
    assert {axes.get_ylabel() for axes in moments.figure().axes} == {"[N m]"}, "no force but at the ground"


def test_angles_and_moments_are_those_of_the_commands(markers: Path, tmp_path: Path) -> None:
    span = ("--time", "0.1:0.9", "--knee", KNEE[0])
    typed = done(call("ik", markers, "--model", LEG, "--out", tmp_path / "ik", *span, folder=tmp_path / "ik"))
    called = gc.inverse_kinematics(markers, model=LEG, time=(0.1, 0.9), knee=KNEE).write(tmp_path / "called")
    for name in ("ik.mot", "markers.csv", "knees.csv"):
        assert typed.bytes(name) == (called / name).read_bytes(), name
    forces = done(call("id", typed.folder / "ik.mot", "--model", LEG, "--out", tmp_path / "id", "--cutoff", "4",
                       folder=tmp_path / "id"))  # fmt: skip
    with pytest.warns(gc.InputWarning, match="only gravity acts"):
        again = gc.inverse_dynamics(called / "ik.mot", model=LEG, cutoff=4.0).write(tmp_path / "again")
    for name in ("id.sto", "id.json"):
        assert forces.bytes(name) == (again / name).read_bytes(), name


def test_a_scaled_model_is_that_of_the_command(markers: Path, tmp_path: Path) -> None:
    pairs = "femur_r,tibia_r=femur_r0/tibia_r0"
    options = ("--scale", pairs, "--mass", "30", "--time", "0:0")
    typed = done(
        call("scale", markers, "--model", LEG, "--out", tmp_path / "typed", *options, folder=tmp_path / "typed")
    )
    result = gc.scale(markers, model=LEG, scale=pairs, mass=30.0, time=(0.0, 0.0))
    assert sum(body.mass for body in result.model.bodies) == pytest.approx(30.0, rel=1e-12)
    assert list(result.table("factors")["body"]) == ["femur_r", "tibia_r"]
    called = result.write(tmp_path / "called")
    for name in ("scaled.osim", "scale.json"):
        assert typed.bytes(name) == (called / name).read_bytes(), name
    page = (called / "report.html").read_text(encoding="utf-8")
    assert "Model scaled to markers.trc" in page and "The scaled model stands" in page
    far = np.linalg.norm(result.seen - result.modelled, axis=1)
    np.testing.assert_allclose(far, result.pose.distances[0], atol=1e-9)


def test_virtual_markers_are_shown_on_the_skeleton(tmp_path: Path) -> None:
    result = gc.virtual_markers(SWING, model=LEG)
    np.testing.assert_allclose(result.model.marker_places(result.values), result.markers.positions, atol=1e-12)
    page = result.page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "segments and joints" in page and "moves farthest" in page


def test_refusals_name_arguments(markers: Path) -> None:
    with pytest.raises(gc.InputError, match="`fill`: -1 s cannot be a gap in a recording"):
        gc.inverse_kinematics(markers, model=LEG, fill=-1.0)
    with pytest.raises(gc.InputError, match="`axes`: has no effect without plates"):
        gc.inverse_dynamics(SWING, model=LEG, axes="x,z,-y")
    with pytest.raises(gc.InputError, match="`plates`: with `loads` names the plates twice"):
        gc.inverse_dynamics(SWING, model=LEG, loads="a.xml", plates="b.mot", plate="1=foot_r")
    with pytest.raises(gc.InputError, match="`mass`: 0 kg cannot be the mass of a person"):
        gc.scale(markers, model=LEG, mass=0.0)


def test_coordinates_that_markers_do_not_tell_come_first(markers: Path) -> None:
    """Markers of the pelvis alone fit very well, and say nothing of the leg."""
    left_out = tuple(f"{body}{k}=0" for body in ("femur_r", "tibia_r", "foot_r") for k in range(4))
    with pytest.warns(gc.InputWarning, match="no frame determines hip_x"):
        found = gc.inverse_kinematics(markers, model=LEG, weight=left_out)
    assert found.sentences[0].startswith("5 of 11 coordinates are not determined; 101 frames, 4 markers")
