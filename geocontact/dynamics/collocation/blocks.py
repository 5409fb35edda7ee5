"""A sparse problem out of many equal pieces: one function of symbols, mapped over the places where it stands.

Derivatives are taken of the small function and set into the large matrices by constant index maps: exact, and as fast
as its expression. Second derivatives of pieces that share a variable are added.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

if TYPE_CHECKING:
    from casadi import DM, MX, SX, Function


@dataclass(frozen=True)
class ProgramBlock:
    """A piece of a problem and where it stands.

    Parameters
    ----------
    variables, data
        Symbols: of the problem's variables, and of numbers of each place.
    cost, constraints
        What it adds to the cost, and what is held between `lower` and `upper`.
    index
        Which of the problem's variables its own are, a column for each place, none twice in a column.
    values
        The data, a column for each place.
    lower, upper
        One for each constraint.
    """

    variables: SX
    data: SX
    cost: SX
    constraints: SX
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


def sparse_program(blocks: Sequence[ProgramBlock], size: int) -> SparseProgram:
    """The blocks' costs added and their constraints one after the other."""
    from casadi import MX, Function, vertcat

    z, none, lam_f = MX.sym("z", size), MX.sym("none", 0), MX.sym("lam_f")
    pieces = [_Piece(block, z) for block in blocks]
    count = sum(piece.rows for piece in pieces)
    lam_g = MX.sym("lam_g", count)
    cost, slope, rows, first = MX(0), MX.zeros(size, 1), [], 0
    jacobian, hessian = _Entries(), _Entries()
    for piece in pieces:
        own_cost, own_rows = piece.value()
        cost = cost + own_cost
        rows.append(own_rows)
        slope = slope + piece.gradient(size)
        jacobian.add(*piece.jacobian(first))
        hessian.add(*piece.hessian(lam_f, lam_g[first : first + piece.rows]))
        first += piece.rows
    g = vertcat(*rows)
    return SparseProgram(
        size,
        Function("nlp", [z, none], [cost, g], ["x", "p"], ["f", "g"]),
        Function("nlp_grad_f", [z, none], [cost, slope], ["x", "p"], ["f", "grad:f:x"]),
        Function("nlp_jac_g", [z, none], [g, jacobian.matrix(count, size)], ["x", "p"], ["g", "jac:g:x"]),
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
        from casadi import DM, MX, Sparsity, mtimes, vertcat

        key = np.concatenate(self.columns) * height + np.concatenate(self.rows)
        places, which = np.unique(key, return_inverse=True)
        pattern = Sparsity.triplet(height, width, (places % height).tolist(), (places // height).tolist())
        sums = DM.triplet(which.tolist(), list(range(len(which))), DM.ones(len(which)), len(places), len(which))
        return MX(pattern, mtimes(sums, vertcat(*self.values)))


class _Piece:
    """A block's functions mapped over its places, of the problem's variables."""

    def __init__(self, block: ProgramBlock, z: MX) -> None:
        from casadi import SX, Function, densify, gradient, hessian, jacobian, triu, vertcat

        b = self.block = block
        self.rows = b.constraints.numel() * b.places
        self.own = z[b.index.ravel(order="F").tolist()].reshape((b.index.shape[0], b.places))
        self.data: DM | Float[np.ndarray, "d m"] = b.values
        multipliers = SX.sym("multipliers", 1 + b.constraints.numel())
        lagrangian = multipliers[0] * b.cost + (multipliers[1:].T @ b.constraints if self.rows else 0.0)
        by = jacobian(b.constraints, b.variables)
        twice = triu(hessian(lagrangian, b.variables)[0])
        self.patterns = [tuple(np.array(k, int) for k in each.sparsity().get_triplet()) for each in (by, twice)]
        given = [b.variables, b.data]
        outputs = [densify(b.cost), densify(b.constraints)]
        self._value = Function("value", given, outputs).map(b.places)
        self._gradient = Function("gradient", given, [densify(gradient(b.cost, b.variables))]).map(b.places)
        self._jacobian = Function("jacobian", given, [_nonzeros(by)]).map(b.places)
        self._hessian = Function("hessian", [*given, multipliers], [_nonzeros(twice)]).map(b.places)
        self._vertcat = vertcat

    def value(self) -> tuple[MX, MX]:
        from casadi import sum2, vec

        cost, rows = self._value(self.own, self.data)
        return sum2(cost), vec(rows)

    def gradient(self, size: int) -> MX:
        from casadi import DM, mtimes, vec

        index = self.block.index.ravel(order="F")
        sums = DM.triplet(index.tolist(), list(range(len(index))), DM.ones(len(index)), size, len(index))
        return mtimes(sums, vec(self._gradient(self.own, self.data)))

    def jacobian(self, first: int) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"], MX]:
        from casadi import vec

        rows, columns = self.patterns[0]
        each = first + self.block.constraints.numel() * np.arange(self.block.places)
        where = (rows[:, None] + each).ravel(order="F"), self.block.index[columns].ravel(order="F")
        return *where, vec(self._jacobian(self.own, self.data))

    def hessian(self, lam_f: MX, lam_g: MX) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"], MX]:
        from casadi import repmat, vec

        b = self.block
        own = lam_g.reshape((b.constraints.numel(), b.places))
        multipliers = self._vertcat(repmat(lam_f, 1, b.places), own)
        ends = np.stack([b.index[k].ravel(order="F") for k in self.patterns[1]])
        return ends.min(axis=0), ends.max(axis=0), vec(self._hessian(self.own, self.data, multipliers))


def _nonzeros(matrix: SX) -> SX:
    """Entries of a matrix in a column, in the order of its pattern."""
    column: SX = matrix.nz[:]
    return column
