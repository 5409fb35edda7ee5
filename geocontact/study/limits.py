"""What a trial may take: time, memory and cores. One that takes more is ended, and its log says where it was.

The first time that a limit is passed the trial is tried again with twice of it, the second time it is set aside. Both
are watched by a thread of the worker, memory ten times a second, which also ends what the trial started. Where compiled
code keeps the interpreter to itself, a thread of Python's `faulthandler` ends the worker alone a second later, and
Dask's nanny at four times the memory.
"""

from __future__ import annotations

import faulthandler
import math
import os
import re
import threading
import time
from collections.abc import Collection, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import Annotated, Any, TextIO

from pydantic import AfterValidator, Field

from geocontact.data.plausible import TRIAL_LIMIT
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, Holds, Text, WithUnit

SIZE = re.compile(r"([0-9]+(?:\.[0-9]+)?) ?([kMGT])(i?)B")
TRIES = 2
"""So often a limit may be passed, the last time twice of it."""
WATCHED = 0.1  # s; so often memory is looked at
HELD_UP = 1.0  # s; after the time, where the interpreter is not free
TIMED_OUT, TOO_LARGE = "Timeout (", "Memory ("
"""How a log goes on where a trial was ended; the first as `faulthandler` writes it."""


def bytes_of(size: str) -> int:
    """Bytes of a size such as 4GB or 500 MiB; ValueError for what is none."""
    found = SIZE.fullmatch(size)
    if found is None:
        raise ValueError(size)
    return int(float(found[1]) * (1024 if found[3] else 1000) ** (1 + "kMGT".index(found[2])))


def is_size(text: str) -> bool:
    """Whether it is one."""
    try:
        return bytes_of(text) > 0
    except ValueError:
        return False


def size_text(size: float) -> str:
    """The same number as it is written."""
    return f"{size / 1e9:g} GB" if size >= 1e9 else f"{size / 1e6:g} MB"


def _size(text: str) -> str:
    if not is_size(text):
        raise refusal(f"{text!r:.60} is not a size of memory", example='"4GB"')
    return text


Size = Annotated[Text, AfterValidator(_size), Holds("size of memory"), Field(examples=['"4GB"'])]
Count = Annotated[int, Field(ge=1)]


class LimitSettings(Document):
    """What each trial may take.

    Parameters
    ----------
    time
        Longest time.
    memory
        Most memory of its process, 0.3 GB of the program among it.
    cores
        Cores.
    """

    time: Annotated[float, WithUnit(TRIAL_LIMIT)] | None = None
    memory: Size | None = None
    cores: Count = 1


@dataclass(frozen=True)
class TrialLimits:
    """Seconds and bytes that a trial may take, None without a limit, and its cores."""

    time: float | None = None
    memory: int | None = None
    cores: int = 1

    def exceeded(self, log: Path) -> str:
        """Which limit has been passed twice, in a line; "" where none has."""
        times, sizes = ended(log)
        if self.time is not None and times >= TRIES:
            return f"took more than {self.time:g} s, and then more than {self.time * TRIES:g} s"
        if self.memory is not None and sizes >= TRIES:
            return f"took more than {size_text(self.memory)}, and then more than {size_text(self.memory * TRIES)}"
        return ""


NO_LIMITS = TrialLimits()


def widest(several: Collection[TrialLimits]) -> TrialLimits:
    """TrialLimits within which each of them is."""

    def most(numbers: list[float | None]) -> float | None:
        known = [each for each in numbers if each is not None]
        return max(known) if len(known) == len(several) > 0 else None

    memory = most([one.memory for one in several])
    cores = max((one.cores for one in several), default=1)
    return TrialLimits(most([one.time for one in several]), None if memory is None else int(memory), cores)


def ended(log: Path) -> tuple[int, int]:
    """How often a trial was ended for its time, and for its memory."""
    try:
        lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return 0, 0
    return sum(line.startswith(TIMED_OUT) for line in lines), sum(line.startswith(TOO_LARGE) for line in lines)


@contextmanager
def kept_within(limits: TrialLimits, log: Path) -> Iterator[None]:
    """End this process where the block takes more than it may, after the log says where it was."""
    if limits.time is None and limits.memory is None:
        yield
        return
    times, sizes = ended(log)
    with ExitStack() as held:
        held.callback(_remove_empty, log)
        file = held.enter_context(log.open("a", encoding="utf-8"))
        seconds = math.inf if limits.time is None else limits.time * (TRIES if times else 1)
        most = math.inf if limits.memory is None else limits.memory * (TRIES if sizes else 1)
        if limits.time is not None:
            faulthandler.dump_traceback_later(seconds + HELD_UP, exit=True, file=file)
            held.callback(faulthandler.cancel_dump_traceback_later)
        held.enter_context(_watched(seconds, most, file))
        yield


def _remove_empty(log: Path) -> None:
    with suppress(OSError):
        if not log.stat().st_size:
            log.unlink()


@contextmanager
def _watched(seconds: float, most: float, log: TextIO) -> Iterator[None]:
    """A thread that ends this process, and those that it started, after a time or where they hold more than `most`."""
    import psutil  # type: ignore[import-untyped]  # of the extra, as is what calls this

    over, own, until = threading.Event(), psutil.Process(), time.monotonic() + seconds
    pause = seconds if math.isinf(most) else WATCHED

    def end(why: str, children: list[Any]) -> None:
        faulthandler.cancel_dump_traceback_later()  # it would write as well
        log.write(f"{why})!\n")
        log.flush()
        faulthandler.dump_traceback(file=log)
        for each in children:
            with suppress(psutil.Error):
                each.kill()
        os._exit(1)

    def watch() -> None:
        while not over.wait(max(0.0, min(pause, until - time.monotonic()))):
            children = []
            with suppress(psutil.Error):
                children = own.children(recursive=True)
            if time.monotonic() >= until and not over.is_set():
                end(f"{TIMED_OUT}{timedelta(seconds=seconds)}", children)
            held = own.memory_info().rss
            for each in children:
                with suppress(psutil.Error):
                    held += each.memory_info().rss
            if held > most and not over.is_set():
                end(f"{TOO_LARGE}{size_text(held)} of {size_text(most)}", children)

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
