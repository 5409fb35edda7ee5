"""Jobs of a queueing system as workers of a study: `scheduler` slurm, pbs, lsf or sge, through dask-jobqueue.

The study's process is the scheduler, on the machine where it is started; jobs come to it by TLS, with certificates of
this run in a file that only the user can read. What a site needs besides (further directives, modules) is Dask's own
`jobqueue.yaml`: of a study, which may come from others, no text reaches a shell.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from geocontact.analyses.frame.workers import OURS, SAFE_PATH
from geocontact.data.errors import InputError
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, Holds, Word
from geocontact.study.limits import TRIES, Count, Size, TrialLimits, bytes_of, size_text

WORD = re.compile(r"[\w.@:+-]{1,80}")
WALLTIME = re.compile(r"([0-9]{1,4}):([0-5][0-9]):([0-5][0-9])")
ANSWERS = 30.0  # s; for the queue to say what is in it
POSIX = os.name == "posix"
SILENT = 600.0  # s; after which a queue that says nothing is taken as one without jobs of the study
TAKES = 120.0  # s; for the queue to take a job
LATE = "Exit code: 124"  # what Dask says of a program that `timeout` ended
LOGS = "jobs"
"""Sub-folder for what jobs print."""
KEYS = ".dask-jobqueue.worker."
"""How the names of certificates begin that dask-jobqueue writes there for the time of the run."""
PATH = re.compile(r"[\w.@:+/-]+")
"""Paths that every system's directives take as they are."""
LONG = "--"  # so begin options of `dask worker`
USED = 0.9
"""Share of a job's memory for trials where the description does not say how much it has."""
NANNY = 0.95
"""Dask's nanny ends a process that holds this share of its memory."""
KEEPS = "export DASK_DISTRIBUTED__WORKER__MEMORY__TERMINATE=False"
"""Unless this is said: where trials may hold more, their own limit and the queue's are enough."""
LISTED = re.compile(r" {0,10}([0-9]+)(?=[\s._\[]|$)")
"""Number of a job, where a line of what a queue lists begins."""
LOST = 20.0  # s; after which a job that was there and is gone is submitted anew


def _plain(word: str) -> str:
    if not WORD.fullmatch(word):
        raise refusal(f"{word!r:.60} is not a name", "write letters, digits and . @ : + - _")
    return word


def _walltime(text: str) -> str:
    if not WALLTIME.fullmatch(text):
        raise refusal(f"{text!r:.60} is not a time", example='"04:00:00"')
    return text


Name = Annotated[Word, AfterValidator(_plain), Holds("name")]


class ClusterSettings(Document):
    """Jobs of `scheduler` slurm, pbs, lsf and sge.

    SGE: memory and cores go into Dask's `jobqueue.yaml`.

    Parameters
    ----------
    jobs
        Most jobs at a time.
    cores
        Of each job, which evaluates as many trials at a time as they have room for.
    memory
        Of each job; by default 2.2 times that of `[limits]` per trial.
    walltime
        Trials that a job has not finished begin again in another.
    queue
        Queue or partition.
    account
        Account or project.
    """

    jobs: Annotated[Count, Field(examples=["10"])]
    cores: Count = 1
    memory: Size | None = None
    walltime: Annotated[str, AfterValidator(_walltime), Holds("hours:minutes:seconds")] = "04:00:00"
    queue: Name | None = None
    account: Name | None = None

    @property
    def seconds(self) -> int:
        """Longest that a job lasts [s]."""
        hours, minutes, seconds = (int(each) for each in self.walltime.split(":"))
        return 3600 * hours + 60 * minutes + seconds


@dataclass(frozen=True)
class QueueingSystem:
    """A queueing system.

    Parameters
    ----------
    cluster
        Class of dask-jobqueue.
    submits, lists
        Commands that submit and list jobs.
    state
        Column of the state in that list, from 0.
    over
        Pattern of states in which a job does nothing more, though it may be listed for long.
    account
        The keyword for who pays.
    """

    cluster: str
    submits: str
    lists: tuple[str, ...]
    state: int
    over: re.Pattern[str]
    account: str = "account"

    def alive(self, said: str) -> set[str]:
        """Numbers of the jobs in a list that run or may still run; one without a state may."""
        found = set()
        for line in said.splitlines():
            words, number = line.split(), LISTED.match(line)
            if number and not (len(words) > self.state and self.over.fullmatch(words[self.state])):
                found.add(number[1])
        return found


