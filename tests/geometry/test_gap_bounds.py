"""Bounds first: the exact least distance and depth are those of measuring everything, at the cost of a few queries."""

from __future__ import annotations

import time

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.contact_area import evolution as depth
from geocontact.geometry.contact_area import gap
from geocontact.geometry.contact_area.area import AS_GIVEN, area_within
from geocontact.geometry.contact_area.evolution import ContactPair, Settings
from geocontact.geometry.contact_area.gap import Rise
from geocontact.geometry.kernels.compile import kernel
from geocontact.geometry.kernels.rise import plane_of, rise_of, size_of
from geocontact.geometry.kernels.tree import scratch
from geocontact.geometry.separation import Collider, settle
from meshes import reference
from meshes import simple_shapes as shapes
from meshes.total_knee import total_knee
from tests.geometry.bodies import MM, surface

INSERT, FEMUR = total_knee(1.0)
BODIES = {
    "ball": shapes.sphere(20.0, 8),
    "cup": shapes.cup(24.0, 5.0, 12),
    "block": shapes.block(40.0, 30.0, 12.0, 2),
    "insert": INSERT,
    "femur": FEMUR,
    "open block": (shapes.block(40.0, 30.0, 12.0, 2)[0], shapes.block(40.0, 30.0, 12.0, 2)[1][1:]),
    "open cup": (shapes.cup(24.0, 5.0, 12)[0], shapes.cup(24.0, 5.0, 12)[1][1:]),
}
OFFSETS = np.array([1e-6, -1e-6, 0.05, -0.05, 0.5, -0.5, -4.0, 30.0, 300.0]) * MM
"""From the pose at which two bodies touch, along the way they came; negative is into one another."""


def touching(moving, fixed, seed):
    """A pose drawn by chance at which the bodies touch, and the way out."""
    rng = np.random.default_rng(seed)
    turn, out = Rotation.random(random_state=rng), rng.normal(size=3)
    out /= np.linalg.norm(out)
    return settle(moving, fixed, RigidTransform.from_components(0.2 * out, turn), tuple(-out)), out


def chosen(seed):
    names = sorted(BODIES)
    one, other = names[seed % len(names)], names[(3 * seed + 1) % len(names)]
    return one, other, surface(BODIES[one], one), surface(BODIES[other], other)


@pytest.mark.parametrize("seed", range(7))
def test_least_distance_is_that_of_all_faces(seed):
    """fcl measures every face against every other; open and closed bodies, near, far and touching."""
    one, other, moving, fixed = chosen(seed)
    pair, collider = ContactPair(moving, fixed, Settings(thresholds=(0.3 * MM,))), Collider(moving, fixed)
    rest, out = touching(moving, fixed, seed)
    rotation = rest.rotation.as_matrix()
    for offset in OFFSETS:
        shift = np.asarray(rest.translation) + offset * out
        found, apart = pair.at(rotation, shift).min_distance, collider.distance(rotation, shift)
        if moving.closed or fixed.closed:
            assert (found > 0.0) == (apart > 0.0), f"{one} on {other}, {offset} m"
        assert max(found, 0.0) == pytest.approx(apart, abs=1e-13), f"{one} on {other}, {offset} m"


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 7, 10])
def test_depth_lies_within_its_bounds(seed):
    """Adaptive subdivision with libigl, of both bodies' faces; closed bodies."""
    one, other, moving, fixed = chosen(seed)
    rest, out = touching(moving, fixed, seed)
    shift = np.asarray(rest.translation) - 0.4 * MM * out
    found = ContactPair(moving, fixed, Settings(thresholds=(0.3 * MM,))).at(rest.rotation.as_matrix(), shift)
    turned = (rest.rotation.apply(BODIES[one][0]) + shift / MM, BODIES[one][1])
    lower, upper = reference.smallest_distance(BODIES[other], turned)
    assert lower - 1e-6 <= found.min_distance / MM <= upper + 1e-6, f"{one} on {other}"


