"""Areas over a motion: the table, threads, words, and one frame against all."""

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.area import AS_GIVEN, RULES
from geocontact.geometry.contact_area.evolution import ContactPair, Settings, area_evolution, area_of_outer
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.geometry.union import united
from meshes.total_knee import total_knee
from tests.contract import COLUMNS, SPLIT
from tests.geometry.bodies import MM, cube, joined, surface

INSERT, FEMORAL = (surface(body, name) for body, name in zip(total_knee(1.0), ("insert", "femoral"), strict=True))
SETTINGS = Settings(thresholds=(0.1 * MM, 4 * MM), split=Plane.across("z"), medial_side=-1)


def gait(frames=5):
    """A piece of flexion with rollback; the last frame is out of reach."""
    k = np.arange(frames)
    shift = np.column_stack([-3 + 0.1 * k, 30.47 - 0.05 * k, 0.05 * k]) * MM
    shift[-1, 1] += 0.1
    return Motion(
        0.25 * k, RigidTransform.from_components(shift, Rotation.from_euler("z", (4.0 + k)[:, None], degrees=True))
    )


@pytest.fixture(scope="module")
def evolution():
    return area_evolution(FEMORAL, INSERT, gait(), SETTINGS, workers=1)


def test_table_has_the_columns_of_the_contract(evolution):
    """COMMANDS.md: frames outer, thresholds inner; medial and lateral only with a split."""
    table = evolution.table()
    assert list(table.columns[: len(COLUMNS) + 2]) == COLUMNS + SPLIT
    assert list(table["time [s]"]) == [t for t in 0.25 * np.arange(5) for _ in range(2)]
    assert table["threshold [mm]"].to_numpy() == pytest.approx(np.tile([0.1, 4.0], 5))
    plain = area_evolution(FEMORAL, INSERT, gait(2), Settings(refinement=AS_GIVEN)).table()
    assert list(plain.columns[: len(COLUMNS)]) == COLUMNS
    assert not set(SPLIT) & set(plain.columns)


def test_table_is_in_mm(evolution):
    table = evolution.table()
    for column, values in (
        ("area_fixed [mm^2]", evolution.fixed.area.ravel() * 1e6),
        ("area_moving [mm^2]", evolution.moving.area.ravel() * 1e6),
        ("area_fixed_lower [mm^2]", evolution.fixed.lower.ravel() * 1e6),
        ("area_fixed_upper [mm^2]", evolution.fixed.upper.ravel() * 1e6),
        ("min_distance [mm]", np.repeat(evolution.min_distance, 2) * 1e3),
        ("max_penetration_fixed [mm]", np.repeat(evolution.max_penetration_fixed, 2) * 1e3),
        ("centroid_y [mm]", evolution.fixed.centroid[:, :, 1].ravel() * 1e3),
    ):
        assert table[column].to_numpy() == pytest.approx(values, rel=1e-12, nan_ok=True)


def test_halves_add_up_and_the_medial_one_is_where_it_is_said(evolution):
    assert evolution.medial + evolution.lateral == pytest.approx(evolution.fixed.area, rel=1e-12)
    assert (evolution.medial[0] > 0).all() and (evolution.lateral[0] > 0).all()
    other = area_evolution(FEMORAL, INSERT, gait(), Settings(SETTINGS.thresholds, split=SETTINGS.split, medial_side=1))
    assert np.array_equal(other.medial, evolution.fixed.area - evolution.medial)
    assert np.array_equal(other.fixed.area, evolution.fixed.area)


def test_frame_out_of_reach_has_no_area_and_no_centroid(evolution):
    table = evolution.table().iloc[-2:]
    assert (table["area_fixed [mm^2]"] == 0).all()
    assert table[["centroid_x [mm]", "centroid_y [mm]", "centroid_z [mm]"]].isna().all(axis=None)
    assert (table["min_distance [mm]"] > 90).all()


@pytest.mark.parametrize("workers", [2, 3])
def test_threads_change_no_bit(evolution, workers):
    other = area_evolution(FEMORAL, INSERT, gait(), SETTINGS, workers=workers)
    pd.testing.assert_frame_equal(evolution.table(), other.table(), check_exact=True)
    assert np.array_equal(evolution.undecided, other.undecided)


def test_one_frame_is_that_frame_of_all(evolution):
    pair, poses = ContactPair(FEMORAL, INSERT, SETTINGS), gait().poses
    for k in (4, 0, 2, 0):  # out of order, and once more: nothing is carried over
        frame = pair.at(poses.rotation.as_matrix()[k], poses.translation[k])
        assert [a.area for a in frame.fixed] == list(evolution.fixed.area[k])
        assert [a.negative for a in frame.fixed] == list(evolution.fixed.negative[k])
        assert [a.upper for a in frame.moving] == list(evolution.moving.upper[k])
        assert frame.min_distance == evolution.min_distance[k]
        np.testing.assert_array_equal(frame.moving[1].centroid, evolution.moving.centroid[k, 1])


