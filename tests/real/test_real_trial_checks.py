"""Checks of a recorded trial on real recordings: silent, but for markers that jump in the files themselves."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from benchmarks.devices import desr, emps, friction_damper
from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.record import Record
from geocontact.analyses.gap.case import doubt_numbers
from geocontact.analyses.motion.checked_trial import turned_plates
from geocontact.analyses.motion.functional_joint.options import JointOptions
from geocontact.analyses.motion.functional_joint.read import read as read_joint
from geocontact.analyses.motion.inverse_dynamics.loads import read as read_id
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.read import read as read_ik
from geocontact.analyses.motion.scale.factors import read as read_scale
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.io.mocap.force_plates import read_force_plates
from geocontact.io.mocap.markers import read_markers
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import read_table
from geocontact.trial_checks.landmarks import body_points
from geocontact.trial_checks.mesh_checks import SurfacePair, surface_contradictions
from geocontact.trial_checks.recorded import FootPlate, MovedModel, TrialInputs
from geocontact.trial_checks.table import contradictions
from tests.cli.calls import call, unpictured
from tests.trial_checks.as_c3d import LABORATORY, as_c3d, laboratory, plates_as_c3d
from tests.trial_checks.damage import Damage, alike, columns_changed, late, said, swapped, text_changed, times

Z_UP = Rotation.from_matrix([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


@dataclass(frozen=True)
class Recording:
    """Files of a trial, the mass where the source states it [kg], and how the warnings begin that are right."""

    markers: str | None
    plates: str | None
    mass: float | None = None
    standing: str | None = None
    right: tuple[str, ...] = ()


DM, WALK, C3D = "gc6_dm_knee/gait/", "opensim_walk/", "c3d_variety/"
TRIALS = {
    "bmclab": Recording("bmclab_gait_c3d/Gait.c3d", "bmclab_gait_c3d/Gait.c3d"),
    "JW": Recording("gc4_jw_knee/c3d/jw_ngait_og3.c3d", "gc4_jw_knee/c3d/jw_ngait_og3.c3d", 66.7),
    # 40 to 50 mm within one frame, at 1.32 s, where heel and toe go on smoothly
    "DM": Recording(
        f"{DM}DM_ngait_og1_new.trc",
        f"{DM}DM_ngait_og1_grf.sto",
        70.0,
        right=("jump: L_Midfoot_Medial", "jump: L_Midfoot_Lateral"),
    ),
    "DM, bouncy": Recording(None, f"{DM}DM_bouncy5_grf.sto", 70.0),
    "DM, smooth": Recording(None, f"{DM}DM_smooth1_grf.sto", 70.0),
    "subject01, on a treadmill": Recording(f"{WALK}subject01_walk1.trc", f"{WALK}subject01_walk1_grf.mot", 72.6),
    "subject01, with its standing trial": Recording(
        f"{WALK}subject01_walk1.trc", f"{WALK}subject01_walk1_grf.mot", 72.6, f"{WALK}subject01_static.trc"
    ),
    "walk": Recording(f"{WALK}markers_walk.trc", f"{WALK}grf_walk.mot"),
    # one frame 40 mm aside of those before and after it, at 3.06 s; the other markers of the shank do not move
    "c3d.org 01": Recording(f"{C3D}Eb015pr.c3d", f"{C3D}Eb015pr.c3d", right=("jump: RSK1",)),
    "c3d.org 02": Recording(f"{C3D}sgi_real.c3d", f"{C3D}sgi_real.c3d"),
}
MODELS = {
    "subject01": (f"{WALK}subject01_simbody.osim", f"{WALK}subject01_walk1_ik.mot"),
    "JW, of a workshop": (
        "gc4_jw_predsim_workshop/KneeProsthesis.osim",
        "gc4_jw_predsim_workshop/KneeProsthesis_states2track.sto",
    ),
    "squats": ("opencap/LaiArnoldModified2017_contacts.osim", "opencap/squats1_videoAndMocap.mot"),
    "walking": ("opencap/LaiArnoldModified2017_contacts.osim", "opencap/walking1_videoAndMocap.mot"),
    **{
        name: ("rmr_shoulder/TSM_subject_CMC_noWeight.osim", f"rmr_shoulder/{name}.mot")
        for name in ("ABD01", "ABD02", "ABD03", "FLX01", "FLX02", "SHRUG01")
    },
}
SURFACES = ("gc4_jw_knee/stl", "gc6_dm_knee/stl", "jma_ankles/Norm_01", "jma_ankles/Norm_03")
SURFACES += ("gc4_jw_predsim_workshop", "body_meshes")


def recorded(data_dir: Path, name: str, mass: float | None = None) -> TrialInputs:
    """Everything of a trial; of a .c3d z is up."""
    one = TRIALS[name]
    turn = Z_UP if (one.markers or one.plates or "").endswith(".c3d") else None

    def seen(file: str | None) -> MarkerTrajectories | None:
        found = None if file is None else read_markers(data_dir / file)
        return found if found is None or turn is None else found.turned(turn)

    plates = ()
    if one.plates is not None:
        under = turned_plates(read_force_plates(data_dir / one.plates), turn, data_dir / one.plates)
        plates = tuple(FootPlate(plate, one.plates) for plate in under)
    return TrialInputs(seen(one.markers), seen(one.standing), plates, one.mass if mass is None else mass)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", TRIALS)
def test_a_real_trial_passes(name: str, data_dir: Path) -> None:
    found = [f"{check.name}: {one.what}" for check, one in contradictions(recorded(data_dir, name))]
    right = TRIALS[name].right
    assert [line for line in found if not line.startswith(right or "nothing")] == []
    assert len(found) == len(right)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", MODELS)
def test_real_coordinates_pass(name: str, data_dir: Path) -> None:
    """Markers where there are some, else the bodies; ranges, sizes, thigh and shank, mass and legs."""
    model, table = read_multibody(data_dir / MODELS[name][0]), read_table(data_dir / MODELS[name][1])
    values = motion_of(table, model)
    seen = body_points(model, table.time, values, name)
    moved = MovedModel(model, table.time, values, name)
    assert not contradictions(TrialInputs(seen, mass=model.mass, up=model.up, moved=moved))
    places = MarkerTrajectories(table.time, model.marker_places(values), tuple(m.name for m in model.markers), name)
    if len(places.names):
        assert not contradictions(TrialInputs(places, up=model.up))


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("folder", SURFACES)
def test_real_surfaces_pass(folder: str, data_dir: Path) -> None:
    import geocontact as gc

    unit = "mm" if folder.startswith("jma") else "m"
    files = sorted([*(data_dir / folder).glob("*.stl"), *(data_dir / folder).glob("*.obj")])
    surfaces = [gc.read_surface(file, unit) for file in files]
    assert len(surfaces) > 1
    for moving in surfaces:
        for fixed in surfaces:
            assert moving is fixed or not surface_contradictions(SurfacePair(moving, fixed))


KNEE, FLUOROSCOPY = "gc6_dm_knee/stl/", "gc6_dm_knee/fluoroscopy/Fluoroscopic Gait Data.sto"
Read = tuple[tuple[str, ...], tuple[str, ...]]
READ: dict[str, Read] = {
    "JW og3, load cells": (
        ("loadcells", "gc4_jw_knee/knee_forces/jw_ngait_og3_knee_forces.csv", "--unit", "lbf"),
        (),
    ),
    # the file has 0, 1, … 100 under `time`; surfaces of fluoroscopy are registered to 1 mm, and overlap by 1.3 mm
    "DM, fluoroscopy": (
        (
            *("area", f"{KNEE}Femoral Component decimated.stl", f"{KNEE}Tibial Insert decimated.stl", "--unit", "m"),
            *("--motion", FLUOROSCOPY, "--angles", "rad", "--region", "ny>0.25", "--map"),
            "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r",
        ),
        ("taken as per cent of a cycle", "the bodies overlap, by 1.30 mm at most"),
    ),
}
"""Commands, files of the data among their words, and what is rightly said."""


def fitted(file: str, shape: str, unit: str, *right: str) -> Read:
    """Fit of a shape to all faces of a file, which few of these bodies are: what the page advises is said."""
    return ("fit", file, "--shape", shape, "--unit", unit), right


OF_SHAPE, BOTH_SIDES = "of the radius: a # does not describe this patch", "look away from the"
SPHERE, CYLINDER = OF_SHAPE.replace("#", "sphere"), OF_SHAPE.replace("#", "cylinder")
IMPLANT, WORKSHOP, ANKLES, MATS = "gc4_jw_knee/stl/", "gc4_jw_predsim_workshop/", "jma_ankles/", "real_mats/"
OPENCAP, ARM, HEAD = "opencap/", "rmr_shoulder/", "OpenSim advises less than"
JOINT_OF_JW = (
    *(f"{WORKSHOP}Femoral_Component_simpler.stl", f"{WORKSHOP}Tibial_Insert_simpler_superior.stl", "--unit", "m"),
    *("--osim", f"{WORKSHOP}KneeProsthesis.osim", "--joint", "knee_joint", "--moving", "parent"),
)
BETA = "is not a plain rotation; read in rad or m"
SUBJECT = ("--model", f"{WALK}subject01_simbody.osim")
READ |= {
    "JW, femoral component": fitted(f"{IMPLANT}Femoral Component.stl", "sphere", "m", "duplicate", SPHERE, BOTH_SIDES),
    # the back of the button is flat; the cup has an inside, an outside and a rim; the head has a stem
    "JW, button": fitted(f"{IMPLANT}Patellar Button.stl", "sphere", "m", SPHERE),
    "JW, cup": fitted(f"{IMPLANT}Hip Implant Acetabular Cup.stl", "sphere", "m", SPHERE, BOTH_SIDES),
    "JW, head": fitted(f"{IMPLANT}Hip Implant Femoral Component.stl", "sphere", "m", SPHERE, "lie on the sphere exact"),
    "DM, component": fitted(f"{KNEE}Femoral Component decimated.stl", "cylinder", "m", CYLINDER, BOTH_SIDES),
    "DM, its bearing": fitted(f"{KNEE}Femoral Component contact.stl", "cylinder", "m"),
    "DM, bearing of the insert": fitted(f"{KNEE}Tibial Insert contact.stl", "plane", "m"),
    "DM, insert": fitted(f"{KNEE}Tibial Insert decimated.stl", "plane", "m"),
    "JW, of a workshop": fitted(f"{WORKSHOP}Femoral_Component_simpler.stl", "cylinder", "m"),
    "JW, insert of a workshop": fitted(f"{WORKSHOP}Tibial_Insert_simpler_superior.stl", "plane", "m"),
    "JW, insert in 100 parts": fitted(f"{WORKSHOP}Tibial Insert simpler_superior_100.stl", "plane", "m"),
    **{
        f"Norm_{n}, talus": fitted(f"{ANKLES}Norm_{n}/Norm_{n}_Talus.stl", "sphere", "mm", SPHERE) for n in ("01", "03")
    },
    # whole bodies are no cylinder, and its radius of 3 m is said to be unusual
    **{
        name: fitted(
            f"body_meshes/human_{name}.obj", "cylinder", "m", "cover 2", "is unusual for the radius", BOTH_SIDES
        )
        for name in ("man", "woman")
    },
    # numbers of four digits: poses are off orthonormal by 0.006
    **{
        f"Norm_{n}, walking": (
            (
                *("area", f"{ANKLES}Norm_{n}/Norm_{n}_Talus.stl", f"{ANKLES}Norm_{n}/Norm_{n}_Calcaneus_Right.stl"),
                *("--unit", "mm", "--motion", f"{{made}}/Norm_{n}_Walk_Talus.txt", "--rate", "1"),
                *("--motion-fixed", f"{{made}}/Norm_{n}_Walk_Calcaneus.txt"),
            ),
            ("rotation parts are off orthonormal",),
        )
        for n in ("01", "03")
    },
    "KneeProsthesis.mot": (
        ("area", *JOINT_OF_JW, "--motion", f"{WORKSHOP}KneeProsthesis.mot", "--angles", "deg"),
        ("unsigned",),
    ),
    "states of a workshop": (
        ("area", *JOINT_OF_JW, "--motion", f"{WORKSHOP}KneeProsthesis_states2track.sto", "--angles", "rad"),
        ("unsigned",),
    ),
    "KCF_ref.mot": (("loadcells", f"{WORKSHOP}KCF_ref.mot", "--unit", "lbf", "--matrix", "{made}/as_is.toml"), ()),
    # insoles on a flat floor; the places of pedar's cells are ours, and one of them never changes
    **{
        f"F-Scan {side}": (
            (
                "mat",
                f"{MATS}FrasP01{side}.asf",
                "--surface",
                "{made}/floor.stl",
                "--unit",
                "mm",
                "--landmarks",
                "{made}/fscan.csv",
            ),
            (),
        )
        for side in "LR"
    },
    **{
        f"pedar {side}": (
            (
                "mat",
                f"{MATS}pressure_example.asc",
                "--layout",
                "{made}/pedar.toml",
                "--sensor",
                side,
                "--unit",
                "mm",
                "--surface",
                "{made}/floor.stl",
                "--landmarks",
                "{made}/pedar.csv",
            ),
            ("never change while those around them do",),
        )
        for side in ("left", "right")
    },
    # OpenSim's own angles leave 77 mm at R.Acromium, and 21.9 mm root mean square; its own residuals are as large
    "subject01, set-up of ik": (("ik", "--setup", f"{WALK}subject01_Setup_IK.xml"), (HEAD,)),
    "subject01, set-up of id": (("id", "--setup", f"{WALK}subject01_Setup_InverseDynamics.xml"), ("limit 5 %",)),
    # the marker set is that before scaling; the head turns from 4.1 s on, by 50 mm
    "subject01, marker set": (
        (
            "scale",
            f"{WALK}subject01_static.trc",
            *SUBJECT,
            "--mass",
            "72.6",
            "--scale",
            "femur_r,femur_l=1.0",
            "--marker-set",
            f"{WALK}gait2354_Scale_MarkerSet.xml",
        ),
        ("L.Temple moves 57 mm", HEAD, "not scaled: lengths of fibres"),
    ),
    # knees bend by 66 degrees in swing, where the hip is lowest by 20 mm: that is no squat
    "subject01, in the plane": (
        (
            "sit-to-stand",
            "coordinates",
            f"{WALK}subject01_walk1_ik.mot",
            *SUBJECT,
            "--leg",
            "right",
            "--belt",
            "1.11",
            "--plates",
            f"{WALK}subject01_walk1_grf.mot",
            "--feet",
            "ground_force",
        ),
        (),
    ),
    "squats, in the plane": (
        (
            "sit-to-stand",
            "coordinates",
            f"{OPENCAP}squats1_videoAndMocap.mot",
            "--model",
            f"{OPENCAP}LaiArnoldModified2017_contacts.osim",
        ),
        (BETA, "the height of a person, which mostly is 0.8 to 1.97 m"),  # 2.04 m by the model's legs
    ),
    **{
        name: (("markers", f"{ARM}{name}.mot", "--model", f"{ARM}TSM_subject_CMC_noWeight.osim"), ())
        for name in ("ABD01", "ABD02", "ABD03", "FLX01", "FLX02", "SHRUG01")
    },
}


def flat(file: Path) -> None:
    """A floor of 200 x 400 mm in faces of 10 mm, its upper side along y."""
    lines = ["solid floor"]
    for i, j in np.ndindex(40, 20):
        corner = [(10 * (j + b), 0, 10 * (i + a)) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        for three in ((0, 1, 2), (0, 2, 3)):
            lines += ["facet normal 0 1 0", "outer loop", *("vertex {} {} {}".format(*corner[k]) for k in three)]
            lines += ["endloop", "endfacet"]
    file.write_text("\n".join([*lines, "endsolid floor"]) + "\n", encoding="utf-8")


@pytest.fixture(scope="module")
def made(data_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the recordings need beside them: every 60th pose of an ankle, a floor, and where a mat lies on it."""
    folder = tmp_path_factory.mktemp("made")
    for file in (data_dir / "jma_ankles").glob("*/*_Walk_*.txt"):
        (folder / file.name).write_text("\n".join(file.read_text(encoding="utf-8").split()[::60]) + "\n")
    (folder / "as_is.toml").write_text('cells = ["medial", "lateral"]\nmedial = [1.0, 0.0]\n')
    flat(folder / "floor.stl")
    for name, rows, columns, pitch in (("fscan", 60, 21, 5.08), ("pedar", 15, 7, 15.0)):
        corners = [(r, c, 20 + pitch * c, 20 + pitch * r) for r in (0, rows) for c in (0, columns)]
        marks = "".join(f"L{r}_{c},{r},{c},{x:g},0,{z:g}\n" for r, c, x, z in corners)
        (folder / f"{name}.csv").write_text(f"id, row, column, x [mm], y [mm], z [mm]\n{marks}")
    places = ", ".join(f"[{k // 7}, {k % 7}]" for k in range(99))
    layout = f"rows = 15\ncolumns = 7\npitch_mm = [15.0, 15.0]\n[sensors]\nleft = [{places}]\nright = [{places}]\n"
    (folder / "pedar.toml").write_text(layout)
    return folder


