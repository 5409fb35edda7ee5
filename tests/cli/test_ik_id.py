"""`geocontact ik`, `id` and `markers`: planted motion of a synthetic leg, and what they refuse."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from geocontact.dynamics.scaling import scaled
from geocontact.io.osim_multibody import read_multibody
from geocontact.io.tables import read_table
from geocontact.io.trc import read_trc
from tests import legs
from tests.cli.calls import Call, call, done

WEIGHT = sum(legs.BODIES.values()) * legs.GRAVITY
PLUMB = (0.0, -1.0, 0.1 * 13.0 / 23.0)
"""Point of the ground below the mass centre of the straight leg with its pelvis."""


def ik(folder: Path, markers: Path, *options: object) -> Call:
    model = legs.model_file(folder)
    return call("ik", markers, "--model", model, "--out", folder / "out", *options, folder=folder / "out")


def id_(folder: Path, motion: Path, *options: object) -> Call:
    model = legs.model_file(folder)
    return call("id", motion, "--model", model, "--out", folder / "out", *options, folder=folder / "out")


def trc(folder: Path) -> Path:
    _, model, time, values = legs.planted(folder)
    return legs.trc_file(folder, legs.markers_of(model, time, values))


def standing(folder: Path, share: float = 1.0) -> tuple[Path, Path]:
    """A leg that stands still on a plate which carries this share of its weight."""
    _, model, time, values = legs.planted(folder, amplitude=0.0)
    loads = legs.plate_files(folder, time, (0.0, share * WEIGHT, 0.0), PLUMB)
    return legs.mot_file(folder, model, time, values), loads


def test_a_planted_motion_comes_back(tmp_path: Path) -> None:
    """Markers by forward kinematics, rounded to a nanometre: angles to a ten-thousandth of a degree."""
    _, model, time, values = legs.planted(tmp_path)
    result = done(ik(tmp_path, legs.trc_file(tmp_path, legs.markers_of(model, time, values))))
    found = read_table(result.folder / "ik.mot")
    assert found.angles.unit == "deg"
    np.testing.assert_allclose(found.time, time, atol=1e-9)
    for coordinate, wanted in zip(model.coordinates, values.T, strict=True):
        angular = coordinate.kind == "rotational"
        wanted = np.degrees(wanted) if angular else wanted
        np.testing.assert_allclose(found.column(coordinate.name), wanted, atol=1e-4 if angular else 1e-7)
    told = result.record()["results"]
    assert told["frames"] == len(time) and told["unsettled_frames"] == 0 and told["rms_mm"] < 1e-4
    assert {"ik.mot", "ik.json", "markers.csv", "report.html", "run.json"} == set(result.record()["files"])
    assert result.table("markers.csv").shape == (len(time), 1 + 16)


def test_a_marker_that_is_off_shows_in_the_table(tmp_path: Path) -> None:
    """And counts less with a smaller weight."""
    _, model, time, values = legs.planted(tmp_path)
    markers = legs.markers_of(model, time, values)
    markers.positions[:, 13] += [0.02, 0.0, 0.0]
    file = legs.trc_file(tmp_path, markers)
    even = done(ik(tmp_path, file)).record()["results"]["markers"]
    assert max(even, key=lambda name: even[name]["rms_mm"]) == "foot_r1"
    left = done(ik(tmp_path, file, "--weight", "foot_r1=0")).record()["results"]["markers"]
    assert "foot_r1" not in left and max(each["rms_mm"] for each in left.values()) < 1e-4


def test_weights_and_holds_of_opensim_s_setup(tmp_path: Path) -> None:
    tasks = tmp_path / "tasks.xml"
    markers = "".join(
        f'<IKMarkerTask name="{b}{k}"><weight>2</weight></IKMarkerTask>' for b in legs.BODIES for k in range(4)
    )
    held = """<IKCoordinateTask name="ankle"><value_type>manual_value</value_type><value>0.1</value>
