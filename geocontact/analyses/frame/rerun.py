"""What `run.json` tells that is needed to run again, and what became of the inputs and the results since."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from geocontact.analyses.frame.folder import RUN, digest
from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import open_text, read_json

REMEDY = f"name the {RUN} that a command or `Result.write` left with its results"
TIMES = ("seconds", "cpu_seconds", "frames_per_second", "samples_per_second_of_one_core")
"""Keys of files of JSON that hang on how fast the machine was."""
TIMED = ("cpu [s]", "wall [s]", "seconds [s]")
"""Columns of tables that do."""
_UNIT = re.compile(r" \[[^\]]*\]$")


@dataclass(frozen=True)
class EarlierRun:
    """A run as it was recorded.

    Parameters
    ----------
    folder
        Of its results.
    command
        As it is typed.
    options
        As recorded: as typed where it was a command, else in SI with units in the names.
    recorded_si
        Options in SI, with units in the names.
    typed
        Whether it was a command.
    inputs
        SHA-256 of the files that were read.
    version
        Of geocontact.
    """

    folder: Path
    command: str
    options: Mapping[str, Any]
    recorded_si: Mapping[str, Any]
    typed: bool
    inputs: Mapping[Path, str]
    version: str

    def in_si(self) -> dict[str, Any]:
        """Options by their names in Python."""
        return {_UNIT.sub("", name): value for name, value in self.recorded_si.items()}

    def changed(self) -> list[Path]:
        """Inputs whose content is another one now; InputError for one that is not there."""
        for file in self.inputs:
            if not file.is_file():
                raise InputError(file, "", "is not there any more", "run again in the folder that names start from")
        return [file for file, known in self.inputs.items() if digest(file) != known]


def read_run(path: str | PathLike[str]) -> EarlierRun:
    """The run that a run.json, or the one in a folder, tells of."""
    file = Path(path) / RUN if Path(path).is_dir() else Path(path)
    told = _content(file)
    command, options, inputs = told.get("command"), told.get("options"), told.get("inputs")
    if not (isinstance(command, str) and isinstance(options, dict) and isinstance(inputs, list)):
        raise InputError(file, "", f"is not a {RUN} of geocontact", REMEDY)
    named = [each for each in inputs if isinstance(each, dict) and isinstance(each.get("file"), str)]
    known = {Path(each["file"]): str(each.get("sha256")) for each in named}
    recorded_si = told.get("options_si", options)
    if not isinstance(recorded_si, dict):
        raise InputError(file, "options_si", f"is not of a {RUN} of geocontact", REMEDY)
    typed = options != recorded_si
    return EarlierRun(file.parent, command, options, recorded_si, typed, known, str(told.get("geocontact", "")))


def results_of(folder: Path) -> dict[str, str]:
    """SHA-256 of every file that the run in a folder wrote, its sub-folders included."""
    found: dict[str, str] = {}
    for run in sorted(folder.rglob(RUN)):
        told = _content(run).get("sha256")
        place = run.parent.relative_to(folder)
        found |= {(place / name).as_posix(): known for name, known in told.items()} if isinstance(told, dict) else {}
    return found


def differing(before: Mapping[str, str], after: Mapping[str, str], old: Path, new: Path) -> list[str]:
    """Files of either run that the other has not, or has with other content; the time a run took is no content."""
    return [
        name
        for name in sorted({*before, *after})
        if before.get(name) != after.get(name) and not _alike(old / name, new / name)
    ]


def _alike(old: Path, new: Path) -> bool:
    """Whether two files differ in nothing but how fast they were made."""
    if not (old.is_file() and new.is_file()):
        return False
    if old.suffix == ".csv":
        return _without_times(old) == _without_times(new)
    if old.suffix != ".json":
        return False
    one, other = _content(old), _content(new)
    return {**one, **dict.fromkeys(TIMES)} == {**other, **dict.fromkeys(TIMES)}


def _without_times(file: Path) -> list[list[str]]:
    """Rows of a table without the columns that hold times of the machine."""
    with open_text(file) as stream:
        rows = list(csv.reader(stream))
    kept = [k for k, name in enumerate(rows[0]) if name not in TIMED] if rows else []
    return [[row[k] for k in kept if k < len(row)] for row in rows]


def _content(file: Path) -> dict[str, Any]:
    try:
        told = read_json(file)
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        raise InputError(file, "", "is not JSON", REMEDY) from error
    if not isinstance(told, dict):
        raise InputError(file, "", f"is not a {RUN} of geocontact", REMEDY)
    return told
