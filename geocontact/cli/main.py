"""Entry point: parse, run one command, turn every failure into one line and an exit code."""

from __future__ import annotations

import atexit
import errno
import gc
import os
import signal
import sys
import traceback
from collections.abc import Sequence
from io import TextIOWrapper

from cyclopts import App, CycloptsError, MissingArgumentError

from geocontact.analyses.catalogue import ENTRIES, GROUPS
from geocontact.analyses.frame.folder import discard_drafts, what_stays
from geocontact.analyses.frame.record import recognised
from geocontact.cli.command import place_of, spelling
from geocontact.cli.folders import FoundCall, calls_in_folder
from geocontact.cli.opensim_setup import with_setup
from geocontact.cli.suggestions import help_of, mistyped, remedy_for
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION

HELP = "--help", "-h"
USAGE_ERROR = 2
FAILURE = 1
COLLECT = 100_000
"""New objects after which Python looks for circles of them: imports and numba's compiler make millions that stay."""
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)

OWN = {
    "app": "geocontact.app.command:window",
    "demo": "geocontact.cli.demo:demo",
    "doctor": "geocontact.cli.doctor:doctor",
    "rerun": "geocontact.cli.rerun:rerun",
    "view": "geocontact.cli.view:view",
}
"""Commands that are no analysis."""


def made() -> App:
    """The command line: groups and analyses of the catalogue, and `OWN`; imported when they are asked for."""
    app = App(
        name="geocontact",
        help="Contact areas, contact forces and material properties from meshes, motion and pressure data.",
        version=VERSION,
        version_flags=["--version"],
        help_format="plaintext",  # <trial>, [N] and * are what they are
        suppress_keyboard_interrupt=False,
    )
    groups = {group.name: App(name=group.name, help=group.help) for group in GROUPS}
    alone = {each.command: place_of(each) for each in ENTRIES if each.command and each.group is None}
    single: dict[str, App | str] = {**OWN, **alone, **groups}
    for name, command in sorted(single.items()):
        if isinstance(command, App):
            app.command(command)
        else:
            app.command(command, name=name)
    for each in ENTRIES:
        if each.group is not None:
            name = each.command.partition(" ")[2]
            groups[each.group.name].command(place_of(each), name=(name, each.also) if each.also else name)
    app.register_install_completion_command(
        help="Let the shell complete commands, options and their choices (bash, zsh, fish, PowerShell)."
    )
    return app


app = made()


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit: 0 done, 2 for a mistake in the input, 1 for any other failure."""
    tokens = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in tokens
    collect_seldom()
    signal.signal(signal.SIGTERM, _terminated)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):  # a file name that the terminal cannot show costs no result
            stream.reconfigure(errors="backslashreplace")
    sys.exit(run([token for token in tokens if token != "--debug"], debug))


def collect_seldom() -> None:
    """Look for circles of objects after `COLLECT` new ones only, and not at all at the end of the process.

    There Python would take half a second after a long call to free one by one what the system frees at once.
    """
    gc.set_threshold(COLLECT)
    atexit.register(gc.freeze)


def run(tokens: Sequence[str], debug: bool = False) -> int:
    """Exit code of one call; with `debug` a traceback precedes the line that says what went wrong."""
    try:
        return _called(tokens, debug)
    except (CycloptsError, InputError) as error:
        return _fail(refusal(error), USAGE_ERROR, debug)
    except ModuleNotFoundError as error:
        remedy = remedy_for(error.name or "")
        line = (
            f"{error.name} is needed here and not installed; {remedy}"
            if remedy
            else f"{error} (run again with --debug)"
        )
        return _fail(line, USAGE_ERROR if remedy else FAILURE, debug)
    except KeyboardInterrupt:
        return _fail(f"interrupted; {what_stays()}", 130, debug)
    except BrokenPipeError:
        return FAILURE
    except OSError as error:
        stays = f"; {what_stays()}" if error.errno in NO_ROOM else ""
        return _fail(f"{refusal(error)}{stays}", FAILURE, debug)
    except MemoryError:
        return _fail("not enough memory; decimate the meshes or evaluate fewer frames", FAILURE, debug)
    except Exception as error:  # the last line of defence: one line for the user, --debug for us
        return _fail(f"{type(error).__name__}: {error} (run again with --debug for the details)", FAILURE, debug)


def refusal(error: CycloptsError | InputError | OSError) -> str:
    """What is wrong with the words of a call, with its input or with the file system, in one line."""
    if isinstance(error, OSError):
        return f"{error.filename or 'file system'}: {error.strerror or error}"
    if isinstance(error, MissingArgumentError):
        name = str(error.argument.name) if error.argument else "an argument"
        unit = "mesh files carry no unit; pass --unit mm, cm, m or in"
        hint = unit if name == "--unit" else f"{_words(error)}{help_of(error.command_chain or ())}"
        return f"{name} is missing: {hint}"
    return mistyped(error, app) if isinstance(error, CycloptsError) else str(error)


def _called(tokens: Sequence[str], debug: bool) -> int:
    tokens = with_setup(tokens)
    if found := calls_in_folder(tokens, spelling):
        return max([_run_found(each, debug) for each in found])
    _load_what_is_listed(tokens)
    result = app(tokens, exit_on_error=False, print_error=False, result_action="return_value")
    return result if isinstance(result, int) else 0


def _run_found(call: FoundCall, debug: bool) -> int:
    """One trial of a folder: which file plays which part, then the command."""
    print("\n".join(call.table))
    with recognised(call.recognised):
        return run(call.tokens, debug)


def _words(error: MissingArgumentError) -> str:
    """First sentence of the help of what is missing: "a mesh of the body; "."""
    words = (error.argument.parameter.help or "") if error.argument else ""
    first = words.split(". ")[0].rstrip(".")
    name = first.partition(" ")[0]
    return f"{first if name[1:] != name[1:].lower() else first[:1].lower() + first[1:]}; " if first else ""


def _terminated(*_: object) -> None:
    """End at once and leave nothing behind; an exception could be lost in compiled code."""
    discard_drafts()
    os.write(2, f"terminated; {what_stays()}\n".encode(errors="replace"))
    os._exit(143)


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _load_what_is_listed(tokens: Sequence[str]) -> None:
    """Import all commands of a group whose help is asked for, so that each says what it does."""
    _, apps, left = app.parse_commands([token for token in tokens if token not in HELP])
    if not left:
        for name in apps[-1]:
            apps[-1][name]


def _fail(line: str, code: int, debug: bool) -> int:
    if debug:
        traceback.print_exc()
    print(_one_line(line), file=sys.stderr)
    return code
