"""Small synthetic models, one for each kind of joint, function and constraint that OpenSim has.

    python -m benchmarks.dynamics.opensim_variants FOLDER
    python -m benchmarks.dynamics.opensim_models FOLDER

The first writes them, the second compares them with OpenSim. A pelvis, a thigh and a shank; what varies is the hip, or
what the hip depends on. Frames are turned and away from their bodies' origins, products of inertia are not zero.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from meshes.leg_files import GRAVITY, PLACES

LINE = "<LinearFunction><coefficients>1 0</coefficients></LinearFunction>"
NOTHING = "<Constant><value>0</value></Constant>"
KNOTS = "<x>-1 -0.3 0.2 1</x><y>-0.5 -0.1 0.2 0.9</y>"
SPLINE = f"<SimmSpline>{KNOTS}</SimmSpline>"
FUNCTIONS = {
    "line": "<LinearFunction><coefficients>0.6 0.2</coefficients></LinearFunction>",
    "multiplier": f"<MultiplierFunction><function>{LINE}</function><scale>0.7</scale></MultiplierFunction>",
    "multiplied spline": f"<MultiplierFunction><function>{SPLINE}</function><scale>0.7</scale></MultiplierFunction>",
    "piecewise": "<PiecewiseLinearFunction><x>-1 0 1</x><y>-0.5 0.1 0.9</y></PiecewiseLinearFunction>",
    "polynomial": "<PolynomialFunction><coefficients>0.2 -0.3 1 0.05</coefficients></PolynomialFunction>",
    "natural spline": f"<NaturalCubicSpline>{KNOTS}</NaturalCubicSpline>",
    "spline of two": "<SimmSpline><x>-1 1</x><y>-0.5 0.9</y></SimmSpline>",
    "spline of three": "<SimmSpline><x>-1 0.1 1</x><y>-0.5 0.3 0.9</y></SimmSpline>",
    "sine": "<Sine><amplitude>0.4</amplitude><omega>1.3</omega><phase>0.2</phase><offset>0.1</offset></Sine>",
    "step": "<StepFunction><start_time>-0.5</start_time><end_time>0.5</end_time></StepFunction>",
    "GCV spline": f"<GCVSpline><half_order>3</half_order>{KNOTS}<weights>1 1 1 1</weights></GCVSpline>",
}
JOINTS = {"GimbalJoint": 3, "BallJoint": 3, "UniversalJoint": 2, "PlanarJoint": 3, "SliderJoint": 1, "PinJoint": 1}
"""And how many coordinates they have."""
ELLIPSOID = "<radii_x_y_z>0.1 0.2 0.15</radii_x_y_z>"
HELD = {
    "locked": "<default_value>0.25</default_value><locked>true</locked>",
    "clamped": "<clamped>true</clamped>",
    "prescribed": f"<prescribed_function>{NOTHING}</prescribed_function><prescribed>true</prescribed>",
}
LIMIT = """<ForceSet><objects><CoordinateLimitForce name="stop"><coordinate>knee</coordinate>
<upper_limit>20</upper_limit><upper_stiffness>2</upper_stiffness><lower_limit>-10</lower_limit><lower_stiffness>3</lower_stiffness>
<damping>0.1</damping><transition>5</transition></CoordinateLimitForce></objects></ForceSet>"""
ENDS = "<socket_frame1>/bodyset/pelvis</socket_frame1><socket_frame2>/bodyset/tibia</socket_frame2>"
AXES = ("1 0 0", "0 1 0", "0 0 1")


def main() -> None:
    """Write the models."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.dynamics.opensim_variants", description=__doc__.splitlines()[0]
    )
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    count = 0
    for name, text in variants():
        (folder / f"{name.replace(' ', '_')}.osim").write_text(text, encoding="utf-8")
        count += 1
    print(f"{count} models in {folder}")


def variants() -> Iterator[tuple[str, str]]:
    """Name and text of each."""
    for kind, count in JOINTS.items():
        yield kind, model(joint(kind, "hip", "pelvis", "femur", names(count)))
    yield "WeldJoint", model(joint("WeldJoint", "hip", "pelvis", "femur", {}))
    yield "EllipsoidJoint", model(joint("EllipsoidJoint", "hip", "pelvis", "femur", names(3), ELLIPSOID))
    yield "reversed", model(joint("PinJoint", "hip", "femur", "pelvis", names(1)))
    gimbal = joint("GimbalJoint", "hip", "pelvis", "femur", names(3))
    for name, function in FUNCTIONS.items():
        yield f"turned by {name}", model(custom({"h1": ""}, (("h1", function),), ()))
        yield f"shifted by {name}", model(custom({"h1": ""}, (("h1", LINE),), (("h1", function),)))
        yield f"coupled by {name}", model(gimbal, coupler(function, "knee"))
    both = "<LinearFunction><coefficients>0.3 0.5 0.1</coefficients></LinearFunction>"
    yield "coupled to two", model(gimbal, coupler(both, "knee h2"))
    yield (
        "shifted for good",
        model(custom({"h1": ""}, (("h1", LINE),), (("", "<Constant><value>0.05</value></Constant>"),))),
    )
    for name, text in HELD.items():
        yield name, model(joint("GimbalJoint", "hip", "pelvis", "femur", {**names(3), "h1": text}))
    yield "gravity along z", model(gimbal, gravity="0 0 -9.81")
    yield "no gravity", model(gimbal, gravity="0 0 0")
    yield "limit force", model(gimbal, sets=LIMIT)
    yield "WeldConstraint", model(gimbal, f'<WeldConstraint name="w">{ENDS}</WeldConstraint>')
    spot = '<PhysicalOffsetFrame name="spot"><socket_parent>..</socket_parent><translation>0 -0.4 0.02</translation>'
    inside = (
        f'<Body name="femur"><components>{spot}<orientation>0 0.2 0</orientation></PhysicalOffsetFrame></components>'
    )
    text = model(gimbal).replace('<Body name="femur">', inside)
    bodies, joints = (text_of_set(model(gimbal), name) for name in ("BodySet", "JointSet"))
    loose = model(gimbal).replace(bodies, f"<components>{objects(bodies)}{objects(joints)}</components>")
    yield "in components", loose.replace(joints, "").replace("/bodyset/", "/")
    yield "frame on a frame", text.replace("/bodyset/femur</socket_parent>", "/bodyset/femur/spot</socket_parent>")


