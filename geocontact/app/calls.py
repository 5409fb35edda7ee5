"""What the words of a form are worth: the mistakes that the command line finds in them, and the same call in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cyclopts import CycloptsError

from geocontact.analyses.catalogue import entry_of
from geocontact.analyses.frame.options import Options, declared
from geocontact.cli.command import command_of
from geocontact.cli.main import app, refusal
from geocontact.data.errors import InputError

INDENT = "    "
WIDTH = 100


def read(words: Sequence[str], command: str) -> Options:
    """Options of a call, read as the command line reads them.

    Raises
    ------
    CycloptsError, InputError
        As the command line does.
    """
    _, bound, _ = app.parse_args(list(words), exit_on_error=False, print_error=False)
    return command_of(entry_of(command)).read(*bound.args, **bound.kwargs)


def checked(words: Sequence[str], command: str, out: Path | str) -> tuple[str, str]:
    """The call in Python, and what the command line would refuse at once, in its words; one of them is empty."""
    try:
        return python_lines(words, command, out), ""
    except (CycloptsError, InputError) as error:
        return "", " ".join(refusal(error).split())


def python_lines(words: Sequence[str], command: str, out: Path | str) -> str:
    """The call in Python; values in SI, defaults left out. "" where Python has none.

    Raises
    ------
    CycloptsError, InputError
        For words that the command line refuses.
    """
    entry = entry_of(command)
    options = read(words, command)
    if not entry.exported or (entry.many and options.given("many")):
        return ""
    call = ".".join(part for part in ("gc", entry.room, entry.name) if part)
    given = []
    for one in declared(type(options)):
        value = getattr(options, one.name)
        if one.settable and (one.required or repr(value) != repr(one.default)):
            plain = repr(_plain(value))
            given.append(plain if one.positional and one.required else f"{one.name}={plain}")
    inside = ", ".join(given)
    if len(inside) > WIDTH:
        inside = "\n" + "".join(f"{INDENT}{each},\n" for each in given)
    lines = f"result = {call}({inside})\nresult.write({str(out)!r})\n"
    if any(one.name == "workers" for one in declared(type(options))):  # processes import the script anew
        lines = 'if __name__ == "__main__":\n' + "".join(f"{INDENT}{line}\n" for line in lines.splitlines())
    return f"import geocontact as gc\n\n{lines}"


def _plain(value: Any) -> Any:
    """A value as a literal of Python: paths become text."""
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, tuple):
        return tuple(map(_plain, value))
    if isinstance(value, Mapping):
        return {name: _plain(each) for name, each in value.items()}
    return value.item() if hasattr(value, "item") else value
