"""What the diagnosis says of a drive whose friction is withheld, and of one that has it: `python -m
benchmarks.devices.emps`.

The recording of the EMPS benchmark (position and force of a linear drive at 1 kHz, as it came) is cut into windows of
one half-cycle, each with a reversal in its middle; three are for calibration, two are held out.
"""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial

if TYPE_CHECKING:
    from geocontact.gap.diagnose import Findings

HERE = Path(__file__).resolve().parents[1]
HALF, FIRST = 3.119, 1.56
"""Time from one reversal to the next, and the middle of the first stroke [s]."""
CALIBRATION, EVALUATION = (0, 2, 4), (1, 3)
BASE = (Parameter("M", "kg", 90.0, 30.0, 300.0), Parameter("F_v", "N s/m", 200.0, 0.0, 1000.0))
FRICTION = (Parameter("F_c", "N", 15.0, 0.0, 100.0), Parameter("F_0", "N", 0.0, -20.0, 20.0))
COULOMB = 20.4
"""Published friction [N]."""


def case(data: Path, system: str, parameters: tuple[Parameter, ...]) -> GapCase:
    """The drive's trials, for one of the models of `benchmarks.devices.emps_model`."""
    from scipy.io import loadmat

    read = loadmat(data / "emps" / "DATA_EMPS.mat")
    time, q, control = (read[name].ravel() for name in ("t", "qm", "vir"))
    force = float(read["gtau"].item()) * control

    def trial(k: int) -> Trial:
        inside = (time >= FIRST + k * HALF) & (time < FIRST + (k + 1) * HALF)
        values = np.column_stack([q[inside], force[inside]])
        return Trial(f"half_cycle_{k + 1}", Signals(time[inside] - time[inside][0], values, ("q", "force"), ("m", "N")))

    return GapCase("emps", system, tuple(map(trial, CALIBRATION)), tuple(map(trial, EVALUATION)), parameters)


def findings(data: Path, rubbing: bool) -> Findings:
    """The diagnosis with all that it rests on, friction in the base or withheld."""
    from benchmarks.devices.emps_model import DRIVE, RUBBING
    from geocontact.gap.diagnose import diagnose

    base, parameters = (RUBBING, (*BASE, *FRICTION)) if rubbing else (DRIVE, BASE)
    one = case(data, f"benchmarks.devices.emps_model:{'RUBBING' if rubbing else 'DRIVE'}", parameters)
    return diagnose(one, base.build(one.parameters, one.constants, one.tables))


def said(data: Path, rubbing: bool) -> Diagnosis:
    """The diagnosis alone."""
    return findings(data, rubbing).diagnosis


def straight(data: Path) -> float:
    """Friction [N] by least squares of the calibration trials: mass, damper, sign of the rate, offset."""
    rows, forces = [], []
    for trial in case(data, "", BASE).calibration:
        rate = np.gradient(trial.column("q"), trial.time)
        rows.append(np.column_stack([np.gradient(rate, trial.time), rate, np.sign(rate), np.ones_like(rate)]))
        forces.append(trial.column("force"))
    return float(np.linalg.lstsq(np.concatenate(rows), np.concatenate(forces), rcond=None)[0][2])


def main() -> None:
    """Diagnose both, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.devices.emps", description=__doc__.splitlines()[0])
    default = Path(os.environ.get("GEOCONTACT_DATA") or HERE.parents[1] / "shared" / "data")
    parser.add_argument("--data", type=Path, default=default, help="folder of the real data (%(default)s)")
    parser.add_argument("--out", type=Path, default=HERE / "results" / "emps.json", help="the JSON")
    options = parser.parse_args()
    from benchmarks.machine import stamp

    found: dict[str, Any] = {**stamp(), "least squares [N]": float(f"{straight(options.data):.4g}")}
    print(found, flush=True)
    for name, rubbing in (("friction withheld", False), ("friction in the base", True)):
        whole = findings(options.data, rubbing)
        one, judged = whole.diagnosis, whole.attribution.answer.chosen.judged.model.values
        limits = {k: v.value for k, v in one.parameters.items() if k.endswith("limit") or k == "F_c"}
        found[name] = {
            "verdict": one.verdict,
            "effects": one.effects,
            "probabilities": {k: round(v, 4) for k, v in one.probabilities.items() if v > 1e-3},
            "limits": {k: float(f"{v:.4g}") for k, v in limits.items()},
            "judged": {k: float(f"{judged[k]:.4g}") for k in limits},
            "rmse": {k: [float(f"{v:.4g}") for v in (g.rmse_before, g.rmse_after)] for k, g in one.gap.items()},
            "remarks": one.remarks,
            "seconds": round(one.seconds, 1),
        }
        print(name, json.dumps(found[name], indent=1), flush=True)
    options.out.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
