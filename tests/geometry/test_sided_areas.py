"""Areas of the sides by themselves: the same as those of the whole job, and centres that weigh as they should."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.geometry.contact_area.area import Refinement
from geocontact.geometry.contact_area.evolution import ContactPair, Settings
from geocontact.geometry.contact_area.sided_areas import SidedAreas
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.motion.poses import motion_from_csv

MESHES = Path(__file__).resolve().parents[2] / "meshes"


def knee() -> tuple[Surface, Surface]:
    names = ("femoral_component_right_coarse.stl", "tibial_insert_right_coarse.stl")
    moving, fixed = (Surface.of(read_mesh(MESHES / name, "mm")) for name in names)
    return moving, fixed


def test_sides_are_those_of_the_whole_job() -> None:
    moving, fixed = knee()
    motion = motion_from_csv(MESHES / "gait.csv")
    split = Plane.across("z")
    pair = ContactPair(moving, fixed, Settings((4e-3,), split=split, medial_side=-1))
    sides = SidedAreas(moving, fixed, 4e-3, split)
    for frame in (15, 72):
        rotation, translation = motion.poses[frame].rotation.as_matrix(), np.asarray(motion.poses[frame].translation)
        whole = pair.at(rotation, translation).fixed[0]
        found = sides.at(rotation, translation, Refinement())
        np.testing.assert_allclose(found[0, 0], whole.negative, rtol=1e-3)
        np.testing.assert_allclose(found[:, 0].sum(), whole.area, rtol=1e-3)
        np.testing.assert_allclose(found[:, 1:].sum(axis=0) / found[:, 0].sum(), whole.centroid, atol=2e-5)
        assert found[0, 3] < 0.0 < found[1, 3], "the medial patch of a right knee is on the side of negative z"


def test_only_faces_that_count_do() -> None:
    moving, fixed = knee()
    front = fixed.vertices[fixed.faces].mean(axis=1)[:, 0] > 0.0
    pose = motion_from_csv(MESHES / "gait.csv").poses[15]
    rotation, translation = pose.rotation.as_matrix(), np.asarray(pose.translation)
    parts = [
        SidedAreas(moving, fixed, 4e-3, Plane.across("z"), faces).at(rotation, translation, Refinement())
        for faces in (front, ~front, np.ones(len(front), bool))
    ]
    np.testing.assert_allclose(parts[0] + parts[1], parts[2], rtol=2e-3, atol=1e-9)
    assert (parts[0][:, 0] > 1e-5).all()


def test_a_plane_with_everything_on_one_side_is_refused() -> None:
    moving, fixed = knee()
    with pytest.raises(ValueError, match="lie on one side of the plane"):
        SidedAreas(moving, fixed, 4e-3, Plane.across("z", 1.0))
