"""The numbers of two recordings side by side, apart from words and names, and why those differ that do."""

from __future__ import annotations

import csv
import io
import json
import math
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.machine import write_results
from benchmarks.same_outputs.comparing import INPUTS, NUMBERS, Recording
from benchmarks.same_outputs.content import STRIPPED, STRIPPED_COLUMNS, pair, stripped
from benchmarks.same_outputs.recording import RUNS
from benchmarks.same_outputs.recording import runs as planned

MEANT = Path(__file__).with_name("meant.toml")
"""Names that were changed, and numbers that were changed on purpose, by the commit that did it."""
BYTE, EQUAL, DIFFERS, MISSING = "equal to the byte", "equal in numbers", "differs", "is missing"
ORDER = (BYTE, EQUAL, DIFFERS, MISSING)
"""Outcomes of a file; that of a run is the last of those of its files. To the byte is meant as `compare` means it:
without times, versions and names that are drawn."""
MOTIONS, BINARY = (".mot", ".sto"), (".npz", ".parquet")
WORD = re.compile(r"[^\s,;:\"'<>()\[\]{}=]+")
"""What may be a number in a text that is no table."""


class Place(NamedTuple):
    """Where a number stands: in a column (or a key without its indices), and in which row."""

    column: str
    row: str


@dataclass(frozen=True)
class Change:
    """Numbers that were changed on purpose: patterns of files (`run/out/file.csv`), the commit, and what it did."""

    files: tuple[str, ...]
    commit: str
    why: str


@dataclass(frozen=True)
class Meant:
    """What was changed on purpose: old names by new ones, old files by new ones, numbers."""

    names: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    changes: Sequence[Change] = ()

    @classmethod
    def of(cls, file: Path = MEANT) -> Meant:
        """As a file in TOML has it."""
        held = tomllib.loads(file.read_text("utf-8"))
        changes = [Change(tuple(one["files"]), one["commit"], one["why"]) for one in held.get("change", [])]
        return cls(held.get("names", {}), held.get("files", {}), changes)

    def name(self, word: str) -> str:
        """A column, key or word of today by one of before."""
        return self.names.get(word, word)

    def why(self, file: str) -> list[str]:
        """Reasons for which a file may differ; none where it may not."""
        return [f"{c.commit}: {c.why}" for c in self.changes if any(fnmatch(file, one) for one in c.files)]


FRAME = re.compile(r"_\d+(?=\.vtp$)")
"""Number of a frame, at the end of its file's name."""


@dataclass
class Verdict:
    """Of one file: outcome; numbers compared, different, no longer there, new; and the largest relative difference."""

    outcome: str = BYTE
    numbers: int = 0
    different: int = 0
    gone: int = 0
    new: int = 0
    largest: float = 0.0
    of_column: float = 0.0
    """The largest difference as a share of the largest number of its column."""
    at: str = ""
    why: list[str] = field(default_factory=list)


def numbers_compared(before: Path, after: Path, meant: Meant, results: str = "", note: str = "") -> int:
    """Print a line for each file whose numbers differ and a summary; exit code 1 where one differs without a reason."""
    old, new = Recording.of(before), Recording.of(after)
    runs = {run: files_compared(old, new, run, meant) for run in old.runs()}
    unexplained = 0
    for run, files in runs.items():
        print(f"{worst(files)} {run}: {len(files)} files, {bytewise(files)} of them equal to the byte")
        for name, found in files.items():
            if found.outcome in (DIFFERS, MISSING):
                unexplained += not found.why
                print(f"    {name}: {said(found)}")
    count = {one: sum(worst(files) == one for files in runs.values()) for one in ORDER}
    print(f"{len(runs)} runs: " + ", ".join(f"{n} {one}" for one, n in count.items()))
    print(f"{unexplained} files differ without a reason")
    if results:
        asked = {"before": about(before), "after": about(after), "note": note}
        write_results(results, asked, figures(runs, count), frozenset({"scipy", "pandas"}))
    return 1 if unexplained or not runs else 0


def said(found: Verdict) -> str:
    """A verdict in words."""
    if found.outcome == MISSING:
        return f"{MISSING}; {'; '.join(found.why) or 'no reason'}"
    share = f"{found.different} of {found.numbers} numbers differ, {found.gone} are gone, {found.new} are new"
    most = f"; at most {found.largest:.2g} ({found.of_column:.2g} of the column), {found.at}" if found.different else ""
    return f"{share}{most}; {'; '.join(found.why) or 'no reason'}"


