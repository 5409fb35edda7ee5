"""`geocontact ik`, `id` and `markers`: planted motion of a synthetic leg, and what they refuse."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.data.multibody.knee_angles import tibia_in_femur
from geocontact.data.wrench import Wrench
from geocontact.dynamics.scaling import scaled
from geocontact.io.mocap.force_plates import LABORATORY_FRAME, read_force_plates
from geocontact.io.mocap.trc import read_trc
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.tables import read_table
from tests import legs
from tests.cli.calls import Call, call, contradicting, done

WEIGHT = sum(legs.BODIES.values()) * legs.GRAVITY
PLUMB = (0.0, -1.0, 0.1 * 13.0 / 23.0)
"""Point of the ground below the mass centre of the straight leg with its pelvis."""


HEIGHT = (10.0 * 1.0 + 8.0 * 0.9 + 4.0 * 0.5 + 1.0 * 0.1) / 23.0 - 0.15
"""Of the mass centre of the straight leg [m]: each body's is 0.15 m below its joint."""


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
    for_opensim = {"seen.trc", "setup_ik.xml", "walk_ik_marker_errors.sto"}
    written = {"ik.mot", "ik.json", "markers.csv", "report.html", "run.json"}
    assert written | for_opensim == set(result.record()["files"])
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
    result = contradicting(ik(tmp_path, trc(tmp_path), "--tasks", tasks))  # what is held is not what was recorded
    np.testing.assert_allclose(read_table(result.folder / "ik.mot").column("ankle"), np.degrees(0.1), atol=1e-5)
    result = done(ik(tmp_path, trc(tmp_path), "--hold", "ankle=-3"))
    np.testing.assert_allclose(read_table(result.folder / "ik.mot").column("ankle"), -3.0, atol=0.05)


SET_UP = (
    '<OpenSimDocument><InverseKinematicsTool><IKTaskSet file="sub/tasks.xml"/></InverseKinematicsTool>'
    "</OpenSimDocument>"
)


def test_tasks_that_a_set_up_names_by_their_file(tmp_path: Path) -> None:
    """From the set-up's folder, as OpenSim reads it; both files stand in run.json."""
    (tmp_path / "sub").mkdir()
    tasks = "".join(
        f'<IKMarkerTask name="{b}{k}"><weight>2</weight></IKMarkerTask>' for b in legs.BODIES for k in range(4)
    )
    held = '<IKCoordinateTask name="ankle"><value_type>manual_value</value_type><value>0.1</value><weight>1e9</weight>'
    text = f"<OpenSimDocument><IKTaskSet>{tasks}{held}</IKCoordinateTask></IKTaskSet></OpenSimDocument>"
    (tmp_path / "sub" / "tasks.xml").write_text(text, encoding="utf-8")
    (tmp_path / "setup.xml").write_text(SET_UP, encoding="utf-8")
    result = contradicting(ik(tmp_path, trc(tmp_path), "--tasks", tmp_path / "setup.xml"))
    np.testing.assert_allclose(read_table(result.folder / "ik.mot").column("ankle"), np.degrees(0.1), atol=1e-5)
    files = {Path(each["file"]).name for each in result.record()["inputs"]}
    assert {"setup.xml", "tasks.xml"} <= files


def test_tasks_whose_file_is_not_there_are_refused(tmp_path: Path) -> None:
    (tmp_path / "setup.xml").write_text(SET_UP, encoding="utf-8")
    result = ik(tmp_path, trc(tmp_path), "--tasks", tmp_path / "setup.xml")
    assert (result.code, len(result.complaints)) == (2, 1)
    assert "setup.xml <IKTaskSet file=…>: names 'sub/tasks.xml', which is not there; put that file there" in result.err


