"""Coordinates from markers: planted poses are found again, limits are kept, gaps are passed over."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import casadi
import numpy as np
import pytest

from benchmarks.dynamics.full_body import write_full_body
from geocontact.data.multibody.joint import Coordinate
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Marker, Multibody
from geocontact.dynamics.inverse_kinematics import MarkerFit, inverse_kinematics
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.io.opensim.osim_multibody import read_multibody
from tests.dynamics.models import all_kinds

FRAMES = 40
EVEN = MarkerTasks({m.name: 1.0 for m in all_kinds().markers})


@pytest.fixture(scope="module")
def tree() -> Tree:
    return tree_of(all_kinds())


def planted(tree: Tree, noise: float = 0.0, seed: int = 3) -> tuple[np.ndarray, MarkerTrajectories]:
    """A smooth synthetic motion and where its markers are."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0.0, 1.0, FRAMES)
    swing = rng.uniform(0.1, 0.5, len(tree.names)) * np.sin(
        2.0 * np.pi * (time[:, None] + rng.uniform(size=len(tree.names)))
    )
    fit = MarkerFit(tree, tree.model.markers)
    places = np.stack([fit.places(q) for q in swing])
    places += noise * rng.normal(size=places.shape)
    return swing, MarkerTrajectories(time, places, tuple(m.name for m in tree.model.markers))


def with_coordinate(model: Multibody, name: str, **changes: object) -> Multibody:
    def changed(c: Coordinate) -> Coordinate:
        return replace(c, **changes) if c.name == name else c

    joints = tuple(replace(j, coordinates=tuple(changed(c) for c in j.coordinates)) for j in model.joints)
    return replace(model, joints=joints)


def test_a_planted_motion_is_found(tree: Tree) -> None:
    """To a hundredth of a degree, here far better."""
    wanted, seen = planted(tree)
    found = inverse_kinematics(tree, seen, EVEN)
    assert found.settled.all()
    assert np.max(np.abs(found.values - wanted)) < 1e-8
    assert np.max(found.distances) < 1e-8
    assert found.names == tree.names


def test_what_is_found_is_a_minimum(tree: Tree) -> None:
    """With noise the gradient is nothing and no step to any side leads down."""
    _, seen = planted(tree, noise=0.02)
    found = inverse_kinematics(tree, seen, EVEN)
    fit = MarkerFit(tree, tree.model.markers)
    none, ones = np.zeros(len(tree.names)), np.ones(len(tree.model.markers))
    for q, observed in zip(found.values[::10], seen.positions[::10], strict=True):
        gradient, cost = fit.slope(q, (observed, ones, none, none))
        assert np.max(np.abs(gradient)) < 1e-6
        for k in range(len(q)):
            for step in (-1e-3, 1e-3):
                assert fit.slope(q + step * np.eye(len(q))[k], (observed, ones, none, none))[1] > cost