@pytest.mark.parametrize("name", READ)
def test_a_command_says_of_a_real_recording_what_is_right(
    name: str, data_dir: Path, made: Path, tmp_path: Path
) -> None:
    words, right = READ[name]
    words = tuple(each.replace("{made}", str(made)) for each in words)
    given = [data_dir / each if (data_dir / each).is_file() else each for each in words]
    with unpictured():
        found = call(*given, "--out", tmp_path / "out")
    assert found.code == 0, found.err
    assert len(found.warnings) == len(right), found.warnings
    assert all(any(each in line for line in found.warnings) for each in right), found.warnings


@pytest.mark.parametrize(
    "words",
    [
        ("fit", f"{IMPLANT}Tibial Insert.stl", "--shape", "sphere", "--unit", "m"),
        ("fit", f"{ANKLES}Norm_01/Norm_01_Calcaneus_Right.stl", "--shape", "plane", "--unit", "mm"),
        ("fit", f"{ANKLES}Norm_03/Norm_03_Calcaneus_Right.stl", "--shape", "plane", "--unit", "mm"),
    ],
    ids=["insert", "calcaneus of Norm_01", "calcaneus of Norm_03"],
)
def test_what_a_real_surface_is_not_contradicts(words: tuple[str, ...], data_dir: Path, tmp_path: Path) -> None:
    given = [data_dir / each if (data_dir / each).is_file() else each for each in words]
    with unpictured():
        assert call(*given, "--out", tmp_path / "out").out.startswith("the result contradicts its data")


