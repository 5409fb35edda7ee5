"""Files for other programs: angles and external loads for OpenSim, lines for ParaView."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from geocontact.io.opensim.external_loads_writer import write_external_loads as write_loads_file
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.shoulder_exoskeleton.device import JOINTS
from geocontact.shoulder_exoskeleton.from_markers.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation
from geocontact.view.surfaces.line_series import LineSeries, write_line_series

HUMERUS = {"right": "humerus_r", "left": "humerus_l"}
"""Bodies of OpenSim's models that the forces act on."""
LOADS = "interface_forces"


def write_angles(folder: Path, arms: Sequence[ArmSimulation]) -> None:
    """angles.sto: joints of the exoskeleton by side, in degrees."""
    names = [f"{joint}_{arm.motion.side}" for arm in arms for joint in JOINTS]
    values = np.degrees(np.hstack([arm.angles for arm in arms]))
    title = "Angles of a shoulder exoskeleton"
    write_storage(folder / "angles.sto", arms[0].motion.time, names, values, title=title, degrees=True)


def write_external_loads(folder: Path, arms: Sequence[ArmSimulation], frame: DeviceFrame) -> None:
    """interface_forces.mot and .xml: forces of the cuffs on the human arms, in the laboratory's frame.

    They act at the sphere's centre, on the upper arm's axis; a cuff that holds by its surface turns the arm as well.
    """
    surface = arms[0].cuff == "surface"
    names: list[str] = []
    columns, loads = [], {}
    for arm in arms:
        side = arm.motion.side
        force = np.einsum("tij,ti->tj", frame.rotation, arm.told["force"])
        place = frame.origin + np.einsum("tij,ti->tj", frame.rotation, arm.motion.interface)
        stem = f"cuff_{side}_force"
        names += [f"{stem}_{kind}{axis}" for kind in "vp" for axis in "xyz"]
        columns += [force, place]
        if surface:
            names += [f"cuff_{side}_torque_{axis}" for axis in "xyz"]
            columns.append(np.einsum("tij,ti->tj", frame.rotation, arm.told["moment"]))
        loads[stem] = HUMERUS[side]
    title = "Forces of a shoulder exoskeleton on the upper arms"
    time, values = arms[0].motion.time, np.hstack(columns)
    write_storage(folder / f"{LOADS}.mot", time, names, values, title=title, degrees=False)
    write_loads_file(folder / f"{LOADS}.xml", f"{LOADS}.mot", loads, torques=surface)


def write_lines(folder: Path, arms: Sequence[ArmSimulation]) -> None:
    """device.pvd: the exoskeleton's arms, the human ones and the back down to the lap belt, with the cuffs' forces."""
    points, lines, forces = [], [], []
    start = 0
    for arm in arms:
        joints = arm.told["joints"].reshape(-1, 4, 3)
        human = np.stack([arm.motion.shoulder, arm.motion.interface], axis=1)
        points.append(np.concatenate([joints, human], axis=1))
        lines += [tuple(range(start, start + 4)), (start + 4, start + 5)]
        at = np.zeros((len(joints), 6, 3))
        at[:, 5] = arm.told["force"]
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
