"""Both ends of what a person does on another foot: `python -m benchmarks.prosthesis.responses`.

The shipped synthetic trial with its numbers as they are: outcomes at 66, 117 and 151 mm by response, how long torques
alone hold the leg, how far joints deviate with half, once and twice the tracking, and the same on ramps and a step.
Answers go to benchmarks/results/prosthesis_responses.json.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import write_results
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.trial import read
from geocontact.below_knee_prosthesis.design.foot_task import Terrain, words
from geocontact.below_knee_prosthesis.design.knob import AIMS, RESPONSES, Knob

TRIAL = Path(__file__).resolve().parents[2] / "meshes" / "gait_P1_medium_1"
FULCRUMS = np.array([0.066, 0.117, 0.151])
TERRAINS = (Terrain(), Terrain(np.radians(5.0)), Terrain(np.radians(-5.0)), Terrain(edge=0.06))
TRACKING = (0.0, 0.5, 1.0, 2.0)
"""Factors on the spring at hip and knee."""


def main() -> None:
    """Print and write."""
    warnings.simplefilter("ignore")
    asked = ProsthesisDesignOptions(
        TRIAL / "walking.trc",
        static=TRIAL / "standing.trc",
        mass=77.3,
        plates=TRIAL / "plates.mot",
        plate="own_force",
    )
    given = read(asked)
    task, figures = given.trial.task(), {}
    for terrain in TERRAINS:
        knob = Knob("fulcrum", FULCRUMS, given.trial.fulcrum, terrain)
        maps = knob.maps(given.foot, task)
        found = knob.measured(maps, task)
        told: dict[str, Any] = {
            aim: dict(zip(RESPONSES, found[:, :, k].tolist(), strict=True)) for k, aim in enumerate(AIMS)
        }
        for factor in TRACKING:
            moved = knob.other_feet(maps, task, factor).moved()
            off = np.degrees(np.abs(moved.joints)).max(axis=(0, 2))
            told[f"tracking {factor:g}"] = {"holds_s": moved.held.tolist(), "joints_off_deg": off.tolist()}
        figures[words(terrain) or "level"] = told
        print(words(terrain) or "level", told, flush=True)
    asked_for = {"fulcrums_m": FULCRUMS.tolist(), "stance_s": float(np.ptp(task.time)), "trial": TRIAL.name}
    write_results("prosthesis_responses", asked_for, figures)


if __name__ == "__main__":
    main()
