"""What was claimed of cases that lack nothing, by system and laboratory."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from geocontact.analyses.gap.benchmark.outcome import BenchmarkOutcome
from geocontact.gap_benchmark.harm import SURE, certainty, harmful
from geocontact.gap_benchmark.rates import Rate

ALL = "all"


@dataclass(frozen=True)
class Alarms:
    """Of the cases of a system and a laboratory, or of all: those with a false alarm, the certain and harmful ones."""

    system: str
    laboratory: str
    claimed: Rate
    sure: Rate
    harmful: Rate


def alarms(outcome: BenchmarkOutcome) -> Iterator[Alarms]:
    """A row per system and laboratory, then one per laboratory over all systems, where there are several."""
    none = [one for one in outcome.cases if one.label is not None and one.lot.kind == "none"]
    places = list(dict.fromkeys(one.lot.laboratory for one in none))
    systems = list(dict.fromkeys(one.lot.system for one in none))
    for system in [*systems, *([ALL] if len(systems) > 1 else [])]:
        for place in [*places, *([ALL] if len(places) > 1 else [])]:
            chosen = [one for one in none if system in (ALL, one.lot.system) and place in (ALL, one.lot.laboratory)]
            said = [(one.label or {}, one.answers["diagnosis"]) for one in chosen]
            claimed = [b["verdict"] != "no_gap" for _, b in said]
            yield Alarms(
                system,
                place,
                Rate.of(claimed),
                Rate.of(c and certainty(b) >= SURE for c, (_, b) in zip(claimed, said, strict=True)),
                Rate.of(harmful(a, b) for a, b in said),
            )


def alarm_lines(outcome: BenchmarkOutcome) -> Iterator[str]:
    """The rows as a table."""
    yield f"| system | laboratory | false alarms | with p ≥ {SURE:g} | named, held out worse |"
    yield "|---|---|---|---|---|"
    for one in alarms(outcome):
        yield f"| {one.system} | {one.laboratory} | {one.claimed} | {one.sure} | {one.harmful} |"
