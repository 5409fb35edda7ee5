"""Somebody who presses Ctrl-C during a search."""

from __future__ import annotations

import os
import signal
from contextlib import contextmanager

from geocontact.analyses.frame.record import Listener


class Interrupting(Listener):
    """Presses Ctrl-C once, at the stage with that number, counted from 1, or at the first that begins so."""

    def __init__(self, at: int | str) -> None:
        self.at, self.count, self.pressed = at, 0, False

    @contextmanager
    def stages(self, label: str):  # type: ignore[no-untyped-def]
        def told(stage: str) -> None:
            self.count += 1
            here = stage.startswith(self.at) if isinstance(self.at, str) else self.count == self.at
            if here and not self.pressed:
                self.pressed = True
                os.kill(os.getpid(), signal.SIGINT)

        yield told
