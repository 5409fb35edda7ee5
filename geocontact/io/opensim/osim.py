"""Joints of OpenSim models: the pose of the child body in the parent body as a function of coordinates.

Both dialects: OpenSim 4 (JointSet, sockets, offset frames) and OpenSim 3 (Joint inside Body, `reverse`).

Seth et al. (2016), A biomechanical model of the scapulothoracic joint, PLoS ONE 11(1):e0141028; OpenSim 4.6,
ScapulothoracicJoint.cpp; Simbody 3.8, RigidBodyNodeSpec_Ellipsoid.h. Two joints with a body without mass between: three
body-fixed turns x, y, z whose frame's origin is the turned z, a point of the unit sphere, times the radii; then a pin.
The ellipsoid's normal there is not the turned z, but for a sphere.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from os import PathLike, fspath
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.joint import (
    Affine,
    Coordinate,
    JointFunction,
    JointModel,
    Kind,
    SineProduct,
    TransformAxis,
)
from geocontact.io.opensim.osim_functions import constant, function_of, linear
from geocontact.io.opensim.osim_meshes import mesh_placement, mesh_placements
from geocontact.io.opensim.osim_xml import Frames, is_true, label, numbers_of, offset, read_model, socket_of, text_of
from geocontact.io.text.tables import listed

TAG = "ScapulothoracicJoint"
QUARTER = RigidTransform.from_rotation(Rotation.from_rotvec([0.0, 0.0, 0.5 * np.pi]))
"""The ellipsoid's frame stands a quarter turn about z from the joint's: abduction and elevation are positive so."""
_STILL, _ITSELF = Affine(np.zeros(0), 0.0), Affine(np.ones(1), 0.0)
_COSINE = 0.5 * np.pi


def between(name: str) -> str:
    """Name of the body without mass."""
    return f"{name}_on_ellipsoid"


def scapulothoracic(
    joint: JointModel, radii: Float[np.ndarray, " 3"], origin: Float[np.ndarray, " 2"], direction: float
) -> tuple[JointModel, JointModel]:
    """Both joints.

    Parameters
    ----------
    joint
        Bodies, offsets and the four coordinates abduction, elevation, upward rotation, winging; its axes do not matter.
    radii
        Of the ellipsoid along x, y, z of the joint's frame on the thorax [m].
    origin
        Of the winging axis in the scapula's plane, x and y of the gliding frame [m].
    direction
        Of that axis, from y towards -x [rad].
    """
    first, second, third, fourth = joint.coordinates
    semi = np.array([radii[1], radii[0], radii[2]])  # of the frame a quarter turn away
    about = np.array([-np.sin(direction), np.cos(direction), 0.0])
    axis = RigidTransform.from_translation([*origin, 0.0])
    middle = between(joint.name)
    return (
        replace(
            joint,
            child=middle,
            coordinates=(first, second, third),
            axes=_glide((first.name, second.name, third.name), semi),
            parent_offset=joint.parent_offset * QUARTER,
            child_offset=QUARTER,
        ),
        replace(
            joint,
            name=f"{joint.name}_winging",
            parent=middle,
            coordinates=(fourth,),
            axes=_pin(fourth.name, about),
            parent_offset=axis,
            child_offset=joint.child_offset * axis,
        ),
    )


def _glide(names: tuple[str, str, str], semi: Float[np.ndarray, " 3"]) -> tuple[TransformAxis, ...]:
    """Turns about x, y, z, and the shift by the turned z times `semi`."""
    turns = (TransformAxis(each, (name,), _ITSELF) for each, name in zip(np.eye(3), names, strict=True))
    x, y, z = np.eye(3)
    return (
        *turns,
        TransformAxis(x, names[1:2], SineProduct(float(semi[0]), (0.0,))),
        TransformAxis(y, names[:2], SineProduct(-float(semi[1]), (0.0, _COSINE))),
        TransformAxis(z, names[:2], SineProduct(float(semi[2]), (_COSINE, _COSINE))),
    )


def _pin(name: str, about: Float[np.ndarray, " 3"]) -> tuple[TransformAxis, ...]:
    still = [TransformAxis(each, (), _STILL) for each in (*np.eye(3), *np.eye(3))]
    return (TransformAxis(about, (name,), _ITSELF), *still[1:])


__all__ = ["Coordinate", "JointModel", "TransformAxis", "joints_of", "mesh_placement", "mesh_placements", "read_joint"]

GROUND = "ground"

_AXES = ("rotation1", "rotation2", "rotation3", "translation1", "translation2", "translation3")
_X, _Y, _Z = np.eye(3)
_SIMPLE: dict[str, tuple[tuple[int, Float[np.ndarray, " 3"]], ...]] = {
    # Slot among `_AXES` and direction of each coordinate in turn; OpenSim 4.6 API, the classes of these names.
    "WeldJoint": (),
    "PinJoint": ((0, _Z),),
    "SliderJoint": ((3, _X),),
    "UniversalJoint": ((0, _X), (1, _Y)),
    "PlanarJoint": ((0, _Z), (3, _X), (4, _Y)),
    "BallJoint": ((0, _X), (1, _Y), (2, _Z)),
    "GimbalJoint": ((0, _X), (1, _Y), (2, _Z)),
    "FreeJoint": ((0, _X), (1, _Y), (2, _Z), (3, _X), (4, _Y), (5, _Z)),
}


def read_joint(path: str | PathLike[str], joint_name: str) -> JointModel:
    """A joint of an .osim file by name; InputError lists the joints there are when the name is not among them."""
    file = fspath(path)
    model = read_model(path)
    joints = {e.get("name", ""): (e, owner) for e, owner in _joint_elements(model)}
    if joint_name not in joints:
        raise InputError(file, "", f"no joint '{joint_name}'", f"joints are: {listed(tuple(joints))}")
    return _joint(file, model, Frames(file, model), *joints[joint_name])


def joint_names(path: str | PathLike[str]) -> tuple[str, ...]:
    """Names of the joints of an .osim file, in its order."""
    return tuple(element.get("name", "") for element, _ in _joint_elements(read_model(path)))


def bodies_at_rest(path: str | PathLike[str]) -> frozenset[str]:
    """The ground of an .osim file and the bodies that are welded to it, one to another."""
    file = fspath(path)
    model = read_model(path)
    frames = Frames(file, model)
    welds = [_joint(file, model, frames, e, owner) for e, owner in _joint_elements(model) if e.tag == "WeldJoint"]
    found = {GROUND}
    for _ in welds:
        found |= {
            body for joint in welds for body in (joint.parent, joint.child) if found & {joint.parent, joint.child}
        }
    return frozenset(found)


def joints_of(file: str, model: Element, frames: Frames) -> tuple[JointModel, ...]:
    """All joints of a model, in the file's order."""
    return tuple(each for found in _joint_elements(model) for each in _joints(file, model, frames, *found))


