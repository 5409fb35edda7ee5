"""Values of options that are written as text: on the command line all of them, in Python where somebody likes to."""

from __future__ import annotations

import re
from importlib import import_module
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

from geocontact.analyses.frame.marks import Typed
from geocontact.data.errors import InputError
from geocontact.data.plausible import PLAIN
from geocontact.io.text.units import si_unit

NUMBER_AND_UNIT = re.compile(r"(?P<number>[-+0-9.eE]+?)\s*(?P<unit>[a-zA-Z%][a-zA-Z/^0-9 ]*)")


def read(typed: Typed, name: str, value: Any) -> Any:
    """What was typed on the command line for the option of that name, in SI."""
    place, _, function = typed.read.rpartition(":")
    module = import_module(f"geocontact.analyses.{place or 'frame.quantities'}")
    return getattr(module, function)(value, f"`{name}`")


def from_python(typed: Typed, name: str, kind: Any, each: bool, value: Any) -> Any:
    """The value in SI of what Python wrote: numbers are in SI already, text is read as on the command line.

    Parameters
    ----------
    typed
        Unit of the option, and what reads its text.
    name
        Of the option, for messages.
    kind
        Its type.
    each
        Whether the command line takes one value each time, and reads them together.
    value
        A text, several of them, or anything else, which is left as it is.

    Raises
    ------
    InputError
        For a number without a unit in a text, where the command line takes it for a unit that is not SI: "4" may be
        4 mm or 4 m.
    """
    if not _is_text(kind, value):
        return value
    if typed.kind is float:
        return _quantity(name, typed, value)
    text = value if isinstance(value, str) else ",".join(value)
    found = read(typed, name, (text,) if each else text)
    plain = _plain(text)
    if plain and _numbers(found) not in ((), plain):
        raise _without_unit(name, typed, text)
    return found


def _is_text(kind: Any, value: Any) -> bool:
    """Whether a value is a text that stands for another value: a name that the option takes as it is does not."""
    if isinstance(value, str):
        return value not in _literals(kind)
    several = isinstance(value, (tuple, list)) and len(value) > 0 and all(isinstance(one, str) for one in value)
    return several and get_origin(kind) is tuple and set(get_args(kind)) <= {float, Ellipsis}


def _literals(kind: Any) -> tuple[Any, ...]:
    if get_origin(kind) is Literal:
        return get_args(kind)
    return (
        tuple(each for part in get_args(kind) for each in _literals(part))
        if get_origin(kind) in (Union, UnionType)
        else ()
    )


def _quantity(name: str, typed: Typed, text: str) -> float:
    """ "30 mm" in SI, for an option whose unit stands in its name on the command line."""
    found = NUMBER_AND_UNIT.fullmatch(text.strip())
    known = si_unit(found["unit"]) if found else None
    plain = _plain(text)
    if len(plain) == 1 and typed.si in ("-", "s"):
        return plain[0]
    if plain:
        raise _without_unit(name, typed, text)
    if found is None or known is None or known[0] != typed.si:
        raise InputError("", f"`{name}`", f"{text!r} is not a value in {typed.si}", f"write {typed.python}")
    return float(found["number"]) * known[1]


def with_unit(name: str, si: str, text: str) -> float | str:
    """ "2 kN" in SI, for a number whose SI unit both doors take as it is; a text without a unit is left as it is."""
    found = NUMBER_AND_UNIT.fullmatch(text.strip())
    if found is None or si == PLAIN.si or _plain(text):
        return text
    known = (si, 1.0) if found["unit"] == si else si_unit(found["unit"])
    if known is None or known[0] != si:
        raise InputError("", f"`{name}`", f"{text!r} is not a value in {si}", "check the unit")
    return float(found["number"]) * known[1]


def _plain(text: str) -> tuple[float, ...]:
    """Numbers of a text that holds nothing but numbers; empty for any other."""
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        return ()


def _numbers(value: Any) -> tuple[float, ...]:
    parts = value if isinstance(value, tuple) else (value,)
    return tuple(map(float, parts)) if all(isinstance(each, (int, float)) for each in parts) else ()


def _without_unit(name: str, typed: Typed, text: str) -> InputError:
    return InputError("", f"`{name}`", f"{text!r} has no unit", f"write the unit, or {typed.python}")
