"""How much a held coordinate counts beside markers: as in OpenSim, whose solver finds the same angles."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

import geocontact as gc
from geocontact.data.errors import InputWarning
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.dynamics.inverse_kinematics import inverse_kinematics
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.io.mocap.markers import read_markers
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_multibody import read_multibody
from tests import opensim_oracle
from tests.cli.calls import MESHES
from tests.elsewhere import Elsewhere

LEG = MESHES / "leg.osim"
WEIGHT, WANTED = 0.01, 0.6


def noisy(folder: Path) -> tuple[Tree, MarkerTrajectories, dict[str, float]]:
    """Markers of the shipped leg with 5 mm of noise, and uneven weights."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        gc.virtual_markers(MESHES / "leg_swing.mot", model=LEG).write(folder / "markers")
    exact = read_markers(folder / "markers" / "markers.trc")
    rng = np.random.default_rng(0)
    moved = exact.positions + rng.normal(0.0, 5e-3, exact.positions.shape)
    write_trc(folder / "noisy.trc", replace(exact, positions=moved))
    seen = read_markers(folder / "noisy.trc")
    return tree_of(read_multibody(LEG)), seen, {name: float(rng.uniform(1.0, 20.0)) for name in seen.names}


def test_held_coordinates_count_as_in_opensim(opensim: Elsewhere, tmp_path: Path) -> None:
    tree, seen, weights = noisy(tmp_path)
    held: dict[str, tuple[float, float | None]] = {tree.names[-1]: (WEIGHT, WANTED)}
    frames = list(range(0, len(seen), 20))
    ours = inverse_kinematics(tree, seen, MarkerTasks(weights, held)).values[frames]
    given = (LEG, tmp_path / "noisy.trc", weights, held, seen.time[frames].tolist(), tree.names, 1e-9)
    _, theirs = opensim(opensim_oracle.inverse_kinematics, *given)
    assert np.degrees(np.abs(ours - theirs)).max() < 1e-3


def test_markers_with_other_units_of_weight_change_nothing(tmp_path: Path) -> None:
    """A common factor of the markers' weights leaves a held coordinate where it is; it pulls by degrees."""
    tree, seen, weights = noisy(tmp_path)
    held: dict[str, tuple[float, float | None]] = {tree.names[-1]: (WEIGHT, WANTED)}
    tens = {name: 10.0 * weight for name, weight in weights.items()}
    found = [inverse_kinematics(tree, seen, MarkerTasks(each, held)).values for each in (weights, tens)]
    np.testing.assert_allclose(*found, atol=1e-7)
    free = inverse_kinematics(tree, seen, MarkerTasks(weights)).values
    assert np.degrees(np.abs(found[0] - free)).max() > 1.0
