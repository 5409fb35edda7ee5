"""The planar chain out of a whole body that was made of one: angles, place, segments, and what is out of the plane."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.standing_up.chain import Subject
from geocontact.standing_up.planar_coordinates import BodyLeg, PlanarMotion, planar_motion
from meshes.whole_body import values_of, whole_body

SUBJECT = Subject(63.0, 1.68, sex="female", own={"shank": {"length": 0.41}})
HEADING = 0.7


def course(frames: int = 40) -> np.ndarray:
    s = np.linspace(0.0, 1.0, frames)[:, None]
    return np.array([0.3, 0.09, 0.05, -0.3, 1.3, -1.6]) * (1.0 - s) + np.array([0.32, 0.1, -0.2, -0.1, 0.1, -0.1]) * s


def found(
    q: np.ndarray, off: np.ndarray, used: tuple[str, ...] = ("right", "left"), **more: np.ndarray
) -> PlanarMotion:
    model = whole_body(SUBJECT)
    values = values_of(model, SUBJECT, q, HEADING, off)
    for name, column in more.items():
        values[:, [c.name for c in model.coordinates].index(name)] = column
    of = {joint.name: joint for joint in model.joints}
    legs = {
        side: BodyLeg(*(of[f"{name}_joint_{side[0]}"] for name in ("thigh", "shank", "foot")))
        for side in ("right", "left")
    }
    return planar_motion(model, values, legs, used)


def test_a_body_made_of_a_chain_gives_the_chain() -> None:
    q = course()
    moved = found(q, np.zeros((len(q), 3)))
    np.testing.assert_allclose(moved.q, q, atol=1e-12)
    np.testing.assert_allclose(moved.forwards, [np.cos(HEADING), 0.0, -np.sin(HEADING)], atol=1e-12)
    np.testing.assert_allclose(moved.turn.apply(moved.forwards), [1.0, 0.0, 0.0], atol=1e-12)
    assert max(float(np.abs(off).max()) for off in (*moved.apart.values(), *moved.leaning.values())) < 1e-12
    for name, own in SUBJECT.segments.items():
        given = moved.own[name]
        sides = 1.0 if name == "trunk" else 2.0
        assert sides * given["mass"] == pytest.approx(own.mass)
        assert given["centre"] == pytest.approx(own.centre) and given["gyration"] == pytest.approx(own.gyration)
        assert "length" not in given or given["length"] == pytest.approx(own.length)
    assert set(moved.own["shank"]) == {"mass", "length", "centre", "gyration"}


def test_legs_that_differ_are_averaged_and_one_is_itself() -> None:
    """Angles of the right leg have more, those of the left as much less; the chain's have the other sign."""
    q = course()
    off = 0.05 * np.sin(np.linspace(0.0, 3.0, len(q)))[:, None] * [1.0, -2.0, 0.5]
    both, right = found(q, off), found(q, off, ("right",))
    np.testing.assert_allclose(both.q[:, 2:], q[:, 2:], atol=1e-12)
    np.testing.assert_allclose(right.q[:, 3:], q[:, 3:] - off[:, ::-1], atol=1e-12)
    np.testing.assert_allclose(both.apart["thigh"], 2.0 * off[:, 0], atol=1e-12)
    np.testing.assert_allclose(both.apart["shank"], 2.0 * (off[:, 0] + off[:, 1]), atol=1e-12)
    assert right.apart == {}


def test_a_leg_that_is_spread_is_out_of_the_plane_by_that() -> None:
    """Turned about x after the hip's flexion: the line from hip to ankle keeps its angle with the plane."""
    q = course()
    q[:, 4] = 0.0  # a straight knee
    spread = np.full(len(q), 0.2)
    moved = found(q, np.zeros((len(q), 3)), hip_adduction_r=spread)
    np.testing.assert_allclose(np.abs(moved.leaning["right thigh"]), 0.2, atol=1e-12)
    np.testing.assert_allclose(np.abs(moved.leaning["right shank"]), 0.2, atol=1e-12)
    assert np.abs(moved.leaning["left thigh"]).max() < 1e-12


def test_hips_above_each_other_have_no_plane() -> None:
    q = np.zeros((30, 6))
    lying = np.full(len(q), 0.5 * np.pi)
    with pytest.raises(ValueError, match="not beside"):
        found(q, np.zeros((len(q), 3)), pelvis_list=lying)
