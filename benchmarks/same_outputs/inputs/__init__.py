"""Samples that the runs read: the shipped ones and small ones made beside them, the same bytes at every call.

Nothing here imports geocontact, so that a fault of the checkout under test cannot change its own inputs.
"""

from __future__ import annotations

import shutil
from pathlib import Path

from benchmarks.same_outputs.inputs import area, elbow, exports, foot, gap, gather, knee, leg, mats, overhead, walk

SHIPPED = (
    "*.stl",
    "*.csv",
    "*.mot",
    "*.osim",
    "knee_pairs.toml",
    "resting_knee.toml",
    "foot_bench/*",
    "whole_body/*",
    "mat_*/*",
    "overhead_*/*",
    "gait_P1_*/*",
    "amputee_P1/*",
    "standing_up*/*",
)


def make(folder: Path, meshes: Path) -> None:
    """All samples, in `folder`."""
    for pattern in SHIPPED:
        for file in sorted(meshes.glob(pattern)):
            there = folder / "meshes" / file.relative_to(meshes)
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, there)
    for kind in (area, knee, foot, leg, mats, exports, elbow, gap, gather, walk, overhead):
        home = folder / kind.__name__.rpartition(".")[2]
        home.mkdir(parents=True, exist_ok=True)
        kind.make(home, folder / "meshes")
