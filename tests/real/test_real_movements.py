"""Real recordings cut into their movements: five squats of OpenCap, by the height of the pelvis."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.io.text.tables import read_table
from geocontact.standing_up.movements import movements_of


def test_five_squats_of_one_recording_are_found(data_dir: Path) -> None:
    """Each between the minima and maxima that eyes find: tops at 0 and 8 s, and four between 1.6 and 6.4 s."""
    table = read_table(data_dir / "opencap" / "squats1_videoAndMocap.mot")
    height = table.column("pelvis_ty")
    found = movements_of(table.time, height, np.zeros(len(height)))
    assert [one.kind for one in found] == ["squat"] * 5 and all(one.agrees for one in found)
    inner = (height[1:-1] < height[:-2]) & (height[1:-1] <= height[2:]) & (height[1:-1] < 0.9)
    bottoms = table.time[1:-1][inner]
    for one in found:
        inside = bottoms[(bottoms > one.start) & (bottoms < one.end)]
        assert len(inside) and abs(0.5 * (one.start + one.end) - inside.mean()) < 0.15
        assert 0.3 < -one.rise < 0.45 and 1.0 < one.end - one.start < 1.6
    assert [one.kind for one in movements_of(table.time, height)] == ["going down", "rising"] * 5
    assert [one.kind for one in movements_of(table.time, height, squats=True)] == ["squat"] * 5
