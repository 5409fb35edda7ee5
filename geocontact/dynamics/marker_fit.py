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


TIGHT = 1e3
"""Times more than all markers together that points of a constraint count: a tenth of a millimetre or less apart."""


class MarkerFit:
    """Half the weighted sum of squares Σ w |x(q) - observed|² + Σ v (q - wanted)², and what a Newton step needs.

    The curvature is exact: markers on skin are centimetres off, and steps after Gauss and Newton shrink slowly there.

    Parameters
    ----------
    tree
        Whose coordinates are sought; nothing changes with those that depend on others.
    markers
        Points on its bodies, m of them.

    Points that the model's constraints keep together count `TIGHT` times as much as all markers.
    """

    def __init__(self, tree: Tree, markers: tuple[Marker, ...]) -> None:
        from casadi import SX, Function, densify, dot, hessian, jacobian, mtimes, reshape, substitute, sum1, vertcat

        whole = tree.coupled()

        def point(body: str, place: Float[np.ndarray, " 3"]) -> SX:
            at = tree.point(body, constant(place))
            return substitute(at, tree.q, whole) if tree.model.couplers else at

        places = vertcat(*(point(m.body, m.location) for m in markers))
        observed, weights = SX.sym("observed", 3 * len(markers)), SX.sym("weights", len(markers))
        wanted, held = SX.sym("wanted", len(tree.names)), SX.sym("held", len(tree.names))
        each = reshape(mtimes(SX.ones(3, 1), weights.T), -1, 1)
        off, astray = places - observed, whole - wanted
        gaps = vertcat(SX(0, 1), *(point(*pair.ends(0)) - point(*pair.ends(1)) for pair in tree.model.pairs))
        tight = TIGHT * sum1(weights) * dot(gaps, gaps)
        cost = 0.5 * (dot(each * off, off) + dot(held * astray, astray) + tight)
        curvature, gradient = hessian(cost, tree.q)
        arguments = [tree.q, observed, weights, wanted, held]
        self._curvature = Buffered(Function("curvature", arguments, [densify(curvature)]))
        self._slope = Buffered(Function("slope", arguments, [densify(gradient), cost]))
        self._slopes = Buffered(Function("slopes", [tree.q], [densify(jacobian(places, tree.q).T)]))
        ties = Function("ties", [tree.q], [densify(jacobian(gaps, tree.q).T)])
        self._ties = Buffered(ties) if tree.model.pairs else None
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

    def ties(self, q: Vector) -> Float[np.ndarray, "k n"]:
        """Derivatives of the distances that constraints keep at zero, three rows for each pair of points."""
        return np.zeros((0, len(q))) if self._ties is None else self._ties(q)[0].reshape(-1, len(q)).copy()

    def places(self, q: Float[np.ndarray, " n"]) -> Float[np.ndarray, "m 3"]:
        """Where the markers are in a pose, in the ground's frame [m]."""
        return np.array(self._places(q)[0]).reshape(-1, 3)