DEVICES = ("desr", "emps", "friction_damper")


@pytest.mark.parametrize("device", DEVICES)
def test_a_real_device_has_no_doubtful_number(device: str, data_dir: Path, tmp_path: Path) -> None:
    """Noise beside what the channels change by, and lengths, of the cases that the benchmarks make of three devices."""
    if device == "desr":
        desr.write_case(data_dir / desr.FILE, tmp_path)
    elif device == "emps":
        write_gap_case(emps.case(data_dir, "benchmarks.devices.emps_model:DRIVE", emps.BASE), tmp_path)
    else:
        system = "benchmarks.devices.friction_damper_model:DAMPER"
        write_gap_case(friction_damper.case(data_dir, system, friction_damper.BASE, 1), tmp_path)
    with collecting(Record("test", {})) as record:
        doubt_numbers(read_gap_case(tmp_path), tmp_path / "case.toml")
    assert record.warnings == []


WALKED = ("subject01_simbody.osim", "subject01_walk1_ik.mot", "subject01_walk1_grf.mot", "subject01_walk1_grf.xml")
WALKED += ("subject01_walk1.trc", "subject01_static.trc")
OSIM, IK, GRF, XML, TRC, STILL = WALKED


def inverse_dynamics(folder: Path, **changed: Any) -> set[str]:
    asked = {"model": folder / OSIM, "loads": folder / XML, "time": (0.6, 2.4)} | changed
    return said(read_id, IdOptions, folder / IK, **asked)


