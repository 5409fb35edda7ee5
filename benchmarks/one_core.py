"""One core for everything: called before numpy, numba or any peer is imported."""

from __future__ import annotations

import os

THREADS = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "IGL_NUM_THREADS",
    "TBB_NUM_THREADS",
    "VTK_SMP_MAX_THREADS",
)


def pin() -> int | None:
    """One thread for every library, the process on its last core; returns that core, None where it cannot be set."""
    for name in THREADS:
        os.environ[name] = "1"
    if not hasattr(os, "sched_setaffinity"):
        return None
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})
    return core
