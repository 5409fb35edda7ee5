"""Linear algebra on one core: several processes of tests, each with threads of its own, would wait for each other."""

from __future__ import annotations

import scipy.linalg  # noqa: F401 - brings a library with threads of its own
from threadpoolctl import threadpool_limits


def one_core() -> None:
    """For the rest of this process."""
    threadpool_limits(limits=1)
