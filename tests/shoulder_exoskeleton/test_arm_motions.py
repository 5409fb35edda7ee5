"""Upper arms in the device's frame from markers: known truth, any laboratory, and what cannot be right."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.markers import read_markers
from geocontact.io.mocap.trc import write_trc
from geocontact.shoulder_exoskeleton.arms_from_markers import (
    ArmMotions,
    MarkerSettings,
    arm_motions,
    filled_markers,
    longest_gap,
)
from geocontact.shoulder_exoskeleton.device_frame import Attachment, virtual_reference
from geocontact.shoulder_exoskeleton.smoothed_arms import smoothed_arms
from geocontact.shoulder_exoskeleton.synthetic import OverheadTrial, condition, participant, synthetic_trial, task

SETTINGS = MarkerSettings(upright=(0.0, 0.25))


@pytest.fixture(scope="module")
def trial() -> OverheadTrial:
    return synthetic_trial(participant("P2"), task("T1"), condition("S100"))


def without(markers: MarkerTrajectories, *names: str) -> MarkerTrajectories:
    kept = [k for k, name in enumerate(markers.names) if name not in names]
    return replace(markers, positions=markers.positions[:, kept], names=tuple(markers.names[k] for k in kept))


def moved(markers: MarkerTrajectories, name: str, places: np.ndarray) -> MarkerTrajectories:
    positions = markers.positions.copy()
    positions[:, markers.names.index(name)] = places
    return replace(markers, positions=positions)


def worn_by_a_person(markers: MarkerTrajectories) -> MarkerTrajectories:
    """The same trial without the device: a trunk whose C7 is 60 mm before the bar, arms by shoulder and elbow."""
    origin, left, below = np.moveaxis(markers.of(("Lucy_MC", "Lucy_Mleft", "T10")), 1, 0)
    x = (left - origin) / np.linalg.norm(left - origin, axis=1, keepdims=True)
    z = origin - below - np.sum((origin - below) * x, axis=1, keepdims=True) * x
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    y = np.cross(z, x)
    trunk = {"C7": -0.06 * y, "CLAV": -0.19 * y, "T8": -0.06 * y - 0.2 * z, "STRN": -0.19 * y - 0.2 * z}
    arms = {"RSHO": "humerus_rup", "LSHO": "humerus_lup", "RELB": "RELB", "LELB": "LELB"}
    places = [origin + each for each in trunk.values()] + [markers.of((each,))[:, 0] for each in arms.values()]
    return MarkerTrajectories(markers.time, np.stack(places, axis=1), (*trunk, *arms))


def test_truth_of_a_synthetic_trial_comes_back(trial: OverheadTrial) -> None:
    found = arm_motions(trial.markers, SETTINGS)
    assert [arm.side for arm in found.arms] == ["right", "left"] and found.notes == ()
    for arm in found.arms:
        np.testing.assert_allclose(arm.elevation, trial.courses[arm.side].elevation, atol=1e-12)
        apart = np.linalg.norm(arm.interface - arm.shoulder, axis=1)
        np.testing.assert_allclose(apart, 0.6 * trial.participant.upper_arm, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(arm.gravity_at_frames(), axis=1), 9.80665, rtol=1e-12)
    assert found.of("left").shoulder[:, 0].min() > 0.0 > found.of("right").shoulder[:, 0].max()
    assert found.of("left").interface[400, 1] < -0.2, "raised arms are in front, and y is backwards"
    np.testing.assert_allclose(found.of("left").gravity_at_frames()[0], [0.0, 0.0, -9.80665], atol=1e-12)


def test_a_laboratory_that_is_moved_changes_nothing(trial: OverheadTrial) -> None:
    turn, shift = Rotation.from_rotvec([1.0, -0.7, 2.0]), np.array([5.0, -3.0, 1.0])
    elsewhere = replace(trial.markers.turned(turn), positions=trial.markers.turned(turn).positions + shift)
    gravity = tuple(turn.apply(SETTINGS.gravity))
    here, there = arm_motions(trial.markers, SETTINGS), arm_motions(elsewhere, replace(SETTINGS, gravity=gravity))
    for one, two in zip(here.arms, there.arms, strict=True):
        for name in ("interface", "shoulder", "elevation", "gravity"):
            np.testing.assert_allclose(getattr(two, name), getattr(one, name), atol=1e-12)


def test_a_device_that_was_not_worn_is_attached_to_the_trunk(trial: OverheadTrial) -> None:
    """Where the invented distances are the true ones the motion is that of the device's own markers."""
    own = arm_motions(trial.markers)
    attached = arm_motions(worn_by_a_person(trial.markers), MarkerSettings(attachment=Attachment(cuff=0.6)))
    for one, two in zip(own.arms, attached.arms, strict=True):
        np.testing.assert_allclose(two.interface, one.interface, atol=1e-12)
        np.testing.assert_allclose(two.shoulder, one.shoulder, atol=1e-12)
    assert "attached virtually to CLAV, C7, STRN, T8: Lucy_MC 60 mm behind C7 (invented)" in attached.notes[0]
    assert [note.split(":")[0] for note in attached.notes[1:]] == ["right arm", "left arm"]
    higher = arm_motions(worn_by_a_person(trial.markers), MarkerSettings(attachment=Attachment(behind_spine=0.1)))
    np.testing.assert_allclose(
        higher.of("left").shoulder - own.of("left").shoulder, [[0.0, -0.04, 0.0]] * 739, atol=1e-12
    )


