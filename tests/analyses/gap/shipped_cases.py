"""Short synthetic cases of models of the package, as one would write them by hand: what a guide should arrive at."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.systems.catalogue import SYSTEMS, system_of

ROWS = 60
Motions = Callable[[np.ndarray, int], dict[str, np.ndarray]]


def sole(time: np.ndarray, k: int) -> dict[str, np.ndarray]:
    """A foot that rolls over its sole."""
    phase = time / time[-1]
    return {
        "x": 0.01 * phase,
        "y": -0.004 - 1e-3 * np.sin(3 * phase + k),
        "pitch": 0.03 * (1.0 - 2.0 * phase) + 5e-3 * k,
    }


def arm(time: np.ndarray, k: int) -> dict[str, np.ndarray]:
    """A raised arm, without a tool."""
    return {"arm": 0.8 + 0.3 * np.sin((2 + 0.4 * k) * time), "event": np.zeros_like(time)}


def strap(time: np.ndarray, k: int) -> dict[str, np.ndarray]:
    """A thigh under a cuff."""
    motions = {"normal": 0.01 + 5e-3 * np.sin((3 + k) * time), "tangential": 1e-3 * time}
    return {f"thigh_{name}": way for name, way in (motions | {"rotation": 0.1 * np.cos((2 + k) * time)}).items()}


SPHERES = pd.DataFrame(
    {"px [m]": [-0.03, 0.1], "py [m]": [0.02, 0.02], "radius [m]": [0.02, 0.02], "zone": ["heel", "toe"]}
)
SUPPORT = pd.DataFrame({"angle [rad]": [0.0, 0.8, 1.6], "torque [N m]": [0.0, 3.8, 5.1]})
MODELS: dict[str, tuple[Motions, dict[str, float], tuple[Parameter, ...], dict[str, pd.DataFrame]]] = {
    "foot": (
        sole,
        {"n": 1.5, "delta_full": 2e-3, "mu_s": 0.8, "mu_k": 0.6, "v_th": 0.25},
        (
            *(Parameter(f"k_{zone}", "N/m^n", 5e5, 5e4, 5e6) for zone in ("heel", "toe")),
            *(Parameter(f"b_{zone}", "N s/m", 200.0, 0.0, 3e3) for zone in ("heel", "toe")),
        ),
        {"spheres": SPHERES},
    ),
    "shoulder": (
        arm,
        {"L_h": 0.27, "o_x": -8e-3, "o_y": 7e-3, "I": 0.11, "c": 0.19, "l_c": 0.16},
        (
            Parameter("m", "kg", 2.0, 0.3, 5.0),
            Parameter("k_t", "N/m", 700.0, 100.0, 5000.0),
            Parameter("b_t", "N s/m", 20.0, 0.0, 100.0),
        ),
        {"support": SUPPORT},
    ),
    "sit_to_stand": (
        strap,
        {"b": 30.0},
        (Parameter("k_n_thigh", "N/m", 3000.0, 300.0, 3e4), Parameter("rho_thigh", "m", 0.02, -0.1, 0.1)),
        {},
    ),
}


def written(name: str, folder: Path) -> GapCase:
    """A case of four trials whose outputs are the model's, 1.2 times as large."""
    motions, constants, parameters, tables = MODELS[name]
    base = next(each for each in SYSTEMS if each.name == name)
    assert base.needs is not None
    time, units = 0.02 * np.arange(ROWS), base.needs.units
    trials = []
    for k in (1, 2, 3, 4):
        inputs = motions(time, k)
        own = [each for each in base.outputs if len(inputs) != 3 or name == "foot" or each.startswith("thigh")]
        values = np.column_stack([*inputs.values(), np.zeros((ROWS, len(own)))])
        channels = (*inputs, *own)
        signals = Signals(time, values, channels, tuple(units[each] for each in channels))
        trials.append(Trial(f"t{k}", signals, {"level": 0.5 + 0.1 * k} if name == "shoulder" else {}, {}))
    case = GapCase(name, name, tuple(trials[:2]), tuple(trials[2:]), parameters, constants, {}, tables)
    system = system_of(case)
    filled = []
    for trial in trials:
        measured = trial.signals.values.copy()  # noqa: PD011 no table
        measured[:, -len(system.outputs) :] = 1.2 * system.simulate(trial, system.start)
        filled.append(replace(trial, signals=replace(trial.signals, values=measured)))
    case = replace(case, calibration=tuple(filled[:2]), evaluation=tuple(filled[2:]))
    write_gap_case(case, folder)
    return case
