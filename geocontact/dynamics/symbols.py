"""CasADi, imported where it is used, and what its symbols lack."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.joint import Affine, JointFunction, SineProduct

if TYPE_CHECKING:
    from casadi import SX


def apply_numpy() -> None:
    """Let NumPy's functions take symbols and give symbols, so that force laws run on them as they are."""
    from casadi import GlobalOptions

    GlobalOptions.setNumpyMode(1)


def constant(values: Float[np.ndarray, ...]) -> SX:
    """Numbers as an expression; what is 0 is left out of it."""
    from casadi import SX, sparsify

    return sparsify(SX(np.asarray(values, dtype=float)))


def column(symbols: SX | Float[np.ndarray, " n"], count: int | None = None) -> SX:
    """Symbols or numbers as a column of CasADi's own kind, (n, 1).

    ValueError for another shape, or another count than is asked.

    Once NumPy's functions take symbols (`apply_numpy`), what a force law returns is CasADi's `ArrayInterfaceSX`, which
    broadcasts as NumPy does: (2, 1) over an array (2,) is (2, 2), and its sum of squares has each square twice. A plain
    `SX` is a matrix, for which (2,) is a column.
    """
    from casadi import SX

    plain = SX(symbols)
    if plain.shape[1] != 1:
        raise ValueError(f"symbols have the shape {plain.shape}, not that of a column")
    if count is not None and plain.shape[0] != count:
        raise ValueError(f"{plain.shape[0]} symbols where there are {count} numbers")
    return plain


def scaled(symbols: SX, size: float | Float[np.ndarray, " n"]) -> SX:
    """A column in parts of its sizes, (n, 1): one size for each entry, or one number for all of them.

    ValueError where there are more or fewer sizes than entries.
    """
    from casadi import SX

    sizes = np.asarray(size, dtype=float)
    return column(symbols, len(sizes) if sizes.ndim else None) / SX(sizes)


def residual(symbols: SX, wanted: SX | Float[np.ndarray, " n"], size: float | Float[np.ndarray, " n"]) -> SX:
    """How far a column is from what is wanted, in parts of its sizes, (n, 1).

    ValueError where the columns are not of one length, or `scaled` has one.
    """
    of = column(symbols)
    return scaled(of - column(wanted, of.shape[0]), size)


def entries(symbols: SX, which: Sequence[int] | slice) -> SX:
    """Entries of an (n, 1) column as a column, (k, 1), also for k = 0.

    Indexed by one subscript, a column of one entry gives (1, 0) where nothing is taken, and `vertcat` counts its row.
    """
    return symbols[which, :]


def turn(axis: Float[np.ndarray, " 3"], angle: SX) -> SX:
    """Rotation matrix about a unit vector (Rodrigues)."""
    from casadi import SX, cos, sin

    across = _cross_matrix(axis)
    return SX.eye(3) + sin(angle) * constant(across) + (1.0 - cos(angle)) * constant(across @ across)


def _cross_matrix(v: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def value_of(function: JointFunction, q: SX) -> SX:
    """A joint's function of coordinates, k values in a column."""
    from casadi import SX, dot, pw_const, sin

    if isinstance(function, Affine):
        return dot(constant(function.slopes), q) + function.offset if len(function.slopes) else SX(function.offset)

    if isinstance(function, SineProduct):
        product = SX(function.factor)
        for k, phase in enumerate(function.phases):
            product = product * sin(q[k] + phase)
        return product

    def piece(of: Float[np.ndarray, " p"]) -> SX:
        return SX(of[0]) if np.all(of == of[0]) else pw_const(q, function.knots, of)

    x = q - piece(function.origins)
    value = piece(function.coefficients[:, 0])
    for power in range(1, function.coefficients.shape[1]):
        value = value * x + piece(function.coefficients[:, power])
    return value
