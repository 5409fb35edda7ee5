"""Plans of `geocontact gap gather`: mats on a thigh, a force plate under a foot, areas and forces of a knee."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs import foot
from benchmarks.same_outputs.inputs.gap import constants, parameter, settings
from benchmarks.same_outputs.inputs.text import storage, table, written

TRIALS = ("t01", "t02", "t03", "t04")
MAT = "../../../mat_plain/out"
"""Results of the run `mat_plain`, as seen from the plan."""


def make(home: Path, meshes: Path) -> None:
    """A folder for each kind."""
    mats(home / "mats", meshes / "mat_thigh_16x8" / "truth.csv")
    plates(home / "foot")
    knee(home / "knee")


def later(k: int, columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """A trial that begins `k` samples later: the same samples twice are refused as a copy."""
    return {name: values[k:] for name, values in columns.items()}


def mats(home: Path, truth: Path) -> None:
    """Displacements that the recorded force suits, but for a strap and what differs from trial to trial."""
    values = np.array([line.split(",")[::7][:2] for line in truth.read_text("utf-8").splitlines()[4:]], float)
    time, force = values.T
    for k, name in enumerate(TRIALS):
        rng = np.random.default_rng([15, k])
        normal = (force - 4.0) / (5000.0 + 100.0 * k) + 2e-5 * rng.standard_normal(len(time))
        wave = np.sin(2.0 * time + k)
        columns = {
            "thigh_normal [m]": normal,
            "thigh_tangential [m]": 0.003 * wave,
            "thigh_rotation [rad]": 0.08 * wave,
        }
        table(home / f"{name}.csv", later(k, {"time [s]": time, **columns}))
    sources = [f'[from.{name}]\ninputs = "{name}.csv"\nthigh = "{MAT}"' for name in TRIALS]
    more = ("[noise]\nthigh_force = 0.5", constants({"b": 80.0, "rho_thigh": 0.02}))
    free = parameter("k_n_thigh", 5000.0, 1500.0, 25000.0, "N/m")
    written(home / "plan.toml", settings("sit_to_stand", TRIALS, 2, *more, free, *sources))


def plates(home: Path) -> None:
    """A foot on a belt that runs backwards, and the reactions of two plates."""
    foot.spheres(home / "spheres.csv")
    foot.plate(home / "grf.mot")
    for k, name in enumerate(TRIALS):
        x, y, pitch = foot.motion(foot.TIME, 0.004 + 0.0005 * k)
        columns = {"x [m]": x - 1.2 * foot.TIME, "y [m]": y, "pitch [rad]": pitch}
        table(home / f"{name}.csv", later(k, {"time [s]": foot.TIME, **columns}))
    source = 'plates = "grf.mot"\nplate = "ground_force_r"\nbelt = 1.2'
    sources = [f'[from.{name}]\ninputs = "{name}.csv"\n{source}' for name in TRIALS]
    numbers = {"n": 1.2, "delta_full": 0.002, "mu_s": 0.9, "mu_k": 0.7, "v_th": 0.25}
    free = [parameter(f"k_z{i}", 8e4, 8e3, 1e6, "N/m^n") for i in (1, 2, 3)]
    free += [parameter(f"b_z{i}", 100.0, 0.0, 3000.0, "N s/m") for i in (1, 2, 3)]
    more = ('spheres = "spheres.csv"', constants(numbers), *free, *sources)
    written(home / "plan.toml", settings("foot", TRIALS, 2, *more))


def knee(home: Path) -> None:
    """Areas at two thresholds [mm^2] and forces of both sides in pounds."""
    frames, levels = np.linspace(0.9, 1.9, 41), np.array([1.0, 2.0])
    time, level = np.repeat(frames, 2), np.tile(levels, 41)
    swell = level * (1.0 + 0.3 * np.sin(5.0 * time))
    columns = {"time [s]": time, "threshold [mm]": level, "area_fixed [mm^2]": 100.0 * swell}
    columns |= {"area_fixed_medial [mm^2]": 60.0 * swell, "area_fixed_lateral [mm^2]": 40.0 * swell}
    table(home / "area.csv", columns)
    clock = np.linspace(0.95, 1.7, 91)
    storage(home / "forces.mot", {"time": clock, "medial": 100.0 * clock, "lateral": 50.0 * clock})
    clock = np.linspace(1.0, 1.8, 81)
    for k, name in enumerate(TRIALS[:2]):
        columns = {"time [s]": clock, "flexion [deg]": 30.0 * clock, "adduction [deg]": 0.1 * clock}
        table(home / f"{name}.csv", later(k, columns))
    source = 'forces = "forces.mot"\nforce_unit = "lbf"\nareas = "area.csv"\nthreshold = 0.002'
    sources = [f'[from.{name}]\ninputs = "{name}.csv"\n{source}' for name in TRIALS[:2]]
    more = (constants({"R": 0.037}), parameter("E_star", 1e7, 1e5, 1e9, "Pa"), *sources)
    written(home / "plan.toml", settings("knee", TRIALS[:2], 1, *more))
