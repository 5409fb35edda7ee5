"""A pelvis with one leg as an OpenSim model, its motion, its markers and a ground reaction."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import storage, written

TIME = np.arange(41) / 100.0
BODIES = {"pelvis": 10.0, "femur_r": 8.0, "tibia_r": 4.0, "foot_r": 1.0}
"""Masses [kg]."""
JOINTS = (
    ("FreeJoint", "base", "ground", "pelvis", (0, 0, 0), ("tilt", "list", "turn", "tx", "ty", "tz")),
    ("BallJoint", "hip_r", "pelvis", "femur_r", (0, -0.1, 0.1), ("hip_x", "hip_y", "hip_z")),
    ("PinJoint", "knee_r", "femur_r", "tibia_r", (0, -0.4, 0), ("knee",)),
    ("PinJoint", "ankle_r", "tibia_r", "foot_r", (0, -0.4, 0), ("ankle",)),
)
PLACES = np.array(((0.1, 0.0, 0.03), (-0.08, 0.05, 0.0), (0.0, -0.2, 0.08), (0.05, -0.1, -0.07)))
"""Of the markers of each body, in its frame [m]."""
ASKED = "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"
COORDINATES = tuple(name for joint in JOINTS for name in joint[-1])
LENGTHS = ("tx", "ty", "tz")


def make(home: Path, meshes: Path) -> None:
    """Markers are off by 2 mm; the static trial is that of a longer thigh and a shorter shank."""
    written(home / "leg.osim", model())
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
        found.append(origin + sizes.get(child, 1.0) * PLACES @ rotation.T)
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


def model() -> str:
    """The .osim file."""
    parts = {
        "BodySet": "".join(map(_body, BODIES)),
        "JointSet": "".join(_joint(*joint) for joint in JOINTS),
        "MarkerSet": "".join(_marker(body, k) for body in BODIES for k in range(4)),
    }
    sets = "\n".join(f"<{name}><objects>{text}</objects></{name}>" for name, text in parts.items())
    return f"""<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="synthetic leg">
<gravity>0 -9.80665 0</gravity><Ground name="ground"/>
{sets}
</Model></OpenSimDocument>"""


def _body(name: str) -> str:
    mass = BODIES[name]
    inertia = f"{0.02 * mass} {0.01 * mass} {0.015 * mass} 0 0 0"
    return f"""<Body name="{name}"><mass>{mass}</mass><mass_center>0 -0.15 0</mass_center>
<inertia>{inertia}</inertia></Body>"""


def _joint(kind: str, name: str, parent: str, child: str, at: tuple[float, ...], coordinates: tuple[str, ...]) -> str:
    path = "/ground" if parent == "ground" else f"/bodyset/{parent}"
    held = "".join(f'<Coordinate name="{c}"/>' for c in coordinates)
    return f"""<{kind} name="{name}"><socket_parent_frame>{name}_in</socket_parent_frame>
<socket_child_frame>{name}_out</socket_child_frame><coordinates>{held}</coordinates><frames>
<PhysicalOffsetFrame name="{name}_in"><socket_parent>{path}</socket_parent>
<translation>{" ".join(map(str, at))}</translation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="{name}_out"><socket_parent>/bodyset/{child}</socket_parent></PhysicalOffsetFrame>
</frames></{kind}>"""


def _marker(body: str, k: int) -> str:
    place = " ".join(map(str, PLACES[k]))
    return f"""<Marker name="{body}{k}"><socket_parent_frame>/bodyset/{body}</socket_parent_frame>
<location>{place}</location></Marker>"""


def _task(body: str, k: int) -> str:
    return f'<IKMarkerTask name="{body}{k}"><weight>{1 + k}</weight></IKMarkerTask>'
