"""A synthetic whole body with the joints of OpenSim's widely used gait models, whose files are not in this project.

39 coordinates: a free pelvis, hips of three, knees whose shift follows the angle, patellae coupled to them, ankles of
oblique axes, subtalar and toe joints, a back and shoulders of three, elbows, forearms that turn, wrists of two. No
marker is on hands, toes and patellae, so what turns them alone is told by none. All lengths, masses and functions are
invented.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

Axis = tuple[str, tuple[float, float, float]]
"""Coordinate and the axis that it turns about."""

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
SPLINE = "<SimmSpline><x>-2 -1.2 -0.6 0 0.3</x><y>{}</y></SimmSpline>"
COUPLED = "<SimmSpline><x>-2.1 -1.4 -0.7 0 0.2</x><y>-1.7 -1.1 -0.5 0 0.12</y></SimmSpline>"
MASSES = {
    "pelvis": 11.8, "torso": 26.8, "femur": 9.3, "patella": 0.09, "tibia": 3.7, "talus": 0.1, "calcn": 1.25,
    "toes": 0.22, "humerus": 2.0, "ulna": 0.6, "radius": 0.6, "hand": 0.46,
}  # fmt: skip
MARKERS = {
    "pelvis": ((0.02, 0.03, 0.13), (0.02, 0.03, -0.13), (-0.15, 0.04, 0.05), (-0.15, 0.04, -0.05)),
    "torso": ((0.02, 0.4, 0.17), (0.02, 0.4, -0.17), (0.1, 0.3, 0.0), (-0.1, 0.35, 0.0)),
    "femur": ((0.01, -0.15, 0.09), (0.09, -0.22, 0.04), (0.01, -0.4, 0.06), (0.01, -0.4, -0.06)),
    "tibia": ((0.03, -0.12, 0.06), (0.06, -0.2, 0.0), (0.0, -0.4, 0.05), (0.0, -0.38, -0.05)),
    "calcn": ((-0.02, 0.02, 0.0), (0.15, 0.03, -0.04), (0.14, 0.02, 0.06)),
    "humerus": ((0.04, -0.1, 0.03), (0.0, -0.28, 0.05), (0.0, -0.28, -0.04)),
    "radius": ((0.03, -0.1, 0.0), (0.0, -0.22, 0.04), (0.0, -0.22, -0.03)),
}
"""Of the right side [m]; the left one's z is turned about."""


def write_full_body(file: Path) -> Path:
    """The model, of OpenSim 4: x forward, y up, z to the right."""
    bodies, joints, markers = ("\n".join(part) for part in (_bodies(), _joints(), _markers()))
    couplers = "\n".join(_coupler(side) for side in "rl")
    file.write_text(
        f"""<?xml version="1.0"?>
<OpenSimDocument Version="40000"><Model name="synthetic_full_body">
<gravity>0 -9.80665 0</gravity><Ground name="ground"/><BodySet><objects>
{bodies}
</objects></BodySet><JointSet><objects>
{joints}
</objects></JointSet><ConstraintSet><objects>
{couplers}
</objects></ConstraintSet><MarkerSet><objects>
{markers}
</objects></MarkerSet></Model></OpenSimDocument>
""",
        encoding="utf-8",
    )
    return file


def _sides(body: str) -> tuple[tuple[str, int], ...]:
    return ((body, 1),) if body in ("pelvis", "torso") else ((f"{body}_r", 1), (f"{body}_l", -1))


def _bodies() -> Iterator[str]:
    for body, mass in MASSES.items():
        for name, _ in _sides(body):
            low = {"torso": 0.3, "pelvis": 0.0}.get(body, -0.1)
            inertia = f"{0.02 * mass:.6g} {0.012 * mass:.6g} {0.02 * mass:.6g} 0 0 0"
            yield (
                f'<Body name="{name}"><mass>{mass}</mass><mass_center>0 {low} 0</mass_center>'
                f"<inertia>{inertia}</inertia></Body>"
            )


def _markers() -> Iterator[str]:
    for body, places in MARKERS.items():
        for name, sign in _sides(body):
            for k, (x, y, z) in enumerate(places):
                yield (
                    f'<Marker name="{name}.{k}"><socket_parent_frame>/bodyset/{name}</socket_parent_frame>'
                    f"<location>{x} {y} {sign * z}</location></Marker>"
                )


def _joints() -> Iterator[str]:
    turns: list[Axis] = [("pelvis_tilt", Z), ("pelvis_list", X), ("pelvis_rotation", Y)]
    shifts = ["<LinearFunction><coefficients>1 0</coefficients></LinearFunction>"] * 3
    moved = ["pelvis_tx", "pelvis_ty", "pelvis_tz"]
    yield _joint("ground_pelvis", "ground", "pelvis", (0.0, 0.0, 0.0), turns, list(zip(moved, shifts, strict=True)))
    back: list[Axis] = [("lumbar_extension", Z), ("lumbar_bending", X), ("lumbar_rotation", Y)]
    yield _joint("back", "pelvis", "torso", (-0.1, 0.08, 0.0), back)
    for side, s in (("r", 1.0), ("l", -1.0)):
        yield from _leg(side, s)
        yield from _arm(side, s)


