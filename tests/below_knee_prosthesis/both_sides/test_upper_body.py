"""Trunk, head and arms by sums over de Leva's segments, written out here; beside Winter's measured whole."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.both_sides.amputee import share_of_body, upper_body
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.standing import standing_amputee
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.data.body_segments import body_segments
from meshes.amputee import (
    standing_trials,
    standing_values,
    true_amputee,
)
from meshes.gait_persons import PARTICIPANTS

MEN = {  # de Leva 1996, table 4: length [m], mass, centre, radii of gyration sagittal, transverse, long
    "head": (0.2033, 0.0694, 0.5976, (0.362, 0.376, 0.312)),
    "trunk": (0.5319, 0.4346, 0.4486, (0.372, 0.347, 0.191)),
    "upper_arm": (0.2817, 0.0271, 0.5772, (0.285, 0.269, 0.158)),
    "forearm": (0.2689, 0.0162, 0.4574, (0.276, 0.265, 0.121)),
    "hand": (0.0862, 0.0061, 0.7900, (0.628, 0.513, 0.401)),
}
TALL = 1.741


def test_sum_of_segments_by_parallel_axes() -> None:
    """A man of de Leva's mean stature: his lengths as they are."""
    shoulder, rows = (0.818 - 0.530) * TALL, []
    rows.append(("trunk", 0.5319, 0.0))
    rows.append(("head", (1.0 - 0.530) * TALL, 0.0))
    for z in (0.1295 * TALL, -0.1295 * TALL):
        rows += [("upper_arm", shoulder, z), ("forearm", shoulder - 0.2817, z)]
        rows.append(("hand", shoulder - 0.2817 - 0.2689, z))
    mass = np.array([MEN[name][1] for name, _, _ in rows])
    places = np.array([[0.0, top - MEN[name][2] * MEN[name][0], z] for name, top, z in rows])
    centre = mass @ places / mass.sum()
    about = np.zeros(3)
    for (name, _, _), m, place in zip(rows, mass, places, strict=True):
        length, _, _, (sagittal, transverse, long) = MEN[name]
        x, y, z = place - centre
        about += m * (length * np.array([sagittal, long, transverse])) ** 2
        about += m * np.array([y**2 + z**2, x**2 + z**2, x**2 + y**2])
    found = upper_body(body_segments("male"), 46.0, TALL)
    assert found[0] == pytest.approx(46.0, rel=1e-12)
    np.testing.assert_allclose(found[1], centre, atol=1e-12)
    np.testing.assert_allclose(found[2], np.diag(46.0 / mass.sum() * about), atol=1e-12)
    assert share_of_body(body_segments("male")) == pytest.approx(mass.sum(), rel=1e-12)


def test_it_is_near_winters_head_arms_and_trunk() -> None:
    """Winter 2009, table 4.1: centre at 0.626 from the shoulder's end, radius of gyration 0.496 of shoulder to hip."""
    long = (0.818 - 0.530) * 1.81
    _, centre, inertia = upper_body(body_segments("male"), 46.8, 1.81)
    assert centre[1] == pytest.approx(0.626 * long, rel=0.12)
    assert np.sqrt(inertia[2, 2] / 46.8) == pytest.approx(0.496 * long, rel=0.12)


def test_it_stands_upright_above_the_hips_whatever_the_pelvis_tilt_is() -> None:
    """In the written model: its centre above the hips' middle, its moments those about the laboratory's axes."""
    truth = true_amputee(PARTICIPANTS[0], vsf_foot(), fulcrum_of("medium", "pinned"))
    model = amputee_tree(truth, held=True)
    poses = model.poses(standing_values(model))
    pelvis = next(body for body in model.bodies if body.name == "pelvis")
    hips = 0.5 * (poses["femur_r"].translation + poses["femur_l"].translation)[0]
    own = upper_body(body_segments("male"), pelvis.mass, 1.81)
    np.testing.assert_allclose(poses["pelvis"].apply(pelvis.centre)[0] - hips, own[1], atol=1e-12)
    turn = poses["pelvis"].rotation.as_matrix()[0]
    np.testing.assert_allclose(turn @ pelvis.inertia @ turn.T, own[2], atol=1e-12)
    assert Rotation.from_matrix(turn).magnitude() > 0.1


def test_markers_tell_the_same_upper_body() -> None:
    trials = standing_trials(PARTICIPANTS[0], vsf_foot(), fulcrum_of("medium", "pinned"), errors=0.0)
    truth = trials.truth
    found = standing_amputee(
        trials.standing, truth.prosthetic.person, truth.foot, truth.fulcrum, 0.03, stature=truth.stature
    )
    off = (found.upright.inv() * truth.upright).magnitude()
    assert off < np.radians(0.01)
    guessed = standing_amputee(trials.standing, truth.prosthetic.person, truth.foot, truth.fulcrum, 0.03)
    assert guessed.stature == pytest.approx(1.81, rel=0.02)  # a hand's markers and a regression beside it
