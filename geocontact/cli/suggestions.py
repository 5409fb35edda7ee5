"""One line for what was mistyped or is not installed: the nearest command or option there is, or what to install."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches
from importlib.metadata import PackageNotFoundError, requires

from cyclopts import App, CycloptsError, UnknownCommandError, UnknownOptionError

NAME = "geocontact"
ALIKE = 0.6
"""Least similarity (0 to 1, Ratcliff and Obershelp) of a name that is suggested."""
FOR_WORK = ("all", "test", "oracle")
"""Extras that bring several or are for those who work on the package."""


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
                return f"{token} is not an option of {' '.join((NAME, *chain))}; {_nearest(token, group) or before}"
            there = f"there are {', '.join(names)}"
            elsewhere = f" (`{deeper}`?)" if (deeper := _in_a_group(token, group)) else ""
            return f"{token} is not a command{_of(chain)}{elsewhere}; {_nearest(token, names) or there}"
        case UnknownOptionError():
            given = (error.token.keyword or error.token.value).partition("=")[0]
            names = [name for each in error.argument_collection if each.parse for name in each.names]
            return f"{given} is not an option{_of(chain)}; {_nearest(given, names) or help_of(chain)}"
    return _with_hint(" ".join(str(error).split()), help_of(chain))


def commands(group: App) -> list[str]:
    """Names of the commands of a group."""
    return [name for name in group if not name.startswith("-")]


def _in_a_group(token: str, group: App) -> str:
    """The command of that name in a group of commands, "knee settle" for settle; several are joined by "or"."""
    found = [f"{name} {token}" for name in commands(group) if token in commands(group[name])]
    return "` or `".join(found)


def help_of(chain: Iterable[str]) -> str:
    """Where the options of a command are described."""
    return f"see {' '.join((NAME, *chain))} --help"


def _of(chain: Iterable[str]) -> str:
    return f" of {' '.join(chain)}" if tuple(chain) else ""


def _nearest(given: str, names: Iterable[str]) -> str:
    found = get_close_matches(given, list(names), n=1, cutoff=ALIKE)
    return f"did you mean {found[0]}?" if found else ""


def _with_hint(text: str, hint: str) -> str:
    """Sentence and remedy; a question keeps its mark and the remedy follows as a sentence of its own."""
    return f"{text} {hint.capitalize()}" if text.endswith("?") else f"{text.rstrip('.')}; {hint}"


def remedy_for(library: str) -> str:
    """What to install for `import library`: "pip install 'geocontact[dynamics]'"; "" where no extra brings it."""
    try:
        told = requires("geocontact") or []
    except PackageNotFoundError:  # run from a checkout that is not installed
        return ""
    wanted = library.partition(".")[0].lower()
    for line in told:
        name, extra = re.match(r"[\w-]*", line), re.search(r"""extra == ['"](\w+)['"]""", line)
        if name and extra and name[0].lower() == wanted and extra[1] not in FOR_WORK:
            return f"pip install 'geocontact[{extra[1]}]'"
    return ""