def ik(folder: Path, **changed: Any) -> set[str]:
    return said(read_ik, IkOptions, folder / TRC, model=folder / OSIM, **changed)


def joint(folder: Path, **changed: Any) -> set[str]:
    asked = {"first": "R.ASIS,L.ASIS,V.Sacral", "second": "R.Thigh.Upper,R.Thigh.Front,R.Thigh.Rear"} | changed
    return said(read_joint, JointOptions, folder / TRC, static=folder / STILL, **asked)


def scaled(folder: Path, **changed: Any) -> set[str]:
    asked: dict[str, Any] = {"model": folder / OSIM, "scale": ("femur_r=1.0",)} | changed
    return said(read_scale, ScaleOptions, folder / STILL, **asked)


def heavier(factor: float) -> Damage:
    def change(text: str) -> str:
        parts = text.split("<mass>")
        changed = [f"{factor * float(part.split('<', 1)[0]):.6f}<{part.split('<', 1)[1]}" for part in parts[1:]]
        return "<mass>".join([parts[0], *changed])

    return text_changed(OSIM, change)


def radians(columns: dict[str, np.ndarray]) -> None:
    for name, values in columns.items():
        if name != "time" and not name.endswith(("tx", "ty", "tz")):
            columns[name] = np.radians(values)


