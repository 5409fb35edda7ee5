"""Equations of motion of a tree: coordinates that are free, driven or prescribed, loads, and laws with memory.

Free coordinates move by the loads alone, driven ones have a force along them besides (a motor, a spring), prescribed
ones follow a course that is given with its rates and accelerations. One model may have all three.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from geocontact.dynamics.inverse_dynamics import Wrenches, generalised_forces
from geocontact.dynamics.symbols import entries
from geocontact.dynamics.tree import Tree

if TYPE_CHECKING:
    from casadi import SX, Function


@dataclass(frozen=True)
class LawState:
    """A law's own state.

    Parameters
    ----------
    symbol
        A scalar that the loads may depend on.
    growth
        Its derivative in time.
    """

    symbol: SX
    growth: SX


@dataclass(frozen=True)
class Equations:
    """`balance` = 0 and z' = `growth`, in columns of symbols.

    Parameters
    ----------
    names
        Coordinates that are found, n of them.
    q, u, a
        Their values, rates and accelerations [rad, m, s].
    z
        Memory of the laws.
    w
        Inputs over time: values of the prescribed coordinates, their rates, their accelerations, then what else was
        named as an input.
    p
        Parameters.
    balance
        What acts along each coordinate less what the motion needs [N m, N], linear in `a`.
    growth
        z' of (q, u, z, w, p).
    """

    names: tuple[str, ...]
    q: SX
    u: SX
    a: SX
    z: SX
    w: SX
    p: SX
    balance: SX
    growth: SX

    @property
    def state(self) -> list[SX]:
        """What a state and its surroundings are: arguments of the functions made of these equations."""
        return [self.q, self.u, self.z, self.w, self.p]

    @property
    def mass(self) -> SX:
        """Mass matrix of the coordinates that are found, (n, n)."""
        from casadi import jacobian, tril, tril2symm

        return tril2symm(tril(-jacobian(self.balance, self.a)))  # both halves are equal, their zeros may differ

    @property
    def force(self) -> SX:
        """What accelerates them, (n,): mass times `a` in motion."""
        from casadi import SX, substitute

        return substitute(self.balance, self.a, SX.zeros(self.a.shape))

    def accelerations(self) -> Function:
        """(q, u, z, w, p) to accelerations."""
        from casadi import Function, densify

        return Function("accelerations", self.state, [densify(solved(self.mass, self.force))])


def equations_of_motion(
    tree: Tree,
    *,
    loads: Wrenches | None = None,
    along: Mapping[str, SX] | None = None,
    prescribed: Sequence[str] = (),
    memory: Sequence[LawState] = (),
    inputs: Sequence[SX] = (),
    parameters: Sequence[SX] = (),
) -> Equations:
    """Equations of the coordinates that are not prescribed.

    Parameters
    ----------
    loads
        On bodies by name: force and moment about the ground's origin, of the tree's symbols, memory, inputs and
        parameters.
    along
        Forces of motors and springs along coordinates by name [N m, N], of the same.
    prescribed
        Coordinates whose course is an input. ValueError for a name that the tree does not have.
    memory, inputs, parameters
        Symbols that loads depend on.
    """
    from casadi import SX, vertcat

    driven = dict(along or {})
    unknown = (set(prescribed) | set(driven)) - set(tree.names)
    if unknown:
        raise ValueError(f"there is no coordinate {min(unknown)}; coordinates are {', '.join(tree.names)}")
    free = [k for k, name in enumerate(tree.names) if name not in prescribed]
    given = [tree.names.index(name) for name in prescribed]
    acting = vertcat(*(driven.get(name, SX(0)) for name in tree.names))
    balance = entries(acting - generalised_forces(tree, loads), free)
    z = vertcat(*(each.symbol for each in memory)) if memory else SX(0, 1)
    growth = vertcat(*(each.growth for each in memory)) if memory else SX(0, 1)
    courses = (entries(each, given) for each in (tree.q, tree.u, tree.a))
    w = vertcat(*courses, *inputs)
    p = vertcat(*parameters) if parameters else SX(0, 1)
    names = tuple(tree.names[k] for k in free)
    q, u, a = (entries(each, free) for each in (tree.q, tree.u, tree.a))
    return Equations(names, q, u, a, z, w, p, balance, growth)


def solved(mass: SX, force: SX) -> SX:
    """Accelerations, by L D Lᵀ."""
    from casadi import ldl, ldl_solve

    diagonal, factor, order = ldl(mass)
    return ldl_solve(force, diagonal, factor, order)
