"""CasADi functions that read and write arrays in place, and C that the user's compiler makes a library of."""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.code_cache import keep, kept, private_place
from geocontact.dynamics.machine_code import Recipe, machine_code, refuse_sparse

if TYPE_CHECKING:
    from casadi import Function


class Buffered:
    """Called with arrays, gives arrays that the next call overwrites; ValueError for a sparse output.

    Parameters
    ----------
    function
        Of columns and matrices; these are passed and given column by column. A recipe is followed only where there is
        no machine code.
    compiled
        Whether to run machine code where there is some, with results equal but for signs of zero: see `code`.
    """

    def __init__(self, function: Function | Recipe, *, compiled: bool = False) -> None:
        if isinstance(function, Recipe):
            inputs, outputs = function.inputs, function.outputs
            self.code = function.machine_code() if compiled else None
        else:
            refuse_sparse(function)
            inputs = tuple(function.nnz_in(k) for k in range(function.n_in()))
            outputs = tuple(function.nnz_out(k) for k in range(function.n_out()))
            self.code = machine_code(function) if compiled else None
        self._inputs, self._outputs = ([np.zeros(size) for size in sizes] for sizes in (inputs, outputs))
        if self.code is None:
            self._run = self._by_casadi(function.make() if isinstance(function, Recipe) else function)
        else:
            self._run = self._by_processor(self.code.run, self.code.work)

    def _by_casadi(self, function: Function) -> Callable[[], object]:
        self._buffer, run = function.buffer()
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


FLAGS = ("-O1", "-ffp-contract=off", "-fPIC", "-shared")
"""No fused operations, which some processors have: they would round otherwise than Python does."""
_LOADED: dict[str, ctypes.CDLL] = {}


def compiler() -> str | None:
    """The C compiler: $CC, else cc, gcc or clang; None where there is none, or on Windows."""
    if sys.platform == "win32":
        return None
    return next(
        (path for name in (os.environ.get("CC", ""), "cc", "gcc", "clang") if (path := shutil.which(name))), None
    )


def library_of(source: str) -> ctypes.CDLL | None:
    """The library of some C, loaded; None where there is no compiler, it fails or libraries may not be loaded.

    It is kept in memory and in the cache, and found again by the source, the compiler with its version and flags, and
    the machine; a damaged one is built anew.
    """
    program = compiler()
    try:
        made_by = "" if program is None else _version(program)
    except (OSError, subprocess.SubprocessError):
        return None
    if program is None:
        return None
    parts = (source, program, made_by, sys.platform, platform.machine(), *FLAGS)
    name = f"{hashlib.sha256(chr(0).join(parts).encode()).hexdigest()}.so"
    if name not in _LOADED:
        content = kept(name)
        library = None if content is None else _loaded(content)
        if library is None:
            content = _built(program, source)
            library = None if content is None else _loaded(content)
            if content is None or library is None:
                return None
            keep(name, content)
        _LOADED[name] = library
    return _LOADED[name]


@cache
def _version(program: str) -> str:
    return subprocess.run([program, "-v"], check=True, capture_output=True, text=True, timeout=20.0).stderr


def _built(program: str, source: str) -> bytes | None:
    try:
        with private_place() as place:
            code, made = place / "f.c", place / "f.so"
            code.write_text(source, encoding="utf-8")
            subprocess.run([program, *FLAGS, "-o", str(made), str(code), "-lm"], check=True, capture_output=True)
            return made.read_bytes()
    except (OSError, subprocess.SubprocessError):
        return None


def _loaded(content: bytes) -> ctypes.CDLL | None:
    """A library, which stays when the file that it is read from is deleted."""
    try:
        with private_place() as place:
            file = place / "f.so"
            file.write_bytes(content)
            return ctypes.CDLL(str(file))
    except OSError:
        return None