def ends(kind: str, factor: float) -> Damage:
    return columns_changed(GRF, alike(*(times(factor, f"{kind}{axis}") for axis in "xyz")))


DAMAGED: dict[str, Damage] = {
    "mass x 0.7": heavier(0.7),
    "mass in pounds": heavier(2.2046),
    "force / 2": ends("_v", 0.5),
    "force in kN": ends("_v", 1e-3),
    "sign of all forces": ends("_v", -1.0),
    "sign along the walk": columns_changed(GRF, times(-1.0, "_vx")),
    "centre of pressure in mm": ends("_p", 1e3),
    "plates 0.1 s late": columns_changed(GRF, late(0.1)),
    "plates 0.1 s early": columns_changed(GRF, late(-0.1)),
    "axes of the plates exchanged": columns_changed(GRF, alike(swapped("_vx", "_vy"), swapped("_px", "_py"))),
    "plates exchanged": text_changed(
        XML, lambda t: t.replace("calcn_r", "X").replace("calcn_l", "calcn_r").replace("X", "calcn_l")
    ),
    "radians, called degrees": columns_changed(IK, radians),
    "degrees, called radians": text_changed(IK, lambda t: t.replace("inDegrees=yes", "inDegrees=no")),
    "floor +50 mm": columns_changed(IK, lambda c: c.update(pelvis_ty=c["pelvis_ty"] + 0.05)),
    "a knee bent forwards": columns_changed(IK, times(-1.0, "knee_angle_r")),
}


