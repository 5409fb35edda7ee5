"""The benchmark: works the cases on all cores and scores the answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from geocontact.analyses.gap.benchmark.case import Task, Worked, lost, worked
from geocontact.analyses.gap.benchmark.lines import page_lines
from geocontact.analyses.gap.benchmark.options import BenchmarkOptions
from geocontact.analyses.gap.benchmark.outcome import BenchmarkOutcome
from geocontact.analyses.gap.benchmark.read import Work
from geocontact.analyses.gap.benchmark.result import BenchmarkResult
from geocontact.analyses.results_folder import Scratch
from geocontact.analyses.run_record import Record
from geocontact.analyses.workers import each
from geocontact.gap_benchmark.drawing import SYSTEMS, Lot


def run(work: Work, o: BenchmarkOptions, record: Record) -> BenchmarkResult:
    """Answers to every case, scored; those that there are when somebody interrupts."""
    scratch = Scratch()
    done = _worked(record, work, scratch.folder, o)
    for one in done:
        for line in one.trouble:
            record.warn(line)
    outcome = BenchmarkOutcome(work.seed, work.systems, tuple(done))
    if not outcome.labels:
        raise RuntimeError("no case could be drawn; see the warnings")
    record.results["cases"] = outcome.kinds
    when = datetime.now(UTC).isoformat(timespec="seconds")
    for line in page_lines(outcome, when):
        record.say(line)
    return BenchmarkResult(record=record, options=o, outcome=outcome, when=when, scratch=scratch)


def _worked(record: Record, work: Work, folder: Path, o: BenchmarkOptions) -> list[Worked]:
    """Outcomes in the order of the lots."""
    chosen, journal = work.lots, work.journal
    twice = {system: _spread([lot for lot in chosen if lot.system == system], o.again) for system in SYSTEMS}
    found = {} if journal is None else {lot: journal.done[lot] for lot in chosen if lot in journal.done}
    left = [lot for lot in mixed(chosen) if lot not in found]
    tasks = [Task(lot, folder, o.keep, lot in twice[lot.system]) for lot in left]
    with record.listener.progress("cases", len(tasks)) as step:
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
            record.warn(f"interrupted after {len(found)} of {len(chosen)} cases, which are scored here")
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
