"""The one place that says how kernels are compiled, and where the result is kept.

numba notices a change of the file a kernel stands in, not of the kernels it calls in other files; so the folder is
named after the text of all of them: this folder's for the kernels of geometry, and for those of the rooms above it
everything that they may call.
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, TypeVar, cast
from weakref import WeakSet

import numba
import numpy as np

F = TypeVar("F", bound=Callable[..., object])

HERE = Path(__file__).parent
ROOMS = (
    "contact",
    "loads",
    "dynamics",
    "identify",
    "chain",
    "axis_misalignment",
    "shoulder_exoskeleton",
    "below_knee_prosthesis",
    "systems",
    "effects",
    "gap",
)
"""Rooms above geometry whose files may hold kernels or laws that kernels call."""
_KERNELS: WeakSet[Any] = WeakSet()
"""Everything that numba compiles here, to ask it what the cache lacked."""


def compilations() -> int:
    """How often this process had to compile, or began to, because the cache on disk lacked a kernel."""
    return sum(sum(each.stats.cache_misses.values()) for each in list(_KERNELS))


@functools.cache
def _cache_folder(*, own: bool) -> Path:
    """Where compiled code is kept: `own` for the kernels of this folder, otherwise for those of other rooms."""
    files = sorted(HERE.glob("*.py"))
    if not own:
        files += [file for room in ROOMS for file in sorted((HERE.parents[1] / room).rglob("*.py"))]
    text = b"".join(file.read_bytes() for file in files)
    base = HERE / "__pycache__" if os.access(HERE, os.W_OK) else Path.home() / ".cache" / "geocontact"
    return base / f"{'kernels' if own else 'loops'}-{hashlib.sha256(text).hexdigest()[:16]}"


def kernel(function: F) -> F:
    """Compile with numba on first call: cached on disk, without the interpreter lock, strict IEEE arithmetic.

    A function that is checked while tests run is compiled from what it wraps.
    """
    return _compiled(function, "never")


def part(function: F) -> F:
    """The same for a step of a long loop: it is put where it is called.

    Handing over its arrays costs more than it does. Whatever calls it takes longer to compile.
    """
    return _compiled(function, "always")


def inner(function: F) -> F:
    """The same for what only other kernels call: without the wrappers for Python, a sixth of the time that it takes.

    A call from Python ends the process, so nothing but a kernel may name it (`tests/house/test_inner_kernels.py`).
    """
    return _compiled(function, "never", wrapped=False)


def lean(function: F) -> F:
    """The same for what allocates nothing and is called often: its arrays are not counted in and out at every call.

    Counting costs more than a node of the tree. Whoever calls it holds the arrays meanwhile.
    """
    return _compiled(function, "never", wrapped=False, counted=False)


def _compiled(function: F, inline: Literal["never", "always"], *, wrapped: bool = True, counted: bool = True) -> F:
    plain = inspect.unwrap(function)
    if vars(numba.config)["DISABLE_JIT"]:  # NUMBA_DISABLE_JIT=1: slow, for debuggers and machines that may not compile
        return cast(F, np.errstate(all="ignore")(plain))  # as silent as what is compiled
    if not os.environ.get("NUMBA_CACHE_DIR"):
        own = Path(inspect.getfile(plain)).parent == HERE
        vars(numba.config)["CACHE_DIR"] = str(_cache_folder(own=own))
    # nothing here is called from C, so no kernel has the wrapper for that
    bare: dict[str, Any] = {"no_cfunc_wrapper": True, "no_cpython_wrapper": not wrapped}
    if not counted:
        bare["_nrt"] = False
    compiled = numba.njit(cache=True, nogil=True, error_model="numpy", inline=inline, **bare)(plain)
    _KERNELS.add(compiled)
    return cast(F, compiled)
