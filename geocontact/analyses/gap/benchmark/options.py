"""What a benchmark of the diagnosis may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import Excludes, Missing, Needs
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError


@dataclass(frozen=True)
class BenchmarkOptions(Options):
    """Diagnose synthetic cases whose effect is known and withheld, and score the answers.

    Parameters
    ----------
    system
        Whose cases.
    cases
        How many of each system.
    seed
        Seed of all cases; a fresh one at each run by default. It is printed and written.
    laboratory
        Who records the cases: "home", or another with a recorder, a placement or inputs of its own; "abroad" lets these
        three take turns.
    kinds
        none,single,pair,outside,absorbed,fault,shift; all of them by default.
    jobs
        Processes; as many as there are cores by default. Cases and answers do not depend on it.
    again
        Cases of each system that are diagnosed a second time with other names, trials in another order, other units.
    journal
        File to which every case is added as it is done: called again with the same one, seed and version, the run goes
        on where it ended.
    keep
        Keep the folders of the cases in `out`/cases-SEED, with labels.json next to them.
    """

    writes: ClassVar[str] = """
    Cases are made by code that shares nothing with the candidates. Writes benchmark.md and benchmark.json (figures with
    exact intervals, with two residual regressions, a constant answer and an oracle), cases.csv, reliability.png,
    reliability.svg and run.json into OUT, and prints the table. The default takes an hour and a half on two cores.
    """

    _: KW_ONLY
    system: Literal["elbow", "foot", "shoulder", "knee", "sit_to_stand", "all"] = "all"
    cases: int = 200
    seed: int | None = None
    laboratory: Literal["home", "recorder", "placement", "inputs", "abroad"] = "home"
    kinds: str | None = None
    jobs: int | None = None
    again: int = 5
    journal: Annotated[
        Path | None,
        Missing(""),  # it is made
        Needs("seed", "it would go on with other cases; give the seed of the run"),
        Excludes("keep", "does not hold folders of cases", "leave out `keep`"),
    ] = None
    keep: bool = False

    def refuse_impossible(self) -> None:
        """Counts below their least, and a seed below 0."""
        rows = (
            ("cases", self.cases, 1, "less than one case", "give 1 or more, e.g. 200"),
            ("again", self.again, 0, "less than none", "give 0 or more"),
            ("jobs", self.jobs, 1, "less than one process", "give 1 or more"),
            ("seed", self.seed, 0, "negative", "give 0 or more"),
        )
        for name, value, least, what, remedy in rows:
            if value is not None and value < least:
                raise InputError("", f"`{name}`", f"{value} is {what}", remedy)
