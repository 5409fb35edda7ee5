"""Record of a run: inputs with their hashes, options, reservations and sentences, and who hears of the work."""

from __future__ import annotations

import json
import platform
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from importlib.metadata import PackageNotFoundError, version
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from geocontact.analyses.frame.folder import RUN, digest, written
from geocontact.analyses.frame.in_memory import InMemory
from geocontact.analyses.frame.table_forms import AS_ALWAYS, TableForms
from geocontact.analyses.frame.warning_kinds import merged
from geocontact.data.errors import InputWarning
from geocontact.data.version import VERSION

if TYPE_CHECKING:
    from geocontact.identify.goodness_of_fit import GoodnessOfFit


class Listener:
    """Hears nothing; whoever shows something overrides what it hears."""

    def warn(self, line: str) -> None:
        """A warning, or one line for all of a kind from one stage of the work."""

    def fail(self, line: str) -> None:
        """A part of the work that could not be done, in one line; the rest goes on."""

    def preparing(self) -> AbstractContextManager[None]:
        """Kernels may be compiled in this block, which takes a while once on a machine."""
        return nullcontext()

    def progress(self, label: str, total: int) -> AbstractContextManager[Callable[[], None]]:
        """A block that calls what it is given after each of `total` steps."""
        return nullcontext(lambda: None)

    def stages(self, label: str) -> AbstractContextManager[Callable[[str], None]]:
        """A block that names the stages of its work as they begin."""
        return nullcontext(lambda _: None)


FOLDER: ContextVar[Mapping[str, object] | None] = ContextVar("folder that inputs were found in", default=None)
"""What was recognised in it; None where files were named one by one."""


@contextmanager
def recognised(found: Mapping[str, object]) -> Iterator[None]:
    """A block whose runs take their files from a folder; its `warnings` are theirs."""
    before = FOLDER.set(found)
    try:
        yield
    finally:
        FOLDER.reset(before)


NO_FIGURES = "no_figures"
"""Option of a run that wrote no figures."""
LIBRARIES = ("numpy", "scipy", "numba", "libigl", "python-fcl", "pandas", "matplotlib")


def as_python(text: str) -> str:
    """A message as Python shows it: options are arguments, in backticks."""
    return text


