"""Areas over gait cycles: cut at the events that kinematics and load cells are cut at."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from tests.analyses.area.calls import area
from tests.cli.calls import PLATE, SPHERE, poses

EVENTS = """recording, side, event, time [s], style
normal, right, heel strike, 0.0, slow
normal, right, toe off, 0.6, slow
normal, right, heel strike, 1.0, fast
normal, right, toe off, 1.7, fast
normal, right, heel strike, 2.0, fast
normal, left, heel strike, 0.5, slow
"""


def test_areas_are_cut_at_the_same_events(tmp_path: Path) -> None:
    """A ball that comes down to 20 mm and goes up again, twice; one cycle each of two styles."""
    events = tmp_path / "events.csv"
    events.write_text(EVENTS)
    times = np.linspace(0.0, 2.0, 9)
    heights = 20.5 - 0.5 * np.sin(np.pi * times) ** 2 * np.where(times < 1.0, 0.5, 1.0)
    rows = [f"{t},0,{h},0,1,0,0,0" for t, h in zip(times, heights, strict=True)]
    motion = tmp_path / "normal.csv"
    motion.write_text("time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n" + "\n".join(rows) + "\n")
    found = area(SPHERE, PLATE, motion, rule="clip", events=events, cycle_side="right", threshold=(1e-3,))
    cycles = found.table("cycles")
    own = cycles[cycles["quantity"] == "area_fixed at 1 mm"].set_index(["style", "cycle [%]"])["mean"]
    assert own["slow", 50.0] == pytest.approx(1e6 * found.area[2, 0]) and own["fast", 50.0] > own["slow", 50.0]
    shifts = found.table("shifts").set_index("quantity").loc["area_fixed at 1 mm"]
    swing = 1e6 * (np.ptp(found.area[4:, 0]) - np.ptp(found.area[:5, 0]))
    assert shifts["peak_to_peak_difference"] == pytest.approx(swing) and shifts["reference"] == "slow"
    stance = area(
        SPHERE, PLATE, motion, rule="clip", events=events, cycle_side="right", part="stance", threshold=(1e-3,)
    )
    half = stance.table("cycles").set_index(["quantity", "style", "cycle [%]"])["mean"]
    assert half["area_fixed at 1 mm", "slow", 100.0] == pytest.approx(1e6 * np.interp(0.6, times, found.area[:, 0]))


def test_events_of_another_recording_are_refused(tmp_path: Path) -> None:
    events = tmp_path / "events.csv"
    events.write_text(EVENTS)
    with pytest.raises(InputError, match="no cycle of the right side in recording 'other'"):
        area(SPHERE, PLATE, poses(tmp_path, (0, 20, 0), name="other.csv"), events=events, cycle_side="right")
    with pytest.raises(InputError, match="has no effect without `events`"):
        area(SPHERE, PLATE, poses(tmp_path, (0, 20, 0)), part=0.6)
