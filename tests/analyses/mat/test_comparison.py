"""A model's forces beside the mat's: point and frame of the model, and the phases that are compared. Synthetic."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.mat.result import MatResult
from tests.analyses.mat.samples import flat, refusal, uniform
from tests.cli.calls import written

COUNT, STEP = 200, 0.02
TIME = STEP * np.arange(COUNT)
POINT = np.array([40.0, 10.0, 25.0])
COLUMNS = ("fx [N]", "fy [N]", "fz [N]", "mx [N m]", "my [N m]", "mz [N m]")


def load() -> np.ndarray:
    """Two cycles of 2 s [kPa]."""
    return uniform(COUNT, 10.0) * (1.0 - np.cos(np.pi * TIME))[:, None, None]


def model(folder: Path, head: str, columns: tuple[str, ...] = COLUMNS, late: float = 0.0, plus: float = 0.0) -> Path:
    """The mat's own load in closed form, its moments about `POINT` [mm]; late by some seconds, off by some newtons."""
    force = np.zeros((COUNT, 3))
    force[:, 2] = -12.0 * (1.0 - np.cos(np.pi * (TIME - late)))
    moment = np.cross((np.array([40.0, 45.0, 0.0]) - POINT) * 1e-3, force)
    force[:, 2] += plus
    values = pd.DataFrame(np.column_stack([force, moment]), columns=COLUMNS)[list(columns)]
    values.insert(0, "time [s]", TIME)
    return written(folder / "model.csv", head + values.to_csv(index=False))


def compare(folder: Path, model: Path, **options: Any) -> MatResult:
    return flat(folder, load(), compare=model, **options)


def said(point: str = "40, 10, 25", frame: str = "of skin.obj") -> str:
    return f"# point_mm = {point}\n# frame = {frame}\n"


def of(result: MatResult, channel: str, phase: str = "all") -> pd.Series:
    rows = result.table("agreement").query("channel == @channel and phase == @phase")
    assert len(rows) == 1
    return rows.iloc[0]


def test_a_model_is_put_beside_it(tmp_path: Path) -> None:
    one = written(tmp_path / "model.csv", "time [s],normal [N]\n0,13\n1,13\n")
    result = flat(tmp_path, uniform(), compare=one)
    whole = of(result, "normal")
    assert whole["mae"] == pytest.approx(1.0) and whole["rmsd"] == pytest.approx(1.0)
    assert len(result.table("agreement")) == 11
    assert result.sentences[-1] == "normal: mean absolute difference 1 N, root mean square 1"


def test_moments_of_the_model_are_moved_to_our_point(tmp_path: Path) -> None:
    result = compare(tmp_path, model(tmp_path, said()), point="-5,3,60")
    assert result.warnings == ()
    for channel in ("fx", "fy", "fz", "mx", "my", "mz"):
        assert of(result, channel)["rmsd"] == pytest.approx(0.0, abs=1e-6)
    assert result.record.results["compared_with"] == {"frame": "of skin.obj", "point_mm": POINT.tolist()}


def test_a_model_without_a_point_is_taken_to_refer_to_ours_and_that_is_told(tmp_path: Path) -> None:
    bare = model(tmp_path, "")
    same, other = compare(tmp_path, bare, point="40,10,25"), compare(tmp_path, bare)
    assert of(same, "mx")["rmsd"] == pytest.approx(0.0, abs=1e-6) and of(other, "mx")["rmsd"] > 0.05
    assert other.record.results["compared_with"]["point_mm"] == "not said, taken as ours"


def test_moments_that_cannot_be_moved_are_refused(tmp_path: Path) -> None:
    alone = model(tmp_path, said(), ("fz [N]", "mx [N m]"))
    with refusal("has moments about another point and no fx, fy to move them with; add the forces, or give `point`"):
        compare(tmp_path, alone)
    assert of(compare(tmp_path, alone, point="40,10,25"), "mx")["rmsd"] < 1e-6


def test_forces_alone_need_no_point(tmp_path: Path) -> None:
    result = compare(tmp_path, model(tmp_path, said(), ("fz [N]",)))
    assert of(result, "fz")["rmsd"] == pytest.approx(0.0, abs=1e-6)


