"""A folder in place of a recording: `geocontact ik SESSION --trial walk1`, before the tokens are parsed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
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


Spelling = tuple[frozenset[str], Callable[[str], str]]
"""Options of a command without a value, and what spells names in backticks as they are typed."""


def calls_in_folder(tokens: Sequence[str], spelling: Callable[[str], Spelling]) -> list[FoundCall]:
    """One call for each trial, where a folder stands in place of the recording; else none.

    `spelling` gives that of a command.
    """
    command = next((c for c in COMMANDS if list(tokens[: len(c.split())]) == c.split()), "")
    if not command or "--help" in tokens or "-h" in tokens:
        return []
    words = command.split()
    rest, wanted = _without_trials(tokens[len(words) :])
    flags, spell = spelling(command)
    at = _place(rest, flags)
    if at is None:
        if wanted:
            raise InputError("", TRIAL, "has no effect without a folder", "name the folder in place of the recording")
        return []
    from geocontact.analyses.motion.folder_inputs import folder_inputs

    typed = {_name(token): _value(rest, k) for k, token in enumerate(rest) if token.startswith("--")}
    try:
        with warnings_in_a_line():
            found = folder_inputs(command, Path(rest[at]), wanted, frozenset(typed), typed.get("c3d_unit"))
    except InputError as error:
        raise InputError(error.file, *map(spell, (error.place, error.what, error.remedy))) from error
    others = rest[:at] + rest[at + 1 :]
    calls = []
    for one in found:
        own = others if len(found) == 1 else _into(others, one.trial)
        own = (
            own if _has_c3d([one.recording, *map(Path, own)]) or not _has_c3d(one.folder.iterdir()) else _unitless(own)
        )
        options = [f"--{name}={value}" for name, value in one.options]
        calls.append(FoundCall([*words, str(one.recording), *options, *own], one.table(), one.recognised()))
    return calls


def _name(token: str) -> str:
    """Name in Python of an option as it is typed."""
    return token.partition("=")[0].removeprefix("--").replace("-", "_")


def _value(tokens: Sequence[str], at: int) -> str | None:
    """Value of the option at a place, None where nothing follows."""
    _, equals, value = tokens[at].partition("=")
    return value if equals else tokens[at + 1] if at + 1 < len(tokens) else None


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


def _has_c3d(files: Iterable[Path]) -> bool:
    return any(file.suffix.lower() == ".c3d" for file in files)


def _unitless(tokens: Sequence[str]) -> list[str]:
    """Tokens without the unit of .c3d files, which the trial of a .trc beside them does not need."""
    rest = list(tokens)
    for k in range(len(rest) - 1, -1, -1):
        if rest[k].startswith("--c3d") and _name(rest[k]) == "c3d_unit":
            del rest[k : k + (1 if "=" in rest[k] else 2)]
    return rest


def _place(rest: Sequence[str], flags: frozenset[str]) -> int | None:
    """Where the folder stands: the token that is no option's value and is a folder, or a .b3d file."""
    found = []
    for k, token in enumerate(rest):
        before = rest[k - 1] if k else ""
        valued = before.startswith("--") and "=" not in before and before not in flags
        if not token.startswith("-") and not valued and (Path(token).is_dir() or token.lower().endswith(".b3d")):
            found.append(k)
    if len(found) > 1:
        raise InputError("", rest[found[1]], f"is a second folder beside {rest[found[0]]}", "name one")
    return found[0] if found else None


def _into(tokens: Sequence[str], trial: str) -> list[str]:
    """The same with results in a folder of the trial."""
    found = list(tokens)
    for k, token in enumerate(found):
        if token.startswith(f"{OUT}="):
            found[k] = f"{OUT}={Path(token.partition('=')[2]) / trial}"
        elif token == OUT and k + 1 < len(found):
            found[k + 1] = str(Path(found[k + 1]) / trial)
    return found
