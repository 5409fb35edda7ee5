"""Recordings of an arm in a misaligned exoskeleton, in plain numpy from points in the plane and the cuff's energy.

Nothing here comes from the package: the attachment is a point, the forearm's angle is that of the line to it, force
and moment are derivatives of the energy that the cuff stores.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

TRUE = {"k": 240.0, "x": 0.045, "y": 0.055, "l": 0.18, "z": 0.11}
"""SI units; another arm than the paper's."""
SMALL = 1e-6


def angle_of_arm(beta: np.ndarray, n: Mapping[str, float]) -> np.ndarray:
    """Flexion of the forearm [rad]: the direction of the attachment seen from the elbow."""
    across, along = n["l"] * np.sin(beta) - n["x"], n["y"] + n["l"] * np.cos(beta)
    return np.arctan2(across, along)


def energy(reach: np.ndarray, turn: np.ndarray, n: Mapping[str, float], turning: float) -> np.ndarray:
    """Of the cuff [J] where the attachment is `reach` [m] from the elbow and the link turned by `turn` to the arm."""
    straight = n["y"] + np.sqrt(n["l"] ** 2 - n["x"] ** 2)
    pushed = straight - reach - n["z"] * np.tan(turn)
    return np.asarray(0.5 * n["k"] * pushed**2 + 0.5 * turning * turn**2)


def loads(beta: np.ndarray, n: Mapping[str, float], turning: float) -> tuple[np.ndarray, np.ndarray]:
    """Force along the forearm [N] and moment about the attachment [N m]: the energy's derivatives."""
    reach = np.hypot(n["l"] * np.sin(beta) - n["x"], n["y"] + n["l"] * np.cos(beta))
    turn = beta - angle_of_arm(beta, n)
    by_reach = energy(reach + SMALL, turn, n, turning) - energy(reach - SMALL, turn, n, turning)
    by_turn = energy(reach, turn + SMALL, n, turning) - energy(reach, turn - SMALL, n, turning)
    return -by_reach / (2.0 * SMALL), by_turn / (2.0 * SMALL)


def remembered(count: int, rng: np.random.Generator) -> np.ndarray:
    """A force [N] that a person adds: 0.2 N, each sample 0.8 of the one before and something new."""
    added, new = np.empty(count), 0.2 * rng.standard_normal(count)
    added[0] = new[0]
    for k in range(1, count):
        added[k] = 0.8 * added[k - 1] + 0.6 * new[k]
    return added


def record(
    folder: Path,
    trials: int = 3,
    turning: float = 0.0,
    level: float = 0.0,
    moment: bool = True,
    alpha: bool = True,
    numbers: Mapping[str, float] = TRUE,
    sign: float = 1.0,
    seed: int = 11,
) -> tuple[Path, ...]:
    """Tables of some trials: angle, force, and what else was measured.

    What the person adds to the force passes through the cuff and is in the moment too; sensors of moment and angle have
    white noise of their own, the angle's zero is off by `level` [rad] and half of it more with each trial.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rng, files = np.random.default_rng(seed), []
    for trial in range(trials):
        time = np.arange(0.0, 20.0, 0.02)
        beta = np.radians(50.0 + 40.0 * np.sin(2.0 * np.pi * (0.23 + 0.04 * trial) * time + trial))
        force, turned = loads(beta, numbers, turning)
        added = remembered(len(time), rng)
        turn = beta - angle_of_arm(beta, numbers)
        columns = {"time [s]": time, "beta [deg]": np.degrees(beta), "force [N]": force + added}
        if moment:
            own = turned - added * numbers["z"] / np.cos(turn) ** 2
            columns["moment [N m]"] = sign * (own + 0.02 * rng.standard_normal(len(time)))
        if alpha:
            shown = beta - turn + level * (1.0 + 0.5 * trial) + np.radians(0.5) * rng.standard_normal(len(time))
            columns["alpha [deg]"] = np.degrees(shown)
        files.append(folder / f"arm_{trial + 1}.csv")
        pd.DataFrame(columns).to_csv(files[-1], index=False)
    return tuple(files)
