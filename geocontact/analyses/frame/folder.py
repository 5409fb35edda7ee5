"""A folder of results: written whole or not at all, and rid of what an earlier run left.

`run.json` lists the files that a run wrote with their SHA-256. Only a file that still has that content is ever removed:
whatever somebody else put there, or changed, stays, and a list that lies removes nothing.
"""

from __future__ import annotations

import hashlib
import os
import secrets
import shutil
import tempfile
import weakref
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path, PurePosixPath

from geocontact.analyses.frame.words import counted
from geocontact.data.errors import OF_THE_MACHINE, InputError

RUN = "run.json"
DRAFT = ".geocontact-"
"""How the names of folders begin that are written into before they are moved."""
OWNER = "GEOCONTACT_DRAFTS_OF"
"""Variable of the environment with a word for these names, by which who ends a process finds its drafts."""


def digest(file: Path) -> str:
    """SHA-256 of a file."""
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


def written(folder: Path, others: Iterable[Path], command: str) -> dict[str, str]:
    """Files of one run in and below `folder` with their SHA-256.

    Not those of the runs in `others` below it, nor where a run.json of the same command tells of them already.
    """
    own = {file.parent for file in folder.rglob(RUN) if _written_record(file.parent).get("command") == command}
    apart = {place for place in (*others, *own) if folder in place.parents}
    files = sorted(file for file in folder.rglob("*") if file.is_file() and not apart & set(file.parents))
    return {file.relative_to(folder).as_posix(): digest(file) for file in files if file.name != RUN}


def left_over(out: Path, draft: Path) -> list[Path]:
    """Files of earlier runs of the same command that would stand in `out` beside the results in `draft`.

    Looked at are `out`, the sub-folders that the draft fills again, and those that the earlier run of `out` filled and
    no other run has since; nothing in them but what their run.json lists.
    """
    command = _written_record(draft).get("command")
    before = _written_record(out)
    children = [p for p in out.iterdir() if p.is_dir() and not p.is_symlink()] if out.is_dir() else []
    filled = [p for p in children if (draft / p.name).is_dir() or (p.name in _folders(before) and _same(p, before))]
    found = []
    for place in (out, *filled):
        told = _written_record(place)
        if told and told.get("command") == command:
            again = draft / place.relative_to(out)
            found += [file for file in _files(told, place) if not (again / file.relative_to(place)).exists()]
    return found


def _written_record(folder: Path) -> dict[str, object]:
    """Content of the folder's run.json; empty when there is none that can be read."""
    try:
        from geocontact.io.text.file_preflight import read_json  # with numpy: not for --help

        content = read_json(folder / RUN)
    except (ValueError, RecursionError):  # InputError is one
        return {}
    return content if isinstance(content, dict) else {}


def _files(told: dict[str, object], place: Path) -> list[Path]:
    """What a run wrote into a folder and nobody has touched since, and its run.json."""
    listed = told.get("sha256")
    if not isinstance(listed, dict):
        return []
    found = [
        place / name for name, known in listed.items() if is_inside(place, name) and _untouched(place / name, known)
    ]
    return [*found, place / RUN]


def is_inside(place: Path, name: str) -> bool:
    """Whether a name leads to something below the folder it is said of, links followed."""
    path = PurePosixPath(name)
    if not path.parts or path.is_absolute() or ".." in path.parts or "\\" in name:
        return False
    try:
        return (place / name).resolve().is_relative_to(place.resolve())
    except (OSError, ValueError, RuntimeError):
        return False


def _untouched(file: Path, known: object) -> bool:
    try:
        return not file.is_symlink() and file.is_file() and digest(file) == known
    except (OSError, ValueError):
        return False


def _folders(told: dict[str, object]) -> list[object]:
    inputs = told.get("inputs")
    return [entry.get("folder") for entry in inputs if isinstance(entry, dict)] if isinstance(inputs, list) else []


