"""A pelvis with one leg as an OpenSim model, its motion, its markers and a ground reaction."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import storage, written
from meshes.leg_files import BODIES, JOINTS, PLACES, leg_model

TIME = np.arange(41) / 100.0
ASKED = "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"
COORDINATES = tuple(name for joint in JOINTS for name in joint[-1])
LENGTHS = ("tx", "ty", "tz")


def make(home: Path, meshes: Path) -> None:
    """Markers are off by 2 mm; the static trial is that of a longer thigh and a shorter shank."""
    written(home / "leg.osim", leg_model())
    phase = 2.0 * np.pi * (1.3 * TIME[:, None] + np.linspace(0.0, 0.8, len(COORDINATES)))
    swing = 0.25 * np.sin(phase)
    swing[:, COORDINATES.index("ty")] += 1.0
    columns = {name: swing[:, k] if name in LENGTHS else np.degrees(swing[:, k]) for k, name in enumerate(COORDINATES)}
    storage(home / "walk.mot", {"time": TIME, **columns}, degrees=True)
    off = np.random.default_rng(3).normal(0.0, 2e-3, (len(TIME), 16, 3))
    trc(home / "walk.trc", np.array([markers(row) for row in swing]) + off)
    trc(home / "static.trc", np.array([markers(0.0 * row, 1.1, 0.9) for row in swing[:3]]) + off[:3])
    reaction(home)
    tasks = "".join(_task(body, k) for body in BODIES for k in range(4))
    written(home / "tasks.xml", f"<OpenSimDocument><IKTaskSet>{tasks}</IKTaskSet></OpenSimDocument>")


def turned(axis: int, angle: float) -> np.ndarray:
    """Rotation about one axis."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


def markers(row: np.ndarray, thigh: float = 1.0, shank: float = 1.0) -> np.ndarray:
    """Places (16, 3) [m] of the markers at coordinates [rad, m], of a leg whose parts are so many times as long."""
    value = dict(zip(COORDINATES, row, strict=True))
    sizes = {"femur_r": thigh, "tibia_r": shank}
    frames = {"ground": (np.eye(3), np.zeros(3))}
    found = []
    for kind, _, parent, child, at, names in JOINTS:
        rotation, origin = frames[parent]
        origin = origin + rotation @ (sizes.get(parent, 1.0) * np.array(at, float))
        axes = (2,) if kind == "PinJoint" else (0, 1, 2)
        if kind == "FreeJoint":
            origin = origin + np.array([value[name] for name in LENGTHS])
        for axis, name in zip(axes, names, strict=False):
            rotation = rotation @ turned(axis, value[name])
        frames[child] = rotation, origin
        found.append(origin + sizes.get(child, 1.0) * np.array(PLACES) @ rotation.T)
    return np.concatenate(found)


def trc(file: Path, places: np.ndarray) -> None:
    """Markers (t, 16, 3) [m] as a .trc file in mm."""
    names = [f"{body}{k}" for body in BODIES for k in range(4)]
    told = ["100", "100", str(len(places)), str(len(names)), "mm", "100", "1", str(len(places))]
    axes = [f"{axis}{k + 1}" for k in range(len(names)) for axis in "XYZ"]
    lines = [f"PathFileType\t4\t(X/Y/Z)\t{file.name}", ASKED, "\t".join(told)]
    lines += ["Frame#\tTime\t" + "\t\t\t".join(names), "\t\t" + "\t".join(axes), ""]
    for k, row in enumerate(1e3 * places):
        lines.append("\t".join([str(k + 1), f"{TIME[k]:.9g}", *(f"{value:.6f}" for value in row.ravel())]))
    written(file, "\n".join(lines) + "\n")


def reaction(home: Path) -> None:
    """A reaction on the foot that grows and fades [N], and OpenSim's file that says so."""
    rise, still = np.sin(np.pi * TIME / TIME[-1]), np.zeros_like(TIME)
    columns = {"plate_force_vx": 20.0 * rise, "plate_force_vy": 220.0 * rise, "plate_force_vz": still}
    columns |= {"plate_force_px": still, "plate_force_py": still, "plate_force_pz": still + 0.1}
    columns |= {f"plate_torque_{axis}": still for axis in "xyz"}
    storage(home / "grf.mot", {"time": TIME, **columns})
    force = """<applied_to_body>foot_r</applied_to_body><force_identifier>plate_force_v</force_identifier>
<point_identifier>plate_force_p</point_identifier><torque_identifier>plate_torque_</torque_identifier>"""
    loads = f'<objects><ExternalForce name="right">{force}</ExternalForce></objects><datafile>grf.mot</datafile>'
    text = f'<OpenSimDocument Version="40000"><ExternalLoads name="loads">{loads}</ExternalLoads></OpenSimDocument>'
    written(home / "loads.xml", f'<?xml version="1.0"?>{text}')


def _task(body: str, k: int) -> str:
    return f'<IKMarkerTask name="{body}{k}"><weight>{1 + k}</weight></IKMarkerTask>'
