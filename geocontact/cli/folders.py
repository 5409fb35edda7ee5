"""A folder in place of a recording: `geocontact ik SESSION --trial walk1`, before the tokens are parsed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from geocontact.cli.opensim_setup import warnings_in_a_line
from geocontact.data.errors import InputError

TRIAL, OUT = "--trial", "--out"
COMMANDS = ("ik", "id", "scale", "markers", "sit-to-stand coordinates")
HELP = (
    "A folder as OpenCap, AddBiomechanics or Pose2Sim leave it, or one with trials, takes the place of the recording: "
    "model, mass and loads come from it unless they are typed. --trial NAME chooses; several have a folder each in OUT."
)
"""What their help says of it."""


@dataclass(frozen=True)
class FoundCall:
    """A call with files of a folder: tokens without the folder, lines that show it, what `run.json` says of it."""

    tokens: list[str]
    table: list[str]
    recognised: dict[str, object]


def calls_in_folder(tokens: Sequence[str]) -> list[FoundCall]:
    """One call for each trial, where a folder stands in place of the recording; else none."""
    command = next((c for c in COMMANDS if list(tokens[: len(c.split())]) == c.split()), "")
    if not command or "--help" in tokens or "-h" in tokens:
        return []
    words = command.split()
    rest, wanted = _without_trials(tokens[len(words) :])
    at = _place(rest)
    if at is None:
        if wanted:
            raise InputError("", TRIAL, "has no effect without a folder", "name the folder in place of the recording")
        return []
    from geocontact.analyses.motion.folder_inputs import folder_inputs

    typed = frozenset(token.partition("=")[0].removeprefix("--") for token in rest if token.startswith("--"))
    try:
        with warnings_in_a_line():
            found = folder_inputs(command, Path(rest[at]), wanted, typed)
    except InputError as error:
        raise InputError(error.file, *map(_spelled, (error.place, error.what, error.remedy))) from error
    others = rest[:at] + rest[at + 1 :]
    calls = []
    for one in found:
        own = others if len(found) == 1 else _into(others, one.trial)
        options = [f"--{name}={value}" for name, value in one.options]
        calls.append(FoundCall([*words, str(one.recording), *options, *own], one.table(), one.recognised()))
    return calls


def _spelled(text: str) -> str:
    """Options in backticks as they are typed."""
    return re.sub(r"`(\w+)`", r"--\1", text)


def _without_trials(tokens: Sequence[str]) -> tuple[list[str], list[str]]:
    """Tokens without `--trial NAME`, and the names."""
    rest, wanted, pending = [], [], False
    for token in tokens:
        if pending or token.startswith(f"{TRIAL}="):
            wanted.append(token if pending else token.partition("=")[2])
            pending = False
        elif token == TRIAL:
            pending = True
        else:
            rest.append(token)
    if pending:
        raise InputError("", TRIAL, "is missing its name", "give the name of a trial")
    return rest, wanted


def _place(rest: Sequence[str]) -> int | None:
    """Where the folder stands: the first token that is no option's value and is a folder, or a .b3d file."""
    for k, token in enumerate(rest):
        valued = k > 0 and rest[k - 1].startswith("--") and "=" not in rest[k - 1]
        if not token.startswith("-") and not valued and (Path(token).is_dir() or token.lower().endswith(".b3d")):
            return k
    return None


def _into(tokens: Sequence[str], trial: str) -> list[str]:
    """The same with results in a folder of the trial."""
    found = list(tokens)
    for k, token in enumerate(found):
        if token.startswith(f"{OUT}="):
            found[k] = f"{OUT}={Path(token.partition('=')[2]) / trial}"
        elif token == OUT and k + 1 < len(found):
            found[k + 1] = str(Path(found[k + 1]) / trial)
    return found
