"""A person with both legs made to measure: the shipped trials, what the file gives ik back, and what is refused."""

from __future__ import annotations

import csv
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.prosthesis.scale.result import FREE, HELD, ProsthesisScaleResult
from geocontact.below_knee_prosthesis.from_markers import MIRROR, as_right
from geocontact.data.multibody.markers import MarkerTasks
from geocontact.dynamics.inverse_kinematics import inverse_kinematics
from geocontact.dynamics.tree import tree_of
from geocontact.io.mocap.markers import read_markers
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_multibody import read_multibody
from meshes.make_gait import standing_files
from tests.cli.calls import MESHES

TRIAL = MESHES / "amputee_P1"
STANDING = TRIAL / "standing.trc"


def scaled(static: Path = STANDING, **options: Any) -> ProsthesisScaleResult:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found: ProsthesisScaleResult = gc.prosthesis.scale(static, **({"mass": 77.3} | options))
    return found


@pytest.fixture(scope="module")
def made() -> ProsthesisScaleResult:
    return scaled(functional=TRIAL / "functional.trc", height=1.81)


def test_shipped_files_are_those_of_the_script() -> None:
    for name, data in standing_files().items():
        assert (MESHES / name).read_bytes() == data


def test_files_are_read_by_ik_and_stand_as_the_person_did(made: ProsthesisScaleResult, tmp_path: Path) -> None:
    made.write(tmp_path / "out")
    free, held = (read_multibody(tmp_path / "out" / name) for name in (FREE, HELD))
    assert free.mass == pytest.approx(77.3, rel=1e-12)
    assert [c.name for c in free.coordinates if c.locked] == [
        f"knee_{turn}_{side}" for side in "rl" for turn in ("adduction", "rotation")
    ]
    assert sum(not c.locked for c in held.coordinates) == 28 - 4 - 6
    still = np.array([[c.default for c in held.coordinates]])
    seen = read_markers(STANDING)
    places = np.nanmedian(seen.of(tuple(m.name for m in held.markers)), axis=0)
    np.testing.assert_allclose(held.marker_places(still)[0], places, atol=1e-6)
    found = inverse_kinematics(tree_of(held), seen, MarkerTasks(dict.fromkeys((m.name for m in held.markers), 1.0)))
    assert found.distances.max() < 2e-3  # the cameras' noise
    for name in (FREE, HELD):  # all that travels with the file
        said = (tmp_path / "out" / name).read_text().split("<credits>")[1].split("</credits>")[0]
        assert "lean and turn with the pelvis alone" in said
    assert (tmp_path / "out" / FREE).read_text().count("<ContactSphere ") == 24 + 5
    assert (tmp_path / "out" / FREE).read_text().count("<SpringGeneralizedForce ") == 6 + 8


def test_functional_trial_fits_better_than_regression_and_hand(made: ProsthesisScaleResult) -> None:
    """By 2 % only: markers on skin hide most of what 6 mm in a joint's centre do."""
    assert made.moved is not None
    markers = scaled().held
    seen = read_markers(TRIAL / "functional.trc")
    other = inverse_kinematics(
        tree_of(markers), seen, MarkerTasks(dict.fromkeys((m.name for m in markers.markers), 1.0))
    )
    rms = [float(np.sqrt(np.nanmean(each.distances**2))) for each in (made.moved, other)]
    assert rms[0] < rms[1] < 0.004
    assert [joint.how for joint in made.joints] == ["functional"] * 5


