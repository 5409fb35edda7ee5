"""Angles, drifts of an axis and a population for `geocontact elbow`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import table, written

PEOPLE = """[k]
unit = "N/m"
normal = { mean = 222, sd = 40, lower = 50 }
[l]
unit = "mm"
uniform = { lower = 160, upper = 210 }
[z]
unit = "mm"
uniform = { lower = 60, upper = 130 }
[x]
unit = "mm"
normal = { mean = 0, sd = 15 }
[y]
unit = "mm"
normal = { mean = 0, sd = 20 }
"""


def make(home: Path, meshes: Path) -> None:
    """A recorded angle, the instant centre of a knee, people with and without a correlation of their offsets."""
    time = np.linspace(0.0, 6.0, 121)
    table(home / "angle.csv", {"time [s]": time, "hinge [deg]": 60.0 - 45.0 * np.cos(1.7 * time) * np.cos(0.4 * time)})
    bent = np.linspace(0.0, 120.0, 13)
    wander = {"instant_centre_x [mm]": -8.0 * bent / 120.0, "instant_centre_y [mm]": 5.0 * np.sin(np.radians(bent))}
    table(home / "knee.csv", {"alpha [deg]": bent, **wander})
    written(home / "people.toml", PEOPLE)
    written(home / "correlated.toml", PEOPLE + "[correlation]\nx_y = 0.4\n")
