"""TOML files before their keys are read."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.text.csv_text import text_of


def toml_of(path: Path, most_bytes: int) -> dict[str, Any]:
    """Content of a TOML file of at most `most_bytes`; InputError where it is none."""
    text = text_of(path, most_bytes, "a TOML file").decode("utf-8")
    try:
        return tomllib.loads(text.replace("\r\n", "\n"))
    except RecursionError:
        raise InputError(path, "", "is nested too deeply", "write it as in the description of the format") from None
    except ValueError as error:  # of the syntax, and of numbers with thousands of digits
        raise InputError(path, "", f"is not TOML: {error}", "check quotes, brackets and =") from error
