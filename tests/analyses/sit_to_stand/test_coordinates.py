"""Planar coordinates by the command: a shipped trial made a whole body in space, and found again from its files."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.calibrate.result import goodness_of_calibration
from geocontact.analyses.sit_to_stand.recorded_beside import doubt_bending
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import COORDINATES, Subject
from geocontact.standing_up.movements import hip_height
from geocontact.standing_up.stance import chain_of
from meshes.whole_body import HEADING, SAMPLE, main, values_of, whole_body, write_body, write_plates
from tests.cli.calls import MESHES
from tests.recording import opened

SUBJECT = Subject()
PLATES = {"feet": "right_force,left_force", "chair": "chair_force"}
pytestmark = pytest.mark.filterwarnings("ignore::geocontact.InputWarning")


def in_space(folder: Path) -> dict[str, Any]:
    """The first shipped trial as a model, its motion, and plates: both feet's share the load unevenly."""
    main(folder)
    return {"model": folder / "body.osim", "plates": folder / "plates.mot", "height": SUBJECT.height, **PLATES}


def test_shipped_files_are_those_that_are_made(tmp_path: Path) -> None:
    main(tmp_path)
    for file in (MESHES / "whole_body").iterdir():
        assert file.read_bytes() == (tmp_path / file.name).read_bytes(), file


def test_a_shipped_trial_is_found_again_from_a_whole_body(tmp_path: Path) -> None:
    """Coordinates, forces and centre as the shipped study gives them, in one folder that calibrate reads."""
    result = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **in_space(tmp_path))
    folder = result.write(tmp_path / "out")
    opened(Record("sit-to-stand calibrate", {}))
    shipped, made = (standing_trials(each / "study.toml", "study") for each in (SAMPLE, folder))
    one, other = shipped.trials[0], made.trials[0]
    moving = slice(0, len(other.time))  # from seat-off on, until the hips are still
    assert 100 < len(other.time) <= len(one.time)
    np.testing.assert_allclose(other.q, one.q[moving], atol=1e-7)
    np.testing.assert_allclose(other.force, one.force[moving], atol=1e-4)
    np.testing.assert_allclose(other.centre, one.centre[moving], atol=1e-6)
    assert made.subject.mass == pytest.approx(SUBJECT.mass, rel=1e-5)
    for name, own in SUBJECT.segments.items():
        given = made.subject.segments[name]
        assert (given.mass, given.centre) == pytest.approx((own.mass, own.centre), rel=1e-4)
        assert given.gyration == pytest.approx(own.gyration, rel=1e-4)
    off = result.table("deviations")
    assert off["largest"].max() < 1e-4
    assert [one.task for one in result.spans] == ["standing up"]


def walked(folder: Path, belt: float = 0.0, shear: float = 0.0, off: float = 0.0) -> dict[str, Any]:
    """One leg that rolls over its foot in 0.6 s under 600 N, on a belt that takes it backwards.

    `shear` [N] brakes, then pushes; the load is `off` [m] ahead of where it belongs.
    """
    time = 0.01 * np.arange(140)
    s = np.clip((time - 0.4) / 0.6, 0.0, 1.0)
    q = np.tile([0.4, 0.1, 0.0, 0.2, 0.1, -0.1], (140, 1))
    q[:, 3] -= 0.4 * s
    q[:, 0] -= belt * time
    model = whole_body(SUBJECT)
    write_body(folder, model, time, values_of(model, SUBJECT, q, HEADING, np.zeros((len(q), 3))))
    up = 600.0 * np.sin(np.pi * s) ** 0.5
    ahead = 0.4 - belt * time - 0.02 + 0.12 * s + off
    along = -shear * np.sin(2.0 * np.pi * s)
    load = np.column_stack([along, up, 0.0 * up, 0.0 * up, 0.0 * up, ahead * up])
    write_plates(folder, time, {"right": load})
    return {"model": folder / "body.osim", "plates": folder / "plates.mot", "feet": "right_force", "leg": "right"}


