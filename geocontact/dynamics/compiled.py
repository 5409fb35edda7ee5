"""CasADi functions as machine code, and as functions that read and write arrays in place."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

if TYPE_CHECKING:
    from casadi import Function


class Buffered:
    """Called with arrays, gives arrays that the next call overwrites; outputs must be dense.

    Parameters
    ----------
    function
        Of columns and matrices; these are passed and given column by column.
    """

    def __init__(self, function: Function) -> None:
        self._buffer, self._run = function.buffer()
        self.function = function
        self._inputs = [np.zeros(function.nnz_in(k)) for k in range(function.n_in())]
        self._outputs = [np.zeros(function.nnz_out(k)) for k in range(function.n_out())]
        for k, each in enumerate(self._inputs):
            self._buffer.set_arg(k, memoryview(each))  # type: ignore[call-arg, arg-type]  # its stubs tell another form
        for k, each in enumerate(self._outputs):
            self._buffer.set_res(k, memoryview(each))  # type: ignore[call-arg, arg-type]  # likewise

    def __call__(self, *values: Float[np.ndarray, ...]) -> list[Float[np.ndarray, " k"]]:
        """Outputs, each in one row. ValueError for more or fewer numbers than an input has: one is not for all."""
        for place, value in zip(self._inputs, values, strict=True):
            if value.size != place.size:
                raise ValueError(f"{value.size} numbers for {place.size} symbols")
            place[:] = value.ravel()
        self._run()
        return self._outputs


LONG = 2_000_000
"""Characters of source from which on it is compiled without optimisation."""


def flags(source: str) -> tuple[str, ...]:
    """For the compiler. Long functions without branches: more optimisation costs minutes and gains little.

    A step of a prosthetic stance, 3.2 million characters, takes gcc 12 6 CPU s at -O0 and 201 at -O1; a simulation of
    1822 steps then takes 0.40 and 0.15 CPU s, 1.6 without a compiler: 780 of them make up for -O1.
    """
    return ("-O0" if len(source) > LONG else "-O1", "-fPIC", "-shared")


def compiler() -> str | None:
    """The C compiler: $CC, else cc, gcc or clang; None where there is none, or on Windows."""
    if sys.platform == "win32":
        return None
    return next(
        (path for name in (os.environ.get("CC", ""), "cc", "gcc", "clang") if (path := shutil.which(name))), None
    )


def compiled(function: Function) -> Function:
    """The same function compiled, or itself where there is no compiler or it fails.

    The library is kept in `cache_folder` and found again by the source, the compiler and its flags.
    """
    return loaded(function, library_of(function))


def library_of(function: Function, beside: str = "") -> Path | None:
    """The function's library; None where there is no compiler or it fails.

    Parameters
    ----------
    beside
        C source that follows the function's own and may call it by its name.
    """
    from casadi import CodeGenerator

    program = compiler()
    if program is None:
        return None
    generator = CodeGenerator("f.c")
    generator.add(function)
    source = generator.dump() + beside
    key = "\0".join((source, program, *flags(source)))
    folder = cache_folder()
    library = folder / f"{hashlib.sha256(key.encode()).hexdigest()}.so"
    if not library.is_file():
        try:
            _build(program, source, folder, library)
        except (OSError, subprocess.CalledProcessError):
            return None
    return library


def loaded(function: Function, library: Path | None) -> Function:
    """The function out of its library; itself where there is none or it is damaged: it is built anew next time."""
    from casadi import external

    if library is None:
        return function
    try:
        return external(function.name(), str(library))
    except RuntimeError:
        library.unlink(missing_ok=True)
        return function


def cache_folder() -> Path:
    """$GEOCONTACT_CACHE, else the user's folder for such files."""
    named = os.environ.get("GEOCONTACT_CACHE")
    if named:
        return Path(named)
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "geocontact"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "geocontact"


def _build(program: str, source: str, folder: Path, library: Path) -> None:
    """Compile beside the place and move there: another process may do the same at the same time."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as place:
        code, made = Path(place) / "f.c", Path(place) / "f.so"
        code.write_text(source, encoding="utf-8")
        subprocess.run([program, *flags(source), "-o", str(made), str(code), "-lm"], check=True, capture_output=True)
        made.replace(library)
