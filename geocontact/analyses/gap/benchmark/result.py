"""What a benchmark of the diagnosis comes to."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.gap.benchmark.content import content
from geocontact.analyses.gap.benchmark.figure import stated_figure
from geocontact.analyses.gap.benchmark.options import BenchmarkOptions
from geocontact.analyses.gap.benchmark.outcome import BenchmarkOutcome
from geocontact.analyses.gap.benchmark.tables import cases_table
from geocontact.analyses.json_file import write_json
from geocontact.analyses.result import Part, Result
from geocontact.analyses.results_folder import Scratch

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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

    def tables(self) -> dict[str, pd.DataFrame]:
        """`cases`: a row per case, the truth, what was said of it, and what that scores."""
        return {"cases": cases_table(self.outcome)}

    def figures(self) -> dict[str, Figure]:
        """`reliability`: stated probabilities against how often they came true."""
        return {"reliability": stated_figure(self.outcome)}

    def write_files(self, folder: Path) -> None:
        """Also figures as JSON and as text, and the cases if they are kept."""
        super().write_files(folder)
        write_json(folder / "benchmark.json", content(self.record, self.outcome, self.when))
        text = "\n".join(self.sentences) + "\n"
        (folder / "benchmark.md").write_text(text, encoding="utf-8", newline="\n")
        if self.options.keep:
            home = folder / f"cases-{self.outcome.seed}"
            shutil.copytree(self.scratch.folder, home)
            write_json(home / "labels.json", self.outcome.labels)
