"""A synthetic pelvis with one leg as an OpenSim model with markers, and a leg swing for it."""

from __future__ import annotations

import numpy as np

GRAVITY = 9.80665
BODIES = {"pelvis": 10.0, "femur_r": 8.0, "tibia_r": 4.0, "foot_r": 1.0}
"""Masses [kg]."""
JOINTS = (
    ("FreeJoint", "base", "ground", "pelvis", (0, 0, 0), ("tilt", "list", "turn", "tx", "ty", "tz")),
    ("BallJoint", "hip_r", "pelvis", "femur_r", (0, -0.1, 0.1), ("hip_x", "hip_y", "hip_z")),
    ("PinJoint", "knee_r", "femur_r", "tibia_r", (0, -0.4, 0), ("knee",)),
    ("PinJoint", "ankle_r", "tibia_r", "foot_r", (0, -0.4, 0), ("ankle",)),
)
PLACES = ((0.1, 0.0, 0.03), (-0.08, 0.05, 0.0), (0.0, -0.2, 0.08), (0.05, -0.1, -0.07))
"""Of the four markers of each body [m]."""
FRAMES, RATE = 101, 100.0
SWING = {"hip_z": (10.0, 25.0, 0.0), "knee": (-35.0, 30.0, 0.25), "ankle": (0.0, 8.0, 0.4), "tilt": (0.0, 2.0, 0.1)}
"""Mean, amplitude [deg] and phase [cycles] of what moves."""


def leg_model() -> str:
    """OpenSim 4 model: x forward, y up, z to the right."""
    bodies = "\n".join(_body(*each) for each in BODIES.items())
    joints = "\n".join(_joint(*each) for each in JOINTS)
    markers = "\n".join(_marker(body, k) for body in BODIES for k in range(len(PLACES)))
    return f"""<?xml version="1.0"?>
<OpenSimDocument Version="40000"><Model name="synthetic_leg">
<credits>Synthetic sample leg of geocontact: no subject, no patient.</credits>
<gravity>0 -{GRAVITY} 0</gravity><Ground name="ground"/>
<BodySet><objects>
{bodies}
</objects></BodySet>
<JointSet><objects>
{joints}
</objects></JointSet>
<MarkerSet><objects>
{markers}
</objects></MarkerSet>
</Model></OpenSimDocument>
"""


def leg_swing() -> str:
    """OpenSim `.mot` of the model's coordinates [deg, m]: one swing of the leg in a second, the pelvis 1 m up."""
    time = np.arange(FRAMES) / RATE
    names = [name for *_, coordinates in JOINTS for name in coordinates]
    columns = {name: np.zeros(FRAMES) for name in names} | {"ty": np.full(FRAMES, 1.0)}
    for name, (mean, amplitude, phase) in SWING.items():
        columns[name] = mean + amplitude * np.sin(2.0 * np.pi * (time / time[-1] + phase))
    head = ["synthetic leg swing", "version=1", f"nRows={FRAMES}", f"nColumns={len(names) + 1}", "inDegrees=yes"]
    rows = [*head, "endheader", "\t".join(["time", *names])]
    for k, t in enumerate(time):
        rows.append("\t".join([f"{t:.2f}", *(f"{columns[name][k] + 0.0:.9f}" for name in names)]))
    return "\n".join(rows) + "\n"


def _body(name: str, mass: float) -> str:
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
