"""Ten thousand damaged files over every reader: each is refused in one line or read as it should be.

`python -m benchmarks.robustness.mutated_files` writes results/mutated_files.json while it goes, `--files 200` is a
short run.
Samples are shipped files, inputs of `same_outputs` and files of the project's own writers. Each is damaged once or
twice (`damage/mutations.py`) and read in a process with 3 times the file and 300 MB of memory and 10 s. Outcomes:
refused (InputError in one line that names the file), read (finite, plausible), read with a warning; and bad ones: any
other exception, an unclear refusal, a process that ends, a hang, an empty or non-finite result without a word.
"""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from benchmarks.damage.judged import BAD, GOOD, Case, Judge, Outcome
from benchmarks.damage.samples import Sample, samples
from benchmarks.machine import write_results

PACKAGES = {"pandas", "trimesh", "vtk", "ezc3d", "openpyxl", "defusedxml"}
SLOW = {"c3d": 0.1, "archive": 0.25}
"""Share of a sample's files where each starts a process or unpacks a workbook."""
SHOWN = 200


def cases(all_of_them: list[Sample], files: int, seed: int) -> Iterator[Case]:
    """So many, the samples in turn; those of slow readers less often."""
    made, k = 0, 0
    while made < files:
        for number, sample in enumerate(all_of_them):
            share = SLOW.get(sample.reader.split()[0], SLOW.get(sample.kind, 1.0))
            if made < files and (k + number) % round(1.0 / share) == 0:
                yield Case(sample, f"{seed} {sample.name} {k}")
                made += 1
        k += 1


def outcomes(files: int, seed: int, scratch: Path, only: str = "", c3d: bool = True) -> Iterator[tuple[Case, Outcome]]:
    """Every case with its outcome; files of the readers that start processes are left out without `c3d`."""
    every = samples(scratch / "samples")
    chosen = [one for one in every if only in one.name and (c3d or not one.reader.startswith("c3d"))]
    judge = Judge(scratch)
    for case in cases(chosen, files, seed):
        yield case, judge.outcome(case)
    judge.end()


def run(
    files: int,
    seed: int,
    only: str = "",
    c3d: bool = True,
    tell: Callable[[dict[str, Any]], None] = lambda _: None,
) -> dict[str, Any]:
    """Counts by reader, and the bad ones; `tell` hears of them every 1000 files."""
    table: dict[str, Counter[str]] = defaultdict(Counter)
    bad: list[dict[str, str]] = []
    with tempfile.TemporaryDirectory() as scratch:
        for number, (case, found) in enumerate(outcomes(files, seed, Path(scratch), only, c3d), 1):
            table[case.sample.reader][found.word] += 1
            if found.word in BAD:
                print(case.sample.name, found.word, found.ways, found.line, sep=" | ", flush=True)
                told = {"file": case.sample.file, "seed": case.seed, "damage": found.ways, "said": found.line}
                bad.append({"reader": case.sample.reader, "outcome": found.word, **told})
            if number % 1000 == 0:
                tell(figures(table, bad))
    return figures(table, bad)


def figures(table: dict[str, Counter[str]], bad: list[dict[str, str]]) -> dict[str, Any]:
    """What the file of results holds."""
    total = sum(table.values(), Counter())
    return {
        "files": sum(total.values()),
        "bad": len(bad),
        "outcomes": {word: total[word] for word in (*GOOD, *BAD)},
        "readers": {name: {word: row[word] for word in (*GOOD, *BAD) if row[word]} for name, row in table.items()},
        "examples": bad[:SHOWN],
    }


def main() -> None:
    """Damage, read, count."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--files", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="samples whose name holds this")
    parser.add_argument("--dry", action="store_true", help="write no results")
    asked = parser.parse_args()

    def tell(found: dict[str, Any]) -> None:
        if not asked.dry:
            write_results("mutated_files", {"files": asked.files, "seed": asked.seed}, found, PACKAGES)

    found = run(asked.files, asked.seed, asked.only, tell=tell)
    tell(found)
    print(found["outcomes"])


if __name__ == "__main__":
    main()
