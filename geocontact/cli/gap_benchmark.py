"""`geocontact gap benchmark`: the options of the command; the work is in `gap_benchmark_run`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class BenchmarkOptions:
    """Options of a benchmark as typed.

    Parameters
    ----------
    out
        Folder for the results.
    system
        Whose cases.
    cases
        How many of each system.
    seed
        Of all cases; a fresh one at each run unless given. It is printed and written.
    kinds
        none,single,pair,outside,absorbed,fault,shift; all of them unless given.
    jobs
        Processes; as many as there are cores unless given. Cases and answers do not depend on it.
    again
        Cases of each system that are diagnosed a second time with other names, trials in another order, other units.
    journal
        File to which every case is added as it is done: called again with the same one, seed and version, the run goes
        on where it ended.
    keep
        Keep the folders of the cases in OUT/cases-SEED, with labels.json beside them.
    """

    out: Path
    system: Literal["elbow", "foot", "shoulder", "knee", "sit_to_stand", "all"] = "all"
    cases: int = 200
    seed: int | None = None
    kinds: str | None = None
    jobs: int | None = None
    again: int = 5
    journal: Path | None = None
    keep: Annotated[bool, Flag] = False


def benchmark(*, options: BenchmarkOptions) -> int:
    """Diagnose synthetic cases whose effect is known and withheld, and score the answers.

    Cases are made by code that shares nothing with the candidates. Writes benchmark.md and benchmark.json (figures with
    exact intervals, beside two residual regressions, a constant answer and an oracle), cases.csv, reliability.png,
    reliability.svg and run.json into OUT, and prints the table. The default takes an hour and a half on two cores.
    """
    from geocontact.analyses.gap.benchmark.run import run_benchmark  # numpy and friends: not for --help

    return run_benchmark(options)
