"""Symbols against numbers: a size for each entry, whatever kind of symbol a force law returns."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.dynamics.symbols import apply_numpy, column, residual, scaled

casadi = pytest.importorskip("casadi")
SIZES = np.array([2.0, 0.5])
AT, WANTED = np.array([3.0, -1.0]), np.array([1.0, 4.0])


def _symbol(kind: str) -> tuple[object, object]:
    """A column of two symbols, and the same as it is or as NumPy's functions return it."""
    apply_numpy()
    x = casadi.SX.sym("x", 2)
    return x, x if kind == "plain" else np.sqrt(x * x) * np.sign(x)


@pytest.mark.parametrize("kind", ["plain", "out of NumPy"])
def test_each_square_counts_once(kind: str) -> None:
    x, of = _symbol(kind)
    total = casadi.Function("total", [x], [casadi.sumsqr(residual(of, WANTED, SIZES))])
    assert float(total(AT)) == pytest.approx((2.0 / 2.0) ** 2 + (-5.0 / 0.5) ** 2, rel=1e-15)
    alone = casadi.Function("alone", [x], [scaled(of, SIZES)])
    np.testing.assert_allclose(alone(AT).full(), [[1.5], [-2.0]], rtol=1e-15)


def test_what_numpy_returns_is_broadcast_as_numpy_does() -> None:
    """Why there is `scaled`: should CasADi change this, it may go."""
    assert (_symbol("out of NumPy")[1] / SIZES).shape == (2, 2)  # type: ignore[operator]


def test_one_number_for_all() -> None:
    x, of = _symbol("out of NumPy")
    halves = casadi.Function("halves", [x], [scaled(of, 2.0)])
    np.testing.assert_allclose(halves(AT).full().ravel(), AT / 2.0, rtol=1e-15)


@pytest.mark.parametrize("kind", ["plain", "out of NumPy"])
@pytest.mark.parametrize("sizes", [np.ones(1), np.ones(3), np.ones(0)])
def test_sizes_that_do_not_fit_are_refused(kind: str, sizes: np.ndarray) -> None:
    with pytest.raises(ValueError, match="2 symbols where there are"):
        scaled(_symbol(kind)[1], sizes)


def test_what_is_wanted_has_to_fit() -> None:
    x, _ = _symbol("plain")
    for wanted in (casadi.SX.sym("one"), np.ones(3)):
        with pytest.raises(ValueError, match="symbols where there are 2"):
            residual(x, wanted, SIZES)


def test_a_matrix_is_no_column() -> None:
    with pytest.raises(ValueError, match="not that of a column"):
        column(casadi.SX.sym("m", 2, 2))
