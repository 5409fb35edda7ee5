"""Synthetic load cells in the thigh strap, and what a comparison finds: `python -m benchmarks.standing.shear OUT`.

OUT/study.toml is the shipped held-out trial with `shear [N]` in the strap's file: the force along the thigh of the
spring and dashpot that are planted (`meshes/standing_up_exoskeleton/truth.csv`), along the recorded coordinates, which
are low-passed, with noise. Written from the planar geometry with numpy and scipy alone; a spring between two rods is
all it is. Nothing here was measured.
"""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.signal import butter, filtfilt

import geocontact as gc

MESHES = Path(__file__).resolve().parents[2] / "meshes"
HELD_OUT = MESHES / "standing_up_held_out"
PLANTED = MESHES / "standing_up_exoskeleton" / "truth.csv"
HEIGHT, SHANK, HIGHER = 1.75, 0.2529, 0.01
"""Of the person [m]; shank over height (de Leva 1996); the exoskeleton's knee above the person's [m]."""
DAMPING = 10.0
"""N s/m, the study's."""
CUTOFF = 6.0
"""Hz."""
NOISE = 1.0
"""Standard deviation of the load cells [N]; invented."""


def shear_of(coordinates: pd.DataFrame, tangential: float, place: float) -> np.ndarray:
    """Force on the person along the thigh, towards the hip [N].

    Parameters
    ----------
    coordinates
        `time`, foot_x, foot_y [m] and turns of both chains [rad].
    tangential, place
        Stiffness [N/m], and the strap's distance from the knee [m].
    """
    time = coordinates["time"].to_numpy()
    turn = coordinates["foot_turn"].to_numpy()
    person, device = (
        np.cumsum([turn, *(coordinates[f"{prefix}{name}"].to_numpy() for name in ("ankle", "knee"))], axis=0)[1:]
        for prefix in ("", "exo_")
    )

    def along(angle: np.ndarray, length: float) -> np.ndarray:
        return length * np.array([-np.sin(angle), np.cos(angle)])

    shank = SHANK * HEIGHT
    own = along(person[0], shank) + along(person[1], place)
    other = along(device[0], shank + HIGHER) + along(device[1], place - HIGHER)
    off = np.sum((other - own) * along(person[1], 1.0), axis=0)
    return np.asarray(tangential * off + DAMPING * np.gradient(off, time))


def read_sto(file: Path) -> pd.DataFrame:
    """Columns of a .sto in radians."""
    lines = file.read_text(encoding="utf-8").splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("endheader"))
    names = lines[head + 1].split()
    table = pd.DataFrame([[float(each) for each in line.split()] for line in lines[head + 2 :]], columns=names)
    turns = [name for name in names if name not in ("time", "foot_x", "foot_y")]
    if "inDegrees=yes" in lines[:head]:
        table[turns] = np.radians(table[turns])
    return table


def write_study(folder: Path, seed: int = 1) -> Path:
    """The held-out study with measured shear; its study.toml."""
    folder.mkdir(parents=True, exist_ok=True)
    for file in HELD_OUT.iterdir():
        shutil.copy(file, folder / file.name)
    numbers = pd.read_csv(PLANTED, comment="#").set_index("parameter")["value"]
    table = read_sto(folder / "P1_coordinates.sto")
    b, a = butter(2, CUTOFF, fs=1.0 / (table["time"][1] - table["time"][0]))
    smooth = table.copy()
    for name in table.columns[1:]:
        smooth[name] = filtfilt(b, a, table[name])
    shear = shear_of(smooth, float(numbers["strap tangential"]), float(numbers["strap place"]))
    strap = pd.read_csv(folder / "P1_strap.csv")
    strap["shear [N]"] = np.interp(strap["time [s]"], table["time"], shear)
    strap["shear [N]"] += np.random.default_rng(seed).normal(0.0, NOISE, len(strap))
    strap.round(4).to_csv(folder / "P1_strap.csv", index=False)
    return folder / "study.toml"


def main() -> None:
    """Make the study, compare, print the rows of strap and shear."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.standing.shear", description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    study = write_study(parser.parse_args().out)
    found = gc.sit_to_stand.compare(study, parameters=PLANTED, against=PLANTED.with_name("study.toml"), nodes=15)
    table = found.table()
    print(found)
    print(table[table["quantity"].isin(["strap", "strap shear"])].to_string())


if __name__ == "__main__":
    main()
