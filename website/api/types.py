"""Types and signatures as a reader wants them: arrays by their shape, modules left out."""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from textwrap import fill
from typing import Any

ARRAY = re.compile(r"(?:jaxtyping\.)?(Float|Int|Bool|Complex)\w*\[(?:numpy\.|np\.)?ndarray, ?['\"]([^'\"]*)['\"]\]")
KINDS = {"Float": "float", "Int": "integer", "Bool": "boolean", "Complex": "complex"}
WIDTH = 84


def shown_type(kind: Any) -> str:
    """In backticks; "" where there is none."""
    if kind is inspect.Parameter.empty or kind is inspect.Signature.empty:
        return ""
    if kind is Path:
        return "path"
    text = kind if isinstance(kind, str) else kind.__name__ if _is_plain(kind) else str(kind)
    text = ARRAY.sub(lambda one: f"{KINDS[one[1]]} array ({', '.join(one[2].split())})", text.strip("'"))
    text = re.sub(r"\b(?:[A-Za-z_]+\.)+(?=[A-Za-z])", "", text)
    text = re.sub(r"Annotated\[([^,\]]+(?:\[[^\]]*\])?),.*\]", r"\1", text)
    text = re.sub(r"Literal\[(.*?)\]", lambda one: one[1].replace(", ", " or "), text)
    return "`" + text.replace("|", r"\|").replace("`", "") + "`"


def signature(name: str, thing: Any) -> str:
    """The call with its names and defaults, in lines of a width that a page has; types stand in the table below it."""
    try:
        known = inspect.signature(thing).parameters.values()
    except (TypeError, ValueError):
        return f"gc.{name}"
    told, starred = [], False
    for one in known:
        if one.kind is one.KEYWORD_ONLY and not starred:
            starred = True
            told.append("*")
        told.append(_argument(one))
    line = f"gc.{name}({', '.join(told)})"
    if len(line) <= WIDTH:
        return line
    body = fill(", ".join(told), WIDTH, initial_indent="    ", subsequent_indent="    ", break_long_words=False)
    return f"gc.{name}(\n{body},\n)"


def _argument(one: inspect.Parameter) -> str:
    if one.default is one.empty:
        return ("*" if one.kind is one.VAR_POSITIONAL else "") + one.name
    default = repr(one.default)
    return f"{one.name}={default if len(default) < 40 else '...'}"


def _is_plain(kind: Any) -> bool:
    """Whether its name says it all: no array of some shape, and nothing in brackets."""
    return isinstance(kind, type) and not hasattr(kind, "__args__") and "jaxtyping" not in f"{kind.__module__} {kind!r}"
