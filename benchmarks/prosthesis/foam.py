"""The sole as foam beside spheres: `python -m benchmarks.prosthesis.foam [--settings low medium high]`.

The foam is that of `[foam]` in a foot's file (`keel.foam`), each zone as stiff and damped as its spheres. Soles of 24,
48 and 96 spheres and columns of 8 to 1 mm are each fitted to the study's three compressions and put under the same load
and pitch (`benchmarks.prosthesis.keel_stance`), without inertia. The reference is foam of 1 mm. Printed are the centre
of pressure under the same load, the force along the reference's own poses, and the CPU time of all frames with damping
and friction.
benchmarks/results/prosthesis_foam.json.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np

from benchmarks.machine import write_results
from benchmarks.prosthesis.keel_stance import LEVEL, WEIGHT, Stance, stance
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.vsf import SETTINGS, fulcrum_of, vsf_foot, vsf_on_foam
from geocontact.loads.centre_of_pressure import centre_of_pressure

COLUMNS = (8e-3, 4e-3, 2e-3, 1e-3)
"""m; breadths of a column along the foot."""
SPHERES = {24: (1, 2), 48: (2, 2), 96: (2, 4)}
REPEATS = 5


def feet() -> dict[str, VariableStiffnessFoot]:
    """By name, the reference last."""
    found = {f"{count} spheres": vsf_foot(finer=f, columns=c) for count, (f, c) in SPHERES.items()}
    return found | {f"foam of {1e3 * pitch:g} mm": vsf_on_foam(pitch, across=1) for pitch in COLUMNS}


def along(foot: VariableStiffnessFoot, fulcrum: float, one: Stance) -> tuple[np.ndarray, np.ndarray, float]:
    """Upward force [N], centre of pressure along the floor [m], median CPU seconds."""
    keel, spent = foot.at(fulcrum), []
    for _ in range(REPEATS):
        before = time.process_time()
        moved = keel.solve(one.poses, LEVEL, rate=one.rate, time=one.time)
        spent.append(time.process_time() - before)
    return moved.force[:, 1], centre(foot, fulcrum, one), float(np.median(spent))


def centre(foot: VariableStiffnessFoot, fulcrum: float, one: Stance) -> np.ndarray:
    """Of pressure along the floor from the keel's posterior end [m], elastic."""
    moved = foot.at(fulcrum).solve(one.poses, LEVEL)
    return centre_of_pressure(moved.loads, gate=0.05 * WEIGHT).centre[:, 0] - one.poses.translation[:, 0]


def at_setting(setting: str) -> dict[str, dict[str, Any]]:
    """All soles at one setting."""
    fulcrum, all_feet = fulcrum_of(setting), feet()
    loaded = {name: stance(foot, fulcrum) for name, foot in all_feet.items()}
    *_, last = all_feet
    best, wanted, _ = along(all_feet[last], fulcrum, loaded[last])
    told: dict[str, dict[str, Any]] = {}
    for name, foot in all_feet.items():
        away = centre(foot, fulcrum, loaded[name]) - wanted
        force, _, seconds = along(foot, fulcrum, loaded[last])
        told[name] = {
            "contacts": len(foot.sole.spheres),
            "centre_rms_share": float(np.sqrt(np.nanmean(away**2))) / foot.keel.length,
            "centre_most_share": float(np.nanmax(np.abs(away))) / foot.keel.length,
            "force_rms_bw": float(np.sqrt(np.mean((force - best) ** 2))) / WEIGHT,
            "seconds": seconds,
        }
    return told


def main() -> None:
    """Print and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--settings", nargs="+", default=list(SETTINGS), choices=list(SETTINGS))
    asked = parser.parse_args()
    told = {setting: at_setting(setting) for setting in asked.settings}
    for setting, rows in told.items():
        for name, row in rows.items():
            centres = f"{100.0 * row['centre_rms_share']:5.2f} ({100.0 * row['centre_most_share']:5.2f}) % of the foot"
            words = f"{centres}, force {100.0 * row['force_rms_bw']:5.2f} % BW, {1e3 * row['seconds']:6.1f} ms"
            print(f"{setting:8}{name:15}{row['contacts']:5d} centre {words}")
    write_results("prosthesis_foam", vars(asked), told)


if __name__ == "__main__":
    main()