def without_samples(file: Path, first: float, last: float) -> None:
    """The second plate's columns are lost between two times."""
    lines = file.read_text().splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("time"))
    lost = [k for k, name in enumerate(lines[head].split("\t")) if name.startswith("left_")]
    assert lost
    for k in range(head + 1, len(lines)):
        cells = lines[k].split("\t")
        if first <= float(cells[0]) <= last:
            lines[k] = "\t".join("nan" if j in lost else cell for j, cell in enumerate(cells))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def test_lost_samples_of_a_plate_are_no_load(tmp_path: Path) -> None:
    """The other foot's plate alone is not the load of both feet; what is lost outside of the motion is left out."""
    given = in_space(tmp_path)
    without_samples(tmp_path / "plates.mot", 0.0, 0.1)
    result = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given, time=(0.2, 1.8))
    assert result.given.clock is not None and result.given.clock[0] > 0.1 and np.isfinite(result.given.feet).all()
    with pytest.raises(gc.InputError, match=r"samples from 0.0\d+ to 0.1 s have no force or no moment; fill the gaps"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given)


def test_a_stance_is_cut_and_read_with_the_load_of_the_rest(tmp_path: Path) -> None:
    result = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **walked(tmp_path, belt=1.1), belt=1.1)
    (span,) = result.spans
    assert (span.task, span.name) == ("stance", "right_1") and 0.4 < span.start < 0.45 and 0.95 < span.end < 1.0
    opened(Record("sit-to-stand calibrate", {}))
    made = standing_trials(result.write(tmp_path / "out") / "study.toml", "study")
    (trial,) = made.trials
    assert made.one_leg and trial.q.shape[1] == 5 and "rates" not in made.tracks
    s = (span.start + trial.time - 0.4) / 0.6
    inside = slice(8, -8)  # the ends are rounded by the low-pass
    np.testing.assert_allclose(trial.q[inside, 0], 0.0, atol=1e-4)
    np.testing.assert_allclose(trial.centre[inside], (0.12 * s - 0.02)[inside], atol=2e-3)
    assert trial.chair is not None
    weight = 9.81 * chain_of(SUBJECT, 5).mass
    np.testing.assert_allclose((trial.chair[:, 1] + trial.force[:, 1])[inside], weight, atol=30.0)


def test_a_treadmill_that_is_not_named_is_asked_for(tmp_path: Path) -> None:
    given = walked(tmp_path, belt=1.1)
    with pytest.warns(gc.InputWarning, match=r"right_1: the flat foot moves at -1\.10 m/s: on a treadmill give"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given)
    with pytest.warns(gc.InputWarning, match=r"right_1: the flat foot moves at -0\.60 m/s: check `belt`, 0\.5 m/s"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given, belt=0.5)


def test_one_leg_whose_knee_bends_in_swing_has_no_hip_to_doubt() -> None:
    """A knee at 66 degrees where the leg's hip is lowest, as in swing; an ankle that is bent backwards is named."""
    record, chain = opened(Record("sit-to-stand calibrate", {})), chain_of(SUBJECT, 5)
    swing = np.radians([[0.0, 0.0, 0.0, -5.0, 66.0], [0.0, 0.0, 0.0, 5.0, 10.0]])
    doubt_bending(Path("ik.mot"), chain, swing, np.array([0.5, 0.8]))
    assert not record.warnings
    doubt_bending(Path("ik.mot"), chain, swing * [1.0, 1.0, 1.0, -5.0, 1.0], np.array([0.5, 0.8]))
    assert ["ankle is 25 degrees" in line for line in record.warnings] == [True]


def test_stances_without_plates_are_no_study(tmp_path: Path) -> None:
    given = walked(tmp_path) | {"plates": None, "feet": None}
    with pytest.warns(gc.InputWarning, match="no study.toml: stances need `plates`"):
        folder = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given).write(tmp_path / "out")
    assert not (folder / "study.toml").exists()


@pytest.mark.parametrize("off", [-0.3, 0.4])
def test_the_plate_of_the_other_foot_is_refused(tmp_path: Path, off: float) -> None:
    given = walked(tmp_path, off=off)
    with pytest.raises(gc.InputError, match=r"`feet`: .* m ahead of the right ankle .*the plate of the other foot"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given)


