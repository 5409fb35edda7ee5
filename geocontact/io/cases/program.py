"""A simulator on the command line: `simulate = "prog {params} {trial} {out}"` in case.toml.

For each run it is given the paths of three files in a folder of its own: params, a JSON object of numbers by name
(parameters, constants, covariates of the trial, SI); trial, a CSV table of `time [s]` and the inputs; out, where it
writes a CSV table of `time [s]` and the outputs, a row for each row of trial. It is started without a shell, in the
folder from which geocontact was started.
"""

from __future__ import annotations

import json
import shlex
import subprocess
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.simulator import SimulatorError
from geocontact.io.cases.trial_table import read_trial

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
