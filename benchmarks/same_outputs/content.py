"""What of a file's content is compared: its lines, without what differs from run to run."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

STRIPPED = (
    *("seconds", "workers", "seconds_most", "cpu_seconds", "date"),  # when, and how long it took
    *("frames_per_second", "samples_per_second_of_one_core"),
    *("geocontact", "versions", "machine", "platform", "run"),  # by what, and its random name
    *("argv", "files"),  # as typed; the files of a folder are compared themselves
)
"""Keys of JSON objects that are left out."""
DIGESTS = "sha256"
"""Of the files of a folder, by name, in its run.json: left out, since the files are compared, and a page may differ."""
STRIPPED_COLUMNS = ("cpu [s]", "wall [s]", "seconds [s]", "folder")
"""Columns of tables that are left out; the last one names folders of a study's trials, which hang on the sources."""
STRIPPED_WORDS = re.compile(r"compiling the distance kernels|per second of|seconds of one core|^Seed \d+, \d{4}-")
"""Lines of text that are left out: what hangs on the load of the machine, and dates."""
RANDOM = re.compile(
    r"(?<=\.geocontact-)[0-9a-f]{16}|(?<=\b[mp])[0-9a-f]{10}\b|(?<=\bimage)[0-9a-f]{10}\b|(?<=\bresults/)[0-9a-f]{32}\b"
)
"""Names that are drawn at each run, or hang on the sources: folders of drafts, marks inside of an .svg file, folders of
a study's trials."""
WORDS = (".txt", ".md")
RUN = "run.json"
"""May have new keys."""


class Number(str):
    """A number as it is written."""

    __slots__ = ()


def lines(file: Path) -> list[str]:
    """Lines of a text file, of a table without the columns that are stripped; one for each array of an array file."""
    if file.suffix == ".npz":
        with np.load(file) as arrays:
            return [f"{n} {arrays[n].dtype} {arrays[n].shape} {arrays[n].tobytes().hex()}" for n in sorted(arrays)]
    text = file.read_bytes().decode("utf-8", errors="backslashreplace")
    if file.suffix == ".csv" and any(name in text.partition("\n")[0] for name in STRIPPED_COLUMNS):
        head, *rows = csv.reader(io.StringIO(text))
        kept = [k for k, name in enumerate(head) if name not in STRIPPED_COLUMNS]
        return [",".join(row[k] for k in kept) for row in (head, *rows)]
    if file.suffix in WORDS:
        return [line for line in text.split("\n") if not STRIPPED_WORDS.search(line)]
    return text.split("\n")


def pair(before: Path, after: Path, strip: Collection[str] = ()) -> tuple[list[str], list[str], list[str]]:
    """Lines of both files, and the new keys of a `run.json`; JSON files have a line `place = value` for each value."""
    if before.suffix != ".json":
        return lines(before), lines(after), []
    old, new = (stripped(parsed(file), (*STRIPPED, *strip)) for file in (before, after))
    added: list[str] = []
    if before.name == RUN:
        new = without_new(new, old, "", added)
    return list(values(old)), list(values(new)), added


def parsed(file: Path) -> Any:
    """A JSON file, its numbers as they are written."""
    return json.loads(file.read_text("utf-8"), parse_float=Number, parse_int=Number, parse_constant=Number)


def stripped(value: Any, keys: Collection[str]) -> Any:
    """Without these keys, at any depth."""
    if isinstance(value, Mapping):
        kept = {key: one for key, one in value.items() if key not in keys and not _digests(key, one)}
        return {key: stripped(one, keys) for key, one in kept.items()}
    return [stripped(one, keys) for one in value] if isinstance(value, list) else value


def _digests(key: str, value: Any) -> bool:
    """Of the files that were written; the digest of an input is a single text."""
    return key == DIGESTS and isinstance(value, Mapping)


def without_new(new: Any, old: Any, place: str, added: list[str]) -> Any:
    """`new` without keys that `old` lacks; these are added to a list by their place."""
    if isinstance(new, Mapping) and isinstance(old, Mapping):
        added += [f"{place}.{key}".lstrip(".") for key in new if key not in old]
        return {key: without_new(one, old[key], f"{place}.{key}", added) for key, one in new.items() if key in old}
    if isinstance(new, list) and isinstance(old, list) and len(new) == len(old):
        return [without_new(a, b, f"{place}[{k}]", added) for k, (a, b) in enumerate(zip(new, old, strict=True))]
    return new


def values(value: Any, place: str = "") -> Iterator[str]:
    """A line for each value and for each object and list, in the order of the file."""
    if isinstance(value, Mapping):
        yield f"{place} = {{}}"
        for key, one in value.items():
            yield from values(one, f"{place}.{key}".lstrip("."))
    elif isinstance(value, list):
        yield f"{place} = {len(value)} entries"
        for k, one in enumerate(value):
            yield from values(one, f"{place}[{k}]")
    else:
        yield f"{place} = {value if isinstance(value, Number) else json.dumps(value, ensure_ascii=False)}"