@pytest.fixture(scope="module")
def walked(data_dir: Path) -> dict[str, set[str]]:
    folder = data_dir / "opensim_walk"
    return {"id": inverse_dynamics(folder), "ik": ik(folder), "joint": joint(folder)}


def test_commands_take_a_real_trial_without_a_word(walked: dict[str, set[str]]) -> None:
    """But for markers of the standing trial that nobody put on for the walk."""
    assert walked["id"] == walked["joint"] == set()
    assert len(walked["ik"]) == 1 and "were not recorded: R.Knee.Lat" in walked["ik"].pop()


@pytest.mark.parametrize("name", DAMAGED)
def test_no_damage_of_a_real_trial_is_silent(
    name: str, data_dir: Path, tmp_path: Path, walked: dict[str, set[str]]
) -> None:
    for file in WALKED:
        shutil.copy(data_dir / "opensim_walk" / file, tmp_path / file)
    assert inverse_dynamics(tmp_path, **DAMAGED[name](tmp_path)) - walked["id"]


def test_a_mass_is_compared_with_who_stands(data_dir: Path) -> None:
    """Of `scale`, by the height of the pelvis: 72.6 kg are right, a tenth of it is not."""
    folder = data_dir / "opensim_walk"
    assert scaled(folder, mass=72.6) == scaled(folder)
    assert "are it and the lengths in kg and m" in "".join(scaled(folder, mass=7.26) - scaled(folder))


