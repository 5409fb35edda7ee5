"""`--setup FILE`: OpenSim's own set-up file in place of typed inputs and options, which come before it."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from geocontact.data.errors import InputError, InputWarning

OPTION = "--setup"
COMMANDS = "ik", "id", "scale"
HELP = (
    "OpenSim's own set-up file takes the place of inputs and options: --setup FILE; options that are typed with it "
    "count instead of its own."
)
"""What their help says of it."""


def with_setup(tokens: Sequence[str]) -> list[str]:
    """The tokens, with what the set-up asks for in place of `--setup FILE`; options that are typed count instead."""
    command = tokens[0] if tokens else ""
    joined = [token for token in tokens if token.startswith(f"{OPTION}=")]
    if command not in COMMANDS or not (OPTION in tokens or joined):
        return list(tokens)
    from geocontact.analyses.motion.opensim_setup import setup_of

    rest = list(tokens[1:])
    if joined:
        rest.remove(joined[0])
        file = joined[0].partition("=")[2]
    else:
        at = rest.index(OPTION)
        if at + 1 == len(rest):
            raise InputError("", OPTION, "is missing its file", "give OpenSim's set-up file")
        file = rest[at + 1]
        del rest[at : at + 2]
    with warnings_in_a_line():
        setup = setup_of(command, Path(file))
    for what in setup.unheeded:
        print(f"warning: {file}: {what} is ignored", file=sys.stderr)
    typed = {token.partition("=")[0] for token in rest}
    told = [token for name, value in setup.options if f"--{name}" not in typed for token in _option(name, value)]
    return [command, str(setup.recording), *told, *rest]


@contextmanager
def warnings_in_a_line() -> Iterator[None]:
    """Warnings of a file that is read before the command, whose collector is not open yet."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", InputWarning)
        warnings.showwarning = lambda message, *_, **__: print(f"warning: {message}", file=sys.stderr)
        yield


def _option(name: str, value: str) -> list[str]:
    return [f"--{name}={value}"] if value else [f"--{name}"]