SYSTEMS = {
    "slurm": QueueingSystem(
        "SLURMCluster", "sbatch", ("squeue", "-h", "-o", "%i %t"), 1, re.compile("CG|CD|CA|F|TO|NF|OOM|BF|DL|PR")
    ),
    "pbs": QueueingSystem("PBSCluster", "qsub", ("qstat",), 4, re.compile("[ECFX]")),
    "lsf": QueueingSystem("LSFCluster", "bsub", ("bjobs",), 2, re.compile("DONE|EXIT|ZOMBI"), "project"),
    "sge": QueueingSystem("SGECluster", "qsub", ("qstat",), 4, re.compile("d.*|E.*"), "project"),
}
"""States by the manuals of squeue(1), qstat of PBS and of SGE, bjobs(1): a job whose node does not answer stays
`completing` or `deleted` in the list for as long as the node is away; one of SGE in error waits for somebody."""


@dataclass(frozen=True)
class JobSize:
    """What a job has: processes that each evaluate one trial at a time, and bytes of memory."""

    processes: int
    memory: int


def job_size(asked: ClusterSettings, limits: TrialLimits, file: Path) -> JobSize:
    """Size of a study's jobs; InputError where its limits do not fit into them."""
    place = "[cluster]"
    processes = asked.cores // limits.cores
    if processes < 1:
        what = f"a job has {asked.cores} of the {limits.cores} cores of a trial"
        raise InputError(file, f"{place} cores", what, f"write {limits.cores} or more")
    if asked.memory is None and limits.memory is None:
        raise InputError(file, f"{place} memory", "is missing", 'add it: memory = "4GB"')
    twice = TRIES * (limits.memory or 0)
    memory = int(processes * twice / USED) if asked.memory is None else bytes_of(asked.memory)
    if memory < processes * twice:
        what = f"{size_text(memory)} are less than {processes} trials may take at their second try"
        raise InputError(file, f"{place} memory", what, f"write {size_text(processes * twice)}")
    if limits.time is not None and TRIES * limits.time > asked.seconds:
        what = f"is shorter than the {TRIES * limits.time:g} s that a trial may take at its second try"
        raise InputError(file, f"{place} walltime", what, "make it longer")
    return JobSize(processes, memory)