def about(folder: Path) -> str:
    """Commit of a recording."""
    return str(json.loads((folder / "recording.json").read_text("utf-8")).get("commit", "unknown"))


def figures(runs: Mapping[str, Mapping[str, Verdict]], count: Mapping[str, int]) -> dict[str, Any]:
    """What is kept: the outcome of every run; of files that are not equal to the byte what differs, and why."""
    kept: dict[str, Any] = {"runs": dict(count), "numbers": sum(f.numbers for r in runs.values() for f in r.values())}
    kept["not compared"] = [name for name in planned(RUNS.read_text("utf-8")) if name not in runs]
    kept["outcomes"] = {}
    for run, files in runs.items():
        one: dict[str, Any] = {"outcome": worst(files), "files": len(files), BYTE: bytewise(files)}
        unequal = {name: f for name, f in files.items() if f.outcome in (DIFFERS, MISSING)}
        if unequal:
            one["differ"] = _by_series(unequal)
        kept["outcomes"][run] = one
    return kept


def _by_series(unequal: Mapping[str, Verdict]) -> dict[str, Any]:
    """Files that differ; frames of one series are one entry, with the one that differs most and how many do."""
    series: dict[str, list[Verdict]] = {}
    for name, found in unequal.items():
        series.setdefault(FRAME.sub("_*", name), []).append(found)
    kept = {}
    for name, those in series.items():
        most = max(those, key=lambda one: (one.outcome == MISSING, one.of_column))
        kept[name] = _plain(most) | ({"files": len(those)} if len(those) > 1 else {})
    return kept


def _plain(found: Verdict) -> dict[str, Any]:
    """Of a file that differs, with three digits."""
    if found.outcome == MISSING:
        return {"outcome": MISSING, "why": found.why}
    counts = {"numbers": found.numbers, "different": found.different, "gone": found.gone, "new": found.new}
    sizes = {"largest": float(f"{found.largest:.3g}"), "of_column": float(f"{found.of_column:.3g}")}
    most = sizes | {"at": found.at.removeprefix("/")}  # a column of a motion is named like a path
    return {**counts, **(most if found.different else {}), "why": found.why}


def worst(files: Mapping[str, Verdict]) -> str:
    """Outcome of a run."""
    return max((one.outcome for one in files.values()), key=ORDER.index, default=BYTE)


def bytewise(files: Mapping[str, Verdict]) -> int:
    """Files that are equal to the byte."""
    return sum(one.outcome == BYTE for one in files.values())


def files_compared(old: Recording, new: Recording, run: str, meant: Meant) -> dict[str, Verdict]:
    """Every file of a run that holds numbers, by its name of before."""
    found = {}
    there = new.files(run)
    for path in sorted(old.files(run)):
        if path.suffix not in NUMBERS and path.parts[0] != INPUTS:
            continue
        now = path if path in there else Path(meant.files.get(path.as_posix(), path.as_posix()))
        verdict = Verdict(MISSING) if now not in there else compared(old.folder / path, new.folder / now, meant)
        if verdict.outcome == EQUAL and _same_lines(old, new, path, now):
            verdict.outcome = BYTE
        if verdict.outcome in (DIFFERS, MISSING):
            verdict.why = meant.why(path.as_posix())
        found[path.as_posix()] = verdict
    return found


def _same_lines(old: Recording, new: Recording, path: Path, now: Path) -> bool:
    """Whether all lines agree without what differs from run to run."""
    ours, theirs, added = pair(old.folder / path, new.folder / now)
    return not added and [*map(old.plain, ours)] == [*map(new.plain, theirs)]