def test_tasks_that_name_themselves_are_refused(tmp_path: Path) -> None:
    (tmp_path / "setup.xml").write_text(SET_UP.replace("sub/tasks", "setup"), encoding="utf-8")
    result = ik(tmp_path, trc(tmp_path), "--tasks", tmp_path / "setup.xml")
    assert result.code == 2 and "<IKTaskSet file=…>: leads back to 'setup.xml'" in result.err


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
    content["parameters"]["ANALOG"]["RATE"]["value"] = [10.0 * legs.RATE]
    content["parameters"]["ANALOG"]["LABELS"]["value"] = ["EMG Soleus", "Fz left"]
    content["parameters"]["FORCE_PLATFORM"]["CHANNEL"]["value"] = np.array([[2]])
    content["data"]["analogs"] = np.arange(2 * 10 * len(time), dtype=float).reshape(1, 2, -1)
    file = tmp_path / "walk.c3d"
    content.write(str(file))
    result = done(ik(tmp_path, file, "--analog"))
    emg = read_table(result.folder / "analog.sto")
    assert emg.channels == ("EMG_Soleus",) and len(emg.time) == 10 * len(time), "the other one is of a plate"
    np.testing.assert_allclose(emg.values[:, 0], np.arange(10 * len(time)), rtol=1e-6)
    np.testing.assert_allclose(np.diff(emg.time), 0.1 / legs.RATE, atol=1e-9)
    assert result.record()["results"]["rms_mm"] < 1e-3  # single precision in the file
    table = result.table("markers.csv")
    assert table["pelvis2 [mm]"].isna().sum() == 4
    content["parameters"]["POINT"]["LABELS"]["value"] = [f"S1:M{k}" for k in range(len(markers.names))]
    content.write(str(file))
    other = ik(tmp_path, file)
    assert other.code == 2 and "recorded are: M0, M1" in other.err and "the model's are: pelvis0" in other.err


