"""Faces chosen by an expression: against Python's own arithmetic; nothing but arithmetic is understood."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.geometry.regions import NAMES, faces_where
from geocontact.geometry.surface import Surface
from meshes.simple_shapes import torus
from tests.geometry.bodies import MM, moved, surface, turned

RING = surface(moved(torus(25.0, 8.0, 10), turned(20, -35, 50), [3.0, -2.0, 5.0]), "ring")


def values(of: Surface) -> dict[str, np.ndarray]:
    """The six names in mm, from the corners."""
    corners = of.vertices[of.faces] / MM
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return dict(zip(NAMES, [*corners.mean(axis=1).T, *normal.T], strict=True))


AT = values(RING)
x, y, z, nx, ny, nz = AT.values()
KNOWN = {
    "ny>0.25": ny > 0.25,
    "ny >= 0.25 and abs(z) < 10": (ny >= 0.25) & (np.abs(z) < 10),
    "x < 0 or nz <= 0 and y > 0": (x < 0) | ((nz <= 0) & (y > 0)),
    "(x < 0 or nz <= 0) and y > 0": ((x < 0) | (nz <= 0)) & (y > 0),
    "not x > 3": x <= 3,
    "not x > 3 and y > 0": (x <= 3) & (y > 0),
    "-10 < x < 10": (x > -10) & (x < 10),
    "-10 < x <= y < 20 > z": (x > -10) & (x <= y) & (y < 20) & (z < 20),
    "sqrt(x**2 + z**2) < 20": np.hypot(x, z) < 20,
    "-x**2 > -100": np.abs(x) < 10,
    "x - y - z > 0": x > y + z,
    "2*x/4 < 1e1": x < 20,
    "nx*1 + ny*2 - -nz > .5": nx + 2 * ny + nz > 0.5,
    "  ny>0.25 ": ny > 0.25,
}


@pytest.mark.parametrize("expression", KNOWN)
def test_expression_chooses_the_faces_it_says(expression):
    chosen = faces_where(RING, expression, MM)
    np.testing.assert_array_equal(chosen, KNOWN[expression])
    assert 0 < chosen.sum() < len(chosen), "a test that chooses something and leaves something"


NUMBER = st.recursive(
    st.sampled_from(NAMES) | st.floats(-30, 30).map(lambda v: f"({v!r})"),
    lambda inner: (
        st.tuples(inner, st.sampled_from(["+", "-", "*", "/"]), inner).map(lambda p: f"({p[0]} {p[1]} {p[2]})")
        | inner.map(lambda v: f"abs({v})")
        | inner.map(lambda v: f"(-{v})")
    ),
    max_leaves=6,
)
COMPARISON = st.tuples(NUMBER, st.sampled_from(["<", "<=", ">", ">="]), NUMBER).map(" ".join)
CONDITION = st.recursive(
    COMPARISON.map(lambda c: f"({c})"),
    lambda inner: (
        st.tuples(inner, st.sampled_from(["and", "or"]), inner).map(lambda p: f"({p[0]} {p[1]} {p[2]})")
        | inner.map(lambda v: f"(not {v})")
    ),
    max_leaves=5,
)


@given(st.tuples(CONDITION, st.sampled_from(NAMES)).map(lambda p: f"({p[1]} < 1e300) and {p[0]}"))
def test_any_expression_is_what_python_makes_of_it(expression):
    """Python's own evaluation, one face after the other; division by zero, which Python refuses, counts as numpy's."""
    mine = {name: column / (MM if name in ("x", "y", "z") else 1.0) for name, column in columns().items()}
    chosen = faces_where(RING, expression, MM)
    with np.errstate(all="ignore"):
        for face in range(0, len(chosen), 37):
            scope = {name: np.float64(column[face]) for name, column in mine.items()} | {"abs": abs}
            try:
                expected = bool(eval(expression, {"__builtins__": {}}, scope))
            except ZeroDivisionError:
                continue
            assert chosen[face] == expected, f"face {face}: {expression}"


def columns() -> dict[str, np.ndarray]:
    """As the surface has them [m], so that equality is to the last bit."""
    return dict(zip(NAMES, [*RING.vertices[RING.faces].mean(axis=1).T, *RING.face_normal.T], strict=True))


def test_what_lies_on_the_limit_is_in_or_out():
    assert faces_where(RING, "x >= x").all() and faces_where(RING, "x <= x").all()
    assert not faces_where(RING, "x > x").any() and not faces_where(RING, "x < x").any()


def test_lengths_are_in_the_unit_of_the_mesh_and_normals_are_not():
    np.testing.assert_array_equal(
        faces_where(RING, "x > 0.01 and nx > 0.5"), faces_where(RING, "x > 10 and nx > 0.5", MM)
    )
    assert not faces_where(RING, "x > 10").any()


def test_parts_are_the_whole():
    """A condition and its opposite divide the faces; so do `and` and `or` by de Morgan."""
    first, second = "x > 2", "nz < 0.1"
    assert (faces_where(RING, first, MM) ^ faces_where(RING, f"not {first}", MM)).all()
    neither = faces_where(RING, f"not ({first} or {second})", MM)
    np.testing.assert_array_equal(neither, faces_where(RING, f"not {first} and not {second}", MM))


HOSTILE = [
    "__import__('os').system('true')",
    "().__class__.__bases__",
    "x.__class__ > 0",
    "x.tofile('proof') or x > 0",
    "open('proof', 'w') or x > 0",
    "exec('1') > x",
    "eval('x') > 0",
    "(lambda: x)() > 0",
    "[x > 0 for x in (1, 2)]",
    "(y := x) > 0",
    "x[0] > 1",
    "f'{x}' > x",
    "'a' * 10**10 > x",
    "b'a' > x",
    "x if x > 0 else y",
    "abs(x, y) > 0",
    "abs(x, out=y) > 0",
    "abs(*x) > 0",
    "abs > 0",
    "sqrt(sqrt) > x",
    "print(x) > 0",
    "x @ y > 0",
    "x // 2 > 0",
    "x % 2 > 0",
    "x << 2 > 0",
    "x & y > 0",
    "~x > 0",
    "x == 0",
    "x != 0",
    "x is 0",
    "x in y",
    "True",
    "x > True",
    "None",
    "x > None",
    "... > x",
    "1j > x",
    "{x}",
    "x, y",
    "w > 0",
    "X > 0",
]


@pytest.mark.parametrize("expression", HOSTILE)
def test_nothing_but_arithmetic_is_understood(expression, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(
        ValueError, match=r"is not understood; only x, y, z, nx, ny, nz, numbers, and/or/not, abs, sqrt"
    ):
        faces_where(RING, expression)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "expression", ["", " ", "ny >", "ny > 0.25)", "import os", "x = 3", "ny > 0; x > 0", "\0", "(" * 5000]
)
def test_what_is_no_expression_is_refused(expression):
    with pytest.raises(ValueError, match=r"cannot be read; write for example ny>0\.25"):
        faces_where(RING, expression)


@pytest.mark.parametrize("expression", ["x", "ny + 1", "3", "1 > 0", "not 1 > 0", "abs(x)"])
def test_what_says_nothing_of_the_faces_is_refused(expression):
    with pytest.raises(ValueError, match=r"is not a condition on the faces|join conditions"):
        faces_where(RING, expression)


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        ("(x > 0) + (y > 0) > 1", "cannot be used as a number"),
        ("abs(x > 0) > 0", "cannot be used as a number"),
        ("-(x > 0) > 0", "cannot be used as a number"),
        ("(x > 0) > 0", "cannot be used as a number"),
        ("x and y > 0", "and, or, not join conditions"),
        ("not x", "and, or, not join conditions"),
        (f"x > {'9' * 400}", "cannot be computed"),
        ("x > 1e999", "is not a finite number"),
        ("not " * 900 + "x > 0", "cannot be computed|cannot be read"),
    ],
)
def test_numbers_and_conditions_are_not_mixed_up(expression, message):
    with pytest.raises(ValueError, match=message):
        faces_where(RING, expression)


def test_huge_powers_take_no_time_and_no_memory():
    """Numbers are floats from the start: 9**9**9 is infinite, not a number of 370 million digits."""
    assert not faces_where(RING, "x > 9**9**9").any()
    assert faces_where(RING, "x < 9**9**9").all()


def test_division_by_zero_and_roots_of_negative_numbers_choose_nothing():
    assert not faces_where(RING, "x > (0-1)**0.5").any() and not faces_where(RING, "sqrt(x - 1e9) > 0").any()
    np.testing.assert_array_equal(faces_where(RING, "x / 0 > 0"), x > 0)
