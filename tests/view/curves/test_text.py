"""Names and numbers in figures."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from matplotlib.text import Text

from geocontact.view.curves.sheet import number, plain


@given(st.text())
@example("_hidden")
@example("__$x_$")
def test_no_name_becomes_a_formula_or_a_hidden_label(name: str) -> None:
    drawn, mathematics = Text(text=plain(name))._preprocess_math(plain(name))
    assert mathematics is False
    assert not plain(name).startswith("_")
    seen = "".join(c if c.isprintable() or c == "\u00a0" else " " if c.isspace() else "\ufffd" for c in name)
    assert drawn.removeprefix("\u200b") == seen


@given(st.text(), st.integers(1, 40))
@example("\u00a0", 1)
@example("a \u00a0 b", 3)
def test_lines_are_no_longer_than_asked_and_lose_no_letter(name: str, width: int) -> None:
    lines = plain(name, width).replace(r"\$", "$").removeprefix("\u200b").split("\n")
    assert all(len(line) <= width for line in lines)
    letters = "".join(c for c in "".join(lines) if c != " ")
    assert letters == "".join(c for c in plain(name).replace(r"\$", "$").removeprefix("\u200b") if c != " ")


@pytest.mark.parametrize(
    ("value", "scale", "shown"),
    [
        (38.765, None, "38.8"),
        (-2.1176, 38.8, "−2.1"),
        (1234.5, None, "1234"),
        (0.012345, None, "0.0123"),
        (-0.001, 10.0, "0.0"),
        (0.0, None, "0"),
        (9.999, None, "10.00"),
        (1.234e-9, None, "1.23e−09"),
        (math.nan, None, "–"),
        (math.inf, 1.0, "–"),
    ],
)
def test_numbers_have_three_significant_digits(value: float, scale: float | None, shown: str) -> None:
    assert number(value, scale) == shown
