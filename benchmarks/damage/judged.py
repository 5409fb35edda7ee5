"""One damaged file after the other in a process with bounded memory and time, and the outcome of each."""

from __future__ import annotations

import contextlib
import multiprocessing as mp
import os
import resource
import shutil
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from benchmarks.damage.mutations import mutated
from benchmarks.damage.readers import READERS, Found, Reader, summary
from benchmarks.damage.samples import Sample
from geocontact.data.magnitude import LARGEST_MEANT

SECONDS = 10.0
"""A reader that takes longer hangs."""
MEMORY = 300 * 2**20
"""Bytes beyond three times the file."""
PER_SI = 1e6
"""Of the largest unit that a file may be in (MPa)."""
GOOD = ("refused", "warned", "read", "unchanged")
SILENT = ("empty", "not finite", "implausible")
BAD = ("other error", "unclear refusal", "no memory", "ended the process", "hangs", *SILENT)


@dataclass(frozen=True)
class Case:
    """A sample, and what it is damaged by."""

    sample: Sample
    seed: str


@dataclass(frozen=True)
class Outcome:
    """One of the words above; the ways in which the file was damaged; what was said, or how it shows."""

    word: str
    ways: str
    line: str = ""
    seconds: float = 0.0


def outcome_of(case: Case, home: Path, whole: Found) -> Outcome:
    """What the reader makes of the damaged file, in this process."""
    path, reader = home / case.sample.file, READERS[case.sample.reader]
    content = (case.sample.home / case.sample.file).read_bytes()
    damaged, ways = mutated(content, case.sample.kind, case.seed)
    path.write_bytes(damaged)
    began = time.perf_counter()
    with warnings.catch_warnings(record=True) as said, _bounded(3 * len(damaged) + MEMORY):
        warnings.simplefilter("always")
        try:
            word, line = _judged(case.sample.kind, reader, summary(reader.read(path)), whole)
        except MemoryError as error:
            word, line = "no memory", _words(error)
        except Exception as error:  # noqa: BLE001  whatever a reader raises is what is looked for
            word, line = _refusal(error, path, len(damaged))
    other = [each for each in said if type(each.message).__name__ != "InputWarning"]
    if word == "read" and other:
        word, line = "other error", f"warning {_words(other[0].message)}"
    elif word in ("read", "empty", "implausible") and said:
        word, line = "warned", str(said[0].message)[:200]
    elif word == "read" and damaged == content:
        word = "unchanged"
    return Outcome(word, ways, line, time.perf_counter() - began)


def _judged(kind: str, reader: Reader, found: Found, whole: Found) -> tuple[str, str]:
    """What was read is there, finite where it has to be, and of a size that can be."""
    if not found.things or (whole.numbers and not found.numbers and kind != "settings"):
        return "empty", f"{found.things} things, {found.numbers} numbers"
    gaps = found.gaps > whole.gaps and not (reader.gaps and found.gaps < found.numbers)
    if gaps or (found.endless > whole.endless and not reader.open_ended):
        return "not finite", f"{found.gaps + found.endless} of {found.numbers} numbers"
    if found.largest > 1.01 * LARGEST_MEANT * PER_SI:
        return "implausible", f"{found.largest:g} where {whole.largest:g} was the largest"
    return "read", ""


def _refusal(error: Exception, path: Path, size: int) -> tuple[str, str]:
    from geocontact.data.errors import InputError

    line = str(error)
    if not isinstance(error, InputError):
        return "other error", f"{_words(error)} at {_place(error)}"
    if "\n" in line or len(line) > 1000 or not (path.name in line or path.parent.name in line):
        return "unclear refusal", line[:300]
    if "memory" in line and size < 2**26:
        return "no memory", line[:300]
    return "refused", line[:300]


def _words(error: BaseException | str) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]


def _place(error: BaseException) -> str:
    """File and line of the package in which it was raised."""
    import traceback

    steps = [step for step in traceback.extract_tb(error.__traceback__) if "/geocontact/" in step.filename]
    return f"{Path(steps[-1].filename).name}:{steps[-1].lineno}" if steps else "elsewhere"


@contextlib.contextmanager
def _bounded(more: int) -> Iterator[None]:
    """So many bytes more than now may be taken."""
    now = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    resource.setrlimit(resource.RLIMIT_AS, (now + more, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (hard, hard))


def _serve(there: Connection, scratch: Path) -> None:
    """Answer cases until there are none."""
    devnull = os.open(os.devnull, os.O_WRONLY)
    os.dup2(devnull, 2)  # libraries speak to stderr of damaged files
    known: dict[str, tuple[Path, Found]] = {}
    while (case := there.recv()) is not None:
        sample: Sample = case.sample
        if sample.name not in known:
            known[sample.name] = _prepared(sample, scratch / f"s{len(known)}-{os.getpid()}")
        home, whole = known[sample.name]
        there.send(outcome_of(case, home, whole))
        shutil.copyfile(sample.home / sample.file, home / sample.file)


def _prepared(sample: Sample, scratch: Path) -> tuple[Path, Found]:
    """A folder of its own in which the sample is damaged, and what is read of it whole."""
    if sample.home.parent.name in ("gap", "gather") or sample.home.name in ("area", "walk"):  # names files elsewhere
        root = scratch / "samples"
        for name in ("meshes", "own"):
            link = root / name
            root.mkdir(parents=True, exist_ok=True)
            with contextlib.suppress(FileExistsError):
                link.symlink_to(_root(sample) / name)
        home = root / sample.home.relative_to(_root(sample))
    else:
        home = scratch / sample.home.name
    shutil.copytree(sample.home, home, dirs_exist_ok=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return home, summary(READERS[sample.reader].read(home / sample.file))


def _root(sample: Sample) -> Path:
    return next(folder for folder in sample.home.parents if (folder / "meshes").is_dir() and (folder / "own").is_dir())


class Judge:
    """A process that reads damaged files; it is started again where one ends it or keeps it for too long."""

    def __init__(self, scratch: Path) -> None:
        self.scratch = scratch
        self._start()

    def _start(self) -> None:
        self._here, there = mp.Pipe()
        self._process = mp.get_context("fork").Process(target=_serve, args=(there, self.scratch), daemon=True)
        self._process.start()
        there.close()

    def outcome(self, case: Case) -> Outcome:
        """Of one case, whatever it does."""
        self._here.send(case)
        busy = max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))
        patience = busy * (SECONDS + READERS[case.sample.reader].seconds)
        try:
            if self._here.poll(patience + 30.0):
                found: Outcome = self._here.recv()
                return found if found.seconds < patience else Outcome("hangs", found.ways, f"{found.seconds:.1f} s")
            word, line = "hangs", f"more than {patience:.0f} s"
        except EOFError:
            word, line = "ended the process", ""
        self._process.kill()
        self._process.join()
        line = line or f"exit code {self._process.exitcode}"
        self._start()
        return Outcome(word, mutated_ways(case), line)

    def end(self) -> None:
        """No more cases."""
        with contextlib.suppress(OSError):
            self._here.send(None)
        self._process.join(5.0)


def mutated_ways(case: Case) -> str:
    """How the file of a case is damaged."""
    return mutated((case.sample.home / case.sample.file).read_bytes(), case.sample.kind, case.seed)[1]