def test_a_heavier_leg_leaves_a_lighter_trunk(tmp_path: Path) -> None:
    """The study of one leg sums up to the model's mass, which `standing_trials` confronts."""
    given = walked(tmp_path)
    text = given["model"].read_text(encoding="utf-8")
    body = text.index('<Body name="thigh_r">')
    begin, end = text.index("<mass>", body) + 6, text.index("</mass>", body)
    given["model"].write_text(f"{text[:begin]}{float(text[begin:end]) + 2.0}{text[end:]}", encoding="utf-8")
    folder = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given).write(tmp_path / "out")
    opened(Record("sit-to-stand calibrate", {}))
    subject = standing_trials(folder / "study.toml", "study").subject
    assert sum(each.mass for each in subject.segments.values()) == pytest.approx(subject.mass, rel=1e-5)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"joints": "hip_flexion,knee_angle"}, "is not three names"),
        ({"joints": "hip,knee_angle,ankle_angle"}, "no coordinate hip_r; there are"),
        ({"feet": "right_force,right_force"}, "names a plate twice"),
        ({"leg": "right", "chair": None}, "2 plates are named for one leg"),
        ({"leg": "right"}, "`chair`: has no effect on stances of one leg"),
        ({"chair": "left_force"}, "left_force is one of `feet` as well"),
        ({"joints": "ankle_angle,knee_angle,hip_flexion"}, "does not lie below"),
        ({"joints": "hip_flexion,ankle_angle,knee_angle"}, "does not lie below"),
        ({"joints": "hip_flexion,hip_flexion,ankle_angle"}, "does not lie below"),
        ({"time": (0.0, 0.05)}, "frames are too few"),
    ],
)
def test_refused(tmp_path: Path, changed: dict[str, Any], words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **(in_space(tmp_path) | changed))


def test_a_stance_has_a_study_of_its_own_and_is_not_predicted(tmp_path: Path) -> None:
    folder = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **walked(tmp_path)).write(tmp_path / "out")
    numbers = MESHES / "standing_up_exoskeleton" / "truth.csv"
    with pytest.raises(gc.InputError, match="stances of one leg, which phase A alone takes"):
        gc.sit_to_stand.predict(folder / "study.toml", parameters=numbers, against=folder / "study.toml")
    text = (folder / "study.toml").read_text(encoding="utf-8")
    (folder / "both.toml").write_text(f'{text}\n[[trials]]\nname = "up"\ncoordinates = "coordinates.mot"\n')
    with pytest.raises(gc.InputError, match="a stance is of one leg, the other trials of both"):
        gc.sit_to_stand.calibrate(folder / "both.toml")


@pytest.mark.parametrize("shear", [80.0, -80.0])
def test_a_stance_that_pushes_before_it_brakes_is_doubted(tmp_path: Path, shear: float) -> None:
    folder = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **walked(tmp_path, shear=shear)).write(tmp_path / "out")
    record = opened(Record("sit-to-stand calibrate", {}))
    standing_trials(folder / "study.toml", "study")
    said = any("it pushes along the walk before it brakes" in line for line in record.warnings)
    assert said == (shear < 0.0)


@pytest.mark.slow
def test_a_stance_is_calibrated_to_files(tmp_path: Path) -> None:
    """Solved and certified; its motion, loads and model are those of one leg."""
    folder = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **walked(tmp_path)).write(tmp_path / "out")
    found = gc.sit_to_stand.calibrate(folder / "study.toml", nodes=40, resamples=0)
    assert found.found.solved and all(trial.certified for trial in found.trials)
    assert any("noise is the one sit-to-stand coordinates writes, invented" in line for line in found.warnings)
    assert "ground reaction" not in found.sentences[0] and "test nothing" in found.sentences[1]
    assert not any("force" in name or "centre" in name for name in goodness_of_calibration(found).tested)
    assert found.trials[0].model.q.shape[1] == 5
    written = found.write(tmp_path / "cal")
    assert read_table(written / "coordinates_right_1.mot").channels == COORDINATES[:5]
    assert "trunk" not in (written / "model.osim").read_text(encoding="utf-8")
    assert (written / "report.html").is_file() and "thigh" in (written / "loads_right_1.xml").read_text(
        encoding="utf-8"
    )


