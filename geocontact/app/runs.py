"""Runs of the command line, each in a process of its own, one after the other; what they print as they print it."""

from __future__ import annotations

import json
import os
import re
import secrets
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import IO, Literal
from urllib.parse import quote

from geocontact.analyses.frame.folder import DRAFT, OWNER
from geocontact.app.child import MODULES
from geocontact.app.gate import RESULT, secret
from geocontact.cli.main import FAILURE, USAGE_ERROR

State = Literal["waiting", "running", "done", "refused", "failed", "cancelled"]
ENDED: tuple[State, ...] = ("done", "refused", "failed", "cancelled")
HOLD_THEIR_FOLDER: tuple[State, ...] = ("waiting", "running", "done")
GRACE = 5.0
"""s that a run has to end after it was asked to."""
MOST_LINES = 500
"""Lines of output that are kept of a run."""
WARNING, WROTE = "warning: ", "results in "
REPORT = "report.html"
_COUNTED = re.compile(r"(?P<label>.*): (?P<done>\d+) of (?P<total>\d+) done …")
_STAGE = re.compile(r"(?P<stage>.*) …")


@dataclass
class Run:
    """One call of the command line.

    Parameters
    ----------
    words
        All words after `geocontact`.
    out
        Folder of its results.
    title
        What it is, for lists.
    modules
        Folders in which Python looks for a simulator of the user's own, after all others.
    """

    words: list[str]
    out: Path
    title: str
    modules: tuple[Path, ...] = ()
    number: int = 0
    state: State = "waiting"
    stage: str = ""
    share: float | None = None
    warnings: list[str] = field(default_factory=list)
    printed: list[str] = field(default_factory=list)
    said: list[str] = field(default_factory=list)
    began: float = 0.0
    ended: float = 0.0
    code: int = 0
    earlier: bool = False
    """Whether it is one of an earlier window."""
    mark: str = field(default_factory=lambda: secrets.token_hex(4))
    key: str = field(default_factory=secret, repr=False)
    """Word of the address of its results."""
    process: subprocess.Popen[str] | None = field(default=None, repr=False)
    _counting_since: tuple[float, float] | None = None

    @property
    def over(self) -> bool:
        """Whether it has ended, in whichever way."""
        return self.state in ENDED

    @property
    def message(self) -> str:
        """Why it was refused or failed: the last line on stderr that is no warning."""
        if self.state not in ("refused", "failed"):
            return ""
        return self.said[-1] if self.said else f"it ended with code {self.code} and no message"

    @property
    def pages(self) -> dict[str, str]:
        """Addresses of the pages of its results by their names: one, or that of each trial of a folder."""
        if self.state != "done":
            return {}
        places = [self.out, *(page.parent for page in sorted(self.out.glob(f"*/{REPORT}")))]
        found = [each.relative_to(self.out) for each in places if (each / REPORT).is_file() and self._wrote(each)]
        address = f"{RESULT}{self.key}/"
        return {"/".join((self.title, *each.parts)): address + quote((each / REPORT).as_posix()) for each in found}

    def _wrote(self, folder: Path) -> bool:
        """Whether it wrote results into a folder, as it said; one of an earlier window by its folder only."""
        return any(line.startswith(f"{WROTE}{folder}:") for line in self.printed) or (
            self.earlier and folder == self.out
        )

    @property
    def complaints(self) -> list[str]:
        """What it printed on stderr besides warnings, where it did not end well; it may have written results."""
        return self.said if self.over and self.code != 0 else []

    def seconds_left(self) -> float | None:
        """Time left if the rest goes on as fast [s]; None before that is known."""
        if self.state != "running" or self.share is None or self._counting_since is None:
            return None
        at, share = self._counting_since
        return (time.monotonic() - at) * (1.0 - self.share) / (self.share - share) if self.share > share else None

    def take(self, line: str) -> None:
        """A line of stderr: a warning, how far the work is, or what went wrong."""
        if line.startswith(WARNING):
            self.warnings.append(line.removeprefix(WARNING))
        elif counted := _COUNTED.fullmatch(line):
            self.share = int(counted["done"]) / int(counted["total"])
            if counted["label"] != self.stage or self._counting_since is None:
                self._counting_since = (time.monotonic(), self.share)
            self.stage = counted["label"]
        elif staged := _STAGE.fullmatch(line):
            self.stage, self.share, self._counting_since = staged["stage"], None, None
        else:
            self.said = [*self.said, line][-MOST_LINES:]


