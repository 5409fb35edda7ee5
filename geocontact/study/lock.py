"""One study at a time writes into a folder: a lock of the system, which goes with the process that holds it.

Nothing has to be cleared after a kill: a lock file that nobody holds is taken over. Between machines it needs a file
system with locks, as NFS and Lustre (mounted with `flock`) have; where there are none it holds nobody up.
"""

from __future__ import annotations

import errno
import os
import platform
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from geocontact.data.errors import InputError

LOCK = ".lock"
TAKEN = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)
LARGEST_TOLD = 200
BEHIND = 1 << 20
"""Byte that is locked on Windows, where others cannot read what is locked: behind what is told."""


@contextmanager
def sole_writer(folder: Path) -> Iterator[None]:
    """Hold the folder's lock while the block runs; InputError where another process holds it."""
    file = folder / LOCK
    descriptor = _held(file)
    try:
        os.ftruncate(descriptor, 0)
        os.write(descriptor, f"process {os.getpid()} on {platform.node()}".encode())
        yield
    finally:
        with suppress(OSError):  # Windows removes no open file; one that nobody holds is taken over
            file.unlink()
        os.close(descriptor)


def _held(file: Path) -> int:
    """Descriptor of the lock file, locked; again where another one removed the file in between."""
    while True:
        descriptor = os.open(file, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if not _lock(descriptor):
                told = os.read(descriptor, LARGEST_TOLD).decode(errors="replace").strip()
                what = f"another study writes here ({told or 'another process'})"
                raise InputError(file.parent, "", what, "wait until it has ended, or choose another `out`")
            with suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(descriptor), file.stat()):
                    return descriptor
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)


def _lock(descriptor: int) -> bool:
    """Lock without waiting; False where another process has it."""
    try:
        if sys.platform == "win32":
            import msvcrt

            os.lseek(descriptor, BEHIND, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            os.lseek(descriptor, 0, os.SEEK_SET)
        else:
            import fcntl

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in TAKEN:
            return False
        if error.errno not in (errno.ENOLCK, errno.ENOTSUP, errno.ENOSYS):
            raise
    return True