def compared(before: Path, after: Path, meant: Meant) -> Verdict:
    """The numbers of two files, place by place; a number that is no longer there is a difference, a new one is none."""
    if before.read_bytes() == after.read_bytes():
        return Verdict(numbers=len(by_place(before, meant, named_rows=False)) if before.suffix in NUMBERS else 0)
    named = _rows(before) != _rows(after)
    old, new = by_place(before, meant, named_rows=named), by_place(after, meant, named_rows=named)
    found = Verdict(EQUAL, numbers=len(old), gone=len(old.keys() - new.keys()), new=len(new.keys() - old.keys()))
    most: dict[str, float] = {}
    for place, value in old.items():
        most[place.column] = max(most.get(place.column, 0.0), abs(value) if math.isfinite(value) else 0.0)
    for place, a in old.items():
        b = new.get(place, a)
        if a == b or (math.isnan(a) and math.isnan(b)):
            continue
        found.different += 1
        apart = abs(a - b) / max(abs(a), abs(b)) if math.isfinite(a) and math.isfinite(b) else math.inf
        if apart > found.largest:
            found.largest, found.at = apart, f"{place.column}[{place.row}]: {a:.12g} → {b:.12g}"
        of_column = abs(a - b) / most[place.column] if most[place.column] else math.inf
        found.of_column = max(found.of_column, of_column if math.isfinite(apart) else math.inf)
    if found.different or found.gone:
        found.outcome = DIFFERS
    return found


def by_place(file: Path, meant: Meant, *, named_rows: bool) -> dict[Place, float]:
    """Every number of a file; rows of a table by their number, or by their first word where `named_rows`."""
    if file.suffix in BINARY or file.suffix in (".csv", *MOTIONS):
        return dict(_of_table(*_table(file), meant, named_rows=named_rows))
    if file.suffix in (".json", ".toml"):
        text = file.read_text("utf-8")
        held = json.loads(text) if file.suffix == ".json" else tomllib.loads(text)
        return dict(_of_keys(stripped(held, STRIPPED), meant, "", ""))
    words = WORD.findall(file.read_bytes().decode("utf-8", errors="ignore"))
    return {Place("number", str(k)): one for k, one in enumerate(x for x in map(number, words) if x is not None)}


def number(word: object) -> float | None:
    """A word as a number; None where it is none."""
    if isinstance(word, bool):
        return None
    try:
        return float(word)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return None


def _rows(file: Path) -> int:
    """Rows of a table; 0 of other files."""
    return len(_table(file)[1]) if file.suffix in (".csv", ".parquet", *MOTIONS) else 0


def _table(file: Path) -> tuple[list[str], list[list[object]]]:
    """Names of columns, and rows; each array of an array file is a column."""
    if file.suffix == ".npz":
        with np.load(file) as arrays:
            columns = {name: arrays[name].ravel().tolist() for name in sorted(arrays)}
        longest = max(map(len, columns.values()), default=0)
        return list(columns), [[c[k] if k < len(c) else "" for c in columns.values()] for k in range(longest)]
    if file.suffix == ".parquet":
        import pandas as pd

        frame = pd.read_parquet(file)
        return list(map(str, frame.columns)), frame.to_numpy(dtype=object).tolist()
    text = file.read_text("utf-8", errors="backslashreplace")
    if file.suffix in MOTIONS:
        lines = text.partition("endheader")[2].strip().splitlines() or [""]
        return lines[0].split(), [list(line.split()) for line in lines[1:]]
    read = list(csv.reader(io.StringIO(text)))
    rows = [row for row in read if row and not row[0].startswith("#")] or [[]]
    return rows[0], [list(row) for row in rows[1:]]


def _of_table(
    head: Sequence[str], rows: Iterable[Sequence[object]], meant: Meant, *, named_rows: bool
) -> Iterator[tuple[Place, float]]:
    """Numbers by column and row."""
    seen: dict[str, int] = {}
    for k, row in enumerate(rows):
        key = str(k)
        if named_rows:
            words = [meant.name(str(one)) for one in row if number(one) is None and str(one)]
            first = words[0] if words else str(row[0]) if row else ""
            seen[first] = seen.get(first, -1) + 1
            key = f"{first} {seen[first]}" if seen[first] else first
        for name, cell in zip(head, row, strict=False):
            value = number(cell)
            if value is not None and name not in STRIPPED_COLUMNS:
                yield Place(meant.name(name), key), value


def _of_keys(value: Any, meant: Meant, key: str, row: str) -> Iterator[tuple[Place, float]]:
    """Numbers by key, and by their indices in lists."""
    if isinstance(value, Mapping):
        for name, one in value.items():
            yield from _of_keys(one, meant, f"{key}.{meant.name(name)}".lstrip("."), row)
    elif isinstance(value, list):
        for k, one in enumerate(value):
            yield from _of_keys(one, meant, key, f"{row},{k}".lstrip(","))
    elif not isinstance(value, str) and (found := number(value)) is not None:
        yield Place(key, row), found
