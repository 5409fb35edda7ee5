"""Two recordings side by side: a line for each run, and where a number differs the file and the first line."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from itertools import takewhile, zip_longest
from pathlib import Path

from benchmarks.same_outputs.content import RANDOM, WORDS, pair

NUMBERS = (".csv", ".json", ".mot", ".sto", ".trc", ".osim", ".toml", ".npz", ".parquet", ".vtp", ".vtu", ".pvd")
"""Endings of files that must agree; of others (what was said, pages, figures) a difference is only told."""
CALL, ABOUT, INPUTS = "call.json", "recording.json", "inputs"
ADDRESSED = re.compile(r"/results/[0-9a-f]{32}/")
"""Results of a study's trials: their folder hangs on the sources; the tables of all trials are compared."""
WIDTH = 160


@dataclass
class Verdict:
    """What two recordings of a run differ in; `failures` count, `notes` are told."""

    failures: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    files: int = 0


@dataclass(frozen=True)
class Recording:
    """The folder of a recording, and the places that its texts may name."""

    folder: Path
    places: Mapping[str, str]

    @classmethod
    def of(cls, folder: Path) -> Recording:
        about = json.loads((folder / ABOUT).read_text("utf-8")) if (folder / ABOUT).is_file() else {}
        return cls(folder, {about[key]: f"<{key}>" for key in ("folder", "checkout") if key in about})

    def runs(self) -> list[str]:
        """Names of the runs, and the inputs."""
        calls = sorted(file.parent.name for file in self.folder.glob(f"*/{CALL}"))
        return [INPUTS, *calls] if (self.folder / INPUTS).is_dir() else calls

    def files(self, run: str) -> set[Path]:
        """Files of a run, as seen from the folder."""
        found = {file.relative_to(self.folder) for file in (self.folder / run).rglob("*") if file.is_file()}
        return {file for file in found if not ADDRESSED.search(file.as_posix())}

    def plain(self, line: str) -> str:
        """A line without the places of this recording and names that were drawn."""
        for place, word in self.places.items():
            line = line.replace(place, word)
        return RANDOM.sub("…", line)


def compared(before: Path, after: Path, strip: Collection[str] = ()) -> int:
    """Print a line for each run and a summary; exit code 1 where something that must agree does not."""
    old, new = Recording.of(before), Recording.of(after)
    every = {name: verdict(old, new, name, strip) for name in old.runs()}
    if not every:
        print(f"{before}: holds no recording")
        return 1
    for name, found in every.items():
        print(f"{'DIFFERS' if found.failures else 'same'} {name}: {found.files} files")
        for line in (*found.failures, *found.notes):
            print(f"    {line}")
    for name in sorted({*new.runs()} - {*every}):
        print(f"new run {name}")
    failed = sum(bool(found.failures) for found in every.values())
    files = sum(found.files for found in every.values())
    print(f"{len(every)} runs, {files} files compared; {failed} runs differ")
    return 1 if failed else 0


def verdict(old: Recording, new: Recording, run: str, strip: Collection[str]) -> Verdict:
    """Of one run."""
    found, (before, after) = Verdict(), (old.files(run), new.files(run))
    found.failures += [f"{path}: is missing" for path in sorted(before - after)]
    found.notes += [f"{path}: new file" for path in sorted(after - before)]
    for path in sorted(before & after):
        found.files += 1
        if (old.folder / path).read_bytes() != (new.folder / path).read_bytes():
            look(old, new, path, strip, found)
    return found


def look(old: Recording, new: Recording, path: Path, strip: Collection[str], found: Verdict) -> None:
    """Note what two files differ in that are not the same bytes: the first line, and new keys of a run.json."""
    ours, theirs, added = pair(old.folder / path, new.folder / path, strip)
    if added:
        found.notes.append(f"{path}: new keys {', '.join(added)}")
    both = zip_longest(map(old.plain, ours), map(new.plain, theirs))
    for number, (a, b) in enumerate(both, 1):
        if a == b:
            continue
        lines = f"in line {number}\n        before: {shown(a, b)}\n        after:  {shown(b, a)}"
        if path.suffix in NUMBERS or path.parts[0] == INPUTS:
            found.failures.append(f"{path}: differs {lines}")
        else:
            found.notes.append(f"{path}: words differ {lines}" if path.suffix in WORDS else f"{path}: differs")
        return


def shown(line: str | None, other: str | None) -> str:
    """A line, cut to what surrounds the first character that differs."""
    if line is None:
        return "(no such line)"
    same = sum(1 for _ in takewhile(lambda both: both[0] == both[1], zip(line, other or "", strict=False)))
    start = max(0, same - WIDTH // 2)
    return ("…" if start else "") + line[start : start + WIDTH]
