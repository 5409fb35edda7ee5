"""TOML files before their keys are read."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.data.plausible import LARGEST_MEANT, TOO_LARGE
from geocontact.io.text.csv_text import text_of

BACKSLASHES = "write paths with /, or in 'single quotes'"
ESCAPES = {"\b": r"\b", "\t": r"\t", "\n": r"\n", "\f": r"\f", "\r": r"\r"}
r"""Signs that a path with backslashes turns into in double quotes, "C:\temp\new.stl", and how they are written."""
ESCAPED = ("Unescaped", "Invalid hex")  # as tomllib begins to tell of a backslash


def toml_of(path: Path, most_bytes: int) -> dict[str, Any]:
    """Content of a TOML file of at most `most_bytes`; InputError where it is none."""
    text = text_of(path, most_bytes, "a TOML file").decode("utf-8")
    try:
        content = tomllib.loads(text.replace("\r\n", "\n"))
    except RecursionError:
        raise InputError(path, "", "is nested too deeply", "write it as in the description of the format") from None
    except ValueError as error:  # of the syntax, and of numbers with thousands of digits
        remedy = BACKSLASHES if str(error).startswith(ESCAPED) else "check quotes, brackets and ="
        raise InputError(path, "", f"is not TOML: {error}", remedy) from error
    for place, words in strings_in(content):
        if any(sign in words and written in text for sign, written in ESCAPES.items()):
            raise InputError(path, place, "a backslash stands for a tab or another sign", BACKSLASHES)
    for place, value in numbers_in(content):
        if math.isfinite(value) and abs(value) > LARGEST_MEANT:
            raise InputError(path, place, f"{value:.4g} {TOO_LARGE}", "check its digits and its exponent")
    return content


def numbers_in(value: Any, place: str = "") -> Iterator[tuple[str, float]]:
    """Every number with where it stands: persons.P1.mass."""
    for found, each in _leaves(value, place):
        if isinstance(each, (int, float)) and not isinstance(each, bool):
            yield found, each


def strings_in(value: Any, place: str = "") -> Iterator[tuple[str, str]]:
    """Every string with where it stands."""
    for found, each in _leaves(value, place):
        if isinstance(each, str):
            yield found, each


def _leaves(value: Any, place: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, each in value.items():
            yield from _leaves(each, f"{place}.{key}" if place else key)
    elif isinstance(value, list):
        for each in value:
            yield from _leaves(each, place)
    else:
        yield place, value
