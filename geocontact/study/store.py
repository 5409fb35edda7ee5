"""The folder of trials' results by their address, each whole or not at all; one study at a time writes there."""

from __future__ import annotations

import errno
import os
import platform
import re
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.analyses.frame.folder import RUN, is_inside
from geocontact.data.errors import OF_THE_MACHINE, InputError
from geocontact.io.text.file_preflight import read_json
from geocontact.study.address import LENGTH, Digests

LOCK = ".lock"
TAKEN = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)
LONGEST_OWNER = 200
ADDRESS = re.compile(rf"[0-9a-f]{{{LENGTH}}}")
BEHIND = 1 << 20
"""Byte that is locked on Windows, where others cannot read what is locked: behind what is written."""
RESULTS = "results"
REPORT = "trial.json"
"""File in the folder of a trial that says what is in it."""
WORK = ".work"
"""Sub-folder of what is being written."""
SHOWN = (".html", ".png", ".svg", ".pdf")
"""Endings of files that are only looked at."""
ANEW = "remove that folder: the trial is evaluated anew"
UNREADABLE = (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError)
"""Errors where a file of results, which may come from others, does not say what it should."""
MOST_ENDED = 3
"""So many workers may end while they are at a trial, before it is set aside."""


@contextmanager
def sole_writer(folder: Path) -> Iterator[None]:
    """Hold the folder's lock while the block runs; InputError where another process holds it.

    A lock of the system goes with the process that holds it, so nothing has to be cleared after a kill: a lock file
    that nobody holds is taken over. Between machines it needs a file system with locks, as NFS and Lustre (mounted with
    `flock`) have; where there are none it holds nobody up.
    """
    file = folder / LOCK
    descriptor = _locked_file(file)
    try:
        os.ftruncate(descriptor, 0)
        os.write(descriptor, f"process {os.getpid()} on {platform.node()}".encode())
        yield
    finally:
        with suppress(OSError):  # Windows removes no open file; one that nobody holds is taken over
            file.unlink()
        os.close(descriptor)


