"""Centre and axis of a joint from markers: command and call on a synthetic leg whose joints are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.motion.functional_joint import result
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.mocap.trc import read_trc
from tests import legs
from tests.cli.calls import call, done

PELVIS, FEMUR, TIBIA = (",".join(f"{body}{k}" for k in range(4)) for body in ("pelvis", "femur_r", "tibia_r"))


@pytest.fixture
def leg(tmp_path: Path) -> tuple[Multibody, np.ndarray, Path]:
    """Model, coordinates and markers of a swing that moves all joints by 36 deg to either side."""
    _, model, time, values = legs.planted(tmp_path, amplitude=2.5)
    return model, values, legs.trc_file(tmp_path, legs.markers_of(model, time, values))


def at(model: Multibody, values: np.ndarray, name: str) -> np.ndarray:
    """Where a joint is in the ground [m]."""
    joint = next(each for each in model.joints if each.name == name)
    return model.poses(values)[joint.child].apply(joint.child_offset.translation)


def test_a_hip_becomes_a_marker(leg: tuple[Multibody, np.ndarray, Path], tmp_path: Path) -> None:
    model, values, file = leg
    out = tmp_path / "out"
    typed = done(call("joint", file, "--first", PELVIS, "--second", FEMUR, "--name", "HIP", "--out", out, folder=out))
    hip = read_trc(out / "markers.trc")
    np.testing.assert_allclose(hip.of(("HIP",))[:, 0], at(model, values, "hip_r"), atol=2e-6)
    assert hip.names[:-1] == read_trc(file).names
    table = typed.table("joint.csv")
    np.testing.assert_allclose(table[[f"second_{a} [mm]" for a in "xyz"]], 1e3 * at(model, values, "hip_r"), atol=2e-3)
    told = typed.record()["results"]
    assert told["turn_deg"] > 10.0 and told["halves_apart_mm"] < 0.01 and max(told["first"]["point_sd_mm"]) < 1e-3
    called = gc.functional_joint(file, first=PELVIS, second=FEMUR, name="HIP").write(tmp_path / "called")
    for name in ("joint.json", "joint.csv", "markers.trc"):
        assert typed.bytes(name) == (called / name).read_bytes(), name


def test_a_knee_becomes_two_markers_of_the_standing_trial(
    leg: tuple[Multibody, np.ndarray, Path], tmp_path: Path
) -> None:
    """On its axis, 10 cm apart, about the middle of the markers named; in another pose than any of the trial."""
    model, values, file = leg
    still = values[:3] * 0.0 + 0.1
    names = tuple(m.name for m in model.markers)
    (tmp_path / "still").mkdir()
    standing = legs.trc_file(
        tmp_path / "still", MarkerTrajectories(np.arange(3) / 100.0, model.marker_places(still), names)
    )
    found = gc.functional_joint(
        file, first=FEMUR, second=TIBIA, axis=True, static=standing, near="tibia_r0,tibia_r1", name="KNEE"
    )
    assert found.markers.source == str(standing) and found.markers.names[-2:] == ("KNEE_1", "KNEE_2")
    one, two = found.markers.of(("KNEE_1", "KNEE_2"))[0]
    axis = (two - one) / 0.1
    np.testing.assert_allclose(np.linalg.norm(two - one), 0.1, atol=1e-9)
    centre = at(model, still, "knee_r")[0]
    np.testing.assert_allclose(np.cross(one - centre, axis), 0.0, atol=1e-5)
    near = found.pair.shown.of(("tibia_r0", "tibia_r1"))[0].mean(axis=0)
    assert abs((0.5 * (one + two) - near) @ axis) < 1e-8
    assert found.points.looseness is not None and found.points.looseness < 1e-3


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--first", PELVIS, "--second", "femur_r0,femur_r1"), "2 markers do not determine a pose"),
        (("--first", PELVIS, "--second", "femur_r0,femur_r1,nowhere"), "no marker nowhere"),
        (("--first", PELVIS, "--second", f"{FEMUR},pelvis1"), "pelvis1 is of both segments"),
        (("--first", PELVIS, "--second", FEMUR, "--name", "pelvis0"), "there is a marker pelvis0 already"),
        (("--first", FEMUR, "--second", TIBIA), "for a hinge give --axis"),
        (("--first", FEMUR, "--second", TIBIA, "--near", "femur_r0"), "--near: has no effect without --axis"),
    ],
)
def test_what_is_refused(
    leg: tuple[Multibody, np.ndarray, Path], tmp_path: Path, options: tuple[str, ...], said: str
) -> None:
    told = call("joint", leg[2], *options, "--out", tmp_path / "out")
    assert told.code == 2 and said in told.err and len(told.complaints) == 1 and not (tmp_path / "out").exists()


def test_skin_and_exchanged_markers_are_told(leg: tuple[Multibody, np.ndarray, Path], tmp_path: Path) -> None:
    model, values, _ = leg
    places = model.marker_places(values)
    names = tuple(m.name for m in model.markers)
    moved = names.index("femur_r1")
    places[:, moved] += 0.06 * np.sin(np.arange(len(places)) / 7.0)[:, None]
    (tmp_path / "skin").mkdir()
    file = legs.trc_file(tmp_path / "skin", MarkerTrajectories(np.arange(len(places)) / 100.0, places, names))
    with pytest.warns(gc.InputWarning) as told:
        found = gc.functional_joint(file, first=PELVIS, second=FEMUR)
    said = [str(each.message) for each in told]
    assert any("mm from a rigid segment" in line for line in said)
    assert found.summary["halves_apart_mm"] > 20.0 and any("two halves of the trial give" in line for line in said)


def test_the_answer_says_where_the_joint_is_and_how_sure(leg: tuple[Multibody, np.ndarray, Path]) -> None:
    """The centre in the pelvis' markers: their mean in the first frame, the hip by forward kinematics."""
    model, values, file = leg
    found = gc.functional_joint(file, first=PELVIS, second=FEMUR)
    markers = read_trc(file)
    mean = markers.of(tuple(PELVIS.split(",")))[0].mean(axis=0)
    expected = 1e3 * (at(model, values[:1], "hip_r")[0] - mean)
    told = found.sentences[0]
    shown = np.array([float(part) for part in told.removeprefix("centre at ").partition(" mm")[0].split(", ")])
    np.testing.assert_allclose(shown, expected, atol=0.06)
    assert told.endswith("(standard errors 0.0, 0.0, 0.0 mm)") and PELVIS.replace(",", ", ") in told
    np.testing.assert_allclose(1e3 * found.point, expected, atol=1e-2)
    facts = dict(found.facts())
    assert (
        found.rms < 1e-6
        and facts["largest standard error"] == "0.00 mm"
        and facts["residual, root mean square"] == "0.00 mm"
    )
    assert np.allclose([float(x) for x in facts["place in the first segment"].removesuffix(" mm").split(", ")], shown)


