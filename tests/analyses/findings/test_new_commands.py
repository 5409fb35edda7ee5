"""Wrong inputs on commands that were new, of which 18 of 124 passed without a word: each is heard of now, by name."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from tests.analyses.findings.heard import Finding, Lines, as_lines, as_parameters, changed_csv, heard, times, typed
from tests.cli.calls import FEMUR, INSERT, MESHES, SPHERE, gait
from tests.cli.test_opensim_setup import SCALE, swinging, task
from tests.trial_checks import test_commands as trials

UNLOADED = MESHES / "standing_up_exoskeleton"
ANGLES, MOTORS = UNLOADED / "unloaded_coordinates.sto", UNLOADED / "unloaded_motors.sto"
OVERHEAD = MESHES / "overhead_P1T1S100"
Attempt = Callable[[Path], Lines]


def device(factor: float) -> Attempt:
    """Motor torques times a factor."""
    return lambda folder: heard(gc.sit_to_stand.device, ANGLES, motors=times(MOTORS, folder, factor))


def walked(damage: trials.Damage) -> Attempt:
    """Prosthesis simulate, up to its reading, along the shipped walk with one thing wrong."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.WALK, folder)
        return as_lines(trials.simulate(there, **damage(there)))

    return attempt


def x_and_z_exchanged(columns: dict[str, np.ndarray]) -> None:
    for name in [each for each in columns if each.endswith("x")]:
        other = name[:-1] + "z"
        columns[name], columns[other] = columns[other], columns[name]


def a_gap(columns: dict[str, np.ndarray]) -> None:
    """50 samples without a force in the middle of the stance."""
    columns["own_force_vy"][150:200] = np.nan


