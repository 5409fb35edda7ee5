"""An OpenSim model file made to measure: what hangs on bodies is moved with them, all else stays as it is written."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from os import PathLike, fspath
from pathlib import Path
from posixpath import basename
from xml.etree.ElementTree import Element, ElementTree, SubElement

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.model import GROUND, Multibody, coupler_stretch
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.osim_xml import (
    Frames,
    label,
    name_joints_apart,
    numbers_of,
    outside_of_sets,
    read_document,
    socket_of,
    text_of,
)
from geocontact.io.text.tables import listed

Vector = Float[np.ndarray, " 3"]
FactorOf = Callable[[str], Vector]

_PLACES = ("x_location", "y_location", "z_location")
_SHIFTS = ("translation1", "translation2", "translation3")
_KEPT: dict[str, Callable[[Element], bool]] = {
    "lengths of fibres and tendons": lambda e: e.tag in ("optimal_fiber_length", "tendon_slack_length"),
    "lengths of ligaments and springs": lambda e: e.tag in ("resting_length", "slack_length"),
    "wrapping surfaces": lambda e: (
        e.tag.startswith("Wrap") and bool(e.get("name")) and e.find("translation") is not None
    ),
    "contact geometry": lambda e: e.tag in ("ContactSphere", "ContactMesh", "ContactEllipsoid", "ContactCylinder"),
}
"""What stays as it is written, and how an element of it is recognised."""

_SAME = 1e-9
"""m that the file that was written may differ from what it was to be."""


def write_scaled_model(
    source: str | PathLike[str],
    target: Path,
    scaled: Multibody,
    factors: Mapping[str, Vector],
    pose: Mapping[str, float] | None = None,
) -> None:
    """Write the source again with bodies, joints, markers and paths of muscles scaled; it is read back and compared.

    Parameters
    ----------
    scaled
        The model as it is to be: masses, mass centres, inertias and markers are its own.
    factors
        Of bodies by name, along the axes of the body's frame.
    pose
        Defaults of coordinates by name [rad, m] in place of those in the file.

    Lengths of fibres and tendons, wrapping surfaces and contact geometry stay, with a warning where there are any.
    InputError where frames hang on frames in a way that is not followed.
    """
    file = fspath(source)
    root = read_document(source, "OpenSim model")
    model = root if root.tag == "Model" else root.find("Model")
    if model is None:
        raise InputError(file, "", f"root element is <{root.tag[:40]}>, not an OpenSim model", "give an .osim file")
    if loose := outside_of_sets(model):
        names = listed(tuple(label(e) for e in loose))
        raise InputError(
            file, "<components>", f"holds {names}, which is not scaled there", "put it into the model's sets"
        )

    name_joints_apart(model)

    def of(body: str) -> Vector:
        return np.asarray(factors.get(basename(body), np.ones(3)), float)

    _bodies(file, model, scaled, of)
    frames = Frames(file, model)
    _frames(file, frames, of)
    _joints_of_old(file, model, of)
    _shifts(file, model, scaled, of)
    _couplers(file, model, scaled, factors)
    _pairs(file, model, frames, of)
    _markers(model, scaled)
    for point in list(model.iter()):
        if point.tag.endswith("PathPoint"):
            by = of(_body_of(point, frames))
            _times(file, point, "location", by)
            _moving(point, by)
        elif point.tag == "Coordinate" and point.get("name", "") in (pose or {}):
            _set(point, "default_value", [(pose or {})[point.get("name", "")]])
    if kept := [what for what, is_there in _KEPT.items() if any(is_there(e) for e in model.iter())]:
        warnings.warn(InputWarning(f"{file}: not scaled: {', '.join(kept)}"), stacklevel=2)
    ElementTree(root).write(target, encoding="UTF-8", xml_declaration=True)
    _compare(file, target, scaled)


def _bodies(file: str, model: Element, scaled: Multibody, of: FactorOf) -> None:
    wanted = {body.name: body for body in scaled.bodies}
    for element in model.findall("BodySet/objects/Body"):
        body = wanted.get(element.get("name", ""))
        if body is None:
            continue
        _set(element, "mass", [body.mass])
        _set(element, "mass_center", body.centre)
        i = body.inertia
        six = {"xx": i[0, 0], "yy": i[1, 1], "zz": i[2, 2], "xy": i[0, 1], "xz": i[0, 2], "yz": i[1, 2]}
        if element.find("inertia") is not None:
            _set(element, "inertia", list(six.values()))
        else:
            for ij, value in six.items():
                _set(element, f"inertia_{ij}", [value])
        for mesh in element.findall("attached_geometry/*"):
            _times(file, mesh, "scale_factors", of(body.name))


def _frames(file: str, frames: Frames, of: FactorOf) -> None:
    """Offset frames and what is drawn in them (OpenSim 4): by the body that they are fixed to, along their own axes."""
    for path, frame in frames.elements.items():
        if frame.tag == "PhysicalOffsetFrame":
            by = of(frames.in_body(path)[0])
            _times(file, frame, "translation", by)
            for mesh in frame.findall("attached_geometry/*"):
                _times(file, mesh, "scale_factors", by)


def _joints_of_old(file: str, model: Element, of: FactorOf) -> None:
    """Where joints and bushings are in their bodies (OpenSim 3)."""
    for element in model.findall("BodySet/objects/Body"):
        for joint in element.findall("Joint/*"):
            _times(file, joint, "location_in_parent", of(text_of(joint, "parent_body")))
            _times(file, joint, "location", of(element.get("name", "")))
    for bushing in (e for e in model.iter() if e.tag.endswith("BushingForce")):
        for k in "12":
            _times(file, bushing, f"location_body_{k}", of(text_of(bushing, f"body_{k}")))


def _shifts(file: str, model: Element, scaled: Multibody, of: FactorOf) -> None:
    """Functions of a shift that are no coordinate by themselves, times the factor along their axis."""
    joints = {joint.name: joint for joint in scaled.joints}
    for element in model.iter("CustomJoint"):
        joint = joints.get(element.get("name", ""))
        for axis in element.findall("SpatialTransform/TransformAxis"):
            if joint is None or joint.base == GROUND or axis.get("name") not in _SHIFTS:
                continue
            slot = _SHIFTS.index(axis.get("name", ""))
            _multiply(file, axis, joint.stretch(3 + slot, of(joint.base)))


def _couplers(file: str, model: Element, scaled: Multibody, factors: Mapping[str, Vector]) -> None:
    """Factors of the functions by which shifts depend on other coordinates."""
    dependents = {coupler.dependent for coupler in scaled.couplers}
    for element in model.findall("ConstraintSet/objects/CoordinateCouplerConstraint"):
        dependent = text_of(element, "dependent_coordinate_name")
        if dependent in dependents:
            factor = float(numbers_of(file, element, "scale_factor", 1, (1.0,))[0])
            _set(element, "scale_factor", [factor * coupler_stretch(scaled, dependent, factors)])


def _pairs(file: str, model: Element, frames: Frames, of: FactorOf) -> None:
    """Points that a constraint keeps together move with their bodies; OpenSim leaves them where they were."""
    for element in model.findall("ConstraintSet/objects/PointConstraint"):
        for end in ("1", "2"):
            named = socket_of(element, f"body_{end}") or text_of(element, f"body_{end}")
            body, pose = frames.in_body(frames.resolve("/constraintset", named))
            if not np.array_equal(pose.as_matrix(), np.eye(4)) and not np.array_equal(of(body), np.ones(3)):
                what = f"<location_body_{end}> is in an offset frame, which is not scaled there"
                raise InputError(file, label(element), what, f"express it in {body}")
            _times(file, element, f"location_body_{end}", of(body))


def _multiply(file: str, axis: Element, factor: float) -> None:
    nested = axis.find("function")
    holder = axis if nested is None else nested
    plain = [child for child in holder if child.tag not in ("coordinates", "coordinate", "axis")]
    if not plain or factor == 1.0:
        return
    function = plain[0]
    if function.tag == "LinearFunction" and numbers_of(file, function, "coefficients", None).tolist() == [1.0, 0.0]:
        return  # the coordinate itself
    _around(holder, function, factor, "function" if nested is None else "")


def _body_of(point: Element, frames: Frames) -> str:
    """Body of a point of a path: as OpenSim does, also where the point is in a frame that is fixed to the body."""
    socket = socket_of(point, "parent_frame")
    if not socket:
        return text_of(point, "body")
    return frames.in_body(frames.resolve(f"/forceset/{point.get('name', '')}", socket))[0]


def _moving(point: Element, by: Vector) -> None:
    """Places of a `MovingPathPoint` that are functions of a coordinate, as properties (OpenSim 4) or inside of them."""
    for name, factor in zip(_PLACES, by, strict=True):
        nested = point.find(name)
        holder = point if nested is None else nested
        for function in [child for child in holder if nested is not None or child.get("name") == name]:
            _around(holder, function, float(factor), name if nested is None else "")


def _around(holder: Element, function: Element, factor: float, name: str) -> None:
    """A `MultiplierFunction` in place of a function; with the function's name where it is a property of its own."""
    if factor == 1.0:
        return
    place = list(holder).index(function)
    holder.remove(function)
    around = Element("MultiplierFunction", {"name": function.get("name", name)} if name else {})
    SubElement(around, "function").append(function)
    SubElement(around, "scale").text = f"{factor:.17g}"
    holder.insert(place, around)


