"""A study of overhead work: the shipped trial with the device and without it, beside a logger and a mat."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import table, written

STUDY = """[tasks.T1]
tool = { value = 1.3, unit = "kg" }
push = { value = 35, unit = "N" }

[persons.P1]
mass = { value = 82, unit = "kg" }
sex = "male"
dominant = "right"
upper_arm = { value = 296, unit = "mm" }

[[trials]]
name = "bare"
person = "P1"
task = "T1"
markers = "../meshes/overhead_P1T1S100/markers.trc"
tool = "../meshes/overhead_P1T1S100/tool.csv"

[[trials]]
name = "supported"
person = "P1"
task = "T1"
markers = "../meshes/overhead_P1T1S100/markers.trc"
tool = "../meshes/overhead_P1T1S100/tool.csv"
level = "50%"
recorded = "recorded.csv"
without = "bare"
"""


def make(home: Path, meshes: Path) -> None:
    """study.toml, and recorded.csv with an arm that is raised once, from half a second on."""
    time = np.arange(50, 551) * 0.01
    up = np.sin(np.pi * np.clip((time - 0.5) / 5.0, 0.0, 1.0)) ** 2
    table(home / "recorded.csv", {"time [s]": time, "elevation [deg]": 10.0 + 100.0 * up, "force [N]": 40.0 * up})
    written(home / "study.toml", STUDY)
