"""What a command says of a wrong input, in lines that begin with how it says it."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd
import pytest

from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.record import Record
from geocontact.data.errors import InputError, InputWarning
from tests.cli.calls import call

Lines = list[str]


class Finding(NamedTuple):
    """A wrong input that somebody tried, and what has to be heard of it.

    Parameters
    ----------
    attempt
        Makes the input in a folder and calls the command; what is heard.
    words
        How the line about it begins that has to be among them ("refused", "warned", "contradicts", or "said" where it
        is the answer), and a word of its cause; a pattern.
    slow
        Whether it takes more than three seconds.
    long
        Whether it takes more than a minute.
    silent
        Why nothing is heard yet; empty where it is.
    alarm
        What no line on a right input holds: the words without numbers and names of the wrong input. Where they are not
        given, what stands last in `words`.
    """

    attempt: Callable[[Path], Lines]
    words: str
    slow: bool = False
    long: bool = False
    silent: str = ""
    alarm: str = ""

    @property
    def forbidden(self) -> str:
        """Pattern of the same alarm, whatever its numbers."""
        last = self.words.rpartition(".*")[2].removeprefix("warned: ")
        return self.alarm or last


def as_parameters(findings: dict[str, Finding]) -> list[Any]:
    """The rows of a table of findings for pytest."""
    return [
        pytest.param(
            each,
            id=name,
            marks=[
                *([pytest.mark.slow] if each.slow or each.long else []),
                *([pytest.mark.long] if each.long else []),
                *([pytest.mark.xfail(strict=True, reason=each.silent)] if each.silent else []),
            ],
        )
        for name, each in findings.items()
    ]


def heard(job: Callable[..., Any], *given: object, **options: object) -> Lines:
    """What an analysis says that is called from Python."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", InputWarning)
        try:
            result = job(*given, **options)
        except InputError as error:
            return [f"refused: {error}"]
    lines = [f"warned: {each.message}" for each in said] + [f"warned: {each}" for each in result.warnings]
    how = "contradicts" if result.fit_outcome == "contradicts" else "said"
    return lines + [f"{how}: {each}" for each in result.sentences]


def heard_reading(read: Callable[[Any], object], options: Callable[..., Any], *given: object, **more: object) -> Lines:
    """What an analysis says while it reads, before it computes."""
    with collecting(Record("test", {})) as record:
        try:
            read(options(*given, **more))
        except InputError as error:
            return [f"refused: {error}"]
    return [f"warned: {each}" for each in record.warnings]


def as_lines(said: Iterable[str]) -> Lines:
    """Warnings and refusals as `tests.trial_checks.test_commands` has them."""
    return [line if line.startswith("refused") else f"warned: {line}" for line in said]


def typed(*words: object) -> Lines:
    """What a command says."""
    result = call(*words)
    lines = [f"warned: {each}" for each in result.warnings]
    if result.code == 1:
        lines += [f"contradicts: {each}" for each in result.out.splitlines()]
    return lines + [f"refused: {each}" for each in result.complaints if result.code == 2]


def times(file: Path, folder: Path, factor: float, *columns: str) -> Path:
    """A copy of a .sto or .mot with columns multiplied, those whose names hold any of these letters."""
    head, body = file.read_text().split("endheader\n")
    names, *rows = body.splitlines()
    wanted = columns or ("",)
    at = [k for k, name in enumerate(names.split()) if name != "time" and any(part in name for part in wanted)]
    cells = [row.split() for row in rows if row.strip()]
    for row in cells:
        for k in at:
            row[k] = repr(factor * float(row[k]))
    copy = folder / file.name
    copy.write_text(f"{head}endheader\n" + "\n".join([names, *("\t".join(row) for row in cells)]) + "\n")
    return copy


def changed_csv(file: Path, folder: Path, **columns: Callable[[pd.Series], pd.Series]) -> Path:
    """A copy of a .csv with columns changed, those whose names begin so."""
    table = pd.read_csv(file, comment="#")
    for begin, change in columns.items():
        for name in table.columns:
            if name.startswith(begin):
                table[name] = change(table[name])
    copy = folder / file.name
    table.to_csv(copy, index=False)
    return copy