def job_options(
    system: str, asked: ClusterSettings, limits: TrialLimits, size: JobSize, folder: Path
) -> dict[str, Any]:
    """Keywords of the class of dask-jobqueue; what they print goes to `folder`/jobs."""
    import dask

    own = SYSTEMS[system]
    threads = " ".join(f"{name}={limits.cores}" for name in THREADS)
    closed = " ".join(f"DASK_DISTRIBUTED__{each}__HTTP__ROUTES='[]'" for each in ("WORKER", "NANNY"))
    found: dict[str, Any] = {
        "cores": asked.cores,
        "processes": size.processes,
        "memory": f"{size.memory}B",
        "queue": asked.queue,
        own.account: asked.account,
        "walltime": asked.walltime,
        "python": f"{shlex.quote(sys.executable)} -P",  # not from the folder of the study
        "job_name": "geocontact",
        "log_directory": str(folder / LOGS),
        "job_script_prologue": [
            *(dask.config.get(f"jobqueue.{system}.job-script-prologue", None) or []),
            f"export {threads}",
            f"export {closed}",
            FREE,
            *([KEEPS] if NANNY * size.memory < size.processes * TRIES * (limits.memory or 0) else []),
        ],
        "worker_extra_args": [f"{LONG}nthreads", "1", f"{LONG}no-dashboard"],  # the last one counts
        "scheduler_options": {"dashboard": False},
        "silence_logs": "critical",
    }
    if system == "lsf":  # minutes are its smallest unit
        minutes = -(-asked.seconds // 60)
        found["walltime"] = f"{minutes // 60:02d}:{minutes % 60:02d}"
    return {name: value for name, value in found.items() if value is not None}


FREE = f"""if [ "${SAFE_PATH}" = {OURS} ]; then unset {SAFE_PATH}; fi"""
"""A job has the environment of who submits it; programs that its trials start search their folder as elsewhere."""
THREADS = ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class Jobs:
    """Jobs that are there as long as trials are missing, and are submitted anew where they are lost.

    `missing` is the number of trials without results; `refused` what the queue said where it did not take a job.
    """

    def __init__(self, system: str, asked: ClusterSettings, limits: TrialLimits, file: Path, folder: Path) -> None:
        self._system, self._asked, self._limits, self._folder = SYSTEMS[system], asked, limits, folder
        self._size = job_size(asked, limits, file)
        self._options = job_options(system, asked, limits, self._size, folder)
        self.missing = 1
        self.refused = ""
        self._silent: float | None = None

    @contextmanager
    def started(self) -> Iterator[Any]:
        """A cluster of dask-jobqueue, whose jobs are cancelled with the block."""
        try:
            import dask_jobqueue
        except ModuleNotFoundError as error:
            what = f"needs {error.name}, which is not installed"
            raise InputError("", "`scheduler`", what, "pip install 'geocontact[cohort]'") from error
        for program in (self._system.submits, self._system.lists[0]):
            if shutil.which(program) is None:
                what = f"{program} is not on this machine"
                raise InputError("", "`scheduler`", what, "start the study where jobs are submitted")
        made = self._made(getattr(dask_jobqueue, self._system.cluster))
        try:
            made.adapt(Adaptive=_kept(self), minimum=0, interval="2s", wait_count=3)
            with made:
                yield made
        finally:
            for name in ("ca_file", "cert", "key"):  # dask-jobqueue keeps these files as long as the object
                file = getattr(made, f"_job_{name}", None)
                if file is not None:
                    file.close()

    def _made(self, kind: Any) -> Any:
        from distributed.security import Security

        logs = self._folder / LOGS
        if not PATH.fullmatch(str(logs)):
            raise InputError(logs, "", "is a path that jobs cannot be given", "choose an `out` of plain letters")
        logs.mkdir(exist_ok=True)
        for left in logs.glob(f"{KEYS}*"):  # of a study that was killed
            left.unlink()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of dask-jobqueue, on its own settings
            return kind(
                job_cls=_noting(self, kind.job_cls),
                security=Security.temporary(),  # type: ignore[no-untyped-call]
                protocol="tls://",
                shared_temp_directory=str(logs),
                **self._options,
            )

    @property
    def several(self) -> bool:
        """Whether a job has several processes."""
        return self._size.processes > 1

    @property
    def wanted(self) -> int:
        """Processes that are worth having; a job that has anything to do is never closed."""
        return min(self._asked.jobs, self.missing) * self._size.processes

    def queued(self, cluster: Any) -> bool:
        """Whether the queue lists one of the jobs as one that runs or may still run.

        Where it does not answer jobs may be there: after 10 min of silence the study goes on without them.
        """
        ids = {str(job.job_id) for job in list(cluster.workers.values()) if job.job_id is not None}
        try:
            said = subprocess.run(
                self._system.lists, capture_output=True, text=True, timeout=ANSWERS, check=False
            ).stdout
        except (OSError, subprocess.TimeoutExpired):  # it does not answer
            if self._silent is None:
                self._silent = time.monotonic()
            return bool(ids) and time.monotonic() - self._silent < SILENT
        self._silent = None
        return bool(ids & self._system.alive(said))


def _noting(jobs: Jobs, base: Any) -> type:
    """A job that notes what the queue says where it is not taken: Dask says it to a log that nobody reads."""
    from distributed.core import Status

    class Noting(base):  # type: ignore[misc]
        """A job."""

        if POSIX and shutil.which("timeout") is not None:  # Dask waits for ever; that of Windows is another program
            submit_command = f"timeout {TAKES:g} {base.submit_command} "  # which Dask splits, or gives to a shell

        async def start(self) -> None:
            try:
                await super().start()
            except (RuntimeError, ValueError, OSError) as error:
                late = f"{base.submit_command} has not answered for {TAKES:g} s"
                jobs.refused = late if LATE in str(error) else _said(str(error))
                self.status = Status.failed  # else Dask, when it closes, takes it as one that is being started
                raise

    return Noting


def _said(error: str) -> str:
    """The line that a program wrote last, of a message of dask-jobqueue."""
    return ([line.strip() for line in error.splitlines() if line.strip() and line.strip() != "stderr:"] or [""])[-1]


def _kept(jobs: Jobs) -> type:
    """An adaptive cluster with as many processes as are wanted."""
    import distributed

    base: Any = distributed.Adaptive

    class Kept(base):  # type: ignore[misc]
        """Jobs by trials that are missing."""

        def __init__(self, *given: Any, **named: Any) -> None:
            super().__init__(*given, worker_key=job_of if jobs.several else None, **named)
            self._met: set[str] = set()
            self._gone: dict[str, float] = {}

        async def target(self) -> int:
            await self._submit_lost()
            return jobs.wanted

        async def _submit_lost(self) -> None:
            """Take jobs that are gone, or were not taken, out of what is requested: Dask then submits them anew."""
            there = {str(name).rsplit("-", 1)[0] if jobs.several else str(name) for name in self.observed}
            self._met |= there
            for name, job in list(self.cluster.workers.items()):
                lost = str(name) in self._met - there or job.job_id is None
                since = self._gone.setdefault(str(name), time.monotonic()) if lost else float("inf")
                if not lost or time.monotonic() - since > LOST:
                    self._gone.pop(str(name), None)
                if time.monotonic() - since > LOST:
                    self._met.discard(str(name))
                    self.cluster.workers.pop(name, None)
                    await job.close()

    return Kept


def job_of(worker: Any) -> str:
    """The job of one of several processes, by its name."""
    return str(worker.name).rsplit("-", 1)[0]
