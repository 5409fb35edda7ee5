"""A person who stands as a model: pose, joints, spheres of both soles, and what speaks against the legs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.standing import NO_JOINTS, FunctionalJoints, JointPoint
from geocontact.below_knee_prosthesis.both_sides.standing_model import (
    as_standing,
    doubts_of_joints,
    doubts_of_legs,
    joint_centres,
    largest_motion,
    sole_spheres,
    standing_pose,
)
from geocontact.below_knee_prosthesis.from_markers import as_right
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from meshes.amputee import true_amputee
from meshes.gait_persons import PARTICIPANTS

ONES = np.ones(3)


@pytest.fixture(scope="module")
def made() -> Amputee:
    return true_amputee(PARTICIPANTS[0], vsf_foot(), fulcrum_of("medium", "pinned"))


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_pose_of_exact_markers_is_the_one_that_made_them(made: Amputee, side) -> None:  # type: ignore[no-untyped-def]
    """In the laboratory of the person's own side; joints are where that pose has them."""
    model = amputee_tree(made, side, held=True)
    values = np.zeros((1, len(model.coordinates)))
    names = [c.name for c in model.coordinates]
    for name, value in (("pelvis_tx", 0.3), ("pelvis_ty", 0.95), ("pelvis_tz", -0.2), ("hip_flexion_r", 0.2)):
        values[0, names.index(name)] = value
    places = np.repeat(model.marker_places(values), 3, axis=0)
    seen = MarkerTrajectories(np.arange(3.0), places, tuple(m.name for m in model.markers), "exact")
    pose = standing_pose(model, as_right(seen, side), side)
    np.testing.assert_allclose(pose.values[0], values[0], atol=1e-7)
    standing = as_standing(model, pose)
    assert {c.name: c.default for c in standing.coordinates}["hip_flexion_r"] == pytest.approx(0.2, abs=1e-7)
    point = JointPoint(ONES, 1e-3 * ONES, 2e-3)
    joints = {each.name: each for each in joint_centres(model, pose, FunctionalJoints({"hip": point}), side)}
    femur = model.poses(values)[f"femur_{side[0]}"].translation[0]
    np.testing.assert_allclose(joints["hip"].place, femur, atol=1e-7)
    assert (joints["hip"].how, joints["hip"].rms) == ("functional", 2e-3)
    assert (joints["intact hip"].how, joints["intact hip"].rms) == ("regression", None)


def test_who_moves_while_standing_is_named() -> None:
    places = np.zeros((11, 2, 3))
    places[7, 1] = [0.03, 0.0, 0.04]
    assert largest_motion(MarkerTrajectories(np.arange(11.0), places, ("LKNE", "RKNE"), "")) == ("RKNE", 0.05)


def test_legs_of_another_height_are_doubted_or_refused(made: Amputee) -> None:
    both = made.intact.thigh + made.intact.shank
    told = FunctionalJoints({"hip": JointPoint(ONES, ONES, 1e-3)})
    assert doubts_of_legs(made, told, both / 0.5, "standing.trc") == []
    assert "55.0% of the height" in doubts_of_legs(made, told, both / 0.55, "")[0]
    with pytest.raises(InputError, match=r"standing.trc `height`: thigh and shank would be 70% of a height"):
        doubts_of_legs(made, told, both / 0.7, "standing.trc")
    short = replace(made, prosthetic=replace(made.prosthetic, thigh=0.85 * made.intact.thigh))
    assert [line.split()[1] for line in doubts_of_legs(short, told, None, "")] == ["thigh"]
    assert "by regression" in doubts_of_legs(made, NO_JOINTS, None, "")[0]


def test_joints_that_are_not_told_or_off_themselves_are_said() -> None:
    joints = FunctionalJoints({"intact_ankle": JointPoint(ONES, ONES, 0.02)}, {}, {"knee": "it hardly moves"})
    assert doubts_of_joints(joints) == [
        "the functional trial does not determine the knee: it hardly moves",
        "intact ankle: both segments put it 20 mm apart: is the skin loose?",
    ]


def test_every_sphere_is_on_one_body(made: Amputee) -> None:
    found = sole_spheres(made, "left")
    assert len({body for body, _ in found}) == len(found)
    own = [spheres for body, spheres in found if body.endswith("_l")]
    assert sum(map(len, own)) == len(made.foot.sole.spheres)
    heel = dict(found)["calcn_l"]  # fixed to the keel's end: in its frame as they lie
    np.testing.assert_array_equal(heel.centre, made.foot.sole.spheres.centre[: len(heel)])
    assert [body for body, _ in found][-2:] == ["calcn_r", "toes_r"]
