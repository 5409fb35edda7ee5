r"""A gap case of recordings: `geocontact gap gather`, `gc.gather`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> from pathlib import Path
>>> time = np.linspace(0.0, 1.0, 51)
>>> for k in (1, 2):
...     forces = {"medial [N]": 800.0 + 100.0 * k * time, "lateral [N]": 500.0 - 50.0 * k * time}
...     pd.DataFrame({"time [s]": time, **forces}).to_csv(f"forces_{k}.csv", index=False)
...     areas = {"area_medial [mm^2]": 60.0 + 5.0 * k * time, "area_lateral [mm^2]": 40.0 - 2.0 * k * time}
...     pd.DataFrame({"time [s]": time, **areas}).to_csv(f"areas_{k}.csv", index=False)
>>> text = 'format = 1\nsystem = "knee"\ncalibration = ["t1"]\nevaluation = ["t2"]\nconstants = { R = 0.037 }\n'
>>> text += 'parameters.E_star = { start = 1e7, lower = 1e5, upper = 1e9, unit = "Pa" }\n'
>>> for k in (1, 2):
...     text += f'[from.t{k}]\ninputs = "areas_{k}.csv"\nforces = "forces_{k}.csv"\n'
>>> _ = Path("gather.toml").write_text(text)
>>> print(gc.gather("gather.toml").sentences[0])
2 trials
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import say
from geocontact.analyses.frame.folder import Scratch
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Part, Result
from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.recordings import Recordings, gathered, read
from geocontact.analyses.gap.gather.show import gather_page
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import trial_table, write_gap_case

if TYPE_CHECKING:
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class GatherResult(Result):
    """Trials of a gap case as they were brought together; `write` makes the folder that `diagnose` reads.

    Parameters
    ----------
    case
        The case, SI units.
    scratch
        Where its files lie until they are written.
    """

    options: GatherOptions
    case: GapCase
    scratch: Scratch

    @property
    def title(self) -> str:
        """Which description was gathered."""
        return f"Trials of {self.options.settings.name}"

    @property
    def parts(self) -> frozenset[Part]:
        """The page; tables are among the files of the case."""
        return frozenset(("pages",))

    @property
    def time(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Time of the rows of each trial [s]."""
        return {one.name: one.time for one in self._trials}

    @property
    def channels(self) -> dict[str, dict[str, Float[np.ndarray, " t"]]]:
        """Columns of each trial over time [SI units of their names]."""
        return {one.name: {name: one.column(name) for name in one.signals.channels} for one in self._trials}

    @property
    def _trials(self) -> tuple[Trial, ...]:
        """Those that may be fitted to first."""
        return (*self.case.calibration, *self.case.evaluation)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`trials/<id>`: every trial, those that may be fitted to first."""
        return {f"trials/{one.name}": trial_table(one) for one in (*self.case.calibration, *self.case.evaluation)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Every channel of the trials over time."""
        return {REPORT: gather_page(self.title, self.case)}

    def write_files(self, folder: Path) -> None:
        """Also case.toml, trials, cells and tables."""
        shutil.copytree(self.scratch.folder, folder, dirs_exist_ok=True)
        super().write_files(folder)


def run(recordings: Recordings, o: GatherOptions) -> GatherResult:
    """The case, which can be read again as it will be written."""
    case = gathered(recordings, o)
    scratch = Scratch()
    write_gap_case(case, scratch.folder)
    read_gap_case(scratch.folder)
    sites = "".join(f", {site} ({len(own.ids)} cells)" for site, own in case.cells.items())
    say(f"{len(recordings.trials)} trials{sites}")
    return GatherResult(options=o, case=case, scratch=scratch)


gather = Job("gap gather", GatherOptions, read, run)
