"""Passive forces of an OpenSim model: which act in inverse dynamics beside gravity. Both dialects, SI."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike, fspath
from xml.etree.ElementTree import Element

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.data.errors import InputError
from geocontact.data.multibody.model import (
    GROUND,
    CoordinateLimit,
    CoordinateSpring,
    FrameBushing,
    Multibody,
    PassiveForce,
    PassiveForces,
)
from geocontact.io.opensim.osim_xml import Frames, is_true, label, numbers_of, offset, read_model, socket_of, text_of
from geocontact.io.text.tables import listed

MUSCLES, ACTUATORS, ALL = "muscles", "actuators", "all"
"""OpenSim's words for groups that every model has; their case does not matter."""


def read_passive_forces(path: str | PathLike[str], model: Multibody, exclude: Sequence[str] = ()) -> PassiveForces:
    """Coordinate limits, springs and bushings of an .osim file that are switched on.

    Muscles and actuators do nothing here: inverse dynamics asks for what they must do. `exclude` names forces, groups
    of the model's force set, or `all`. InputError for a name that is neither.
    """
    file = fspath(path)
    root = read_model(path)
    elements = [e for e in root.findall("ForceSet/objects/*") if _acts(file, e)]
    left_out = _chosen(file, root, elements, exclude)
    kept = [e for e in elements if e.get("name", "") not in left_out]
    frames = Frames(file, root)
    known = {body.name for body in model.bodies} | {GROUND}
    acting = tuple(_READ[e.tag](file, e, model, frames) for e in kept if e.tag in _READ)
    for force in acting:
        if isinstance(force, FrameBushing) and not set(force.bodies) <= known:
            raise InputError(file, f"force {force.name}", f"is between {' and '.join(force.bodies)}", "name two bodies")
    unread = tuple(label(e) for e in kept if e.tag not in _READ)
    return PassiveForces(acting, tuple(e.get("name", "") for e in elements if e not in kept), unread)


def _acts(file: str, element: Element) -> bool:
    """Whether a force is switched on and needs no control. OpenSim 3 says isDisabled, OpenSim 4 appliesForce."""
    if "Muscle" in element.tag or "Actuator" in element.tag or element.tag == "TorqueActuator":
        return False
    if element.find("appliesForce") is not None:
        return is_true(file, element, "appliesForce")
    return not is_true(file, element, "isDisabled")


def _chosen(file: str, root: Element, elements: list[Element], words: Sequence[str]) -> set[str]:
    names = {e.get("name", "") for e in elements}
    every = {e.get("name", "") for e in root.findall("ForceSet/objects/*")}
    groups = {e.get("name", ""): set(text_of(e, "members").split()) for e in root.findall("ForceSet/groups/*")}
    found: set[str] = set()
    for word in words:
        if word.lower() == ALL:
            found |= names
        elif word in groups or word in every:
            found |= groups.get(word, {word})
        elif word.lower() not in (MUSCLES, ACTUATORS):
            there = listed((*sorted(names), *groups)) or "none that acts without control"
            raise InputError(
                file, f"`exclude` {word}", "is neither a force nor a group of the model", f"forces: {there}"
            )
    return found


def _limit(file: str, element: Element, model: Multibody, frames: Frames) -> PassiveForce:
    """Limits, stiffness and damping are per degree where the coordinate is an angle."""
    name, kind = _coordinate(file, element, model)
    unit = np.pi / 180.0 if kind == "rotational" else 1.0
    upper, lower, transition = (
        _number(file, element, each) * unit for each in ("upper_limit", "lower_limit", "transition")
    )
    above, below, damping = (
        _number(file, element, each) / unit for each in ("upper_stiffness", "lower_stiffness", "damping")
    )
    return CoordinateLimit(element.get("name", ""), name, upper, lower, above, below, damping, transition)


def _spring(file: str, element: Element, model: Multibody, frames: Frames) -> PassiveForce:
    name, _ = _coordinate(file, element, model)
    numbers = (_number(file, element, each) for each in ("stiffness", "rest_length", "viscosity"))
    return CoordinateSpring(element.get("name", ""), name, *numbers)


def _bushing(file: str, element: Element, model: Multibody, frames: Frames) -> PassiveForce:
    ends = [_end(file, element, frames, k) for k in (1, 2)]
    numbers = [
        np.concatenate(
            [
                numbers_of(file, element, f"{kind}_{each}", 3, (0.0, 0.0, 0.0))
                for kind in ("rotational", "translational")
            ]
        )
        for each in ("stiffness", "damping")
    ]
    (first, one), (second, two) = ends
    return FrameBushing(element.get("name", ""), (first, second), (one, two), *numbers)


def _end(file: str, element: Element, frames: Frames, k: int) -> tuple[str, RigidTransform]:
    """Body and frame in it; OpenSim 3 names the body and gives the frame's place."""
    body = text_of(element, f"body_{k}")
    if body:
        turn = numbers_of(file, element, f"orientation_body_{k}", 3, (0.0, 0.0, 0.0))
        return body, offset(turn, numbers_of(file, element, f"location_body_{k}", 3, (0.0, 0.0, 0.0)))
    socket = socket_of(element, f"frame{k}")
    if not socket:
        raise InputError(file, label(element), f"no <socket_frame{k}>", "open and save the model with OpenSim 4")
    return frames.in_body(frames.resolve(f"/forceset/{element.get('name', '')}", socket))


def _coordinate(file: str, element: Element, model: Multibody) -> tuple[str, str]:
    name = text_of(element, "coordinate")
    kinds = {c.name: c.kind for c in model.coordinates}
    if name not in kinds:
        what = f"acts along '{name}', which is not a coordinate of the model"
        raise InputError(file, label(element), what, f"coordinates are: {listed(tuple(kinds))}")
    return name, kinds[name]


def _number(file: str, element: Element, child: str) -> float:
    return float(numbers_of(file, element, child, 1, (_DEFAULTS.get((element.tag, child), 0.0),))[0])


_DEFAULTS = {
    ("CoordinateLimitForce", "upper_stiffness"): 1.0,
    ("CoordinateLimitForce", "lower_stiffness"): 1.0,
    ("CoordinateLimitForce", "damping"): 0.001,
    ("CoordinateLimitForce", "transition"): 0.1,
}
"""Defaults of OpenSim 4.6, for what a file does not say."""

_READ: dict[str, Callable[[str, Element, Multibody, Frames], PassiveForce]] = {
    "CoordinateLimitForce": _limit,
    "SpringGeneralizedForce": _spring,
    "BushingForce": _bushing,
}
