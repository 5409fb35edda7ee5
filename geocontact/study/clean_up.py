"""Results that no description asks for: which they are, how large, and their removal."""

from __future__ import annotations

import json
import os
from collections.abc import Collection
from pathlib import Path

from geocontact.io.text.file_preflight import read_json
from geocontact.study.store import UNREADABLE, Store

ASKED = "asked_for.json"
"""File beside the results: the addresses that each description asked for last, by its path from there."""
MB = 1e6


def note_asked(store: Store, study: Path, addresses: Collection[str]) -> None:
    """Keep which results a description asks for."""
    file = store.folder / ASKED
    known = {**_asked(store), _named(store, study): sorted({*addresses} - {""})}
    draft = file.with_name(f"{ASKED}.part")
    draft.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")
    os.replace(draft, file)


def not_asked_for(store: Store, study: Path, addresses: Collection[str]) -> dict[str, int]:
    """Bytes of the results that no description that is still there asks for, by address.

    This one asks for `addresses`, each other one for what it asked for when it was run last.
    """
    wanted = {*addresses}
    for other, asked in _asked(store).items():
        if other != _named(store, study) and (store.folder / other).is_file():
            wanted |= {*asked}
    return {each: store.size(each) for each in store.addresses() if each not in wanted}


def _named(store: Store, study: Path) -> str:
    """Path of a description from the results."""
    try:
        return Path(os.path.relpath(study.resolve(), store.folder)).as_posix()
    except ValueError:  # on another drive
        return study.resolve().as_posix()


def size_in_words(sizes: Collection[int]) -> str:
    """ "3 results, 6.5 MB"."""
    return f"{len(sizes)} result{'s' * (len(sizes) != 1)}, {sum(sizes) / MB:.3g} MB"


def _asked(store: Store) -> dict[str, list[str]]:
    """What is kept; nothing where that cannot be read."""
    try:
        known = read_json(store.folder / ASKED)
    except UNREADABLE:
        return {}
    if not isinstance(known, dict):
        return {}
    return {str(name): [str(each) for each in some] for name, some in known.items() if isinstance(some, list)}
