"""A tree of bodies as an OpenSim model (.osim, the dialect of OpenSim 4), as `osim_multibody` reads one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.joint import Affine, Coordinate, JointModel, TransformAxis
from geocontact.data.multibody.model import GROUND, Body, Marker, Multibody

Vector = Float[np.ndarray, " 3"]
FORBIDDEN = " \t\n/\\*+"
"""Characters that a name of OpenSim 4 must not have."""
SLOTS = ("rotation1", "rotation2", "rotation3", "translation1", "translation2", "translation3")


@dataclass(frozen=True)
class ContactBall:
    """A sphere that is to touch the floor: name, body, place in its frame and radius [m]."""

    name: str
    body: str
    centre: Vector
    radius: float


def write_osim(
    path: Path,
    model: Multibody,
    *,
    springs: Mapping[str, tuple[float, float]] | None = None,
    balls: Sequence[ContactBall] = (),
    forces: Sequence[Element] = (),
    note: str = "",
) -> None:
    """Write the model; ValueError for a joint with a function that is not a coordinate itself, or a name with a blank.

    Parameters
    ----------
    springs
        Stiffness and damping about zero along coordinates by name [N m/rad and N m s/rad, N/m and N s/m].
    balls
        Written as geometry, with the floor y = 0; a force law is among `forces` or there is none.
    forces
        Further ones, as `osim_contact_forces` makes them.
    note
        What the file says of itself.
    """
    groups = (model.bodies, model.joints, model.coordinates, model.markers, balls)
    names = [model.name, *(part.name for group in groups for part in group)]
    wrong = [name for name in names if any(letter in name for letter in FORBIDDEN)]
    if wrong:
        raise ValueError(f"OpenSim takes no blank and none of / \\ * + in the name '{wrong[0]}'")
    root = Element("OpenSimDocument", {"Version": "40000"})
    top = SubElement(root, "Model", {"name": model.name})
    if note:
        SubElement(top, "credits").text = note
    SubElement(top, "length_units").text = "meters"
    SubElement(top, "force_units").text = "N"
    SubElement(top, "Ground", {"name": GROUND})
    add_numbers(top, "gravity", model.gravity)
    bodies = _set(top, "BodySet", "bodyset")
    for body in model.bodies:
        bodies.append(_body(body))
    joints = _set(top, "JointSet", "jointset")
    for joint in model.joints:
        joints.append(_joint(joint))
    acting = _set(top, "ForceSet", "forceset")
    for name, (stiffness, damping) in (springs or {}).items():
        acting.append(_spring(name, stiffness, damping))
    acting.extend(forces)
    markers = _set(top, "MarkerSet", "markerset")
    for marker in model.markers:
        markers.append(_marker(marker))
    if balls:
        shapes = _set(top, "ContactGeometrySet", "contactgeometryset")
        shapes.append(_floor())
        for ball in balls:
            shapes.append(_ball(ball))
    indent(root, "\t")
    ElementTree(root).write(path, encoding="UTF-8", xml_declaration=True)


def _set(model: Element, tag: str, name: str) -> Element:
    return SubElement(SubElement(model, tag, {"name": name}), "objects")


def _body(body: Body) -> Element:
    element = Element("Body", {"name": body.name})
    add_numbers(element, "mass", [body.mass])
    add_numbers(element, "mass_center", body.centre)
    i = body.inertia
    add_numbers(element, "inertia", [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]])
    return element


def _joint(joint: JointModel) -> Element:
    """A weld, or a joint of six motions; frames of their own where it sits on both bodies."""
    element = Element("CustomJoint" if joint.coordinates else "WeldJoint", {"name": joint.name})
    ends = ((joint.parent, joint.parent_offset), (joint.child, joint.child_offset))
    SubElement(element, "socket_parent_frame").text = f"{joint.parent}_offset"
    SubElement(element, "socket_child_frame").text = f"{joint.child}_offset"
    if joint.coordinates:
        held = SubElement(element, "coordinates")
        for coordinate in joint.coordinates:
            held.append(_coordinate(coordinate))
    frames = SubElement(element, "frames")
    for body, pose in ends:
        frames.append(offset_frame(f"{body}_offset", body, pose))
    if joint.coordinates:
        transform = SubElement(element, "SpatialTransform")
        directions = _directions(joint)
        for slot, axis, direction in zip(SLOTS, joint.axes, directions, strict=True):
            transform.append(_axis(joint, slot, axis, direction))
    return element


def _coordinate(coordinate: Coordinate) -> Element:
    element = Element("Coordinate", {"name": coordinate.name})
    add_numbers(element, "default_value", [coordinate.default])
    if np.isfinite(coordinate.limits).all():
        add_numbers(element, "range", coordinate.limits)
    SubElement(element, "clamped").text = "true" if coordinate.clamped else "false"
    SubElement(element, "locked").text = "true" if coordinate.locked else "false"
    return element


def offset_frame(name: str, body: str, pose: RigidTransform) -> Element:
    """A frame that is fixed to a body."""
    element = Element("PhysicalOffsetFrame", {"name": name})
    SubElement(element, "socket_parent").text = frame_path(body)
    add_numbers(element, "translation", pose.translation)
    add_numbers(element, "orientation", pose.rotation.as_euler("XYZ"))
    return element


def _directions(joint: JointModel) -> list[Vector]:
    """Axes of the six motions; what does not turn gets one that is not in the plane of the others, as OpenSim wants."""
    found: list[Vector | None] = [axis.direction if axis.coordinates else None for axis in joint.axes]
    for start in (0, 3):
        known = [each for each in found[start : start + 3] if each is not None]
        for k in range(start, start + 3):
            if found[k] is None:
                across = np.linalg.svd(np.array([*known, np.zeros(3)]))[2][len(known)] if known else np.eye(3)[0]
                found[k] = np.asarray(across)
                known.append(np.asarray(across))
    return [each for each in found if each is not None]


def _axis(joint: JointModel, slot: str, axis: TransformAxis, direction: Vector) -> Element:
    element = Element("TransformAxis", {"name": slot})
    SubElement(element, "coordinates").text = " ".join(axis.coordinates)
    add_numbers(element, "axis", direction)
    function = axis.function
    if not isinstance(function, Affine) or len(function.slopes) != len(axis.coordinates) or len(function.slopes) > 1:
        raise ValueError(f"joint {joint.name}: {slot} is not a line of one coordinate")
    if axis.coordinates:
        line = SubElement(element, "LinearFunction", {"name": "function"})
        add_numbers(line, "coefficients", [*function.slopes, function.offset])
    else:
        add_numbers(SubElement(element, "Constant", {"name": "function"}), "value", [function.offset])
    return element


def _spring(name: str, stiffness: float, damping: float) -> Element:
    element = Element("SpringGeneralizedForce", {"name": f"{name}_spring"})
    SubElement(element, "coordinate").text = name
    add_numbers(element, "stiffness", [stiffness])
    add_numbers(element, "rest_length", [0.0])
    add_numbers(element, "viscosity", [damping])
    return element


def _marker(marker: Marker) -> Element:
    element = Element("Marker", {"name": marker.name})
    SubElement(element, "socket_parent_frame").text = frame_path(marker.body)
    add_numbers(element, "location", marker.location)
    SubElement(element, "fixed").text = "true" if marker.fixed else "false"
    return element


def _floor() -> Element:
    """A half-space fills x > 0 of its own frame: turned so that it lies below y = 0."""
    element = Element("ContactHalfSpace", {"name": "floor"})
    SubElement(element, "socket_frame").text = "/ground"
    add_numbers(element, "location", np.zeros(3))
    add_numbers(element, "orientation", [0.0, 0.0, -0.5 * np.pi])
    return element


def _ball(ball: ContactBall) -> Element:
    element = Element("ContactSphere", {"name": ball.name})
    SubElement(element, "socket_frame").text = frame_path(ball.body)
    add_numbers(element, "location", ball.centre)
    add_numbers(element, "orientation", np.zeros(3))
    add_numbers(element, "radius", [ball.radius])
    return element


def frame_path(body: str) -> str:
    """Path of a body's own frame in the model."""
    return "/ground" if body == GROUND else f"/bodyset/{body}"


def add_numbers(element: Element, child: str, values: Float[np.ndarray, " k"] | Sequence[float]) -> None:
    """A child with numbers in it."""
    SubElement(element, child).text = " ".join(f"{float(value):.17g}" for value in values)
