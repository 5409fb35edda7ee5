"""Results that no description asks for: which they are, how large, and their removal."""

from __future__ import annotations

import json
import os
from collections.abc import Collection
from pathlib import Path

from geocontact.io.text.file_preflight import read_json
from geocontact.study.description import StudyFile
from geocontact.study.store import UNREADABLE, Store

ASKED = "asked_for.json"
"""File beside the results: the addresses that each description asked for last, by its path and folder from there."""
FROM = " from "
"""Between the path of a description and the folder that paths in it start from, where that is another one."""
MB = 1e6


def note_asked(store: Store, study: StudyFile, addresses: Collection[str]) -> None:
    """Keep which results a description asks for: besides those of earlier runs where one has no address, ""."""
    file, name, known = store.folder / ASKED, _named(store, study), _asked(store)
    before = known.get(name, []) if "" in addresses else []
    known[name] = sorted({*addresses, *before} - {""})
    draft = file.with_name(f"{ASKED}.part")
    draft.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")
    os.replace(draft, file)


def not_asked_for(store: Store, study: StudyFile, addresses: Collection[str]) -> dict[str, int]:
    """Bytes of the results that no description that is still there asks for, by address.

    This one asks for `addresses`, each other one for what it asked for when it was run last.
    """
    wanted = _wanted(store, study, addresses)
    return {each: store.size(each) for each in store.addresses() if each not in wanted}


def clear(store: Store, study: StudyFile, addresses: Collection[str]) -> dict[str, int]:
    """Remove them, and the logs of trials that none asks for; bytes of results by address."""
    wanted, removed = _wanted(store, study, addresses), not_asked_for(store, study, addresses)
    for each in (*removed, *(log for log in store.logs() if log not in wanted)):
        store.forget(each)
    return removed


def _wanted(store: Store, study: StudyFile, addresses: Collection[str]) -> set[str]:
    found = {*addresses}
    for other, asked in _asked(store).items():
        if other != _named(store, study) and (store.folder / other.partition(FROM)[0]).is_file():
            found |= {*asked}
    return found


def _named(store: Store, study: StudyFile) -> str:
    """A description and the folder that its paths start from, as paths from the results."""
    file = study.path.resolve()
    name = _from_results(store, file)
    return name if study.home == file.parent else f"{name}{FROM}{_from_results(store, study.home)}"


def _from_results(store: Store, path: Path) -> str:
    try:
        return Path(os.path.relpath(path, store.folder)).as_posix()
    except ValueError:  # on another drive
        return path.as_posix()


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
