"""What the diagnosis says of a friction damper whose friction is withheld, and of one that has it.

`python -m benchmarks.devices.friction_damper`. Recordings of a banded rotary friction damper with backlash (real; 1024
Hz, at 30 lb of band tension, its friction about 9.9 kN), two cycles a trial, and again one: three for calibration, of
two rates, two held out, one of them of half the stroke. The base is a spring and a dashpot of a simulator that takes a
force law (`benchmarks.devices.friction_damper_model`).
"""

from __future__ import annotations

import argparse
import json
import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import geocontact as gc
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial

if TYPE_CHECKING:
    from geocontact.gap.diagnose import Findings

HERE = Path(__file__).resolve().parents[1]
INCH, KIP = 0.0254, 4448.2216
EVERY = 8
"""Samples of which one is kept: 128 Hz."""
FAST, SLOW, SMALL = (f"{name}amplitude.json" for name in ("1Hz30lbtension1", "0.5Hz30lbtension1", "1Hz30lbtension0.5"))
CALIBRATION, EVALUATION = ((FAST, 0), (FAST, 1), (SLOW, 0)), ((FAST, 2), (SMALL, 1))
"""Files and which of their pieces."""
CYCLES = 2
"""A trial's."""
CYCLE = {FAST: 1.0, SLOW: 2.0, SMALL: 1.0}
"""[s]"""
BASE = (gc.Parameter("k", "N/m", 1e4, 0.0, 1e6), gc.Parameter("c", "N s/m", 1e4, 0.0, 1e6))
FRICTION = (gc.Parameter("F_c", "N", 9e3, 0.0, 5e4), gc.Parameter("reach", "m", 4e-3, 1e-4, 2e-2))
PUBLISHED = 9.9e3
"""Friction [N], about."""


def case(data: Path, system: str, parameters: tuple[gc.Parameter, ...], cycles: int = CYCLES) -> GapCase:
    """The damper's trials, for one of the models of `benchmarks.devices.friction_damper_model`."""

    def trial(file: str, piece: int) -> Trial:
        rows = np.array(json.loads((data / "friction_damper" / file).read_text())["data"])
        length = cycles * CYCLE[file]
        inside = (rows[:, 0] >= piece * length) & (rows[:, 0] < (piece + 1) * length)
        part = rows[inside][::EVERY]
        values = np.column_stack([INCH * part[:, 1], KIP * part[:, 2]])
        signals = Signals(part[:, 0] - part[0, 0], values, ("x", "force"), ("m", "N"))
        return Trial(
            f"{file.split('30lb', maxsplit=1)[0]}_{piece}_{file.split('tension')[1].split('amp', maxsplit=1)[0]}in",
            signals,
        )

    calibration, evaluation = ([trial(*each) for each in which] for which in (CALIBRATION, EVALUATION))
    return GapCase("friction_damper", system, tuple(calibration), tuple(evaluation), parameters)


def findings(data: Path, rubbing: bool, cycles: int = CYCLES) -> Findings:
    """The diagnosis with all that it rests on, friction in the base or withheld."""
    from benchmarks.devices.friction_damper_model import DAMPER, RUBBING
    from geocontact.gap.diagnose import diagnose

    base, parameters = (RUBBING, (*BASE, *FRICTION)) if rubbing else (DAMPER, BASE)
    one = case(
        data, f"benchmarks.devices.friction_damper_model:{'RUBBING' if rubbing else 'DAMPER'}", parameters, cycles
    )
    return diagnose(one, base.build(one.parameters, one.constants, one.tables))


def main() -> None:
    """Diagnose both, print, write the JSON."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.devices.friction_damper", description=__doc__.splitlines()[0]
    )
    default = Path(os.environ.get("GEOCONTACT_DATA") or HERE.parents[1] / "shared" / "data")
    parser.add_argument("--data", type=Path, default=default, help="folder of the real data (%(default)s)")
    parser.add_argument("--out", type=Path, default=HERE / "results" / "friction_damper.json")
    options = parser.parse_args()
    from benchmarks.machine import stamp

    found: dict[str, Any] = {**stamp(), "published_N": PUBLISHED, "rate_Hz": 1024 // EVERY}
    for cycles in (CYCLES, 1):
        for rubbing in (False, True):
            name = f"{cycles} a trial, friction {'in the base' if rubbing else 'withheld'}"
            found[name] = _told(options.data, rubbing, cycles)
            print(name, json.dumps(found[name], indent=1), flush=True)
    options.out.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


def _told(data: Path, rubbing: bool, cycles: int) -> dict[str, Any]:
    began = time.process_time()
    told = findings(data, rubbing, cycles).diagnosis
    return {
        "verdict": told.verdict,
        "effects": list(told.effects),
        "probabilities": {k: float(v) for k, v in told.probabilities.items()},
        "gap": {
            k: {"before": g.rmse_before, "after": g.rmse_after, "reduction": g.reduction, "ci95": g.ci95}
            for k, g in told.gap.items()
        },
        "parameters": {k: {"value": e.value, "ci95": e.ci95} for k, e in told.parameters.items()},
        "remarks": list(told.remarks),
        "cpu_s": time.process_time() - began,
    }


if __name__ == "__main__":
    main()
