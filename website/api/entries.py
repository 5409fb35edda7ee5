"""What is public: the names of `geocontact.__all__`, those of its rooms of jobs, and those of `geocontact.chain`."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from types import ModuleType
from typing import Any

import geocontact
from geocontact import chain
from geocontact.analyses.catalogue import Room
from geocontact.analyses.frame.job import Job
from geocontact.chain.links import LawParameters
from geocontact.data.units import Unit

JOBS, FUNCTIONS, TYPES, CHAIN, UNITS = "Jobs", "Functions", "Types", "Models of one's own", "Units"
GROUPS = (JOBS, FUNCTIONS, TYPES, CHAIN, UNITS)


@dataclass(frozen=True)
class Entry:
    """One public name.

    Parameters
    ----------
    name
        As it is written after `gc.`.
    thing
        What it is.
    group
        One of `GROUPS`.
    """

    name: str
    thing: Any
    group: str

    @property
    def module(self) -> ModuleType:
        """Where it is defined; of a job, where it is put together."""
        if isinstance(self.thing, Job):
            homes = [part.__module__ for part in (self.thing.read, self.thing.run)]
            jobs = [f"{home.rpartition('.')[0]}.job" for home in homes]
            return next(sys.modules[each] for each in (*jobs, homes[1]) if each in sys.modules)
        if isinstance(self.thing, LawParameters):
            return import_module(f"{chain.__name__}.{self.name.rpartition('.')[2].lower()}")
        return sys.modules[Unit.__module__ if self.group == UNITS else _home(self.thing)]

    @property
    def example(self) -> str:
        """Docstring that holds its example: its own, of a job that of its module, of a unit that of all units."""
        if not isinstance(self.thing, (Job, Unit)):
            return "\n\n".join(_blocks(self.docstring))
        blocks = _blocks(inspect.getdoc(self.module) or "")
        return "\n\n".join(block for block in blocks if len(blocks) == 1 or f"{self.name}(" in block)

    @property
    def docstring(self) -> str:
        """What is said of it: of the numbers of a law, by the module of that law."""
        return inspect.getdoc(self.module if isinstance(self.thing, LawParameters) else self.thing) or ""

    @property
    def line(self) -> int:
        """Line of the source where it begins."""
        if isinstance(self.thing, (Job, Unit)) or not (inspect.isclass(self.thing) or inspect.isfunction(self.thing)):
            return 1
        return inspect.getsourcelines(self.thing)[1]


def entries() -> list[Entry]:
    """All of them, by group and name."""
    found = [*_front(), *_chain()]
    return sorted(found, key=lambda one: (GROUPS.index(one.group), one.name.lower()))


def _front() -> Iterator[Entry]:
    for name in geocontact.__all__:
        thing = getattr(geocontact, name)
        if isinstance(thing, Room):
            yield from (Entry(f"{name}.{job}", getattr(thing, job), JOBS) for job in thing.__all__)
        elif not isinstance(thing, ModuleType):
            yield Entry(name, thing, _group(thing))


def _chain() -> Iterator[Entry]:
    yield from (Entry(f"chain.{name}", getattr(chain, name), CHAIN) for name in chain.__all__)


def _group(thing: Any) -> str:
    if isinstance(thing, Job):
        return JOBS
    if isinstance(thing, Unit):
        return UNITS
    return TYPES if inspect.isclass(thing) else FUNCTIONS


def _home(thing: Any) -> str:
    return str(thing.__module__ if hasattr(thing, "__qualname__") else type(thing).__module__)


def _blocks(docstring: str) -> list[str]:
    """Paragraphs of a docstring that are typed into Python."""
    text = re.sub(r"^Examples\n-+\n", "", docstring, flags=re.MULTILINE)
    return [part.strip("\n") for part in text.split("\n\n") if part.lstrip().startswith(">>>")]
