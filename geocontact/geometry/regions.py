"""Choosing faces by where they are and which way they look: "ny > 0.25 and abs(z) < 30"."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from jaxtyping import Bool, Float

from geocontact.geometry.sagittal import Sagittal, Vector
from geocontact.geometry.surface import Surface

Values = Callable[[], Float[np.ndarray, " m"]]


def about(
    surface: Surface, point: Vector, along: Vector | None = None, metres_per_unit: float = 1.0
) -> Mapping[str, Values]:
    """`radial`, distance of a face's centroid from an axis (a point if not `along`), and `outward`.

    `outward` is the cosine between the face's normal and the way from there: the bearing surface of a condyle and the
    back of a cup look outwards (near 1), a box for the bone and the cavity of a cup inwards (near -1).
    """

    def offset() -> Float[np.ndarray, "m 3"]:
        way = _centroids(surface) - np.asarray(point)
        if along is None:
            return np.asarray(way)
        unit = np.asarray(along, float) / np.linalg.norm(along)
        return np.asarray(way - (way @ unit)[:, None] * unit)

    def radial() -> Float[np.ndarray, " m"]:
        return np.asarray(np.linalg.norm(offset(), axis=1) / metres_per_unit)

    def outward() -> Float[np.ndarray, " m"]:
        way = offset()
        size = np.maximum(np.linalg.norm(way, axis=1), 1e-300)
        return np.asarray(np.einsum("ij,ij->i", way, surface.face_normal) / size)

    return {"radial": radial, "outward": outward}


def about_flexion(surface: Surface, sagittal: Sagittal) -> Mapping[str, Values]:
    """`flexion`, angle at which a face's centroid lies [deg]."""
    return {"flexion": lambda: np.degrees(sagittal.angle(_centroids(surface)))}


def about_other(surface: Surface, other: Surface, metres_per_unit: float = 1.0) -> Mapping[str, Values]:
    """`distance` of a face's centroid to another body, negative inside a closed one."""
    return {"distance": lambda: np.asarray(other.proximity(_centroids(surface)).distance / metres_per_unit)}


def _centroids(surface: Surface) -> Float[np.ndarray, "m 3"]:
    return np.asarray(surface.vertices[surface.faces].mean(axis=1))


NAMES = ("x", "y", "z", "nx", "ny", "nz")
Value = np.ndarray

_COMPARE: Mapping[type, Callable[[Value, Value], Value]] = {
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
}
_COMBINE: Mapping[type, Callable[[Value, Value], Value]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_FUNCTIONS: Mapping[str, Callable[[Value], Value]] = {"abs": np.abs, "sqrt": np.sqrt}


def faces_where(
    surface: Surface,
    expression: str,
    metres_per_unit: float = 1.0,
    more: Mapping[str, Callable[[], Float[np.ndarray, " m"]]] = MappingProxyType({}),
) -> Bool[np.ndarray, " m"]:
    """Faces for which the expression holds.

    Parameters
    ----------
    expression
        Comparisons in x y z (face centroid) and nx ny nz (unit normal), both in the surface's frame, combined with
        `and`, `or`, `not`, + - * / **, abs, sqrt and parentheses.
    metres_per_unit
        Length unit of x, y, z: 1e-3 when the expression is in mm.
    more
        Further names and what gives their value for each face, called only where the expression has the name; see
        `geometry.regions`. What it raises as `ValueError` is passed on.

    Raises
    ------
    ValueError
        The expression cannot be read, or does not say yes or no for each face.

    Examples
    --------
    >>> import geocontact as gc
    >>> ball = gc.read_surface("meshes/sphere_r20.stl", "mm")
    >>> upper = gc.faces_where(ball, "y > 0", metres_per_unit=1e-3)
    >>> int(upper.sum()), len(ball.faces)
    (1416, 2880)
    """
    try:
        tree = ast.parse(expression.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ValueError(f"{expression!r} cannot be read; write for example ny>0.25 and abs(z)<30") from None
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    centroid = surface.vertices[surface.faces].mean(axis=1) / metres_per_unit
    values = dict(zip(NAMES, [*centroid.T, *surface.face_normal.T], strict=True))
    values |= {name: compute() for name, compute in more.items() if name in used}
    try:
        with np.errstate(all="ignore"):
            chosen = _evaluate(tree.body, values, (*NAMES, *more))
    except (ArithmeticError, RecursionError, MemoryError):
        raise ValueError(f"{expression!r} cannot be computed; write for example ny>0.25") from None
    if not used & {*NAMES, *more} or chosen.dtype != bool or chosen.shape != (len(surface.faces),):
        raise ValueError(f"{expression!r} is not a condition on the faces; write for example ny>0.25")
    return chosen


def _evaluate(node: ast.expr, values: Mapping[str, Float[np.ndarray, " m"]], names: tuple[str, ...]) -> Value:
    def of(part: ast.expr) -> Value:
        return _evaluate(part, values, names)

    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return np.full(len(values["x"]), _finite(number))
        case ast.Name(id=name) if name in values:
            return values[name]
        case ast.BoolOp(op=op, values=parts):
            both = [_condition(of(part)) for part in parts]
            return np.asarray(np.logical_and.reduce(both) if isinstance(op, ast.And) else np.logical_or.reduce(both))
        case ast.UnaryOp(op=ast.Not(), operand=inner):
            return ~_condition(of(inner))
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_number(of(inner))
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _COMBINE:
            return _COMBINE[type(op)](_number(of(left)), _number(of(right)))
        case ast.Call(func=ast.Name(id=name), args=[inner], keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_number(of(inner)))
        case ast.Compare(left=left, ops=ops, comparators=rest) if all(type(op) in _COMPARE for op in ops):
            terms = [_number(of(term)) for term in (left, *rest)]
            pairs = zip(ops, terms, terms[1:], strict=False)
            return np.asarray(np.logical_and.reduce([np.asarray(_COMPARE[type(op)](a, b)) for op, a, b in pairs]))
    raise ValueError(
        f"{ast.unparse(node)!r} is not understood; only {', '.join(names)}, numbers, and/or/not, abs, sqrt"
    )


def _finite(number: int | float) -> float:
    value = float(number)
    if not np.isfinite(value):
        raise ValueError(f"{number!r} is not a finite number")
    return value


def _condition(value: Value) -> Bool[np.ndarray, " m"]:
    if value.dtype != bool:
        raise ValueError("and, or, not join conditions such as ny>0.25")
    return value


def _number(value: Value) -> Value:
    if value.dtype == bool:
        raise ValueError("a condition cannot be used as a number; join conditions with and, or")
    return value
