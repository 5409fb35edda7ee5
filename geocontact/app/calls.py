"""What the words of a form are worth: the mistakes that the command line finds in them, and the same call in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path
from typing import Any

from cyclopts import CycloptsError

from geocontact.analyses.catalogue import entry_of
from geocontact.analyses.frame.options import Options, declared
from geocontact.app.fields import BEFORE, PROGRAM, Form
from geocontact.cli.command import FORMS, command_of, spelling
from geocontact.cli.folders import OUT, calls_in_folder
from geocontact.cli.main import app, refusal
from geocontact.cli.opensim_setup import with_setup
from geocontact.data.errors import InputError

INDENT = "    "
HELP = f"; see {PROGRAM} "
WIDTH = 100
WRITTEN = {name: f"{name}=True" for name in FORMS} | {"no_figures": "figures=False", "no_overwrite": "overwrite=False"}
"""Arguments of `Result.write`."""


def read(words: Sequence[str], command: str) -> Options:
    """Options of a call, read as the command line reads them.

    Raises
    ------
    CycloptsError, InputError
        As the command line does.
    """
    return _bound(words, command)[0]


def _bound(words: Sequence[str], command: str) -> tuple[Options, dict[str, Any]]:
    """Options of a call, and all that was typed by its name."""
    _, bound, _ = app.parse_args(list(words), exit_on_error=False, print_error=False)
    return command_of(entry_of(command)).read(*bound.args, **bound.kwargs), bound.kwargs


def _calls(words: Sequence[str]) -> dict[str, list[str]]:
    """What the command line makes of a call: one for each trial where a folder takes the place of the recording.

    By the names of the trials, "" where no folder does. Warnings are left to the run.
    """
    with redirect_stderr(StringIO()):
        tokens = with_setup(words)
        found = calls_in_folder(tokens, spelling)
    return {str(each.recognised["trial"]): each.tokens for each in found} or {"": tokens}


def expanded(form: Form, out: Path | str) -> dict[str, Form]:
    """The form with the inputs that a set-up file or a folder stands for: by the name of each of its trials, else "".

    Raises
    ------
    InputError, OSError
        For a set-up file or a folder that cannot be used.
    """
    if not any(one.name in BEFORE for one in form.fields):
        return {"": form}
    return {trial: Form.of_words(words) for trial, words in _calls(form.words(out)).items()}


def checked(words: Sequence[str], command: str, out: Path | str) -> tuple[str, str]:
    """The call in Python, and what the command line would refuse at once, in its words; one of them is empty."""
    try:
        return python_lines(words, command, out), ""
    except (CycloptsError, InputError, OSError) as error:
        return "", complaint(error)


def complaint(error: CycloptsError | InputError | OSError) -> str:
    """What is wrong, in one line, without where the help stands: that is in the form."""
    return " ".join(refusal(error).split()).partition(HELP)[0]


def python_lines(words: Sequence[str], command: str, out: Path | str) -> str:
    """The call in Python; values in SI, defaults left out. "" where Python has none.

    Raises
    ------
    CycloptsError, InputError
        For words that the command line refuses.
    """
    calls = list(_calls(words).values())
    lines = ""
    for tokens in calls:
        own = out if len(calls) == 1 else next(word for word in tokens if word.startswith(f"{OUT}=")).partition("=")[2]
        lines += _one_call(tokens, command, own)
    if "workers" in {one.name for one in declared(entry_of(command).load_options())}:  # they import the script anew
        lines = lines and 'if __name__ == "__main__":\n' + "".join(f"{INDENT}{each}\n" for each in lines.splitlines())
    return lines and f"import geocontact as gc\n\n{lines}"


def _one_call(words: Sequence[str], command: str, out: Path | str) -> str:
    entry = entry_of(command)
    options, typed = _bound(words, command)
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
    forms = [WRITTEN[name] for name in FORMS if typed.get(name)]
    return f"result = {call}({inside})\nresult.write({', '.join([repr(str(out)), *forms])})\n"


def _plain(value: Any) -> Any:
    """A value as a literal of Python: paths become text."""
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, tuple):
        return tuple(map(_plain, value))
    if isinstance(value, Mapping):
        return {name: _plain(each) for name, each in value.items()}
    return value.item() if hasattr(value, "item") else value
