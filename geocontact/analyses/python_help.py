"""What `help` says of an analysis: its options with types, SI units and an example as Python takes them."""

from __future__ import annotations

import re
from inspect import cleandoc
from pathlib import Path
from textwrap import wrap
from typing import Any

from geocontact.analyses.options import Declared, Options, declared

WIDTH = 112


def python_help(options: type[Options]) -> str:
    """Docstring of the call: that of the options, and how values that the command line reads from text are written."""
    summary = cleandoc(options.__doc__ or "").partition("Parameters\n")[0].strip()
    lines = [summary, "", "Parameters", "----------"]
    known = [one for one in declared(options) if one.settable]
    for section in dict.fromkeys(one.section for one in known):
        lines += ["", section, "-" * len(section)] if section else []
        lines += [line for one in known if one.section == section for line in _told(one)]
    return "\n".join(lines) + "\n"


def _told(one: Declared) -> list[str]:
    unit = f" [{one.typed.si}]" if one.typed is not None and one.typed.si != "-" else ""
    head = f"{one.name} : {_kind(one.kind)}{unit}{', optional' if not one.required else ''}"
    words = one.words
    if one.typed is not None:
        words = f"{words.rstrip('.')}. Written here as {one.typed.python}"
    return [head, *(f"    {line}" for line in wrap(words, WIDTH, break_on_hyphens=False))]


def _kind(kind: Any) -> str:
    """A type as it is written in Python, modules left out: a path may be text."""
    if kind is Path:
        return "path"
    text = kind.__name__ if isinstance(kind, type) and not hasattr(kind, "__args__") else str(kind)
    return re.sub(r"\b(?:[a-z_]+\.)+(?=[A-Z])", "", text)
