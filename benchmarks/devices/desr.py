"""Torque-angle loops of a prosthetic ankle as a gap case: `python -m benchmarks.devices.desr OUT`, `--data` to say
where from.

The foot has a slider that changes its stiffness; each setting (0 to 45 mm) was turned once by a dynamometer, 0 → -10° →
11.5° → 0 at a constant 3.3 °/s, then held for 2.4 s: 12 000 samples in 14.4 s. A trial is a setting. The base model is
an elastic joint, its stiffness a function of the setting, fitted to some settings and held against others: three
between them and one (45 mm) beyond. Its curve is one of two: the mean of turning up and turning down at the settings
that are fitted to, so that nothing but the loops is left to explain ("loops"), or the mean of the two cam profiles that
the foot was designed with ("design").

Recordings are low-passed at 12.5 Hz without phase (Butterworth, order 3, both ways; the data's authors use the same
corner) and every 18th sample is kept, 46 Hz, so that nothing above half of that is left to fold back.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.io import loadmat
from scipy.signal import butter, sosfiltfilt

FILE = Path("desr_prosthetic_ankle") / "DESR_Characterization_Data.mat"
CALIBRATION = ("x00", "x20", "x30", "x33", "x40")
EVALUATION = ("x10", "x25", "x35", "x45")
EVERY, CORNER, ORDER = 18, 12.5, 3
CURVE = np.radians(np.arange(-9.75, 11.26, 0.25))
"""Angles of the curve, within what every setting was turned through; designed profiles go from -40 to 40 degrees."""
SYSTEMS = {"ankle": "benchmarks.devices.desr_model:ANKLE", "joint": "geocontact.systems.elastic_joint:JOINT"}
"""With the effect that the designers intended among the candidates, and without it."""
CURVES = ("loops", "design")


def loops(file: Path, series: str = "DESR_N") -> dict[str, pd.DataFrame]:
    """Recordings by setting, thinned: time [s], angle [rad], torque [N m].

    "DESR_N" switches between its cams; "DESR_N_CAM1" and "DESR_N_CAM2" are the foot with one cam, at 33 mm only.
    """
    return {name: thinned(recording) for name, recording in loadmat(file, simplify_cells=True)[series].items()}


def thinned(recording: Mapping[str, np.ndarray]) -> pd.DataFrame:
    """Low-passed and decimated."""
    time, angle, torque = (recording[name] for name in ("timeJIM", "angleJIM", "torque"))
    low_pass = butter(ORDER, CORNER, fs=1.0 / np.diff(time).mean(), output="sos")
    slow = {"angle [rad]": sosfiltfilt(low_pass, angle), "torque [N m]": sosfiltfilt(low_pass, torque)}
    return pd.DataFrame({"time [s]": time, **slow})[::EVERY]


def cams(file: Path) -> pd.DataFrame:
    """Designed torque along either cam [N m] at the angles of `CURVE`, and their mean."""
    data = loadmat(file, squeeze_me=True)
    angle = np.radians(np.linspace(-40.0, 40.0, 16001))
    dorsal, plantar = (np.interp(CURVE, angle, data[f"torque_desired_{cam}"]) for cam in ("dorsal", "plantar"))
    return pd.DataFrame(
        {
            "angle [rad]": CURVE,
            "torque [N m]": 0.5 * (dorsal + plantar),
            "dorsal [N m]": dorsal,
            "plantar [N m]": plantar,
        }
    )


def middle(table: pd.DataFrame) -> np.ndarray:
    """Mean torque [N m] of turning up and turning down at the angles of `CURVE`."""
    time, angle, torque = (table[column].to_numpy() for column in table)
    lowest, highest = int(angle.argmin()), int(angle.argmax())
    up = slice(lowest, highest + 1)
    down = np.concatenate([np.flatnonzero(time > time[highest]), np.arange(lowest)])
    down = down[angle[down].argsort()]
    return 0.5 * (np.interp(CURVE, angle[up], torque[up]) + np.interp(CURVE, angle[down], torque[down]))


def curve(file: Path, kind: str) -> pd.DataFrame:
    """Table `curve` of the case: the designed cams, for "loops" with the mean of the recordings as torque."""
    table = cams(file)
    if kind == "loops":
        recorded = loops(file)
        means = [middle(recorded[name]) for name in CALIBRATION]
        table["torque [N m]"] = np.mean([mean / np.ptp(mean) for mean in means], axis=0) * np.ptp(means[0])
    return table


def settings(system: str) -> str:
    """case.toml."""
    trials = [f"[trial.{name}]\nsetting = {float(name[1:])}  # mm" for name in (*CALIBRATION, *EVALUATION)]
    lists = [f"{side} = {list(names)}" for side, names in (("calibration", CALIBRATION), ("evaluation", EVALUATION))]
    return "\n".join(
        [
            "format = 1",
            f'system = "{system}"',
            *(line.replace("'", '"') for line in lists),
            'curve = "curve.csv"',
            parameter("k", 150.0, 20.0, 2000.0, "N m/rad"),
            parameter("growth", 0.03, 0.0, 0.2, "1/mm"),
            parameter("bend", 0.0, -0.002, 0.002, "1/mm^2"),
            parameter("angle0", 0.0, -0.05, 0.05, "rad"),
            *trials,
            "",
        ]
    )


def parameter(name: str, start: float, lower: float, upper: float, unit: str) -> str:
    return f'[parameters.{name}]\nstart = {start}\nlower = {lower}\nupper = {upper}\nunit = "{unit}"'


def write_case(file: Path, folder: Path, system: str = SYSTEMS["ankle"], kind: str = "loops") -> Path:
    """A gap case in `folder`, made from the recordings in `file`."""
    (folder / "trials").mkdir(parents=True)
    for name, table in loops(file).items():
        table.to_csv(folder / "trials" / f"{name}.csv", index=False, float_format="%.9g")
    curve(file, kind).to_csv(folder / "curve.csv", index=False, float_format="%.9g")
    (folder / "case.toml").write_text(settings(system), encoding="utf-8")
    return folder


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, help="folder that gets a case per base model")
    default = Path(os.environ.get("GEOCONTACT_DATA") or Path(__file__).resolve().parents[3] / "shared" / "data")
    parser.add_argument("--data", type=Path, default=default, help="folder of the real data (%(default)s)")
    given = parser.parse_args()
    if not (given.data / FILE).is_file():
        parser.error(f"no {given.data / FILE}; name the folder of the real data with --data")
    if taken := [folder for folder in given.out.glob("desr_*") if folder.is_dir()]:
        parser.error(f"{taken[0]} is there already; name another folder")
    for (name, system), kind in product(SYSTEMS.items(), CURVES):
        print(write_case(given.data / FILE, given.out / f"desr_{name}_{kind}", system, kind))


if __name__ == "__main__":
    main()