def test_an_axis_is_compared_with_the_line_of_two_markers(leg: tuple[Multibody, np.ndarray, Path]) -> None:
    """Angle between the hinge's axis and two markers of the first frame, whose axes the axis is in; by arccos here."""
    _, _, file = leg
    found = gc.functional_joint(file, first=FEMUR, second=TIBIA, axis=True, near="femur_r0,femur_r1")
    markers = read_trc(file).of(("femur_r0", "femur_r1"))
    line = markers[0, 1] - markers[0, 0]
    along = np.diff(found.points.first, axis=0)[0]
    turn = np.degrees(np.arccos(abs(line @ along) / np.linalg.norm(line) / np.linalg.norm(along)))
    assert found.sentences[1] == f"the axis is {turn:.1f} deg from the line through femur_r0 and femur_r1"
    assert "halves of the trial give axes 0.0 mm apart" in found.sentences[2]
    assert found.sentences[0].startswith("axis through ") and dict(found.facts())["direction"].count(",") == 2


def test_the_rotation_is_the_largest_between_any_two_frames(
    leg: tuple[Multibody, np.ndarray, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A hinge that swings to either side of its first frame turns by the range of its angle, a hip as all pairs say."""
    model, values, file = leg
    time, knee = np.arange(101) / 50.0, [each.name for each in model.coordinates].index("knee")
    bent = np.repeat(values[:1], len(time), axis=0)
    bent[:, knee] -= 0.6 * np.sin(np.pi * time)
    (tmp_path / "bent").mkdir()
    swing = legs.trc_file(tmp_path / "bent", legs.markers_of(model, time, bent))
    found = gc.functional_joint(swing, first=FEMUR, second=TIBIA, axis=True)
    whole, from_first = np.degrees(1.2), np.degrees(0.6)
    assert found.summary["turn_deg"] == pytest.approx(whole, abs=1e-3) and whole > from_first + 10.0
    assert f"{whole:.0f} degrees between the two that are turned farthest apart" in found.sentences[1]
    assert dict(found.facts())["largest rotation between two frames"] == f"{whole:.0f}°"
    hip = gc.functional_joint(file, first=PELVIS, second=FEMUR)
    turns = hip.pair.first_poses.rotation.inv() * hip.pair.second_poses.rotation
    pairs = [float((turn.inv() * turns).magnitude().max()) for turn in turns]
    assert hip.summary["turn_deg"] == pytest.approx(np.degrees(max(pairs)), rel=1e-9)
    monkeypatch.setattr(result, "COMPARED", len(turns) // 3)
    assert 0.97 * max(pairs) < result.turned(hip.pair) <= max(pairs) + 1e-12, "every fourth frame"


def test_advice_fits_the_kind_of_joint(leg: tuple[Multibody, np.ndarray, Path], tmp_path: Path) -> None:
    model, values, _ = leg
    names = tuple(m.name for m in model.markers)
    places = model.marker_places(values)
    slid = 0.06 * np.sin(np.arange(len(places)) / 7.0)[:, None]
    for name in ("femur_r1", "tibia_r1"):
        places[:, names.index(name)] += slid
    file = legs.trc_file(tmp_path, MarkerTrajectories(np.arange(len(places)) / 100.0, places, names))
    for first, second, axis, fits, not_this in (
        (FEMUR, TIBIA, True, "bend and stretch the hinge", "a hip"),
        (PELVIS, FEMUR, False, "a hip forward, sideways and round", "hinge"),
    ):
        with pytest.warns(gc.InputWarning) as told:
            gc.functional_joint(file, first=first, second=second, axis=axis)
        (line,) = (str(each.message) for each in told if "two halves of the trial give" in str(each.message))
        assert fits in line and not_this not in line
