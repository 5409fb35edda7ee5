"""One frame for every analysis: called from Python it returns a result, executed it also fills a folder."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from inspect import Parameter, Signature
from os import fspath
from pathlib import Path
from typing import Any, Generic, TypeVar

from geocontact.analyses.frame.calls import python_help, require_arguments
from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.folder import written_whole
from geocontact.analyses.frame.in_memory import InMemory
from geocontact.analyses.frame.options import Declared, Options, declared
from geocontact.analyses.frame.record import Listener, Record, as_python
from geocontact.analyses.frame.result import Part, Result
from geocontact.analyses.frame.table_forms import AS_ALWAYS, TableForms
from geocontact.analyses.frame.warning_kinds import merged
from geocontact.data.errors import InputError, InputWarning

I = TypeVar("I")
R = TypeVar("R", bound=Result)


class Job(Generic[I, R]):
    """An analysis: its name, its options, and what reads and computes.

    Called with the options' arguments it returns the result; reservations become `InputWarning`s.

    Parameters
    ----------
    command
        Name, as it is typed.
    options
        Class of the options, below `Options`.
    read
        Reads what the options name.
    run
        Computes from what was read. Both reach the record of the run by `frame.collector`.
    """

    def __init__(
        self,
        command: str,
        options: type[Options],
        read: Callable[[Any], I],
        run: Callable[[I, Any], R],
    ) -> None:
        self.command, self.options, self.read, self.run = command, options, read, run
        self.__doc__ = python_help(options, run)
        self.__name__ = command.replace(" ", "_")

    @property
    def __signature__(self) -> Signature:
        """Names, types and defaults of the options, without what only the command line needs."""
        return Signature([_parameter(one) for one in declared(self.options) if one.settable])

    def __call__(self, *inputs: Any, **options: Any) -> R:
        """Read and compute; nothing is written. Arguments are those of `__signature__`.

        A path may be text. Where a file is asked for, a `DataFrame`, an array of rows, a `trimesh.Trimesh`, a
        `pyvista.PolyData`, a triangle mesh of open3d or a `gc.Motion` may be given as well.
        """
        require_arguments(self.command, self.options, inputs, options)
        held = InMemory()
        placed = dict(zip([one.name for one in declared(self.options) if one.positional], inputs, strict=False))
        given = held.replaced(placed | options)
        try:
            asked = self.options(**given)
            asked.refuse_missing_files()
            record = Record(self.command, asked.in_si(), asked.in_si(), spell=held.spelled, held=held)
            with collecting(record):
                tell_doubts(asked, record)
                result = self.run(self.read(asked), asked)
        except InputError as error:
            if not held.words:
                raise
            parts = map(held.spelled, (fspath(error.file), error.place, error.what, error.remedy))
            raise InputError(*parts) from error
        record.name_in_memory()
        for line in (*((record.judged,) if record.judged else ()), *merged(record.warnings)):
            warnings.warn(line, InputWarning, stacklevel=2)
        return result

    @property
    def place(self) -> str:
        """Where it is in Python: "gc.shoulder.simulate"; "" where no package of geocontact lists it."""
        home = self.run.__module__
        name = next((name for name, each in vars(sys.modules[home]).items() if each is self), "")
        for package in (home.rsplit(".", count)[0] for count in range(1, home.count(".") + 1)):
            if name in getattr(sys.modules.get(package), "__all__", ()):
                return ".".join(("gc", *package.split(".")[2:], name))
        return ""

    def __repr__(self) -> str:
        inputs = [one.name for one in declared(self.options) if one.settable and one.positional]
        count = sum(one.settable and not one.positional for one in declared(self.options))
        return f"<analysis {self.place or self.command}({', '.join(inputs)}, …): {count} options, see help()>"


def _parameter(one: Declared) -> Parameter:
    kind = Parameter.POSITIONAL_OR_KEYWORD if one.positional else Parameter.KEYWORD_ONLY
    default = Parameter.empty if one.required else one.default
    return Parameter(one.name, kind, default=default, annotation=one.kind | None if one.optional else one.kind)


def tell_doubts(options: Options, record: Record) -> None:
    """What is unusual about options, and about the folder they were found in, is a reservation of the result."""
    told = (record.folder or {}).get("warnings", ())
    for line in (*options.doubts(), *(map(str, told) if isinstance(told, Sequence) else ())):
        record.warn(line)


@dataclass(frozen=True)
class Call:
    """How the command line called an analysis.

    Parameters
    ----------
    typed
        Options as typed.
    listener
        Hears of the work.
    spell
        Turns options in backticks into what was typed.
    forms
        Further forms of the tables.
    overwrite
        Whether a folder that holds results already may be written into.
    without
        Parts that are not written.
    """

    typed: Mapping[str, object]
    listener: Listener
    spell: Callable[[str], str] = as_python
    forms: TableForms = AS_ALWAYS
    overwrite: bool = True
    without: frozenset[Part] = frozenset()


def execute(job: Job[Any, R], options: Options, out: Path, call: Call) -> tuple[R, list[str]]:
    """Evaluate and write into `out`, whole or not at all; the result and the names of the files."""
    record = Record(
        job.command,
        call.typed,
        options.in_si(),
        listener=call.listener,
        spell=call.spell,
        forms=call.forms,
        out=out,
        without=call.without,
    )
    with collecting(record), written_whole(out, call.overwrite) as draft:
        with record.stage():
            tell_doubts(options, record)
            inputs = job.read(options)
        with record.stage():
            result = job.run(inputs, options)
            del inputs  # a long recording, while its results are written
            return result, result.put(draft)
