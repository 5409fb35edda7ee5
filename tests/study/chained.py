"""An analysis that adds up numbers, and studies of several steps of it and of a sine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.result import Result
from geocontact.data.errors import InputError


@dataclass(frozen=True)
class AddOptions(Options):
    """The sum of the numbers that stand first in files, or of a column of tables.

    Parameters
    ----------
    files
        Each begins with a number, or is a table with force [N].
    times
        A factor.
    """

    files: tuple[Path, ...]
    _: KW_ONLY
    times: float = 1.0


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class AddResult(Result):
    """The sum."""

    total: float

    def tables(self) -> dict[str, pd.DataFrame]:
        return {"total": pd.DataFrame({"total [N]": [self.total]})}

    def write_files(self, folder: Path) -> None:
        super().write_files(folder)
        (folder / "total.txt").write_text(f"{self.total:.0f}", encoding="utf-8")


def _number(file: Path) -> float:
    add_input("number", file)
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".csv":
        return float(pd.read_csv(file)["force [N]"].sum())
    if "wrong" in text:
        raise InputError(file, "", "is wrong", "mend it")
    return float(text.split()[0])


def read(o: AddOptions) -> list[float]:
    return [_number(file) for file in o.files]


def run(numbers: list[float], o: AddOptions) -> AddResult:
    say(f"{o.times * sum(numbers):g}")
    return AddResult(total=o.times * sum(numbers))


add = Job("add", AddOptions, read, run)

OWN = """files = "{subject}_{trial}.txt"
analysis = "tests.study.chained:add"
per = ["subject"]

[options]
files = ["{sine:sine.csv}"]

[steps.offset]
analysis = "tests.study.chained:add"
per = ["subject"]
where = { trial = ["still"] }
options = { files = "{file}" }

[steps.sum]
analysis = "tests.study.chained:add"
where = { trial = ["1", "2"] }
options = { files = ["{file}", "{offset:total.txt}"] }

[steps.sine]
analysis = "tests.study.quick:quick"
where = { trial = ["1", "2"] }
options = { file = "{sum:total.txt}" }

[steps.all]
analysis = "tests.study.chained:add"
per = []
where = { trial = ["1", "2"] }
options = { files = ["{sum:total.txt}"] }
"""
"""From a number at rest for each subject, over sums and sines of each trial, to sums for each subject and over all."""


def chain(folder: Path, numbers: Mapping[str, str], more: str = "") -> Path:
    """A study of five steps with a file for each subject and trial."""
    for name, text in numbers.items():
        (folder / f"{name}.txt").write_text(text, encoding="utf-8")
    file = folder / "study.toml"
    file.write_text(more + OWN, encoding="utf-8")
    return file


NUMBERS = {"A_still": "1", "A_1": "10", "A_2": "20", "B_still": "2", "B_1": "30", "B_2": "40"}


def sine(number: float) -> float:
    """Sum of the forces of tests.study.quick."""
    return float((number * np.sin(np.linspace(0.0, 1.0, 5 + int(number)))).sum())