def test_a_marker_on_the_skin_says_where_along_the_arm_the_cuff_is(trial: OverheadTrial) -> None:
    """50 mm beside the axis or on it: the cuff is the device's own, 60 % of the way, whatever is guessed."""
    person, own = worn_by_a_person(trial.markers), arm_motions(trial.markers)
    axis = person.of(("RELB",))[:, 0] - person.of(("RSHO",))[:, 0]
    beside = np.cross(axis, [0.3, 0.5, 0.8])
    beside *= 0.05 / np.linalg.norm(beside, axis=1, keepdims=True)
    for off in (0.0, beside):
        skin = trial.markers.of(("humerus_rdn",))[:, 0] + off
        marked = replace(
            person, positions=np.append(person.positions, skin[:, None], axis=1), names=(*person.names, "humerus_rdn")
        )
        found = arm_motions(marked, MarkerSettings(attachment=Attachment(cuff=0.4)))
        np.testing.assert_allclose(found.of("right").interface, own.of("right").interface, atol=1e-12)
        assert "right arm: the cuff is taken where humerus_rdn lies" in found.notes[1]
        assert "left arm: the cuff is taken 40% of the way" in found.notes[2]


def test_sides_that_contradict_the_pelvis_are_refused() -> None:
    """Attached by acromia and pelvis: a person whose shoulders look backwards."""
    names = ("RSHO", "LSHO", "RASI", "LASI", "RPSI", "LPSI")
    places = [[0, -0.2, 1.4], [0, 0.2, 1.4], [0.1, -0.1, 0.9], [0.1, 0.1, 0.9], [-0.1, -0.05, 0.9], [-0.1, 0.05, 0.9]]
    still = np.repeat(np.array([places], float), 3, axis=0)
    right = MarkerTrajectories(np.arange(3) / 100.0, still, names, "walk.trc")
    found = virtual_reference(right, Attachment())
    assert found is not None and found.origin[0, 0] == pytest.approx(-0.12), "behind the acromia"
    with pytest.raises(InputError, match="RSHO and LSHO the person looks away from RASI and LASI"):
        virtual_reference(replace(right, names=("LSHO", "RSHO", *names[2:])), Attachment())


def test_one_arm_is_enough(trial: OverheadTrial) -> None:
    alone = without(trial.markers, "humerus_lup", "humerus_ldn", "LELB")
    (arm,) = arm_motions(alone, SETTINGS).arms
    assert arm.side == "right"
    with pytest.raises(KeyError):
        arm_motions(alone, SETTINGS).of("left")


def test_without_an_upright_stance_that_is_reported(trial: OverheadTrial) -> None:
    found = arm_motions(trial.markers)
    assert found.pitch == 0.0 and "T10 is taken to lie straight below Lucy_MC" in found.notes[0]


def test_ends_without_markers_are_cut_and_short_gaps_stay(trial: OverheadTrial) -> None:
    places = trial.markers.of(("humerus_rdn",))[:, 0].copy()
    places[:20] = places[-30:] = places[300:310] = np.nan
    found: ArmMotions = arm_motions(moved(trial.markers, "humerus_rdn", places))
    arm = found.of("right")
    assert arm.time[0] == pytest.approx(0.2) and len(arm.time) == len(trial.markers.time) - 50
    assert np.isnan(arm.interface[280:290]).all() and np.isfinite(arm.interface[290:]).all()
    assert "used from 0.20 to 7.08 s" in found.notes[1]


def test_length_of_gaps() -> None:
    time = np.arange(8) / 10.0
    seen = np.array([1, 1, 0, 1, 0, 0, 1, 1], bool)
    assert longest_gap(time, seen) == (time[3], time[6])
    assert longest_gap(time, np.ones(8, bool)) == (0.0, 0.0)
    with pytest.raises(ValueError, match="first and the last"):
        longest_gap(time, ~seen)


