"""An analysis of a few milliseconds that can fail in every way, and studies of it."""

from __future__ import annotations

import ctypes
import errno
import json
import os
import time
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input, judge, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.result import Result
from geocontact.data.errors import InputError
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit
from geocontact.io.text.results import write_table


@dataclass(frozen=True)
class QuickOptions(Options):
    """A sine over time, times the number in a file.

    Parameters
    ----------
    file
        Holds a number, and after it what goes wrong, if anything does.
    gain
        A second factor.
    """

    over_time: ClassVar[bool] = True

    file: Path
    _: KW_ONLY
    gain: float = 1.0


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class QuickResult(Result):
    """The sine."""

    table_: pd.DataFrame

    def tables(self) -> dict[str, pd.DataFrame]:
        return {"sine": self.table_}

    def write_files(self, folder: Path) -> None:
        write_table(self.table_, folder, "sine")
        self.write_page(folder / "report.html")

    def write_page(self, file: Path) -> None:
        file.write_text("<p>sine</p>", encoding="utf-8")


def read(o: QuickOptions) -> tuple[float, str]:
    add_input("number", o.file)
    words = o.file.read_text(encoding="utf-8").split()
    if len(words) > 2:  # a file that only this one names
        add_input("beside", o.file.with_name(words[2]))
    return float(words[0]), words[1] if len(words) > 1 else ""


def run(inputs: tuple[float, str], o: QuickOptions) -> QuickResult:  # noqa: C901
    number, wrong = inputs
    match wrong:
        case "wrong":
            raise InputError(o.file, "", "is wrong", "mend it")
        case "fails":
            raise ZeroDivisionError("it fails")
        case "kills":
            os._exit(9)
        case "full":
            raise OSError(errno.ENOSPC, "No space left on device")
        case "holds":  # compiled code that keeps the interpreter to itself
            o.file.with_suffix(".begun").touch()
            ctypes.PyDLL(None).sleep(60)
        case "warns":
            reserve(f"rms {number:g} mm, {2.0 * number:g} mm at most")
        case "contradicts":
            judge(GoodnessOfFit((Doubt("force: a line describes it better", True),), ("force",)))
        case "slow":
            time.sleep(0.3)
        case "hungry":
            taken = []
            for _ in range(60):  # 3 GB in 3 s, unless the process is ended
                taken.append(np.ones(50_000_000 // 8))
                time.sleep(0.05)
    time_ = np.linspace(0.0, 1.0, 5 + int(number))
    say(f"{number:g}")
    table = pd.DataFrame(
        {
            "time [s]": time_,
            "force [N]": number * o.gain * np.sin(time_),
            "side": np.where(time_ < 0.5, "left", "right"),
        }
    )
    return QuickResult(table_=table)


quick = Job("quick", QuickOptions, read, run)


def study(folder: Path, numbers: Mapping[str, str], *more: str) -> Path:
    """Description of a study with one file for each subject."""
    for name, text in numbers.items():
        (folder / f"{name}.txt").write_text(text, encoding="utf-8")
    file = folder / "study.toml"
    lines = ['analysis = "tests.study.quick:quick"', 'files = "{subject}.txt"', *more, "[options]", 'file = "{file}"']
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def tables(out: Path) -> dict[str, bytes]:
    """Content of all tables of a study, and of its manifest."""
    files = [*sorted((out / "tables").iterdir()), out / "trials.csv"]
    return {file.name: file.read_bytes() for file in files}


def told(out: Path) -> dict[str, Any]:
    """`run.json`."""
    return json.loads((out / "run.json").read_text(encoding="utf-8"))


def compared(folder: Path) -> Path:
    """Six subjects, two trials of each in two conditions, the second one larger; F's last trial is odd."""
    gains = {"slow": 0, "fast": 2}
    numbers = {
        f"{subject}_{condition}_{trial}": str(20 + k % 3 + more + 40 * (f"{subject}{condition}{trial}" == "Ffast2"))
        for k, subject in enumerate("ABCDEF")
        for condition, more in gains.items()
        for trial in (1, 2)
    }
    file = study(folder, numbers)
    text = file.read_text(encoding="utf-8").replace("{subject}.txt", "{subject}_{condition}_{trial}.txt")
    file.write_text(text, encoding="utf-8")
    return file
