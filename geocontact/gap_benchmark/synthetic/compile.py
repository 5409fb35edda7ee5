"""How the few loops with memory are compiled; each kernel stands alone in its file, so numba's own cache is safe."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])


def loop(function: F) -> F:
    """Compile with numba on first call, cached on disk; a function that is checked in tests is unwrapped first."""
    return cast(F, numba.njit(cache=True, nogil=True, error_model="numpy")(inspect.unwrap(function)))
