"""Results appear whole or not at all."""

from __future__ import annotations

import os
import secrets
import shutil
import tempfile
import weakref
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from geocontact.analyses.page_words import counted
from geocontact.analyses.stale_results import RUN, left_over
from geocontact.data.errors import InputError

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
    draft = base / f".geocontact-{secrets.token_hex(8)}"
    _drafts.add(draft)  # before it is there: whoever is terminated in between leaves nothing behind
    try:
        draft.mkdir(mode=0o700)
    except OSError as error:
        _drafts.discard(draft)
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
