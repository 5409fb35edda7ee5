"""Folders as OpenCap, AddBiomechanics, Pose2Sim and laboratories leave them; all made here, synthetic."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.motion.folder_inputs import folder_inputs
from geocontact.data.errors import InputError
from geocontact.io.mocap.markers import read_markers
from geocontact.io.mocap.trc import read_trc
from geocontact.io.recordings.tool_folder import read_tool_folder
from tests import legs
from tests.cli.calls import MESHES, Call, call, done
from tests.trial_checks.as_c3d import write_c3d

SESSION = "calibrationSettings:\n  mass_kg: 1\nheight_m: 1.8\nmass_kg: {}\nopenSimModel: leg\nsubjectID: synthetic\n"


@pytest.fixture(scope="module")
def leg(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Model, motion and markers of a leg that swings and stands, and a plate under it."""
    folder = tmp_path_factory.mktemp("leg")
    _, model, time, values = legs.planted(folder)
    legs.mot_file(folder, model, time, values)
    legs.plate_files(folder, time, (20.0, 200.0, 5.0), (0.1, 0.0, 0.05))
    legs.trc_file(folder, legs.markers_of(model, time, 0.0 * values + values[:1])).rename(folder / "still.trc")
    legs.trc_file(folder, legs.markers_of(model, time, values))
    return folder


def mass_of(leg: Path) -> float:
    return legs.read_multibody(leg / "leg.osim").mass