@dataclass
class Record:
    """Collects what a run has to tell beside its numbers, and what `run.json` says.

    Parameters
    ----------
    command
        Name of the analysis, as it is typed.
    options
        What was asked for: as typed on the command line, else in SI.
    in_si
        The same in SI, with units in the names.
    inputs
        Files that were read, with their SHA-256.
    warnings
        Reservations, each one line.
    causes
        Those of them by which inputs contradict each other.
    results
        Summary by name.
    tables
        What the tables refer to, such as point and frame, by the name of their file.
    sentences
        What was found.
    fit
        Whether the result agrees with its data; None where nothing was compared.
    listener
        Hears of the work while it goes on.
    spell
        Turns options in backticks into what the user wrote them as.
    forms
        Further forms of the tables.
    out
        Where results will be; None where nothing is written. What is whole by itself may be put there at once.
    without
        Parts of a result that are not written.
    folder
        What was recognised in the folder that the files were found in; None where they were named.
    held
        Values of a Python session that stand where files are; their files are there as long as the record is.
    """

    command: str
    options: Mapping[str, object]
    in_si: Mapping[str, object] = field(default_factory=dict)
    inputs: list[dict[str, object]] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    causes: list[str] = field(default_factory=list)
    results: dict[str, object] = field(default_factory=dict)
    tables: dict[str, Mapping[str, object]] = field(default_factory=dict)
    sentences: list[str] = field(default_factory=list)
    fit: GoodnessOfFit | None = None
    started: float = field(default_factory=time.perf_counter)
    listener: Listener = field(default_factory=Listener)
    spell: Callable[[str], str] = as_python
    forms: TableForms = AS_ALWAYS
    out: Path | None = None
    without: frozenset[str] = frozenset()
    folder: Mapping[str, object] | None = field(default_factory=FOLDER.get)
    held: InMemory = field(default_factory=InMemory)
    _holds: bool = field(default=False, init=False, repr=False)

    def name_in_memory(self) -> None:
        """Replace files that stand for values of a Python session by what those are."""
        self.options = {name: self.held.plain(value) for name, value in self.options.items()}
        self.in_si = {name: self.held.plain(value) for name, value in self.in_si.items()}
        for one in self.inputs:
            one |= {name: self.held.spelled(fact) for name, fact in one.items() if isinstance(fact, str)}

    def add_input(self, role: str, path: str | PathLike[str], **facts: object) -> None:
        """Note a file with its SHA-256 and what is known of it."""
        known = facts.pop("sha256", None) or digest(Path(path))
        self.inputs.append({"role": self.spell(role), "file": fspath(path), "sha256": known, **facts})

    def warn(self, line: str, *, cause: bool = False) -> None:
        """Keep a reservation, once; `cause` where inputs contradict each other."""
        line = self.spell(" ".join(line.split()))
        if cause and line not in self.causes:
            self.causes.append(line)
        if line not in self.warnings:
            self.warnings.append(line)
            if not self._holds:
                self.listener.warn(line)

    @contextmanager
    def stage(self) -> Iterator[None]:
        """A part of the work after which its warnings are shown, one line for each kind; `warnings` keeps them all."""
        before, held = len(self.warnings), self._holds
        self._holds = True
        try:
            yield
        finally:
            self._holds = held
            for line in () if held else merged(self.warnings[before:]):
                self.listener.warn(line)

    def judge(self, fit: GoodnessOfFit) -> None:
        """Keep the outcome of a test of fit; of several the doubts of all, the worst of them first."""
        known = () if self.fit is None else self.fit.doubts
        tested = () if self.fit is None else self.fit.tested
        added = tuple(doubt for doubt in fit.doubts if doubt not in known)
        self.fit = replace(fit, doubts=(*known, *added), tested=(*tested, *fit.tested))

    @property
    def judged(self) -> str:
        """What contradicts the data, in a sentence; empty where nothing does."""
        known = self.fit
        if known is None or known.outcome != "contradicts":
            return ""
        cause = f"; its inputs contradict each other: {self.causes[0]}" if self.causes else ""
        return f"{self.spell(known.words)}{cause}"

    def say(self, text: str) -> None:
        """Keep a sentence of what was found."""
        self.sentences.append(self.spell(text))

    @contextmanager
    def catching_warnings(self) -> Iterator[None]:
        """Turn every `InputWarning` raised inside into one line."""
        with warnings.catch_warnings():
            warnings.simplefilter("always", InputWarning)
            warnings.showwarning = lambda message, category, *_, **__: (
                self.warn(str(message)) if issubclass(category, InputWarning) else None
            )
            yield

    def plain_options(self) -> dict[str, object]:
        """Options given or in force, as JSON holds them, and that figures were not written."""
        less = {NO_FIGURES: True} if "figures" in self.without else {}
        return {key: _plain(value) for key, value in self.options.items() if value is not None} | less

    def versions(self) -> dict[str, str]:
        """What it ran on."""
        return {"python": platform.python_version(), "platform": platform.platform(), **library_versions()}

    def write(self, *folders: Path) -> None:
        """Write `run.json` into each folder of results; they differ only in what lists the files beside it."""
        from geocontact.analyses.frame.json_file import plain  # late: --help needs no numpy
        from geocontact.analyses.frame.withheld import withheld_json

        results = plain(self.results)
        if self.judged:
            results = withheld_json(results)
        content = {
            "geocontact": VERSION,
            "command": self.command,
            "options": self.plain_options(),
            "options_si": {key: _plain(value) for key, value in self.in_si.items()},
            **({} if self.folder is None else {"folder": _plain(self.folder)}),
            "inputs": self.inputs,
            "results": results,
            **({} if self.fit is None else _fit_words(self.fit, self.causes)),
            "tables": {name: _plain(told) for name, told in self.tables.items()},
            "warnings": self.warnings,
            "versions": self.versions(),
            "seconds": round(time.perf_counter() - self.started, 3),
        }
        places = dict.fromkeys(folders)
        for folder in places:
            files = written(folder, places, self.command)
            told = {**content, "files": sorted((*files, RUN)), "sha256": files}
            text = json.dumps(told, indent=2, ensure_ascii=False)
            (folder / RUN).write_text(text + "\n", encoding="utf-8")


def _fit_words(fit: GoodnessOfFit, causes: list[str]) -> dict[str, object]:
    doubts = [{"what": doubt.what, "contradicts": doubt.contradicts} for doubt in fit.doubts]
    found = {"inputs contradict": causes} if causes and fit.outcome == "contradicts" else {}
    return {"fit": {"outcome": fit.outcome, "doubts": doubts, "tested": list(fit.tested), **found}}


def _plain(value: object) -> object:
    if isinstance(value, (str, int, float, bool)):
        return value
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    return str(value)


def library_versions() -> dict[str, str]:
    """Versions of the libraries that results depend on."""
    found = {}
    for name in LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "not installed"
    return found
