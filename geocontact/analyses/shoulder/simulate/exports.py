"""Files for other programs: OpenSim's loads, lines for ParaView, a case of the base model `shoulder`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.io.opensim.external_loads import write_external_loads as write_loads_file
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.results import write_table
from geocontact.shoulder_exoskeleton.carried_device import forces_of_device
from geocontact.shoulder_exoskeleton.device import JOINTS
from geocontact.shoulder_exoskeleton.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.plane import plane_arm
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation
from geocontact.shoulder_exoskeleton.working_arm import SCREWING, SimulatedArm
from geocontact.view.surfaces.vtp_series import LineSeries, write_line_series

HUMERUS, TRUNK = {"right": "humerus_r", "left": "humerus_l"}, "torso"
"""Bodies of OpenSim's models that the forces act on."""
LOADS = "interface_forces"


def write_angles(folder: Path, arms: Sequence[ArmSimulation]) -> None:
    """angles.sto: joints of the exoskeleton by side, in degrees."""
    names = [f"{joint}_{arm.motion.side}" for arm in arms for joint in JOINTS]
    values = np.degrees(np.hstack([arm.angles for arm in arms]))
    title = "Angles of a shoulder exoskeleton"
    write_storage(folder / "angles.sto", arms[0].motion.time, names, values, title=title, degrees=True)


def write_external_loads(folder: Path, arms: Sequence[ArmSimulation], frame: DeviceFrame) -> None:
    """interface_forces.mot and .xml: all that the device does to arms and trunk, in the laboratory's frame.

    Forces of the cuffs act on the human arms at the sphere's centre, on the upper arm's axis; a cuff that holds by its
    surface turns the arm as well. The trunk gets the opposite of both, and at each arm's first passive joint the
    device's weight and inertia with their moment.
    """
    names: list[str] = []
    columns, loads = [], {}
    for arm in arms:
        side = arm.motion.side
        for what, wrench in forces_of_device(arm).items():
            acting, at, turning = (np.einsum("tij,ti->tj", frame.rotation, each) for each in wrench)
            stem = f"{what}_{side}_force"
            names += [f"{stem}_{kind}{axis}" for kind in "vp" for axis in "xyz"]
            names += [f"{what}_{side}_torque_{axis}" for axis in "xyz"]
            columns += [acting, frame.origin + at, turning]
            loads[stem] = HUMERUS[side] if what == "cuff" else TRUNK
    title = "Forces of a shoulder exoskeleton on the upper arms and on the trunk"
    time, values = arms[0].motion.time, np.hstack(columns)
    write_storage(folder / f"{LOADS}.mot", time, names, values, title=title, degrees=False)
    write_loads_file(folder / f"{LOADS}.xml", f"{LOADS}.mot", loads, torques=True)


def write_lines(folder: Path, arms: Sequence[ArmSimulation]) -> None:
    """device.pvd: the exoskeleton's arms, the human ones and the back down to the lap belt, with the cuffs' forces."""
    points, lines, forces = [], [], []
    start = 0
    for arm in arms:
        joints = arm.outputs["joints"].reshape(-1, 4, 3)
        human = np.stack([arm.motion.shoulder, arm.motion.interface], axis=1)
        points.append(np.concatenate([joints, human], axis=1))
        lines += [tuple(range(start, start + 4)), (start + 4, start + 5)]
        at = np.zeros((len(joints), 6, 3))
        at[:, 5] = arm.outputs["force"]
        forces.append(at)
        start += 6
    first = arms[0]
    back = np.zeros((len(first.motion.time), 2, 3))
    back[:, 1, 2] = -first.device["belt_share"] * first.wearer.torso
    points.append(back)
    lines.append((start, start + 1))
    forces.append(np.zeros_like(back))
    series = LineSeries(arms[0].motion.time, np.concatenate(points, axis=1), lines)
    write_line_series(folder, "device", series, {"force on the arm [N]": np.concatenate(forces, axis=1)})


FREE = {"k_t": ("N/m", 50.0, 2e4), "b_t": ("N s/m", 0.0, 500.0), "m": ("kg", 0.05, 5.0)}
"""Numbers that a fit may free, with unit and bounds; the others are constants."""
HEAD = """# {side} arm in its plane; the hinge moves by {moved} (standard deviation) forwards and upwards
# A diagnosis needs two trials to fit to, and others to hold out, two if there are: simulate them as well, then write
# their folders for SECOND and THIRD below, and their levels, 0 to 1.
format = 1
system = "shoulder"
support = "support.csv"
calibration = ["t01", "t02"]
evaluation = ["t03"]

[from.t01]
inputs = "{side}.csv"
outputs = "{side}_simulated.csv"

[trial.t01]
level = {level:g}

[from.t02]
inputs = "SECOND/plane/{side}.csv"
outputs = "SECOND/plane/{side}_simulated.csv"

[trial.t02]
level = {level:g}

[from.t03]
inputs = "THIRD/plane/{side}.csv"
outputs = "THIRD/plane/{side}_simulated.csv"

[trial.t03]
level = {level:g}

[constants]
{known}

{free}
"""


def write_plane(folder: Path, arm: SimulatedArm) -> None:
    """SIDE.csv (arm, event), SIDE_simulated.csv (exo, force), support.csv, and SIDE.toml to copy into a gather.toml."""
    s, side = arm.simulation, arm.side
    found = plane_arm(s)
    folder.mkdir(parents=True, exist_ok=True)
    event = (arm.phase == SCREWING).astype(int)
    time = s.motion.time
    inputs = {"time [s]": time, "arm [deg]": np.degrees(s.motion.elevation), "event [-]": event}
    write_table(pd.DataFrame(inputs), folder, side)
    outputs = {"time [s]": time, "exo [deg]": np.degrees(s.elevation), "force [N]": s.supporting}
    write_table(pd.DataFrame(outputs), folder, f"{side}_simulated")
    support = {"angle [deg]": np.degrees(found.angle), "torque [N m]": found.torque}
    write_table(pd.DataFrame(support), folder, "support")
    known = "\n".join(f"{name} = {value:.9g}" for name, value in found.constants.items() if name not in FREE)
    moved = " and ".join(f"{1e3 * each:.1f} mm" for each in found.moved)
    free = "\n".join(_parameter(name, found.constants[name]) for name in FREE)
    text = HEAD.format(side=side, moved=moved, level=s.level, known=known, free=free)
    (folder / f"{side}.toml").write_text(text, encoding="utf-8")


def _parameter(name: str, start: float) -> str:
    unit, lower, upper = FREE[name]
    return f'[parameters.{name}]\nstart = {start:.6g}\nlower = {lower:g}\nupper = {upper:g}\nunit = "{unit}"\n'