def _locked_file(file: Path) -> int:
    """Descriptor of the lock file, locked; again where another one removed the file in between."""
    while True:
        descriptor = os.open(file, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if not _lock(descriptor):
                owner = os.read(descriptor, LONGEST_OWNER).decode(errors="replace").strip()
                what = f"another study writes here ({owner or 'another process'})"
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


def _moved(file: str, now: Mapping[str, str]) -> str:
    """The path of a file with the folder of earlier results that it would come from now."""
    return next((new + file[len(old) :] for old, new in now.items() if file.startswith(f"{old}/")), file)


def _as_written(place: Path, run: Mapping[str, Any], digests: Digests) -> bool:
    """Whether a folder holds what its run.json says of it."""
    return all(
        is_inside(place, name)
        and (place / name).is_file()
        and (name.endswith(SHOWN) or digests.of(place / name) == known)
        for name, known in run.get("sha256", {}).items()
    )


@dataclass(frozen=True)
class Store:
    """Results by address below one folder.

    Parameters
    ----------
    folder
        On a cluster, one that all workers see under this path.
    """

    folder: Path

    def place(self, address: str) -> Path:
        """Folder of the results of that address, whether they are there or not."""
        return self.folder / address

    def report(self, address: str) -> dict[str, Any]:
        """What a trial says of itself: its tables, sentences and reservations.

        InputError where it is none, or a table's name leads out of the trial's folder: results may come from others.
        """
        file = self.place(address) / REPORT
        try:
            found: dict[str, Any] = read_json(file)
            whole = all(isinstance(each, str) for each in [*found["tables"], *found.get("warnings", ())])
        except (InputError, OSError):
            raise
        except UNREADABLE:
            whole = False
        if not whole:
            raise InputError(file, "", "does not say what a trial has", ANEW)
        for name in found["tables"]:
            if not is_inside(file.parent, f"{name}.parquet"):
                what = f"the table {str(name)[:80]!r} is not in its folder"
                raise InputError(file, "tables", what, ANEW)
        return found

    def holds(self, address: str, home: Path, digests: Digests, taken: Sequence[str] = ()) -> bool:
        """Whether results are there as they were written, and all files that they were made of are as they were.

        Of pages and pictures, which nothing is made of, only that they are there. `taken` are the folders of earlier
        results that they would be made of now, in the order of `address_of`: their files stand for those of the folders
        that these results were made of.
        """
        place = self.place(address)
        if not (place / REPORT).is_file():
            return False
        try:
            before = read_json(place / REPORT).get("from", [])
            now = dict(zip(before, taken, strict=True))
            run = read_json(place / RUN)
            named = {
                home / _moved(str(each["file"]), now): each["sha256"]
                for each in run["inputs"]
                if "sha256" in each and "file" in each
            }
            # a pipe or a device, of which results of others may say that they were made, would be waited for
            same = all(file.is_file() and digests.of(file) == known for file, known in named.items())
            return same and _as_written(place, run, digests)
        except UNREADABLE:
            return False

    def whole(self, address: str) -> bool:
        """Whether results are there as they were written, whatever has become of what they were made of."""
        place = self.place(address)
        try:
            return (place / REPORT).is_file() and _as_written(place, read_json(place / RUN), Digests())
        except UNREADABLE:
            return False

    def seconds(self, address: str) -> float | None:
        """How long the results took [s]; None where that is not known."""
        try:
            return float(read_json(self.place(address) / RUN)["seconds"])
        except UNREADABLE:
            return None

    def of_step(self, name: str, most: int) -> list[str]:
        """Addresses of at most so many results of a step, whatever they were made of."""
        found = []
        for each in self.addresses():
            with suppress(*UNREADABLE):
                if read_json(self.place(each) / REPORT).get("step") == name:
                    found.append(each)
            if len(found) == most:
                break
        return found

    def addresses(self) -> list[str]:
        """Addresses that have results, in order of the alphabet."""
        there = self.folder.iterdir() if self.folder.is_dir() else ()
        return sorted(
            p.name for p in there if ADDRESS.fullmatch(p.name) and not p.is_symlink() and (p / REPORT).is_file()
        )

    def logs(self) -> list[str]:
        """Addresses that have a log, in order of the alphabet."""
        return sorted(p.stem for p in self.folder.glob("*.log") if ADDRESS.fullmatch(p.stem))

    def size(self, address: str) -> int:
        """Bytes of results."""
        return sum(file.stat().st_size for file in self.place(address).rglob("*") if file.is_file())

    def keep(self, draft: Path, address: str) -> None:
        """Put finished results in their place; where others finished them meanwhile, theirs stay."""
        place = self.place(address)
        try:
            os.rename(draft, place)
        except OSError:
            if not (place / REPORT).is_file():
                raise
            shutil.rmtree(draft, ignore_errors=True)

    def write_log(self, address: str, text: str) -> str:
        """Keep the whole traceback of a trial that failed, until it is evaluated again; its file, from the study's."""
        self.log(address).write_text(text, encoding="utf-8")
        return self.log_named(address)

    def log(self, address: str) -> Path:
        """File that says where a trial failed, or was ended."""
        return self.folder / f"{address}.log"

    def log_named(self, address: str) -> str:
        """The same, from the study's folder."""
        return f"{self.folder.name}/{self.log(address).name}"

    def forget(self, address: str) -> None:
        """Remove results that are out of date; what says that they are whole goes first."""
        self.log(address).unlink(missing_ok=True)
        (self.place(address) / REPORT).unlink(missing_ok=True)
        shutil.rmtree(self.place(address), ignore_errors=True)

    @contextmanager
    def begun(self) -> Iterator[None]:
        """The folder to write into, for one study at a time; what is half-written is cleared before and after."""
        with ExitStack() as held:
            held.callback(self._clear_empty)
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
                held.enter_context(sole_writer(self.folder))
                shutil.rmtree(self.folder / WORK, ignore_errors=True)
                (self.folder / WORK).mkdir(exist_ok=True)
            except OSError as error:
                if error.errno in OF_THE_MACHINE:
                    raise
                what = f"cannot be written to ({error.strerror})"
                raise InputError(error.filename or self.folder, "", what, "choose another `out`") from error
            try:
                yield
            finally:
                shutil.rmtree(self.folder / WORK, ignore_errors=True)

    def _clear_empty(self) -> None:
        for folder in (self.folder, self.folder.parent):
            with suppress(OSError):  # something is kept there
                folder.rmdir()

    def starts(self, run: str, address: str) -> int:
        """How often a worker began a trial in a run and did not end it."""
        try:
            return (self.folder / WORK / f"{run}-{address}").stat().st_size
        except OSError:
            return 0

    def starting(self, run: str, address: str) -> Callable[[], None]:
        """Note that a worker begins a trial; the function takes the note away when it has ended it."""
        note = self.folder / WORK / f"{run}-{address}"
        with note.open("ab") as file:
            file.write(b".")
        return lambda: note.unlink(missing_ok=True)
