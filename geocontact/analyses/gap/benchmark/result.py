"""How often the diagnosis is right: `geocontact gap benchmark`."""

from __future__ import annotations

import secrets
import shutil
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.frame.collector import current, listener, note, reserve, say
from geocontact.analyses.frame.folder import Scratch
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import write_json
from geocontact.analyses.frame.result import Part, Result
from geocontact.analyses.frame.workers import each
from geocontact.analyses.gap.benchmark.case import Journal, Task, Worked, lost, worked
from geocontact.analyses.gap.benchmark.options import BenchmarkOptions
from geocontact.analyses.gap.benchmark.outcome import BenchmarkOutcome, cases_table
from geocontact.analyses.gap.benchmark.show import content, page_lines, stated_figure
from geocontact.data.errors import InputError
from geocontact.gap_benchmark.drawing import ABROAD, KINDS, SYSTEMS, Lot, lots

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SEEDS = 2**32


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class BenchmarkResult(Result):
    """Answers to synthetic cases whose effect was known and withheld, scored.

    Parameters
    ----------
    outcome
        Labels and answers of every case.
    when
        Date and time, ISO 8601.
    scratch
        Where folders of cases lie that are kept.
    """

    options: BenchmarkOptions
    outcome: BenchmarkOutcome
    when: str
    scratch: Scratch

    @property
    def title(self) -> str:
        """With the seed of the cases."""
        return f"Gap benchmark, seed {self.outcome.seed}"

    @property
    def parts(self) -> frozenset[Part]:
        """No page: benchmark.md is read instead."""
        return frozenset(("tables", "figures"))

    @property
    def seconds(self) -> dict[str, float]:
        """CPU time of the diagnosis of each case [s]."""
        return {one.name: one.cpu for one in self.outcome.cases if one.label is not None}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`cases`: a row per case, the truth, what was said of it, and what that scores."""
        return {"cases": cases_table(self.outcome)}

    def figures(self) -> dict[str, Figure]:
        """`reliability`: stated probabilities against how often they came true."""
        return {"reliability": stated_figure(self.outcome)}

    def write_files(self, folder: Path) -> None:
        """Also figures as JSON and as text, and the cases if they are kept."""
        super().write_files(folder)
        write_json(folder / "benchmark.json", content(self.outcome, self.when))
        text = "\n".join(self.sentences) + "\n"
        (folder / "benchmark.md").write_text(text, encoding="utf-8", newline="\n")
        if self.options.keep:
            home = folder / f"cases-{self.outcome.seed}"
            shutil.copytree(self.scratch.folder, home)
            write_json(home / "labels.json", self.outcome.labels)


@dataclass(frozen=True)
class Work:
    """Cases in the order in which they are reported, and the journal that keeps them."""

    seed: int
    systems: tuple[str, ...]
    lots: tuple[Lot, ...]
    journal: Journal | None


def read(o: BenchmarkOptions) -> Work:
    """The lots of the options; a seed that was not given is drawn, and recorded as if it had been."""
    kinds = _kinds(o.kinds)
    seed = secrets.randbelow(SEEDS) if o.seed is None else o.seed
    current().options, current().in_si = {**current().options, "seed": seed}, {**current().in_si, "seed": seed}
    note("seed", seed)
    systems = SYSTEMS if o.system == "all" else (o.system,)
    laboratories = tuple(ABROAD) if o.laboratory == "abroad" else (o.laboratory,)
    journal = None if o.journal is None else Journal(o.journal)
    return Work(seed, systems, tuple(lots(systems, o.cases, kinds, seed, laboratories)), journal)


def _kinds(text: str | None) -> tuple[str, ...]:
    kinds = KINDS if text is None else tuple(dict.fromkeys(kind.strip() for kind in text.split(",")))
    unknown = [kind for kind in kinds if kind not in KINDS]
    if unknown:
        raise InputError("", "`kinds`", f"unknown kind {unknown[:1]}", f"kinds are {', '.join(KINDS)}")
    return kinds


def run(work: Work, o: BenchmarkOptions) -> BenchmarkResult:
    """Answers to every case, scored; those that there are when somebody interrupts."""
    scratch = Scratch()
    done = _worked(work, scratch.folder, o)
    for one in done:
        for line in one.trouble:
            reserve(line)
    outcome = BenchmarkOutcome(work.seed, work.systems, tuple(done))
    if not outcome.labels:
        raise RuntimeError("no case could be drawn; see the warnings")
    note("cases", outcome.kinds)
    when = datetime.now(UTC).isoformat(timespec="seconds")
    for line in page_lines(outcome, when):
        say(line)
    return BenchmarkResult(options=o, outcome=outcome, when=when, scratch=scratch)


def _worked(work: Work, folder: Path, o: BenchmarkOptions) -> list[Worked]:
    """Outcomes in the order of the lots."""
    chosen, journal = work.lots, work.journal
    twice = {system: _spread([lot for lot in chosen if lot.system == system], o.again) for system in SYSTEMS}
    found = {} if journal is None else {lot: journal.done[lot] for lot in chosen if lot in journal.done}
    left = [lot for lot in mixed(chosen) if lot not in found]
    tasks = [Task(lot, folder, o.keep, lot in twice[lot.system]) for lot in left]
    with listener().progress("cases", len(tasks)) as step:
        try:
            for task, became in each(worked, tasks, o.jobs):
                one = became if isinstance(became, Worked) else lost(task, became)
                found[task.lot] = one
                if journal is not None:
                    journal.keep(one)
                step()
        except KeyboardInterrupt:
            if not found:
                raise
            reserve(f"interrupted after {len(found)} of {len(chosen)} cases, which are scored here")
    return [found[lot] for lot in chosen if lot in found]


def mixed(chosen: Sequence[Lot]) -> list[Lot]:
    """Lots in an order in which every beginning has systems and kinds in about the proportions of the whole."""
    count = Counter((lot.system, lot.kind, lot.laboratory) for lot in chosen)
    seen: Counter[tuple[str, str, str]] = Counter()
    along = {}
    for lot in chosen:
        key = lot.system, lot.kind, lot.laboratory
        along[lot] = (seen[key] + 0.5) / count[key]
        seen[key] += 1
    return sorted(chosen, key=lambda lot: along[lot])


def _spread(among: Sequence[Lot], count: int) -> set[Lot]:
    """So many lots, evenly spaced, so that every kind has a chance."""
    step = max(len(among) / count, 1.0) if count else 1.0
    return {among[int(i * step)] for i in range(min(count, len(among)))}


benchmark = Job("gap benchmark", BenchmarkOptions, read, run)
