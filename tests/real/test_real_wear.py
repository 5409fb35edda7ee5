"""Wear of a real insert at rest under a load, against force times path of its centres of pressure by hand."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc

DM = "gc6_dm_knee/stl"
K = 1e-16
"""m^2/N."""


@pytest.mark.slow
def test_dm_wears_factor_times_force_times_path(data_dir: Path, tmp_path: Path) -> None:
    """Swept from 0 to 40 deg under 2000 N; a side's contact is small, so that its path is that of its centre."""
    bodies = [data_dir / DM / f"{name} decimated.stl" for name in ("Femoral Component", "Tibial Insert")]
    layer = {"modulus": gc.MPa(463), "poisson": 0.46, "region": "ny>0.25", "piece": gc.mm(1)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        sweep = ("flexion", 0.0, gc.deg(40), gc.deg(5))
        settled = gc.knee.settle(*bodies, unit="m", side="right", sweep=sweep, load=2000.0, **layer)
        settled.write(tmp_path / "settled")
        found = gc.pressure(
            *bodies,
            unit="m",
            motion=str(tmp_path / "settled" / "poses.csv"),
            split="z",
            side="right",
            rule="clip",
            wear_factor=K,
            **layer,
        )
    table, poses = found.table("pressure"), found.motions[0].motion.poses
    work = 0.0
    for side in ("medial", "lateral"):
        force = table[f"force_{side} [N]"].to_numpy()
        centre = table[[f"cop_{side}_{axis} [mm]" for axis in "xyz"]].to_numpy() * 1e-3
        for k in range(len(table) - 1):
            turn = poses[k + 1].rotation * poses[k].rotation.inv()
            middle = 0.5 * (centre[k] + centre[k + 1])
            there = turn.apply(middle - poses[k].translation) + poses[k + 1].translation
            halfway = Rotation.from_rotvec(-0.5 * turn.as_rotvec())  # the chord, turned back by half the angle
            slid = halfway.apply(there - middle)
            work += 0.5 * (force[k] + force[k + 1]) * np.hypot(slid[0], slid[2])
    worn = found.record.results["wear"]
    assert worn["force_times_path_J_per_cycle"] == pytest.approx(work, rel=0.1)
    assert worn["volume_mm3"] == pytest.approx(1e9 * K * 1e6 * worn["force_times_path_J_per_cycle"], rel=1e-9)
    assert any("the motion does not end where it begins" in line for line in found.warnings)
    assert 0.0 < worn["deepest_mm"] < 1.0 and 0.0 <= worn["cross_shear_ratio"] < 0.2
