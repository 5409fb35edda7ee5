"""Contact areas of real implants: plausible over the cycle, and equal to an independent subdivision with libigl."""

from __future__ import annotations

import warnings
from pathlib import Path

import igl
import numpy as np
import pytest

from geocontact.data.errors import InputWarning
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import ContactPair, FrameContact, Settings, area_evolution
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.motion.poses import motion_from_joint, motion_from_map
from geocontact.io.opensim.osim import read_joint
from geocontact.io.text.tables import read_table
from meshes import reference

MM, MM2 = 1e-3, 1e-6
DM, WORKSHOP = "gc6_dm_knee", "gc4_jw_predsim_workshop"
DM_MAP = "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r"
THRESHOLDS = (0.1 * MM, 0.5 * MM, 1.0 * MM, 4.0 * MM)


def read(file: Path) -> Surface:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return Surface.of(read_mesh(file, "m"))


def frame_of(pair: ContactPair, motion: Motion, frame: int) -> FrameContact:
    pose = motion.poses[frame]
    return pair.at(np.ascontiguousarray(pose.rotation.as_matrix()), np.asarray(pose.translation))


@pytest.fixture(scope="module")
def dm_motion(data_dir: Path) -> Motion:
    table = read_table(data_dir / DM / "fluoroscopy/Fluoroscopic Gait Data.sto")
    return motion_from_map(table, DM_MAP, angles="rad")


@pytest.fixture(scope="module")
def dm_bodies(data_dir: Path) -> tuple[Surface, Surface]:
    """Femoral component and insert, both closed."""
    folder = data_dir / DM / "stl"
    return read(folder / "Femoral Component decimated.stl"), read(folder / "Tibial Insert decimated.stl")


def upward(insert: Surface) -> np.ndarray:
    """The region `ny>0.25`: the articular side of the insert."""
    return np.asarray(insert.face_normal[:, 1] > 0.25)


@pytest.fixture(scope="module")
def dm_cycle(dm_bodies: tuple[Surface, Surface], dm_motion: Motion) -> AreaEvolution:
    femur, insert = dm_bodies
    return area_evolution(femur, insert, dm_motion, Settings(fixed_faces=upward(insert)))


def test_dm_area_over_the_gait_cycle(dm_cycle: AreaEvolution) -> None:
    """101 frames of fluoroscopy; 2167 to 2775 mm^2 at 4 mm, overlapping by 1.3 mm at most."""
    area, distance = dm_cycle.fixed.area[:, 0] / MM2, dm_cycle.min_distance / MM
    assert dm_cycle.signed == "both"
    assert len(area) == 101
    assert area.min() > 2160 and area.max() < 2780, f"{area.min():.1f} .. {area.max():.1f} mm^2"
    assert distance.min() > -1.35 and distance.max() < 0.1, f"{distance.min():.3f} .. {distance.max():.3f} mm"
    width = (dm_cycle.fixed.upper - dm_cycle.fixed.lower) / dm_cycle.fixed.upper
    assert width.max() < 0.1, f"bounds up to {100 * width.max():.1f} % apart"


@pytest.mark.parametrize("frame", [10, 30, 75])
def test_dm_areas_equal_adaptive_subdivision(dm_bodies: tuple[Surface, Surface], dm_motion: Motion, frame: int) -> None:
    """On the same facets, within 0.2 %; the reference lies between the bounds."""
    femur, insert = dm_bodies
    counted = upward(insert)
    found = frame_of(ContactPair(femur, insert, Settings(THRESHOLDS, fixed_faces=counted)), dm_motion, frame)
    fixed = insert.vertices / MM, insert.faces[counted]
    placed = dm_motion.poses[frame].apply(femur.vertices) / MM, femur.faces
    for threshold, ours in zip(THRESHOLDS, found.fixed, strict=True):
        true = reference.area_within(fixed, placed, threshold / MM, width=3e-3, most=150_000)
        what = f"frame {frame} at {threshold / MM} mm: {ours.area / MM2:.3f} instead of {true} mm^2"
        assert ours.area / MM2 == pytest.approx(true.estimate, rel=2e-3), what
        assert ours.lower / MM2 <= true.upper and true.lower <= ours.upper / MM2, what
        assert ours.lower / MM2 <= true.estimate <= ours.upper / MM2, what


