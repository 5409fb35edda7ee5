"""What a terminal shows while something takes long: the first compilation on a machine, many frames, stages."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from geocontact.analyses.frame.record import Listener

SILENCE = 2.5  # s; as long may compiling last without a word
AGAIN = 0.5
"""s between two looks whether something is compiled."""
COMPILING = "compiling the distance kernels, once on this machine (about 15 s) …"
PAUSE = 30.0
"""s between two lines on how far the work is, where stderr is a file or a pipe."""


def rate(per_second: float | None) -> str:
    """ "12/s", "3.5/min"; nothing before it is known."""
    if not per_second:
        return ""
    return f"{per_second:.3g}/s" if per_second >= 1.0 else f"{60.0 * per_second:.3g}/min"


class Paced:
    """Lines on stderr, one in `PAUSE` seconds at most; none of work that is done sooner."""

    def __init__(self) -> None:
        self._last = time.monotonic()

    def say(self, line: str) -> None:
        """Print the line, if it is time."""
        if time.monotonic() - self._last >= PAUSE:
            self._last = time.monotonic()
            print(line, file=sys.stderr, flush=True)


class Terminal(Listener):
    """Shows warnings and failures on stderr, and where that is a terminal how far the work is."""

    def warn(self, line: str) -> None:
        """One line on stderr."""
        print(f"warning: {line}", file=sys.stderr)

    def fail(self, line: str) -> None:
        """One line on stderr."""
        print(" ".join(line.split()), file=sys.stderr)

    @contextmanager
    def preparing(self) -> Iterator[None]:
        """Say that kernels are being compiled, while they are; nothing where they are loaded, however long it takes."""
        from numba.core import event  # late: --help needs no numba

        from geocontact.geometry.kernels.compile import compilations

        class Compiling(event.Listener):  # type: ignore[misc, unused-ignore]
            """How many functions are being compiled, one for another."""

            depth = 0

            def on_start(self, _: event.Event) -> None:
                self.depth += 1

            def on_end(self, _: event.Event) -> None:
                self.depth -= 1

        before, done, compiling = compilations(), threading.Event(), Compiling()

        def look() -> None:
            wait = SILENCE
            while not done.wait(wait):
                if compiling.depth > 0 and compilations() > before:
                    print(COMPILING, file=sys.stderr, flush=True)
                    return
                wait = AGAIN

        threading.Thread(target=look, daemon=True).start()
        try:
            with event.install_listener("numba:compile", compiling):
                yield
        finally:
            done.set()

    @contextmanager
    def progress(self, label: str, total: int) -> Iterator[Callable[[], None]]:
        """A progress bar when stderr is a terminal, else a line now and then; the block calls it after each step."""
        if total < 2:
            yield lambda: None
            return
        if not sys.stderr.isatty():
            yield _counting(label, total)
            return
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, Task, TextColumn, TimeRemainingColumn
        from rich.text import Text

        class Rate(TextColumn):
            """Steps per second, per minute where they are slow."""

            def render(self, task: Task) -> Text:
                return Text(rate(task.finished_speed or task.speed))

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), Rate(""), TimeRemainingColumn())
        with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task(label, total=total)
            yield lambda: bar.advance(task)

    @contextmanager
    def stages(self, label: str) -> Iterator[Callable[[str], None]]:
        """What is being done, and for how long, when stderr is a terminal, else a line now and then; the block names
        stages as they begin.
        """
        if not sys.stderr.isatty():
            paced = Paced()
            yield lambda stage: paced.say(f"{label}: {stage} …")
            return
        from rich.console import Console
        from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

        columns = (SpinnerColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn())
        with Progress(*columns, console=Console(stderr=True), transient=True) as line:
            task = line.add_task(label, total=None)
            yield lambda stage: line.update(task, description=f"{label}: {stage}")


def _counting(label: str, total: int) -> Callable[[], None]:
    """Counts steps, and says now and then how many are done."""
    paced, done = Paced(), 0

    def step() -> None:
        nonlocal done
        done += 1
        paced.say(f"{label}: {done} of {total} done …")

    return step
