"""Which cases are drawn, and which of them are done already."""

from __future__ import annotations

import secrets
from dataclasses import dataclass

from geocontact.analyses.gap.benchmark.journal import Journal
from geocontact.analyses.gap.benchmark.options import BenchmarkOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.gap_benchmark.drawing import ABROAD, KINDS, SYSTEMS, Lot, lots

SEEDS = 2**32


@dataclass(frozen=True)
class Work:
    """Cases in the order in which they are told of, and the journal that keeps them."""

    seed: int
    systems: tuple[str, ...]
    lots: tuple[Lot, ...]
    journal: Journal | None


def read(o: BenchmarkOptions, record: Record) -> Work:
    """The lots of the options; a seed that was not given is drawn, and recorded as if it had been."""
    kinds = _kinds(o.kinds)
    seed = secrets.randbelow(SEEDS) if o.seed is None else o.seed
    record.options, record.in_si = {**record.options, "seed": seed}, {**record.in_si, "seed": seed}
    record.results["seed"] = seed
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
