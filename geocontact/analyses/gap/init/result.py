r"""A gap case begun: `geocontact gap init`, `gc.init_gap_case`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> from pathlib import Path
>>> _ = Path("strut.py").write_text('def run(time, inputs, numbers):\n    return numbers["k"] * inputs[0]\n')
>>> Path("recordings").mkdir()
>>> time = 0.02 * np.arange(100)
>>> for k in range(1, 5):
...     angle = 10.0 * np.sin(2.0 * k * time)
...     trial = pd.DataFrame({"time [s]": time, "angle [deg]": angle, "torque [N m]": 1.5 * angle})
...     trial.to_csv(f"recordings/t{k}.csv", index=False)
>>> result = gc.init_gap_case(simulator="strut.py", data="recordings", number={"k": 80.0})
>>> print(result.sentences[0])
run of strut.py was called on 4 trials: angle [rad] → torque [N m]
>>> f"{result.errors['t1']['torque']:.2f} N m"
'0.68 N m'
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Part, Result
from geocontact.analyses.gap.init.adapter import function_adapter
from geocontact.analyses.gap.init.first_run import FirstRun, errors_of, first_run, unit_ratio
from geocontact.analyses.gap.init.options import InitOptions
from geocontact.analyses.gap.init.settings import NOISE_ASKED, NUMBERS_ASKED, settings_text
from geocontact.analyses.gap.init.show import init_page
from geocontact.analyses.gap.init.simulator import FoundSimulator, found_simulator
from geocontact.analyses.gap.init.starts import require_trial_numbers, shared_numbers, trial_numbers
from geocontact.chain.system import System
from geocontact.data.errors import InputError
from geocontact.data.gap_case import LISTED_SYSTEMS, GapCase
from geocontact.data.text import same_place
from geocontact.data.trial import Trial
from geocontact.io.cases.case_settings import SETTINGS, CaseSettings
from geocontact.io.cases.gap_case_writer import trial_table, write_tables
from geocontact.io.cases.trial_table import alike, read_trial
from geocontact.io.text.results import CASES
from geocontact.io.text.side_table import read_side_table

if TYPE_CHECKING:
    from geocontact.view.page.content import Page

FEW = 4
"""Trials from which on two are held out."""
FIRST_RUN = "first_run"
_NO_TABLES = {*CaseSettings.model_fields, FIRST_RUN}
"""Other keys of case.toml and another file of its folder."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class InitResult(Result):
    """A case that is begun; `write` makes the folder that is to be completed.

    Parameters
    ----------
    case
        Trials, SI units, a third of them held out.
    found
        The simulator.
    run
        What its first calls gave.
    questions
        What only the user knows, in words.
    """

    options: InitOptions
    case: GapCase
    found: FoundSimulator
    run: FirstRun
    questions: tuple[str, ...]

    @property
    def title(self) -> str:
        """Which simulator."""
        return f"A gap case of {self.found.words}"

    @property
    def parts(self) -> frozenset[Part]:
        """The page and its numbers."""
        return frozenset(("tables", "pages"))

    def units(self, table: str) -> Mapping[str, str]:
        """SI, as in the case."""
        return CASES

    @property
    def system(self) -> System:
        """The base model at its start values."""
        return self.run.system

    @property
    def time(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Time of the rows of each trial [s]."""
        return {one.name: one.time for one in (*self.case.calibration, *self.case.evaluation)}

    @property
    def errors(self) -> dict[str, dict[str, float]]:
        """Root mean square of measured minus simulated by trial and channel [SI unit of the channel]."""
        return errors_of(self.case, self.system.outputs, self.run.simulated)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`first_run`: measured and simulated at the start values; `trials/<id>`: every trial."""
        trials = (*self.case.calibration, *self.case.evaluation)
        return {FIRST_RUN: self._first_run(trials)} | {f"trials/{one.name}": trial_table(one) for one in trials}

    def _first_run(self, trials: tuple[Trial, ...]) -> pd.DataFrame:
        parts = []
        for one in trials:
            columns = {"trial": one.name, "time [s]": one.time}
            for c, name in enumerate(self.system.outputs):
                unit = one.signals.units[one.signals.channels.index(name)]
                columns[f"{name} measured [{unit}]"] = one.column(name)
                columns[f"{name} simulated [{unit}]"] = self.run.simulated[one.name][:, c]
            parts.append(pd.DataFrame(columns))
        return pd.concat(parts, ignore_index=True)

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Measured beside simulated, and the questions."""
        return {REPORT: init_page(self.title, self.case, self.run, self.questions, self.errors)}

    def write_files(self, folder: Path) -> None:
        """Also case.toml, tables and the adapter."""
        super().write_files(folder)
        text = settings_text(self.case, self.found, self.run, self.questions)
        (folder / SETTINGS).write_text(text, encoding="utf-8", newline="\n")
        write_tables(self.case, folder)
        name, module = self.found.adapter
        if name:
            (folder / name).write_text(module, encoding="utf-8", newline="\n")


def read(o: InitOptions) -> GapCase:
    """The trials of a folder as a case without a base model."""
    files = sorted(each for each in o.data.glob("*.csv") if each.is_file())
    own = trial_numbers(o.number, [each.stem for each in files])
    if len(files) < 3:
        what = f"holds {len(files)} .csv files"
        raise InputError(o.data, "", what, "give a file per trial: two to fit to and two held out at least")
    if twice := same_place(each.stem for each in files):
        what = f"two trials are called {twice}, in small and in capital letters"
        raise InputError(o.data, "", what, "rename one: on Windows and macOS both would be one file")
    tables = alike({each.stem: read_trial(each) for each in files})
    for each in files:
        add_input("trial", each)
    trials = tuple(Trial(name, table.signals, own.get(name, {}), {}) for name, table in tables.items())
    held = trials[2::3] if len(trials) >= FEW + 2 else trials[-min(2, len(trials) // 2) :]
    fitted = tuple(one for one in trials if one not in held)
    return GapCase(o.data.resolve().name, "", fitted, tuple(held), (), {}, {}, _tables(o.table))


def _tables(given: Sequence[str]) -> dict[str, pd.DataFrame]:
    """Tables of "name=file", SI units."""
    found = {}
    for each in given:
        name, equals, path = each.partition("=")
        if not (name.isidentifier() and equals and path) or name in _NO_TABLES:
            raise InputError("", "`table`", f"is {each!r}", "write name and file of a table: spheres=spheres.csv")
        if name in found:
            raise InputError("", "`table`", f"names {name} twice", "give one file")
        found[name] = read_side_table(Path(path))
        add_input("table", Path(path))
    return found


def run(case: GapCase, o: InitOptions) -> InitResult:
    """The simulator called on every trial, and what remains to be asked."""
    signals = case.calibration[0].signals
    units = dict(zip(signals.channels, signals.units, strict=True))
    found = found_simulator(o, units, case)
    _require_channels(found, units, o)
    shared = shared_numbers(o.number, case)
    require_trial_numbers(case, {*shared, *(p.name for p in found.declared)})
    first = first_run(found, case, shared, o.simulator)
    found = _with_memory(found, first, units)
    questions = (*found.questions, *_asked(case, found, first))
    sides = [", ".join(f"{n} [{units[n]}]" for n in names) for names in (first.system.inputs, first.system.outputs)]
    count = len(case.calibration) + len(case.evaluation)
    say(f"{found.words} was called on {count} trials: {sides[0]} → {sides[1]}")
    many = "about 3000, of a model with memory ten times as many"
    say(f"one call takes less than {first.seconds:g} s; a diagnosis makes {many}")
    for question in questions:
        say(f"open: {question}")
    if found.adapter[0]:
        say(f"keep {found.adapter[0]} where geocontact is started, not in the folder of the case")
    return InitResult(options=o, case=case, found=found, run=first, questions=questions)


def _require_channels(found: FoundSimulator, units: Mapping[str, str], o: InitOptions) -> None:
    """Every channel of the simulator is a column of the trials."""
    lacking = [name for name in (*found.base.inputs, *found.base.outputs) if name not in units]
    if lacking:
        what = f"needs {', '.join(lacking)}, which the trials lack"
        raise InputError(o.simulator, "", what, f"they have {', '.join(units)}; rename columns or channels")


def _with_memory(found: FoundSimulator, first: FirstRun, units: Mapping[str, str]) -> FoundSimulator:
    """The adapter as the first call showed it must be; a reservation where the model itself says otherwise."""
    if not first.spreads or first.system.dynamic or found.system in LISTED_SYSTEMS:
        return found
    name, _ = found.adapter
    if not name:
        what = "a change of one input sample changes outputs at other samples"
        reserve(f"{what}; declare the base model with dynamic=True, otherwise false alarms are frequent")
        return found
    module, function = name.removesuffix("_adapter.py"), found.words.partition(" ")[0]
    inputs, outputs = ({n: units[n] for n in names} for names in (found.base.inputs, found.base.outputs))
    acts_on = first.system.geometry.yields
    return replace(found, adapter=(name, function_adapter(module, function, inputs, outputs, acts_on, dynamic=True)))


def _asked(case: GapCase, found: FoundSimulator, first: FirstRun) -> list[str]:
    """What the data and the first call leave open."""
    asked = []
    declared = {p.name for p in found.declared}
    if names := [p.name for p in first.system.parameters if p.name not in declared]:
        asked.append(f"{NUMBERS_ASKED}{', '.join(names)}; fixed = true for what is known exactly")
    asked.append(
        f"{NOISE_ASKED}{', '.join(first.system.outputs)}: standard deviation of each sensor; else it is estimated"
    )
    if silent := [name for name in first.silent if name not in first.system.spare]:
        asked.append(f"{', '.join(silent)} changed no output where it was moved: is it the right column?")
    trials = (*case.calibration, *case.evaluation)
    if len(trials) < FEW:
        asked.append(f"{len(trials)} trials; can you record {FEW} or more? Two to fit to and two held out")
    if not first.unknown:
        for c, name in enumerate(first.system.outputs):
            both = [np.concatenate(each) for each in zip(*_curves(trials, name, c, first), strict=True)]
            if ratio := unit_ratio(both[0], both[1]):
                asked.append(f"simulated {name} is {ratio} as large as measured: is a unit mixed up?")
    return asked


def _curves(trials: tuple[Trial, ...], name: str, column: int, first: FirstRun) -> list[tuple[np.ndarray, np.ndarray]]:
    return [(one.column(name), first.simulated[one.name][:, column]) for one in trials]


init_gap_case = Job("gap init", InitOptions, read, run)
