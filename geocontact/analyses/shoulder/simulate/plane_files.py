"""Files from which `geocontact gap gather` makes a case of the base model `shoulder`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.shoulder.simulate.simulated_arm import SimulatedArm
from geocontact.io.text.results import write_table
from geocontact.shoulder_exoskeleton.plane import plane_arm
from geocontact.shoulder_exoskeleton.work_phases import PHASES

FREE = {"k_t": ("N/m", 50.0, 2e4), "b_t": ("N s/m", 0.0, 500.0), "m": ("kg", 0.05, 5.0)}
"""Numbers that a fit may free, with unit and bounds; the others are constants."""
HEAD = """# {side} arm in its plane; the hinge moves by {moved} (standard deviation) forwards and upwards
# A case needs a second trial, held out: simulate it as well, then write its folder for OTHER below, and its level.
format = 1
system = "shoulder"
support = "support.csv"
calibration = ["t01"]
evaluation = ["t02"]

[from.t01]
inputs = "{side}.csv"
outputs = "{side}_simulated.csv"

[trial.t01]
level = {level:g}

[from.t02]
inputs = "OTHER/plane/{side}.csv"
outputs = "OTHER/plane/{side}_simulated.csv"

[trial.t02]
level = {level:g}

[constants]
{known}

{free}
"""


def write_plane(folder: Path, arm: SimulatedArm) -> None:
    """SIDE.csv (arm, event), SIDE_simulated.csv (exo, force), support.csv, and SIDE.toml to copy into a gather.toml."""
    s, side = arm.simulation, arm.side
    found = plane_arm(s)
    folder.mkdir(parents=True, exist_ok=True)
    event = (arm.phase == PHASES.index("screw-in")).astype(int)
    time = s.motion.time
    inputs = {"time [s]": time, "arm [deg]": np.degrees(s.motion.elevation), "event [-]": event}
    write_table(pd.DataFrame(inputs), folder, side)
    outputs = {"time [s]": time, "exo [deg]": np.degrees(s.elevation), "force [N]": s.supporting}
    write_table(pd.DataFrame(outputs), folder, f"{side}_simulated")
    support = {"angle [deg]": np.degrees(found.angle), "torque [N m]": found.torque}
    write_table(pd.DataFrame(support), folder, "support")
    known = "\n".join(f"{name} = {value:.9g}" for name, value in found.constants.items() if name not in FREE)
    moved = " and ".join(f"{1e3 * each:.1f} mm" for each in found.moved)
    free = "\n".join(_parameter(name, found.constants[name]) for name in FREE)
    text = HEAD.format(side=side, moved=moved, level=s.level, known=known, free=free)
    (folder / f"{side}.toml").write_text(text, encoding="utf-8")


def _parameter(name: str, start: float) -> str:
    unit, lower, upper = FREE[name]
    return f'[parameters.{name}]\nstart = {start:.6g}\nlower = {lower:g}\nupper = {upper:g}\nunit = "{unit}"\n'