def _joints(file: str, model: Element, frames: Frames, element: Element, owner: Element) -> tuple[JointModel, ...]:
    """The joints that one element of the file stands for: one, or two by way of a body without mass."""
    if element.tag != TAG:
        return (_joint(file, model, frames, element, owner),)
    coordinates = tuple(
        _coordinate(file, e.get("name", ""), e, "rotational") for e in element.findall("coordinates/Coordinate")
    )
    if len(coordinates) != 4:
        raise InputError(
            file, label(element), f"{len(coordinates)} coordinates, not 4", "save the model with OpenSim 4"
        )
    name, place = element.get("name", ""), _place_by_sockets(file, element, frames, model)
    joint = JointModel(name, place[0], place[1], coordinates, (), place[2], place[3], False, file)
    radii = numbers_of(file, element, "thoracic_ellipsoid_radii_x_y_z", 3)
    origin = numbers_of(file, element, "scapula_winging_axis_origin", 2, (0.0, 0.0))
    direction = numbers_of(file, element, "scapula_winging_axis_direction", 1, (0.0,))
    return scapulothoracic(joint, radii, origin, float(direction[0]))


def _joint(file: str, model: Element, frames: Frames, element: Element, owner: Element) -> JointModel:
    bodies = {id(body.find("Joint")): body for body in model.findall("BodySet/objects/Body")}
    if (body := bodies.get(id(owner))) is not None:
        place = _place_in_body(file, element, body)
    else:
        place = _place_by_sockets(file, element, frames, model)
    coordinates, axes = _motion(file, element)
    name = element.get("name", "")
    return JointModel(name, place[0], place[1], coordinates, axes, place[2], place[3], place[4], file)


