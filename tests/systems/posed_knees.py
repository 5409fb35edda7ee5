"""The sample knee as a chain: meshes, poses of its synthetic cycle, systems and trials."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from geocontact.chain.system import System
from geocontact.data.gap_case import CaseMesh
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.motion.poses import motion_from_csv
from geocontact.systems import knee_full_chain as knee_chain
from geocontact.systems.knee_posed import POSE

MESHES = Path(__file__).resolve().parents[2] / "meshes"
CONSTANTS = {"R": 0.037, "threshold": 4e-3, "side": 1.0, "cell_posterior": -0.015, "cell_anterior": 0.015}
E_STAR = Parameter("E_star", "Pa", 3e6, 1e5, 1e8)
UNITS = ("rad",) * 3 + ("m",) * 3


@cache
def bodies(side: str = "right") -> dict[str, CaseMesh]:
    """Coarse femoral component and insert."""
    names = {"moving": f"femoral_component_{side}_coarse.stl", "fixed": f"tibial_insert_{side}_coarse.stl"}
    return {name: CaseMesh(read_mesh(MESHES / file, "mm"), "", 1e-3) for name, file in names.items()}


def poses(every: int = 16) -> tuple[np.ndarray, np.ndarray]:
    """Times and coordinates (6, t) of the right knee's cycle."""
    motion = motion_from_csv(MESHES / "gait.csv")
    turned, tilted, bent = motion.poses.rotation.as_euler("YXZ").T
    pose = np.array([bent, -tilted, -turned, *np.asarray(motion.poses.translation).T])
    return motion.time[::every], pose[:, ::every].copy()


def chain(outputs: tuple[str, ...] = knee_chain.CELL_NAMES, **constants: float) -> System:
    given = {**CONSTANTS, **constants}
    side = "right" if given["side"] > 0.0 else "left"
    if outputs != knee_chain.CELL_NAMES:
        given = {name: value for name, value in given.items() if not name.startswith("cell")}
    return knee_chain.build((E_STAR,), given, {}, bodies(side), outputs)


def trial(name: str, time: np.ndarray, pose: np.ndarray, outputs: tuple[str, ...] = knee_chain.CELL_NAMES) -> Trial:
    values = np.column_stack([pose.T, np.full((len(time), len(outputs)), np.nan)])
    return Trial(name, Signals(time, values, (*POSE, *outputs), UNITS + ("N",) * len(outputs)))
