"""A gap case: the folder with case.toml, trials and tables, to SI units.

For each run it is given the paths of three files in a folder of its own: params, a JSON object of numbers by name
(parameters, constants, covariates of the trial, SI); trial, a CSV table of `time [s]` and the inputs; out, where it
writes a CSV table of `time [s]` and the outputs, a row for each row of trial. It is started without a shell, in the
folder from which geocontact was started.
"""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import warnings
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.gap_case import CaseMesh, GapCase
from geocontact.data.parameter import Parameter
from geocontact.data.simulator import SimulatorError
from geocontact.data.trial import Trial
from geocontact.io.cases.case_settings import (
    KNOWN_SYSTEMS,
    SETTINGS,
    CaseSettings,
    case_folder,
    check_settings,
    check_trial_files,
    inside,
    parameters_of,
    read_settings,
    trial_file,
)
from geocontact.io.cases.trial_table import TrialTable, alike, noise_in_si, read_cells, read_trial
from geocontact.io.mesh.meshes import READERS, read_mesh
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.units import LENGTH

PLACES = ("{params}", "{trial}", "{out}")
TIMEOUT = 120.0
"""Seconds for one run."""
KEPT = 50_000_000
"""Bytes of results that are remembered: what an effect does to inputs or outputs asks for the same run again."""
SAME_TIME = 1e-6
"""Relative to the duration, that times of outputs may be rounded by."""


