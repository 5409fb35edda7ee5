"""The benchmark: draws the lots, works them on all cores, scores, writes, prints the table."""

from __future__ import annotations

import secrets
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from geocontact.analyses.gap.benchmark.case import Task, Worked, lost, worked
from geocontact.analyses.gap.benchmark.journal import Journal
from geocontact.analyses.gap.benchmark.write import Outcome, write_results
from geocontact.analyses.progress import progress
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.analyses.workers import each
from geocontact.cli.gap_benchmark import BenchmarkOptions
from geocontact.data.errors import InputError
from geocontact.gap_benchmark.drawing import KINDS, SYSTEMS, Lot, lots

COMMAND = "gap benchmark"
SEEDS = 2**32


def run_benchmark(o: BenchmarkOptions) -> int:
    """Run the whole benchmark."""
    kinds = _checked(o)
    seed = secrets.randbelow(SEEDS) if o.seed is None else o.seed
    systems = SYSTEMS if o.system == "all" else (o.system,)
    record = Record(COMMAND, {**asdict(o), "seed": seed})
    record.results["seed"] = seed
    with record.catching_warnings(), written_whole(o.out) as draft:
        journal = None if o.journal is None else Journal(o.journal)
        done = _worked(record, list(lots(systems, o.cases, kinds, seed)), draft, o, journal)
        for one in done:
            for line in one.trouble:
                record.warn(line)
        outcome = Outcome(seed, systems, tuple(done))
        if not outcome.labels:
            raise RuntimeError("no case could be drawn; see the warnings")
        table = write_results(record, outcome, draft, f"cases-{seed}" if o.keep else "")
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    for line in table:
        record.say(line)
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _checked(o: BenchmarkOptions) -> tuple[str, ...]:
    """Kinds that are asked for; InputError for options that mean nothing."""
    kinds = KINDS if o.kinds is None else tuple(dict.fromkeys(kind.strip() for kind in o.kinds.split(",")))
    unknown = [kind for kind in kinds if kind not in KINDS]
    rows = (
        (bool(unknown), "--kinds", f"unknown kind {unknown[:1]}", f"kinds are {', '.join(KINDS)}"),
        (o.cases < 1, "--cases", f"{o.cases} is less than one case", "give 1 or more, e.g. 200"),
        (o.again < 0, "--again", f"{o.again} is less than none", "give 0 or more"),
        (o.jobs is not None and o.jobs < 1, "--jobs", f"{o.jobs} is less than one process", "give 1 or more"),
        (o.journal is not None and o.seed is None, "--journal", "would go on with other cases", "give --seed too"),
        (o.journal is not None and o.keep, "--journal", "does not hold folders of cases", "leave out --keep"),
        (o.seed is not None and o.seed < 0, "--seed", f"{o.seed} is negative", "give 0 or more"),
    )  # fmt: skip
    for wrong, option, what, remedy in rows:
        if wrong:
            raise InputError("", option, what, remedy)
    return kinds


def _worked(
    record: Record, chosen: Sequence[Lot], draft: Path, o: BenchmarkOptions, journal: Journal | None
) -> list[Worked]:
    """Outcomes in the order of the lots; those that there are when somebody interrupts."""
    twice = {system: _spread([lot for lot in chosen if lot.system == system], o.again) for system in SYSTEMS}
    with tempfile.TemporaryDirectory(prefix="geocontact-") as scratch:
        folder = draft / f"cases-{record.results['seed']}" if o.keep else Path(scratch)
        folder.mkdir(exist_ok=True)
        found = {} if journal is None else {lot: journal.done[lot] for lot in chosen if lot in journal.done}
        left = [lot for lot in mixed(chosen) if lot not in found]
        tasks = [Task(lot, folder, o.keep, lot in twice[lot.system]) for lot in left]
        with progress("cases", len(tasks)) as step:
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
    count = Counter((lot.system, lot.kind) for lot in chosen)
    seen: Counter[tuple[str, str]] = Counter()
    along = {}
    for lot in chosen:
        key = lot.system, lot.kind
        along[lot] = (seen[key] + 0.5) / count[key]
        seen[key] += 1
    return sorted(chosen, key=lambda lot: along[lot])


def _spread(among: Sequence[Lot], count: int) -> set[Lot]:
    """So many lots, evenly spaced, so that every kind has a chance."""
    step = max(len(among) / count, 1.0) if count else 1.0
    return {among[int(i * step)] for i in range(min(count, len(among)))}
