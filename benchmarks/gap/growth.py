"""How `gap diagnose` grows with the samples of a trial: `nice python -m benchmarks.gap.growth FOLDER`.

Five synthetic trials of the elbow and of the foot with a withheld effect, in which the same movement is recorded at a
higher rate (`finer`) or a movement goes on for longer at the same rate (`longer`). CPU seconds and peak memory are of
the whole command with tables only, in a process of its own on one thread, kernels compiled before. Slopes are those of
straight lines through the logarithms of sizes and of CPU seconds: 1 where all that is done is done for each sample.
Writes results/gap_growth.json, in which runs that were not asked for stay as they were; gap_growth_before.json has
those of commit 4b961edf, which averaged nothing.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from benchmarks.machine import write_results
from benchmarks.robustness.growth_inputs import run
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.systems.catalogue import system_of

KEPT = Path(__file__).resolve().parents[1] / "results" / "gap_growth.json"
SIZES = (600, 2_000, 10_000, 100_000)
TRIALS = ("t01", "t02", "t03", "t04", "t05")
SEED = 61
LOADED = 20.0  # N, below which no centre of pressure is recorded
WAVES = 24  # of an input, at frequencies drawn anew for each: a movement that does not repeat


@dataclass(frozen=True)
class Subject:
    """A base model and how it is recorded.

    Parameters
    ----------
    step
        Time between two samples, of the smallest size, and of all that go on for longer [s].
    inputs
        Middle, size and highest frequency [Hz] of each.
    input_noise
        Standard deviation, in the inputs' units.
    effect, amplitudes
        That is withheld.
    """

    system: str
    step: float
    inputs: Mapping[str, tuple[float, float, float]]
    input_noise: Mapping[str, float]
    units: Mapping[str, str]
    parameters: tuple[Parameter, ...]
    true: Mapping[str, float]
    constants: Mapping[str, float]
    noise: Mapping[str, float]
    effect: str
    amplitudes: Mapping[str, float]

    def tables(self) -> dict[str, pd.DataFrame]:
        """Spheres of the foot."""
        if self.system != "foot":
            return {}
        x = np.linspace(0.0, 0.22, 9)
        zones = [f"z{1 + k // 3}" for k in range(len(x))]
        return {"spheres": pd.DataFrame({"px [m]": x, "py [m]": 0.012, "radius [m]": 0.011, "zone": zones})}

    def case(self, count: int, step: float) -> GapCase:
        """Five trials of so many samples."""
        rng, time = np.random.default_rng(SEED), step * np.arange(count)
        moved = [{name: movement(rng, time, *how) for name, how in self.inputs.items()} for _ in TRIALS]
        silent = {name: np.zeros(count) for name in self.noise}
        blank = self.of([self.trial(time, inputs, silent) for inputs in moved])
        base = system_of(blank).scaled(blank.calibration, self.true)
        model = next(one for one in candidates(base) if one.label == self.effect).apply(base)
        return self.of([self.recorded(rng, model, time, inputs) for inputs in moved])

    def of(self, trials: Sequence[Trial]) -> GapCase:
        """Three trials to fit, two held out."""
        named = tuple(replace(one, name=name) for one, name in zip(trials, TRIALS, strict=True))
        rest = (self.parameters, self.constants, self.noise, self.tables())
        return GapCase(self.system, self.system, named[:3], named[3:], *rest)

    def trial(self, time: Float[np.ndarray, " t"], inputs: Mapping[str, Any], outputs: Mapping[str, Any]) -> Trial:
        """Of these columns."""
        columns = {**inputs, **outputs}
        values = np.column_stack(list(columns.values()))
        return Trial("", Signals(time, values, tuple(columns), tuple(self.units[name] for name in columns)))

    def recorded(self, rng: np.random.Generator, model: System, time: np.ndarray, inputs: Mapping[str, Any]) -> Trial:
        """One trial: stiffnesses vary by 2 %, white noise in all channels; a quotient's grows as 1 over its divisor.

        It is as stated at the median of the forces at which a centre of pressure is recorded.
        """
        own = {name: value * (1.0 + 0.02 * rng.standard_normal()) for name, value in self.true.items()}
        clean = model.simulate(self.trial(time, inputs, {}), {**own, **self.amplitudes})
        columns = dict(zip(model.outputs, clean.T, strict=True))
        under = np.maximum(columns["force_y"], LOADED) if "cop_x" in columns else np.full(len(time), 2.0 * LOADED)
        usual = float(np.median(under[under > LOADED]))
        sizes = {name: self.noise[name] * (usual / under if name == "cop_x" else 1.0) for name in columns}
        noisy = {name: y + sizes[name] * rng.standard_normal(len(time)) for name, y in columns.items()}
        seen = {name: x + self.input_noise[name] * rng.standard_normal(len(time)) for name, x in inputs.items()}
        return self.trial(time, seen, noisy)


def movement(
    rng: np.random.Generator, time: Float[np.ndarray, " t"], middle: float, size: float, highest: float
) -> Float[np.ndarray, " t"]:
    """A band-limited movement with waves of random frequencies; the same at any rate."""
    frequency, phase = rng.uniform(0.1, highest, WAVES), rng.uniform(0.0, 2.0 * np.pi, WAVES)
    found = np.zeros(len(time))
    for f, p in zip(frequency, phase, strict=True):
        found += np.cos(2.0 * np.pi * f * time + p)
    return np.asarray(middle + size * np.sqrt(2.0 / WAVES) * found)


def zones(letter: str, unit: str, start: float, lower: float, upper: float) -> tuple[Parameter, ...]:
    """A parameter of each zone of the sole."""
    return tuple(Parameter(f"{letter}_z{k}", unit, start, lower, upper) for k in (1, 2, 3))


SUBJECTS = {
    "elbow": Subject(
        system="elbow",
        step=0.04,
        inputs={"beta": (1.2, 0.3, 0.45)},
        input_noise={"beta": 0.002},
        units={"beta": "rad", "force": "N"},
        parameters=(
            Parameter("k", "N/m", 300.0, 50.0, 1000.0),
            Parameter("x", "m", 0.03, 0.0, 0.1),
            Parameter("y", "m", 0.04, 0.0, 0.12),
        ),
        true={"k": 260.0, "x": 0.035, "y": 0.05},
        constants={"l_ex": 0.185, "z_ex": 0.09},
        noise={"force": 0.12},
        effect="damping",
        amplitudes={"damping.b": 40.0, "damping.exponent": 1.0},
    ),
    "foot": Subject(
        system="foot",
        step=0.005,
        inputs={"x": (0.0, 0.01, 1.0), "y": (0.003, 0.004, 1.5), "pitch": (0.0, 0.06, 1.5)},
        input_noise={"x": 5e-5, "y": 5e-5, "pitch": 5e-4},
        units={"x": "m", "y": "m", "pitch": "rad", "force_x": "N", "force_y": "N", "cop_x": "m"},
        parameters=(*zones("k", "N/m^n", 8e4, 8e3, 1e6), *zones("b", "N s/m", 200.0, 0.0, 3000.0)),
        true={f"k_z{k}": 8e4 + 1e4 * k for k in (1, 2, 3)} | {f"b_z{k}": 250.0 for k in (1, 2, 3)},
        constants={"n": 1.2, "delta_full": 0.002, "mu_s": 0.9, "mu_k": 0.7, "v_th": 0.25},
        noise={"force_x": 3.0, "force_y": 6.0, "cop_x": 0.001},
        effect="series_compliance",
        amplitudes={"series_compliance.compliance": 3e-6, "series_compliance.exponent": 1.0},
    ),
}
GROWTHS = ("finer", "longer")


@dataclass(frozen=True)
class Grown:
    """One command on five trials of `n` samples, and what it answered."""

    system: str
    growth: str
    n: int
    cpu_s: float
    peak_mb: float
    verdict: str
    effects: tuple[str, ...]


def measured(system: str, growth: str, n: int, folder: Path) -> Grown:
    """One run, in a process of its own."""
    subject = SUBJECTS[system]
    step = subject.step * SIZES[0] / n if growth == "finer" else subject.step
    write_gap_case(subject.case(n, step), folder / "case")
    cpu, peak = run(folder, ["gap", "diagnose", "case", "--out", "out", "--bare"])
    said = json.loads((folder / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    return Grown(system, growth, n, round(cpu, 2), round(peak, 1), said["verdict"], tuple(said["effects"]))


def table(runs: Sequence[Grown]) -> list[dict[str, object]]:
    """For each system and growth: its runs, and the slope of CPU time."""
    found: list[dict[str, object]] = []
    for system, growth in dict.fromkeys((one.system, one.growth) for one in runs):
        own = sorted((one for one in runs if (one.system, one.growth) == (system, growth)), key=lambda one: one.n)
        sizes, seconds = (np.log([getattr(one, key) for one in own]) for key in ("n", "cpu_s"))
        slopes = {"cpu_slope": float(np.polyfit(sizes, seconds, 1)[0])} if len(own) > 1 else {}
        found.append({"system": system, "growth": growth, "runs": [asdict(one) for one in own]} | slopes)
    return found


def main() -> None:
    """Run all, or what is named, and keep the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--systems", nargs="+", default=list(SUBJECTS), choices=list(SUBJECTS))
    parser.add_argument("--growths", nargs="+", default=list(GROWTHS), choices=GROWTHS)
    parser.add_argument("--sizes", nargs="+", type=int, default=list(SIZES))
    parser.add_argument("--kept", type=Path, default=KEPT, help="the file of results, gap_growth.json")
    given = parser.parse_args()
    runs: list[Grown] = []
    for system in given.systems:
        for growth in given.growths:
            for n in given.sizes:
                runs.append(measured(system, growth, n, given.folder.resolve() / f"{system}_{growth}_{n}"))
                print(json.dumps(asdict(runs[-1])), flush=True)
    kept = json.loads(given.kept.read_text(encoding="utf-8"))["figures"] if given.kept.exists() else []
    asked = {(one.system, one.growth, one.n) for one in runs}
    others = [Grown(**run) for each in kept for run in each["runs"]]
    others = [one for one in others if (one.system, one.growth, one.n) not in asked]
    packages = frozenset({"numpy", "scipy", "numba", "pandas"})
    print(write_results(given.kept.stem, {"seed": SEED}, table([*others, *runs]), packages))


if __name__ == "__main__":
    sys.exit(main())