def _markers(model: Element, scaled: Multibody) -> None:
    """The model's markers written anew, in the dialect of the file."""
    old = bool(model.findall("BodySet/objects/Body/Joint"))
    holder = model.find("MarkerSet")
    if holder is None:
        holder = SubElement(model, "MarkerSet", {"name": "markerset"})
    for child in list(holder):
        holder.remove(child)
    objects = SubElement(holder, "objects")
    for marker in scaled.markers:
        element = SubElement(objects, "Marker", {"name": marker.name})
        if old:
            SubElement(element, "body").text = marker.body
        else:
            path = "/ground" if marker.body == GROUND else f"/bodyset/{marker.body}"
            SubElement(element, "socket_parent_frame").text = path
        _set(element, "location", marker.location)
        SubElement(element, "fixed").text = "true" if marker.fixed else "false"


def _compare(file: str, target: Path, scaled: Multibody) -> None:
    """What was written must be the model that was meant, joint by joint and marker by marker."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        found = read_multibody(target)
    ends = [
        (
            f"joint {one.name}",
            [*one.parent_offset.translation, *one.child_offset.translation],
            [*other.parent_offset.translation, *other.child_offset.translation],
        )
        for one, other in zip(found.joints, scaled.joints, strict=True)
    ]
    places = np.tile([c.default for c in scaled.coordinates], (3, 1)) + np.array([[0.0], [0.1], [-0.2]])
    ends += [
        (f"marker {m.name}", one.ravel().tolist(), other.ravel().tolist())
        for m, one, other in zip(
            scaled.markers,
            found.marker_places(found.coupled(places)).swapaxes(0, 1),
            scaled.marker_places(scaled.coupled(places)).swapaxes(0, 1),
            strict=True,
        )
    ]
    ends += [
        (f"constraint {one.name}", one.places.ravel().tolist(), other.places.ravel().tolist())
        for one, other in zip(found.pairs, scaled.pairs, strict=True)
    ]
    for what, one, other in ends:
        if np.abs(np.subtract(one, other)).max() > _SAME:
            raise InputError(file, what, "is attached to frames in a way that is not scaled", "attach it to a body")


def _times(file: str, element: Element, child: str, by: Vector) -> None:
    if element.find(child) is not None:
        _set(element, child, numbers_of(file, element, child, 3) * by)


def _set(element: Element, child: str, values: Float[np.ndarray, " k"] | list[float]) -> None:
    found = element.find(child)
    if found is None:
        found = SubElement(element, child)
    found.text = " ".join(f"{float(value):.17g}" for value in values)
