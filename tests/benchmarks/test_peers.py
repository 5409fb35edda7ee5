"""The benchmark runs, and libigl and geocontact agree in it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.engines.clip import clipped_area

ROOT = Path(__file__).resolve().parents[2]


def test_clip_of_one_triangle_in_every_way_of_cutting_it() -> None:
    """Legs of 1: x <= c cuts 1/2 - (1 - c)^2 / 2 off, x >= 1 - c the tip c^2 / 2."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    for turn in range(3):
        face = np.roll([[0, 1, 2]], turn, axis=1)
        for c in (0.2, 0.5, 0.9):
            below = clipped_area(face, np.array([0.5]), corners[:, 0], c)
            above = clipped_area(face, np.array([0.5]), -corners[:, 0], c - 1.0)
            assert below == pytest.approx(0.5 - 0.5 * (1.0 - c) ** 2, rel=1e-14)
            assert above == pytest.approx(0.5 * c**2, rel=1e-14)


@pytest.mark.slow
@pytest.mark.long
def test_small_run_agrees_with_libigl(tmp_path: Path) -> None:
    options = ["--faces", "3000", "--frames", "5", "--rounds", "1", "--no-memory", "--only", "libigl", "--out"]
    command = [sys.executable, "-m", "benchmarks.area.peers", *options, str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rows = {row["engine"]: row for row in json.loads((tmp_path / "peers-knee.json").read_text())["rows"]}
    ours = rows["geocontact, map + clip"]
    assert 1e3 * ours["max_distance_error_m"] <= 1e-9
    assert ours["relative_area_error"] <= 1e-9
    assert "libigl AABB" in done.stdout
