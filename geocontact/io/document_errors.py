"""What is wrong with a description, in the words of its validators, and where that is written in TOML."""

from __future__ import annotations

from datetime import date
from pathlib import Path
from typing import Any

from pydantic_core import ErrorDetails, PydanticCustomError

from geocontact.data.errors import InputError

LONGEST = 80
"""Signs of a key that are repeated in a message."""


BOUNDS = {
    "greater_than": "above",
    "greater_than_equal": "at least",
    "less_than": "below",
    "less_than_equal": "at most",
}
CHECK = "check the value and its unit"


def refusal(what: str, remedy: str = "", *, example: str = "", at: tuple[str | int, ...] = ()) -> PydanticCustomError:
    """What a validator raises.

    Parameters
    ----------
    example
        A value as it may be written: the remedy is to write it at the key.
    at
        Keys, and numbers in lists, from what is validated on to the place that is meant; "" after those of a table that
        is meant itself.
    """
    return PydanticCustomError("refused", "{what}", {"what": what, "remedy": remedy, "example": example, "at": at})


def input_error(path: Path, first: ErrorDetails) -> InputError:
    """In the words of `refusal`, or for what pydantic refuses by itself."""
    context: dict[str, Any] = {"at": (), **first.get("ctx", {})}
    place, key = _place((*first["loc"], *context["at"]))
    match first["type"]:
        case "refused":
            remedy = f"write {key} = {context['example']}" if context["example"] else context["remedy"]
            return InputError(path, place, context["what"], remedy)
        case "dict_type" | "mapping_type":
            return InputError(path, place, "is not a table", "write names with values")
        case "float_type" | "finite_number":
            return InputError(path, place, f"{shown(first['input'])} is not a finite number", f"write {key} = 1.5")
        case "bool_type":
            return InputError(path, place, f"{shown(first['input'])} is neither true nor false", f"write {key} = true")
        case "literal_error":
            choice = context["expected"].replace("'", "")
            return InputError(path, place, f"{shown(first['input'])} is none", f"write {choice}")
        case "greater_than" | "greater_than_equal" | "less_than" | "less_than_equal" as kind:
            return InputError(path, place, f"is not {BOUNDS[kind]} {next(iter(first['ctx'].values())):g}", CHECK)
        case "string_type":
            return InputError(path, place, f"{shown(first['input'])} is not a text", "write it in quotes")
        case _:
            wanted = first["msg"].removeprefix("Input ")
            return InputError(path, place, f"{shown(first['input'])} cannot be", f"it {wanted}")


def _place(loc: tuple[str | int, ...]) -> tuple[str, str]:
    """Where in the file, `[persons.P1] mass` or `[[trials]] 2 mass`, and the key alone."""
    numbers = [part + 1 for part in loc if isinstance(part, int)]
    *tables, key = ["".join(filter(str.isprintable, part))[:LONGEST] for part in loc if isinstance(part, str)] or [""]
    if numbers and tables:
        return f"[[{'.'.join(tables)}]] {numbers[0]} {key}".strip(), key
    if numbers:
        return f"[[{key}]] {numbers[0]}", key
    return (f"[{'.'.join(tables)}] {key}".strip() if tables else key), key


def shown(value: object) -> str:
    """A value as it is repeated in a message."""
    return f"{value if isinstance(value, date) else repr(value)!s:.60}"