@pytest.mark.parametrize("offset", [-4.0, -0.5, -0.02])
@pytest.mark.parametrize("seed", [0, 1])
def test_depth_in_a_block_is_that_of_linear_programmes(seed, offset):
    """Inside a convex body the signed distance is the largest height over its planes: an LP for each face of a ball."""
    block, ball = surface(BODIES["block"]), surface(shapes.sphere(20.0, 3))
    rest, out = touching(block, ball, seed)
    rotation, shift = rest.rotation.as_matrix(), np.asarray(rest.translation) + offset * MM * out
    found = ContactPair(block, ball, Settings(thresholds=(0.3 * MM,))).at(rotation, shift).max_penetration_fixed / MM
    normal = np.concatenate([np.eye(3), -np.eye(3)])
    level = (normal @ block.vertices.T).max(axis=1)
    in_block = (ball.vertices - shift) @ rotation
    heights = (in_block[ball.faces] @ normal.T - level) / MM  # (face, corner, plane)
    corners = heights.max(axis=2).min(axis=1)
    near = np.flatnonzero(corners - ball.edge_length.max(axis=1) / MM < corners.min())
    weights, free = {"A_eq": [[1, 1, 1, 0]], "b_eq": [1]}, [(0, None)] * 3 + [(None, None)]
    lowest = min(
        linprog([0, 0, 0, 1], np.column_stack([heights[f].T, -np.ones(6)]), np.zeros(6), bounds=free, **weights).fun
        for f in near
    )
    assert corners.min() - lowest > 1e-6, "the deepest point is a corner: nothing is searched for"
    assert found == pytest.approx(-lowest, abs=2e-6)


@kernel
def over_face(tree, place, beyond):
    """Middle and normal of the face at a place, the radius `beyond` the face, and the rise within it."""
    cx, cy, cz, nx, ny, nz = plane_of(tree.leaves, place)
    radius = beyond + size_of(tree.leaves, place)
    nodes, keys, square, fan = scratch()
    rise = rise_of(tree, cx, cy, cz, nx, ny, nz, radius, True, nodes, keys, square, fan)
    return cx, cy, cz, nx, ny, nz, radius, rise


@pytest.mark.parametrize("name", ["cup", "insert", "femur", "block"])
def test_no_signed_distance_is_below_the_rise_over_a_face(name):
    """The bound of `kernels.rise`, at points about faces on either side."""
    body, rng = surface(BODIES[name], name), np.random.default_rng(0)
    known, tree = Rise.of(body, body), body.tree
    checked = 0
    for slot in rng.permutation(len(body.faces))[:150]:
        place = known.place[slot]
        for share in (0.3, 1.0):
            *plane, radius, rise = over_face(tree, place, share * known.reach)
            centre, normal = np.array(plane[:3]), np.array(plane[3:])
            points = centre + radius * rng.uniform(-1.0, 1.0, (40, 3))
            bound = (points - centre) @ normal - rise
            holds = np.linalg.norm(points - centre, axis=1) + np.abs(bound) < radius
            signed = body.proximity(points[holds] + body.centre).distance
            assert (signed >= bound[holds] - 1e-12).all(), f"{(bound[holds] - signed).max():.1e} m too high"
            checked += int(holds.sum())
    assert checked > 100, "the bound was hardly ever put to the test"