@pytest.mark.parametrize("ending", [".trc", ".csv"])
def test_files_give_the_same(trial: OverheadTrial, tmp_path: Path, ending: str) -> None:
    file = tmp_path / f"trial{ending}"
    seen = trial.markers
    if ending == ".trc":
        write_trc(file, seen)
    else:
        head = ["time [s]", *(f"{name}_{axis} [cm]" for name in seen.names for axis in "xyz")]
        rows = np.column_stack((seen.time, 1e2 * seen.positions.reshape(len(seen), -1)))
        np.savetxt(file, rows, fmt="%.9f", delimiter=",", header=",".join(head), comments="")
    found = arm_motions(read_markers(file), SETTINGS)
    for one, two in zip(arm_motions(seen, SETTINGS).arms, found.arms, strict=True):
        np.testing.assert_allclose(two.interface, one.interface, atol=1e-8)


def exchanged(markers: MarkerTrajectories, pairs: dict[str, str]) -> MarkerTrajectories:
    return markers.renamed(pairs | {b: a for a, b in pairs.items()})


def spoilt(markers: MarkerTrajectories, how: str) -> MarkerTrajectories:
    middle, left, t10 = (markers.of((name,))[:, 0] for name in ("Lucy_MC", "Lucy_Mleft", "T10"))
    lost = markers.of(("humerus_ldn",))[:, 0].copy()
    lost[200:240] = np.nan
    arms = {"humerus_rup": "humerus_lup", "humerus_rdn": "humerus_ldn"}
    mirrored = moved(markers, "Lucy_Mleft", 2.0 * middle - left)
    return {
        "no T10": lambda: without(markers, "T10"),
        "no lower": lambda: without(markers, "humerus_rdn"),
        "no arm": lambda: without(markers, "humerus_rup", "humerus_rdn", "humerus_lup", "humerus_ldn"),
        "no device": lambda: without(markers, "T10", "Lucy_MC", "Lucy_Mleft"),
        "one point": lambda: moved(markers, "Lucy_Mleft", middle + 1e-3),
        "one line": lambda: moved(markers, "T10", middle + 2.0 * (left - middle)),
        "arms exchanged": lambda: exchanged(markers, arms),
        "bar exchanged": lambda: mirrored,
        "all exchanged": lambda: exchanged(mirrored, arms),
        "metres as mm": lambda: replace(markers, positions=1e3 * markers.positions),
        "long arm": lambda: moved(markers, "humerus_rdn", 20.0 * markers.of(("humerus_rdn",))[:, 0]),
        "far T10": lambda: moved(markers, "T10", t10 - [0.0, 2.0, 0.0]),
        "z up": lambda: markers.turned(Rotation.from_euler("x", 90.0, degrees=True)),
        "gap": lambda: moved(markers, "humerus_ldn", lost),
        "never": lambda: moved(markers, "T10", np.full_like(t10, np.nan)),
        "no lower seen": lambda: moved(markers, "humerus_rdn", np.full_like(t10, np.nan)),
    }[how]()


@pytest.mark.parametrize(
    ("how", "what"),
    [
        ("no T10", "no marker T10; name them with `markers_map`"),
        ("no lower", "no marker humerus_rdn, only humerus_rup; name them"),
        ("no arm", "no markers of an upper arm: {humerus_rup, humerus_rdn} or {humerus_lup, humerus_ldn}; name them"),
        ("no device", "must be complete, CLAV, C7, STRN, T10 missing; name them"),
        (
            "one point",
            "Lucy_MC and Lucy_Mleft lie on one point in 739 frames, first at 0.00 s; is one marker given twice",
        ),
        ("one line", "T10 lies on the line through Lucy_MC and Lucy_Mleft in 739 frames, first at 0.00 s; T10 belongs"),
        ("arms exchanged", "the right shoulder lies on the left side of Lucy_MC; left and right are exchanged"),
        ("bar exchanged", "the right shoulder lies on the left side of Lucy_MC; left and right are exchanged"),
        ("all exchanged", "the shoulders lie 129 mm behind Lucy_MC; left and right are exchanged"),
        ("metres as mm", "the markers of the right upper arm are 167 m apart, not 0.05 to 0.6 m; is the unit"),
        ("long arm", "upper arm are 2"),
        ("far T10", "reference markers of the device are 2.26 m apart; is the unit"),
        ("z up", "the device is inclined 90 degrees from upright; is y up in the file? turn it with `axes`"),
        ("gap", "humerus_ldn is not seen from 1.99 to 2.40 s, 0.41 s; the limit is 0.2 s; fill the gap"),
        ("never", "Lucy_MC, Lucy_Mleft and T10 are never seen together; fill their gaps"),
        ("no lower seen", "no frame shows both markers of the right upper arm; fill their gaps"),
    ],
)
def test_what_cannot_be_right_is_refused_in_one_line(trial: OverheadTrial, how: str, what: str) -> None:
    with pytest.raises(InputError) as error:
        arm_motions(spoilt(trial.markers, how))
    assert what in str(error.value) and "\n" not in str(error.value)


