"""A gait study of one person on three settings of a prosthetic foot, for `geocontact prosthesis compare`."""

from __future__ import annotations

from pathlib import Path

from benchmarks.same_outputs.inputs.text import written

PERSON = """\
[persons.P1]
mass = { value = 77.3, unit = "kg" }
static = "../meshes/gait_P1_medium_1/standing.trc"
"""
TRIAL = """
[[trials]]
name = "P1_SETTING_1"
person = "P1"
setting = "SETTING"
markers = "../meshes/gait_P1_SETTING_1/walking.trc"
plates = "../meshes/gait_P1_SETTING_1/plates.mot"
plate = "own_force"
other_plate = "other_force"
"""


def make(home: Path, meshes: Path) -> None:
    """The description; its files are the shipped ones."""
    settings = ("low", "medium", "high")
    written(home / "study.toml", PERSON + "".join(TRIAL.replace("SETTING", each) for each in settings))
