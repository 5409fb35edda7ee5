"""`geocontact gap gather`: what is refused is one line, and leaves nothing."""

from __future__ import annotations

from pathlib import Path

from tests.cli.calls import call, written

SETTINGS = """format = 1
system = "knee"
calibration = ["t01"]
evaluation = ["t02"]
[from.t01]
inputs = "t01.csv"
forces = "forces.csv"
"""


def test_what_cannot_be_gathered_is_one_line(tmp_path: Path) -> None:
    settings = written(tmp_path / "gather.toml", SETTINGS)
    made = call("gap", "gather", settings, "--out", tmp_path / "case")
    (line,) = made.err.splitlines()
    assert made.code == 2 and line == f"{settings} [from.t02]: is missing; write it as [from.t01]: inputs, forces"
    assert not (tmp_path / "case").exists()
