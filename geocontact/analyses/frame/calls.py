"""A call from outside: help of its options, arguments that fit none, values as they are typed."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from importlib import import_module
from inspect import cleandoc, signature
from pathlib import Path
from textwrap import wrap
from typing import Any

from geocontact.analyses.frame.options import Declared, Options, declared

WIDTH = 112
IN_PYTHON = (
    ("(exit 1)", "(`accepted` is False)"),
    ("Also write ", "`write` also leaves "),
    (", typed ", ", as text "),
)
"""What words about options say of the command, and what that is in Python."""


def python_help(options: type[Options], run: Callable[..., Any]) -> str:
    """Docstring of the call: what it does, its arguments, the result with its numbers, and an example.

    Parameters
    ----------
    options
        Class of the options; its docstring says what each is.
    run
        Function that computes: its return annotation names the class of the result, and its module has the example.
    """
    summary = cleandoc(options.__doc__ or "").partition("Parameters\n")[0].strip()
    lines = [summary, "", "Parameters", "----------"]
    known = [one for one in declared(options) if one.settable]
    for section in dict.fromkeys(one.section for one in known):
        lines += ["", section, "-" * len(section)] if section else []
        lines += [line for one in known if one.section == section for line in _parameter_lines(one)]
    return "\n".join([*lines, *_returns(run), *_example(run)]) + "\n"


def _parameter_lines(one: Declared) -> list[str]:
    unit = f" [{one.typed.si}]" if one.typed is not None and one.typed.si != "-" else ""
    head = f"{one.name} : {_kind(one.kind)}{unit}{', optional' if not one.required else ''}"
    words = one.words
    for command, python in IN_PYTHON:
        words = words.replace(command, python)
    if one.typed is not None:
        words = f"{words.rstrip('.')}. As {one.typed.python}, or a text with its unit"
    return [head, *_indented(words)]


def _indented(words: str) -> list[str]:
    return [f"    {line}" for line in wrap(words, WIDTH, break_on_hyphens=False)]


def _returns(run: Callable[..., Any]) -> list[str]:
    """The class of the result, what it is, and numbers that are attributes of it."""
    found = signature(run).return_annotation
    kind = vars(import_module(run.__module__)).get(found) if isinstance(found, str) else found
    if not isinstance(kind, type):
        return []
    words = f"{cleandoc(kind.__doc__ or '').partition(chr(10) * 2)[0]} {METHODS}"
    lines = ["", "Returns", "-------", kind.__name__, *_indented(" ".join(words.split()))]
    for name, each in vars(kind).items():
        if isinstance(each, property) and not name.startswith("_") and not hasattr(kind.__mro__[1], name):
            lines += [f"    {name} : {' '.join(cleandoc(each.__doc__ or '').partition(chr(10) * 2)[0].split())}"]
    return lines


def _example(run: Callable[..., Any]) -> list[str]:
    """What the module of the result shows."""
    text = import_module(run.__module__).__doc__ or ""
    place = text.find(">>>")
    return ["", "Examples", "--------", *text[place:].rstrip().splitlines()] if place >= 0 else []


METHODS = (
    "`table()` and `tables()` give numbers, `figure()` a figure, `page(file)` its page, `write(folder)` all files."
)


def _kind(kind: Any) -> str:
    """A type as it is written in Python, modules left out: a path may be text."""
    if kind is Path:
        return "path"
    text = kind.__name__ if isinstance(kind, type) and not hasattr(kind, "__args__") else str(kind)
    return re.sub(r"\b(?:[a-z_]+\.)+(?=[A-Z])", "", text)


ALIKE = 0.6
"""Least similarity (0 to 1, Ratcliff and Obershelp) of a name that is suggested."""


def require_arguments(
    command: str, options: type[Options], inputs: Sequence[object], named: Mapping[str, object]
) -> None:
    """TypeError that names every argument that is unknown, given twice or missing, and the nearest one there is."""
    known = [one for one in declared(options) if one.settable]
    places = [one.name for one in known if one.positional]
    given = {*places[: len(inputs)], *named}
    names = [one.name for one in known]
    wrong = [_unknown(name, [each for each in names if each not in given]) for name in named if name not in names]
    wrong += [f"`{name}` is given twice" for name in places[: len(inputs)] if name in named]
    if len(inputs) > len(places):
        wrong.append(f"{len(inputs)} arguments without a name, where only {_listed(places)} can do without")
    missing = [one.name for one in known if one.required and one.name not in given]
    if missing:
        wrong.append(f"{_listed(missing)} {'is' if len(missing) == 1 else 'are'} missing")
    if wrong:
        raise TypeError(f"{command}: {'; '.join(wrong)}")


def _unknown(name: str, names: Sequence[str]) -> str:
    near = get_close_matches(name, names, n=1, cutoff=ALIKE)
    meant = f" (did you mean `{near[0]}`?)" if near else f" (there are {_listed(names)})"
    return f"there is no argument `{name}`{meant}"


def _listed(names: Sequence[str]) -> str:
    quoted = [f"`{name}`" for name in names]
    return " and ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)


def key(one: Declared) -> str:
    """Key of the option in `run.json`."""
    return one.spelled.key or one.name