def test_curvature_and_slope_are_derivatives_of_the_cost(tree: Tree) -> None:
    rng = np.random.default_rng(5)
    n, m = len(tree.names), len(tree.model.markers)
    fit = MarkerFit(tree, tree.model.markers)
    q, against = (
        rng.normal(size=n) * 0.3,
        (rng.normal(size=(m, 3)), rng.uniform(size=m), rng.normal(size=n), np.ones(n)),
    )
    slope, step = fit.slope(q, against)[0], 1e-6
    sides = [[fit.slope(q + s * step * e, against) for s in (1.0, -1.0)] for e in np.eye(n)]
    np.testing.assert_allclose(slope, [(a[1] - b[1]) / (2 * step) for a, b in sides], rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(
        fit.curvature(q, against), np.array([(a[0] - b[0]) / (2 * step) for a, b in sides]), rtol=1e-5, atol=1e-5
    )


def test_gaps_are_passed_over(tree: Tree) -> None:
    """A marker lost for a while costs nothing where the others tell; its distance is not stated."""
    wanted, seen = planted(tree)
    lost = seen.positions.copy()
    lost[10:20, 3] = np.nan
    lost[15, :4] = np.nan  # all markers of one body: others hold its joints or the last frame does
    found = inverse_kinematics(tree, replace(seen, positions=lost), EVEN)
    assert np.isnan(found.distances[10:20, 3]).all()
    assert np.isfinite(found.distances[20:]).all()
    kept = [i for i in range(FRAMES) if i != 15]
    assert np.max(np.abs(found.values[kept] - wanted[kept])) < 1e-7


def test_a_clamped_coordinate_stays_within_its_limits(tree: Tree) -> None:
    wanted, seen = planted(tree)
    k = tree.names.index("s")
    limit = 0.5 * float(np.max(wanted[:, k]))
    clamped = tree_of(with_coordinate(tree.model, "s", limits=(-limit, limit), clamped=True))
    found = inverse_kinematics(clamped, seen, EVEN)
    assert found.settled.all()
    assert np.max(np.abs(found.values[:, k])) <= limit
    beyond = np.abs(wanted[:, k]) > limit
    np.testing.assert_allclose(np.abs(found.values[beyond, k]), limit)
    free = inverse_kinematics(tree, seen, EVEN)
    assert np.max(np.abs(free.values[:, k])) > limit


def test_a_locked_coordinate_stays_at_its_default(tree: Tree) -> None:
    _, seen = planted(tree)
    locked = tree_of(with_coordinate(tree.model, "a", default=0.2, locked=True))
    found = inverse_kinematics(locked, seen, EVEN)
    assert found.settled.all()
    np.testing.assert_array_equal(found.values[:, tree.names.index("a")], 0.2)


def test_what_no_marker_tells_costs_no_steps(tmp_path: Path) -> None:
    """Hands and toes of a whole body without markers: named, at their default, and the search as short as with them."""
    tree = tree_of(read_multibody(write_full_body(tmp_path / "body.osim")))
    swing = 0.3 * np.sin(np.linspace(0.0, 0.5, 8)[:, None] + np.arange(len(tree.names)))
    values = tree.model.coupled(swing)
    seen = MarkerTrajectories(
        np.arange(8) / 100.0, tree.model.marker_places(values), tuple(m.name for m in tree.model.markers)
    )
    found = inverse_kinematics(tree, seen, MarkerTasks({m.name: 1.0 for m in tree.model.markers}))
    lost = {f"{name}_{side}" for name in ("mtp_angle", "wrist_flex", "wrist_dev") for side in "rl"}
    told = found.determined.all(axis=0)
    assert {name for name, each in zip(tree.names, told, strict=True) if not each} == lost
    np.testing.assert_allclose(found.values[:, told], values[:, told], atol=1e-7)
    assert not found.values[:, ~told].any() and found.steps[1:].mean() < 8.0


def test_an_arm_is_found_though_its_markers_hardly_tell_the_pronation(tmp_path: Path) -> None:
    """One marker at the elbow and one near the axis at the wrist, as of a camera: elbow and shoulder make up for a turn
    of the forearm. It stays at its default, alone, and the arm is where it was.
    """
    body = read_multibody(write_full_body(tmp_path / "body.osim"))
    spots = {"elbow": ("ulna_r", (0.0, 0.0, 0.0)), "wrist": ("radius_r", (-0.009, -0.236, 0.02))}
    few = tuple(Marker(name, at, np.array(place)) for name, (at, place) in spots.items())
    tree = tree_of(
        replace(body, markers=tuple(m for m in body.markers if "torso" in m.name or "pelvis" in m.name) + few)
    )
    arm = [name for name in tree.names if name.endswith("_r") and name.startswith(("arm", "elbow"))]
    values = np.zeros((12, len(tree.names)))
    for k, name in enumerate(arm):
        values[:, tree.names.index(name)] = 0.8 + 0.2 * np.sin(0.2 * np.arange(12) + k)
    names = tuple(m.name for m in tree.model.markers)
    places = tree.model.marker_places(values)
    places += 1e-3 * np.random.default_rng(7).normal(size=places.shape)
    seen = MarkerTrajectories(np.arange(12) / 100.0, places, names)
    found = inverse_kinematics(tree, seen, MarkerTasks(dict.fromkeys(names, 1.0)))
    told = dict(zip(tree.names, found.determined.T, strict=True))
    assert not told["pro_sup_r"].any() and all(told[name].all() for name in arm)
    assert found.settled.all() and found.steps.max() < 40
    off = np.abs(found.values - values)[:, [tree.names.index(name) for name in arm]]
    assert off.max() < np.radians(5.0)


def test_nothing_moves_where_all_coordinates_are_locked(tree: Tree) -> None:
    _, seen = planted(tree)
    model = tree.model
    for name in tree.names:
        model = with_coordinate(model, name, locked=True)
    found = inverse_kinematics(tree_of(model), seen, EVEN)
    assert found.settled.all()
    np.testing.assert_array_equal(found.values, np.tile([c.default for c in model.coordinates], (len(found.values), 1)))


def test_weights_say_which_marker_gives_way(tree: Tree) -> None:
    """One marker is off by 3 cm: the more it counts, the nearer the model comes to it."""
    _, seen = planted(tree)
    off = seen.positions.copy()
    off[:, 5] += [0.03, 0.0, 0.0]
    name = tree.model.markers[5].name
    shares = []
    for weight in (0.01, 1.0, 100.0):
        found = inverse_kinematics(tree, replace(seen, positions=off), MarkerTasks({**EVEN.markers, name: weight}))
        shares.append(float(np.mean(found.distances[:, 5])))
    assert shares[0] > 0.025 > shares[1] > shares[2]
    without = inverse_kinematics(tree, replace(seen, positions=off), MarkerTasks({**EVEN.markers, name: 0.0}))
    assert name not in without.markers


def test_a_wanted_value_holds_a_coordinate(tree: Tree) -> None:
    _, seen = planted(tree)
    k = tree.names.index("l")
    held = inverse_kinematics(tree, seen, MarkerTasks(EVEN.markers, {"l": (1e6, 0.3)}))
    np.testing.assert_allclose(held.values[:, k], 0.3, atol=1e-4)
    default = inverse_kinematics(tree, seen, MarkerTasks(EVEN.markers, {"l": (1e6, None)}))
    np.testing.assert_allclose(default.values[:, k], 0.0, atol=1e-4)


def test_too_few_markers_are_refused(tree: Tree) -> None:
    _, seen = planted(tree)
    few = MarkerTasks({m.name: 1.0 for m in tree.model.markers[:2]})
    with pytest.raises(ValueError, match="2 markers of the model were recorded and have a weight; three are needed"):
        inverse_kinematics(tree, seen, few)


def test_the_order_of_markers_does_not_matter(tree: Tree) -> None:
    _, seen = planted(tree, noise=0.01)
    turned = MarkerTrajectories(seen.time, seen.positions[:, ::-1], seen.names[::-1])
    found, other = (inverse_kinematics(tree, each, EVEN) for each in (seen, turned))
    np.testing.assert_array_equal(found.values, other.values)


def test_progress_is_told(tree: Tree) -> None:
    told: list[int] = []
    inverse_kinematics(tree, planted(tree)[1], EVEN, told.append)
    assert told == list(range(1, FRAMES + 1))


def test_markers_are_where_the_bodies_are(tree: Tree) -> None:
    fit = MarkerFit(tree, tree.model.markers)
    q = np.random.default_rng(2).normal(size=len(tree.names))
    marker = tree.model.markers[7]
    place = casadi.Function("p", [tree.q], [tree.point(marker.body, casadi.SX(marker.location))])
    np.testing.assert_allclose(fit.places(q)[7], np.array(place(q)).ravel(), atol=1e-15)