class Queue:
    """Runs that wait, one that runs, and those that have ended.

    Parameters
    ----------
    folder
        For results.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.start = Path.cwd()
        """Where runs are started: relative paths start from here, for them as for who checks their words."""
        self.runs: list[Run] = []
        self._numbers = count(1)
        self._changed = threading.Condition()
        self._closed = threading.Event()
        self._worker = threading.Thread(target=self._work, daemon=True)
        self._worker.start()

    def add(self, words: Sequence[str], out: Path, title: str) -> Run:
        """A run that begins when those before it have ended."""
        return self.remember(Run(list(words), out, title))

    def add_apart(self, words: Callable[[Path], Sequence[str]], out: Path, modules: tuple[Path, ...] = ()) -> Run:
        """A run into `out`, or into the next folder of that name and number where another run has it already."""
        with self._changed:
            taken = {_spot(run.out) for run in self.runs if run.state in HOLD_THEIR_FOLDER}
            if _spot(out) in taken:
                out = Path(os.path.abspath(out))
                stem, dash, last = out.name.rpartition("-")
                base = stem if dash and last.isdigit() else out.name
                numbered = (out.with_name(f"{base}-{k}") for k in count(2))
                out = next(each for each in numbered if _spot(each) not in taken and not each.exists())
            return self.remember(Run(list(words(out)), out, out.name, modules))

    def remember(self, run: Run) -> Run:
        """Number a run and keep it; one that waits begins in its turn."""
        with self._changed:
            run.number = next(self._numbers)
            self.runs.append(run)
            self._changed.notify_all()
        return run

    def cancel(self, run: Run) -> None:
        """End a run with all its processes; what it had begun to write is removed."""
        with self._changed:
            if run.over:
                return
            run.state = "cancelled"
            process = run.process
            self._changed.notify_all()
        if process is not None:
            end(process)
            _remove_drafts(run)
        run.ended = time.monotonic()

    def close(self) -> None:
        """Cancel all."""
        self._closed.set()
        for run in reversed(self.runs):
            self.cancel(run)
        with self._changed:
            self._changed.notify_all()

    def _next(self) -> Run | None:
        return next((run for run in self.runs if run.state == "waiting"), None)

    def _work(self) -> None:
        while not self._closed.is_set():
            with self._changed:
                self._changed.wait_for(lambda: self._closed.is_set() or self._next() is not None)
                run = self._next()
                if run is None or self._closed.is_set():
                    return
                try:
                    _start(run, self.start)
                except (OSError, ValueError) as error:  # a folder that is gone, a character that no word can have
                    run.said.append(f"it cannot be started: {error}")
                    run.state, run.code, run.ended = "failed", FAILURE, time.monotonic()
                    continue
            _finish(run)


def _start(run: Run, folder: Path) -> None:
    """Start the process, in a group of its own, so that all of it can be ended; no module of `folder` is imported."""
    run.state, run.began = "running", time.monotonic()
    run.process = subprocess.Popen(
        [sys.executable, "-P", "-m", "geocontact.app.child", *run.words],
        cwd=folder,
        env=os.environ
        | {"PYTHONUNBUFFERED": "1", "PYTHONIOENCODING": "utf-8", OWNER: run.mark}
        | {MODULES: json.dumps([os.path.abspath(each) for each in run.modules])},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        errors="replace",
        start_new_session=os.name != "nt",
    )


def _finish(run: Run) -> None:
    """Read what it prints until it has ended."""
    process = run.process
    if process is None or process.stdout is None or process.stderr is None:
        return
    reader = threading.Thread(target=_each_line, args=(process.stdout, run.printed.append), daemon=True)
    reader.start()
    _each_line(process.stderr, run.take)
    reader.join()
    run.code = process.wait()
    run.ended = time.monotonic()
    if run.state == "running":
        run.state = _judged(run)


def _judged(run: Run) -> State:
    """How a run has ended: results may be there beside a verdict against a device or one trial that was refused."""
    wrote = any(line.startswith(WROTE) for line in run.printed)
    if run.code == 0 or (wrote and run.code in (FAILURE, USAGE_ERROR)):
        return "done"
    return "refused" if run.code == USAGE_ERROR else "failed"


def _each_line(stream: IO[str], take: Callable[[str], None]) -> None:
    with stream:
        for line in stream:
            if line.strip():
                take(line.rstrip())


def end(process: subprocess.Popen[str]) -> None:
    """Ask a process to end, which removes what it had begun to write; then end all that it started."""
    if sys.platform == "win32":
        taskkill = shutil.which("taskkill") or "taskkill"
        subprocess.run([taskkill, "/T", "/F", "/PID", str(process.pid)], check=False, capture_output=True)
    else:
        process.terminate()
        with suppress(subprocess.TimeoutExpired):
            process.wait(GRACE)
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _remove_drafts(run: Run) -> None:
    """Remove what a run that was killed had begun to write; by its mark, so nothing of others."""
    drafts = f"{DRAFT}{run.mark}-*"
    places = [each.glob(drafts) for each in run.out.absolute().parents]
    for draft in (*run.out.rglob(drafts), *(found for place in places for found in place)):
        shutil.rmtree(draft, ignore_errors=True)


def _spot(path: Path) -> str:
    """A path in one spelling."""
    return os.path.normcase(os.path.abspath(path))
