"""Functions of coordinates in OpenSim models: of transform axes, and of coordinates that follow others."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float
from scipy.linalg import solve_banded

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.joint import Affine, JointFunction, Piecewise
from geocontact.data.multibody.model import Coupler, PointPair
from geocontact.io.opensim.osim_xml import Frames, is_true, label, numbers_of, socket_of, text_of
from geocontact.io.text.tables import listed

_DEEPEST = 8


def constant(value: float, arguments: int = 0) -> Affine:
    """The same value whatever the coordinates are."""
    return Affine(np.zeros(arguments), value)


def linear(coefficients: Float[np.ndarray, " n"]) -> Affine:
    """a·q + b; the coefficients are a_1 … a_k, b."""
    return Affine(coefficients[:-1], float(coefficients[-1]))


def polynomial(coefficients: Float[np.ndarray, " n"]) -> Piecewise:
    """Polynomial of one coordinate, highest power first."""
    return Piecewise(np.zeros(0), np.zeros(1), coefficients[None, :])


def piecewise_linear(x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]) -> Piecewise:
    """Straight between the points, and on in the direction of the outermost pair."""
    return Piecewise(x[1:-1], x[:-1], np.column_stack([np.diff(y) / np.diff(x), y[:-1]]))


def simm_spline(x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]) -> Piecewise:
    """SIMM's cubic spline: straight outside the points, with the slope at the end.

    Called natural in old files, yet its end condition is that of Forsythe, Malcolm & Moler (1977), Computer Methods
    for Mathematical Computations, sec. 4.4: the third derivative in the first and last interval is that of the cubic
    through the four outermost points (equal curvature at both ends of the interval when there are three points).
    """
    h = np.diff(x)
    slope = np.diff(y) / h
    if len(x) == 2:
        return piecewise_linear(x, y)
    curvature = _curvature(x, h, slope)
    rate = np.diff(curvature) / (6.0 * h)
    start = slope - h * (2.0 * curvature[:-1] + curvature[1:]) / 6.0
    inner = np.column_stack([rate, curvature[:-1] / 2.0, start, y[:-1]])
    end = float(start[-1] + h[-1] * (curvature[-2] + curvature[-1]) / 2.0)
    before, after = [0.0, 0.0, float(start[0]), float(y[0])], [0.0, 0.0, end, float(y[-1])]
    return Piecewise(x, np.append(x[0], x), np.vstack([before, inner, after]))


def _curvature(
    x: Float[np.ndarray, " n"], h: Float[np.ndarray, " m"], slope: Float[np.ndarray, " m"]
) -> Float[np.ndarray, " n"]:
    """Second derivatives at the points, from the tridiagonal system of a C² cubic spline."""
    n = len(x)
    bands, right = np.zeros((3, n)), np.zeros(n)
    bands[0, 1:], bands[2, :-1] = h, h
    bands[1, 1:-1] = 2.0 * (h[:-1] + h[1:])
    bands[1, 0], bands[1, -1] = -h[0], -h[-1]
    right[1:-1] = 6.0 * np.diff(slope)
    if n > 3:
        second = np.diff(slope) / (x[2:] - x[:-2])
        right[0] = 6.0 * h[0] ** 2 * (second[1] - second[0]) / (x[3] - x[0])
        right[-1] = -6.0 * h[-1] ** 2 * (second[-1] - second[-2]) / (x[-1] - x[-4])
    return np.asarray(solve_banded((1, 1), bands, right), dtype=float)


def function_of(owner: str, file: str, element: Element, arguments: int) -> JointFunction:
    """Function in an XML element of `arguments` coordinates; what is wrong with it is refused with its owner's name."""
    try:
        return read_function(file, element, arguments)
    except InputError as error:
        raise InputError(error.file, f"{owner} {error.place}", error.what, error.remedy) from None


def read_function(file: str, element: Element, arguments: int, depth: int = 0) -> JointFunction:
    """Function in an XML element of `arguments` coordinates; unsupported kinds are refused by name."""
    if element.tag == "Constant":
        return constant(float(numbers_of(file, element, "value", 1, (0.0,))[0]), arguments)
    if element.tag == "LinearFunction":
        return linear(numbers_of(file, element, "coefficients", arguments + 1, (1.0, 0.0) if arguments == 1 else None))
    if element.tag == "MultiplierFunction" and depth < _DEEPEST:
        return _multiplied(file, element, arguments, depth)
    if element.tag not in _OF_ONE_COORDINATE:
        names = ", ".join(["Constant", "LinearFunction", "MultiplierFunction", *_OF_ONE_COORDINATE])
        raise InputError(file, label(element), "this kind of function is not supported", f"supported: {names}")
    if arguments != 1:
        raise InputError(file, label(element), f"takes one coordinate, {arguments} are named", "correct the model")
    return _OF_ONE_COORDINATE[element.tag](file, element)


def _read_polynomial(file: str, element: Element) -> JointFunction:
    coefficients = numbers_of(file, element, "coefficients", None)
    if not len(coefficients):
        raise InputError(file, f"{label(element)} <coefficients>", "no coefficients", "correct the model")
    return polynomial(coefficients)


def _multiplied(file: str, element: Element, arguments: int, depth: int) -> JointFunction:
    scale = float(numbers_of(file, element, "scale", 1, (1.0,))[0])
    inner = next(iter(element.findall("function/*")), None)
    if inner is None:
        raise InputError(file, label(element), "holds no function", "correct the model")
    return read_function(file, inner, arguments, depth + 1).scaled(scale)


def _read_spline(file: str, element: Element) -> JointFunction:
    return simm_spline(*_points(file, element))


def _read_piecewise(file: str, element: Element) -> JointFunction:
    return piecewise_linear(*_points(file, element))


def _points(file: str, element: Element) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    x, y = (numbers_of(file, element, child, None) for child in ("x", "y"))
    if len(x) != len(y) or len(x) < 2 or np.any(np.diff(x) <= 0.0):
        what = f"{len(x)} x and {len(y)} y values"
        raise InputError(file, label(element), what, "two or more points with increasing x are needed")
    return x, y


_OF_ONE_COORDINATE: dict[str, Callable[[str, Element], JointFunction]] = {
    "PolynomialFunction": _read_polynomial,
    "PiecewiseLinearFunction": _read_piecewise,
    "SimmSpline": _read_spline,
    "NaturalCubicSpline": _read_spline,
    "natCubicSpline": _read_spline,
}


TAG, PAIR = "CoordinateCouplerConstraint", "PointConstraint"


def read_couplers(file: str, model: Element, coordinates: Sequence[str]) -> tuple[Coupler, ...]:
    """Couplers that are switched on, in an order in which each follows those it depends on.

    Constraints of other kinds, but for pairs of points, are no part of a tree: a warning names them.
    """
    found = _switched_on(file, model)
    others = tuple(label(e) for e in found if e.tag not in (TAG, PAIR))
    if others:
        message = f"{file}: constraints are ignored, coordinates they couple move freely: {listed(others)}"
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
        what = (
            f"names '{unknown[0]}', which is not a coordinate of the model" if unknown else "depends on no coordinate"
        )
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