def test_moving_and_fixed_change_places(evolution):
    motion = gait()
    other = area_evolution(INSERT, FEMORAL, Motion(motion.time, motion.poses.inv()), Settings(SETTINGS.thresholds))
    assert other.moving.area == pytest.approx(evolution.fixed.area, rel=1e-9)
    assert other.fixed.area == pytest.approx(evolution.moving.area, rel=1e-9)
    assert other.min_distance == pytest.approx(evolution.min_distance, abs=1e-12)
    for one, there in ((other.moving, evolution.fixed), (other.fixed, evolution.moving)):
        in_femoral = motion.poses[:4].inv().apply(there.centroid[:4, 1])
        assert one.centroid[:4, 1] == pytest.approx(in_femoral, abs=1e-9), "centroids are in the frame of FIXED"


def test_frames_are_handed_over_in_order():
    seen = []
    area_evolution(
        FEMORAL, INSERT, gait(), Settings(refinement=AS_GIVEN), workers=3, each=lambda k, f: seen.append((k, f))
    )
    assert [k for k, _ in seen] == [0, 1, 2, 3, 4]
    assert seen[0][1].fixed_distances.signed.min() < 0.5 * MM < seen[4][1].fixed_distances.signed.min()


@pytest.mark.parametrize("moving_open", [False, True])
@pytest.mark.parametrize("fixed_open", [False, True])
def test_signed_says_which_areas_are(moving_open, fixed_open):
    """area_fixed is signed when MOVING is closed."""
    vertices, faces = cube((0, 0, 0), 10.0)
    moving, fixed = (surface((vertices, faces[1:] if opened else faces)) for opened in (moving_open, fixed_open))
    word = {(0, 0): "both", (0, 1): "fixed", (1, 0): "moving", (1, 1): "none"}[moving_open, fixed_open]
    assert ContactPair(moving, fixed).signed == word
    motion = Motion(np.zeros(1), RigidTransform.from_translation([[0.0, 0.021, 0.0]]))
    assert (area_evolution(moving, fixed, motion).table()["signed"] == word).all()
    assumed = Surface(moving.vertices, moving.faces, assume_closed=True)
    assert ContactPair(assumed, fixed).signed == ("fixed" if fixed_open else "both")


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"thresholds": ()}, "thresholds must be finite and not negative"),
        ({"thresholds": (-1e-3,)}, "thresholds must be finite and not negative"),
        ({"thresholds": (np.nan,)}, "thresholds must be finite and not negative"),
        ({"thresholds": (1e-3, np.inf)}, "thresholds must be finite and not negative"),
        ({"rule": "vertices"}, f"rule must be one of {', '.join(RULES)}, not 'vertices'"),
    ],
)
def test_settings_that_mean_nothing_are_refused(settings, message):
    with pytest.raises(ValueError, match=message):
        Settings(**settings)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_pose_that_is_not_finite_is_refused(bad):
    with pytest.raises(ValueError, match="finite"):
        ContactPair(FEMORAL, INSERT).at(np.eye(3), np.array([0.0, bad, 0.0]))


def test_sensitivity_is_the_clipped_area_at_further_thresholds(evolution):
    """Below and above the threshold that is asked for; the areas themselves stay what they are."""
    further = (0.0, 0.5 * MM, 2 * MM, 6 * MM)
    found = area_evolution(
        FEMORAL, INSERT, gait(), Settings((4 * MM,), split=SETTINGS.split, medial_side=-1, sensitivity=further)
    )
    clipped = area_evolution(FEMORAL, INSERT, gait(), Settings(further, rule="clip"))
    assert found.sensitivity_thresholds == further
    assert found.sensitivity == pytest.approx(clipped.fixed.area, rel=1e-12)
    assert (found.sensitivity[0, -1] > found.fixed.area[0, 0]) and (found.sensitivity[0, 2] < found.fixed.area[0, 0])
    assert found.fixed.area[:, 0] == pytest.approx(evolution.fixed.area[:, 1], rel=4e-4)


@pytest.mark.parametrize("wrong", [(-1e-3,), (np.nan,), (np.inf,)])
def test_thresholds_of_the_sensitivity_are_checked_too(wrong):
    with pytest.raises(ValueError, match="finite and not negative"):
        Settings(sensitivity=wrong)


def test_the_outer_surface_alone_has_no_area_inside():
    """A cube with a smaller one inside it, 2 mm below its top; a plate 1 mm above the top; all within 4 mm."""
    both = surface(joined(cube((0, 0, 0), 5), cube((0, 2, 0), (3, 1, 3))))
    plate = surface(cube((0, 8, 0), (20, 2, 20)), "plate")
    still = Motion(np.zeros(1), RigidTransform.from_translation(np.zeros((1, 3))))
    outer, settings = united(both), Settings(thresholds=(1 * MM, 4 * MM), refinement=AS_GIVEN, rule="clip")
    whole = area_evolution(plate, both, still, settings, workers=1).fixed.area[0, 1]
    alone = area_of_outer(plate, both, still, settings, "fixed", outer, workers=1)
    assert alone.shape == (1,)
    assert whole - alone[0] == pytest.approx(
        (36.0 + 4 * 6.0 * 1.0) * MM**2, rel=1e-6
    )  # top of the inner one, 1 mm down
    turned_over = area_of_outer(both, plate, still, settings, "moving", outer, workers=1)
    assert turned_over[0] == pytest.approx(alone[0], rel=1e-6)
