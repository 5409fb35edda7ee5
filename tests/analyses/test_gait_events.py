"""One table of gait events for kinematics, areas and load cells: cycles by hand, styles, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.motion.styles import Cutting, shifts_between
from geocontact.data.errors import InputError
from geocontact.data.gait_events import GaitEvent, cycles_between
from geocontact.identify.signals.gait_cycles import gait_cycles
from geocontact.io.recordings.gait_events import read_gait_events

HEAD = "recording, side, event, time [s], style\n"
TABLE = HEAD + (
    "normal, right, heel strike, 0.0, slow\n"
    "normal, right, toe off, 0.6, slow\n"
    "normal, right, Heel Strike, 1.0, fast\n"
    "normal, right, foot off, 1.7, fast\n"
    "normal, right, heel strike, 2.0, fast\n"
    "normal, left, heel strike, 0.5, slow\n"
    "normal, left, heel strike, 1.5, slow\n"
    "other, right, heel strike, 7.0, slow\n"
)


def table(folder: Path, text: str = TABLE) -> Path:
    file = folder / "events.csv"
    file.write_text(text)
    return file


def test_cycles_of_a_side_run_from_strike_to_strike(tmp_path: Path) -> None:
    events = read_gait_events(table(tmp_path))
    found = cycles_between(events, "normal", "right")
    assert [(one.style, one.start, one.end) for one in found] == [("slow", 0.0, 1.0), ("fast", 1.0, 2.0)]
    part = cycles_between(events, "normal", "right", 0.6)
    assert [one.end for one in part] == pytest.approx([0.6, 1.6])
    stance = cycles_between(events, "normal", "right", "stance")
    assert [(one.start, one.end) for one in stance] == [(0.0, 0.6), (1.0, 1.7)], "the last strike has no toe off"
    assert cycles_between(events, "other", "right") == []
    without = [each for each in events if each.time != 0.6]
    assert [one.start for one in cycles_between(without, "normal", "right", "stance")] == [1.0], "1.7 s is not its own"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("side, time [s]\nright, 1\n", "no column event"),
        (HEAD + "a, both, heel strike, 1, x\n", "'both' is not a side"),
        (HEAD + "a, right, jump, 1, x\n", "'jump' is no event"),
        (HEAD + 2 * "a, right, heel strike, 1, x\n", "occurs twice"),
    ],
)
def test_tables_that_cannot_be_read(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_gait_events(table(tmp_path, text))


def test_a_channel_of_two_styles_by_hand() -> None:
    """A sine of amplitude 1, and one of 3 that is 10 % later: swing 4, and 10 of 101 steps."""
    time = np.linspace(0.0, 2.0, 2001)
    wave = np.where(time <= 1.0, np.sin(2 * np.pi * time), 3.0 * np.sin(2 * np.pi * (time - 0.1)))
    events = [
        GaitEvent("right", "heel strike", at, "walk", style) for at, style in ((0.0, "a"), (1.0, "b"), (2.0, "b"))
    ]
    cutting = Cutting(Path("events.csv"), tuple(events), None, None)
    trials = cutting.trials_of("walk", time, {"knee [deg]": wave})
    (row,) = shifts_between(trials).to_dict(orient="records")
    assert (row["quantity"], row["unit"], row["style"], row["reference"]) == ("knee", "deg", "b", "a")
    assert row["peak_to_peak_difference"] == pytest.approx(4.0, abs=0.05)
    assert row["later [%]"] == pytest.approx(10.0, abs=0.6)
    mean = trials["knee [deg]"]
    expected = np.sqrt(np.mean((mean["b"][0] - mean["a"][0]) ** 2))
    assert row["rmse"] == pytest.approx(expected) and np.isnan(row["later_lower [%]"])


def test_whose_cycles_count_is_asked_for(tmp_path: Path) -> None:
    cutting = Cutting(Path("events.csv"), read_gait_events(table(tmp_path)), None, None)
    with pytest.raises(InputError, match="events of both sides"):
        cutting.cycles_of("normal")
    assert len(Cutting(cutting.file, cutting.events, "left", None).cycles_of("normal")) == 1
    with pytest.raises(InputError, match="no cycle of the left side in recording 'other'"):
        Cutting(cutting.file, cutting.events, "left", None).cycles_of("other")


SHARES = (0.9, 1.0, 1.1, 1.0 + 1e-9)
"""Shares of four cells in a force: no two are equal, which is asked about."""


def test_load_cells_are_cut_at_the_same_events(tmp_path: Path) -> None:
    time = np.linspace(0.0, 2.0, 201)
    force = np.where(time < 1.0, 200.0, 300.0) * np.sin(np.pi * (time % 1.0)) + 1.0
    cells = {name: share * force for name, share in zip(("PM [N]", "AM [N]", "AL [N]", "PL [N]"), SHARES, strict=True)}
    file = tmp_path / "normal.csv"
    pd.DataFrame({"time [s]": time} | cells).to_csv(file, index=False)
    with pytest.warns(gc.InputWarning, match="one cycle per style"):
        found = gc.load_cells(file, events=table(tmp_path), cycle_side="right", part="60%")
    assert found.table("cycles")["style"].tolist() == ["slow", "fast"]
    assert found.table("cycles")["end [s]"].tolist() == pytest.approx([0.6, 1.6])
    assert found.table("shifts")["peak_to_peak_difference [N]"].iloc[2] == pytest.approx(400.0, rel=0.02)
    with pytest.raises(InputError, match="stance needs toe offs"):
        gc.load_cells(file, cycles="stride", part="stance")
    with pytest.raises(InputError, match="says the cycles again"):
        gc.load_cells(file, cycles="stride", events=table(tmp_path))


def test_coordinates_are_cut_at_toe_offs() -> None:
    """A ramp: 100 % of a stance from 0 to 0.6 s is 0.6; of 60 % of the cycle the same."""
    time = np.linspace(0.0, 2.0, 201)
    strikes, offs = {"right": np.array([0.0, 1.0, 2.0])}, {"right": np.array([0.6, 1.7])}
    found = gait_cycles(time, ("knee_r",), ("deg",), time[:, None], strikes, offs, "stance")
    assert found.curves["knee_r"][:, -1] == pytest.approx([0.6, 1.7]) and found.counts == {"right": 2}
    part = gait_cycles(time, ("knee_r",), ("deg",), time[:, None], strikes, part=0.6)
    assert part.curves["knee_r"][:, -1] == pytest.approx([0.6, 1.6])