@pytest.mark.filterwarnings("ignore")
def test_a_plate_that_is_missing_is_spoken_of(data_dir: Path, tmp_path: Path) -> None:
    """A foot without its plate leaves more than a third of the weight while it stands."""
    import geocontact as gc

    folder, asked = data_dir / "opensim_walk", {"model": data_dir / "opensim_walk" / OSIM, "time": (0.6, 2.0)}
    words = "the residual force exceeds a third of the weight for"
    feet = ("ground_force=calcn_r", "1_ground_force=calcn_l")
    whole, alone = (
        gc.inverse_dynamics(folder / IK, plates=folder / GRF, plate=each, **asked) for each in (feet, feet[:1])
    )
    assert words not in "".join(whole.warnings) and words in "".join(alone.warnings)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("c3d", [False, True])
def test_a_turned_recording_gives_the_same_results(
    c3d: bool, data_dir: Path, tmp_path: Path, walked: dict[str, set[str]]
) -> None:
    """The walk along -x with z up, and in .c3d files with z up: `axes` gives forces and angles as they were."""
    import geocontact as gc

    for file in WALKED:
        shutil.copy(data_dir / "opensim_walk" / file, tmp_path / file)
    if c3d:
        for file in (TRC, STILL):
            as_c3d(tmp_path, file)
        columns_changed(GRF, lambda c: c.update(time=np.arange(len(c["time"])) / 600.0))(
            tmp_path
        )  # in full, not 0.1 ms
        plates_as_c3d(tmp_path, GRF, ("ground_force", "1_ground_force"))
    else:
        laboratory(tmp_path, (TRC, STILL, GRF))
    was, axes = data_dir / "opensim_walk", LABORATORY if c3d else "-x,z,y"
    end = ".c3d" if c3d else ".trc"
    names: dict[str, Any] = {"first": "R.Thigh.Upper,R.Thigh.Front,R.Thigh.Rear", "axis": True}
    names |= {"second": "R.Shank.Upper,R.Shank.Front,R.Shank.Rear"}
    loaded: dict[str, Any] = {"model": tmp_path / OSIM, "time": (0.6, 1.0)}
    plates = {"plates": (tmp_path if c3d else was) / GRF, "plate": ("ground_force=calcn_r", "1_ground_force=calcn_l")}
    turned = {"plates": tmp_path / (GRF.replace(".mot", ".c3d") if c3d else GRF), "axes": axes}
    turned["plate"] = ("1=calcn_r", "2=calcn_l") if c3d else plates["plate"]
    pairs = [
        (
            gc.inverse_kinematics(was / TRC, model=was / OSIM, time=(0.6, 1.0)),
            gc.inverse_kinematics((tmp_path / TRC).with_suffix(end), model=was / OSIM, time=(0.6, 1.0), axes=axes),
        ),
        (
            gc.functional_joint(was / TRC, static=was / STILL, **names),
            gc.functional_joint(
                (tmp_path / TRC).with_suffix(end), static=(tmp_path / STILL).with_suffix(end), axes=axes, **names
            ),
        ),
        (gc.inverse_dynamics(was / IK, **plates, **loaded), gc.inverse_dynamics(was / IK, **turned, **loaded)),
    ]
    for expected, found in pairs:
        for name, table in expected.tables().items():
            values, known = (each.select_dtypes("number").to_numpy(float) for each in (found.table(name), table))
            np.testing.assert_allclose(values, known, rtol=1e-3, atol=2e-3, err_msg=name)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["bmclab", "JW", "DM", "subject01, on a treadmill", "walk"])
def test_a_wrong_mass_is_seen(name: str, data_dir: Path) -> None:
    """Where the mass is not stated it is that of 0.8 times the weight in a step."""
    right = TRIALS[name].mass or 70.0 * (1.15 if name == "walk" else 1.0)
    for factor in (0.7, 2.2046):
        trial = recorded(data_dir, name, factor * right)
        assert "mass" in {check.name for check, _ in contradictions(TrialInputs(plates=trial.plates, mass=trial.mass))}