def _joint_elements(model: Element) -> list[tuple[Element, Element]]:
    return [(e, owner) for owner in _owners(model) for e in owner if e.tag.endswith("Joint")]


def _owners(model: Element) -> list[Element]:
    """Elements that hold joints: the joint set (OpenSim 4) and `<Joint>` in each body (OpenSim 3)."""
    return [*model.findall("JointSet/objects"), *model.findall("BodySet/objects/Body/Joint")]


_Place = tuple[str, str, RigidTransform, RigidTransform, bool]


def _place_in_body(file: str, joint: Element, body: Element) -> _Place:
    """OpenSim 3: parent and child body, the joint's frames in them, and whether the functions are reversed."""
    parent = text_of(joint, "parent_body")
    if not parent:
        raise InputError(file, label(joint), "no <parent_body>", "open and save the model with OpenSim 3.3 or later")
    ends = []
    for suffix in ("_in_parent", "_in_child" if joint.find("location_in_child") is not None else ""):
        turn = numbers_of(file, joint, f"orientation{suffix}", 3, (0.0, 0.0, 0.0))
        ends.append(offset(turn, numbers_of(file, joint, f"location{suffix}", 3, (0.0, 0.0, 0.0))))
    return parent, body.get("name", ""), ends[0], ends[1], is_true(file, joint, "reverse")


def _place_by_sockets(file: str, joint: Element, frames: Frames, model: Element) -> _Place:
    """OpenSim 4: bodies behind the joint's two frames and the frames' poses in them."""
    holder = model.find("JointSet")
    owner = f"/{(holder.get('name') if holder is not None else '') or 'jointset'}/{joint.get('name', '')}"
    ends = []
    for socket in ("parent_frame", "child_frame"):
        connectee = socket_of(joint, socket)
        if not connectee:
            raise InputError(file, label(joint), f"no <socket_{socket}>", "open and save the model with OpenSim 4")
        ends.append(frames.in_body(frames.resolve(owner, connectee)))
    return ends[0][0], ends[1][0], ends[0][1], ends[1][1], False


def _motion(file: str, joint: Element) -> tuple[tuple[Coordinate, ...], tuple[TransformAxis, ...]]:
    elements = [*joint.findall("coordinates/Coordinate"), *joint.findall("CoordinateSet/objects/Coordinate")]
    transform = joint.find("SpatialTransform")
    if joint.tag in _SIMPLE:
        axes = _simple_axes(joint, [e.get("name", "") for e in elements])
        kinds = {a.coordinates[0]: _kind(i >= 3) for i, a in enumerate(axes) if a.coordinates}
    elif joint.tag == "CustomJoint" and transform is not None:
        axes = tuple(_read_axis(file, label(joint), transform, slot) for slot in range(6))
        kinds = _kinds(transform)
    else:
        supported = ", ".join(["CustomJoint with SpatialTransform", *_SIMPLE])
        raise InputError(file, label(joint), "this kind of joint is not supported", f"supported: {supported}")
    given = {e.get("name", ""): e for e in elements}
    unknown = {name for axis in axes for name in axis.coordinates} - set(given)
    if unknown and joint.tag == "CustomJoint":
        what = f"its transform uses {listed(tuple(sorted(unknown)))}"
        raise InputError(file, label(joint), what, f"coordinates are: {listed(tuple(given))}")
    names = list(dict.fromkeys([*given, *(name for axis in axes for name in axis.coordinates)]))
    return tuple(_coordinate(file, name, given.get(name), kinds.get(name, "coupled")) for name in names), axes


def _coordinate(file: str, name: str, element: Element | None, kind: Kind) -> Coordinate:
    """A motion type written into the file (OpenSim 3) is what its motion files were written by."""
    if element is None:
        return Coordinate(name, 0.0, kind)
    stated = text_of(element, "motion_type").lower()
    known: Kind
    for known in ("rotational", "translational", "coupled"):
        if stated == known:
            kind = known
    low, high = numbers_of(file, element, "range", 2, (-np.inf, np.inf))
    clamped, locked = (is_true(file, element, flag) for flag in ("clamped", "locked"))
    default = float(numbers_of(file, element, "default_value", 1, (0.0,))[0])
    if is_true(file, element, "prescribed"):
        held = element.find("prescribed_function/Constant")
        if held is None:
            held = element.find("Constant")
        if held is not None:
            default, locked = float(numbers_of(file, held, "value", 1)[0]), True
        else:
            message = f"{file}: coordinate {name} is prescribed over time, which is ignored"
            warnings.warn(InputWarning(message), stacklevel=5)
    return Coordinate(name, default, kind, (float(low), float(high)), clamped, locked)


