"""What a study may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Missing, Requires, Spelled, Texts, Typed
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.shared_options import CyclePart, Side
from geocontact.data.errors import InputError
from geocontact.data.plausible import TRIAL_LIMIT

LOCAL = "local"


QUEUES = ("slurm", "pbs", "lsf", "sge")
"""Queueing systems, as `study.cluster` starts jobs of them."""


@dataclass(frozen=True)
class CohortOptions(Options):
    """One analysis of many subjects, trials, conditions and settings, on this machine or a cluster.

    Parameters
    ----------
    study
        Description of the study (.toml): the analysis, its options, and the differences between its trials.
    folder
        Folder that paths in it start from; that of the description by default.

    Gait cycles
    -----------
    events
        Table side, event, time [s] (heel strike, toe off), with recording (the trial's, or its file's name): each curve
        is the mean over the cycles of its trial, and shifts.csv says how conditions differ.
    cycle_side
        Side whose cycles count, where the events are of both.
    part
        Use only this first part of each cycle: 60%, or stance, which ends at the toe off.

    What is evaluated
    -----------------
    dry_run
        Evaluate and write nothing: say of each step what has results, what would be evaluated and how long that took
        before.
    only
        Evaluate only trials that have this value, subject=P1; may be given again for another name. Other results are
        used where they are there.
    from_step
        Evaluate this step and all that takes from it anew.
    forget
        Evaluate this step anew; later ones follow where its files come out different.
    redo_failed
        Evaluate only what trials.csv of the last run names as failed, set aside or an input error, and what takes from
        it.
    clean_up
        Remove results in results/… that no description asks for.

    Work
    ----
    run_simulator
        Start what the study's files name: an analysis or a model in a module of others, a program of a gap case.
        Whatever the files say, nothing is started without.
    scheduler
        Address of a Dask scheduler, such as tcp://host:8786; slurm, pbs, lsf or sge: jobs of [cluster]; local: this
        machine.
    workers
        Processes on this machine; as many as there are cores, and memory for them, by default.
    memory
        Most memory that the process of a trial may hold: 4GB. One that holds more is ended, tried once more with twice
        that, and set aside after that.
    limit
        Longest that a trial may take: it is ended then, tried once more with twice that time, and set aside after that.
    cores
        Cores of each trial; 1 by default.
    """

    writes: ClassVar[str] = """
    Writes results/… (a folder for each trial), trials.csv (status of each trial), tables/… (the tables of all trials as
    .parquet and .nc), report.html and run.json into OUT. It can be interrupted and run again at any time: only what is
    missing is evaluated, and the tables are the same. A trial that cannot be evaluated is one line, the others go on.
    """

    study: Path
    _: KW_ONLY
    folder: Annotated[Path | None, Missing("there is no such folder")] = None
    events: Path | None = None
    cycle_side: Annotated[Side | None, Requires("events")] = None
    part: Annotated[CyclePart | None, Requires("events")] = None
    dry_run: bool = False
    only: Texts = ()
    from_step: Annotated[str | None, Spelled("from")] = None
    forget: str | None = None
    redo_failed: bool = False
    clean_up: bool = False
    run_simulator: bool = False
    scheduler: str = LOCAL
    workers: int | None = None
    memory: str | None = None
    cores: int | None = None
    limit: Annotated[float | None, Typed("s", "finite", "600.0", "[s]", float), TRIAL_LIMIT] = None

    @property
    def local(self) -> bool:
        """Whether the work is done on this machine."""
        return self.scheduler == LOCAL

    @property
    def queueing(self) -> bool:
        """Whether the work is done by jobs."""
        return self.scheduler in QUEUES

    def refuse_impossible(self) -> None:
        """No process, no address, no size, and a choice without a value."""
        odd = next((each for each in self.only if not each.partition("=")[2]), None)
        if odd is not None:
            raise InputError("", "`only`", f"{odd!r} has no value", "write for example subject=P1")
        if not self.local and not self.queueing and "://" not in self.scheduler:
            remedy = f"write tcp://host:8786, {', '.join(QUEUES)}, or local"
            raise InputError("", "`scheduler`", f"{self.scheduler!r} is not an address", remedy)
        if not self.local and self.workers is not None:
            remedy = "write `jobs` into [cluster]" if self.queueing else "leave it out"
            raise InputError("", "`workers`", "has no effect with `scheduler`", remedy)
        from geocontact.study.limits import is_size  # not for help

        if self.memory is not None and not is_size(self.memory):
            raise InputError("", "`memory`", f"{self.memory!r} is not a size of memory", "write for example 4GB")
        for name in ("workers", "cores"):
            if (getattr(self, name) or 1) < 1 or getattr(self, name) == 0:
                raise InputError("", f"`{name}`", f"{getattr(self, name)} is less than one", "give 1 or more")
