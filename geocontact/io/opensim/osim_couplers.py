"""Coordinates of an OpenSim model that are functions of others (`CoordinateCouplerConstraint`); other constraints."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from xml.etree.ElementTree import Element

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.model import Coupler
from geocontact.io.opensim.osim_functions import read_function
from geocontact.io.opensim.osim_xml import is_true, label, numbers_of, text_of
from geocontact.io.text.tables import listed

TAG = "CoordinateCouplerConstraint"


def read_couplers(file: str, model: Element, coordinates: Sequence[str]) -> tuple[Coupler, ...]:
    """Couplers that are switched on, in an order in which each follows those it depends on.

    Constraints of other kinds are no part of a tree: a warning names them.
    """
    found = [e for e in model.findall("ConstraintSet/objects/*") if not _is_off(file, e)]
    others = tuple(label(e) for e in found if e.tag != TAG)
    if others:
        message = f"{file}: constraints are not heeded, coordinates they couple move freely: {listed(others)}"
        warnings.warn(InputWarning(message), stacklevel=4)
    return _in_order(file, [_coupler(file, e, coordinates) for e in found if e.tag == TAG])


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
    return Coupler(dependent, of, read_function(file, function, len(of)).scaled(factor))


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
