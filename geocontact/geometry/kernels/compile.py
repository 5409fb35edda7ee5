"""The one place that says how kernels are compiled, and where the result is kept.

numba notices a change of the file a kernel stands in, not of the kernels it calls in other files; so the folder is
named after the text of all of them.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])


def _cache_folder() -> Path:
    here = Path(__file__).parent
    text = b"".join(file.read_bytes() for file in sorted(here.glob("*.py")))
    base = here / "__pycache__" if os.access(here, os.W_OK) else Path.home() / ".cache" / "geocontact"
    return base / f"kernels-{hashlib.sha256(text).hexdigest()[:16]}"


if not os.environ.get("NUMBA_CACHE_DIR"):
    vars(numba.config)["CACHE_DIR"] = str(_cache_folder())


def kernel(function: F) -> F:
    """Compile with numba on first call: cached on disk, without the interpreter lock, strict IEEE arithmetic."""
    return cast(F, numba.njit(cache=True, nogil=True, error_model="numpy")(function))
