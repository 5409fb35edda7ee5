"""What a local worker does first."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
import sys

from geocontact.analyses.frame.workers import leave_programs_their_folder

PR_SET_PDEATHSIG = 1
"""Option of Linux' prctl(2): the signal that the system sends when the thread that started this process is gone.

Dask starts each of them in a thread of its own, which it keeps until the process has ended.
"""


def dask_setup(worker: object) -> None:
    """Leave Ctrl-C to the process that started the study, which then ends its workers; end where it is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    leave_programs_their_folder()
    starter = multiprocessing.parent_process()
    if starter is not None and starter.pid is not None:
        _end_with(starter.pid)


def _end_with(starter: int) -> None:
    """At once, whatever runs here: Dask's own watch waits for compiled code that keeps the interpreter to itself.

    Where the system offers no such thing, that watch has to do.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != starter:  # it went before the system was asked, while this process read the program
            os._exit(1)