def _leg(side: str, s: float) -> Iterator[str]:
    hip: list[Axis] = [
        (f"hip_flexion_{side}", Z), (f"hip_adduction_{side}", (s, 0.0, 0.0)), (f"hip_rotation_{side}", (0.0, s, 0.0)),
    ]  # fmt: skip
    yield _joint(f"hip_{side}", "pelvis", f"femur_{side}", (-0.06, -0.08, 0.08 * s), hip)
    knee = f"knee_angle_{side}"
    rolls = [(knee, SPLINE.format("-0.03 -0.015 0 0.004 0.003")), (knee, SPLINE.format("0.42 0.41 0.404 0.4 0.399"))]
    down = [(name, text.replace("0.4", "-0.4")) for name, text in rolls]
    yield _joint(f"knee_{side}", f"femur_{side}", f"tibia_{side}", (0.0, 0.0, 0.0), [(knee, Z)], down)
    beta = f"knee_angle_{side}_beta"
    path = [(beta, SPLINE.format("-0.02 0.01 0.04 0.05 0.05")), (beta, SPLINE.format("-0.43 -0.42 -0.39 -0.37 -0.36"))]
    yield _joint(f"patella_{side}", f"femur_{side}", f"patella_{side}", (0.0, 0.0, 0.0), [(beta, Z)], path)
    ankle: list[Axis] = [(f"ankle_angle_{side}", (-0.105 * s, -0.174 * s, 0.979))]
    yield _joint(f"ankle_{side}", f"tibia_{side}", f"talus_{side}", (-0.01, -0.4, 0.0), ankle)
    subtalar: list[Axis] = [(f"subtalar_angle_{side}", (0.787 * s, 0.605 * s, -0.121))]
    yield _joint(f"subtalar_{side}", f"talus_{side}", f"calcn_{side}", (-0.044, -0.042, 0.008 * s), subtalar)
    toes: list[Axis] = [(f"mtp_angle_{side}", (-0.581 * s, 0.0, 0.814))]
    yield _joint(f"mtp_{side}", f"calcn_{side}", f"toes_{side}", (0.18, -0.002, 0.001 * s), toes)


def _arm(side: str, s: float) -> Iterator[str]:
    shoulder: list[Axis] = [
        (f"arm_flex_{side}", Z), (f"arm_add_{side}", (s, 0.0, 0.0)), (f"arm_rot_{side}", (0.0, s, 0.0)),
    ]  # fmt: skip
    yield _joint(f"acromial_{side}", "torso", f"humerus_{side}", (0.003, 0.37, 0.17 * s), shoulder)
    elbow: list[Axis] = [(f"elbow_flex_{side}", (0.227 * s, 0.018 * s, 0.974))]
    yield _joint(f"elbow_{side}", f"humerus_{side}", f"ulna_{side}", (0.013, -0.286, -0.01 * s), elbow)
    turn: list[Axis] = [(f"pro_sup_{side}", (0.056 * s, 0.998 * s, 0.02))]
    yield _joint(f"radioulnar_{side}", f"ulna_{side}", f"radius_{side}", (-0.007, -0.013, 0.026 * s), turn)
    wrist: list[Axis] = [(f"wrist_flex_{side}", Z), (f"wrist_dev_{side}", (s, 0.0, 0.0))]
    yield _joint(f"radius_hand_{side}", f"radius_{side}", f"hand_{side}", (-0.009, -0.236, 0.014 * s), wrist)


def _joint(
    name: str,
    parent: str,
    child: str,
    at: tuple[float, float, float],
    turns: list[Axis],
    shifts: list[tuple[str, str]] | None = None,
) -> str:
    """A CustomJoint: turns in this order, then shifts along x, y and z as functions of coordinates."""
    line = "<LinearFunction><coefficients>1 0</coefficients></LinearFunction>"
    axes = [_axis(f"rotation{k + 1}", axis, coordinate, line) for k, (coordinate, axis) in enumerate(turns)]
    spare = [axis for axis in (X, Y, Z) if axis not in [each for _, each in turns]]
    axes += [_axis(f"rotation{k + 1}", spare.pop(), "", "") for k in range(len(turns), 3)]
    told = shifts or []
    for k, axis in enumerate((X, Y, Z)):
        coordinate, text = told[k] if k < len(told) else ("", "")
        axes.append(_axis(f"translation{k + 1}", axis, coordinate, text))
    names = dict.fromkeys([*(c for c, _ in turns), *(c for c, _ in told)])
    coordinates = "".join(f'<Coordinate name="{c}"><range>-0.6 0.6</range></Coordinate>' for c in names)
    path = "/ground" if parent == "ground" else f"/bodyset/{parent}"
    return f"""<CustomJoint name="{name}"><socket_parent_frame>{name}_in</socket_parent_frame>
<socket_child_frame>{name}_out</socket_child_frame><coordinates>{coordinates}</coordinates><frames>
<PhysicalOffsetFrame name="{name}_in"><socket_parent>{path}</socket_parent>
<translation>{" ".join(map(str, at))}</translation></PhysicalOffsetFrame>
<PhysicalOffsetFrame name="{name}_out"><socket_parent>/bodyset/{child}</socket_parent></PhysicalOffsetFrame>
</frames><SpatialTransform>{"".join(axes)}</SpatialTransform></CustomJoint>"""


def _axis(slot: str, axis: tuple[float, float, float], coordinate: str, function: str) -> str:
    text = function or "<Constant><value>0</value></Constant>"
    told = f"<coordinates>{coordinate}</coordinates>" if coordinate else "<coordinates/>"
    return f'<TransformAxis name="{slot}">{told}<axis>{" ".join(map(str, axis))}</axis>{text}</TransformAxis>'


def _coupler(side: str) -> str:
    return f"""<CoordinateCouplerConstraint name="patellofemoral_{side}"><coupled_coordinates_function>{COUPLED}
</coupled_coordinates_function><independent_coordinate_names>knee_angle_{side}</independent_coordinate_names>
<dependent_coordinate_name>knee_angle_{side}_beta</dependent_coordinate_name></CoordinateCouplerConstraint>"""
