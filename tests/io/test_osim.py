"""Joints and meshes of OpenSim models against the opensim package, and against closed forms where it is absent."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from geocontact.data.errors import InputError
from geocontact.io.opensim.osim import JointModel, mesh_placement, mesh_placements, read_joint
from geocontact.io.opensim.osim_functions import piecewise_linear, simm_spline
from geocontact.io.opensim.osim_xml import read_model
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

BODY = "<mass>1</mass><inertia>1 1 1 0 0 0</inertia>"
FRAMES = """<frames>
 <PhysicalOffsetFrame name="p_offset"><socket_parent>/bodyset/p</socket_parent>
  <translation>0.1 -0.2 0.3</translation><orientation>0.4 -0.5 0.6</orientation></PhysicalOffsetFrame>
 <PhysicalOffsetFrame name="c_offset"><socket_parent>../c_inner</socket_parent>
  <translation>-0.3 0.1 0.2</translation><orientation>-0.2 0.3 0.1</orientation></PhysicalOffsetFrame>
 <PhysicalOffsetFrame name="c_inner"><socket_parent>../../../bodyset/c/c_fixed</socket_parent>
  <translation>0.05 0 0</translation><orientation>0 0.7 0</orientation></PhysicalOffsetFrame>
</frames>"""
C_FIXED = """<components><PhysicalOffsetFrame name="c_fixed"><socket_parent>..</socket_parent>
 <translation>0 0.02 0</translation><orientation>0.1 0 0</orientation>
 <attached_geometry><Mesh name="m"><socket_frame>..</socket_frame><scale_factors>1 2 3</scale_factors>
 <mesh_file>plate.stl</mesh_file></Mesh></attached_geometry></PhysicalOffsetFrame></components>
 <attached_geometry><Mesh name="n"><socket_frame>..</socket_frame><scale_factors>0.001 0.001 0.001</scale_factors>
 <mesh_file>tray.stl</mesh_file></Mesh></attached_geometry>"""


def model4(joint: str) -> str:
    """OpenSim 4: body p welded to ground, body c on the joint named j, offset frames of three levels between."""
    return f"""<?xml version="1.0" encoding="UTF-8"?><OpenSimDocument Version="40000"><Model name="mini">
    <Ground name="ground"/><BodySet name="bodyset"><objects><Body name="p">{BODY}</Body>
    <Body name="c">{C_FIXED}{BODY}</Body></objects></BodySet><JointSet name="jointset"><objects>
    <WeldJoint name="w"><socket_parent_frame>/ground</socket_parent_frame>
    <socket_child_frame>/bodyset/p</socket_child_frame></WeldJoint>{joint}</objects></JointSet></Model></OpenSimDocument>"""


def joint4(kind: str, inside: str, coordinates: Sequence[str]) -> str:
    listed = "".join(f'<Coordinate name="{c}"><default_value>0.25</default_value></Coordinate>' for c in coordinates)
    return f"""<{kind} name="j"><socket_parent_frame>p_offset</socket_parent_frame>
    <socket_child_frame>c_offset</socket_child_frame><coordinates>{listed}</coordinates>{FRAMES}{inside}</{kind}>"""


def model3(kind: str, inside: str, coordinates: Sequence[str], reverse: str, visible: str = "") -> str:
    """OpenSim 3: the same two bodies, joints inside the bodies."""
    listed = "".join(
        f'<Coordinate name="{c}"><default_value>0.25</default_value><range>-9 9</range></Coordinate>'
        for c in coordinates
    )
    body = "<mass>1</mass><mass_center>0 0 0</mass_center>" + "".join(
        f"<inertia_{ij}>{value}</inertia_{ij}>"
        for ij, value in zip(("xx", "yy", "zz", "xy", "xz", "yz"), (1, 1, 1, 0, 0, 0), strict=True)
    )
    weld = '<WeldJoint name="w"><parent_body>ground</parent_body></WeldJoint>'
    return f"""<?xml version="1.0" encoding="UTF-8"?><OpenSimDocument Version="30000"><Model name="mini">
    <BodySet><objects>
    <Body name="ground">{body}<Joint/></Body><Body name="p">{body}<Joint>{weld}</Joint></Body>
    <Body name="c">{body}<Joint><{kind} name="j"><parent_body>p</parent_body>
    <location_in_parent>0.1 -0.2 0.3</location_in_parent><orientation_in_parent>0.4 -0.5 0.6</orientation_in_parent>
    <location>-0.3 0.1 0.2</location><orientation>-0.2 0.3 0.1</orientation><reverse>{reverse}</reverse>
    <CoordinateSet><objects>{listed}</objects></CoordinateSet>{inside}</{kind}></Joint>{visible}</Body>
    </objects></BodySet></Model></OpenSimDocument>"""


FUNCTIONS = {
    "Constant": "<value>0.3</value>",
    "LinearFunction": "<coefficients>-1.5 0.2</coefficients>",
    "PolynomialFunction": "<coefficients>0.3 -0.2 0.5 0.1</coefficients>",
    "SimmSpline": "<x>-1 -0.4 0.1 0.5 1.2</x><y>0.2 -0.1 0.3 0.25 -0.4</y>",
    "PiecewiseLinearFunction": "<x>-1 -0.4 0.1 0.5 1.2</x><y>0.2 -0.1 0.3 0.25 -0.4</y>",
    "MultiplierFunction": "<function><SimmSpline><x>-1 0 1.5</x><y>0.2 -0.1 0.3</y></SimmSpline></function>"
    "<scale>1.7</scale>",
}
AXES = ("0 0 2", "1 1 0", "0 -1 0.2", "3 0 1", "0 1 0", "0.3 0.1 -1")
SLOTS = ("rotation1", "rotation2", "rotation3", "translation1", "translation2", "translation3")


def transform(wrapped: bool) -> str:
    """One of each function on six oblique axes of no unit length, written as OpenSim 3 or as OpenSim 4 does."""
    parts = []
    for slot, axis, (kind, inside) in zip(SLOTS, AXES, FUNCTIONS.items(), strict=True):
        function = (
            f"<function><{kind}>{inside}</{kind}></function>"
            if wrapped
            else f'<{kind} name="function">{inside}</{kind}>'
        )
        coordinate = "" if kind == "Constant" else "a" if slot < "rotation3" else "b"
        parts.append(
            f'<TransformAxis name="{slot}"><coordinates>{coordinate}</coordinates><axis>{axis}</axis>'
            f"{function}</TransformAxis>"
        )
    return f"<SpatialTransform>{''.join(parts)}</SpatialTransform>"


SIMPLE = {"PinJoint": 1, "SliderJoint": 1, "UniversalJoint": 2, "PlanarJoint": 3, "BallJoint": 3, "GimbalJoint": 3}
SIMPLE |= {"FreeJoint": 6, "WeldJoint": 0}
NAMES = ("a", "b", "d", "e", "f", "g")
MODELS = {f"4 {kind}": model4(joint4(kind, "", NAMES[:count])) for kind, count in SIMPLE.items()}
MODELS |= {
    f"3 {kind} {reverse}": model3(kind, "", NAMES[:count], reverse)
    for kind, count in SIMPLE.items()
    for reverse in ("false", "true")
}
MODELS |= {f"3 CustomJoint {r}": model3("CustomJoint", transform(True), ("a", "b"), r) for r in ("false", "true")}
MODELS |= {f"4 CustomJoint {w}": model4(joint4("CustomJoint", transform(w), ("a", "b"))) for w in (False, True)}
BARE = '<TransformAxis name="{slot}"><coordinates>a</coordinates><axis>0 3 4</axis>{function}</TransformAxis>'
MODELS |= {
    f"4 no function {slot} {bool(function)}": model4(
        joint4(
            "CustomJoint", f"<SpatialTransform>{BARE.format(slot=slot, function=function)}</SpatialTransform>", ("a",)
        )
    )
    for slot in ("rotation2", "translation1")
    for function in ("", "<function/>")
}


def written(folder: Path, text: str) -> Path:
    file = folder / "mini.osim"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize("text", MODELS.values(), ids=MODELS.keys())
def test_poses_agree_with_opensim(tmp_path: Path, opensim: Elsewhere, text: str) -> None:
    file = written(tmp_path, text)
    joint = read_joint(file, "j")
    names = [c.name for c in joint.coordinates]
    samples = np.random.default_rng(1).uniform(-2.5, 2.5, (7, len(names)))
    samples[0] = 0.25
    ours = joint.pose(dict(zip(names, samples.T, strict=True)), len(samples)).as_matrix()
    theirs = opensim(opensim_oracle.poses, file, names, samples, [(joint.child, joint.parent)])
    np.testing.assert_allclose(ours, theirs[:, 0], atol=1e-12)


@pytest.mark.parametrize("text", MODELS.values(), ids=MODELS.keys())
def test_kind_of_coordinates_agrees_with_opensim(tmp_path: Path, opensim: Elsewhere, text: str) -> None:
    file = written(tmp_path, text)
    ours = read_joint(file, "j").coordinates
    assert opensim(opensim_oracle.motion_types, file, [c.name for c in ours]) == [c.kind for c in ours]


def linear_axis(slot: str, axis: str, slope: float) -> str:
    function = f'<LinearFunction name="function"><coefficients>{slope} 0</coefficients></LinearFunction>'
    return f'<TransformAxis name="{slot}"><coordinates>a</coordinates><axis>{axis}</axis>{function}</TransformAxis>'


@pytest.mark.parametrize(
    ("axes", "kind"),
    [
        (linear_axis("rotation1", "1 0 0", -1), "rotational"),
        (linear_axis("rotation1", "1 0 0", 2), "coupled"),
        (linear_axis("translation1", "1 0 0", 1), "translational"),
        (linear_axis("rotation1", "1 0 0", 1) + linear_axis("translation1", "1 0 0", 1), "translational"),
    ],
)
def test_kind_of_linear_coordinates(tmp_path: Path, opensim: Elsewhere, axes: str, kind: str) -> None:
    file = written(tmp_path, model4(joint4("CustomJoint", f"<SpatialTransform>{axes}</SpatialTransform>", ("a",))))
    assert opensim(opensim_oracle.motion_types, file, ["a"]) == [kind]
    assert read_joint(file, "j").coordinates[0].kind == kind


def test_scopes_in_tags_are_read(tmp_path: Path) -> None:
    """OpenSim writes its contact forces so, which is not XML."""
    force = (
        '<ForceSet><objects><HuntCrossleyForce name="foot"><HuntCrossleyForce::ContactParametersSet><objects>'
        "<HuntCrossleyForce::ContactParameters><stiffness>2e6</stiffness></HuntCrossleyForce::ContactParameters>"
        "</objects></HuntCrossleyForce::ContactParametersSet></HuntCrossleyForce></objects></ForceSet>"
    )
    text = MODELS["4 PinJoint"]
    file = written(tmp_path, text.replace("</JointSet>", "</JointSet>" + force, 1))
    assert read_joint(file, "j").parent == "p"
    (found,) = read_model(file).iter("HuntCrossleyForce::ContactParameters")
    assert found.findtext("stiffness") == "2e6"


def pin(folder: Path) -> JointModel:
    return read_joint(written(folder, MODELS["3 PinJoint false"]), "j")


def test_pin_joint_without_the_oracle(tmp_path: Path) -> None:
    """Parent offset · Rz(q) · inverse child offset, written out with plain matrices."""

    def matrix(angles: list[float], shift: list[float]) -> np.ndarray:
        pose = np.eye(4)
        pose[:3, :3] = Rotation.from_euler("XYZ", angles).as_matrix()
        pose[:3, 3] = shift
        return pose

    q = 0.7
    expected = (
        matrix([0.4, -0.5, 0.6], [0.1, -0.2, 0.3])
        @ matrix([0, 0, q], [0, 0, 0])
        @ np.linalg.inv(matrix([-0.2, 0.3, 0.1], [-0.3, 0.1, 0.2]))
    )
    np.testing.assert_allclose(pin(tmp_path).pose({"a": np.array([q])}, 1).as_matrix()[0], expected, atol=1e-15)


def test_reverse_swaps_only_the_joint_motion(tmp_path: Path) -> None:
    plain = pin(tmp_path)
    turned = read_joint(written(tmp_path, MODELS["3 PinJoint true"]), "j")
    assert (plain.parent, plain.child, turned.parent, turned.child) == ("p", "c", "p", "c")
    q = np.array([0.3, -0.8])
    np.testing.assert_allclose(
        turned.pose({"a": q}, 2).as_matrix(), plain.pose({"a": -q}, 2).as_matrix(), atol=1e-15
    )  # a pin undoes itself by -q


def test_absent_coordinates_take_their_default(tmp_path: Path) -> None:
    joint = pin(tmp_path)
    assert joint.coordinates[0].default == 0.25
    np.testing.assert_array_equal(
        joint.pose({}, 2).as_matrix(), joint.pose({"a": np.array([0.25, 0.25])}, 2).as_matrix()
    )


def test_spline_reproduces_a_cubic_and_continues_straight() -> None:
    x = np.array([-1.0, -0.3, 0.2, 1.1, 2.0])
    cubic = np.polynomial.Polynomial([0.2, -0.7, 0.4, 0.9])
    spline = simm_spline(x, cubic(x))
    q = np.linspace(-1.0, 2.0, 50)
    np.testing.assert_allclose(spline(q[:, None]), cubic(q), atol=1e-12)
    outside = np.array([[-1.5], [2.7]])
    tangent = [cubic(-1.0) - 0.5 * cubic.deriv()(-1.0), cubic(2.0) + 0.7 * cubic.deriv()(2.0)]
    np.testing.assert_allclose(spline(outside), tangent, atol=1e-12)


def test_spline_of_three_points_is_their_parabola() -> None:
    x, y = np.array([0.0, 1.0, 3.0]), np.array([1.0, -2.0, 0.5])
    q = np.linspace(0.0, 3.0, 20)
    np.testing.assert_allclose(simm_spline(x, y)(q[:, None]), CubicSpline(x, y, bc_type="not-a-knot")(q), atol=1e-12)


def test_two_points_make_a_line() -> None:
    x, y = np.array([0.0, 2.0]), np.array([1.0, 5.0])
    for function in (simm_spline, piecewise_linear):
        np.testing.assert_allclose(function(x, y)(np.array([[-1.0], [1.0], [3.0]])), [-1.0, 3.0, 7.0], atol=1e-15)


VISIBLE = """<VisibleObject><GeometrySet><objects>
<DisplayGeometry><geometry_file>g.stl</geometry_file><transform>0.1 0.2 0.3 0.4 0.5 0.6</transform>
<scale_factors>1 2 3</scale_factors></DisplayGeometry>
<DisplayGeometry><geometry_file>h.stl</geometry_file></DisplayGeometry></objects></GeometrySet>
<scale_factors>2 3 4</scale_factors><transform>0.7 0.8 0.9 1 2 3</transform></VisibleObject>"""


def test_meshes_of_opensim_3_sit_where_its_conversion_puts_them(tmp_path: Path, opensim: Elsewhere) -> None:
    file = written(tmp_path, model3("PinJoint", "", ("a",), "false", VISIBLE))
    opensim(opensim_oracle.converted, file, tmp_path / "converted.osim")
    old, new = mesh_placements(file, "c"), mesh_placements(tmp_path / "converted.osim", "c")
    assert set(old) == set(new) == {"g.stl", "h.stl"}
    for name, affine in old.items():
        np.testing.assert_allclose(affine, new[name], atol=5e-5)  # OpenSim prints six digits here
    np.testing.assert_allclose(np.linalg.norm(old["g.stl"][:3, :3], axis=0), [2, 6, 12], rtol=1e-14)


def test_meshes_of_opensim_4_sit_in_the_frames_they_are_attached_to(tmp_path: Path) -> None:
    file = written(tmp_path, MODELS["4 PinJoint"])
    np.testing.assert_array_equal(mesh_placement(file, "c", "tray.stl"), np.diag([0.001, 0.001, 0.001, 1.0]))
    expected = np.eye(4)
    expected[:3, :3] = Rotation.from_euler("X", 0.1).as_matrix() @ np.diag([1, 2, 3])
    expected[:3, 3] = [0, 0.02, 0]
    np.testing.assert_allclose(mesh_placement(file, "c", "plate.stl"), expected, atol=1e-15)
    with pytest.raises(InputError, match=r"body 'c' has 2 meshes; name one of: tray\.stl, plate\.stl"):
        mesh_placement(file, "c")
    with pytest.raises(InputError, match=r"body 'c' has no mesh 'x\.stl'"):
        mesh_placement(file, "c", "x.stl")
    with pytest.raises(InputError, match="no body 'x'; bodies are: "):
        mesh_placement(file, "x")


PIN4 = MODELS["4 PinJoint"]
CUSTOM = MODELS["4 CustomJoint False"]
BAD = {
    "empty": ("", "the file is empty"),
    "truncated": (PIN4[:-40], "not a readable OpenSim model"),
    "html": ("<html><body/></html>", "root element is <html>, not an OpenSim model"),
    "other document": ("<OpenSimDocument/>", "not an OpenSim model"),
    "entity bomb": (
        '<!DOCTYPE x [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]><OpenSimDocument>&b;</OpenSimDocument>',
        "readable",
    ),
    "before 2.0": (PIN4.replace('Version="40000"', 'Version="10905"'), "version 10905, before OpenSim 2.0"),
    "other joint": (PIN4.replace('name="j"', 'name="knee_r"'), "no joint 'j'; joints are: w, knee_r"),
    "word for a number": (
        PIN4.replace("-0.5 0.6", "-0.5 abc"),
        "PhysicalOffsetFrame p_offset <orientation>: '0.4 -0.5 abc'",
    ),
    "two numbers": (
        PIN4.replace("0.1 -0.2 0.3", "0.1 -0.2"),
        "PhysicalOffsetFrame p_offset <translation>: '0.1 -0.2' where 3",
    ),
    "NaN": (PIN4.replace("0.25", "nan"), "Coordinate a <default_value>: 'nan' where 1 finite number"),
    "unknown frame": (
        PIN4.replace("/bodyset/p<", "/bodyset/q<"),
        "frame '/bodyset/q' of /jointset/j/p_offset is neither",
    ),
    "other kind of frame": (
        PIN4.replace("/bodyset/p<", "s<").replace("</Model>", '<x><StationDefinedFrame name="s"/></x></Model>'),
        "frame 's' of /jointset/j/p_offset is a StationDefinedFrame; bodies and PhysicalOffsetFrames are supported",
    ),
    "circle": (PIN4.replace("../../../bodyset/c/c_fixed", "../c_offset"), "refer to each other in a circle"),
    "no socket": (PIN4.replace("socket_child_frame", "socket_x"), "PinJoint j: no <socket_child_frame>"),
    "other kind of joint": (
        PIN4.replace("PinJoint", "EllipsoidJoint"),
        "this kind of joint is not supported; supported: Cu",
    ),
    "other kind of function": (
        CUSTOM.replace("SimmSpline", "GCVSpline"),
        "CustomJoint j translation1 GCVSpline function: this kind of function is not",
    ),
    "spline runs back": (
        CUSTOM.replace("-0.4 0.1 0.5", "-0.4 0.1 0.1"),
        "5 x and 5 y values; two or more points with incr",
    ),
    "spline of unequal length": (CUSTOM.replace("0.25 -0.4<", "0.25<"), "5 x and 4 y values"),
    "too many coefficients": (
        CUSTOM.replace("-1.5 0.2", "-1.5 0.2 1"),
        "LinearFunction function <coefficients>: '-1.5 0.2 1'",
    ),
    "axis of no length": (CUSTOM.replace("0 0 2", "0 0 0"), "TransformAxis rotation1 <axis>: an axis of length 0"),
    "unknown coordinate": (
        CUSTOM.replace('Coordinate name="b"', 'Coordinate name="z"'),
        "its transform uses b; coordinates are: a, z",
    ),
    "reverse": (
        MODELS["3 PinJoint true"].replace(">true<", ">maybe<"),
        "PinJoint j <reverse>: 'maybe' is neither true nor false",
    ),
    "no parent": (MODELS["3 PinJoint true"].replace("parent_body", "parent"), "PinJoint j: no <parent_body>"),
}


@pytest.mark.parametrize(("text", "message"), BAD.values(), ids=BAD.keys())
def test_bad_models_are_refused_with_their_place(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        read_joint(written(tmp_path, text), "j")
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_missing_model(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.osim: there is no such file"):
        read_joint(tmp_path / "none.osim", "j")
