"""Points of paths and of bushings are scaled along the axes of their body, as OpenSim does it; what stays is told."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputWarning
from geocontact.dynamics.scaling import scaled
from geocontact.io.opensim.osim_functions import read_function
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.osim_scaler import write_scaled_model
from geocontact.io.opensim.osim_xml import numbers_of, read_model
from tests.cli.calls import MESHES

SPLINE = "<SimmSpline{name}><x>-1 0 1 2</x><y>{y}</y></SimmSpline>"
PLACES = {"x_location": "0.1 0.2 0.15 0.3", "y_location": "1 2 3 5", "z_location": "0 1 4 9"}
FACTORS = np.array([1.1, 0.9, 1.0])


@pytest.mark.parametrize("inside", [True, False], ids=["OpenSim 3", "OpenSim 4"])
def test_moving_path_points_are_scaled(tmp_path: Path, inside: bool) -> None:
    """By a function times the factor; the axis whose factor is 1 is left alone."""
    leg = read_multibody(MESHES / "leg.osim")
    body = leg.bodies[0].name
    places = "".join(
        f"<{name}>{SPLINE.format(name='', y=y)}</{name}>" if inside else SPLINE.format(name=f' name="{name}"', y=y)
        for name, y in PLACES.items()
    )
    owner = f"<body>{body}</body>" if inside else f"<socket_parent_frame>/bodyset/{body}</socket_parent_frame>"
    point = f'<ForceSet><objects><MovingPathPoint name="p">{owner}{places}</MovingPathPoint></objects></ForceSet>'
    source = tmp_path / "leg.osim"
    text = (MESHES / "leg.osim").read_text(encoding="utf-8").replace("</JointSet>", "</JointSet>" + point)
    source.write_text(text, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        other = scaled(leg, {body: FACTORS}, sum(each.mass for each in leg.bodies))
        write_scaled_model(source, tmp_path / "out.osim", other, {body: FACTORS})
    functions = {}
    for file in (source, tmp_path / "out.osim"):
        (found,) = read_model(file).iter("MovingPathPoint")
        for name in PLACES:
            nested = found.find(name)
            own = next(iter(nested)) if nested is not None else next(e for e in found if e.get("name") == name)
            functions[file.name, name] = read_function(str(file), own, 1)
    q = np.linspace(-1.5, 2.5, 9)[:, None]
    for name, factor in zip(PLACES, FACTORS, strict=True):
        before, after = (functions[file, name](q) for file in ("leg.osim", "out.osim"))
        np.testing.assert_allclose(after, factor * before, rtol=1e-12)
        assert np.ptp(before) > 0.1


THINGS = """<ForceSet name="forceset"><objects>
<PathActuator name="pull"><GeometryPath name="path"><PathPointSet><objects>
<PathPoint name="p"><socket_parent_frame>/jointset/ankle_r/ankle_r_in</socket_parent_frame>
<location>0.1 0.1 0.1</location></PathPoint></objects></PathPointSet></GeometryPath></PathActuator>
<FunctionBasedBushingForce name="between"><frames><PhysicalOffsetFrame name="side"><socket_parent>/bodyset/tibia_r/inner
</socket_parent><translation>0.1 0.1 0.1</translation></PhysicalOffsetFrame></frames></FunctionBasedBushingForce>
<BushingForce name="pad"><body_1>pelvis</body_1><body_2>tibia_r</body_2><location_body_2>0.1 0.1 0.1</location_body_2>
</BushingForce></objects></ForceSet><ContactGeometrySet name="cg"><objects><ContactSphere name="heel">
<socket_frame>/bodyset/tibia_r</socket_frame><location>0 0 0</location><radius>0.03</radius></ContactSphere></objects>
</ContactGeometrySet>"""
FRAME = """<PhysicalOffsetFrame name="{}"><socket_parent>{}</socket_parent><translation>0.1 0.1 0.1</translation>
<orientation>0 0 0.5</orientation>{}</PhysicalOffsetFrame>"""
BALL = "<attached_geometry><Sphere><scale_factors>1 1 1</scale_factors></Sphere></attached_geometry>"
INSIDE = f"<components>{FRAME.format('outer', '..', BALL)}{FRAME.format('inner', '../outer', '')}</components>"
WRAP = """<WrapObjectSet><objects><WrapCylinder name="w"><translation>0 0 0</translation></WrapCylinder></objects>
</WrapObjectSet>"""


def test_what_hangs_on_frames_of_bodies_is_scaled_and_what_stays_is_told(tmp_path: Path) -> None:
    """Places as OpenSim 4.6 scales them: by the body that a point's frame is fixed to, along the frame's axes."""
    source = tmp_path / "leg.osim"
    text = (MESHES / "leg.osim").read_text(encoding="utf-8").replace("</JointSet>", "</JointSet>" + THINGS)
    source.write_text(text.replace('<Body name="tibia_r">', '<Body name="tibia_r">' + WRAP + INSIDE), encoding="utf-8")
    factors = {"tibia_r": FACTORS}
    with pytest.warns(InputWarning, match="not scaled: wrapping surfaces, contact geometry"):
        write_scaled_model(source, tmp_path / "out.osim", scaled(read_multibody(source), factors), factors)
    model = read_model(tmp_path / "out.osim")
    names = {e.get("name"): e for e in model.iter() if e.get("name") in ("outer", "inner", "side")}
    for name, child in (("outer", "translation"), ("inner", "translation"), ("side", "translation")):
        np.testing.assert_allclose(numbers_of("", names[name], child, 3), 0.1 * FACTORS, rtol=1e-12, err_msg=name)
    (ball,) = model.iter("Sphere")
    np.testing.assert_allclose(numbers_of("", ball, "scale_factors", 3), FACTORS, rtol=1e-12)
    for kind, child in (("PathPoint", "location"), ("BushingForce", "location_body_2")):
        (found,) = model.iter(kind)
        np.testing.assert_allclose(numbers_of("", found, child, 3), 0.1 * FACTORS, rtol=1e-12)


def test_shifts_of_joints_of_one_name_scale_with_their_own_bodies(tmp_path: Path) -> None:
    """A knee and an ankle that both are called `ankle_r`."""
    shift = (
        "<TransformAxis name='translation1'><axis>1 0 0</axis><Constant><value>0.1</value></Constant></TransformAxis>"
    )
    text = (
        (MESHES / "leg.osim")
        .read_text(encoding="utf-8")
        .replace("PinJoint", "CustomJoint")
        .replace("knee_r", "ankle_r")
    )
    text = text.replace("</CustomJoint>", f"<SpatialTransform>{shift}</SpatialTransform></CustomJoint>")
    (tmp_path / "leg.osim").write_text(text, encoding="utf-8")
    leg = read_multibody(tmp_path / "leg.osim")
    factors = {"femur_r": FACTORS, "tibia_r": np.array([2.0, 1.0, 1.0])}
    write_scaled_model(tmp_path / "leg.osim", tmp_path / "out.osim", scaled(leg, factors), factors)
    joints = {joint.child: joint for joint in read_multibody(tmp_path / "out.osim").joints}
    shifts = {child: float(joints[child].axes[3].function(np.zeros((1, 0)))[0]) for child in ("tibia_r", "foot_r")}
    assert shifts == {"tibia_r": pytest.approx(0.11), "foot_r": pytest.approx(0.2)}
