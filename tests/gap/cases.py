"""Small synthetic elbow cases, made with the package's own model plus noise, jitter and noise of the input."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy.signal import butter, filtfilt

from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.systems.catalogue import system_of

TRUE = {"k": 260.0, "x": 0.035, "y": 0.05}
PARAMETERS = (
    Parameter("k", "N/m", 300.0, 50.0, 1000.0),
    Parameter("x", "m", 0.03, 0.0, 0.1),
    Parameter("y", "m", 0.04, 0.0, 0.12),
)
NOISE = 0.12  # N
STEP = 0.04  # s
Change = Callable[[str, np.ndarray, np.ndarray], np.ndarray]


def elbow_case(
    effect: str = "",
    values: Mapping[str, float] | None = None,
    seed: int = 0,
    duration: float = 16.0,
    change: Change | None = None,
) -> GapCase:
    """Three calibration trials and two held out; `change` alters (trial, time, force) before it is recorded."""
    rng = np.random.default_rng(seed)
    names = ("t01", "t02", "t03", "t04", "t05")
    motions = {name: _motion(rng, duration) for name in names}
    empty = GapCase("case", "elbow", *_split(motions, {}), PARAMETERS, {"l_ex": 0.185, "z_ex": 0.09}, {"force": NOISE})
    system = system_of(empty).scaled(_trials(motions, {}), TRUE)
    model = _with(system, effect)
    forces = {}
    for name in names:
        own = {"k": TRUE["k"] * (1.0 + 0.02 * rng.standard_normal())}
        own |= {axis: TRUE[axis] + 5e-4 * rng.standard_normal() for axis in ("x", "y")}
        clean = model.simulate(_trial(name, motions[name], None), {**own, **(values or {})})[:, 0]
        time = STEP * np.arange(len(clean))
        clean = change(name, time, clean) if change else clean
        forces[name] = clean + NOISE * rng.standard_normal(len(clean))
    measured = {name: beta + _smooth(rng, len(beta), 0.002) for name, beta in motions.items()}
    calibration, evaluation = _split(measured, forces)
    return GapCase("case", "elbow", calibration, evaluation, PARAMETERS, empty.constants, {"force": NOISE})


def _with(system: System, effect: str) -> System:
    return next(one for one in candidates(system) if one.label == effect).apply(system) if effect else system


def _motion(rng: np.random.Generator, duration: float) -> np.ndarray:
    time = np.arange(0.0, duration, STEP)
    waves = sum(
        rng.uniform(0.5, 1.0) * np.sin(2.0 * np.pi * f * time + rng.uniform(0.0, 6.28)) for f in (0.1, 0.23, 0.41)
    )
    return 1.2 + 0.6 * waves / np.abs(waves).max()


def _smooth(rng: np.random.Generator, count: int, sd: float) -> np.ndarray:
    noise = filtfilt(*butter(2, 6.0, fs=1.0 / STEP), rng.standard_normal(count + 100))[50:-50]
    return sd * noise / noise.std()


def _trial(name: str, beta: np.ndarray, force: np.ndarray | None) -> Trial:
    time = STEP * np.arange(len(beta))
    columns = np.column_stack([beta, np.zeros(len(beta)) if force is None else force])
    return Trial(name, Signals(time, columns, ("beta", "force"), ("rad", "N")))


def _trials(motions: Mapping[str, np.ndarray], forces: Mapping[str, np.ndarray]) -> tuple[Trial, ...]:
    return tuple(_trial(name, beta, forces.get(name)) for name, beta in motions.items())


def _split(
    motions: Mapping[str, np.ndarray], forces: Mapping[str, np.ndarray]
) -> tuple[tuple[Trial, ...], tuple[Trial, ...]]:
    trials = _trials(motions, forces)
    return trials[:3], trials[3:]
