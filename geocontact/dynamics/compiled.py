"""CasADi functions that read and write arrays in place, and C that the user's compiler makes a library of."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.machine_code import cache_folder, machine_code

if TYPE_CHECKING:
    from casadi import Function


class Buffered:
    """Called with arrays, gives arrays that the next call overwrites; outputs must be dense.

    Parameters
    ----------
    function
        Of columns and matrices; these are passed and given column by column.
    compiled
        Whether to run machine code where there is some, with the same results: see `code`.
    """

    def __init__(self, function: Function, *, compiled: bool = False) -> None:
        self.function = function
        self._inputs = [np.zeros(function.nnz_in(k)) for k in range(function.n_in())]
        self._outputs = [np.zeros(function.nnz_out(k)) for k in range(function.n_out())]
        self.code = machine_code(function) if compiled else None
        self._run = self._by_casadi() if self.code is None else self._by_processor(self.code.run, self.code.work)

    def _by_casadi(self) -> Callable[[], object]:
        self._buffer, run = self.function.buffer()
        for k, each in enumerate(self._inputs):
            self._buffer.set_arg(k, memoryview(each))  # type: ignore[call-arg, arg-type]  # its stubs tell another form
        for k, each in enumerate(self._outputs):
            self._buffer.set_res(k, memoryview(each))  # type: ignore[call-arg, arg-type]  # likewise
        return run  # type: ignore[no-any-return]

    def _by_processor(self, run: Callable[..., object], work: int) -> Callable[[], object]:
        lists = (np.array([each.ctypes.data for each in of], np.uintp) for of in (self._inputs, self._outputs))
        self._memory = [*lists, np.empty(work)]
        return partial(run, *(each.ctypes.data for each in self._memory))

    def __call__(self, *values: Float[np.ndarray, ...]) -> list[Float[np.ndarray, " k"]]:
        """Outputs, each in one row. ValueError for more or fewer numbers than an input has: one is not for all."""
        for place, value in zip(self._inputs, values, strict=True):
            if value.size != place.size:
                raise ValueError(f"{value.size} numbers for {place.size} symbols")
            place[:] = value.ravel()
        self._run()
        return self._outputs

    def many(self, *values: Float[np.ndarray, "m _"]) -> list[Float[np.ndarray, "m k"]]:
        """Outputs of many calls, each of which takes one row of every input."""
        found = [np.empty((len(values[0]), each.size)) for each in self._outputs]
        for k, rows in enumerate(zip(*values, strict=True)):
            for all_of_it, each in zip(found, self(*rows), strict=True):
                all_of_it[k] = each
        return found


FLAGS = ("-O1", "-fPIC", "-shared")


def compiler() -> str | None:
    """The C compiler: $CC, else cc, gcc or clang; None where there is none, or on Windows."""
    if sys.platform == "win32":
        return None
    return next(
        (path for name in (os.environ.get("CC", ""), "cc", "gcc", "clang") if (path := shutil.which(name))), None
    )


def library_of(source: str) -> Path | None:
    """The library of some C; None where there is no compiler or it fails.

    It is kept in `cache_folder` and found again by the source, the compiler and its flags.
    """
    program = compiler()
    if program is None:
        return None
    folder = cache_folder()
    library = folder / f"{hashlib.sha256(chr(0).join((source, program, *FLAGS)).encode()).hexdigest()}.so"
    if not library.is_file():
        try:
            _build(program, source, folder, library)
        except (OSError, subprocess.CalledProcessError):
            return None
    return library


def _build(program: str, source: str, folder: Path, library: Path) -> None:
    """Compile beside the place and move there: another process may do the same at the same time."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as place:
        code, made = Path(place) / "f.c", Path(place) / "f.so"
        code.write_text(source, encoding="utf-8")
        subprocess.run([program, *FLAGS, "-o", str(made), str(code), "-lm"], check=True, capture_output=True)
        made.replace(library)