@dataclass(eq=False)
class Program:
    """A program that simulates one trial per run; results are remembered."""

    command: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    units: Mapping[str, str]
    runs: int = 0
    _known: OrderedDict[tuple[bytes, ...], Float[np.ndarray, "t c"]] = field(default_factory=OrderedDict, repr=False)

    def run(
        self, time: Float[np.ndarray, " t"], inputs: Float[np.ndarray, "i t"], numbers: Mapping[str, float]
    ) -> Float[np.ndarray, "t c"]:
        """Outputs at the times of the inputs; SimulatorError where there are none."""
        told = json.dumps({name: float(numbers[name]) for name in sorted(numbers)})
        key = (told.encode(), time.tobytes(), inputs.tobytes())
        if key in self._known:
            self._known.move_to_end(key)
            return self._known[key].copy()
        found = self._run(time, inputs, told)
        self.runs += 1
        self._known[key] = found
        while len(self._known) > 1 and len(self._known) * found.nbytes > KEPT:
            self._known.popitem(last=False)
        return found.copy()

    def _run(self, time: Float[np.ndarray, " t"], inputs: Float[np.ndarray, "i t"], told: str) -> np.ndarray:
        with TemporaryDirectory(prefix="geocontact-") as folder:
            params, trial, out = (Path(folder) / name for name in ("params.json", "trial.csv", "out.csv"))
            params.write_text(told + "\n", encoding="utf-8")
            header = ",".join(["time [s]", *(f"{name} [{self.units[name]}]" for name in self.inputs)])
            np.savetxt(trial, np.vstack([time, inputs]).T, "%.17g", ",", header=header, comments="", encoding="utf-8")
            paths = dict(zip(PLACES, map(str, (params, trial, out)), strict=True))
            self._call([_filled(word, paths) for word in self.command])
            return self._read(out, time)

    def _call(self, words: list[str]) -> None:
        try:
            done = subprocess.run(words, capture_output=True, timeout=TIMEOUT, check=False, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            raise SimulatorError(f"{words[0]} took more than {TIMEOUT:g} s") from None
        except OSError as error:
            raise SimulatorError(f"{words[0]} cannot be started: {error.strerror or error}") from error
        if done.returncode:
            lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
            said = f": {lines[-1]}" if lines else ""
            raise SimulatorError(f"{words[0]} ended with code {done.returncode}{said}")

    def _read(self, out: Path, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t c"]:
        if not out.is_file():
            raise SimulatorError(f"{self.command[0]} wrote no {{out}}")
        try:
            table = read_trial(out)
        except InputError as error:
            raise SimulatorError(f"its output cannot be used: {error}") from error
        for name in self.outputs:
            if name not in table.signals.channels:
                raise SimulatorError(f"its output has no column {name}")
            unit = table.column(name).si
            if unit != self.units[name]:
                raise SimulatorError(f"its output has {name} in {unit}, the trials in {self.units[name]}")
        theirs = table.signals.time
        if len(theirs) != len(time) or np.abs(theirs - time).max() > SAME_TIME * (time[-1] - time[0]):
            raise SimulatorError(f"its output has {len(theirs)} rows or other times than the {len(time)} of the trial")
        return np.column_stack([table.signals.column(name) for name in self.outputs])


def program(command: str, inputs: tuple[str, ...], outputs: tuple[str, ...], units: Mapping[str, str]) -> Program:
    """Simulator from what case.toml says; ValueError when the command lacks one of its three places."""
    words = tuple(shlex.split(command))
    for place in PLACES:
        if not any(place in word for word in words):
            raise ValueError(f'has no {place}; write for example "my_simulator {" ".join(PLACES)}"')
    return Program(words, inputs, outputs, dict(units))


def _filled(word: str, paths: Mapping[str, str]) -> str:
    for place, path in paths.items():
        word = word.replace(place, path)
    return word


def gap_case_folders(folder: str | PathLike[str]) -> list[Path]:
    """Every sub-folder that holds a case.toml, by name; InputError when there is none."""
    home = case_folder(folder)
    try:
        found = sorted(entry for entry in home.iterdir() if (entry / SETTINGS).is_file())
    except OSError as error:
        raise InputError(folder, "", f"cannot be read: {error.strerror or error}", "check its permissions") from error
    if not found:
        remedy = "it is a case itself" if (home / SETTINGS).is_file() else "name the folder that holds the cases"
        raise InputError(folder, "", f"no sub-folder has a {SETTINGS}", remedy)
    return found


def read_gap_case(
    folder: str | PathLike[str], known_systems: tuple[str, ...] = KNOWN_SYSTEMS, run_programs: bool = False
) -> GapCase:
    r"""Case in a folder, in SI units.

    Channels of all trials come in the order of the first calibration trial. Noise is converted like its channel, tables
    like their headers say; parameters, constants and covariates are in SI units already. Trial files that case.toml
    does not list are warned of, and trials without the cells of a site.

    Parameters
    ----------
    folder
        Holds case.toml, trials/<id>.csv and the tables that case.toml names.
    known_systems
        Names that `system` may have besides "package.module:OBJECT".
    run_programs
        Whether a program that the case names as its simulator may be run: a case may come from somebody else.

    Raises
    ------
    InputError
        A file is not there or damaged, a key is not known, or trials do not agree in their channels.

    Examples
    --------
    >>> import geocontact as gc, numpy as np, pandas as pd
    >>> from pathlib import Path
    >>> Path("case/trials").mkdir(parents=True)
    >>> time, noise = 0.04 * np.arange(160), np.random.default_rng(3)
    >>> for k in range(1, 6):
    ...     angle = 0.3 * np.sin((2.0 + 0.4 * k) * time) + 0.08 * np.sin((5.0 + k) * time)
    ...     torque = 60.0 * angle + 3.0 * np.gradient(angle, time) + noise.normal(0.0, 0.2, 160)
    ...     trial = pd.DataFrame({"time [s]": time, "angle [rad]": angle, "torque [N m]": torque})
    ...     trial.to_csv(f"case/trials/t{k}.csv", index=False)
    >>> text = 'format = 1\nsystem = "geocontact.systems.elastic_joint:JOINT"\n'
    >>> text += 'calibration = ["t1", "t2", "t3"]\nevaluation = ["t4", "t5"]\n[noise]\ntorque = 0.2\n'
    >>> text += '[parameters.k]\nstart = 50.0\nlower = 10.0\nupper = 200.0\nunit = "N m/rad"\n'
    >>> _ = Path("case/case.toml").write_text(text)
    >>> case = gc.read_gap_case("case")
    >>> case.system, [trial.name for trial in case.calibration]
    ('geocontact.systems.elastic_joint:JOINT', ['t1', 't2', 't3'])
    """
    home = case_folder(folder)
    file = home / SETTINGS
    settings = read_settings(file)
    check_settings(settings, file, known_systems)
    parameters = parameters_of(settings, file)
    check_trial_files(home, settings)
    tables = {key: read_side_table(inside(home, name, key)) for key, name in settings.tables.items()}
    trials = alike({name: read_trial(trial_file(home, name)) for name in settings.trials})
    cells = read_cells(home, settings, next(iter(trials.values())).signals.channels)
    name = Path(os.path.abspath(home)).name
    simulator = _simulator(settings, file, next(iter(trials.values())), run_programs)
    case = case_of(settings, parameters, file, name, trials, tables)
    return replace(case, meshes=_meshes(home, settings), cells=cells, simulator=simulator)


def case_of(
    settings: CaseSettings,
    parameters: tuple[Parameter, ...],
    file: Path,
    name: str,
    trials: Mapping[str, TrialTable],
    tables: Mapping[str, pd.DataFrame],
) -> GapCase:
    """Case of that name without meshes and cells: settings that `file` holds, trials that are alike, and tables."""
    return GapCase(
        name=name,
        system=settings.system,
        calibration=tuple(_trial(each, trials[each], settings) for each in settings.calibration),
        evaluation=tuple(_trial(each, trials[each], settings) for each in settings.evaluation),
        parameters=parameters,
        constants=dict(settings.constants),
        noise=noise_in_si(_stated_noise(settings.noise, file), trials, file),
        tables=tables,
    )


def _trial(name: str, table: TrialTable, settings: CaseSettings) -> Trial:
    known = settings.trial.get(name, {})
    covariates = {key: value for key, value in known.items() if isinstance(value, float)}
    labels = {key: value for key, value in known.items() if isinstance(value, str)}
    return Trial(name, table.signals, covariates, labels)


def _stated_noise(noise: dict[str, float], file: Path) -> dict[str, float]:
    """Noise that says something: a standard deviation of 0 is left out with a warning."""
    for channel, sd in noise.items():
        if sd == 0.0:
            message = f"{file} [noise] {channel}: is 0; taken as not known"
            warnings.warn(InputWarning(message), stacklevel=3)
    return {channel: sd for channel, sd in noise.items() if sd > 0.0}


def _simulator(settings: CaseSettings, file: Path, trial: TrialTable, allowed: bool) -> Program | None:
    """The program that simulates the case, None where one of our models does."""
    if not settings.simulate:
        return None
    if not allowed:
        what = f"would run {settings.simulate[:80]!r}; a case runs a program only on request"
        raise InputError(file, "simulate", what, "pass `run_simulator` if you trust it")
    units = dict(zip(trial.signals.channels, trial.signals.units, strict=True))
    channels = (*settings.inputs, *settings.outputs)
    if missing := [name for name in channels if name not in units]:
        remedy = f"channels are {', '.join(trial.signals.channels)}"
        raise InputError(trial.file, "line 1", f"no column '{missing[0]}', which case.toml names", remedy)
    try:
        return program(settings.simulate, settings.inputs, settings.outputs, {name: units[name] for name in channels})
    except ValueError as error:
        raise InputError(file, "simulate", str(error), "the program gets the paths of three files") from error


def _meshes(home: Path, settings: CaseSettings) -> dict[str, CaseMesh]:
    found = {}
    for name, given in settings.mesh.items():
        path = inside(home, given.file, f"[mesh.{name}] file", tuple(READERS))
        found[name] = CaseMesh(read_mesh(path, given.unit), given.region, LENGTH[given.unit])
    return found
