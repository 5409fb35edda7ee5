"""TOML files before their keys are read."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.data.magnitude import LARGEST_MEANT, TOO_LARGE
from geocontact.io.text.csv_text import text_of


def toml_of(path: Path, most_bytes: int) -> dict[str, Any]:
    """Content of a TOML file of at most `most_bytes`; InputError where it is none."""
    text = text_of(path, most_bytes, "a TOML file").decode("utf-8")
    try:
        content = tomllib.loads(text.replace("\r\n", "\n"))
    except RecursionError:
        raise InputError(path, "", "is nested too deeply", "write it as in the description of the format") from None
    except ValueError as error:  # of the syntax, and of numbers with thousands of digits
        raise InputError(path, "", f"is not TOML: {error}", "check quotes, brackets and =") from error
    for place, value in numbers_in(content):
        if math.isfinite(value) and abs(value) > LARGEST_MEANT:
            raise InputError(path, place, f"{value:.4g} {TOO_LARGE}", "check its digits and its exponent")
    return content


def numbers_in(value: Any, place: str = "") -> Iterator[tuple[str, float]]:
    """Every number with where it stands: persons.P1.mass."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        yield place, value
    elif isinstance(value, dict):
        for key, each in value.items():
            yield from numbers_in(each, f"{place}.{key}" if place else key)
    elif isinstance(value, list):
        for each in value:
            yield from numbers_in(each, place)
