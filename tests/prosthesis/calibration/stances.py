"""A stance whose numbers are planted, and the files that a laboratory would have of it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from benchmarks.keel_stance import WEIGHT, stance
from geocontact.prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.prosthesis.keel.vsf import fulcrum_of
from geocontact.prosthesis.keel.vsf_foot import VariableStiffnessFoot, vsf_foot

FACTORS = np.array([1.2, 1.5, 0.7, 0.6, 1.1, 1.3, 0.7, 1.4, 1.2, 0.8, 0.9, 1.1, 1.2, 0.8, 0.95])
"""Planted numbers over the usual ones."""
PLATE_GATE = 30.0


def planted() -> tuple[ZoneParameters, np.ndarray]:
    """Zones and the planted numbers."""
    foot = vsf_foot()
    zones = ZoneParameters(foot.sole, foot.law)
    return zones, FACTORS * zones.values_of(foot.law)


@lru_cache(maxsize=2)
def recorded(noise: float = 1.0) -> RecordedStance:
    """On the planted sole, the plate's errors `noise` times their size; poses are exact."""
    foot, fulcrum = vsf_foot(), fulcrum_of("medium")
    moved = stance(foot, fulcrum)
    frames = len(moved.time)
    blank = RecordedStance(
        moved.time, moved.poses, moved.rate, fulcrum, np.zeros((frames, 3)), np.zeros(frames), WEIGHT
    )
    zones, values = planted()
    true = VariableStiffnessFoot(foot.keel, foot.sole, zones.law(values)).at(fulcrum)
    shown = blank.predicted(true, blank.solved(true))
    rng, e = np.random.default_rng(1), blank.errors
    force = shown[:, :3] + noise * e.force * rng.standard_normal((frames, 3))
    off = noise * e.couple / np.maximum(force[:, 1], 1.0) / foot.keel.length * rng.standard_normal(frames)
    return replace(blank, force=force, centre=np.where(force[:, 1] > PLATE_GATE, shown[:, 3] + off, np.nan))


def laboratory_files(folder: Path, one: RecordedStance) -> tuple[Path, Path]:
    """Poses (.csv) and the plate (.mot)."""
    turn, place = one.poses.rotation.as_quat()[:, [3, 0, 1, 2]], 1e3 * one.poses.translation
    rows = np.column_stack([one.time, place, turn])
    poses = folder / "poses.csv"
    head = "time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"
    np.savetxt(poses, rows, delimiter=",", header=head, comments="", fmt="%.12g")
    forward = one.poses.rotation.apply([1.0, 0.0, 0.0])
    forward[:, 1] = 0.0
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)
    length = vsf_foot().keel.length
    under = one.poses.translation + np.nan_to_num(one.centre)[:, None] * length * forward
    under[:, 1] = 0.0
    names = [f"ground_force_{kind}{axis}" for kind in "vp" for axis in "xyz"]
    names += [f"ground_torque_{axis}" for axis in "xyz"]
    table = np.column_stack([one.time, one.force, under, np.zeros_like(under)])
    plate = folder / "plate.mot"
    text = f"plate\nversion=1\nnRows={len(table)}\nnColumns={table.shape[1]}\ninDegrees=yes\nendheader\n"
    header = text + "\t".join(["time", *names])
    np.savetxt(plate, table, delimiter="\t", header=header, comments="", fmt="%.12g")
    return poses, plate