def put(leg: Path, root: Path, *pairs: tuple[str, str]) -> Path:
    for name, place in pairs:
        (root / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(leg / name, root / place)
    return root


def opencap(leg: Path, root: Path, mass: float | None = None) -> Path:
    root.mkdir()
    (root / "sessionMetadata.yaml").write_text(SESSION.format(mass or mass_of(leg)))
    return put(
        leg,
        root,
        ("leg.osim", "OpenSimData/Model/leg_scaled.osim"),
        ("walk.mot", "OpenSimData/Kinematics/walk1.mot"),
        ("walk.trc", "MarkerData/walk1.trc"),
        ("still.trc", "MarkerData/neutral.trc"),
        ("walk.trc", "Videos/Cam0/notes.txt"),
    )


def addbiomechanics(leg: Path, root: Path) -> Path:
    put(
        leg,
        root,
        ("leg.osim", "Models/match_markers_and_physics.osim"),
        ("leg.osim", "Models/match_markers_but_ignore_physics.osim"),
        ("leg.osim", "Models/unscaled_generic.osim"),
        ("walk.mot", "IK/walk_segment_0_ik.mot"),
        ("walk.trc", "MarkerData/walk_segment_0.trc"),
        ("loads.xml", "ID/walk_segment_0_external_forces.xml"),
        ("grf.mot", "ID/grf.mot"),
    )
    (root / "_subject.json").write_text(json.dumps({"massKg": f"{mass_of(leg)}", "heightM": 1.8}))
    return root


def pose2sim(leg: Path, root: Path) -> Path:
    trial = "T01_Walk/pose-3d/T01_Walk_0-100"
    put(leg, root, ("still.trc", f"{trial}.trc"), ("still.trc", f"{trial}_filt_butterworth.trc"))
    put(leg, root, ("walk.trc", f"{trial}_filt_butterworth_LSTM.trc"))
    put(leg, root, ("leg.osim", "T01_Walk/kinematics/T01_Walk_0-100_filt_butterworth_LSTM.osim"))
    (root / "Config.toml").write_text(
        f"[project]\nparticipant_mass = [{mass_of(leg)}]\n[kinematics]\nuse_augmentation = true\n"
    )
    return root


def same(ours: Call, theirs: Call, *names: str) -> None:
    for name in names:
        assert ours.bytes(name) == theirs.bytes(name), name


def test_a_session_of_opencap_is_one_word(leg: Path, tmp_path: Path) -> None:
    """Three words in place of five and of two paths inside of it; the numbers are the same to the byte."""
    root, out = opencap(leg, tmp_path / "session"), tmp_path / "out"
    before = (
        "ik",
        root / "MarkerData/walk1.trc",
        "--model",
        root / "OpenSimData/Model/leg_scaled.osim",
        "--out",
        out / "a",
    )
    after = ("ik", root, "--out", out / "b")
    assert (len(before), len(after)) == (6, 4)
    theirs, ours = (done(call(*words, folder=words[-1])) for words in (before, after))
    same(ours, theirs, "ik.mot", "markers.csv")
    told = ours.record()["folder"]
    assert [told["kind"], told["trial"], told["unused_files"]] == ["OpenCap session", "walk1", 1]
    assert {row["part"]: row["file"] for row in told["parts"]} == {
        "markers": "MarkerData/walk1.trc",
        "model": "OpenSimData/Model/leg_scaled.osim",
        "person": "sessionMetadata.yaml",
    }
    assert "folder" not in theirs.record() and not told["warnings"]
    assert all(row["file"] in ours.out for row in told["parts"]) and "1 other file not used" in ours.out
    assert "the inputs are the same" in call("rerun", out / "b").out


def test_named_trials_have_a_folder_each(leg: Path, tmp_path: Path) -> None:
    root = opencap(leg, tmp_path / "session")
    done(call("ik", root, "--trial", "walk1", "--trial=neutral", "--out", tmp_path / "o"))
    assert {file.parent.name for file in (tmp_path / "o").glob("*/ik.mot")} == {"walk1", "neutral"}
    made = done(call("markers", root, "--out", tmp_path / "m", folder=tmp_path / "m"))
    theirs = done(
        call("markers", leg / "walk.mot", "--model", leg / "leg.osim", "--out", tmp_path / "n", folder=tmp_path / "n")
    )
    same(made, theirs, "markers.trc")


def test_a_subject_of_addbiomechanics_has_its_loads(leg: Path, tmp_path: Path) -> None:
    root = addbiomechanics(leg, tmp_path / "subject")
    named = ("--model", leg / "leg.osim", "--loads", leg / "loads.xml", "--out", tmp_path / "a")
    theirs = call("id", leg / "walk.mot", *named, folder=tmp_path / "a")
    ours = call("id", root, "--out", tmp_path / "b", folder=tmp_path / "b")
    assert ours.code == theirs.code == 1  # a constant load under a leg that swings contradicts it, either way
    assert [row["part"] for row in ours.record()["folder"]["parts"]] == ["coordinates", "model", "loads", "person"]
    same(ours, theirs, "id.sto")
    (one,) = folder_inputs("id", root)
    assert dict(one.options)["model"].endswith("match_markers_and_physics.osim")
    typed = folder_inputs("id", root, typed=frozenset({"loads", "model"}))
    assert not typed[0].options
    nested = tmp_path / "nested"
    shutil.copytree(root, nested / "results")
    (nested / "results" / "_subject.json").rename(nested / "_subject.json")
    for place in (nested, nested / "results"):  # the person's file lies beside the second
        (one,) = folder_inputs("ik", place)
        assert one.recording.name == "walk_segment_0.trc"
        assert Path(next(part.file for part in one.parts if part.part == "person")).name == "_subject.json"


def test_loads_that_are_missing_are_said(leg: Path, tmp_path: Path) -> None:
    root = opencap(leg, tmp_path / "session")
    ours = done(call("id", root, "--out", tmp_path / "b", folder=tmp_path / "b"))
    assert any("no ground reaction belongs to walk1" in line for line in ours.warnings)
    assert any("no ground reaction" in line for line in ours.record()["warnings"])


def test_a_project_of_pose2sim_gives_its_last_step(leg: Path, tmp_path: Path) -> None:
    root = pose2sim(leg, tmp_path / "project")
    (one,) = folder_inputs("ik", root)
    assert one.trial == "T01_Walk" and one.recording.name.endswith("_LSTM.trc")
    assert one.parts[0].note == "the last step of 3 files"
    config = root / "Config.toml"
    config.write_text(config.read_text().replace("true", "false"))
    assert folder_inputs("ik", root)[0].recording.name.endswith("_filt_butterworth.trc")
    with pytest.raises(InputError, match="no trial has coordinates; compute them first: geocontact ik"):
        folder_inputs("id", root)


def test_static_trials_are_known_by_name_and_by_standing(leg: Path, tmp_path: Path) -> None:
    root = put(
        leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("still.trc", "P1_cal01.trc"), ("walk.trc", "P1_walk.trc")
    )
    assert [one.trial for one in folder_inputs("ik", root)] == ["P1_walk"]
    (one,) = folder_inputs("scale", root)
    assert one.trial == "P1_cal01" and not one.warnings
    done(call("scale", root, "--mass", "30", "--out", tmp_path / "s", folder=tmp_path / "s"))
    (root / "P1_cal01.trc").rename(root / "calf.trc")
    (one,) = folder_inputs("scale", root)
    assert one.trial == "calf" and "no name says static" in one.warnings[0]
    (root / "calf.trc").unlink()
    (root / "P1_walk.trc").rename(root / "static.trc")
    (one,) = folder_inputs("scale", root)
    assert "its name says static, and its markers move" in one.warnings[0]


def test_trials_are_read_once_however_often_a_form_asks(
    leg: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whether they stand still; a file that changed is read again."""
    pairs = (("leg.osim", "leg.osim"), ("walk.trc", "a.trc"), ("still.trc", "b.trc"), ("walk.trc", "c.trc"))
    root = put(leg, tmp_path / "laboratory", *pairs)
    files: list[str] = []

    def reading(file: Path, unit: str | None) -> object:
        files.append(file.name)
        return read_markers(file, unit)

    monkeypatch.setattr("geocontact.analyses.motion.folder_inputs.read_markers", reading)
    assert [one.trial for one in folder_inputs("ik", root)] == ["a", "c"]
    assert [one.trial for one in folder_inputs("ik", root, typed=frozenset({"cutoff"}))] == ["a", "c"]
    assert files == ["a.trc", "b.trc", "c.trc"]
    (root / "c.trc").write_bytes((leg / "still.trc").read_bytes())
    (root / "b.trc").write_bytes((leg / "walk.trc").read_bytes() + b"\n")
    assert [one.trial for one in folder_inputs("ik", root)] == ["a", "b"]
    assert files[3:] == ["b.trc", "c.trc"]


def test_the_person_is_confronted_with_the_model(leg: Path, tmp_path: Path) -> None:
    root = opencap(leg, tmp_path / "session", mass=1.3 * mass_of(leg))
    (one,) = folder_inputs("ik", root)
    assert "is it scaled?" in one.warnings[0]
    done(call("ik", root, "--out", tmp_path / "o", folder=tmp_path / "o"))
    (scale,) = folder_inputs("scale", root, typed=frozenset({"model"}))
    assert float(dict(scale.options)["mass"]) == pytest.approx(1.3 * mass_of(leg)) and scale.trial == "neutral"


def test_what_is_not_clear_is_refused_in_one_line(leg: Path, tmp_path: Path) -> None:
    root = opencap(leg, tmp_path / "session")
    for words, line in (
        (("ik", root, "--trial", "run"), "no trial 'run'; there are neutral, walk1"),
        (("id", root, "--trial", "neutral"), "trial 'neutral' has no coordinates"),
        (("scale", root), "holds no generic model to scale; name a generic model with --model"),
        (("ik", leg / "walk.trc", "--trial", "a"), "--trial: has no effect without a folder"),
        (("ik", root, "--trial"), "--trial: is missing its name"),
        (
            ("ik", tmp_path / "x.b3d"),
            "x.b3d: is AddBiomechanics' own format; its only reader, nimblephysics, has had no",
        ),
        (
            ("id", tmp_path / "x.b3d"),
            "download the subject's OpenSim results (.osim, .mot, .trc), and name that folder",
        ),
    ):
        refused = call(*words, "--out", tmp_path / "no") if words[-1] != "--trial" else call(*words)
        assert refused.code == 2 and line in refused.err and len(refused.complaints) == 1, refused.err
    shutil.copy(leg / "leg.osim", root / "OpenSimData/Model/other.osim")
    assert folder_inputs("ik", root)  # the metadata name the model that is meant
    (root / "sessionMetadata.yaml").write_text("mass_kg: heavy\n")
    with pytest.raises(InputError, match=r"sessionMetadata.yaml mass_kg: .*heavy.* is no size of a person"):
        read_tool_folder(root)
    (root / "sessionMetadata.yaml").unlink()
    with pytest.raises(InputError, match=r"holds 2 models: leg_scaled.osim, other.osim; name it with `model`"):
        folder_inputs("ik", root)
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="is no folder of trials"):
        read_tool_folder(tmp_path / "empty")
    (tmp_path / "empty" / "a.b3d").write_bytes(b"")
    with pytest.raises(InputError, match="b3d only"):
        read_tool_folder(tmp_path / "empty")
    (tmp_path / "empty" / "a.c3d").write_bytes(b"\x02\x50" + 600 * b"\0" + b"pelvis_4X4")
    with pytest.raises(InputError, match=r"a.c3d: cannot be read"):
        folder_inputs("ik", tmp_path / "empty")
    two = put(leg, tmp_path / "two", ("leg.osim", "leg.osim"), ("still.trc", "cal1.trc"), ("still.trc", "static2.trc"))
    with pytest.raises(InputError, match="2 trials are static: cal1, static2; say which one with `trial`"):
        folder_inputs("scale", two)


EXTERNAL = """<OpenSimDocument Version="40000"><ExternalLoads name="loads"><objects><ExternalForce name="right">
<applied_to_body>foot_r</applied_to_body><force_identifier>right_force_v</force_identifier>
<point_identifier>right_force_p</point_identifier></ExternalForce></objects><datafile>plates.mot</datafile>
</ExternalLoads></OpenSimDocument>"""


def test_a_whole_body_that_stands_up_is_one_word(tmp_path: Path) -> None:
    """Model, height, plates, which is under which foot, and the chair: the same study as with all of it named."""
    body, root = MESHES / "whole_body", tmp_path / "subject"
    for name, place in (
        ("body.osim", "Models/final.osim"),
        ("ik.mot", "IK/up_ik.mot"),
        ("plates.mot", "ID/plates.mot"),
    ):
        (root / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(body / name, root / place)
    (root / "ID/up_external_forces.xml").write_text(EXTERNAL)
    (root / "_subject.json").write_text(json.dumps({"massKg": "70", "heightM": 1.75}))
    command = ("sit-to-stand", "coordinates")
    named = ("--model", body / "body.osim", "--plates", body / "plates.mot", "--feet", "right_force,left_force")
    theirs = done(
        call(*command, body / "ik.mot", *named, "--chair", "chair_force", "--height", "1.75", "--out", tmp_path / "a")
    )
    ours = done(call(*command, root, "--out", tmp_path / "b", folder=tmp_path / "b"))
    assert theirs.code == ours.code == 0
    for name in ("coordinates.mot", "plates.mot"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    studies = [(tmp_path / each / "study.toml").read_text().splitlines()[1:] for each in "ab"]
    assert studies[0] == studies[1] and any("feet_force" in line for line in studies[0])
    parts = {row["part"]: row["file"] for row in ours.record()["folder"]["parts"]}
    assert parts["plates"] == "ID/plates.mot"
    (root / "ID/up_external_forces.xml").unlink()
    (alone,) = folder_inputs("sit-to-stand coordinates", root)
    assert any("no plates belong to up" in line for line in alone.warnings)
    assert dict(alone.options)["height"] == "1.75"


NAMES = (
    "sit_to_stand1 sitToStand standToSit stand2sit stand_up standing_up oneLegStand stand_and_reach walk_standard calf"
)
STATIC = "static1 Static_Pose stand01 standing P1_stand neutral T-pose tPose left-static P1_cal01 stat2"


def test_standing_up_is_no_standing(leg: Path, tmp_path: Path) -> None:
    """Sitting down, standing up and one leg are movements; every trial that is left out is printed."""
    for name in NAMES.split():
        root = put(leg, tmp_path / "names" / name, ("walk.trc", f"{name}.trc"))
        assert not read_tool_folder(root).trials[0].static, name
    for name in STATIC.split():
        root = put(leg, tmp_path / "names" / name, ("walk.trc", f"{name}.trc"))
        assert read_tool_folder(root).trials[0].static, name
    root = opencap(leg, tmp_path / "session")
    put(leg, root, ("walk.mot", "OpenSimData/Kinematics/sit_to_stand1.mot"))
    for command in ("id", "markers", "sit-to-stand coordinates"):
        found = folder_inputs(command, root)
        assert [one.trial for one in found] == ["sit_to_stand1", "walk1"], command
        assert found[0].left_out == ("neutral (no coordinates)",)
    put(leg, root, ("walk.mot", "OpenSimData/Kinematics/static2.mot"))
    (root / "OpenSimData/Kinematics/sit_to_stand1.mot").unlink()
    ours = done(call("markers", root, "--out", tmp_path / "o", folder=tmp_path / "o"))
    assert "trial left out: static2 (static by its name)" in ours.out
    assert ours.record()["folder"]["left_out"] == ["neutral (no coordinates)", "static2 (static by its name)"]


def recorded(leg: Path, file: Path, unit: str = "mm", loads: tuple[float, ...] = ()) -> Path:
    """A .c3d of the leg that swings, with a plate under each load [N]."""
    seen = read_trc(leg / "walk.trc")
    still = np.zeros((len(seen.time), 3))
    plates = tuple((np.add(still, (0.0, load, 0.0)), np.add(still, (0.1, 0.0, 0.05)), still) for load in loads)
    write_c3d(file, seen.names, seen.positions, legs.RATE, plates)
    if unit != "mm":
        import ezc3d

        content = ezc3d.c3d(str(file))
        content["parameters"]["POINT"]["UNITS"]["value"] = [unit]
        content.write(str(file))
    return file


def test_plates_of_a_c3d_are_not_passed_over(leg: Path, tmp_path: Path) -> None:
    """Nothing but gravity acts only where no plate was recorded; loads of one trial act in one."""
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.mot", "walk.mot"))
    plated = recorded(leg, root / "walk.c3d", loads=(200.0, 150.0))
    refused = call("id", root, "--out", tmp_path / "no")
    assert refused.code == 2 and "holds 2 force plates" in refused.err, refused.err
    assert f"give --plates {plated} --plate 1=calcn_r" in refused.err and len(refused.complaints) == 1
    (one,) = folder_inputs("id", root, typed=frozenset({"plates", "plate"}))
    assert not one.warnings
    recorded(leg, plated)
    assert "nothing but gravity acts" in folder_inputs("id", root)[0].warnings[0]
    put(leg, root, ("walk.mot", "run.mot"), ("walk.trc", "run.trc"))
    with pytest.raises(InputError, match=r"`plates`: is of one trial, and there are run, walk; choose with `trial`"):
        folder_inputs("id", root, typed=frozenset({"plates", "plate"}))


def test_a_trial_that_cannot_be_read_costs_no_other(leg: Path, tmp_path: Path) -> None:
    """Markers without a unit, or none at all, are left out with a note; the unit that is typed counts."""
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("still.trc", "static.trc"), ("walk.trc", "walk.trc"))
    recorded(leg, root / "odd.c3d", unit="")
    for command, trial in (("ik", "walk"), ("scale", "static")):
        (one,) = folder_inputs(command, root)
        assert one.trial == trial and "trial odd is left out" in one.warnings[0], one.warnings
        assert "state it with `c3d_unit`" in one.warnings[0]
    assert [one.trial for one in folder_inputs("ik", root, c3d_unit="mm")] == ["odd", "walk"]
    done(call("scale", root, "--c3d-unit", "mm", "--mass=30", "--out", tmp_path / "s", folder=tmp_path / "s"))
    for name in ("walk.trc", "static.trc"):
        (root / name).unlink()
    refused = call("ik", root, "--out", tmp_path / "no")
    assert refused.code == 2 and "state it with --c3d-unit m, cm" in refused.err, refused.err
    ours = call("ik", root, "--c3d-unit", "mm", "--axes", "x,z,-y", "--out", tmp_path / "o", folder=tmp_path / "o")
    assert done(ours).record()["results"]["rms_mm"] < 1e-3


def test_poses_of_segments_are_refused_with_the_reason(leg: Path, tmp_path: Path) -> None:
    """Theia's .c3d holds no point; beside others it is left out."""
    ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.trc", "walk.trc"))
    content = ezc3d.c3d()
    content["parameters"]["POINT"]["RATE"]["value"] = [100]
    content["data"]["points"] = np.zeros((4, 0, 50))
    content.add_parameter("ROTATION", "LABELS", ["worldbody_4X4", "pelvis_4X4", "l_thigh_4X4"])
    content.write(str(root / "poses.c3d"))
    refused = call("scale", root / "poses.c3d", "--model", leg / "leg.osim", "--mass", "23", "--out", tmp_path / "no")
    line = "ROTATION:LABELS: holds poses of segments (…_4X4), as Theia writes them, in place of markers"
    assert refused.code == 2 and line in refused.err and len(refused.complaints) == 1, refused.err
    refused = call("ik", root / "poses.c3d", "--model", leg / "leg.osim", "--out", tmp_path / "no")
    line = "ROTATION: holds no poses of segments; is the file complete?"
    assert refused.code == 2 and line in refused.err and len(refused.complaints) == 1, refused.err
    (one,) = folder_inputs("ik", root)
    assert one.trial == "walk" and line in one.warnings[0]


def test_two_files_of_one_trial_cost_no_other(leg: Path, tmp_path: Path) -> None:
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.trc", "walk.trc"), ("walk.trc", "walk2.trc"))
    recorded(leg, root / "walk.c3d")
    both = "walk.c3d and walk.trc are of one trial; name the file that is meant"
    (one,) = folder_inputs("ik", root)
    assert one.trial == "walk2" and both in one.warnings[0]
    assert [each.trial for each in folder_inputs("ik", root, ["walk2"])] == ["walk2"]
    with pytest.raises(InputError, match=both):
        folder_inputs("ik", root, ["walk"])
    (root / "walk2.trc").unlink()
    with pytest.raises(InputError, match=both):
        folder_inputs("ik", root)
    put(leg, root, ("walk.mot", "walk.mot"))
    assert folder_inputs("markers", root)[0].recording.name == "walk.mot", "markers are not needed"


def test_a_folder_after_a_flag_is_a_folder(leg: Path, tmp_path: Path) -> None:
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("still.trc", "static.trc"))
    for flag in ("--mass-by-volume", "--no-overwrite"):
        done(call("scale", "--mass=30", flag, root, "--out", tmp_path / flag, folder=tmp_path / flag))
    other = put(leg, tmp_path / "other", ("still.trc", "static.trc"))
    refused = call("scale", root, other, "--mass=30", "--out", tmp_path / "no")
    assert refused.code == 2 and f"{other}: is a second folder beside {root}; name one" in refused.err, refused.err


def test_loads_beside_the_trials_of_a_laboratory_act(leg: Path, tmp_path: Path) -> None:
    """As opensim-models has them: the same moments as with the files named; gravity alone acted before."""
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.trc", "walk.trc"), ("walk.mot", "walk_ik.mot"))
    put(leg, root, ("loads.xml", "walk_grf.xml"), ("grf.mot", "grf.mot"))
    (found,) = folder_inputs("id", root)
    assert dict(found.options)["loads"] == str(root / "walk_grf.xml") and not found.warnings
    typed = ("--model", leg / "leg.osim", "--loads", leg / "loads.xml", "--out", tmp_path / "typed")
    codes = call("id", root, "--out", tmp_path / "folder").code, call("id", leg / "walk.mot", *typed).code
    assert codes[0] == codes[1], "a residual that loads made up here leave"
    ours, theirs = (tmp_path / name / "id.sto" for name in ("folder", "typed"))
    assert ours.read_bytes() == theirs.read_bytes()


def test_forces_that_name_no_body_are_not_passed_over(leg: Path, tmp_path: Path) -> None:
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.trc", "walk.trc"), ("walk.mot", "walk_ik.mot"))
    put(leg, root, ("grf.mot", "walk_grf.mot"))
    with pytest.raises(InputError, match=r"walk_grf.mot: holds forces of the ground, .*; give `loads`"):
        folder_inputs("id", root)
    (typed,) = folder_inputs("id", root, typed=frozenset({"plates"}))
    assert "loads" not in dict(typed.options)


def test_a_model_and_its_motions_alone_are_trials(leg: Path, tmp_path: Path) -> None:
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.mot", "slow.mot"), ("walk.mot", "fast_ik.mot"))
    put(leg, root, ("loads.xml", "slow_grf.xml"), ("grf.mot", "slow_grf.mot"))
    fast, slow = folder_inputs("id", root, typed=frozenset({"model"}))
    assert (fast.trial, fast.recording.name, slow.trial) == ("fast", "fast_ik.mot", "slow")
    assert dict(slow.options)["loads"] == str(root / "slow_grf.xml")
    with pytest.raises(InputError, match="no trial has markers; is the folder complete"):
        folder_inputs("ik", root)
    (root / "leg.osim").unlink()
    with pytest.raises(InputError, match=r"is no folder of trials; .* with a model and its motions$"):
        read_tool_folder(root)


def test_loads_that_leave_it_open_which_is_meant_are_refused(leg: Path, tmp_path: Path) -> None:
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.mot", "walk.mot"), ("loads.xml", "walk_grf.xml"))
    put(leg, root, ("loads.xml", "walk_external_loads.xml"))
    both = r"walk_external_loads.xml and walk_grf.xml are loads of one trial; leave one there, or name it with `loads`"
    for command in ("id", "sit-to-stand coordinates"):
        with pytest.raises(InputError, match=both):
            folder_inputs(command, root)
    (typed,) = folder_inputs("id", root, typed=frozenset({"loads"}))
    assert not typed.warnings
    assert folder_inputs("markers", root), "which needs no loads"
    for name in ("walk_grf.xml", "walk_external_loads.xml"):
        (root / name).unlink()
    put(leg, root, ("grf.mot", "walk_grf.mot"), ("grf.mot", "walk_forces.mot"))
    with pytest.raises(InputError, match=r"`plates` \S*walk_forces.mot or \S*walk_grf.mot `plate`"):
        folder_inputs("id", root)


def test_two_motions_of_one_trial_leave_it_open_which_is_meant(leg: Path, tmp_path: Path) -> None:
    """The longer name won without a word; plates under the trial's own name leave no doubt (below)."""
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.mot", "walk.mot"), ("walk.mot", "walk_ik.mot"))
    both = r"walk_ik.mot and walk.mot are of one trial; name the file that is meant, or leave one of them there"
    for command, wanted in (("id", ()), ("markers", ()), ("sit-to-stand coordinates", ("walk",))):
        with pytest.raises(InputError, match=both):
            folder_inputs(command, root, wanted)
    put(leg, root, ("walk.mot", "run.mot"))
    (run,) = folder_inputs("id", root)
    assert run.recording.name == "run.mot" and re.search(f"trial walk is left out: .*{both}", run.warnings[0])
    put(leg, root, ("walk.trc", "walk.trc"))
    assert folder_inputs("ik", root, ("walk",)), "which begins with markers"
    named = call("markers", root / "walk.mot", "--model", root / "leg.osim", "--out", tmp_path / "out")
    assert done(named), "as the refusal says"


@pytest.mark.parametrize("name", ["walk_Grf", "grf_walk", "External_Loads", "Walk_ExternalLoads", "forces_grf"])
def test_loads_are_found_by_each_name_that_public_folders_use(leg: Path, tmp_path: Path, name: str) -> None:
    """The last is gait2354's: two words of loads, of no trial."""
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.mot", "walk.mot"), ("walk.mot", "static.mot"))
    put(leg, root, ("loads.xml", f"{name}.xml"), ("grf.mot", "grf.mot"))
    (found,) = folder_inputs("id", root)
    assert dict(found.options)["loads"] == str(root / f"{name}.xml") and not found.warnings


def test_files_that_may_hold_the_loads_are_named(leg: Path, tmp_path: Path) -> None:
    """Plates under a trial's own name beside its angles, and loads of no trial where there are two; no other file."""
    root = put(leg, tmp_path / "lab", ("leg.osim", "leg.osim"), ("walk.trc", "walk.trc"), ("walk.mot", "walk_ik.mot"))
    put(leg, root, ("grf.mot", "walk.mot"), ("walk.mot", "angles.mot"))
    (root / "setup_ik.xml").write_text("<OpenSimDocument><InverseKinematicsTool/></OpenSimDocument>")
    (one,) = folder_inputs("id", root)
    (said,) = one.warnings
    assert said.endswith("nothing but gravity acts; perhaps in walk.mot (`loads` for .xml, `plates` for .mot)")
    put(leg, root, ("walk.trc", "run.trc"), ("walk.mot", "run.mot"), ("loads.xml", "External_Loads.xml"))
    for each in folder_inputs("id", root):
        assert "perhaps in External_Loads.xml, walk.mot (" in each.warnings[0]
    for each in folder_inputs("sit-to-stand coordinates", root):
        assert "else `plates`; perhaps in External_Loads.xml, walk.mot (" in each.warnings[0]


def test_trials_one_folder_below_are_named(leg: Path, tmp_path: Path) -> None:
    root = put(leg, tmp_path / "subject", ("walk.trc", "gait/walk.trc"), ("leg.osim", "models/leg.osim"))
    with pytest.raises(InputError, match=r"is no folder of trials; .*: perhaps its folder gait/$"):
        read_tool_folder(root)