def text_of_set(text: str, name: str) -> str:
    return text[text.index(f"<{name}>") : text.index(f"</{name}>")] + f"</{name}>"


def objects(text: str) -> str:
    """What a set holds."""
    return text.partition("<objects>")[2].rpartition("</objects>")[0]


def names(count: int) -> dict[str, str]:
    """Coordinates of the hip, and what more is said of each."""
    return {f"h{k + 1}": "" for k in range(count)}


def model(hip: str, constraints: str = "", gravity: str = f"0 -{GRAVITY} 0", sets: str = "") -> str:
    """The whole model around a hip."""
    bodies = "".join(body(name, mass) for name, mass in {"pelvis": 10.0, "femur": 8.0, "tibia": 4.0}.items())
    free = dict.fromkeys(("tilt", "list", "turn", "tx", "ty", "tz"), "")
    moved = [(name, LINE) for name in free]
    base = joint("CustomJoint", "base", "ground", "pelvis", free, transform(moved[:3], moved[3:]))
    knee = joint("PinJoint", "knee", "femur", "tibia", {"knee": ""})
    held = f"<ConstraintSet><objects>{constraints}</objects></ConstraintSet>" if constraints else ""
    markers = "".join(
        f'<Marker name="{name}{k}"><socket_parent_frame>/bodyset/{name}</socket_parent_frame>'
        f"<location>{' '.join(map(str, place))}</location></Marker>"
        for name in ("pelvis", "femur", "tibia")
        for k, place in enumerate(PLACES)
    )
    return f"""<?xml version="1.0"?>
<OpenSimDocument Version="40000"><Model name="synthetic"><gravity>{gravity}</gravity><Ground name="ground"/>
<BodySet><objects>{bodies}</objects></BodySet><JointSet><objects>{base}{hip}{knee}</objects></JointSet>{held}{sets}
<MarkerSet><objects>{markers}</objects></MarkerSet></Model></OpenSimDocument>
"""


def body(name: str, mass: float) -> str:
    inertia = f"{0.02 * mass} {0.01 * mass} {0.015 * mass} 0.001 -0.002 0.0005"
    return (
        f'<Body name="{name}"><mass>{mass}</mass><mass_center>0.01 -0.15 0.02</mass_center>'
        f"<inertia>{inertia}</inertia></Body>"
    )


def joint(kind: str, name: str, parent: str, child: str, coordinates: dict[str, str], more: str = "") -> str:
    """A joint between turned frames; `more` is what its kind needs besides."""
    path = "/ground" if parent == "ground" else f"/bodyset/{parent}"
    held = "".join(
        f'<Coordinate name="{c}"><range>-0.7 0.7</range>{text}</Coordinate>' for c, text in coordinates.items()
    )
    return f"""<{kind} name="{name}"><socket_parent_frame>{name}_in</socket_parent_frame>
<socket_child_frame>{name}_out</socket_child_frame><coordinates>{held}</coordinates><frames>
<PhysicalOffsetFrame name="{name}_in"><socket_parent>{path}</socket_parent><translation>0 -0.4 0.02</translation>
<orientation>0.1 -0.2 0.3</orientation></PhysicalOffsetFrame><PhysicalOffsetFrame name="{name}_out">
<socket_parent>/bodyset/{child}</socket_parent><translation>0.01 0.02 -0.01</translation>
<orientation>0 0.2 0.1</orientation></PhysicalOffsetFrame></frames>{more}</{kind}>"""


def custom(coordinates: dict[str, str], turns: tuple[tuple[str, str], ...], shifts: tuple[tuple[str, str], ...]) -> str:
    """A hip whose turns and shifts are functions of coordinates, by coordinate and function."""
    return joint("CustomJoint", "hip", "pelvis", "femur", coordinates, transform(list(turns), list(shifts)))


def transform(turns: list[tuple[str, str]], shifts: list[tuple[str, str]]) -> str:
    none = ("", NOTHING)
    parts = []
    for kind, told in (("rotation", turns), ("translation", shifts)):
        for k, (coordinate, function) in enumerate([*told, none, none, none][:3]):
            axis = AXES[(k + 2) % 3] if kind == "rotation" else AXES[k]
            parts.append(
                f'<TransformAxis name="{kind}{k + 1}"><coordinates>{coordinate}</coordinates>'
                f"<axis>{axis}</axis>{function}</TransformAxis>"
            )
    return f"<SpatialTransform>{''.join(parts)}</SpatialTransform>"


def coupler(function: str, independent: str) -> str:
    """The hip's first coordinate as a function of others."""
    return f"""<CoordinateCouplerConstraint name="c"><coupled_coordinates_function>{function}
</coupled_coordinates_function><independent_coordinate_names>{independent}</independent_coordinate_names>
<dependent_coordinate_name>h1</dependent_coordinate_name></CoordinateCouplerConstraint>"""


if __name__ == "__main__":
    main()
