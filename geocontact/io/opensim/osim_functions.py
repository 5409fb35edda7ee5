"""Functions of coordinates in OpenSim models: what moves a transform axis."""

from __future__ import annotations

from collections.abc import Callable
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float
from scipy.linalg import solve_banded

from geocontact.data.errors import InputError
from geocontact.data.multibody.joint_function import Affine, JointFunction, Piecewise
from geocontact.io.opensim.osim_xml import label, numbers_of

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
    """Function in an XML element of `arguments` coordinates; what is wrong with it is told with its owner's name."""
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
