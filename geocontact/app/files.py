"""Contents of files, found in a process of its own: a large or damaged file stops nothing."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
import threading
import warnings
from collections.abc import Sequence
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path
from typing import Any

from geocontact.analyses.frame.file_content import Content, content_of, state_of_folder
from geocontact.data.errors import InputError

PATIENCE = 60.0
"""s that reading may last before the file is said to be too large to be looked at."""
PAGE = "page"
_running: set[subprocess.Popen[str]] = set()
_closed = threading.Event()

Known = tuple[Path, int, int]
"""A file, its time of change and its size: the same content as before. Of a folder, a mark of these of all files in it,
and how many they are."""


def known_file(path: Path, folder: bool = False) -> Known | None:
    """A regular file as it is now, or a folder where that may be; None where none is that may be looked at."""
    try:
        seen = path.stat()
    except (OSError, ValueError):  # a folder that is closed, a name that is too long or holds a zero
        return None
    if folder and stat.S_ISDIR(seen.st_mode):
        return (path, *state_of_folder(path))
    return (path, seen.st_mtime_ns, seen.st_size) if stat.S_ISREG(seen.st_mode) else None


def page_name(surface: Path, unit: str) -> str:
    """File name of the page of a surface, another one for each path and unit."""
    mark = sha256(os.fsencode(surface.absolute())).hexdigest()[:16]
    return f"{surface.stem[:32]}_{unit}_{mark}.html"


def contents(paths: Sequence[Path], patience: float = PATIENCE) -> list[Content]:
    """Content of each file, in their order."""
    found, why = answer_of(__name__, {"paths": list(map(str, paths))}, patience)
    if found is not None:
        return [Content(**each) for each in found]
    if len(paths) > 1 and not _closed.is_set():  # by themselves, so that one costs the others nothing
        return [content for path in paths for content in contents([path], patience)]
    return [Content(wrong=f"{path.name}: not looked at, {why}") for path in paths]


def write_page(surface: Path, unit: str, out: Path, patience: float = PATIENCE) -> str:
    """Write the page of a surface, which turns it in 3-D; why it cannot be written, "" where it is."""
    found, why = answer_of(__name__, {PAGE: [str(surface), unit, str(out)]}, patience)
    return f"no page: {why}" if found is None else str(found)


def answer_of(module: str, question: object, patience: float = PATIENCE) -> tuple[Any, str]:
    """What a module of this room prints for a question, both as JSON; None and why where it prints nothing.

    Its process ends with all that it started where it lasts too long. The question goes to its standard input:
    arguments have a largest size and are seen by other users.
    """
    from geocontact.app.runs import end  # which a process that reads does not need

    with subprocess.Popen(
        [sys.executable, "-P", "-m", module],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        encoding="utf-8",
        start_new_session=os.name != "nt",
    ) as process:
        try:
            if until_close(process):
                printed, _ = process.communicate(json.dumps(question), timeout=patience)
        except subprocess.TimeoutExpired:
            pass
        finally:
            timely = process.poll() is not None
            if not timely:
                end(process)
            _running.discard(process)
    if not timely:
        return None, f"reading lasts more than {patience:g} s"
    code = process.returncode
    return (json.loads(printed), "") if code == 0 else (None, f"the process that reads ended with {code}")


def until_close(process: subprocess.Popen[str]) -> bool:
    """End a process at `close` at the latest; False where that was before."""
    _running.add(process)
    return not _closed.is_set()


def close() -> None:
    """End all that is being read or written, for good."""
    from geocontact.app.runs import end

    _closed.set()
    for process in tuple(_running):
        if process.poll() is None:
            end(process)


def _page(surface: str, unit: str, out: str) -> str:
    """Write the page in this process; why it cannot be written."""
    from geocontact.analyses.frame.surface_page import write_surface_page

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # stand beside the file already
        try:
            write_surface_page(Path(surface), unit, Path(out))
        except InputError as error:
            return str(error)
    return ""


if __name__ == "__main__":
    asked = json.load(sys.stdin)
    found = _page(*asked[PAGE]) if PAGE in asked else [asdict(content_of(Path(each))) for each in asked["paths"]]
    json.dump(found, sys.stdout)