def _simple_axes(joint: Element, given: list[str]) -> tuple[TransformAxis, ...]:
    """The six motions of a joint without functions of its own; unnamed coordinates are `<joint>_coord_<i>`."""
    axes = [TransformAxis(direction, (), constant(0.0)) for direction in (*np.eye(3), *np.eye(3))]
    for i, (slot, direction) in enumerate(_SIMPLE[joint.tag]):
        name = given[i] if i < len(given) else f"{joint.get('name', '')}_coord_{i}"
        axes[slot] = TransformAxis(direction, (name,), linear(np.array([1.0, 0.0])))
    return tuple(axes)


def _kind(translation: bool) -> Kind:
    return "translational" if translation else "rotational"


def _read_axis(file: str, joint: str, transform: Element, slot: int) -> TransformAxis:
    axis = _axis_element(transform, slot)
    default = tuple(float(x) for x in np.eye(3)[slot % 3])
    if axis is None:
        return TransformAxis(np.array(default), (), constant(0.0))
    direction = numbers_of(file, axis, "axis", 3, default)
    length = float(np.linalg.norm(direction))
    if not 0.0 < length < np.inf:
        raise InputError(file, f"{label(axis)} <axis>", f"an axis of length {length:g}", "correct the model")
    names = tuple(text_of(axis, "coordinates").split())
    found = _function_element(axis)
    owner = f"{joint} {axis.get('name', '')}"
    function = (
        function_of(owner, file, found, len(names)) if found is not None else _without_function(file, axis, names)
    )
    # OpenSim normalises translation axes as well as rotation axes.
    return TransformAxis(direction / length, names, function)


def _without_function(file: str, axis: Element, names: tuple[str, ...]) -> JointFunction:
    """What OpenSim does: where `<function/>` is empty a coordinate moves its axis by itself, where there is none not at
    all (seen by trial on OpenSim 4.6).
    """
    if not _is_identity(axis):
        return constant(0.0, len(names))
    if len(names) > 1:
        what = f"{len(names)} coordinates and no function"
        raise InputError(file, label(axis), what, "open and save the model with OpenSim 4")
    return linear(np.array([1.0, 0.0])) if names else constant(0.0)


def _is_identity(axis: Element) -> bool:
    """Whether an axis has a function that is empty."""
    function = axis.find("function")
    return function is not None and len(function) == 0


def _axis_element(transform: Element, slot: int) -> Element | None:
    found = [axis for axis in transform.findall("TransformAxis") if axis.get("name") == _AXES[slot]]
    return found[0] if found else None


def _function_element(axis: Element) -> Element | None:
    """`<function><LinearFunction>…` (OpenSim 3) or `<LinearFunction name="function">` (OpenSim 4)."""
    for child in axis:
        if child.tag == "function":
            return next(iter(child), None)
        if child.tag not in ("coordinates", "coordinate", "axis"):
            return child
    return None


def _kinds(transform: Element) -> dict[str, Kind]:
    """Coordinates that drive an axis as themselves (linear, slope ±1); translation counts more.

    As OpenSim 4 decides it; seen by trial on OpenSim 4.6 (`Coordinate.getMotionType`).
    """
    kinds: dict[str, Kind] = {}
    for slot in range(6):
        axis = _axis_element(transform, slot)
        function = None if axis is None else _function_element(axis)
        if axis is None or not (_is_identity(axis) if function is None else function.tag == "LinearFunction"):
            continue
        slopes = ["1"] if function is None else text_of(function, "coefficients", "1 0").split()
        for name, slope in zip(text_of(axis, "coordinates").split(), slopes, strict=False):
            if abs(float(slope)) == 1.0:
                kinds[name] = _kind(slot >= 3)
    return kinds