def test_a_c3d_file_without_plates_lists_its_channels(tmp_path: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    content = ezc3d.c3d()
    content["parameters"]["POINT"]["RATE"]["value"] = [legs.RATE]
    content["parameters"]["ANALOG"]["RATE"]["value"] = [10.0 * legs.RATE]
    content["parameters"]["ANALOG"]["LABELS"]["value"] = ["EMG Soleus", "Fz left"]
    content["parameters"]["POINT"]["LABELS"]["value"] = ["M0"]
    content["data"]["points"] = np.ones((4, 1, 61))
    content["data"]["analogs"] = np.ones((1, 2, 610))
    content.write(str(tmp_path / "emg.c3d"))
    result = id_(tmp_path, standing(tmp_path)[0], "--plates", tmp_path / "emg.c3d", "--plate", "1=foot_r")
    assert result.code == 2 and "holds no force plate" in result.err and "EMG Soleus, Fz left" in result.err


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
    assert told["residual_share_of_peak"] < 1e-8 and not result.warnings
    assert told["mass_centre_height_m"] == pytest.approx(HEIGHT, rel=1e-9)
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
    (line,) = result.warnings
    assert "residual force 22.6 N at 0.14 s = 11 % of the largest plate force" in line and "check which plate" in line
    assert "residual force 22.6 N at 0.14 s" in result.out.splitlines()[0]
    bare = done(id_(tmp_path, motion))
    assert any(
        "residual force 226 N" in w and "= 100 % of the weight" in w and "give --loads" in w for w in bare.warnings
    )
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


def lost(folder: Path, frames: slice, markers: slice) -> Path:
    """The planted walk without these markers in these frames."""
    _, model, time, values = legs.planted(folder)
    seen = legs.markers_of(model, time, values)
    seen.positions[frames, markers] = np.nan
    return legs.trc_file(folder, seen)


def knee_and_ankle(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    table = read_table(folder / "ik.mot")
    return table.column("knee"), table.column("ankle")


def test_a_short_gap_is_filled_and_told(tmp_path: Path) -> None:
    """The foot is not seen for 0.06 s: its ankle comes from a spline, near the truth, all else from markers."""
    _, model, _, values = legs.planted(tmp_path)
    result = done(ik(tmp_path, lost(tmp_path, slice(20, 26), slice(12, 16))))
    told = result.record()["results"]
    assert told["filled_frames"] == {"ankle": 6} and told["missing_frames"] == {}
    assert any(
        "6 frames from 0.2 to 0.25 s: filled between frames that determine them: ankle" in w for w in result.warnings
    )
    names = [c.name for c in model.coordinates]
    knee, ankle = knee_and_ankle(result.folder)
    np.testing.assert_allclose(knee, np.degrees(values[:, names.index("knee")]), atol=1e-4)
    np.testing.assert_allclose(ankle, np.degrees(values[:, names.index("ankle")]), atol=0.05)


@pytest.mark.parametrize(("frames", "count"), [(slice(20, 40), 20), (slice(0, 5), 5), (slice(56, 61), 5)])
def test_a_long_gap_and_the_ends_stay_empty(tmp_path: Path, frames: slice, count: int) -> None:
    """Nothing is held over from the frame before; inverse dynamics refuses the holes and can be cut to the rest."""
    result = done(ik(tmp_path, lost(tmp_path, frames, slice(12, 16))))
    assert result.record()["results"]["missing_frames"] == {"ankle": count}
    assert any("left empty, markers do not determine them: ankle" in w for w in result.warnings)
    knee, ankle = knee_and_ankle(result.folder)
    assert np.isnan(ankle).sum() == count and np.isfinite(knee).all()
    refused = call("id", result.folder / "ik.mot", "--model", legs.model_file(tmp_path), "--out", tmp_path / "id")
    assert refused.code == 2 and f"'ankle' is nan in {count}" in refused.err


def test_frames_without_a_marker_stay_empty(tmp_path: Path) -> None:
    """The first ones too: the search begins where markers are."""
    result = done(ik(tmp_path, lost(tmp_path, slice(0, 10), slice(0, 16)), "--knee", "right=femur_r,tibia_r"))
    missing = result.record()["results"]["missing_frames"]
    assert set(missing.values()) == {10} and len(missing) == 11
    assert result.table("knees.csv")["right_flexion [deg]"].isna().sum() == 10
    _, model, _, values = legs.planted(tmp_path)
    names = [c.name for c in model.coordinates]
    np.testing.assert_allclose(
        knee_and_ankle(result.folder)[0][10:], np.degrees(values[10:, names.index("knee")]), atol=1e-4
    )


def test_what_no_frame_tells_stays_at_its_default(tmp_path: Path) -> None:
    result = done(ik(tmp_path, lost(tmp_path, slice(None), slice(12, 16))))
    assert any("no frame determines ankle: set to the model's default" in w for w in result.warnings)
    np.testing.assert_array_equal(knee_and_ankle(result.folder)[1], 0.0)


def test_what_two_markers_cannot_tell_is_refused(tmp_path: Path) -> None:
    result = ik(tmp_path, lost(tmp_path, slice(None), slice(2, 16)))
    assert result.code == 2 and "no frame shows more than 2 markers" in result.err
    nothing = ik(tmp_path, lost(tmp_path, slice(None), slice(None)))
    assert nothing.code == 2 and "no marker is visible in any frame" in nothing.err


def test_a_held_coordinate_is_told_without_markers(tmp_path: Path) -> None:
    result = done(ik(tmp_path, lost(tmp_path, slice(20, 40), slice(12, 16)), "--hold", "ankle=0"))
    assert result.record()["results"]["missing_frames"] == {}


def test_a_marker_that_is_never_seen_is_named(tmp_path: Path) -> None:
    result = done(ik(tmp_path, lost(tmp_path, slice(None), slice(3, 4))))
    assert any("were not recorded: pelvis3" in w for w in result.warnings)
    text = (result.folder / "ik.json").read_text()
    assert "NaN" not in text and "pelvis3" not in json.loads(text)["markers"]


def test_angles_of_a_left_knee_in_three_directions(tmp_path: Path) -> None:
    """Thigh and shank of a model whose knee is free; the left one mirrors the signs of the right."""
    file = legs.model_file(tmp_path)
    text = file.read_text().replace('<PinJoint name="knee_r">', '<BallJoint name="knee_r">')
    start = text.index('<BallJoint name="knee_r">')
    end = text.index("</PinJoint>", start)
    text = text[:end] + "</BallJoint>" + text[end + len("</PinJoint>") :]
    file.write_text(text.replace('<Coordinate name="knee"/>', "".join(f'<Coordinate name="knee_{a}"/>' for a in "xyz")))
    model = read_multibody(file)
    time, values = legs.motion(model)
    wanted = {"flexion": np.radians(40.0), "adduction": np.radians(7.0), "rotation": np.radians(-11.0)}
    for side in ("left", "right"):
        turned = tibia_in_femur(*(np.array([each]) for each in wanted.values()), side)
        for name, angle in zip("xyz", turned.as_euler("XYZ")[0], strict=True):
            values[:, [c.name == f"knee_{name}" for c in model.coordinates]] = angle
        markers = legs.trc_file(tmp_path, legs.markers_of(model, time, values))
        options = ["--model", file, "--out", tmp_path / side, "--knee", f"{side}=femur_r,tibia_r"]
        table = done(call("ik", markers, *options, folder=tmp_path / side)).table("knees.csv")
        for name, angle in wanted.items():
            np.testing.assert_allclose(table[f"{side}_{name} [deg]"], np.degrees(angle), atol=1e-3)


def test_a_file_in_another_unit_is_refused(tmp_path: Path) -> None:
    file = trc(tmp_path)
    file.write_text(file.read_text().replace("\tmm\t", "\tm\t"), encoding="utf-8")
    result = ik(tmp_path, file)
    assert result.code == 2 and "perhaps it is mm" in result.err


def test_markers_far_from_the_model_are_warned_of(tmp_path: Path) -> None:
    _, model, time, values = legs.planted(tmp_path)
    seen = legs.markers_of(model, time, values)
    mixed = type(seen)(seen.time, seen.positions[:, ::-1], seen.names)
    result = contradicting(ik(tmp_path, legs.trc_file(tmp_path, mixed)))
    assert any("mm from the model" in w and "another subject's size" in w for w in result.warnings)


def off_by(folder: Path, shift: float) -> Call:
    """`ik` of a walk with one marker of 16 off by this [m] in one frame, and by a little in all."""
    _, model, time, values = legs.planted(folder)
    markers = legs.markers_of(model, time, values)
    markers.positions[30, 13] += [0.0, 0.0, shift]
    return done(ik(folder, legs.trc_file(folder, markers)))


def test_marker_errors_stand_beside_opensim_s_limits(tmp_path: Path) -> None:
    """In the last line always, in a warning beyond 2 cm of root mean square or 4 cm at most."""
    small, large = off_by(tmp_path, 0.03), off_by(tmp_path, 0.15)
    told = "mm at most, foot_r1 at 0.3 s (OpenSim advises less than 20 and 40 mm)"
    # a jump within one frame has a warning of its own, at either size
    assert told in small.out and not any("OpenSim" in line for line in small.warnings)
    (line,) = [each for each in large.warnings if "OpenSim" in each]
    assert told in line and "check where foot_r1 is on the model" in line


LAB = {f"{body}{k}": f"S7:{body.upper()}{k}" for body in legs.BODIES for k in range(4)}


def as_in_the_lab(folder: Path) -> Path:
    """The planted walk with the laboratory's names: S7:FOOT_R1 for foot_r1."""
    _, model, time, values = legs.planted(folder)
    markers = legs.markers_of(model, time, values)
    return legs.trc_file(folder, type(markers)(time, markers.positions, tuple(LAB[name] for name in markers.names)))


def test_names_of_the_laboratory_are_mapped(tmp_path: Path) -> None:
    """As typed or from a file, in `ik` and `scale`; without a map the message says which one to pass."""
    file = as_in_the_lab(tmp_path)
    bare = ik(tmp_path, file)
    pairs = ",".join(f"{lab.removeprefix('S7:')}={name}" for name, lab in LAB.items())
    assert bare.code == 2 and "recorded are: PELVIS0" in bare.err and f"perhaps --markers-map {pairs}" in bare.err
    assert done(ik(tmp_path, file, "--markers-map", pairs)).record()["results"]["rms_mm"] < 1e-4
    table = tmp_path / "map.csv"
    table.write_text("recorded,model\n" + pairs.replace(",", "\n").replace("=", ","), encoding="utf-8")
    mapped = done(ik(tmp_path, file, "--markers-map", table))
    assert mapped.record()["results"]["rms_mm"] < 1e-4
    assert any(each["file"] == str(table) for each in mapped.record()["inputs"])
    model = legs.model_file(tmp_path)
    options = ("--scale", "femur_r=femur_r0/femur_r2", "--markers-map", table, "--time", "0:0")
    done(call("scale", file, "--model", model, "--out", tmp_path / "s", *options))


def test_a_map_that_fits_in_part_is_used_with_a_warning(tmp_path: Path) -> None:
    result = done(ik(tmp_path, trc(tmp_path), "--markers-map", "foot_r1=foot_r1,FOOT_r2=foot_r2"))
    assert "--markers-map: FOOT_r2 was not recorded; perhaps foot_r2" in result.warnings
    swapped = ik(tmp_path, trc(tmp_path), "--markers-map", "foot_r1=foot_r2")
    assert swapped.code == 2 and "two markers would be called foot_r2" in swapped.err
    nothing = ik(tmp_path, trc(tmp_path), "--markers-map", "RHEE=R.Heel")
    assert nothing.code == 2 and "does not pair a recorded marker with one of the model" in nothing.err


def test_a_static_trial_has_the_limits_of_scaling(tmp_path: Path) -> None:
    _, model, time, values = legs.planted(tmp_path)
    markers = legs.markers_of(model, time[:1], 0.0 * values[:1])
    markers.positions[:, 13] += [0.0, 0.0, 0.06]
    file = legs.trc_file(tmp_path, markers)
    result = done(call("scale", file, "--model", legs.model_file(tmp_path), "--out", tmp_path / "s"))
    assert any("less than 10 and 20 mm" in line for line in result.warnings)


def test_markers_from_a_file_of_their_own(tmp_path: Path) -> None:
    """In place of the model's; one that is fixed stays where the file has it when a model is made to measure."""
    _, model, time, values = legs.planted(tmp_path)
    places = legs.OSIM[legs.OSIM.index("<MarkerSet>") : legs.OSIM.index("</MarkerSet>")] + "</MarkerSet>"
    places = places.replace('name="foot_r3">', 'name="foot_r3"><fixed>true</fixed>')
    (tmp_path / "set.xml").write_text(f"<OpenSimDocument>{places}</OpenSimDocument>", encoding="utf-8")
    bare = tmp_path / "bare.osim"
    start, end = legs.OSIM.index("<MarkerSet>"), legs.OSIM.index("</MarkerSet>") + len("</MarkerSet>")
    bare.write_text(legs.OSIM[:start] + legs.OSIM[end:], encoding="utf-8")
    seen = legs.markers_of(model, time[:2], 0.0 * values[:2])
    seen.positions[:, 14:] += [0.0, 0.01, 0.0]
    static = legs.trc_file(tmp_path, seen)
    without = call("ik", static, "--model", bare, "--out", tmp_path / "ik")
    assert without.code == 2 and "has no markers" in without.err
    done(call("ik", static, "--model", bare, "--marker-set", tmp_path / "set.xml", "--out", tmp_path / "ik"))
    done(call("scale", static, "--model", bare, "--marker-set", tmp_path / "set.xml", "--out", tmp_path / "s"))
    ours = read_multibody(tmp_path / "s" / "scaled.osim")
    assert [m.name for m in ours.markers] == [m.name for m in model.markers]
    np.testing.assert_array_equal(ours.markers[15].location, model.markers[15].location)
    assert np.abs(ours.markers[14].location - model.markers[14].location).max() > 0.001


def test_the_static_pose_becomes_the_default(tmp_path: Path) -> None:
    file, static = grown(tmp_path)
    done(call("scale", static, "--model", file, "--out", tmp_path / "s", *PAIRS))
    knee = next(c for c in read_multibody(tmp_path / "s" / "scaled.osim").coordinates if c.name == "knee")
    assert knee.default == pytest.approx(0.05, abs=1e-6)
    told = json.loads((tmp_path / "s" / "scale.json").read_text())["static_pose"]
    assert told["knee [deg]"] == pytest.approx(np.degrees(0.05), abs=1e-4)


def test_a_subject_that_moves_is_no_static_trial(tmp_path: Path) -> None:
    file, model, time, values = legs.planted(tmp_path)
    walk = legs.trc_file(tmp_path, legs.markers_of(model, time, values))
    result = done(call("scale", walk, "--model", file, "--out", tmp_path / "s", *PAIRS))
    assert any("is this standing still?" in w for w in result.warnings)
    factors = json.loads((tmp_path / "s" / "scale.json").read_text())["factors"]
    assert factors["tibia_r"] == pytest.approx(1.0, abs=1e-6), "distances are averaged, not places"


def test_a_joint_on_a_frame_of_a_body_is_scaled_or_refused(tmp_path: Path) -> None:
    """A frame that the body owns moves with it, and one that hangs on such a frame.

    Turned against each other and longer along one axis only they are refused: OpenSim lengthens each along its own.
    """
    frame = '<PhysicalOffsetFrame name="spot"><socket_parent>..</socket_parent><translation>0 -0.4 0</translation>'
    owned = legs.OSIM.replace(
        '<Body name="femur_r">', f'<Body name="femur_r"><components>{frame}</PhysicalOffsetFrame></components>'
    )
    owned = owned.replace(
        "<socket_parent>/bodyset/femur_r</socket_parent>", "<socket_parent>/bodyset/femur_r/spot</socket_parent>"
    )
    owned = owned.replace(
        '<translation>0 -0.4 0</translation></PhysicalOffsetFrame>\n<PhysicalOffsetFrame name="knee_r_out">',
        '<translation>0 0 0</translation></PhysicalOffsetFrame>\n<PhysicalOffsetFrame name="knee_r_out">',
    )
    _, static = grown(tmp_path)
    (tmp_path / "owned.osim").write_text(owned, encoding="utf-8")
    contradicting(call("scale", static, "--model", tmp_path / "owned.osim", "--out", tmp_path / "s", *PAIRS))
    knee = next(j for j in read_multibody(tmp_path / "s" / "scaled.osim").joints if j.name == "knee_r")
    np.testing.assert_allclose(knee.parent_offset.translation, [0.0, -0.44, 0.0], atol=1e-6)
    away = owned.replace(
        '<translation>0 0 0</translation></PhysicalOffsetFrame>\n<PhysicalOffsetFrame name="knee_r_out">',
        '<translation>0 -0.1 0</translation></PhysicalOffsetFrame>\n<PhysicalOffsetFrame name="knee_r_out">',
    )
    (tmp_path / "away.osim").write_text(away, encoding="utf-8")
    contradicting(call("scale", static, "--model", tmp_path / "away.osim", "--out", tmp_path / "u", *PAIRS))
    knee = next(j for j in read_multibody(tmp_path / "u" / "scaled.osim").joints if j.name == "knee_r")
    np.testing.assert_allclose(knee.parent_offset.translation, [0.0, -0.55, 0.0], atol=1e-6)
    turned = away.replace("<translation>0 -0.4 0<", "<orientation>0 0 0.5</orientation><translation>0 -0.4 0<")
    (tmp_path / "turned.osim").write_text(turned, encoding="utf-8")
    longer = ("--scale", "femur_r:y=1.1", "--out", tmp_path / "t")
    result = call("scale", static, "--model", tmp_path / "turned.osim", *longer)
    assert result.code == 2 and "is attached to frames in a way that is not scaled" in result.err


REFUSED = {
    "no such marker": (("--weight", "heel=3"), "'heel=3' is not in the model"),
    "a negative weight": (("--weight", "foot_r1=-3"), "negative"),
    "a weight twice": (("--weight", "foot_r1=3", "--weight", "foot_r1=1"), "foot_r1 is given twice"),
    "no such coordinate": (("--hold", "elbow=3"), "'elbow=3' is not in the model"),
    "a span without end": (("--time", "0.3"), "'0.3' is not a span"),
    "a span before the recording": (("--time", "7:8"), "no frame between 7 and 8 s"),
    "mirrored axes": (("--axes", "x,z,y"), "mirrors"),
    "an axis twice": (("--axes", "x,x,y"), "not three different axes"),
    "no such side": (("--knee", "centre=femur_r,tibia_r"), "not a side and two bodies"),
    "no such body": (("--knee", "right=femur_r,patella"), "no body 'patella'"),
    "a knee twice": (("--knee", "left=femur_r,tibia_r", "--knee", "left=tibia_r,foot_r"), "left knee is given twice"),
    "a gap of no time": (("--fill", "-1"), "-1 s cannot be a gap in a recording"),
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


def plates(folder: Path, **columns: np.ndarray) -> Path:
    """The standing leg's plates with some columns exchanged, 100 Hz."""
    motion, _ = standing(folder)
    table = read_table(folder / "grf.mot")
    values = {name: table.column(name).copy() for name in table.channels} | columns
    write_storage(
        folder / "grf.mot", table.time, list(values), np.column_stack(list(values.values())), title="p", degrees=False
    )
    return motion


def test_a_force_that_is_missing_is_not_no_force(tmp_path: Path) -> None:
    gap = np.full(61, WEIGHT)
    gap[30:33] = np.nan
    motion = plates(tmp_path, plate_force_vy=gap)
    result = id_(tmp_path, motion, "--loads", tmp_path / "loads.xml")
    assert result.code == 2 and "missing at 0.3 s and in 3 frames" in result.err


def test_an_unloaded_plate_has_no_point(tmp_path: Path) -> None:
    """Without force no point is needed, even beside a loaded sample; 2 N at 332 m do nothing to the joints."""
    force, point = np.full(61, WEIGHT), np.zeros(61)
    force[:20], point[:20] = 0.0, np.nan
    motion = plates(tmp_path, plate_force_vy=force, plate_force_px=point)
    done(id_(tmp_path, motion, "--loads", tmp_path / "loads.xml"))
    force[:20], point[:20] = 2.0, 332.0
    motion = plates(tmp_path, plate_force_vy=force, plate_force_px=point)
    result = done(id_(tmp_path, motion, "--loads", tmp_path / "loads.xml", "--threshold", "10"))
    assert np.abs(read_table(result.folder / "id.sto").column("knee_moment")[:20]).max() < 1e-6
    far = done(id_(tmp_path, motion, "--loads", tmp_path / "loads.xml"))
    assert any("332 m from the origin of foot_r" in w for w in far.warnings)


def test_the_torque_acts_where_it_is_named(tmp_path: Path) -> None:
    motion = plates(tmp_path, plate_torque_y=np.full(61, 50.0))
    loads = tmp_path / "loads.xml"
    turn = read_table(done(id_(tmp_path, motion, "--loads", loads)).folder / "id.sto").column("hip_y_moment")
    np.testing.assert_allclose(turn, -50.0, rtol=1e-6)
    loads.write_text(loads.read_text().replace("plate_torque_</torque", "</torque"), encoding="utf-8")
    still = read_table(done(id_(tmp_path, motion, "--loads", loads)).folder / "id.sto").column("hip_y_moment")
    np.testing.assert_allclose(still, 0.0, atol=1e-6)
    for old, new in (("plate_force_p<", "other_p<"), ("</torque_identifier>", "other_torque_</torque_identifier>")):
        text = loads.read_text().replace(old, new, 1)
        (tmp_path / "other.xml").write_text(text, encoding="utf-8")
        result = id_(tmp_path, motion, "--loads", tmp_path / "other.xml")
        assert result.code == 2 and "does not belong to the force" in result.err


def test_plates_of_a_laboratory_whose_z_is_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As a .c3d file has them, named on the command line and turned; without --axes they are refused."""
    motion, _ = standing(tmp_path)
    (plate,) = read_force_plates(tmp_path / "grf.mot")
    lab = Rotation.from_matrix([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]).inv()
    wrench = plate.wrench
    turned = Wrench(lab.apply(wrench.force), lab.apply(wrench.moment), lab.apply(wrench.origin), LABORATORY_FRAME)
    there = replace(plate, name="plate 1", wrench=turned, point=lab.apply(plate.point), normal=lab.apply(plate.normal))
    monkeypatch.setattr("geocontact.analyses.motion.inverse_dynamics.loads.read_force_plates", lambda _, __: (there,))
    options = ("--plates", tmp_path / "grf.mot", "--plate", "1=foot_r")
    found = read_table(done(id_(tmp_path, motion, *options, "--axes", "x,z,-y")).folder / "id.sto")
    np.testing.assert_allclose(found.column("ty_force"), 0.0, atol=1e-6)
    np.testing.assert_allclose(found.column("hip_x_moment"), -WEIGHT * (0.1 - PLUMB[2]), rtol=1e-9)
    as_it_is = id_(tmp_path, motion, *options)
    assert as_it_is.code == 2 and "its floor's normal is 0 0 1" in as_it_is.err


def test_opensim_s_own_plates_are_not_turned(tmp_path: Path) -> None:
    motion, _ = standing(tmp_path)
    result = id_(tmp_path, motion, "--plates", tmp_path / "grf.mot", "--plate", "1=foot_r", "--axes", "x,z,-y")
    assert result.code == 0 and any("turns the markers, not these plates" in line for line in result.warnings)
    done(id_(tmp_path, motion, "--plates", tmp_path / "grf.mot", "--plate", "plate_force=foot_r"))


ID_REFUSED = {
    "plates without a body": (("--plates", "grf.mot"), "belong together"),
    "a plate without its file": (("--plate", "1=foot_r"), "belong together"),
    "axes without plates": (("--axes", "x,z,-y"), "has no effect without plates"),
    "a threshold below nothing": (("--threshold", "-3"), "-3 N cannot be the force"),
    "a cut-off above half the rate": (("--cutoff", "70"), "--cutoff"),
    "a negative cut-off": (("--cutoff", "-1"), "-1 Hz cannot be a cut-off frequency"),
    "no such span": (("--time", "3:4"), "no frame between 3 and 4 s"),
    "a plate twice": (
        ("--plates", __file__, "--plate", "1=foot_r", "--plate", "1=foot_l"),
        "plate 1 is given twice: its force would act twice",
    ),
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


def test_a_body_grows_along_its_own_axes_by_pairs_and_by_numbers(tmp_path: Path) -> None:
    """An axis of which nothing is said keeps its length; a body that grows alike has one number in the results."""
    file, static = grown(tmp_path)
    told = ("--scale", "femur_r:y=femur_r0/femur_r2", "--scale", "femur_r:x=1.05", "--scale", "tibia_r=0.95")
    done(call("scale", static, "--model", file, "--out", tmp_path / "s", "--keep-markers", *told))
    factors = json.loads((tmp_path / "s" / "scale.json").read_text())["factors"]
    assert list(factors) == ["femur_r x", "femur_r y", "femur_r z", "tibia_r"]
    assert list(factors.values()) == pytest.approx([1.05, 1.1, 1.0, 0.95], abs=1e-6)
    before, after = read_multibody(file), read_multibody(tmp_path / "s" / "scaled.osim")
    thigh = [
        (m.location, n.location) for m, n in zip(before.markers, after.markers, strict=True) if m.body == "femur_r"
    ]
    for old, new in thigh:
        np.testing.assert_allclose(new, old * [1.05, 1.1, 1.0], atol=1e-6)


SCALE_REFUSED = {
    "an axis twice": (("--scale", "femur_r=1.1", "--scale", "femur_r:x=1.2"), "body 'femur_r' is named twice"),
    "no such axis": (("--scale", "femur_r:w=1.1"), "'w' is not one or more of the axes x, y and z"),
    "no pair": (("--scale", "femur_r=femur_r0"), "not bodies and pairs"),
    "no such body": (("--scale", "arm=femur_r0/femur_r2"), "no body 'arm'"),
    "a body twice": ((*PAIRS, *PAIRS), "body 'femur_r' is named twice"),
    "no such marker": (("--scale", "femur_r=femur_r0/heel"), "the model has no marker heel"),
    "a mass of nothing": ((*PAIRS, "--mass", "0"), "0 kg cannot be the mass of a person"),
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
