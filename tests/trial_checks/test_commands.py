"""Wrong inputs made from the shipped trials: no analysis takes one without a word, and none warns of what is right.

What is read is checked before anything is computed, so that only reading runs here.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocontact.analyses.cop.foot import read as read_cop
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.recordings import gathered
from geocontact.analyses.gap.gather.recordings import read as read_gather
from geocontact.analyses.motion.functional_joint.options import JointOptions
from geocontact.analyses.motion.functional_joint.read import read as read_joint
from geocontact.analyses.motion.inverse_dynamics.loads import read as read_id
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.read import read as read_ik
from geocontact.analyses.motion.scale.factors import read as read_scale
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.motion.virtual_markers.options import MarkersOptions
from geocontact.analyses.motion.virtual_markers.result import read as read_moved
from geocontact.analyses.motion.virtual_markers.result import run as run_markers
from geocontact.analyses.prosthesis.calibrate.foot_on_plate import read as read_calibrate
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.stances import read as read_compare
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.trial import read as read_design
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.scale.result import read as read_prosthesis_scale
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import read as read_simulate
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.profiles import read as read_optimise
from geocontact.analyses.shoulder.simulate.arms import read as read_shoulder
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.study.cases import read as read_study
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.result import read as read_standing
from geocontact.io.mocap.trc import read_trc, write_trc
from tests import legs
from tests.cli.calls import MESHES, call
from tests.trial_checks.damage import (
    Damage,
    Said,
    alike,
    all_of,
    columns_changed,
    decimal_comma,
    exchanged,
    files_of,
    jumping,
    larger,
    late,
    markers_changed,
    mirrored,
    option,
    plates_changed,
    raised,
    said,
    swapped,
    text_changed,
    times,
    z_up,
)
from tests.trial_checks.meant import MEANT

WALK, OVERHEAD, STANDING_UP = MESHES / "gait_P1_medium_1", MESHES / "overhead_P1T1S100", MESHES / "standing_up"
SECOND = MESHES / "gait_P1_low_1"
MASS = 77.3

STANDING = {
    "standing trial 25 % larger": markers_changed("standing.trc", larger(1.25)),
    "standing trial with another floor": markers_changed("standing.trc", raised(0.05)),
    "right and left mirrored": all_of(
        markers_changed("standing.trc", mirrored), markers_changed("walking.trc", mirrored)
    ),
    "z is up": all_of(markers_changed("standing.trc", z_up), markers_changed("walking.trc", z_up)),
}
WALKED = {
    **STANDING,
    "a jump of 150 mm": markers_changed("walking.trc", jumping("RASI")),
    "labels exchanged half-way": markers_changed("walking.trc", exchanged("RASI", "LASI")),
    "the walk with another floor": markers_changed("walking.trc", raised(0.05)),
    "both with another floor": all_of(
        markers_changed("walking.trc", raised(0.05)), markers_changed("standing.trc", raised(0.05))
    ),
    "the standing trial twice": option(markers="standing.trc"),
    "mass x 0.7": option(mass=0.7 * MASS),
    "mass in pounds": option(mass=2.2046 * MASS),
    "force in kN": plates_changed(times(1e-3, "_vy")),
    "force / 2": plates_changed(alike(*(times(0.5, f"_v{a}") for a in "xyz"))),
    "the gain of one plate x 1.3": plates_changed(alike(*(times(1.3, f"own_force_v{a}") for a in "xyz"))),
    "sign of the force along the walk": plates_changed(times(-1.0, "_vx")),
    "sign of all forces": plates_changed(alike(*(times(-1.0, f"_v{a}") for a in "xyz"))),
    "plates 0.1 s late": plates_changed(late(0.1)),
    "plates 0.1 s early": plates_changed(late(-0.1)),
    "centre of pressure in mm": plates_changed(alike(times(1e3, "_px"), times(1e3, "_pz"))),
    "the other plate": option(plate="other_force"),
    "axes of the plates exchanged": plates_changed(alike(swapped("_vx", "_vy"), swapped("_px", "_py"))),
    "plates 0.2 m aside": plates_changed(lambda c: c.update(own_force_px=c["own_force_px"] + 0.2)),
    "plates mirrored": plates_changed(alike(times(-1.0, "_vz"), times(-1.0, "_pz"))),
    "a clock that runs twice as fast": plates_changed(lambda c: c.update(time=2.0 * c["time"])),
    "the plates' time in ms": plates_changed(lambda c: c.update(time=1e3 * c["time"])),
    "a free moment in N mm": plates_changed(lambda c: c.update(own_torque_y=0.02e3 * c["own_force_vy"])),
    "decimal comma in the plates": decimal_comma("plates.mot"),
    "decimal comma in the markers": decimal_comma("walking.trc"),
    "markers in m, called mm": markers_changed("walking.trc", larger(1e-3)),
    "markers in cm, called mm": all_of(
        markers_changed("walking.trc", larger(0.1)), markers_changed("standing.trc", larger(0.1))
    ),
}


def prosthesis(folder: Path, **changed: Any) -> dict[str, Any]:
    given: dict[str, Any] = {"markers": "walking.trc", "static": "standing.trc", "plates": "plates.mot"} | changed
    files = {name: folder / given.pop(name) for name in ("markers", "static", "plates")}
    return {"mass": MASS, "plate": "own_force", **files, **given}


def simulate(folder: Path, **changed: Any) -> Said:
    given = {"other_plate": "other_force", **prosthesis(folder, **changed)}
    return said(read_simulate, ProsthesisSimulateOptions, given.pop("markers"), **given)


def calibrate(folder: Path, **changed: Any) -> Said:
    given = prosthesis(folder, **changed)
    return said(read_calibrate, ProsthesisCalibrateOptions, given.pop("markers"), **given)


def design(folder: Path, **changed: Any) -> Said:
    given = prosthesis(folder, **changed)
    return said(read_design, ProsthesisDesignOptions, given.pop("markers"), **given)


def stood(folder: Path, **changed: Any) -> Said:
    given = {"mass": MASS, "markers": "standing.trc"} | changed
    return said(read_prosthesis_scale, ProsthesisScaleOptions, folder / given.pop("markers"), **given)


def shoulder(folder: Path, **changed: Any) -> Said:
    given = {"side": "right", "markers": "markers.trc"} | changed
    return said(read_shoulder, ShoulderSimulateOptions, folder / given.pop("markers"), **given)


def standing_up(folder: Path, **changed: Any) -> Said:
    study = folder / changed.pop("study", "study.toml")
    return said(read_standing, StandingCalibrateOptions, study, **changed)


def body_mass(factor: float) -> Damage:
    def damage(folder: Path) -> dict[str, Any]:
        study = folder / "study.toml"
        study.write_text(study.read_text().replace("value = 70,", f"value = {70.0 * factor:g},"))
        return {}

    return damage


def joint(folder: Path, **changed: Any) -> Said:
    given = {"markers": "walking.trc", "static": "standing.trc"} | changed
    asked: dict[str, Any] = {"first": "RASI,LASI,RPSI,LPSI", "second": "RTH1,RTH2,RTH3"}
    asked |= {"static": folder / given["static"]} | {k: v for k, v in given.items() if k in ("axes", "markers_map")}
    return said(read_joint, JointOptions, folder / given["markers"], **asked)


def foot_files(folder: Path, walk: Path) -> Path:
    """Pose of a foot along a walk from its heel and toes, and two spheres at these: what `cop` and `gather` read."""
    seen = read_trc(walk / "walking.trc")
    heel, toe = seen.of(("RHEE",))[:, 0], seen.of(("RTOE",))[:, 0]
    pitch = np.arctan2(toe[:, 1] - heel[:, 1], toe[:, 0] - heel[:, 0])
    table = np.column_stack([seen.time, heel, pitch])
    file = folder / f"{walk.name}.csv"
    np.savetxt(file, table, delimiter=",", comments="", header="time [s],x [m],y [m],z [m],pitch [rad]")
    shutil.copy(walk / "plates.mot", folder / f"{walk.name}.mot")
    length = float(np.nanmedian(np.linalg.norm(toe - heel, axis=1)))
    spheres = f"px [m],py [m],pz [m],radius [m],zone\n0,0,0,0.005,all\n{length:.4f},0,0,0.005,all\n"
    (folder / "spheres.csv").write_text(spheres)
    return file


def cop_files(folder: Path) -> Path:
    """The foot of the shipped walk and its plates."""
    foot_files(folder, WALK)
    shutil.move(folder / f"{WALK.name}.mot", folder / "plates.mot")
    shutil.move(folder / f"{WALK.name}.csv", folder / "foot.csv")
    return folder


def cop(folder: Path, **changed: Any) -> Said:
    given = {"compare": folder / "plates.mot", "plate": "own_force", "map": "rz=pitch,tx=x,ty=y,tz=z"} | changed
    return said(read_cop, CopOptions, folder / "spheres.csv", motion=folder / "foot.csv", **given)


GATHER = """format = 1
system = "foot"
calibration = ["t01"]
evaluation = ["t02"]
spheres = "spheres.csv"
[constants]
n = 1.2
delta_full = 0.002
mu_s = 0.9
mu_k = 0.7
v_th = 0.25
[parameters.k_all]
start = 3e4
lower = 0.0
upper = 1e6
unit = "N/m^n"
[parameters.b_all]
start = 150.0
lower = 0.0
upper = 1e6
unit = "N s/m"
[from.t01]
inputs = "t01.csv"
plates = "plates.mot"
plate = "own_force"
[from.t02]
inputs = "t02.csv"
plates = "t02.mot"
plate = "own_force"
"""


def gather_files(folder: Path) -> Path:
    """Two shipped walks with feet of two stiffnesses."""
    for name, walk in (("t02", SECOND), ("t01", WALK)):
        foot_files(folder, walk)
        shutil.move(folder / f"{walk.name}.csv", folder / f"{name}.csv")
        shutil.move(folder / f"{walk.name}.mot", folder / ("plates.mot" if name == "t01" else "t02.mot"))
    (folder / "gather.toml").write_text(GATHER)
    return folder


def gather(folder: Path, **changed: Any) -> Said:
    return said(lambda o: gathered(read_gather(o), o), GatherOptions, folder / "gather.toml", **changed)


def rows_changed(name: str, change: Callable[[np.ndarray], None]) -> Damage:
    """A .csv of numbers, changed in place; its first column is time."""

    def damage(folder: Path) -> dict[str, Any]:
        head, *rows = (folder / name).read_text().splitlines()
        values = np.array([[float(cell) for cell in row.split(",")] for row in rows])
        change(values)
        np.savetxt(folder / name, values, delimiter=",", comments="", header=head)
        return {}

    return damage


def moved(column: int, by: float = 0.0, factor: float = 1.0, rows: slice = slice(None)) -> Callable[[np.ndarray], None]:
    def change(values: np.ndarray) -> None:
        values[rows, column] = factor * values[rows, column] + by

    return change


def leg_files(folder: Path) -> Path:
    """A leg that swings: its model, coordinates, markers, and a plate below its foot."""
    _, multibody, time, values = legs.planted(folder)
    write_trc(folder / "walk.trc", legs.markers_of(multibody, time, values))
    write_trc(folder / "still.trc", legs.markers_of(multibody, time[:5], np.tile(values[:1], (5, 1))))
    shutil.copy(MESHES / "leg_swing.mot", folder / "swing.mot")
    legs.plate_files(folder, np.arange(101) / 100.0, (20.0, 225.0, 10.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    return folder


def ik(folder: Path, **changed: Any) -> Said:
    seen = folder / changed.pop("markers", "walk.trc")
    return said(read_ik, IkOptions, seen, model=folder / "leg.osim", **changed)


def scale(folder: Path, **changed: Any) -> Said:
    seen = folder / changed.pop("markers", "still.trc")
    return said(read_scale, ScaleOptions, seen, model=folder / "leg.osim", scale=("femur_r=1.05",), **changed)


def markers(folder: Path, **changed: Any) -> Said:
    asked = {"model": folder / "leg.osim"} | changed
    return said(lambda o: run_markers(read_moved(o), o), MarkersOptions, folder / "swing.mot", **asked)


def inverse_dynamics(folder: Path, **changed: Any) -> Said:
    asked = {"model": folder / "leg.osim", "loads": folder / "loads.xml"} | changed
    return said(read_id, IdOptions, folder / "swing.mot", **asked)


COMPARED = f"""[persons.P1]
mass = {{ value = {MASS}, unit = "kg" }}
static = "standing.trc"
side = "right"