def _same(folder: Path, before: dict[str, object]) -> bool:
    """Whether the results in a sub-folder are those of the run that `before` tells of."""
    told = _written_record(folder)
    runs = [_results(each).get("run") for each in (told, before)]
    if isinstance(runs[0], str) and runs[0] == runs[1]:
        return True
    own = {"files": None, "sha256": None}
    return bool(told) and {**told, **own} == {**before, **own}


def _results(told: dict[str, object]) -> dict[str, object]:
    results = told.get("results")
    return results if isinstance(results, dict) else {}


_drafts: set[Path] = set()
_written: list[Path] = []


def discard_drafts() -> None:
    """Remove what is half-written."""
    for draft in tuple(_drafts):
        shutil.rmtree(draft, ignore_errors=True)


def what_stays() -> str:
    """What an interrupted run leaves: nothing, or what it wrote whole before, such as the first trials of several."""
    folders = list(dict.fromkeys(_written))
    if not folders:
        return "nothing was written"
    others = f" and {counted(len(folders) - 1, 'folder')} more" if len(folders) > 1 else ""
    return f"what was finished is in {folders[-1]}{others}"


def is_kept(folder: Path) -> None:
    """What lies in a folder stays when the run is ended now."""
    _written.append(folder)


class Scratch:
    """A folder for files that a result will write; it goes with the last reference to it, and when a run is ended.

    Parameters
    ----------
    folder
        Empty at first.
    """

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="geocontact-"))
        _drafts.add(self.folder)
        weakref.finalize(self, _discard, self.folder)


def _discard(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    _drafts.discard(folder)


@contextmanager
def written_whole(out: Path, overwrite: bool = True) -> Iterator[Path]:
    """Folder to write into; its files move to `out` when the block ends well, and vanish when it does not.

    A folder that is there already keeps its other files, but not those in which an earlier run of the same command left
    what this one has not written again. Without `overwrite` a folder that holds results is refused.
    """
    if not overwrite and (out / RUN).exists():
        raise InputError(
            out, "", f"holds results already ({RUN})", "choose another `out`, or allow it to be overwritten"
        )
    for folder in (out, *out.parents):
        if folder.exists() and not folder.is_dir():
            raise InputError(folder, "", "is a file", "`out` names a folder")
    base = next(folder for folder in (out, *out.absolute().parents) if folder.is_dir())
    owner = f"{name}-" if (name := os.environ.get(OWNER, "")).isalnum() else ""
    draft = base / f"{DRAFT}{owner}{secrets.token_hex(8)}"
    _drafts.add(draft)  # before it is there: whoever is terminated in between leaves nothing behind
    try:
        draft.mkdir(mode=0o700)
    except OSError as error:
        _drafts.discard(draft)
        if error.errno in OF_THE_MACHINE:
            raise
        raise InputError(base, "", f"cannot be written to ({error.strerror})", "choose another `out`") from error
    try:
        yield draft
        os.chmod(draft, 0o755)
        old = left_over(out, draft)
        files = sorted(p for p in draft.rglob("*") if p.is_file())
        targets = [out / file.relative_to(draft) for file in files]
        _refuse_what_is_in_the_way(targets)
        for file, target in zip(files, targets, strict=True):
            target.parent.mkdir(parents=True, exist_ok=True)
            os.replace(file, target)
        _written.append(out)
        for file in old:
            file.unlink(missing_ok=True)
        for folder in sorted({p for file in old for p in file.parents if out in p.parents}, reverse=True):
            with suppress(OSError):  # it holds files of somebody else
                folder.rmdir()
    finally:
        shutil.rmtree(draft, ignore_errors=True)
        _drafts.discard(draft)


def _refuse_what_is_in_the_way(targets: list[Path]) -> None:
    for target in targets:
        if target.is_dir():
            raise InputError(target, "", "is a folder where a result is to be a file", "choose another `out`")
        if target.parent.exists() and not target.parent.is_dir():
            raise InputError(target.parent, "", "is a file where results need a folder", "choose another `out`")