def test_a_stance_outside_the_recording_is_refused(trial: OverheadTrial) -> None:
    with pytest.raises(
        InputError, match="no frame with all reference markers from 20 to 21 s; the recording is from 0"
    ):
        arm_motions(trial.markers, MarkerSettings(upright=(20.0, 21.0)))


def exchanged_from(markers: MarkerTrajectories, one: str, other: str, first: int) -> MarkerTrajectories:
    """Two names that change places from a frame on."""
    positions = markers.positions.copy()
    pair = [markers.names.index(one), markers.names.index(other)]
    positions[first:, pair] = positions[first:, pair[::-1]]
    return replace(markers, positions=positions)


def test_markers_that_jump_are_refused_with_the_time(trial: OverheadTrial) -> None:
    """A spike of 150 mm in three frames; two markers of one arm that exchange their names halfway. Both were silent."""
    spiked = trial.markers.of(("humerus_rdn",))[:, 0].copy()
    spiked[300:303, 2] += 0.15
    at = rf"the lower marker of the right upper arm jumps by 15\d mm at {trial.markers.time[300]:.2f} s \(15 m/s\)"
    with pytest.raises(InputError, match=at):
        arm_motions(moved(trial.markers, "humerus_rdn", spiked), SETTINGS)
    half = exchanged_from(trial.markers, "humerus_rup", "humerus_rdn", 400)
    with pytest.raises(
        InputError, match=rf"jumps by 167 mm at {trial.markers.time[400]:.2f} s .* exchanged their names"
    ):
        arm_motions(half, SETTINGS)


def test_an_arm_that_grows_in_a_gap_is_refused(trial: OverheadTrial) -> None:
    """Right and left lower markers exchanged while both are out of sight for 0.19 s: the speed does not show it."""
    half = exchanged_from(trial.markers, "humerus_rdn", "humerus_ldn", 400)
    hidden = half.positions.copy()
    hidden[390:409, [half.names.index(f"humerus_{side}dn") for side in "rl"]] = np.nan
    with pytest.raises(InputError, match=r"upper arm are \d{3} mm apart at 4\.09 s, 167 mm in the median"):
        arm_motions(replace(half, positions=hidden), SETTINGS)


def test_smoothed_arms_are_those_of_one_side_with_all_markers_in_their_frame(trial: OverheadTrial) -> None:
    """A low-pass of 6 Hz leaves a lift where it is; without one the arm is the recorded one."""
    plain = arm_motions(trial.markers, SETTINGS)
    found = smoothed_arms(trial.markers, SETTINGS, None, "left")
    (left,) = found.arms
    np.testing.assert_allclose(left.interface, plain.of("left").interface, atol=1e-9)
    place = found.markers[:, trial.markers.names.index("humerus_ldn")]
    np.testing.assert_allclose(place, left.interface, atol=1e-9)
    both = smoothed_arms(trial.markers, SETTINGS)
    assert [arm.side for arm in both.arms] == ["right", "left"] and both.notes == plain.notes
    moved = np.abs(both.arms[1].interface - left.interface).max()
    assert 0.0 < moved < 0.005
    one = without(trial.markers, "humerus_lup", "humerus_ldn")
    assert smoothed_arms(one, SETTINGS).notes[-1] == "only the right arm was recorded"
    with pytest.raises(InputError, match="the left arm was not recorded; recorded: right"):
        smoothed_arms(one, SETTINGS, side="left")


def test_gaps_of_markers_are_filled_and_late_ones_left_out() -> None:
    time = np.arange(50) * 0.01
    line = np.stack([time, 2.0 * time, -time], axis=1)
    positions = np.stack([line, line, line], axis=1)
    positions[10:15, 0] = np.nan
    positions[0, 1] = np.nan
    seen = MarkerTrajectories(time, positions, ("gap", "late", "whole"), "walk.trc")
    found = filled_markers(seen, 0.1)
    assert found.names == ("gap", "whole") and found.source == "walk.trc"
    np.testing.assert_allclose(found.positions, np.stack([line, line], axis=1), atol=1e-12)
    with pytest.raises(InputError, match=r"walk\.trc"):
        filled_markers(seen, 0.03)
    with pytest.raises(InputError, match="no marker is seen from the first to the last frame"):
        filled_markers(without(seen, "gap", "whole"), 0.1)
