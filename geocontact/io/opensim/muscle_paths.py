"""Moment arms and lines of action of a model's muscles, asked of the opensim package in a process of its own.

Its libraries and CasADi's do not load into one process. The extra `muscles` brings the package.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.module_folders import searching


@dataclass(frozen=True, eq=False)
class MusclePaths:
    """Muscles of a model along a motion.

    Parameters
    ----------
    names
        As the model has them.
    strongest
        Largest isometric force of each [N].
    arms
        Moment arms about each coordinate [m]; without a unit along one that is a length.
    pulls
        Direction sum of each muscle's tension on the bodies beyond a joint, in the ground's frame [-]; zero for one
        that does not cross it.
    """

    names: tuple[str, ...]
    strongest: Float[np.ndarray, " m"]
    arms: Float[np.ndarray, "t m n"]
    pulls: Float[np.ndarray, "t m 3"]


INSTALL = "pip install 'geocontact[muscles]' (Python 3.11 or 3.12 on Linux x86-64, Windows or macOS)"


def require_opensim() -> None:
    """InputError where the opensim package is not installed."""
    if find_spec("opensim") is None:
        raise InputError("", "`muscles`", "needs the opensim package", INSTALL)


def muscle_paths(
    model: Path, coordinates: Sequence[str], values: Float[np.ndarray, "t n"], beyond: Sequence[str]
) -> MusclePaths:
    """Paths of all muscles of a model (.osim).

    Parameters
    ----------
    coordinates, values
        Names, and values over time [rad, m].
    beyond
        Bodies on the far side of a joint; none for pulls of zero.
    """
    require_opensim()
    with TemporaryDirectory() as folder:
        asked, found = Path(folder) / "asked.npz", Path(folder) / "found.npz"
        given = {"model": str(model.absolute()), "names": list(coordinates), "values": values, "beyond": list(beyond)}
        np.savez(asked, **given)  # type: ignore[arg-type]
        program = f"from {__name__} import answer; answer({str(asked)!r}, {str(found)!r})"
        run = subprocess.run(
            [sys.executable, "-P", "-c", searching(program)], cwd=folder, capture_output=True, text=True, check=False
        )
        if run.returncode or not found.is_file():
            why = (run.stderr.strip().splitlines() or ["it ended without a word"])[-1]
            raise InputError(model, "", f"opensim does not answer: {why}", "open the model in OpenSim")
        told = np.load(found)
        names = tuple(map(str, told["names"]))
        if not names:
            raise InputError(model, "", "has no muscles", "give a model that has some")
        return MusclePaths(names, told["strongest"], told["arms"], told["pulls"])


def answer(asked: str, found: str) -> None:
    """What runs in the other process: reads what is asked, writes what opensim says."""
    import opensim

    opensim.Logger.setLevelString("Off")
    given = np.load(asked)
    model = opensim.Model(str(given["model"]))
    state = model.initSystem()
    every = model.getCoordinateSet()
    coordinates = [every.get(str(name)) for name in given["names"]]
    beyond = {str(name) for name in given["beyond"]}
    muscles = [model.getMuscles().get(k) for k in range(model.getMuscles().getSize())]
    frames, values = len(given["values"]), given["values"]
    arms = np.zeros((frames, len(muscles), len(coordinates)))
    pulls = np.zeros((frames, len(muscles), 3))
    for t in range(frames):
        for coordinate, value in zip(coordinates, values[t], strict=True):
            coordinate.setValue(state, float(value), False)
        model.assemble(state)
        model.realizePosition(state)
        for m, muscle in enumerate(muscles):
            arms[t, m] = [muscle.computeMomentArm(state, each) for each in coordinates]
            if beyond:
                pulls[t, m] = _pull(opensim, muscle, state, beyond)
    strongest = [muscle.getMaxIsometricForce() for muscle in muscles]
    np.savez(found, names=[each.getName() for each in muscles], strongest=strongest, arms=arms, pulls=pulls)


def _pull(opensim: Any, muscle: Any, state: Any, beyond: set[str]) -> Float[np.ndarray, " 3"]:
    """Sum of the unit forces of its path's points on these bodies."""
    points = opensim.ArrayPointForceDirection()
    muscle.getGeometryPath().getPointForceDirections(state, points)
    total = np.zeros(3)
    for k in range(points.getSize()):
        point = points.get(k)
        if point.frame().findBaseFrame().getName() in beyond:
            direction = point.direction()
            total += [direction.get(axis) for axis in range(3)]
    return total
