"""Long recordings a part at a time: what is worked out frame by frame takes the memory of one part.

Arrays beyond `AT_ONCE` values lie in temporary files that are mapped into memory. Pages of such a file count as memory
of the process while they are mapped in; after each part they are given back (`release`), and what was written to them
stays in the file. Files have no name and vanish with their array. They lie where Python's `tempfile` puts them: TMPDIR
names another place where that one is small, or is memory itself (tmpfs).
"""

from __future__ import annotations

import errno
import math
import mmap
import os
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from tempfile import TemporaryFile, gettempdir
from typing import IO, Any
from weakref import WeakSet, finalize

import numpy as np

from geocontact.data.errors import InputError

AT_ONCE = 1 << 18
"""Values of a part: 2 MB."""

_MAPPED: WeakSet[mmap.mmap] = WeakSet()


def blocks(count: int, each: int) -> Iterator[slice]:
    """Slices that follow each other over `count` frames, or channels, of `each` values; one at least."""
    step = max(1, AT_ONCE // max(1, each))
    yield from (slice(start, min(start + step, count)) for start in range(0, max(1, count), step))


def parts(values: np.ndarray, *others: np.ndarray, each: int = 0) -> Iterator[tuple[np.ndarray, ...]]:
    """Arrays of the same frames a part at a time, side by side; `each` is how many values a frame makes, if more."""
    both = (values, *others)
    for some in blocks(len(values), max(each, *(math.prod(one.shape[1:]) for one in both), 1)):
        yield tuple(one[some] for one in both)
        release()


def worked(made: Callable[..., np.ndarray], values: np.ndarray, *others: np.ndarray, each: int = 0) -> np.ndarray:
    """What `made` gives for each part, frame by frame in one array; arguments as of `parts`."""
    return worked_together(lambda *some: (made(*some),), values, *others, each=each)[0]


def worked_together(
    made: Callable[..., tuple[np.ndarray, ...]], values: np.ndarray, *others: np.ndarray, each: int = 0
) -> tuple[np.ndarray, ...]:
    """What `made` gives for each part where that is several arrays, each joined as by `worked`."""
    found: tuple[np.ndarray, ...] = ()
    start = 0
    for some in parts(values, *others, each=each):
        made_of_it = made(*some)
        if len(some[0]) == len(values):
            return made_of_it
        found = found or tuple(room((len(values), *one.shape[1:]), one.dtype) for one in made_of_it)
        for whole, part in zip(found, made_of_it, strict=True):
            whole[start : start + len(part)] = part
        start += len(some[0])
    release()
    return found


def room(shape: Sequence[int], dtype: Any = np.float64) -> np.ndarray:
    """An array to be filled, in a temporary file beyond `AT_ONCE` values; InputError where there is no space for it."""
    kind = np.dtype(dtype)
    if math.prod(shape) <= AT_ONCE:
        return np.empty(shape, kind)
    size = math.prod(shape) * kind.itemsize
    with TemporaryFile() as file, _space(size):
        if hasattr(os, "posix_fallocate"):  # a full disk shows here, not as a broken page later
            os.posix_fallocate(file.fileno(), 0, size)
        else:
            file.truncate(size)
        return _mapped(file, kind).reshape(shape)


def release() -> None:
    """Give the pages of all arrays in files back; the next who reads them finds them in their file."""
    if hasattr(mmap, "MADV_DONTNEED"):
        for each in list(_MAPPED):
            each.madvise(mmap.MADV_DONTNEED)


class Growing:
    """Numbers that are appended to; beyond `AT_ONCE` those before lie in a temporary file."""

    def __init__(self) -> None:
        self._near: array[float] = array("d")
        self._file: IO[bytes] | None = None
        self._before = 0

    def __len__(self) -> int:
        return self._before + len(self._near)

    def extend(self, numbers: Iterable[float]) -> None:
        """Append numbers."""
        self._near.extend(numbers)
        if len(self._near) > AT_ONCE:
            self._put_away()

    def extend_by(self, numbers: np.ndarray) -> None:
        """Append the numbers of an array, row by row."""
        self._near.frombytes(np.ascontiguousarray(numbers, np.float64).tobytes())
        if len(self._near) > AT_ONCE:
            self._put_away()

    def values(self) -> np.ndarray:
        """All of them, not copied."""
        if self._file is None:
            return np.frombuffer(self._near) if self._near else np.empty(0)
        self._put_away()
        return _mapped(self._file, np.dtype(float))

    def _put_away(self) -> None:
        if self._file is None:
            self._file = TemporaryFile()  # noqa: SIM115 - closed with this object; what is mapped of it stays
            finalize(self, _close, self._file)
        with _space(8 * len(self)):
            self._near.tofile(self._file)
            self._file.flush()
        self._before += len(self._near)
        self._near = array("d")


def _close(file: IO[bytes]) -> None:
    """What it could not hold was said when it was written."""
    with suppress(OSError):
        file.close()


def _mapped(file: IO[bytes], kind: np.dtype[Any]) -> np.ndarray:
    pages = mmap.mmap(file.fileno(), 0)
    _MAPPED.add(pages)
    return np.frombuffer(pages, kind)


@contextmanager
def _space(size: int) -> Iterator[None]:
    """InputError where a file of so many bytes does not fit."""
    try:
        yield
    except OSError as error:
        what = f"cannot hold {size / 1e9:.2g} GB of a long recording for a while ({error.strerror})"
        full = error.errno not in (errno.EMFILE, errno.ENFILE)
        remedy = "name another folder in TMPDIR" if full else "allow more open files (ulimit -n)"
        raise InputError(gettempdir(), "", what, remedy) from error