[[trials]]
name = "one"
person = "P1"
setting = "medium"
markers = "walking.trc"
plates = "plates.mot"
plate = "own_force"
other_plate = "other_force"
"""


def compare(folder: Path, **changed: Any) -> Said:
    (folder / "study.toml").write_text(changed.pop("study", COMPARED))
    return said(read_compare, ProsthesisCompareOptions, folder / "study.toml", **changed)


OVERHEAD_STUDY = """[tasks.T1]
tool = { value = 1.3, unit = "kg" }
push = { value = 35, unit = "N" }

[persons.P1]
mass = { value = 82, unit = "kg" }
sex = "male"
dominant = "right"

[[trials]]
person = "P1"
task = "T1"
markers = "markers.trc"
tool = "tool.csv"
"""


def overhead(
    read: Callable[[Any], object], options: Callable[..., Any], level: str, folder: Path, **changed: Any
) -> Said:
    (folder / "study.toml").write_text(changed.pop("study", OVERHEAD_STUDY) + level)
    return said(read, options, folder / "study.toml", **changed)


def swing(ends: str, rows: slice, by: float) -> Callable[[dict[str, np.ndarray]], None]:
    def change(columns: dict[str, np.ndarray]) -> None:
        columns[ends][rows] += by

    return change


def radians(columns: dict[str, np.ndarray]) -> None:
    """Angles in radians below a header that says degrees."""
    for name, values in columns.items():
        if name not in ("time", "tx", "ty", "tz", "foot_x", "foot_y"):
            columns[name] = np.radians(values)


SHOULDER = {
    "a jump of 150 mm": markers_changed("markers.trc", jumping("humerus_rdn")),
    "labels exchanged half-way": markers_changed("markers.trc", exchanged("humerus_rdn", "humerus_ldn")),
    "two of one arm exchanged half-way": markers_changed("markers.trc", exchanged("humerus_rup", "humerus_rdn")),
    "in inches": markers_changed("markers.trc", larger(1.0 / 25.4)),
    "decimal comma": decimal_comma("markers.trc"),
}
STOOD_UP = {f"mass x {factor:g}": body_mass(factor) for factor in (0.7, 1.2857, 2.2)} | {
    "plates 0.1 s late": columns_changed("T1_plates.mot", late(0.1)),
    "plates 0.1 s early": columns_changed("T1_plates.mot", late(-0.1)),
    "force / 2": columns_changed("T1_plates.mot", times(0.5, "_vy")),
    "force in kN": columns_changed("T1_plates.mot", times(1e-3, "_vy")),
    "sign of all forces": columns_changed("T1_plates.mot", alike(times(-1.0, "_vx"), times(-1.0, "_vy"))),
    "centre of pressure in mm": columns_changed("T1_plates.mot", times(1e3, "_px")),
    "axes of the plates exchanged": columns_changed("T1_plates.mot", swapped("_vx", "_vy")),
    "feet and chair exchanged": text_changed(
        "study.toml",
        lambda t: (
            t.replace('"feet_force"', '"X"').replace('"chair_force"', '"feet_force"').replace('"X"', '"chair_force"')
        ),
    ),
    "the chair's plate missing": text_changed("study.toml", lambda t: t.replace('chair = "chair_force"\n', "")),
    "another trial's plates": text_changed("study.toml", lambda t: t.replace('"T1_plates.mot"', '"T3_plates.mot"')),
    "radians, called degrees": columns_changed("T1_coordinates.sto", radians),
    "degrees, called radians": text_changed("T1_coordinates.sto", lambda t: t.replace("inDegrees=yes", "inDegrees=no")),
    "foot in mm": columns_changed("T1_coordinates.sto", times(1e3, "foot_y")),
    "time in ms": columns_changed("T1_coordinates.sto", lambda c: c.update(time=1e3 * c["time"])),
    "height in feet": text_changed("study.toml", lambda t: t.replace("value = 1.75", "value = 5.74")),
    "a child's height": text_changed("study.toml", lambda t: t.replace("value = 1.75", "value = 1.1")),
    "decimal comma": decimal_comma("T1_plates.mot"),
    "plates 0.1 m aside": columns_changed("T1_plates.mot", lambda c: c.update(feet_force_px=c["feet_force_px"] + 0.1)),
    "sign of the rates": columns_changed("T1_rates.sto", lambda c: c.update({k: -c[k] for k in c if k != "time"})),
    "rates in degrees, called radians": columns_changed(
        "T1_rates.sto", lambda c: c.update({k: 57.3 * c[k] for k in ("ankle", "knee", "hip")})
    ),
    "one trial twice": text_changed("study.toml", lambda t: t.replace("T2_", "T1_")),
}
LEG = {
    "a jump of 150 mm": markers_changed("walk.trc", jumping("foot_r1")),
    "labels exchanged half-way": markers_changed("walk.trc", exchanged("foot_r1", "foot_r3")),
    "in m, called mm": markers_changed("walk.trc", larger(1e-3)),
    "decimal comma": decimal_comma("walk.trc"),
}
STILL = {
    "a jump of 150 mm": markers_changed("still.trc", jumping("foot_r1")),
    "labels exchanged half-way": markers_changed("still.trc", exchanged("foot_r1", "tibia_r3")),
    "in m, called mm": markers_changed("still.trc", larger(1e-3)),
    "decimal comma": decimal_comma("still.trc"),
}
SWUNG = {
    "a jump of an angle": columns_changed("swing.mot", swing("hip_z", slice(50, 53), 30.0)),
    "columns exchanged half-way": columns_changed("swing.mot", lambda c: _half(c, "hip_z", "knee")),
    "radians, called degrees": columns_changed("swing.mot", radians),
    "degrees, called radians": text_changed("swing.mot", lambda t: t.replace("inDegrees=yes", "inDegrees=no")),
    "shifts in mm": columns_changed("swing.mot", times(1e3, "ty")),
    "time in ms": columns_changed("swing.mot", lambda c: c.update(time=1e3 * c["time"])),
    "decimal comma": decimal_comma("swing.mot"),
}
LOADED = {name: SWUNG[name] for name in SWUNG if "called" in name or "in m" in name or name == "decimal comma"} | {
    "a jump of an angle": SWUNG["a jump of an angle"],
    "sign of all forces": columns_changed("grf.mot", alike(*(times(-1.0, f"_v{a}") for a in "xyz"))),
    "torque in N mm": columns_changed("grf.mot", times(1e3, "torque_y")),
    "centre of pressure in mm": columns_changed(
        "grf.mot", lambda c: c.update(plate_force_px=c["plate_force_px"] + 300.0)
    ),
    "axes of the plate exchanged": columns_changed("grf.mot", swapped("_vx", "_vy")),
    "the plate's time in ms": columns_changed("grf.mot", lambda c: c.update(time=1e3 * c["time"])),
    "decimal comma in the plate": decimal_comma("grf.mot"),
}
PLATED = {
    name: WALKED[name]
    for name in (
        "sign of the force along the walk", "sign of all forces", "plates 0.1 s late", "plates 0.1 s early",
        "plates 0.2 m aside", "a clock that runs twice as fast", "force in kN",
        "centre of pressure in mm", "axes of the plates exchanged", "the plates' time in ms", "a free moment in N mm",
        "decimal comma in the plates",
    )
}  # fmt: skip
ON_PLATE = PLATED | {
    "the other plate": option(plate="other_force"),
    "floor +50 mm": rows_changed("foot.csv", moved(2, by=0.05)),
    "the foot elsewhere": rows_changed("foot.csv", moved(1, by=0.8)),
    "a jump of 150 mm": rows_changed("foot.csv", moved(1, by=0.15, rows=slice(50, 53))),
    "decimal comma in the motion": decimal_comma("foot.csv"),
}
GATHERED = PLATED | {
    "the other plate": text_changed("gather.toml", lambda t: t.replace("own_force", "other_force", 1)),
    "floor +50 mm": rows_changed("t01.csv", moved(2, by=0.05)),
    "the foot elsewhere": rows_changed("t01.csv", moved(1, by=0.8)),
    "a jump of 150 mm": rows_changed("t01.csv", moved(1, by=0.15, rows=slice(50, 53))),
    "pitch in degrees, called radians": rows_changed("t01.csv", moved(4, factor=57.3)),
    "x in mm, called m": rows_changed("t01.csv", moved(1, factor=1e3)),
    "the same files twice": text_changed(
        "gather.toml", lambda t: t.replace("t02.csv", "t01.csv").replace("t02.mot", "plates.mot")
    ),
    "the same plates twice": text_changed("gather.toml", lambda t: t.replace("t02.mot", "plates.mot")),
    "the same plates on another clock": all_of(
        lambda folder: (shutil.copy(folder / "plates.mot", folder / "t02.mot"), {})[1],
        columns_changed("t02.mot", late(0.004)),
    ),
    "inputs 1 s late": rows_changed("t01.csv", moved(0, by=1.0)),
    "inputs 0.1 s late": rows_changed("t01.csv", moved(0, by=0.1)),
    "decimal comma in the inputs": decimal_comma("t01.csv"),
}  # fmt: skip


def _half(columns: dict[str, np.ndarray], one: str, other: str) -> None:
    half = len(columns[one]) // 2
    columns[one][half:], columns[other][half:] = columns[other][half:].copy(), columns[one][half:].copy()


JOINED = {
    name: WALKED[name]
    for name in (
        "standing trial 25 % larger", "right and left mirrored", "z is up", "a jump of 150 mm",
        "labels exchanged half-way", "the standing trial twice", "decimal comma in the markers",
        "markers in m, called mm", "markers in cm, called mm",
    )
}  # fmt: skip
COMPARISON = {
    name: WALKED[name]
    for name in (
        "a jump of 150 mm", "labels exchanged half-way", "force / 2", "plates 0.1 s late", "sign of all forces",
        "sign of the force along the walk", "standing trial 25 % larger", "z is up",
    )
}  # fmt: skip
OVERHEAD_FEW = {name: SHOULDER[name] for name in ("a jump of 150 mm", "in inches")}
Run = Callable[..., Said]
COMMANDS: dict[str, tuple[Run, Path | Callable[[Path], Path], dict[str, Damage]]] = {
    "prosthesis simulate": (simulate, WALK, WALKED),
    "prosthesis calibrate": (calibrate, WALK, WALKED),
    "prosthesis design": (design, WALK, {name: WALKED[name] for name in WALKED if name != "the other plate"}),
    "prosthesis scale": (
        stood,
        WALK,
        {name: STANDING[name] for name in STANDING if name != "standing trial 25 % larger"}
        | {"pounds": option(mass=2.2046 * MASS), "a child's mass": option(mass=30.0)},
    ),
    "prosthesis compare": (compare, WALK, COMPARISON),
    "shoulder simulate": (shoulder, OVERHEAD, SHOULDER),
    "shoulder study": (partial(overhead, read_study, StudyOptions, 'level = "100%"\n'), OVERHEAD, OVERHEAD_FEW),
    "shoulder optimise": (partial(overhead, read_optimise, ShoulderOptimiseOptions, ""), OVERHEAD, OVERHEAD_FEW),
    "sit-to-stand calibrate": (standing_up, STANDING_UP, STOOD_UP),
    "ik": (ik, leg_files, LEG),
    "scale": (scale, leg_files, STILL),
    "joint": (joint, WALK, JOINED),
    "markers": (markers, leg_files, SWUNG),
    "id": (inverse_dynamics, leg_files, LOADED),
    "cop": (cop, cop_files, ON_PLATE),
    "gap gather": (gather, gather_files, GATHERED),
}
EACH = [(command, name) for command, (_, _, damages) in COMMANDS.items() for name in damages]


def trial_of(command: str, folder: Path) -> Path:
    source = COMMANDS[command][1]
    return files_of(source, folder) if isinstance(source, Path) else source(folder)


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Said]:
    """What each command says of its trial as it is shipped."""
    return {
        command: run(trial_of(command, tmp_path_factory.mktemp("clean"))) for command, (run, _, _) in COMMANDS.items()
    }


@pytest.mark.parametrize(("command", "name"), EACH)
def test_no_wrong_input_is_silent(command: str, name: str, tmp_path: Path, clean: dict[str, Said]) -> None:
    """What is said names the cause that was made; an unrelated warning does not count."""
    run, _, damages = COMMANDS[command]
    folder = trial_of(command, tmp_path)
    said = run(folder, **damages[name](folder)) - clean[command]
    assert [line for line in said if re.search(MEANT[name], line)], said


def test_every_pattern_is_of_a_damage() -> None:
    assert set(MEANT) == {name for _, name in EACH}


@pytest.mark.parametrize("command", COMMANDS)
def test_the_shipped_trial_is_not_doubted(command: str, clean: dict[str, Said]) -> None:
    """What is said of it is about numbers that nobody has measured, not about the recording."""
    known = ("regression", "for this sole only the general prior", "invented", "to lie straight below")
    known += (
        "nothing is mapped to rx, ry",
        "is taken; forces depend on this value",
        "numbers of the force law that were not given",
    )
    assert not [line for line in clean[command] if not any(word in line for word in known)]


def test_a_study_says_what_a_trial_said(tmp_path: Path) -> None:
    """`cohort` over two motions of the leg, one with a jump: its warning is the study's, in words and in trials.csv."""
    leg_files(tmp_path)
    shutil.copy(tmp_path / "swing.mot", tmp_path / "right.mot")
    SWUNG["a jump of an angle"](tmp_path)
    (tmp_path / "study.toml").write_text(
        'analysis = "markers"\n[options]\nmodel = "leg.osim"\n[sweep]\ncoordinates = ["swing.mot", "right.mot"]\n'
    )
    done = call(
        "cohort",
        tmp_path / "study.toml",
        "--out",
        tmp_path / "out",
        folder=tmp_path / "out",
    )
    assert done.code == 0, done.err
    assert [line for line in done.warnings if "leaves its course" in line]
    assert sorted(done.table("trials.csv")["warnings [-]"]) != [0, 0]