def test_dm_overlap_counts_as_contact(dm_bodies: tuple[Surface, Surface], dm_motion: Motion) -> None:
    """Frame 30 overlaps by more than a millimetre: 852 to 865 mm^2 at 0.1 mm, signed."""
    femur, insert = dm_bodies
    found = frame_of(ContactPair(femur, insert, Settings((0.1 * MM,), fixed_faces=upward(insert))), dm_motion, 30)
    assert 852 < found.fixed[0].area / MM2 < 865, f"{found.fixed[0].area / MM2:.2f} mm^2"
    assert found.max_penetration_fixed > 0.5 * MM


def test_dm_contact_surfaces_are_open_and_said_to_be(data_dir: Path, dm_motion: Motion) -> None:
    """Signs are refused: where frame 30 overlaps by more than 0.1 mm the unsigned area is smaller."""
    folder = data_dir / DM / "stl"
    femur, insert = read(folder / "Femoral Component contact.stl"), read(folder / "Tibial Insert contact.stl")
    assert (femur.topology.open_edges, insert.topology.open_edges) == (580, 340)
    pair = ContactPair(femur, insert, Settings((0.1 * MM, 4 * MM)))
    assert pair.signed == "none"
    found = frame_of(pair, dm_motion, 30)
    assert found.min_distance == 0
    assert np.isnan(found.max_penetration_fixed)
    assert found.fixed[0].area / MM2 < 800
    assert 2160 < found.fixed[1].area / MM2 < 2780


# --- workshop: open shells of 188 and 100 faces -----------------------------------------------------------------------


def unsigned_area(of: Surface, to: Surface, threshold: float, levels: int = 6) -> float:
    """Area [m^2] of faces whose centroid is within the threshold, every face cut into 4^levels."""
    triangles = of.vertices[of.faces]
    for _ in range(levels):
        triangles = reference.quartered(triangles)
    distance2 = igl.point_mesh_squared_distance(triangles.mean(axis=1), to.vertices, to.faces.astype(np.int64))[0]
    return float(reference.areas(triangles)[distance2 <= threshold**2].sum())


@pytest.fixture(scope="module")
def workshop(data_dir: Path) -> tuple[Surface, Surface, Motion]:
    folder = data_dir / WORKSHOP
    joint = read_joint(folder / "KneeProsthesis.osim", "knee_joint")
    motion = motion_from_joint(read_table(folder / "KneeProsthesis.mot"), joint, moving="parent", angles="deg")
    femur = read(folder / "Femoral_Component_simpler.stl")
    return femur, read(folder / "Tibial Insert simpler_superior_100.stl"), motion


def test_workshop_area_over_the_gait_cycle(workshop: tuple[Surface, Surface, Motion]) -> None:
    """1956 mm^2 in the first frame, nearly the whole sheet of 1987 mm^2 in stance, 1394 mm^2 at 65 deg of flexion."""
    femur, insert, motion = workshop
    found = area_evolution(femur, insert, motion)
    area = found.fixed.area[:, 0] / MM2
    assert found.signed == "none"
    assert len(area) == 41
    assert area[0] == pytest.approx(1956, abs=5)
    assert area.min() > 1380 and area.max() < 1986.9, f"{area.min():.1f} .. {area.max():.1f} mm^2"
    assert area.argmin() == 9, "the most flexed frame"
    assert (found.min_distance == 0).all(), "the shells cross one another in every frame"


@pytest.mark.parametrize("frame", [0, 10, 30])
def test_workshop_area_equals_subdivision(workshop: tuple[Surface, Surface, Motion], frame: int) -> None:
    femur, insert, motion = workshop
    found = frame_of(ContactPair(femur, insert), motion, frame)
    placed = Surface(motion.poses[frame].apply(femur.vertices), femur.faces)
    for ours, of, to in ((found.fixed[0], insert, placed), (found.moving[0], placed, insert)):
        true = unsigned_area(of, to, 4 * MM)
        assert ours.area == pytest.approx(true, rel=2e-3), f"{ours.area / MM2:.2f} instead of {true / MM2:.2f} mm^2"
        assert ours.lower <= true * (1 + 1e-4) and true * (1 - 1e-4) <= ours.upper
