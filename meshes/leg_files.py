"""A synthetic pelvis with one leg as an OpenSim model with markers, and a leg swing for it."""

from __future__ import annotations

from collections.abc import Mapping

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


def document(name: str, bodies: str, joints: str, markers: str) -> str:
    """OpenSim 4 model of these parts, each already written."""
    return f"""<?xml version="1.0"?>
<OpenSimDocument Version="40000"><Model name="{name}">
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


def leg_model() -> str:
    """OpenSim 4 model: x forward, y up, z to the right."""
    bodies = "\n".join(body(*each) for each in BODIES.items())
    joints = "\n".join(joint(*each) for each in JOINTS)
    markers = "\n".join(marker(name, k) for name in BODIES for k in range(len(PLACES)))
    return document("synthetic_leg", bodies, joints, markers)


def leg_swing() -> str:
    """OpenSim `.mot` of the model's coordinates [deg, m]: one swing of the leg in a second, the pelvis 1 m up."""
    time = np.arange(FRAMES) / RATE
    names = [name for *_, coordinates in JOINTS for name in coordinates]
    columns = {name: np.zeros(FRAMES) for name in names} | {"ty": np.full(FRAMES, 1.0)}
    for name, (mean, amplitude, phase) in SWING.items():
        columns[name] = mean + amplitude * np.sin(2.0 * np.pi * (time / time[-1] + phase))
    return motion_text("synthetic leg swing", time, columns)


def motion_text(name: str, time: np.ndarray, columns: Mapping[str, np.ndarray]) -> str:
    """OpenSim `.mot` of coordinates [deg, m]."""
    head = [name, "version=1", f"nRows={len(time)}", f"nColumns={len(columns) + 1}", "inDegrees=yes"]
    rows = [*head, "endheader", "\t".join(["time", *columns])]
    for k, t in enumerate(time):
        rows.append("\t".join([f"{t:.2f}", *(f"{values[k] + 0.0:.9f}" for values in columns.values())]))
    return "\n".join(rows) + "\n"


def body(name: str, mass: float, size: float = 1.0) -> str:
    """A body; `size` is that over the one whose mass is in its middle at y = -0.15 m."""
    inertia = " ".join(f"{round(share * mass * size**2, 12)}" for share in (0.02, 0.01, 0.015))
    return f"""<Body name="{name}"><mass>{mass}</mass><mass_center>0 {-0.15 * size:.9g} 0</mass_center>
<inertia>{inertia} 0 0 0</inertia></Body>"""


def joint(kind: str, name: str, parent: str, child: str, at: tuple[float, ...], coordinates: tuple[str, ...]) -> str:
    """A joint at a place of its parent, in the child's origin."""
    held = "".join(f'<Coordinate name="{c}"/>' for c in coordinates)
    return _joint(kind, name, parent, child, at, f"<coordinates>{held}</coordinates>")


def custom_joint(name: str, parent: str, child: str, coordinates: tuple[str, ...]) -> str:
    """A joint that turns about z by the first coordinate, and shifts along x, y and z of the parent by the others."""
    held = "".join(f'<Coordinate name="{c}"/>' for c in coordinates)
    rows = [("rotation1", coordinates[0], "0 0 1"), ("rotation2", "", "1 0 0"), ("rotation3", "", "0 1 0")]
    shifts = zip("123", coordinates[1:], ("1 0 0", "0 1 0", "0 0 1"), strict=True)
    rows += [(f"translation{k}", own, axis) for k, own, axis in shifts]
    axes = "\n".join(_axis(*each) for each in rows)
    inside = f"<coordinates>{held}</coordinates><SpatialTransform>\n{axes}\n</SpatialTransform>"
    return _joint("CustomJoint", name, parent, child, (0, 0, 0), inside)


def _axis(name: str, coordinate: str, axis: str) -> str:
    function = '<LinearFunction name="function"><coefficients>1 0</coefficients></LinearFunction>'
    if not coordinate:
        function = '<Constant name="function"><value>0</value></Constant>'
    return f"""<TransformAxis name="{name}"><coordinates>{coordinate}</coordinates><axis>{axis}</axis>
{function}</TransformAxis>"""


def _joint(kind: str, name: str, parent: str, child: str, at: tuple[float, ...], inside: str) -> str:
    path = "/ground" if parent == "ground" else f"/bodyset/{parent}"
    return f"""<{kind} name="{name}"><socket_parent_frame>{name}_in</socket_parent_frame>
<socket_child_frame>{name}_out</socket_child_frame>{inside}<frames>
<PhysicalOffsetFrame name="{name}_in"><socket_parent>{path}</socket_parent>
<translation>{" ".join(map(str, at))}</translation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="{name}_out"><socket_parent>/bodyset/{child}</socket_parent></PhysicalOffsetFrame>
</frames></{kind}>"""


def marker(of: str, k: int, size: float = 1.0) -> str:
    """One of the four markers of a body of that size."""
    place = " ".join(str(x if size == 1.0 else round(size * x, 9)) for x in PLACES[k])
    return f"""<Marker name="{of}{k}"><socket_parent_frame>/bodyset/{of}</socket_parent_frame>
<location>{place}</location></Marker>"""
