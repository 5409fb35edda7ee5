"""Results appear whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from geocontact.data.errors import InputError

_drafts: set[Path] = set()


def discard_drafts() -> None:
    """Remove what is half-written."""
    for draft in tuple(_drafts):
        shutil.rmtree(draft, ignore_errors=True)


@contextmanager
def written_whole(out: Path) -> Iterator[Path]:
    """Folder to write into; its files move to `out` when the block ends well, and vanish when it does not.

    A folder that is there already keeps its other files.
    """
    for folder in (out, *out.parents):
        if folder.exists() and not folder.is_dir():
            raise InputError(folder, "", "is a file", "--out names a folder")
    base = next(folder for folder in (out, *out.absolute().parents) if folder.is_dir())
    try:
        draft = Path(tempfile.mkdtemp(prefix=".geocontact-", dir=base))
    except OSError as error:
        raise InputError(base, "", f"cannot be written to ({error.strerror})", "choose another --out") from error
    _drafts.add(draft)
    try:
        yield draft
        os.chmod(draft, 0o755)
        for file in sorted(p for p in draft.rglob("*") if p.is_file()):
            target = out / file.relative_to(draft)
            target.parent.mkdir(parents=True, exist_ok=True)
            os.replace(file, target)
    finally:
        shutil.rmtree(draft, ignore_errors=True)
        _drafts.discard(draft)
