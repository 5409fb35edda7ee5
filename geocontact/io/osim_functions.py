"""Functions of coordinates in OpenSim models: what moves a transform axis."""

from __future__ import annotations

from collections.abc import Callable
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PPoly
from scipy.linalg import solve_banded

from geocontact.data.errors import InputError
from geocontact.io.osim_xml import label, numbers_of

Function = Callable[[Float[np.ndarray, "t k"]], Float[np.ndarray, " t"]]
"""Values of k coordinates per frame → value per frame."""

_DEEPEST = 8


def constant(value: float) -> Function:
    """The same value whatever the coordinates are."""
    return lambda q: np.full(len(q), value)


def linear(coefficients: Float[np.ndarray, " n"]) -> Function:
    """a·q + b; the coefficients are a_1 … a_k, b."""
    return lambda q: q @ coefficients[:-1] + coefficients[-1]


def polynomial(coefficients: Float[np.ndarray, " n"]) -> Function:
    """Polynomial of one coordinate, highest power first."""
    return lambda q: np.polyval(coefficients, q[:, 0])


def piecewise_linear(x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]) -> Function:
    """Straight between the points, and on in the direction of the outermost pair."""
    slope = np.append(np.diff(y) / np.diff(x), 0.0)
    slope[-1] = slope[-2]

    def value(q: Float[np.ndarray, "t k"]) -> Float[np.ndarray, " t"]:
        i = np.clip(np.searchsorted(x, q[:, 0], side="right") - 1, 0, len(x) - 1)
        return np.asarray(y[i] + (q[:, 0] - x[i]) * slope[i])

    return value


def simm_spline(x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]) -> Function:
    """SIMM's cubic spline: straight outside the points, with the slope at the end.

    Called natural in old files, yet its end condition is that of Forsythe, Malcolm & Moler (1977), Computer Methods
    for Mathematical Computations, sec. 4.4: the third derivative in the first and last interval is that of the cubic
    through the four outermost points (equal curvature at both ends of the interval when there are three points).
    """
    h = np.diff(x)
    slope = np.diff(y) / h
    if len(x) == 2:
        return linear(np.array([slope[0], y[0] - slope[0] * x[0]]))
    curvature = _curvature(x, h, slope)
    rate = np.diff(curvature) / (6.0 * h)
    start = slope - h * (2.0 * curvature[:-1] + curvature[1:]) / 6.0
    spline = PPoly(np.array([rate, curvature[:-1] / 2.0, start, y[:-1]]), x)
    first, last = float(start[0]), float(spline(x[-1], 1))

    def value(q: Float[np.ndarray, "t k"]) -> Float[np.ndarray, " t"]:
        inside = np.clip(q[:, 0], x[0], x[-1])
        beyond = q[:, 0] - inside
        return np.asarray(spline(inside) + beyond * np.where(beyond < 0.0, first, last))

    return value


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


def read_function(file: str, element: Element, arguments: int, depth: int = 0) -> Function:
    """Function in an XML element of `arguments` coordinates; unsupported kinds are refused by name."""
    if element.tag == "Constant":
        return constant(float(numbers_of(file, element, "value", 1, (0.0,))[0]))
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


def _read_polynomial(file: str, element: Element) -> Function:
    coefficients = numbers_of(file, element, "coefficients", None)
    if not len(coefficients):
        raise InputError(file, f"{label(element)} <coefficients>", "no coefficients", "correct the model")
    return polynomial(coefficients)


def _multiplied(file: str, element: Element, arguments: int, depth: int) -> Function:
    scale = float(numbers_of(file, element, "scale", 1, (1.0,))[0])
    inner = next(iter(element.findall("function/*")), None)
    if inner is None:
        raise InputError(file, label(element), "holds no function", "correct the model")
    function = read_function(file, inner, arguments, depth + 1)
    return lambda q: scale * function(q)


def _read_spline(file: str, element: Element) -> Function:
    return simm_spline(*_points(file, element))


def _read_piecewise(file: str, element: Element) -> Function:
    return piecewise_linear(*_points(file, element))


def _points(file: str, element: Element) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    x, y = (numbers_of(file, element, child, None) for child in ("x", "y"))
    if len(x) != len(y) or len(x) < 2 or np.any(np.diff(x) <= 0.0):
        what = f"{len(x)} x and {len(y)} y values"
        raise InputError(file, label(element), what, "two or more points with increasing x are needed")
    return x, y


_OF_ONE_COORDINATE: dict[str, Callable[[str, Element], Function]] = {
    "PolynomialFunction": _read_polynomial,
    "PiecewiseLinearFunction": _read_piecewise,
    "SimmSpline": _read_spline,
    "NaturalCubicSpline": _read_spline,
    "natCubicSpline": _read_spline,
}
