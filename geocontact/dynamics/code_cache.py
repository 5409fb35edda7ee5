"""What is compiled at run time, kept between runs: only where nobody else can put code that this process would run.

A file holds the SHA-256 of its name and its content, and the content: a damaged file, or one under another's name, is
as if it were absent. That is no protection against whoever may write there, so a folder or a file of another user, or
one that others may write, is not used at all.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from geocontact.data.errors import InputWarning

MOST = 500_000_000
"""Bytes that are kept; the oldest files beyond are deleted."""
PREFIX, ABANDONED = "making-", 86_400.0
"""How folders in which something is being made begin, and the age [s] from which nobody works in them."""
SUM = hashlib.sha256().digest_size


def cache_folder() -> Path | None:
    """$GEOCONTACT_CACHE, else the user's folder for such files; None for a user without a home."""
    named = os.environ.get("GEOCONTACT_CACHE")
    if named:
        return Path(named)
    caches = os.environ.get("XDG_CACHE_HOME") if sys.platform != "darwin" else None
    try:
        place = Path.home() / ("Library/Caches" if sys.platform == "darwin" else ".cache")
    except RuntimeError:
        return Path(caches) / "geocontact" if caches else None
    return (Path(caches) if caches else place) / "geocontact"


def refusal(status: os.stat_result) -> str:
    """Why a file or folder is not used, "" where it may be; Windows' access lists are not looked at."""
    if sys.platform != "win32":
        if status.st_uid not in (0, os.getuid()):
            return f"belongs to another user ({status.st_uid})"
        if status.st_mode & 0o022:
            return "may be written by others"
    return ""


def usable_folder() -> Path | None:
    """`cache_folder`, made where it is absent; None where there can be none, or, with a warning, others may write."""
    folder = cache_folder()
    if folder is None:
        return None
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        why = refusal(folder.stat())
    except OSError:
        return None
    if why:
        _warn(str(folder), why)
        return None
    return folder


@cache
def _warn(folder: str, why: str) -> None:
    """Once in a process."""
    remedy = "`chmod go-w` it" if why.endswith("others") else "name one of your own in $GEOCONTACT_CACHE"
    warnings.warn(InputWarning(f"{folder} {why}: compiled code is not kept; {remedy}"), stacklevel=5)


def kept(name: str) -> bytes | None:
    """Content under a name; None where there is none, it is damaged or others may have written it."""
    folder = usable_folder()
    if folder is None:
        return None
    try:
        with (folder / name).open("rb") as stream:
            if refusal(os.fstat(stream.fileno())):
                return None
            whole = stream.read()
    except OSError:
        return None
    return whole[SUM:] if _sum(name, whole[SUM:]) == whole[:SUM] else None


def keep(name: str, content: bytes) -> None:
    """Write beside the place and move there, since another process may do the same; nothing where that fails."""
    folder = usable_folder()
    if folder is None:
        return
    with suppress(OSError), tempfile.TemporaryDirectory(dir=folder, prefix=PREFIX) as place:
        made = Path(place) / name
        with os.fdopen(os.open(made, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as stream:
            stream.write(_sum(name, content) + content)
        made.replace(folder / name)
    prune(folder)


def _sum(name: str, content: bytes) -> bytes:
    return hashlib.sha256(name.encode() + b"\0" + content).digest()


def prune(folder: Path) -> None:
    """Delete the oldest files beyond `MOST` bytes, and what processes that were ended have left half made."""
    files = sorted(_files(folder), key=lambda each: each[1].st_mtime_ns, reverse=True)
    total = 0
    for file, status in files:
        total += status.st_size
        if total > MOST:
            with suppress(OSError):
                file.unlink()
    for place in folder.glob(f"{PREFIX}*"):
        with suppress(OSError):
            if time.time() - place.stat().st_mtime > ABANDONED:
                shutil.rmtree(place, ignore_errors=True)


def _files(folder: Path) -> list[tuple[Path, os.stat_result]]:
    found = []
    for pattern in ("*.o", "*.so"):
        for file in folder.glob(pattern):
            with suppress(OSError):
                found.append((file, file.stat()))
    return found


def words() -> str:
    """Where machine code is kept and how much there is, or why it is not: for `geocontact doctor`."""
    folder = cache_folder()
    if folder is None:
        return "machine code of body models is not kept: no $GEOCONTACT_CACHE and no home folder"
    files = _files(folder)
    try:
        why = refusal(folder.stat())
    except OSError:
        why = ""  # it is made when it is needed
    if why:
        return f"machine code of body models is not kept: {folder} {why}"
    size = sum(status.st_size for _, status in files) / 1e6
    return f"machine code of body models is kept in {folder}: {len(files)} files, {size:.0f} of {MOST / 1e6:.0f} MB"


@contextmanager
def private_place() -> Iterator[Path]:
    """A folder for this process alone while it makes something: in the cache, where programs may run, else anywhere."""
    with tempfile.TemporaryDirectory(dir=_writable(usable_folder()), prefix=PREFIX) as place:
        yield Path(place)


def _writable(folder: Path | None) -> Path | None:
    return folder if folder is not None and os.access(folder, os.W_OK) else None
