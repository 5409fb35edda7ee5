"""The one place that says how kernels are compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])


def kernel(function: F) -> F:
    """Compile with numba on first call: cached on disk, without the interpreter lock, strict IEEE arithmetic."""
    return cast(F, numba.njit(cache=True, nogil=True, error_model="numpy")(function))