def test_another_frame_is_refused_where_ours_has_a_name_and_told_where_not(tmp_path: Path) -> None:
    other = model(tmp_path, said(frame="pelvis"))
    with refusal("is in the frame 'pelvis', the mat's forces are in 'thigh'; turn it into that frame"):
        compare(tmp_path, other, frame="thigh")
    (line,) = compare(tmp_path, other).warnings
    assert "is in the frame 'pelvis'" in line and "say which frame ours is with `frame`" in line
    assert compare(tmp_path, other, frame="pelvis").warnings == ()


def phases(folder: Path, *rows: str) -> Path:
    return written(folder / "phases.csv", "\n".join(["name, start [s], end [s]", *rows]) + "\n")


def test_phases_are_pooled_over_the_cycles_and_tell_their_lag(tmp_path: Path) -> None:
    """Loads peak at 1 and 3 s; the model is 0.06 s late. Seat-off is too short for a lag."""
    named = phases(tmp_path, "lean, 0.2, 1.8", "seat-off, 1.8, 2.0", "lean, 2.2, 3.8", "rise, 1.2, 1.6")
    result = compare(tmp_path, model(tmp_path, said(), late=0.06), phases=named)
    assert result.table("agreement")["phase"].drop_duplicates().tolist() == ["all", "lean", "seat-off", "rise"]
    lean, short, rise = (of(result, "fz", name) for name in ("lean", "seat-off", "rise"))
    assert lean["samples"] == 162 and lean["lag [s]"] == pytest.approx(0.06, abs=0.002)
    assert short["samples"] == 11 and np.isnan(short["lag [s]"])
    assert np.isnan(rise["lag [s]"]), "a steady fall"
    inside = ((TIME > 0.19) & (TIME < 1.81)) | ((TIME > 2.19) & (TIME < 3.81))
    off = 12.0 * (np.cos(np.pi * TIME) - np.cos(np.pi * (TIME - 0.06)))[inside]
    assert lean["mae"] == pytest.approx(np.abs(off).mean(), rel=1e-6)
    assert lean["rmsd"] == pytest.approx(np.sqrt(np.mean(off**2)), rel=1e-6)
    assert [each["role"] for each in result.record.inputs].count("`phases`") == 1


def test_without_phases_tenths_are_compared(tmp_path: Path) -> None:
    result = compare(tmp_path, model(tmp_path, said(), plus=1.5))
    tenths = result.table("agreement")["phase"].drop_duplicates().tolist()[1:]
    assert tenths == [f"{a}-{a + 10} %" for a in range(0, 100, 10)]
    assert of(result, "fz", "30-40 %")["bias"] == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (("lean, 0.2, 0.2",), "row 1: phase 'lean' from 0.2 to 0.2 s holds 1 frames"),
        (("lean, 0.2, 1", "rise, 2, 1"), "row 2: phase 'rise' from 2 to 1 s"),
        (("lean, 0.2, 5",), "at least 3 are needed, between 0 and 3.98 s"),
        (("lean, -1, 1",), "phase 'lean' from -1 to 1 s"),
        (("lean, 0, 1", "lean, 0.5, 2"), "phase 'lean' overlaps itself"),
        (("all, 0, 1",), "phase 'all' is the name of the whole recording"),
        (("lean, soon, 1",), "'soon' in column 'start' is not a finite number"),
    ],
)
def test_phases_that_cannot_be_are_refused(tmp_path: Path, rows: tuple[str, ...], said: str) -> None:
    with refusal(said):
        compare(tmp_path, model(tmp_path, ""), phases=phases(tmp_path, *rows))


def test_phases_without_their_columns_are_refused(tmp_path: Path) -> None:
    named = written(tmp_path / "phases.csv", "name,start [s]\nlean,0\n")
    with refusal("line 1: no column end [s]"):
        compare(tmp_path, model(tmp_path, ""), phases=named)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("# point_mm = 1, 2\ntime [s],mx [N m]\n0,1\n4,1\n", "line 1: point_mm is '1, 2'"),
        ("time [s],fz [kPa]\n0,1\n4,1\n", "column 'fz' is not in N"),
        ("time [s],force [N]\n0,1\n4,1\n", "holds none of our columns"),
        ("time [s],fz [N]\n50,1\n54,1\n", "has no time in common"),
    ],
)
def test_models_that_cannot_be_compared_are_refused(tmp_path: Path, text: str, said: str) -> None:
    with refusal(said):
        compare(tmp_path, written(tmp_path / "model.csv", text))