def turned_name(folder: Path, order: tuple[str, ...]) -> Path:
    """The plates of the folder with names 1, 2, … in another order: names and order say nothing."""
    table = read_table(folder / "plates.mot")
    columns, names = [], []
    for k, name in enumerate(order, 1):
        for tail in [f"force_{kind}{axis}" for kind in "vp" for axis in "xyz"] + [f"torque_{a}" for a in "xyz"]:
            columns.append(table.column(f"{name}_{tail}"))
            names.append(f"{k}_ground_{tail}")
    write_storage(folder / "other.mot", table.time, names, np.column_stack(columns), title="Plates", degrees=False)
    return folder / "other.mot"


@pytest.mark.parametrize("order", [("chair", "left", "right"), ("left", "right", "chair")])
def test_plates_are_found_by_their_place(tmp_path: Path, order: tuple[str, ...]) -> None:
    """Whatever their names and order: the same loads as with names that are typed, to the last digit."""
    given = in_space(tmp_path)
    typed = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given)
    plates = turned_name(tmp_path, order)
    files = {"model": given["model"], "height": given["height"]}
    found = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", plates=plates, **files)
    carried = {"right": "right foot", "left": "left foot", "chair": "seat"}
    assert [place.carries for place in found.given.places] == [carried[name] for name in order]
    for one, other in ((typed.given.feet, found.given.feet), (typed.given.chair, found.given.chair)):
        assert one is not None and other is not None
        np.testing.assert_allclose(other, one, rtol=0.0, atol=1e-9)
    assert any(line.startswith("plates: 1_ground_force under") for line in found.sentences)


def test_force_and_centre_of_both_feet_by_hand(tmp_path: Path) -> None:
    """The sum and its centre of pressure in the plane, from the file's columns with numpy alone."""
    given = in_space(tmp_path)
    recording = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", model=given["model"], plates=given["plates"]).given
    assert recording.feet is not None
    table = read_table(given["plates"])

    def triple(name: str) -> np.ndarray:
        return np.column_stack([table.column(f"{name}{axis}") for axis in "xyz"])

    force = triple("right_force_v") + triple("left_force_v")
    moment = triple("right_torque_") + triple("left_torque_")
    centre = np.column_stack([moment[:, 2], -moment[:, 0]]) / force[:, [1]]  # x and z on y = 0, of r × F = M
    forwards = np.array([np.cos(HEADING), -np.sin(HEADING)])  # x and z of the plane's x
    up = force[:, 1] > 50.0
    np.testing.assert_allclose(recording.feet[up, 5] / recording.feet[up, 1], (centre @ forwards)[up], atol=1e-6)
    np.testing.assert_allclose(recording.feet[:, 0], force[:, [0, 2]] @ forwards, atol=1e-6)


