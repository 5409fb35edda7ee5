"""Where an analysis puts what it has to say beside its numbers: warnings, sentences, inputs, figures of `run.json`.

The frame opens a collector around reading, computing and writing; whatever runs inside reaches it by the functions
below, without passing it along. Where none is open, in a script that calls a part of an analysis by itself, `reserve`
raises an `InputWarning` and the others do nothing. A thread begins without the collector of the one that starts it:
start it in `contextvars.copy_context()`.

>>> import warnings
>>> from geocontact.analyses.frame.record import Record
>>> with collecting(Record("area", {})) as record:
...     reserve("the surface is open")
...     say("two bodies")
>>> record.warnings, record.sentences
(['the surface is open'], ['two bodies'])
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geocontact.analyses.frame.record import Listener, Record
from geocontact.data.errors import InputWarning

if TYPE_CHECKING:
    from geocontact.identify.goodness_of_fit import GoodnessOfFit

OPEN: ContextVar[Record | None] = ContextVar("record of the run", default=None)
"""The record that is open; None where nobody collects."""


@contextmanager
def collecting(record: Record) -> Iterator[Record]:
    """A block whose warnings, sentences, inputs and figures go into `record`."""
    before = OPEN.set(record)
    try:
        with record.catching_warnings():
            yield record
    finally:
        OPEN.reset(before)


def current() -> Record:
    """The record that is open; else an empty one."""
    return OPEN.get() or Record("", {})


def reserve(line: str, *, cause: bool = False) -> None:
    """Keep a warning of the result, once; an `InputWarning` where no collector is open.

    `cause` is of inputs that contradict each other: a result that contradicts its data has its cause in them, and the
    command ends with 2.
    """
    record = OPEN.get()
    if record is None:
        warnings.warn(line, InputWarning, stacklevel=2)
    else:
        record.warn(line, cause=cause)


def say(text: str) -> None:
    """Keep a sentence of the result."""
    current().say(text)


def judge(fit: GoodnessOfFit, *, warned: bool = False) -> None:
    """Keep whether the result agrees with its data: in `run.json`, and a doubt as a warning, unless it was one already.

    What contradicts the data is the first of all sentences, and the command ends with 1, or with 2 (`reserve`).
    """
    current().judge(fit)
    if fit.outcome == "doubtful" and not warned:
        reserve(fit.words)


def contradicted() -> bool:
    """Whether what was judged so far contradicts its data."""
    return bool(current().judged)


def if_it_fits(text: str) -> str:
    """Words of an interval or of a claim; none where the result contradicts its data."""
    return "" if contradicted() else text


def as_it_fits(content: Mapping[str, Any]) -> dict[str, Any]:
    """A nested result for a file; without ends of intervals where the result contradicts its data."""
    from geocontact.analyses.frame.withheld import withheld_json  # late: --help needs no numpy

    return withheld_json(content) if contradicted() else dict(content)


def note(key: str, value: object) -> None:
    """Keep a figure of the result for `run.json`."""
    current().results[key] = value


def results() -> dict[str, object]:
    """Figures of the result for `run.json`, by name."""
    return current().results


def add_input(role: str, path: str | PathLike[str], **facts: object) -> None:
    """Keep a file that was read, with its SHA-256 and what is known of it."""
    if OPEN.get() is not None:
        current().add_input(role, path, **facts)


def spelled(text: str) -> str:
    """Options in backticks as the user wrote them."""
    return current().spell(text)


def listener() -> Listener:
    """Who is shown the progress of the work."""
    return current().listener


def results_place() -> Path | None:
    """Folder of the results; None where nothing is written."""
    return current().out


def seen_from_results(file: Path) -> str:
    """Path of an input as a file among the results names it: relative, so that no name of a user's folder is shared.

    Absolute where no relative path leads there, as from one drive of Windows to another.
    """
    place = results_place()
    whole = file.parent.resolve() / file.name  # OpenSim changes into the folder itself, behind symbolic links
    if place is None:
        return whole.as_posix()
    try:
        return os.path.relpath(whole, place.resolve()).replace(os.sep, "/")
    except ValueError:
        return whole.as_posix()
