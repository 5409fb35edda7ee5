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
from geocontact.data.multibody import Multibody
from geocontact.io.osim_xml import label, numbers_of, read_document, socket_of, text_of

Vector = Float[np.ndarray, " 3"]
FactorOf = Callable[[str], Vector]

_SHIFTS = ("translation1", "translation2", "translation3")


def write_scaled_model(
    source: str | PathLike[str], target: Path, scaled: Multibody, factors: Mapping[str, Vector]
) -> None:
    """Write the source again with bodies, joints, markers and paths of muscles scaled.

    Parameters
    ----------
    scaled
        The model as it is to be: masses, mass centres, inertias and places of markers are its own.
    factors
        Of bodies by name, along the axes of the body's frame.

    Lengths of fibres and tendons, wrapping surfaces and contact geometry stay, with a warning where there are any.
    InputError for joints on frames that hang on other frames, and for markers that hang on a frame.
    """
    file = fspath(source)
    root = read_document(source, "OpenSim model")
    model = root if root.tag == "Model" else root.find("Model")
    if model is None:
        raise InputError(file, "", f"root element is <{root.tag[:40]}>, not an OpenSim model", "give an .osim file")

    def of(body: str) -> Vector:
        return np.asarray(factors.get(basename(body), np.ones(3)), float)

    _bodies(file, model, scaled, of)
    _joints(file, model, of)
    _markers(file, model, scaled)
    for point in model.iter():
        if point.tag.endswith("PathPoint") and point.find("location") is not None:
            body = text_of(point, "body") or socket_of(point, "parent_frame")
            _times(file, point, "location", of(body))
    if any(True for _ in model.iter("optimal_fiber_length")) or any(model.iter("WrapObjectSet")):
        message = f"{file}: lengths of fibres and tendons, wrapping surfaces and contact geometry are not scaled"
        warnings.warn(InputWarning(message), stacklevel=2)
    ElementTree(root).write(target, encoding="UTF-8", xml_declaration=True)


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
            if mesh.find("scale_factors") is not None:
                _times(file, mesh, "scale_factors", of(body.name))


def _joints(file: str, model: Element, of: FactorOf) -> None:
    for joint in model.findall("JointSet/objects/*"):
        frames = {f.get("name", ""): f for f in joint.findall("frames/PhysicalOffsetFrame")}
        for frame in frames.values():
            body = socket_of(frame, "parent")
            if basename(body) in frames:
                raise InputError(file, label(frame), "hangs on another frame", "hang the joint's frames on bodies")
            _times(file, frame, "translation", of(body))
        held = frames.get(basename(socket_of(joint, "parent_frame")))
        parent = socket_of(joint, "parent_frame") if held is None else socket_of(held, "parent")
        _shifts(file, joint, of(parent))
    for body in model.findall("BodySet/objects/Body"):
        for joint in body.findall("Joint/*"):  # OpenSim 3
            parent = text_of(joint, "parent_body")
            _times(file, joint, "location_in_parent", of(parent))
            _times(file, joint, "location", of(body.get("name", "")))
            _shifts(file, joint, of(parent))


def _shifts(file: str, joint: Element, by: Vector) -> None:
    """Functions of a shift that are no coordinate by themselves, times the factor along their axis."""
    for axis in joint.findall("SpatialTransform/TransformAxis"):
        if axis.get("name") not in _SHIFTS:
            continue
        slot = _SHIFTS.index(axis.get("name", ""))
        direction = numbers_of(file, axis, "axis", 3, tuple(np.eye(3)[slot]))
        factor = float(np.linalg.norm(direction / np.linalg.norm(direction) * by))
        nested = axis.find("function")
        holder = axis if nested is None else nested
        plain = [child for child in holder if child.tag not in ("coordinates", "coordinate", "axis")]
        if not plain or factor == 1.0:
            continue
        function = plain[0]
        if function.tag == "LinearFunction" and text_of(function, "coefficients").split() in (
            ["1", "0"],
            ["1.0", "0.0"],
        ):
            continue
        place = list(holder).index(function)
        holder.remove(function)
        around = Element("MultiplierFunction", {"name": function.get("name", "function")} if nested is None else {})
        SubElement(around, "function").append(function)
        SubElement(around, "scale").text = f"{factor:.17g}"
        holder.insert(place, around)


def _markers(file: str, model: Element, scaled: Multibody) -> None:
    wanted = {m.name: m for m in scaled.markers}
    for element in model.findall("MarkerSet/objects/Marker"):
        marker = wanted[element.get("name", "")]
        socket = socket_of(element, "parent_frame") or text_of(element, "body")
        if basename(socket) != marker.body:
            raise InputError(file, label(element), f"hangs on '{socket}'", "hang markers on bodies")
        _set(element, "location", marker.location)


def _times(file: str, element: Element, child: str, by: Vector) -> None:
    if element.find(child) is not None:
        _set(element, child, numbers_of(file, element, child, 3) * by)


def _set(element: Element, child: str, values: Float[np.ndarray, " k"] | list[float]) -> None:
    found = element.find(child)
    if found is None:
        found = SubElement(element, child)
    found.text = " ".join(f"{float(value):.17g}" for value in values)
