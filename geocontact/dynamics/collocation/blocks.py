"""A sparse problem out of many equal pieces: one function of symbols, mapped over the places where it stands.

Derivatives are taken of the small function and set into the large matrices by constant index maps: exact, and as fast
as its expression. Second derivatives of pieces that share a variable are added.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

if TYPE_CHECKING:
    from casadi import DM, MX, SX, Function


@dataclass(frozen=True, eq=False)
class BlockFunctions:
    """A piece of a problem and its derivatives, at one place.

    Parameters
    ----------
    rows
        How many constraints it has.
    cost, constraints
        (variables, data) to each.
    gradient, jacobian
        (variables, data) to the cost and its slope, to the constraints and entries of their first derivatives.
    hessian
        (variables, data, multipliers) to entries of the Lagrangian's second derivatives, upper half.
    patterns
        Rows and columns of both kinds of entries.
    """

    rows: int
    cost: Function
    constraints: Function
    gradient: Function
    jacobian: Function
    hessian: Function
    patterns: tuple[Int[np.ndarray, "2 _"], Int[np.ndarray, "2 _"]]


def block_functions(
    variables: SX, data: SX, cost: SX, constraints: SX, held: Bool[np.ndarray, " v"] | None = None
) -> BlockFunctions:
    """Functions of expressions of the problem's variables and of numbers of each place.

    What stands several times in the expressions is worked out once, in their derivatives too.

    Parameters
    ----------
    held
        Variables by which nothing is derived: slopes by them are given as 0, and no entry is theirs. None by default.
    """
    from casadi import SX, Function, cse, densify, gradient, hessian, jacobian, triu

    cost, constraints = cse([cost, constraints])
    rows, count = constraints.numel(), variables.numel()
    moves = np.arange(count) if held is None else np.flatnonzero(~held)
    moving = variables[moves.tolist(), :]
    multipliers = SX.sym("multipliers", 1 + rows)
    lagrangian = multipliers[0] * cost + (multipliers[1:].T @ constraints if rows else 0.0)
    by = jacobian(constraints, moving)
    twice = triu(hessian(lagrangian, moving)[0])
    slope = SX(count, 1)
    slope[moves.tolist(), :] = gradient(cost, moving)
    first, second = (np.array(each.sparsity().get_triplet(), int) for each in (by, twice))
    given = [variables, data]
    return BlockFunctions(
        rows,
        Function("cost", given, [densify(cost)]),
        Function("constraints", given, [densify(constraints)]),
        Function("gradient", given, [densify(cost), densify(slope)]),
        Function("jacobian", given, [densify(constraints), _nonzeros(by)]),
        Function("hessian", [*given, multipliers], [_nonzeros(twice)]),
        (np.stack([first[0], moves[first[1]]]), moves[second]),
    )


@dataclass(frozen=True)
class ProgramBlock:
    """A piece of a problem and where it stands.

    Parameters
    ----------
    functions
        What it adds to the cost, and what is held between `lower` and `upper`.
    index
        Which of the problem's variables its own are, a column for each place, none twice in a column.
    values
        The data, a column for each place.
    lower, upper
        One for each constraint.
    """

    functions: BlockFunctions
    index: Int[np.ndarray, "v m"]
    values: Float[np.ndarray, "d m"]
    lower: Float[np.ndarray, " c"]
    upper: Float[np.ndarray, " c"]

    @property
    def places(self) -> int:
        """How many there are."""
        return int(self.index.shape[1])


@dataclass(frozen=True)
class SparseProgram:
    """Cost and constraints of z and their derivatives.

    Parameters
    ----------
    size
        Number of variables.
    value
        (z, -) to cost and constraints.
    gradient, jacobian, hessian
        As the solver takes them: with the values; of z and the multipliers of cost and constraints, upper half.
    lower, upper
        Of the constraints.
    """

    size: int
    value: Function
    gradient: Function
    jacobian: Function
    hessian: Function
    lower: Float[np.ndarray, " c"]
    upper: Float[np.ndarray, " c"]

    def at_minimum(
        self,
        z: Float[np.ndarray, " z"],
        of_bounds: Float[np.ndarray, " z"],
        of_rows: Float[np.ndarray, " c"],
        bounds: tuple[Float[np.ndarray, " z"], Float[np.ndarray, " z"]],
        tolerance: float,
    ) -> bool:
        """Whether the conditions of a minimum hold to the tolerance and what the last digit of z changes.

        A variable that is known to a part ε of itself leaves |L_zz| |z| ε of the Lagrangian's slope (first-order
        analysis of rounding; Higham 2002, Accuracy and Stability of Numerical Algorithms, 1.6). Where the force of a
        contact rises steeply that is 1e-8 of the scaled problem.

        Parameters
        ----------
        of_bounds, of_rows
            Multipliers.
        bounds
            Least and greatest z.
        """
        rows, by = (each.sparse() for each in self.jacobian(z, []))
        half = self.hessian(z, [], 1.0, of_rows).sparse()
        whole = abs(half + half.T).tolil()
        whole.setdiag(abs(half.diagonal()))
        slope = np.array(self.gradient(z, [])[1]).ravel() + by.T @ of_rows + of_bounds
        stationary = np.abs(slope) <= tolerance + np.finfo(float).eps * (whole @ np.abs(z))
        moves, reached = bounds[0] < bounds[1], rows.toarray().ravel()
        away = np.where(of_bounds > 0.0, bounds[1] - z, z - bounds[0])
        idle = np.abs(of_bounds) * np.where(np.isfinite(away), away, 0.0) <= tolerance
        missed = max((self.lower - reached).max(initial=0.0), (reached - self.upper).max(initial=0.0))
        return bool(stationary[moves].all() and idle[moves].all() and missed <= tolerance)


def sparse_program(blocks: Sequence[ProgramBlock], size: int) -> SparseProgram:
    """The blocks' costs added and their constraints one after the other."""
    from casadi import MX, Function, vertcat

    z, none, lam_f = MX.sym("z", size), MX.sym("none", 0), MX.sym("lam_f")
    pieces = [_Piece(block, z) for block in blocks]
    count = sum(piece.rows for piece in pieces)
    lam_g = MX.sym("lam_g", count)
    slope, costs, rows, first = MX.zeros(size, 1), [MX(0), MX(0)], list[tuple[MX, MX]](), 0
    jacobian, hessian = _Entries(), _Entries()
    for piece in pieces:
        beside_slope, own_slope = piece.gradient(size)
        beside_jacobian, entries = piece.jacobian(first)
        costs = [costs[0] + piece.cost(), costs[1] + beside_slope]
        rows.append((piece.constraints(), beside_jacobian))
        slope = slope + own_slope
        jacobian.add(*entries)
        hessian.add(*piece.hessian(lam_f, lam_g[first : first + piece.rows]))
        first += piece.rows
    g = [vertcat(*each) for each in zip(*rows, strict=True)]
    return SparseProgram(
        size,
        Function("nlp", [z, none], [costs[0], g[0]], ["x", "p"], ["f", "g"]),
        Function("nlp_grad_f", [z, none], [costs[1], slope], ["x", "p"], ["f", "grad:f:x"]),
        Function("nlp_jac_g", [z, none], [g[1], jacobian.matrix(count, size)], ["x", "p"], ["g", "jac:g:x"]),
        Function(
            "nlp_hess_l",
            [z, none, lam_f, lam_g],
            [hessian.matrix(size, size)],
            ["x", "p", "lam:f", "lam:g"],
            ["triu:hess:gamma:x:x"],
        ),
        np.concatenate([np.tile(b.lower, b.places) for b in blocks]),
        np.concatenate([np.tile(b.upper, b.places) for b in blocks]),
    )