def test_feet_without_a_plate_are_refused(tmp_path: Path) -> None:
    """One foot on a plate of two, plates elsewhere, and the other leg's: each is said with the places of all."""
    given = in_space(tmp_path)
    whole = {"model": given["model"]}
    one = turned_name(tmp_path, ("left", "chair"))
    with pytest.raises(gc.InputError, match="only the left foot stands on a plate: 1_ground_force under the left foot"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", plates=one, **whole)
    with pytest.raises(gc.InputError, match=r"no plate lies under the right foot: .* 2_ground_force under the seat"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", plates=one, leg="right", **whole)
    alone = turned_name(tmp_path, ("chair",))
    with pytest.raises(gc.InputError, match=r"no plate lies under either foot: .* seat .*are `axes`, origin and clock"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", plates=alone, **whole)


def test_plates_that_are_named_as_something_else_are_doubted(tmp_path: Path) -> None:
    given = in_space(tmp_path) | {"feet": "right_force,chair_force", "chair": "left_force"}
    with pytest.warns(gc.InputWarning) as said:
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", **given)
    words = [str(each.message) for each in said]
    assert any("chair_force under the seat" in line and "is one of `feet`" in line for line in words)
    assert any("left_force under the left foot" in line and "are feet and chair exchanged" in line for line in words)


def stretched(model: Path, factor: float) -> Path:
    """The same body with legs of other lengths: places of knees and ankles in their parents are times `factor`."""
    text = model.read_text(encoding="utf-8")
    long = re.sub(
        r"<translation>-?0 (-[0-9.]+) -?0</translation>",
        lambda found: f"<translation>0 {factor * float(found[1])} 0</translation>",
        text,
    )
    assert long != text
    (model.parent / "long.osim").write_text(long, encoding="utf-8")
    return model.parent / "long.osim"


def test_a_height_that_nobody_typed_is_said_and_confronted(tmp_path: Path) -> None:
    """By shank and thigh: 0.2529 and 0.2425 of it (de Leva 1996); one of 2.04 m is doubted, one of 2.6 m refused."""
    model = in_space(tmp_path)["model"]
    found = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", model=model)
    legs = found.segments["shank", "length"] + found.segments["thigh", "length"]
    assert found.height == pytest.approx(legs / (0.2529 + 0.2425)) and "unusual" not in " ".join(found.warnings)
    assert f"height {found.height:.2f} m, by shank and thigh of body.osim" in found.sentences
    with pytest.warns(gc.InputWarning, match=r"long.osim: by shank and thigh 2\.04\d* m is unusual .* give `height`"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", model=stretched(model, 2.042 / found.height))
    with pytest.raises(gc.InputError, match=r"long.osim shank and thigh: 2\.6\d* m cannot be the height of a person"):
        gc.sit_to_stand.coordinates(tmp_path / "ik.mot", model=stretched(model, 2.6 / found.height))


def test_legs_apart_by_more_than_ten_degrees_are_doubted(tmp_path: Path) -> None:
    """Both hips turned apart: right less left by 12 degrees, both legs' mean as it was; 8 degrees are no warning."""
    table, subject = read_table(SAMPLE / "T1_coordinates.sto"), SUBJECT
    q = np.column_stack([table.column(name) for name in COORDINATES])
    q[:, 2:] = np.radians(q[:, 2:])
    model = whole_body(subject)
    for half, doubted in ((4.0, False), (6.0, True)):
        off = np.tile(np.radians([half, 0.0, 0.0]), (len(q), 1))
        write_body(tmp_path, model, table.time, values_of(model, subject, q, HEADING, off))
        found = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", model=tmp_path / "body.osim")
        assert any("the legs do not move alike, by 12.0°" in line for line in found.warnings) == doubted
        apart = found.table("deviations").set_index(["what", "of"])
        assert apart.loc[("right less left", "thigh"), "rms"] == pytest.approx(2.0 * half, abs=1e-4)


@pytest.mark.slow
def test_coordinates_alone_make_no_number_of_the_contact_known(tmp_path: Path) -> None:
    """Without a force of the ground what halves the prior is untested; with it the same trial's toe is known."""
    given = in_space(tmp_path)
    told = {}
    for name, plates in (("without", None), ("with", given["plates"])):
        made = gc.sit_to_stand.coordinates(tmp_path / "ik.mot", model=given["model"], plates=plates)
        study = made.write(tmp_path / name) / "study.toml"
        text = study.read_text(encoding="utf-8")
        for key, size in (("length", "0.0005"), ("angle", "0.00524")):  # the sample's own
            text = re.sub(rf"(?m)^{key} = {{ value = [0-9.]+", f"{key} = {{ value = {size}", text, count=1)
        study.write_text(text, encoding="utf-8")
        found = gc.sit_to_stand.calibrate(study, nodes=20, resamples=0)
        told[name] = found.table("parameters").set_index("parameter")["verdict"]
        assert any("no force of the ground was recorded" in line for line in found.warnings) == (name == "without")
    assert "known" not in set(told["without"]) and "untested" in set(told["without"])
    assert "known" in set(told["with"]) and "untested" not in set(told["with"])


def test_a_leg_that_swings_has_no_hip_to_doubt(tmp_path: Path) -> None:
    """The chain of a stance ends at the thigh: a knee bent by 66 degrees in swing is read, as on OpenSim's walk."""
    q = np.tile([0.0, 0.1, 0.0, -0.2, np.radians(66.0)], (30, 1))
    lowered = hip_height(SUBJECT, q) - 0.3 * np.sin(np.linspace(0.0, np.pi, len(q)))  # as of who sits down
    record = opened(Record("sit-to-stand calibrate", {}))
    doubt_bending(tmp_path / "swing.mot", chain_of(SUBJECT, 5), q, lowered)
    assert not record.warnings
