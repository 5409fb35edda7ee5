"""What a local worker does first."""

from __future__ import annotations

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1
"""Of Linux' prctl(2): the signal that the system sends when the process that started this one is gone."""


def dask_setup(worker: object) -> None:
    """Leave Ctrl-C to the process that started the study, which then ends its workers; end where it is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _end_with(os.getppid())


def _end_with(parent: int) -> None:
    """At once, whatever runs here: Dask's own watch waits for compiled code that keeps the interpreter to itself.

    Where the system offers no such thing, that watch has to do.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it went in between
            os._exit(1)
