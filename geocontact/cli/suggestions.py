"""One line for what was mistyped: what is no command or no option here, and the nearest that is."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from cyclopts import App, CycloptsError, UnknownCommandError, UnknownOptionError

NAME = "geocontact"
ALIKE = 0.6
"""Least similarity (0 to 1, Ratcliff and Obershelp) of a name that is suggested."""


def mistyped(error: CycloptsError, app: App) -> str:
    """What is wrong, and what may have been meant; without anything near, what there is or where to look."""
    chain = error.command_chain or ()
    match error:
        case UnknownCommandError(unused_tokens=[token, *_]):
            group = app
            for name in chain:
                group = group[name]
            names = commands(group)
            if token.startswith("-"):
                before = f"name the command before its options, {help_of(chain)}"
                return f"{token} is no option of {' '.join((NAME, *chain))}; {_nearest(token, group) or before}"
            there = f"there are {', '.join(names)}"
            return f"{token} is no command{_of(chain)}; {_nearest(token, names) or there}"
        case UnknownOptionError():
            given = (error.token.keyword or error.token.value).partition("=")[0]
            names = [name for each in error.argument_collection if each.parse for name in each.names]
            return f"{given} is no option{_of(chain)}; {_nearest(given, names) or help_of(chain)}"
    return _with_hint(" ".join(str(error).split()), help_of(chain))


def commands(group: App) -> list[str]:
    """Names of the commands of a group."""
    return [name for name in group if not name.startswith("-")]


def help_of(chain: Iterable[str]) -> str:
    """Where the options of a command are told."""
    return f"see {' '.join((NAME, *chain))} --help"


def _of(chain: Iterable[str]) -> str:
    return f" of {' '.join(chain)}" if tuple(chain) else ""


def _nearest(given: str, names: Iterable[str]) -> str:
    found = get_close_matches(given, list(names), n=1, cutoff=ALIKE)
    return f"did you mean {found[0]}?" if found else ""


def _with_hint(text: str, hint: str) -> str:
    """Sentence and remedy; a question keeps its mark and the remedy follows as a sentence of its own."""
    return f"{text} {hint.capitalize()}" if text.endswith("?") else f"{text.rstrip('.')}; {hint}"
