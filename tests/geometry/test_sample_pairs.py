"""Every pair of `meshes/manifest.toml` against areas and distances converged by adaptive subdivision with libigl."""

import tomllib
from functools import cache
from pathlib import Path

import pytest
from scipy.spatial.transform import Rotation

from geocontact.geometry.contact_area.area import Refinement
from meshes.stl import read_stl
from tests.geometry.bodies import MM, MM2, contact, pose_of, surface

FOLDER = Path(__file__).parents[2] / "meshes"
MANIFEST = tomllib.loads((FOLDER / "manifest.toml").read_text(encoding="utf-8"))
POSES = [
    pytest.param(pair, pose, id=f"{pair['name']}-{k}")
    for pair in MANIFEST["pair"]
    for k, pose in enumerate(pair["pose"])
]
each_pose = pytest.mark.parametrize(("pair", "pose"), POSES)


@cache
def read(name):
    return surface(read_stl(FOLDER / name), name)


def at(pose):
    return pose_of(Rotation.from_quat(pose["quaternion"], scalar_first=True), [x * MM for x in pose["position_mm"]])


def references(pose):
    return [area for area in pose["area"] if area["surface"] == "triangulated"]


@each_pose
def test_areas_equal_the_converged_reference(pair, pose):
    """Within 0.1 % of what the facets of these very meshes enclose; the reference lies between the certified bounds."""
    known = references(pose)
    found = contact(read(pair["moving"]), read(pair["fixed"]), at(pose), [a["threshold_mm"] * MM for a in known])
    for k, area in enumerate(known):
        for side, ours in (("fixed", found.fixed[k]), ("moving", found.moving[k])):
            true, doubt = area[f"area_{side}_mm2"], area[f"area_{side}_uncertainty_mm2"]
            what = f"{side} at {area['threshold_mm']} mm: {ours.area / MM2:.6g} instead of {true:.6g} mm^2"
            assert ours.area / MM2 == pytest.approx(true, rel=1e-3, abs=doubt), what
            assert ours.lower / MM2 - doubt <= true <= ours.upper / MM2 + doubt, f"{what}, {ours}"
            assert abs(ours.area / MM2 - true) <= 3 * ours.error / MM2 + doubt + 1e-5 * true, f"{what}, {ours}"
    lower, upper = pose["min_distance_mm"]
    assert lower - 1e-3 <= found.min_distance / MM <= upper + 1e-6, f"{found.min_distance / MM} mm"


@pytest.mark.parametrize("name", ["sphere_plane", "sphere_cup", "knee_right_coarse"])
def test_bounds_are_as_tight_as_asked_for(name):
    pair = next(p for p in MANIFEST["pair"] if p["name"] == name)
    pose = pair["pose"][0]
    known = references(pose)
    thresholds = [a["threshold_mm"] * MM for a in known]
    found = contact(read(pair["moving"]), read(pair["fixed"]), at(pose), thresholds, refinement=Refinement(bounds=0.02))
    for k, area in enumerate(known):
        for side, ours in (("fixed", found.fixed[k]), ("moving", found.moving[k])):
            width = (ours.upper - ours.lower) / ours.upper
            assert width < 0.02, f"{side} at {area['threshold_mm']} mm: {100 * width:.2f} %"
            assert ours.lower / MM2 <= area[f"area_{side}_mm2"] <= ours.upper / MM2