def stood_up(damage: trials.Damage) -> Attempt:
    """Sit-to-stand calibrate, up to its reading, on the shipped study with one thing wrong."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.STANDING_UP, folder)
        damage(there)
        return as_lines(trials.standing_up(there))

    return attempt


def half_the_plate(folder: Path) -> dict[str, object]:
    for file in folder.glob("*_plates.mot"):
        times(file, folder, 0.5, "_v")
    return {}


def set_up(*changes: tuple[str, str], z_up: bool = False) -> Attempt:
    """Scale --setup with words of the set-up replaced."""

    def attempt(folder: Path) -> Lines:
        swinging(folder)
        text = SCALE.format("".join(task(f"femur_r{k}", 1.0) for k in range(4)))
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        (folder / "scale.xml").write_text(text)
        if z_up:
            trials.markers_changed("walk.trc", trials.z_up)(folder)
        return typed("scale", "--setup", folder / "scale.xml", "--out", folder / "out")

    return attempt


def settled(moving: Path = FEMUR, fixed: Path = INSERT, poses: str = "mm", **options: object) -> Attempt:
    """Knee settle in one frame of the shipped cycle, its layer in large pieces."""

    def attempt(folder: Path) -> Lines:
        motion = gait(folder, (30,))
        motion.write_text(motion.read_text().replace("[mm]", f"[{poses}]"))
        given = {"unit": "mm", "side": "right", "load": 1800.0, "modulus": gc.MPa(463), "poisson": 0.46}
        given |= {"motion": motion, "piece": gc.mm(3), "thickness": gc.mm(8)}
        return heard(gc.knee.settle, moving, fixed, **(given | options))

    return attempt


def settled_with_forces(folder: Path) -> Lines:
    """kN under [N]."""
    (folder / "forces.csv").write_text("time [s],total [N]\n0,2\n0.3,2\n1,2\n")
    return settled(load=None, forces=folder / "forces.csv")(folder)


def raised_arm(folder: Path, **options: object) -> Lines:
    return heard(gc.shoulder.simulate, OVERHEAD / "markers.trc", side="right", **options)


def short_cuff(folder: Path) -> Lines:
    (folder / "device.toml").write_text('name = "short"\n[numbers]\ncuff_length = { value = 16, unit = "mm" }\n')
    return raised_arm(folder, device=str(folder / "device.toml"))


def in_milliamperes(folder: Path) -> Lines:
    return raised_arm(folder, tool=changed_csv(OVERHEAD / "tool.csv", folder, current=lambda amperes: 1e3 * amperes))


def studied(*lines: str, unit: str = "mm") -> Attempt:
    """A study of two trials of areas on the shipped knee."""

    def attempt(folder: Path) -> Lines:
        motion = gait(folder, (30,))
        text = f'analysis = "area"\n[options]\nmoving = "{FEMUR}"\nfixed = "{INSERT}"\nunit = "{unit}"\n'
        text += f'motion = "{motion.name}"\n[sweep]\nthreshold = [1, 4]\n'
        (folder / "study.toml").write_text(text + "\n".join(lines))
        return heard(gc.cohort, folder / "study.toml", workers=1)

    return attempt


BY_HAND = (
    (" measurements manualScale", " manualScale"),
    ("<ScaleSet><objects>", "<Scales><objects>"),
    ("</objects></ScaleSet>", "</objects></Scales>"),
)
PRESSURE = "(warned|contradicts): .*(exchanged|pressure)"

FINDINGS: dict[str, Finding] = {
    "d_neg: motor torques with opposite sign": Finding(device(-1.0), "contradicts: .*viscous friction.*sign turned"),
    "d_Nmm: motor torques in N mm": Finding(device(1000.0), "warned: .*motors.* 40063 N m is unusual.*N mm meant"),
    "c_unit: a study with unit = cm": Finding(studied(unit="cm"), "warned: .*1061 mm across", slow=True),
    "c_col: a column of the summary that no table has": Finding(
        studied('[summary]\ntable = "area"\ncolumns = ["area [mm^2]"]'),
        r"refused: .*no column 'area \[mm\^2\]'",
        slow=True,
    ),
    "p_negx: fore-aft sign of the plates": Finding(
        walked(trials.plates_changed(trials.times(-1.0, "_vx"))), "warned: .*sign of the force along the walk turned"
    ),
    "p_xz: x and z of the plates exchanged": Finding(
        walked(trials.plates_changed(x_and_z_exchanged)), "warned: .*plates and markers in the same axes"
    ),
    "p_m60: 60 kg for 77.3": Finding(
        walked(trials.option(mass=60.0)), "warned: .*carry # times the weight of # kg over a step.*check `mass`"
    ),
    "p_lb: 170.4 lb as kg": Finding(walked(trials.option(mass=170.4)), "warned: .*is about # kg: check `mass`"),
    "p_nan: a gap in the plates": Finding(
        walked(trials.plates_changed(a_gap)), r"refused: .*its force is missing from 0\.175 to 0\.273 s, under load"
    ),
    "t_mass: 154 lb as kg": Finding(stood_up(trials.body_mass(154.0 / 70.0)), "refused: .*0.45 times the weight"),
    "t_mass60: 55 kg for 70": Finding(stood_up(trials.body_mass(55.0 / 70.0)), "refused: .*1.26 times the weight"),
    "t_half: half of the plate's force": Finding(stood_up(half_the_plate), "refused: .*that no plate is missing"),
    "x_zup: markers with z up": Finding(set_up(z_up=True), "warned: .*945.0 mm from the model.*axes"),
    "x_lb: mass in lb": Finding(set_up(("<mass>30<", "<mass>66<")), "warned: .*mass.*66 kg is 3 times"),
    "x_order: manualScale without a ScaleSet": Finding(
        set_up(*BY_HAND), "warned: .*scaling_order manualScale, of which the set-up has nothing"
    ),
    "x_base: a ScaleTool file without tasks": Finding(
        set_up(("IKMarkerTask", "Task"), ("IKTaskSet", "TaskSet")), "refused: .*holds no IKMarkerTask; .*of scaling"
    ),
    "k_load2: 2 N for 2 kN": Finding(settled(load=2.0), "warned: `load`: 2 N is unusual.*2 kN meant"),
    "k_fkn: kN under [N]": Finding(settled_with_forces, "warned: .*forces.csv.* 2 N is unusual.*2 kN meant"),
    "k_GPa: 463 GPa for MPa": Finding(settled(modulus=gc.GPa(463)), "warned: `modulus`: 463000 MPa is unusual"),
    "k_Pa: 463 without a unit": Finding(settled(modulus=463.0), "refused: `modulus`: .*is 463 MPa meant"),
    "k_exchanged: insert and femoral component": Finding(settled(INSERT, FEMUR), PRESSURE),
    "k_springs: 30000 N/mm for 30": Finding(
        settled(free=("adduction", "anterior"), springs={"anterior": 3e7}),
        "warned: `springs` anterior: 30000 N/mm is unusual.*30000 N/m meant",
    ),
    "k_bodies: names exchanged": Finding(
        settled(bodies=("tibial_insert", "femoral_component")), "warned: `bodies`: .*are they exchanged"
    ),
    "k_m: poses in m under [mm]": Finding(settled(poses="m"), "refused: .*no contact.*check motion, unit"),
    "k_region: a strip of the insert": Finding(settled(region="nz>0.25"), PRESSURE),
    "s_toolmA: current in mA under [A]": Finding(in_milliamperes, "warned: .*`tool`: 4820 A is unusual.*4820 mA meant"),
    "s_upr: upright in the middle of the work": Finding(
        lambda folder: raised_arm(folder, upright=(3.0, 4.0)), "warned: `upright`: the right arm is 124 degrees up"
    ),
    "s_device: a cuff of 16 mm for 160": Finding(short_cuff, "refused: .*the cuff is 16 mm long"),
    "q_cm: a sphere of 20 mm in cm": Finding(
        lambda _: heard(gc.fit_shape, SPHERE, shape="sphere", unit="cm"), "warned: .*radius.*200.*unusual"
    ),
}
"""`k_thickness`, 8 for 8 mm, is what the help says of lengths without a unit, and no wrong input."""


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_a_wrong_input_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert any(re.search(finding.words, line) for line in lines), lines