<weight>1e9</weight></IKCoordinateTask>"""
    tasks.write_text(f"<OpenSimDocument><IKTaskSet>{markers}{held}</IKTaskSet></OpenSimDocument>", encoding="utf-8")
    result = done(ik(tmp_path, trc(tmp_path), "--tasks", tasks))
    np.testing.assert_allclose(read_table(result.folder / "ik.mot").column("ankle"), np.degrees(0.1), atol=1e-5)
    result = done(ik(tmp_path, trc(tmp_path), "--hold", "ankle=-3"))
    np.testing.assert_allclose(read_table(result.folder / "ik.mot").column("ankle"), -3.0, atol=0.05)


def test_knee_angles_of_a_pin_are_its_own(tmp_path: Path) -> None:
    """The pin turns about z, to the right; flexion of Grood and Suntay is the other way round."""
    _, model, time, values = legs.planted(tmp_path)
    file = legs.trc_file(tmp_path, legs.markers_of(model, time, values))
    table = done(ik(tmp_path, file, "--knee", "right=femur_r,tibia_r")).table("knees.csv")
    knee = values[:, [c.name == "knee" for c in model.coordinates]].ravel()
    np.testing.assert_allclose(table["right_flexion [deg]"], -np.degrees(knee), atol=1e-4)
    np.testing.assert_allclose(table["right_adduction [deg]"], 0.0, atol=1e-6)


def test_a_laboratory_whose_z_is_up(tmp_path: Path) -> None:
    """Ours x, y, z are theirs x, z, -y."""
    _, model, time, values = legs.planted(tmp_path)
    markers = legs.markers_of(model, time, values)
    markers.positions[:] = markers.positions[..., [0, 2, 1]] * [1.0, -1.0, 1.0]
    result = done(ik(tmp_path, legs.trc_file(tmp_path, markers), "--axes", "x,z,-y", "--time", "0.1:0.3"))
    assert result.record()["results"]["rms_mm"] < 1e-4
    assert result.record()["results"]["frames"] == 21


def test_markers_of_a_c3d_file(tmp_path: Path) -> None:
    """With the subject before each name; a marker of negative residual was not seen."""
    ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    _, model, time, values = legs.planted(tmp_path)
    markers = legs.markers_of(model, time, values)
    content = ezc3d.c3d()
    content["parameters"]["POINT"]["RATE"]["value"] = [legs.RATE]
    content["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    content["parameters"]["POINT"]["LABELS"]["value"] = [f"S1:{name}" for name in markers.names]
    points = np.ones((4, len(markers.names), len(time)))
    points[:3] = 1e3 * np.moveaxis(markers.positions, 2, 0).swapaxes(1, 2)
    points[:3, 2, 5:9] = np.nan
    content["data"]["points"] = points
    file = tmp_path / "walk.c3d"
    content.write(str(file))
    result = done(ik(tmp_path, file))
    assert result.record()["results"]["rms_mm"] < 1e-3  # single precision in the file
    table = result.table("markers.csv")
    assert table["pelvis2 [mm]"].isna().sum() == 4


def test_a_leg_that_stands_on_a_plate(tmp_path: Path) -> None:
    """The plate carries it: nothing is left over at the ground; the reaction pulls at the hip over its lever."""
    motion, loads = standing(tmp_path)
    result = done(id_(tmp_path, motion, "--loads", loads))
    found = read_table(result.folder / "id.sto")
    assert found.angles.unit == "rad" and len(found.time) == 61
    assert "knee_moment" in found.channels and "ty_force" in found.channels
    at_hip = np.array([name == "hip_x_moment" for name in found.channels])
    np.testing.assert_allclose(found.values[:, ~at_hip], 0.0, atol=1e-6)
    np.testing.assert_allclose(found.values[:, at_hip], -WEIGHT * (0.1 - PLUMB[2]), rtol=1e-9)
    told = result.record()["results"]
    assert told["peak_external_force_N"] == pytest.approx(WEIGHT, rel=1e-9)
    assert told["residual_share_of_peak"] < 1e-8
    assert told["residuals"] == [
        f"{n}_{k}"
        for n, k in zip(("tilt", "list", "turn", "tx", "ty", "tz"), ("moment",) * 3 + ("force",) * 3, strict=True)
    ]


def test_what_the_plate_does_not_carry_is_left_over(tmp_path: Path) -> None:
    motion, loads = standing(tmp_path, 0.9)
    result = done(id_(tmp_path, motion, "--loads", loads, "--time", "0.1:0.2"))
    found = read_table(result.folder / "id.sto")
    assert len(found.time) == 11
    np.testing.assert_allclose(found.column("ty_force"), 0.1 * WEIGHT, rtol=1e-9)
    assert result.record()["results"]["residual_share_of_peak"] == pytest.approx(1 / 9, rel=1e-6)
    bare = done(id_(tmp_path, motion))
    np.testing.assert_allclose(read_table(bare.folder / "id.sto").column("ty_force"), WEIGHT, rtol=1e-9)
    assert bare.record()["results"]["residual_share_of_peak"] is None


def test_a_moving_leg_needs_the_force_of_its_acceleration(tmp_path: Path) -> None:
    """Shaken up and down without a turn by a sin ωt: the whole mass times -a ω² sin ωt, unfiltered."""
    _, model, time, values = legs.planted(tmp_path, amplitude=0.0)
    omega, height = 2.0 * np.pi * 2.0, 0.03
    values[:, [c.name == "ty" for c in model.coordinates]] += height * np.sin(omega * time)[:, None]
    result = done(id_(tmp_path, legs.mot_file(tmp_path, model, time, values), "--cutoff", "0"))
    found = read_table(result.folder / "id.sto").column("ty_force")
    wanted = WEIGHT - sum(legs.BODIES.values()) * height * omega**2 * np.sin(omega * time)
    np.testing.assert_allclose(found[3:-3], wanted[3:-3], rtol=1e-4)
    smooth = done(id_(tmp_path, legs.mot_file(tmp_path, model, time, values), "--cutoff", "2"))
    assert np.ptp(read_table(smooth.folder / "id.sto").column("ty_force")[20:40]) < 0.5 * np.ptp(wanted)


def test_virtual_markers_are_where_the_model_puts_them(tmp_path: Path) -> None:
    file, model, time, values = legs.planted(tmp_path)
    motion = legs.mot_file(tmp_path, model, time, values)
    result = done(call("markers", motion, "--model", file, "--out", tmp_path / "out", folder=tmp_path / "out"))
    seen = read_trc(result.folder / "markers.trc")
    np.testing.assert_allclose(seen.time, time, atol=1e-9)
    np.testing.assert_allclose(seen.positions, model.marker_places(values), atol=2e-9)


REFUSED = {
    "no such marker": (("--weight", "heel=3"), "'heel=3' names nothing"),
    "a negative weight": (("--weight", "foot_r1=-3"), "negative"),
    "no such coordinate": (("--hold", "elbow=3"), "'elbow=3' names nothing"),
    "a span without end": (("--time", "0.3"), "'0.3' is not a span"),
    "a span before the recording": (("--time", "7:8"), "no frame between 7 and 8 s"),
    "mirrored axes": (("--axes", "x,z,y"), "mirrors"),
    "an axis twice": (("--axes", "x,x,y"), "not three different axes"),
    "no such side": (("--knee", "centre=femur_r,tibia_r"), "not a side and two bodies"),
    "no such body": (("--knee", "right=femur_r,patella"), "no body 'patella'"),
}


@pytest.mark.parametrize(("options", "message"), REFUSED.values(), ids=REFUSED.keys())
def test_ik_refuses(tmp_path: Path, options: tuple[str, ...], message: str) -> None:
    result = ik(tmp_path, trc(tmp_path), *options)
    assert result.code == 2 and message in result.err and len(result.complaints) == 1
    assert not (tmp_path / "out").exists()


def test_other_markers_than_the_model_s_are_refused(tmp_path: Path) -> None:
    _, model, time, values = legs.planted(tmp_path)
    seen = legs.markers_of(model, time, values)
    other = type(seen)(seen.time, seen.positions, tuple(f"M{k}" for k in range(16)))
    result = ik(tmp_path, legs.trc_file(tmp_path, other))
    assert result.code == 2 and "0 markers of the model were recorded" in result.err


ID_REFUSED = {
    "a cut-off above half the rate": (("--cutoff", "70"), "--cutoff"),
    "a negative cut-off": (("--cutoff", "-1"), "not a frequency"),
    "no such span": (("--time", "3:4"), "no frame between 3 and 4 s"),
}


@pytest.mark.parametrize(("options", "message"), ID_REFUSED.values(), ids=ID_REFUSED.keys())
def test_id_refuses(tmp_path: Path, options: tuple[str, ...], message: str) -> None:
    result = id_(tmp_path, standing(tmp_path)[0], *options)
    assert result.code == 2 and message in result.err and len(result.complaints) == 1


def test_id_refuses_plates_that_end_before_the_motion(tmp_path: Path) -> None:
    motion, loads = standing(tmp_path)
    legs.plate_files(tmp_path, np.arange(20) / legs.RATE, (0.0, WEIGHT, 0.0), PLUMB)
    result = id_(tmp_path, motion, "--loads", loads)
    assert result.code == 2 and "runs from 0 to 0.19 s" in result.err
    done(id_(tmp_path, motion, "--loads", loads, "--time", "0:0.1"))


def test_id_refuses_a_body_that_is_not_there(tmp_path: Path) -> None:
    motion, loads = standing(tmp_path)
    loads.write_text(loads.read_text().replace("foot_r<", "hand_r<"), encoding="utf-8")
    result = id_(tmp_path, motion, "--loads", loads)
    assert result.code == 2 and "no body 'hand_r'" in result.err


def test_id_refuses_frames_that_are_not_even(tmp_path: Path) -> None:
    _, model, time, values = legs.planted(tmp_path)
    kept = np.arange(len(time)) != 30
    result = id_(tmp_path, legs.mot_file(tmp_path, model, time[kept], values[kept]))
    assert result.code == 2 and "frames are not" in result.err


def grown(folder: Path) -> tuple[Path, Path]:
    """A generic leg, and a static trial of one whose thigh is 1.1 and whose shank is 0.9 times as long."""
    file, model, time, values = legs.planted(folder)
    by = {"femur_r": 1.1 * np.ones(3), "tibia_r": 0.9 * np.ones(3)}
    return file, legs.trc_file(folder, legs.markers_of(scaled(model, by), time[:3], 0.0 * values[:3] + 0.05))


PAIRS = ("--scale", "femur_r=femur_r0/femur_r2,femur_r1/femur_r3", "--scale", "tibia_r=tibia_r0/tibia_r2")


def test_a_model_is_made_to_measure(tmp_path: Path) -> None:
    """The scaled file holds the sizes of the subject, its mass, and markers that fit the static trial."""
    file, static = grown(tmp_path)
    result = done(call("scale", static, "--model", file, "--out", tmp_path / "s", *PAIRS, "--mass", "30"))
    told = json.loads((tmp_path / "s" / "scale.json").read_text())
    assert told["factors"] == {"femur_r": pytest.approx(1.1, abs=1e-6), "tibia_r": pytest.approx(0.9, abs=1e-6)}
    assert told["static_rms_mm"] < 1e-3 and told["mass_kg"] == pytest.approx(30.0)
    assert "femur_r 1.100" in result.out
    ours = read_multibody(tmp_path / "s" / "scaled.osim")
    knee = next(j for j in ours.joints if j.name == "knee_r")
    np.testing.assert_allclose(knee.parent_offset.translation, [0.0, -0.44, 0.0], atol=1e-6)
    assert sum(b.mass for b in ours.bodies) == pytest.approx(30.0)
    done(call("ik", static, "--model", tmp_path / "s" / "scaled.osim", "--out", tmp_path / "ik"))
    assert json.loads((tmp_path / "ik" / "ik.json").read_text())["rms_mm"] < 1e-3


def test_markers_are_put_where_they_were_seen(tmp_path: Path) -> None:
    """One is stuck on 2 cm off: the scaled model carries it there, unless markers are to be kept."""
    file, model, time, values = legs.planted(tmp_path)
    markers = legs.markers_of(model, time[:2], 0.0 * values[:2])
    markers.positions[:, 9] += [0.0, 0.02, 0.0]
    static = legs.trc_file(tmp_path, markers)
    off = {}
    for name, options in (("moved", ()), ("kept", ("--keep-markers",))):
        done(call("scale", static, "--model", file, "--out", tmp_path / name, *options))
        ours = read_multibody(tmp_path / name / "scaled.osim")
        off[name] = ours.markers[9].location - model.markers[9].location
    np.testing.assert_array_equal(off["kept"], 0.0)
    assert off["moved"][1] > 0.01


SCALE_REFUSED = {
    "no pair": (("--scale", "femur_r=femur_r0"), "not bodies and pairs"),
    "no such body": (("--scale", "arm=femur_r0/femur_r2"), "no body 'arm'"),
    "a body twice": ((*PAIRS, *PAIRS), "body 'femur_r' is named twice"),
    "no such marker": (("--scale", "femur_r=femur_r0/heel"), "the model has no marker heel"),
    "a mass of nothing": ((*PAIRS, "--mass", "0"), "0 kg is not a mass"),
}


@pytest.mark.parametrize(("options", "message"), SCALE_REFUSED.values(), ids=SCALE_REFUSED.keys())
def test_scale_refuses(tmp_path: Path, options: tuple[str, ...], message: str) -> None:
    file, static = grown(tmp_path)
    result = call("scale", static, "--model", file, "--out", tmp_path / "s", *options)
    assert result.code == 2 and message in result.err and not (tmp_path / "s").exists()


def test_an_absurd_factor_is_refused(tmp_path: Path) -> None:
    """Markers in another unit than the file says."""
    file, static = grown(tmp_path)
    static.write_text(static.read_text().replace("\tmm\t", "\tcm\t"), encoding="utf-8")
    result = call("scale", static, "--model", file, "--out", tmp_path / "s", *PAIRS)
    assert result.code == 2 and "11 times as large" in result.err
