"""The long run against peers: poses, whose frames are done and how they are scaled, and what counts as met."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.area.long_run_peers import AIMS, LIBIGL, OPEN3D, WARP, compared, largest_difference, long_pair, measured
from benchmarks.engines.engine import Engine, Frame
from benchmarks.engines.ours import FRAMES, OURS, engines
from benchmarks.pairs import ROOT, knee
from geocontact.io.motion.poses import motion_from_csv


def test_poses_are_those_recorded_and_interpolated_between_them() -> None:
    recorded = len(motion_from_csv(ROOT / "meshes" / "gait.csv"))
    pair, plain = long_pair(1500, 2 * recorded - 1), knee(1500, recorded)
    assert pair.rotation[::2] == pytest.approx(plain.rotation, abs=1e-9)
    assert pair.translation[::2] == pytest.approx(plain.translation, abs=1e-12)
    turns = np.einsum("tij,tik->tjk", pair.rotation, pair.rotation)
    assert turns == pytest.approx(np.broadcast_to(np.eye(3), turns.shape), abs=1e-12)
    middle = 0.5 * (plain.translation[:-1] + plain.translation[1:])
    assert np.abs(pair.translation[1::2] - middle).max() < 0.5e-3


def test_peers_do_some_frames_and_geocontact_all_of_them() -> None:
    pair, asked = long_pair(1500, 11), []

    def prepare(_: object):
        def step(k: int) -> Frame:
            asked.append(k)
            return Frame(None, 2.0 * k, 0.0)

        return step

    def missing(_: object):
        raise ImportError("no such library")

    ours = [engine for engine in engines() if engine.name in (OURS, FRAMES)]
    lines: list[str] = []
    rows = [*ours, Engine("peer", "", prepare), Engine("absent", "", missing)]
    found = measured(pair, rows, 4, lines.append)
    assert asked == [0, 0, 4, 8], "the first is not measured"
    assert {name: row["frames"] for name, row in found.items()} == {OURS: 11, FRAMES: 11, "peer": 3}
    assert found["peer"]["area"].tolist() == [0.0, 8.0, 16.0]
    assert any("absent: skipped, no such library" in line for line in lines)
    clip, refined = found[OURS]["area"], found[FRAMES]["area"]
    assert largest_difference(refined, clip) < 1.0, "coarse triangles, cut once or divided"
    step = ours[0].prepare(pair)
    assert clip.tolist() == [step(k).area for k in (0, 4, 8)]


def test_an_aim_is_met_by_time_and_by_area() -> None:
    area = np.array([1.0, 2.0, 0.0])

    def row(seconds: float, off: float = 0.0) -> dict:
        return {"cpu_s": seconds, "frames": 3, "area": area * (1.0 + 0.01 * off)}

    found = {OURS: row(1.0), FRAMES: row(4.0, 0.05), LIBIGL: row(50.0), OPEN3D: row(50.0, 0.2), WARP: row(0.9)}
    table = compared(found, LIBIGL)
    assert table[LIBIGL]["ratio"] == 12.5 and table[LIBIGL]["met"]
    assert table[LIBIGL]["ratio_to_map_and_clip"] == 50.0
    assert table[OPEN3D]["ratio"] > AIMS[OPEN3D][1] and not table[OPEN3D]["met"], "areas are not the same"
    assert table[WARP]["ratio"] == 0.9 and not table[WARP]["met"]
    assert table[FRAMES]["largest_area_difference_percent"] == pytest.approx(0.05)
    assert largest_difference(np.array([1.0]), np.array([0.0])) == np.inf
