"""A whole OpenSim model as a tree of bodies: masses, joints, markers, gravity. Both dialects, metres and radians."""

from __future__ import annotations

from os import PathLike, fspath
from posixpath import basename
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.multibody.model import GROUND, Body, Marker, Multibody, outwards
from geocontact.io.opensim.osim import between, joints_of
from geocontact.io.opensim.osim_functions import read_couplers, read_pairs
from geocontact.io.opensim.osim_xml import (
    Frames,
    is_true,
    label,
    numbers_of,
    read_document,
    read_model,
    socket_of,
    text_of,
)

_MOMENTS = ("xx", "yy", "zz", "xy", "xz", "yz")


def read_multibody(path: str | PathLike[str]) -> Multibody:
    """Bodies, joints and markers of an .osim file.

    Coordinates that a coupler makes functions of others follow them; points that a constraint keeps together too.
    Other constraints are no part of a tree: a model with some that are not switched off is read with a warning that
    names them. Muscles and other forces are left aside. InputError for loops and bodies without a joint.
    """
    file = fspath(path)
    model = read_model(path)
    frames = Frames(file, model)
    bodies = tuple(_body(file, e) for e in model.findall("BodySet/objects/Body") if e.get("name") != GROUND)
    joints, lost = outwards(joints_of(file, model, frames))
    bodies += tuple(_without_mass(joint.child) for joint in joints if joint.child == between(joint.name))
    if lost:
        raise InputError(file, f"joint {lost[0].name}", "closes a loop or has no parent", "bodies must form a tree")
    loose = {body.name for body in bodies} - {joint.child for joint in joints}
    if loose:
        raise InputError(file, f"body {min(loose)}", "has no joint", "correct the model")
    couplers = read_couplers(file, model, [c.name for joint in joints for c in joint.coordinates])
    markers = _markers(file, frames, model.findall("MarkerSet/objects/Marker"), {body.name for body in bodies})
    gravity = numbers_of(file, model, "gravity", 3, (0.0, -9.80665, 0.0))
    pairs = read_pairs(file, model, frames)
    return Multibody(model.get("name", ""), bodies, joints, markers, gravity, couplers, pairs)


def read_marker_set(path: str | PathLike[str], osim: str | PathLike[str]) -> tuple[Marker, ...]:
    """Markers of a file of their own (OpenSim's `MarkerSet`), for the bodies and frames of a model."""
    file = fspath(path)
    model = read_model(osim)
    frames = Frames(fspath(osim), model)
    bodies = {e.get("name", "") for e in model.findall("BodySet/objects/Body")}
    root = read_document(path, "OpenSim marker set")
    elements = [e for owner in root.iter("MarkerSet") for e in owner.findall("objects/Marker")]
    if not elements:
        raise InputError(file, "", "holds no MarkerSet with markers", "give OpenSim's marker set (.xml)")
    return _markers(file, frames, elements, bodies)


def _markers(file: str, frames: Frames, elements: list[Element], bodies: set[str]) -> tuple[Marker, ...]:
    markers = tuple(_marker(file, frames, e) for e in elements)
    unknown = [m for m in markers if m.body not in bodies | {GROUND}]
    if unknown:
        raise InputError(
            file, f"marker {unknown[0].name}", f"is on '{unknown[0].body}', which is not a body of the model"
        )
    names = [m.name for m in markers]
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise InputError(file, f"marker {twice[0]}", f"is there {names.count(twice[0])} times", "rename one")
    return markers


def _body(file: str, element: Element) -> Body:
    mass = float(numbers_of(file, element, "mass", 1, (0.0,))[0])
    if mass < 0.0:
        raise InputError(file, f"{label(element)} <mass>", f"{mass:g} kg is negative", "correct the model")
    centre = numbers_of(file, element, "mass_center", 3, (0.0, 0.0, 0.0))
    return Body(element.get("name", ""), mass, centre, _inertia(file, element))


def _without_mass(name: str) -> Body:
    return Body(name, 0.0, np.zeros(3), np.zeros((3, 3)))


def _inertia(file: str, element: Element) -> Float[np.ndarray, "3 3"]:
    """`<inertia>` with six numbers (OpenSim 4) or `<inertia_xx>` and five more (OpenSim 3), about the mass centre."""
    if element.find("inertia") is not None:
        moments = numbers_of(file, element, "inertia", 6)
    else:
        moments = np.array([numbers_of(file, element, f"inertia_{ij}", 1, (0.0,))[0] for ij in _MOMENTS])
    for axis, moment in zip("xyz", moments[:3], strict=True):
        if moment < 0.0:
            what = f"{moment:g} kg m^2 about {axis} is negative"
            raise InputError(file, f"{label(element)} <inertia>", what, "correct the model")
    xx, yy, zz, xy, xz, yz = moments
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _marker(file: str, frames: Frames, element: Element) -> Marker:
    location, fixed = numbers_of(file, element, "location", 3), is_true(file, element, "fixed")
    socket = socket_of(element, "parent_frame")
    if not socket:  # OpenSim 3 names the body itself
        return Marker(element.get("name", ""), text_of(element, "body"), location, fixed)
    body, pose = frames.in_body(frames.resolve(f"/markerset/{element.get('name', '')}", socket))
    return Marker(element.get("name", ""), basename(body), pose.apply(location), fixed)
