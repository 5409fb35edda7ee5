"""Markers of one rigid body whose names are exchanged, without a file or a command."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.multibody.joint import free
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import GROUND, Body, Marker, Multibody
from geocontact.dynamics.exchanged_markers import exchanged_markers
from geocontact.dynamics.inverse_kinematics import inverse_kinematics
from geocontact.dynamics.tree import tree_of

PLACES = {"RASI": (0.0, 0.0, 0.12), "LASI": (0.0, 0.0, -0.12), "high": (0.02, 0.2, 0.03), "ahead": (0.15, 0.0, 0.0)}


def test_only_markers_in_each_other_s_place_are_found() -> None:
    """Exchanged they fit to nothing; as they are, or with a limit that allows the distances, nothing is said."""
    markers = tuple(Marker(name, "pelvis", np.array(place)) for name, place in PLACES.items())
    bodies = (Body("pelvis", 1.0, np.zeros(3), np.eye(3)),)
    model = Multibody("one body", bodies, (free("base", GROUND, "pelvis"),), markers, np.array([0.0, -9.81, 0.0]))
    time, values = np.arange(3) / 100.0, np.zeros((3, 6))
    values[:, 2], values[:, 3] = [0.0, 0.05, 0.1], 0.3
    seen = MarkerTrajectories(time, model.marker_places(values), tuple(PLACES))
    tree, tasks = tree_of(model), MarkerTasks(dict.fromkeys(PLACES, 1.0))
    assert exchanged_markers(tree, seen, tasks, inverse_kinematics(tree, seen, tasks), 0.02, 0.04) is None
    wrong = seen.renamed({"high": "ahead", "ahead": "high"})
    found = inverse_kinematics(tree, wrong, tasks)
    exchanged = exchanged_markers(tree, wrong, tasks, found, 0.02, 0.04)
    assert exchanged is not None and [set(pair) for pair in exchanged.pairs] == [{"high", "ahead"}]
    assert exchanged.before == pytest.approx(np.sqrt(np.mean(found.distances[[0, 2]] ** 2)), rel=1e-3)
    assert exchanged.after < 1e-5
    assert exchanged_markers(tree, wrong, tasks, found, 1.0, 1.0) is None
