"""Constraints of an OpenSim model: coordinates that are functions of others, points that belong together."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from xml.etree.ElementTree import Element

import numpy as np

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.model import Coupler, PointPair
from geocontact.io.opensim.osim_functions import function_of
from geocontact.io.opensim.osim_xml import Frames, is_true, label, numbers_of, socket_of, text_of
from geocontact.io.text.tables import listed

TAG, PAIR = "CoordinateCouplerConstraint", "PointConstraint"


def read_couplers(file: str, model: Element, coordinates: Sequence[str]) -> tuple[Coupler, ...]:
    """Couplers that are switched on, in an order in which each follows those it depends on.

    Constraints of other kinds, but for pairs of points, are no part of a tree: a warning names them.
    """
    found = _switched_on(file, model)
    others = tuple(label(e) for e in found if e.tag not in (TAG, PAIR))
    if others:
        message = f"{file}: constraints are not heeded, coordinates they couple move freely: {listed(others)}"
        warnings.warn(InputWarning(message), stacklevel=4)
    return _in_order(file, [_coupler(file, e, coordinates) for e in found if e.tag == TAG])


def read_pairs(file: str, model: Element, frames: Frames) -> tuple[PointPair, ...]:
    """Points that a `PointConstraint` keeps together, in the bodies that its frames are fixed to."""
    return tuple(_pair(file, e, frames) for e in _switched_on(file, model) if e.tag == PAIR)


def _pair(file: str, element: Element, frames: Frames) -> PointPair:
    bodies, places = [], []
    for end in ("1", "2"):
        named = socket_of(element, f"body_{end}") or text_of(element, f"body_{end}")
        if not named:
            raise InputError(file, label(element), f"names no body {end}", "correct the model")
        body, pose = frames.in_body(frames.resolve("/constraintset", named))
        bodies.append(body)
        places.append(pose.apply(numbers_of(file, element, f"location_body_{end}", 3, (0.0, 0.0, 0.0))))
    return PointPair(element.get("name", ""), (bodies[0], bodies[1]), np.array(places))


def _switched_on(file: str, model: Element) -> list[Element]:
    return [e for e in model.findall("ConstraintSet/objects/*") if not _is_off(file, e)]


def _coupler(file: str, element: Element, coordinates: Sequence[str]) -> Coupler:
    dependent = text_of(element, "dependent_coordinate_name")
    of = tuple(text_of(element, "independent_coordinate_names").split())
    unknown = [name for name in (dependent, *of) if name not in coordinates]
    if unknown or not of:
        what = f"names '{unknown[0]}', which is no coordinate of the model" if unknown else "depends on no coordinate"
        raise InputError(file, label(element), what, "correct the model, or switch the constraint off")
    function = next(iter(element.findall("coupled_coordinates_function/*")), None)
    if function is None:
        raise InputError(file, label(element), "holds no function", "correct the model")
    factor = float(numbers_of(file, element, "scale_factor", 1, (1.0,))[0])
    return Coupler(dependent, of, function_of(label(element), file, function, len(of)).scaled(factor))


def _in_order(file: str, couplers: list[Coupler]) -> tuple[Coupler, ...]:
    waiting = {coupler.dependent: coupler for coupler in couplers}
    if len(waiting) < len(couplers):
        raise InputError(file, TAG, "two of them set the same coordinate", "switch one off")
    order: list[Coupler] = []
    while waiting:
        ready = [c for c in waiting.values() if not set(c.of) & set(waiting)]
        if not ready:
            raise InputError(file, TAG, f"{listed(tuple(waiting))} depend on each other in a circle", "switch one off")
        order += ready
        for coupler in ready:
            del waiting[coupler.dependent]
    return tuple(order)


def _is_off(file: str, element: Element) -> bool:
    """OpenSim 3 says isDisabled, OpenSim 4 isEnforced."""
    if element.find("isEnforced") is not None:
        return not is_true(file, element, "isEnforced")
    return is_true(file, element, "isDisabled")
