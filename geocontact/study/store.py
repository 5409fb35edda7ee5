"""The folder in which the results of trials lie by their address, whole or not at all."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.analyses.stale_results import RUN
from geocontact.data.errors import InputError
from geocontact.study.address import Digests
from geocontact.study.lock import sole_writer

RESULTS = "results"
TOLD = "trial.json"
"""File in the folder of a trial that says what is in it."""
WORK = ".work"
"""Sub-folder of what is being written."""
MOST_ENDED = 3
"""So many workers may end while they are at a trial, before it is set aside."""


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

    def told(self, address: str) -> dict[str, Any]:
        """What a trial says of itself: its tables, sentences and reservations."""
        found: dict[str, Any] = json.loads((self.place(address) / TOLD).read_bytes())
        return found

    def holds(self, address: str, home: Path, digests: Digests) -> bool:
        """Whether results are there, and all files that they were made of are as they were."""
        place = self.place(address)
        if not (place / TOLD).is_file():
            return False
        try:
            inputs = json.loads((place / RUN).read_bytes())["inputs"]
            return all(
                digests.of(home / each["file"]) == each["sha256"]
                for each in inputs
                if "sha256" in each and "file" in each
            )
        except (OSError, ValueError, KeyError, TypeError):
            return False

    def keep(self, draft: Path, address: str) -> None:
        """Put finished results in their place; where others finished them meanwhile, theirs stay."""
        place = self.place(address)
        try:
            os.rename(draft, place)
        except OSError:
            if not (place / TOLD).is_file():
                raise
            shutil.rmtree(draft, ignore_errors=True)

    def forget(self, address: str) -> None:
        """Remove results that are out of date; what says that they are whole goes first."""
        (self.place(address) / TOLD).unlink(missing_ok=True)
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