@pytest.mark.parametrize("offset", [-0.4, -0.02, 0.1])
def test_few_edges_and_faces_are_measured_one_by_one(offset, monkeypatch):
    """Nearly conforming bodies of 3500 faces each, apart and overlapping: bounds leave less than one in twenty.

    Of the faces less than one in 25: those that the rise about a face of the other body leaves are bounded once more
    by the rise about themselves, before they are divided. Without that it is one in 22.
    """
    counted = {"edges": 0, "faces": 0}
    edge_gap, deepest = gap.edge_gap, depth.deepest

    def edges(tree, start, *rest):
        counted["edges"] += len(start)
        return edge_gap(tree, start, *rest)

    def faces(*given):
        before = given[-1][1]
        found = deepest(*given)
        counted["faces"] += given[-1][1] - before
        return found

    monkeypatch.setattr(gap, "edge_gap", edges)
    monkeypatch.setattr(depth, "deepest", faces)
    femur, insert = surface(FEMUR, "femur"), surface(INSERT, "insert")
    pair = ContactPair(femur, insert, Settings(thresholds=(4 * MM,)))
    rest = settle(femur, insert, RigidTransform.from_translation([-3 * MM, 60 * MM, 0.0]), (0.0, -1.0, 0.0))
    pair.at(np.eye(3), np.asarray(rest.translation) + np.array([0.0, offset * MM, 0.0]))
    assert 0 < counted["edges"] + counted["faces"] < 0.05 * (len(femur.faces) + len(insert.faces)), counted
    assert counted["faces"] < 0.04 * (len(femur.faces) + len(insert.faces)), counted


def test_open_bodies_are_never_searched_for_depth(monkeypatch):
    monkeypatch.setattr(depth, "deepest", lambda *_: pytest.fail("depth was asked for"))
    one, other = surface(BODIES["open block"]), surface(BODIES["open cup"])
    rest, out = touching(one, other, 3)
    found = ContactPair(one, other).at(rest.rotation.as_matrix(), np.asarray(rest.translation) - 2e-3 * out)
    assert found.min_distance == 0.0


@pytest.mark.parametrize("offset", [-0.5, 0.0, 0.7])
def test_areas_of_many_thresholds_are_those_of_each(offset):
    """In one pass, without certificates: the cut of a triangle never leaves its certified bounds."""
    thresholds = (3e-3, 0.0, 1e-4, 5e-4, 1e-3)
    femur, insert = surface(FEMUR, "femur"), surface(INSERT, "insert")
    pair = ContactPair(femur, insert, Settings(thresholds=(1 * MM,), sensitivity=thresholds))
    shift = np.array([-3.0, 30.47 + offset, 0.0]) * MM
    found = pair.at(np.eye(3), shift)
    for area, threshold in zip(found.sensitivity, thresholds, strict=True):
        alone = area_within(pair._fixed, femur, found.fixed_distances, threshold, np.eye(3), -shift, AS_GIVEN)
        assert area == pytest.approx(alone.area, rel=1e-12, abs=1e-18)


@pytest.mark.slow
def test_everything_costs_little_more_than_maps_and_clipped_areas():
    """CPU time of frames as the command evaluates them over that of both bodies' maps and clipped areas.

    Measured 2.4 with bodies of 5e4 faces; a search of depth without bounds makes it 16.
    """
    insert, femur = (surface(body) for body in total_knee(2.0))
    sensitivity = tuple(4e-3 * np.linspace(0.0, 1.5, 13))
    pair = ContactPair(femur, insert, Settings(sensitivity=sensitivity))
    poses = np.array([[-3.0, 30.46 - 0.01 * k, 0.05 * k] for k in range(8)]) * MM
    turns = Rotation.from_rotvec([[0.0, 0.0, 4.0 + k] for k in range(8)], degrees=True).as_matrix()

    def plain(turn, shift):
        back = np.ascontiguousarray(turn.T)
        for side, other, pose in ((pair._fixed, femur, (back, -back @ shift)), (pair._moving, insert, (turn, shift))):
            area_within(side, other, side.distances(other, *pose), 4e-3, *pose, AS_GIVEN)

    def seconds(evaluate):
        start = time.process_time()
        for turn, shift in zip(turns, poses, strict=True):
            evaluate(np.ascontiguousarray(turn), shift)
        return time.process_time() - start

    for evaluate in (plain, pair.at):
        seconds(evaluate)
    ratios = [seconds(pair.at) / seconds(plain) for _ in range(5)]
    assert np.median(ratios) < 4.0, f"ratios {np.round(ratios, 2)}"