class _Entries:
    """Entries of a matrix, of which some may stand at one place: they are added."""

    def __init__(self) -> None:
        self.rows: list[Int[np.ndarray, " n"]] = []
        self.columns: list[Int[np.ndarray, " n"]] = []
        self.values: list[MX] = []

    def add(self, rows: Int[np.ndarray, " n"], columns: Int[np.ndarray, " n"], values: MX) -> None:
        self.rows.append(rows)
        self.columns.append(columns)
        self.values.append(values)

    def matrix(self, height: int, width: int) -> MX:
        from casadi import MX, Sparsity, mtimes, vertcat

        key = np.concatenate(self.columns) * height + np.concatenate(self.rows)
        places, first, which = np.unique(key, return_index=True, return_inverse=True)
        begins = np.searchsorted(places, height * np.arange(width + 1))
        pattern = Sparsity(height, width, begins.tolist(), (places % height).tolist())
        values, further = vertcat(*self.values), np.delete(np.arange(len(key)), first)
        entries = values[first.tolist()]
        if len(further):
            entries = entries + mtimes(_sums(which[further], len(places)), values[further.tolist()])
        return MX(pattern, entries)


def _sums(which: Int[np.ndarray, " n"], count: int) -> DM:
    """What adds each of n entries to one of `count`: a 1 in every column."""
    from casadi import DM, Sparsity

    return DM.ones(Sparsity(count, len(which), list(range(len(which) + 1)), which.tolist()))


class _Piece:
    """A block's functions mapped over its places, of the problem's variables."""

    def __init__(self, block: ProgramBlock, z: MX) -> None:
        b = self.block = block
        self.rows = b.functions.rows * b.places
        self.own = z[b.index.ravel(order="F").tolist()].reshape((b.index.shape[0], b.places))
        self.data: DM | Float[np.ndarray, "d m"] = b.values

    def cost(self) -> MX:
        from casadi import sum2

        return sum2(self.block.functions.cost.map(self.block.places)(self.own, self.data))

    def constraints(self) -> MX:
        from casadi import vec

        return vec(self.block.functions.constraints.map(self.block.places)(self.own, self.data))

    def gradient(self, size: int) -> tuple[MX, MX]:
        """Cost and its slope."""
        from casadi import mtimes, sum2, vec

        cost, slope = self.block.functions.gradient.map(self.block.places)(self.own, self.data)
        return sum2(cost), mtimes(_sums(self.block.index.ravel(order="F"), size), vec(slope))

    def jacobian(self, first: int) -> tuple[MX, tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"], MX]]:
        """Constraints; rows and columns of their first derivatives, and entries."""
        from casadi import vec

        b = self.block
        rows, columns = b.functions.patterns[0]
        each = first + b.functions.rows * np.arange(b.places)
        where = (rows[:, None] + each).ravel(order="F"), b.index[columns].ravel(order="F")
        found, entries = b.functions.jacobian.map(b.places)(self.own, self.data)
        return vec(found), (*where, vec(entries))

    def hessian(self, lam_f: MX, lam_g: MX) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"], MX]:
        from casadi import repmat, vec, vertcat

        b = self.block
        multipliers = vertcat(repmat(lam_f, 1, b.places), lam_g.reshape((b.functions.rows, b.places)))
        ends = np.stack([b.index[k].ravel(order="F") for k in b.functions.patterns[1]])
        found = b.functions.hessian.map(b.places)(self.own, self.data, multipliers)
        return ends.min(axis=0), ends.max(axis=0), vec(found)


def _nonzeros(matrix: SX) -> SX:
    """Entries of a matrix in a column, in the order of its pattern."""
    column: SX = matrix.nz[:]
    return column
