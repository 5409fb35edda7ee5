"""Real recordings in the layouts of OpenCap, AddBiomechanics and a laboratory: the same numbers as with named files."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

from geocontact.analyses.motion.folder_inputs import folder_inputs
from geocontact.io.text.tables import read_table
from tests.cli.calls import call, done

MODEL = "LaiArnoldModified2017_contacts"


def put(data: Path, root: Path, **places: str) -> Path:
    for place, name in places.items():
        (root / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(data / name, root / place)
    return root


def session(data: Path, root: Path) -> Path:
    """A session of OpenCap: what its repository gives, in the places that its downloads have."""
    motions = {f"OpenSimData/Kinematics/{n}.mot": f"opencap/{n}_videoAndMocap.mot" for n in ("walking1", "squats1")}
    put(data, root, **motions, **{f"OpenSimData/Model/{MODEL}_scaled.osim": f"opencap/{MODEL}.osim"})
    (root / "sessionMetadata.yaml").write_text(f"height_m: 1.8\nmass_kg: 75\nopenSimModel: {MODEL}\n")
    return root


def test_moments_of_a_session(data_dir: Path, tmp_path: Path) -> None:
    """Two trials, each in a folder of its own; the missing ground reaction and another mass are said."""
    root = session(data_dir, tmp_path / "session")
    assert [one.trial for one in folder_inputs("id", root)] == ["squats1", "walking1"]
    folder, named = tmp_path / "folder", tmp_path / "named"
    ours = call("id", root, "--trial", "walking1", "--out", folder, folder=folder)
    motion, model = data_dir / "opencap/walking1_videoAndMocap.mot", data_dir / f"opencap/{MODEL}.osim"
    theirs = call("id", motion, "--model", model, "--out", named, folder=named)
    assert ours.code == theirs.code and ours.bytes("id.sto") == theirs.bytes("id.sto")
    assert any("no ground reaction belongs to walking1" in line for line in ours.record()["warnings"])


def test_a_walk_as_addbiomechanics_hands_it_out(data_dir: Path, tmp_path: Path) -> None:
    """From markers to moments, one word each: within 1 % of those of OpenSim's own tool, root mean square.

    Its moments belong to other angles than those beside them, as tests/real/test_real_kinematics.py says: the folder
    gets those of `ik`.
    """
    walk = data_dir / "opensim_walk"
    places = {
        "Models/match_markers_and_physics.osim": "subject01_simbody.osim",
        "IK/walk1_ik.mot": "subject01_walk1_ik.mot",
        "MarkerData/walk1.trc": "subject01_walk1.trc",
        "ID/walk1_external_forces.xml": "subject01_walk1_grf.xml",
        "ID/subject01_walk1_grf.mot": "subject01_walk1_grf.mot",
    }
    root = put(walk, tmp_path / "subject", **places)
    done(call("ik", root, "--tasks", walk / "subject01_Setup_IK.xml", "--time", "0.4:1.6", "--out", tmp_path / "ik"))
    shutil.copy(tmp_path / "ik" / "ik.mot", root / "IK" / "walk1_ik.mot")
    done(call("id", root, "--out", tmp_path / "id"))
    ours, theirs = read_table(tmp_path / "id" / "id.sto"), read_table(walk / "inverse_dynamics.sto")
    found = np.column_stack([ours.column(name) for name in theirs.channels])
    assert float(np.sqrt(np.mean((found - theirs.values) ** 2) / np.mean(theirs.values**2))) < 0.01


def test_static_and_walk_side_by_side(data_dir: Path, tmp_path: Path) -> None:
    """The static trial is known by its name and stands still; the walk is what `ik` takes."""
    data = data_dir / "opensim_walk"
    names = ("subject01_static.trc", "subject01_walk1.trc", "subject01_simbody.osim")
    root, out = put(data, tmp_path / "lab", **{name: name for name in names}), tmp_path / "ik"
    (scale,), (walk,) = folder_inputs("scale", root), folder_inputs("ik", root)
    assert (scale.trial, walk.trial, scale.warnings) == ("subject01_static", "subject01_walk1", ())
    result = call("ik", root, "--out", out, folder=out)
    assert result.code == 0 and (out / "ik.mot").is_file()


def test_the_walk_of_gait2354_as_its_repository_has_it(data_dir: Path, tmp_path: Path) -> None:
    """Motion, model and loads are found beside the markers; they were left out, and gravity alone acted."""
    walk = data_dir / "opensim_walk"
    done(call("id", walk, "--time", "0.5:0.8", "--out", tmp_path / "folder"))
    model, loads = walk / "subject01_simbody.osim", walk / "subject01_walk1_grf.xml"
    typed = ("--model", model, "--loads", loads, "--time", "0.5:0.8", "--out", tmp_path / "typed")
    done(call("id", walk / "subject01_walk1_ik.mot", *typed))
    ours, theirs = (tmp_path / name / "id.sto" for name in ("folder", "typed"))
    assert ours.read_bytes() == theirs.read_bytes()


def test_folders_of_a_model_and_its_motions(data_dir: Path) -> None:
    """A shoulder and OpenCap's example: motions without markers are trials."""
    shoulder = [one.trial for one in folder_inputs("markers", data_dir / "rmr_shoulder")]
    assert shoulder == ["ABD01", "ABD02", "ABD03", "FLX01", "FLX02", "SHRUG01"]
    assert len(folder_inputs("id", data_dir / "opencap")) == 2
