"""How far a pose is from markers, weighted, with gradient and curvature by coordinate; compiled to one function."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.model import Marker
from geocontact.dynamics.buffered import Buffered
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Tree

Vector = Float[np.ndarray, " n"]
Target = tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, " m"], Vector, Vector]
"""Places [m] and weights of the markers, values wanted of the coordinates [rad, m] and their weights."""


class MarkerFit:
    """Half the weighted sum of squares Σ w |x(q) - observed|² + Σ v (q - wanted)², and what a Newton step needs.

    The curvature is exact: markers on skin are centimetres off, and steps after Gauss and Newton shrink slowly there.

    Parameters
    ----------
    tree
        Whose coordinates are sought; nothing changes with those that depend on others.
    markers
        Points on its bodies, m of them.
    """

    def __init__(self, tree: Tree, markers: tuple[Marker, ...]) -> None:
        from casadi import SX, Function, densify, dot, hessian, jacobian, mtimes, reshape, substitute, vertcat

        whole = tree.coupled()
        places = vertcat(*(tree.point(m.body, constant(m.location)) for m in markers))
        places = substitute(places, tree.q, whole) if tree.model.couplers else places
        observed, weights = SX.sym("observed", 3 * len(markers)), SX.sym("weights", len(markers))
        wanted, held = SX.sym("wanted", len(tree.names)), SX.sym("held", len(tree.names))
        each = reshape(mtimes(SX.ones(3, 1), weights.T), -1, 1)
        off, astray = places - observed, whole - wanted
        cost = 0.5 * (dot(each * off, off) + dot(held * astray, astray))
        curvature, gradient = hessian(cost, tree.q)
        arguments = [tree.q, observed, weights, wanted, held]
        self._curvature = Buffered(Function("curvature", arguments, [densify(curvature)]))
        self._slope = Buffered(Function("slope", arguments, [densify(gradient), cost]))
        self._slopes = Buffered(Function("slopes", [tree.q], [densify(jacobian(places, tree.q).T)]))
        self._places = Buffered(Function("places", [tree.q], [densify(places)]))

    def slope(self, q: Vector, against: Target) -> tuple[Vector, float]:
        """Gradient and cost of a pose."""
        gradient, cost = self._slope(q, *against)
        return gradient.copy(), float(cost[0])

    def curvature(self, q: Vector, against: Target) -> Float[np.ndarray, "n n"]:
        """Second derivatives of the cost."""
        return self._curvature(q, *against)[0].reshape(len(q), len(q)).copy()

    def slopes(self, q: Vector) -> Float[np.ndarray, "k n"]:
        """Derivatives of the markers' places by the coordinates, three rows for each marker."""
        return self._slopes(q)[0].reshape(-1, len(q)).copy()

    def places(self, q: Float[np.ndarray, " n"]) -> Float[np.ndarray, "m 3"]:
        """Where the markers are in a pose, in the ground's frame [m]."""
        return np.array(self._places(q)[0]).reshape(-1, 3)