def test_numbers_are_those_of_the_written_model(made: ProsthesisScaleResult, tmp_path: Path) -> None:
    """Each mass and spring of amputee.osim in numbers.csv; EI is that of the springs, not that of beam theory."""
    made.write(tmp_path / "out")
    lines = (tmp_path / "out" / "numbers.csv").read_text().splitlines()
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    told = {row["number"]: float(row["value"]) for row in rows}
    mass = {body.name: body for body in read_multibody(tmp_path / "out" / FREE).bodies}
    pairs = {
        "femur_r": "prosthetic thigh_mass",
        "tibia_r": "prosthetic residual_mass",
        "socket_r": "prosthetic prosthesis_mass",
        "femur_l": "intact thigh_mass",
        "tibia_l": "intact shank_mass",
        "calcn_l": "intact foot_mass",
        "toes_l": "intact toes_mass",
        "pelvis": "pelvis mass",
    }
    for body, name in pairs.items():
        assert told[name] == pytest.approx(mass[body].mass, rel=1e-10), name
    for k, axis in enumerate("xyz"):
        for other, name in enumerate("xyz"[k:], start=k):
            assert told[f"pelvis I{axis}{name}"] == pytest.approx(mass["pelvis"].inertia[k, other], rel=1e-10)
        assert told[f"pelvis centre_{axis}"] == pytest.approx(mass["pelvis"].centre[k], abs=1e-11)
    text = (tmp_path / "out" / FREE).read_text()
    names = {f"keel_{k}_r": f"keel stiffness_{k}" for k in range(1, 9)} | {"socket_ty_r": "socket_ty stiffness"}
    for coordinate, name in names.items():
        spring = text.split(f"<coordinate>{coordinate}</coordinate>")[1]
        stiffness = float(spring.split("<stiffness>")[1].split("</stiffness>")[0])
        assert told[name] == pytest.approx(stiffness, rel=1e-10), name
        viscosity = float(spring.split("<viscosity>")[1].split("</viscosity>")[0])
        damped = told["keel retardation"] * stiffness if name.startswith("keel") else told["socket_ty damping"]
        assert damped == pytest.approx(viscosity, rel=1e-10), name
    places = {joint.name: joint.parent_offset.translation for joint in read_multibody(tmp_path / "out" / FREE).joints}
    hip = [told[f"prosthetic hip_{axis}"] for axis in "xyz"]
    np.testing.assert_allclose(places["hip_r"], hip, atol=1e-11)
    for joint, name in (("knee_r", "prosthetic thigh_length"), ("knee_l", "intact thigh_length")):
        assert -places[joint][1] == pytest.approx(told[name], rel=1e-10)
    each = (told["keel length"] - told["keel posterior"]) / told["keel joints"]
    assert places["keel_2_r"][0] == pytest.approx(each, rel=1e-10)
    of_keel = told["keel density"] * told["keel width"] * told["keel thickness"]
    assert mass["keel_3_r"].mass == pytest.approx(of_keel * each, rel=1e-10)
    assert mass["calcn_r"].mass == pytest.approx(of_keel * told["keel posterior"], rel=1e-10)
    assert told["keel bending"] == pytest.approx(19.74, abs=0.005)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"mass": None}, "mass of the person is not known"),
        ({"mass": 0.0773}, "cannot be the mass of a walking person"),
        ({"height": 1.2}, "74% of a height of 1.2 m"),
        ({"height": 181.0}, "cannot be the height of a person"),
        ({"side": "left"}, "is `side` right"),
        ({"prosthesis_mass": 0.1}, "cannot be the mass of a below-knee prosthesis"),
        ({"functional": MESHES / "gait_P1_medium_1" / "walking.trc"}, "no marker LTH1"),
        ({"fulcrum": gc.mm(160)}, "66 to 151 mm"),
        ({"residual_length": gc.mm(480)}, "a residual limb of 480 mm is not shorter than the shank"),
        ({"residual_length": gc.mm(150), "residual": 0.4}, "40% of the shank and 150 mm long"),
        ({"residual_length": gc.mm(150), "residual_markers": "RKNE,RSO3"}, "given by its length as well"),
        ({"residual_markers": "RKNE"}, "'RKNE' are not two markers"),
        ({"residual_markers": "RKNE,REND"}, "no marker REND in the standing trial"),
        ({"residual_markers": "RASI,RHEE"}, "cannot be the length of a residual limb"),
    ],
)
def test_refused(changed: dict[str, Any], words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        scaled(**changed)


def test_a_left_prosthesis_is_told_by_its_mirror_image(tmp_path: Path) -> None:
    write_trc(tmp_path / "standing.trc", as_right(read_markers(STANDING), "left"))
    right, left = scaled(), scaled(tmp_path / "standing.trc", side="left")
    assert [body.name for body in left.model.bodies][1:5] == ["femur_l", "tibia_l", "socket_l", "calcn_l"]
    for one, other in zip(right.model.bodies, left.model.bodies, strict=True):
        assert other.mass == pytest.approx(one.mass, rel=1e-9)
        np.testing.assert_allclose(other.centre, one.centre * MIRROR, atol=1e-8)
    own, theirs = (one.table("joints").set_index("joint") for one in (right, left))
    np.testing.assert_allclose(theirs["z [mm]"], -own["z [mm]"], atol=1e-4)
    np.testing.assert_allclose(theirs["y [mm]"], own["y [mm]"], atol=1e-4)


def test_heavier_prosthesis_takes_from_the_trunk() -> None:
    light, heavy = scaled(), scaled(prosthesis_mass=4.0)
    mass = [one.table("segments").set_index("segment")["mass [kg]"] for one in (light, heavy)]
    assert mass[1].sum() == pytest.approx(77.3, rel=1e-12)
    keel = mass[0].filter(like="keel_").sum() + mass[0]["calcn_r"]
    assert mass[1]["socket_r"] == pytest.approx(4.0 - keel, rel=1e-12)
    assert mass[1]["pelvis"] - mass[0]["pelvis"] == pytest.approx(mass[0]["socket_r"] - mass[1]["socket_r"], rel=1e-9)
