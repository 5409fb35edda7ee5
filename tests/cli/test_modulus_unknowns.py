"""`geocontact modulus --free adduction`: from meshes to the offset; offsets of poses, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.io.recordings.area_table import OFFSET
from tests.analyses.modulus.synthetic_step import pressed
from tests.cli.calls import FEMUR, INSERT, agree, area, done, gait, poses
from tests.cli.test_modulus import modulus, told
from tests.elsewhere import Elsewhere
from tests.identify.synthetic_contact import TRUE

SOME = range(0, 96, 10)


def test_offset_of_a_motion_is_that_of_its_poses(tmp_path: Path) -> None:
    """--adduction x=1.5 is the same as poses that were turned by hand."""
    rows = [(1.0, 30.2, -0.5)]
    half = np.radians(0.75)
    turned = [(*row, np.cos(half), np.sin(half), 0.0, 0.0) for row in rows]
    how = ("--split", "z", "--side", "right", "--rule", "clip")
    ours = done(area(tmp_path / "a", "--adduction", "x=1.5", *how, motion=poses(tmp_path, *rows))).table()
    assert (ours.pop(OFFSET) == 1.5).all()
    byhand = poses(tmp_path, *turned, name="turned.csv")
    agree(ours, done(area(tmp_path / "b", *how, motion=byhand)).table(), areas=1e-5)


@pytest.mark.slow
def test_adduction_from_meshes(tmp_path: Path, elsewhere: Elsewhere) -> None:
    """Areas of the sample knee at three offsets; forces by the law of areas at an offset between them."""
    motion, found = gait(tmp_path, SOME), {}
    how = ("--split", "z", "--side", "right", "--rule", "clip")
    for degrees in (-1.5, 0.0, 1.5, 0.6):
        turn = ("--adduction", f"x={degrees}") if degrees else ()
        out = tmp_path / f"at {degrees}"
        call = elsewhere(area, out, *how, *turn, moving=FEMUR, fixed=INSERT, motion=motion)
        found[degrees] = done(call).folder / "area.csv"
    force = pressed(tmp_path, pd.read_csv(found[0.6]))
    others = ("--area", found[0.0], "--area", found[1.5])
    m = told(
        done(elsewhere(modulus, tmp_path, *others, "--free", "adduction", area=found[-1.5], force=force, bootstrap=0))
    )
    assert m["adduction_deg"] == pytest.approx(0.6, abs=0.1) and m["E_star_Pa"] == pytest.approx(TRUE, rel=0.02)
    assert m["identifiability"]["free"]["verdict"] == "separable"


REFUSED = {
    "plain table": (("--free", "adduction"), "needs areas at 3 offsets of it or more"),
    "no motion": (("--free", "slope"), "slope needs --flexion"),
    "idle motion": (("--flexion", "x.csv"), "has no effect without --profile or slope in --free"),
    "prediction": (("--free", "slope", "--flexion", "x.csv", "--predict-area", "x.csv"), "do not go together"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_in_one_line(tmp_path: Path, name: str) -> None:
    options, words = REFUSED[name]
    result = modulus(tmp_path, *options)
    assert (result.code, result.out) == (2, "") and words in result.err
    assert len(result.complaints) == 1 and not result.folder.exists()


@pytest.mark.parametrize("text", ["2", "w=2", "x=", "x=90", "x=nan"])
def test_an_offset_that_is_none_is_refused(tmp_path: Path, text: str) -> None:
    result = area(tmp_path / "out", "--adduction", text, motion=gait(tmp_path))
    assert result.code == 2 and "--adduction" in result.err and len(result.complaints) == 1
    assert not result.folder.exists()
