"""CasADi's functions as machine code: operations against Python's own, long functions, what is kept between runs."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from pathlib import Path

import casadi
import numpy as np
import pytest
from casadi import SX, Function

from geocontact.dynamics import machine_code as module
from geocontact.dynamics.compiled import Buffered

POINTS = [-2.5, -1.0, -0.3, -0.0, 0.0, 0.3, 0.999, 1.0, 2.5, 700.0, math.inf, math.nan]


def _guarded(function: Callable[..., float]) -> Callable[..., float]:
    def of(*values: float) -> float:
        try:
            return float(function(*values))
        except (ValueError, OverflowError, ZeroDivisionError):
            return math.nan

    return of


ONE: dict[str, tuple[Callable[[SX], SX], Callable[[float], float]]] = {
    **{name: (getattr(casadi, name), _guarded(getattr(math, name))) for name in ("sin", "cos", "tan", "exp", "log")},
    **{name: (getattr(casadi, name), _guarded(getattr(math, name))) for name in ("sinh", "cosh", "tanh", "sqrt")},
    **{name: (getattr(casadi, name), _guarded(getattr(math, name))) for name in ("asinh", "acosh", "atanh", "erf")},
    **{name: (getattr(casadi, name), _guarded(getattr(math, name))) for name in ("asin", "acos", "atan", "fabs")},
    **{name: (getattr(casadi, name), _guarded(getattr(math, name))) for name in ("floor", "ceil", "log1p", "expm1")},
    "inverse": (lambda x: 1 / x, _guarded(lambda x: 1.0 / x)),
    "negative": (lambda x: -x, lambda x: -x),
    "twice": (lambda x: 2 * x, lambda x: 2.0 * x),
    "square": (lambda x: x**2, lambda x: x * x),
    "not": (casadi.logic_not, lambda x: float(not x)),
    "sign": (casadi.sign, lambda x: math.copysign(1.0, x) if x and x == x else x),
    "constant power": (lambda x: x**2.5, _guarded(lambda x: math.pow(x, 2.5))),
}
TWO: dict[str, tuple[Callable[[SX, SX], SX], Callable[[float, float], float]]] = {
    "sum": (lambda a, b: a + b, lambda a, b: a + b),
    "difference": (lambda a, b: a - b, lambda a, b: a - b),
    "product": (lambda a, b: a * b, lambda a, b: a * b),
    "quotient": (lambda a, b: a / b, _guarded(lambda a, b: a / b)),
    "power": (lambda a, b: a**b, _guarded(math.pow)),
    "less": (lambda a, b: a < b, lambda a, b: float(a < b)),
    "at most": (lambda a, b: a <= b, lambda a, b: float(a <= b)),
    "equal": (lambda a, b: a == b, lambda a, b: float(a == b)),
    "unequal": (lambda a, b: a != b, lambda a, b: float(a != b)),
    "and": (casadi.logic_and, lambda a, b: float(bool(a) and bool(b))),
    "or": (casadi.logic_or, lambda a, b: float(bool(a) or bool(b))),
    "arc tangent": (casadi.atan2, math.atan2),
    "remainder": (casadi.fmod, _guarded(math.fmod)),
    "sign of": (casadi.copysign, math.copysign),
    "hypotenuse": (casadi.hypot, math.hypot),
    "least": (casadi.fmin, lambda a, b: float(np.fmin(a, b))),
    "most": (casadi.fmax, lambda a, b: float(np.fmax(a, b))),
    "only where": (lambda a, b: casadi.if_else(a, b, 0.0), lambda a, b: b if a else 0.0),
}


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GEOCONTACT_CACHE", str(tmp_path / "cache"))
    module._IN_MEMORY.clear()


def _found(function: Function, rows: list[tuple[float, ...]]) -> np.ndarray:
    fast = Buffered(function, compiled=True)
    assert fast.code is not None
    found = np.array([fast(np.array(row))[0].copy() for row in rows])
    slow = np.array([Buffered(function)(np.array(row))[0].copy() for row in rows])
    np.testing.assert_array_equal(found, slow)
    return found


def test_functions_of_one_number() -> None:
    """Against Python's, with infinity and not a number; what Python refuses to evaluate only against CasADi."""
    x = SX.sym("x")
    found = _found(Function("f", [x], [casadi.vertcat(*(of(x) for of, _ in ONE.values()))]), [(p,) for p in POINTS])
    for column, (name, (_, of)) in zip(found.T, ONE.items(), strict=True):
        wanted = np.array([of(p) for p in POINTS])
        known = ~np.isnan(wanted)
        np.testing.assert_allclose(column[known], wanted[known], rtol=2e-15, err_msg=name)


