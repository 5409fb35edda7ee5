"""A study of real analyses, one trial of which takes too much memory: it is named, the others have their tables."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.cli.calls import FACET, ROOT, call

MESHES = ROOT / "meshes"
RADIUS = 20.0  # mm
STUDY = f"""files = "balls/{{subject}}.stl"
analysis = "modulus"
pages = false
figures = false

[options]
area = ["{{press:area.csv}}"]
force = "{{press:pressure.csv}}"
map = "total=force"
radius_mm = {RADIUS:g}
reading = "cap"
bootstrap = 0

[steps.press]
analysis = "area"
limits = {{ memory = "600MB" }}

[steps.press.options]
moving = "{{file}}"
fixed = "plate.stl"
unit = "mm"
motion = "press.csv"
threshold = "0"
pressure = true
modulus = "5MPa"
poisson = 0.46
"""


def large_ball(file: Path, around: int, down: int) -> None:
    """A ball of very many facets, 50 B each, without poles of their own kind: facets there have no area."""
    turn, tilt = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, around), np.linspace(0.0, np.pi, down), indexing="ij")
    ball = RADIUS * np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1)
    a, b, c, d = ball[:-1, :-1], ball[1:, :-1], ball[1:, 1:], ball[:-1, 1:]
    facets = np.zeros(2 * a.shape[0] * a.shape[1], FACET)
    facets["corners"] = np.concatenate([np.stack(each, axis=2).reshape(-1, 3, 3) for each in ((a, c, b), (a, d, c))])
    file.write_bytes(b"\0" * 80 + np.uint32(len(facets)).astype("<u4").tobytes() + facets.tobytes())


def press(file: Path) -> None:
    """A press of 0.2 to 0.9 mm within a second, without turns."""
    rows = [f"{k / 20.0},0,{RADIUS - 0.2 - 0.035 * k},0,1,0,0,0" for k in range(21)]
    file.write_text("\n".join(["time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz", *rows]) + "\n", encoding="utf-8")


def study(folder: Path) -> Path:
    """Three balls pressed into a layer, that of B with four million facets."""
    (folder / "balls").mkdir()
    for name in "AC":
        shutil.copy(MESHES / "sphere_r20.stl", folder / "balls" / f"{name}.stl")
    large_ball(folder / "balls" / "B.stl", 2001, 1001)
    shutil.copy(MESHES / "plate_80x80x12.stl", folder / "plate.stl")
    press(folder / "press.csv")
    file = folder / "study.toml"
    file.write_text(STUDY, encoding="utf-8")
    return file


@pytest.mark.slow
def test_a_study_sets_the_trial_aside_that_takes_twice_its_memory(tmp_path: Path) -> None:
    """Ended at 600 MB and at 1.2 GB, it is named with its log; what takes from it has no input, the others have."""
    out = tmp_path / "out"
    done = call("cohort", study(tmp_path), "--workers", "1", "--out", out, folder=out)
    assert done.code == 1
    line = re.search(
        r"press of B: took more than 600 MB, and then more than 1.2 GB \(where it was: (.*\.log)\)", done.err
    )
    assert line is not None, done.err
    log = (out / line[1]).read_text(encoding="utf-8")
    tries = re.findall(r"^Memory \(.* of (.*)\)!$", log, re.MULTILINE)
    assert tries == ["600 MB", "1.2 GB"] and "geocontact/" in log.replace("\\", "/")
    for step, new in (("press", 2), ("modulus", 1)):  # A and C press alike: one modulus serves both
        assert f"2 of 3 trials of {step} have results, {new} of them new" in done.out
    table = done.table("trials.csv").set_index(["step", "name"])
    states = {"press": ["done", "set aside", "done"], "modulus": ["done", "without input", "done"]}
    for step, expected in states.items():
        assert [table.loc[(step, name), "state"] for name in "ABC"] == expected
    assert table.loc[("press", "B"), "words"] in line[0] and table.loc[("modulus", "B"), "words"] == "needs press of B"
    assert set(pd.read_parquet(out / "tables" / "modulus" / "modulus.parquet")["name"]) == {"A", "C"}
    agrees(pd.read_parquet(out / "tables" / "press" / "area.parquet"), tmp_path / "press.csv")


def agrees(area: pd.DataFrame, motion: Path) -> None:
    """Areas of a ball whose facets lie inside: below π(2 R d − d²), deeper than 0.7 mm by up to 4.5 %."""
    depth = RADIUS - pd.read_csv(motion, skipinitialspace=True)["ty [mm]"].to_numpy()
    disc = np.pi * (2.0 * RADIUS * depth - depth**2)
    for name in "AC":
        found = area[area["name"] == name]["area_fixed [mm^2]"].to_numpy()
        assert (found < disc).all()
        np.testing.assert_allclose(found[depth > 0.7], disc[depth > 0.7], rtol=0.045)
    assert set(area["name"]) == {"A", "C"}
