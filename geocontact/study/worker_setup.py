"""What a local worker does first."""

from __future__ import annotations

import signal


def dask_setup(worker: object) -> None:
    """Leave Ctrl-C to the process that started the study, which then ends its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
