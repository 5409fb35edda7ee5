"""Exact derivatives of a motion by some parameters, after the motion is known: its variational equations.

x' = f(x, w, p) with x = (q, u, z) has S' = J S + f_p for S = dx/dp, which is linear. `Stepper(by_parameter=True)`
follows the same derivatives through its steps, of whose second derivatives the code is made: for a small model. Here J
and f_p are asked for along the motion, and S is carried by Radau IIA of two stages, third order and L-stable as the
steps are (Hairer & Wanner 1996, Solving ODEs II, sec. IV.5). Nothing is differenced.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.compiled import Buffered
from geocontact.dynamics.equations import Equations, solved
from geocontact.dynamics.symbols import entries

if TYPE_CHECKING:
    from casadi import SX, Function

NODES = (1.0 / 3.0, 1.0)
"""Nodes of an interval, where J and f_p are asked for."""
WEIGHTS = ((5.0 / 12.0, -1.0 / 12.0), (0.75, 0.25))
"""Weights of both nodes in the integral up to each."""
CHUNK = 128
"""Intervals whose linear systems are solved at once."""


def nodes_of(times: Float[np.ndarray, " n1"]) -> Float[np.ndarray, " m"]:
    """Where states and inputs are asked for between times [s], two in each interval."""
    return np.asarray((times[:-1, None] + np.diff(times)[:, None] * np.array(NODES)).ravel())


class Variation:
    """Derivatives by those parameters of some equations whose places in `Equations.p` are named.

    Parameters
    ----------
    machine_code
        Whether J and f_p are machine code.
    """

    def __init__(self, equations: Equations, places: Sequence[int], *, machine_code: bool = True) -> None:
        self.equations, self.places = equations, tuple(places)
        made = _slopes(equations, self.places)
        self.slopes = Buffered(made, compiled=machine_code)

    def along(
        self,
        times: Float[np.ndarray, " n1"],
        x: Float[np.ndarray, "m x"],
        w: Float[np.ndarray, "m w"],
        p: Float[np.ndarray, " p"],
        start: Float[np.ndarray, "x k"],
    ) -> Float[np.ndarray, "n1 x k"]:
        """S at the ends of n intervals, `start` at the first.

        Parameters
        ----------
        times
            Where intervals end [s]: where the steps of the motion do, so that what moves fast is followed.
        x, w
            States and inputs at the intervals' `nodes_of`: m = 2 n.
        """
        count, columns, lasting = len(x) // 2, start.shape[1], np.diff(times)
        s = np.empty((count + 1, x.shape[1], columns))
        s[0] = start
        for first in range(0, count, CHUNK):
            last = min(first + CHUNK, count)
            chosen = slice(2 * first, 2 * last)
            turn, gain = _carried(lasting[first:last], *self._at(x[chosen], w[chosen], p))
            for k in range(first, last):
                s[k + 1] = turn[k - first] @ s[k] + gain[k - first]
        return s

    def tangents(
        self,
        times: Float[np.ndarray, " n1"],
        x: Float[np.ndarray, "m x"],
        w: Float[np.ndarray, "m w"],
        p: Float[np.ndarray, " p"],
    ) -> Float[np.ndarray, "n x x"]:
        """Derivatives of the state at each interval's end by that at its start; given as for `along`."""
        count, lasting, found = len(x) // 2, np.diff(times), []
        for first in range(0, count, CHUNK):
            chosen = slice(2 * first, 2 * min(first + CHUNK, count))
            found.append(_carried(lasting[first : first + CHUNK], *self._at(x[chosen], w[chosen], p))[0])
        return np.concatenate(found)

    def _at(
        self, x: Float[np.ndarray, "m x"], w: Float[np.ndarray, "m w"], p: Float[np.ndarray, " p"]
    ) -> tuple[Float[np.ndarray, "m x x"], Float[np.ndarray, "m x k"]]:
        """J and f_p."""
        n, m = len(self.equations.names), len(x)
        given = (x[:, :n], x[:, n : 2 * n], x[:, 2 * n :], w, np.broadcast_to(p, (m, len(p))))
        mass, pulled, grown = self.slopes.many(*given)
        size, wide = x.shape[1], x.shape[1] + len(self.places)
        both = np.zeros((m, size, wide))
        both[:, np.arange(n), n + np.arange(n)] = 1.0
        rows = np.linalg.solve(_matrices(mass, n), _matrices(pulled, wide))
        both[:, n : 2 * n] = rows
        both[:, 2 * n :] = _matrices(grown, wide)
        return both[:, :, :size], both[:, :, size:]


def _matrices(by_column: Float[np.ndarray, "m nk"], wide: int) -> Float[np.ndarray, "m n k"]:
    return by_column.reshape(len(by_column), wide, by_column.shape[1] // max(wide, 1)).swapaxes(1, 2)


def _carried(
    lasting: Float[np.ndarray, " n"], slope: Float[np.ndarray, "m x x"], push: Float[np.ndarray, "m x k"]
) -> tuple[Float[np.ndarray, "n x x"], Float[np.ndarray, "n x k"]]:
    """What S at an interval's start is multiplied by, and what is added, to be that at its end."""
    size, columns = slope.shape[1], push.shape[2]
    count = len(lasting)
    of, by = slope.reshape(count, 2, size, size), push.reshape(count, 2, size, columns)
    weights = lasting[:, None, None] * np.array(WEIGHTS)
    matrix = np.einsum("nij,njab->niajb", -weights, of).reshape(len(of), 2 * size, 2 * size)
    matrix += np.eye(2 * size)
    gained = np.einsum("nij,njak->niak", weights, by).reshape(len(of), 2 * size, columns)
    held = np.broadcast_to(np.vstack([np.eye(size)] * 2), (len(of), 2 * size, size))
    found = np.linalg.solve(matrix, np.concatenate([held, gained], axis=2))[:, size:]
    return found[:, :, :size], found[:, :, size:]


def _slopes(e: Equations, places: tuple[int, ...]) -> Function:
    """(q, u, z, w, p) to the mass matrix, what the balance changes by with q, u, z and p, and z' likewise."""
    from casadi import Function, densify, horzcat, jacobian, substitute

    mass = e.mass
    start = solved(mass, e.force)
    chosen = entries(e.p, list(places))

    def by(of: SX) -> SX:
        of_p = jacobian(of, e.p)[:, list(places)] if chosen.numel() else jacobian(of, chosen)
        return horzcat(*(jacobian(of, each) for each in (e.q, e.u, e.z)), of_p)

    pulled = substitute(by(e.balance), e.a, start)
    return Function("slopes", e.state, [densify(mass), densify(pulled), densify(by(e.growth))])