def test_functions_of_two_numbers() -> None:
    """The same."""
    x = SX.sym("x", 2)
    pairs = [(a, b) for a in POINTS for b in POINTS]
    found = _found(Function("f", [x], [casadi.vertcat(*(of(x[0], x[1]) for of, _ in TWO.values()))]), pairs)
    for column, (name, (_, of)) in zip(found.T, TWO.items(), strict=True):
        wanted = np.array([of(a, b) for a, b in pairs])
        known = ~np.isnan(wanted)
        assert known.sum() > 40
        np.testing.assert_allclose(column[known], wanted[known], rtol=2e-15, err_msg=name)


def test_a_function_of_many_pieces() -> None:
    """x → sin(x) + x/3 a thousand times over, with sums of all that went before: more than ten pieces."""
    x, given = SX.sym("x", 3), np.array([0.1, -0.4, 2.0])
    value, total = x, SX.zeros(3)
    by_hand, summed = given.copy(), np.zeros(3)
    for _ in range(1000):
        value, by_hand = casadi.sin(value) + value / 3.0, np.sin(by_hand) + by_hand / 3.0
        total, summed = total + value * x[::-1], summed + by_hand * given[::-1]
    function = Function("f", [x], [total, casadi.vertcat(value, 7.25)])
    assert function.n_instructions() > 10 * module.PIECE
    found = Buffered(function, compiled=True)(given)
    np.testing.assert_allclose(found[0], summed, rtol=1e-13)
    np.testing.assert_allclose(found[1], [*by_hand, 7.25], rtol=1e-13)
    wanted = function(given)
    assert all(np.array_equal(a, np.array(b).ravel()) for a, b in zip(found, wanted, strict=True))


def test_many_calls_at_once() -> None:
    x, y = SX.sym("x", 2), SX.sym("y")
    run = Buffered(Function("f", [x, y], [x * y, y**2]), compiled=True)
    a, b = np.arange(6.0).reshape(3, 2), np.array([[1.0], [-2.0], [3.0]])
    product, square = run.many(a, b)
    np.testing.assert_array_equal(product, a * b)
    np.testing.assert_array_equal(square, b**2)


def test_code_is_kept_and_made_anew_where_it_is_damaged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    x = SX.sym("x")
    function, folder = Function("f", [x], [casadi.cos(x)]), tmp_path / "cache"
    assert module.machine_code(function) is not None
    (file,) = folder.iterdir()
    content, translations = file.read_bytes(), []
    true = module.translated
    monkeypatch.setattr(module, "translated", lambda f: translations.append(f) or true(f))
    module._IN_MEMORY.clear()
    assert Buffered(function, compiled=True)(np.array([1.0]))[0][0] == math.cos(1.0)
    assert not translations, "read again"
    for damaged in (b"", content[:40], content[:-1], bytes([content[0] ^ 1]) + content[1:]):
        file.write_bytes(damaged)
        module._IN_MEMORY.clear()
        assert Buffered(function, compiled=True)(np.array([1.0]))[0][0] == math.cos(1.0)
        assert file.read_bytes() == content
    assert len(translations) == 4
    assert module.machine_code(Function("f", [x], [casadi.sin(x)])) is not None and len(list(folder.iterdir())) == 2
    monkeypatch.setattr(module, "VERSION", "another")
    assert module.machine_code(function) is not None and len(list(folder.iterdir())) == 3


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="whoever may write everywhere")
def test_code_that_cannot_be_kept_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tmp_path.chmod(0o500)
    monkeypatch.setenv("GEOCONTACT_CACHE", str(tmp_path / "inside"))
    x = SX.sym("x")
    assert Buffered(Function("f", [x], [x + 1.0]), compiled=True)(np.array([1.0]))[0][0] == 2.0
    tmp_path.chmod(0o700)


def test_a_cache_that_is_a_file_keeps_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("GEOCONTACT_CACHE", str(tmp_path / "file"))
    x = SX.sym("x")
    assert Buffered(Function("f", [x], [x + 1.0]), compiled=True)(np.array([1.0]))[0][0] == 2.0


def test_what_has_no_translation_is_left_to_casadi(monkeypatch: pytest.MonkeyPatch) -> None:
    """Functions of matrices, operations that are not listed, and machines that may not compile."""
    m, x = casadi.MX.sym("m"), SX.sym("x")
    function = Function("f", [x], [casadi.sin(x)])
    assert module.machine_code(Function("f", [m], [m * m])) is None
    monkeypatch.delitem(module.CALLED, "SIN")
    assert module.machine_code(function) is None
    run = Buffered(function, compiled=True)
    assert run.code is None and run(np.array([1.0]))[0][0] == math.sin(1.0)
    monkeypatch.setattr(module, "_target", lambda: None)
    assert module.machine_code(Function("f", [x], [x + 1.0])) is None
