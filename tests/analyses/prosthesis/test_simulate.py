"""A stance by the analysis: what is refused at once, the shipped trial from end to end, an end before toe-off."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.number_units import with_units
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.result import (
    ProsthesisSimulateResult,
    beside_words,
    curves_table,
    errors_table,
    found_words,
    goodness_of,
)
from geocontact.analyses.prosthesis.simulate.show import small_forces
from geocontact.analyses.prosthesis.simulate.walk import bushing_of, read, walk_of
from geocontact.analyses.prosthesis.stance_files import write_coordinates
from geocontact.below_knee_prosthesis.evaluation import stance_errors
from geocontact.below_knee_prosthesis.foot_numbers import socket_numbers
from geocontact.below_knee_prosthesis.stance_summary import doubts, summary
from geocontact.io.opensim.external_loads import read_external_loads
from tests.analyses.prosthesis.test_written_motion import keel_frames, read_back
from tests.below_knee_prosthesis.stances import a_stance
from tests.below_knee_prosthesis.test_stance_errors import plate_of, walked
from tests.cli.calls import MESHES
from tests.recording import opened

TRIAL = MESHES / "gait_P1_medium_1"
GIVEN: dict[str, Any] = {
    "static": TRIAL / "standing.trc",
    "mass": 77.3,
    "plates": TRIAL / "plates.mot",
    "other_plate": "other_force",
    "plate": "own_force",
}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"fulcrum": gc.mm(60)}, "66 to 151 mm"),
        ({"static": None}, "no standing trial"),
        ({"residual_length": gc.mm(480)}, "a residual limb of 480 mm is not shorter than the shank"),
        ({"mass": None}, "mass of the person is not known"),
        ({"mass": 77.3e3}, "cannot be the mass of a walking person"),
        ({"other_plate": None}, "the force under the other foot is not known"),
        ({"plate": "third"}, "no plate 'third'"),
        ({"plate": "other_force", "other_plate": "own_force"}, "carries no whole stance"),
        ({"side": "left"}, "no marker"),
        ({"socket_turns": -1}, "-1 is not 0 to 50"),
        ({"walks": 2}, "2 is not 4 to 600"),
        ({"seed": 1}, "`seed`: has no effect"),
        ({"plate": None, "score": "study"}, "without a plate nothing is compared"),
        ({"residual_markers": "RKNE,REND"}, "no marker REND"),
        ({"time": (0.1, 0.6)}, "the stance on own_force is from"),
    ],
)
def test_refused(changed: dict[str, Any], words: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        with pytest.raises(gc.InputError, match=words):
            gc.prosthesis.simulate(TRIAL / "walking.trc", **(GIVEN | changed))


def test_a_limb_between_two_markers_and_a_socket_of_a_file(tmp_path: Path) -> None:
    """The limb is as long as the markers are apart while standing; numbers of the socket are those of the file."""
    file = tmp_path / "socket.toml"
    file.write_text(
        'turn_stiffness = { value = 12, unit = "N m/deg" }\nturn_damping = { value = 4, unit = "N m s/deg" }\n'
        'shift_stiffness = { value = 25, unit = "N/mm" }\nshift_damping = { value = 9, unit = "N s/mm" }\n'
        'piston_stiffness = { value = 35, unit = "N/mm" }\n'
    )
    given = GIVEN | {"residual_markers": "RKNE,RSO3", "socket_numbers": file}
    o = ProsthesisSimulateOptions(TRIAL / "walking.trc", **given)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        opened(Record("prosthesis simulate", {}))
        recorded = read(o)
        walk = walk_of(recorded, o)
    names = list(recorded.standing.names)
    knee, end = (np.median(recorded.standing.positions[:, names.index(name)], axis=0) for name in ("RKNE", "RSO3"))
    limb = walk.leg.person.residual * walk.leg.shank
    assert limb == pytest.approx(float(np.linalg.norm(knee - end)), rel=1e-9)
    degree = np.pi / 180.0
    assert bushing_of(o).stiffness == pytest.approx([12.0 / degree] * 3 + [25e3, 35e3, 25e3])
    assert bushing_of(o).damping == pytest.approx([4.0 / degree] * 3 + [9e3] * 3)
    numbers = socket_numbers(bushing_of(o))
    assert {each.source for each in numbers.values()} == {"option"}
    with pytest.raises(gc.InputError, match="`socket_numbers`: they stand in place of"):
        ProsthesisSimulateOptions(TRIAL / "walking.trc", **given, socket="as_printed")


def test_a_plate_elsewhere_is_not_under_the_foot(tmp_path: Path) -> None:
    head, body = (TRIAL / "plates.mot").read_text().split("endheader\n")
    names, *rows = body.splitlines()
    at = names.split("\t").index("own_force_px")
    moved = [row.split("\t") for row in rows]
    for row in moved:
        row[at] = f"{float(row[at]) + 0.8:.4f}"
    file = tmp_path / "plates.mot"
    file.write_text(f"{head}endheader\n" + "\n".join([names, *("\t".join(row) for row in moved)]) + "\n")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        with pytest.raises(gc.InputError, match="no plate under the foot"):
            gc.prosthesis.simulate(TRIAL / "walking.trc", **(GIVEN | {"plates": file}))


@pytest.fixture(scope="module")
def found() -> ProsthesisSimulateResult:
    """The shipped trial."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return gc.prosthesis.simulate(TRIAL / "walking.trc", **GIVEN)


@pytest.mark.slow
def test_written_coordinates_put_the_foot_where_it_was_simulated(
    found: ProsthesisSimulateResult, tmp_path: Path
) -> None:
    """At all 500 samples a second. Drawn in lines between frames the foot is 0.5 mm off."""
    stance = found.stance
    write_coordinates(tmp_path, stance, "right")
    keel = keel_frames(read_back(tmp_path), stance.motion.leg)
    np.testing.assert_allclose(keel.translation, stance.poses.translation, atol=5e-6)
    off = (keel.rotation.inv() * stance.poses.rotation).magnitude()
    assert off.max() < 2e-5


@pytest.mark.slow
def test_shipped_trial_from_markers_to_files(found: ProsthesisSimulateResult, tmp_path: Path) -> None:
    errors = found.table("errors").set_index("quantity")
    assert errors.loc["resultant", "rmse"] < 0.09  # 0.094 with the socket counted twice; nothing is fitted here
    assert found.record.results["socket"]["settled"]
    assert not any("counted twice" in line for line in found.warnings)
    assert errors.loc["cop_ground", "r2 [-]"] > 0.8
    assert errors.loc["cop_ground", "rmse"] < 0.10
    assert abs(errors.loc["stance", "difference"]) < 0.03 and not (errors["rmse"] < 0.0).any()
    assert np.isnan(errors.loc["stance", "rmse"]), "a difference is no root mean square"
    numbers = found.table("numbers").set_index("number")
    assert numbers.loc["leg mass", "source"] == "option" and "option mass" in numbers.loc["leg mass", "note"]
    shown = with_units(found.table("numbers")).set_index("number")
    assert shown["unit"].str.len().all(), "each number has its unit"
    assert shown.loc["leg mass", "unit"] == "kg" and shown.loc["gravity", "unit"] == "m/s²"
    found.write(tmp_path / "out")
    file, loads = read_external_loads(tmp_path / "out" / "ground_reaction.xml")
    assert file.name == "ground_reaction.mot"
    assert len(loads) == 1
    told = np.genfromtxt(tmp_path / "out" / "ground_reaction.mot", skip_header=6, names=True)
    np.testing.assert_allclose(told["ground_right_force_vy"], found.stance.force[:, 1], rtol=1e-8, atol=1e-8)
    text = (tmp_path / "out" / "plane" / "foot.toml").read_text()
    plate = pd.read_csv(tmp_path / "out" / "plane" / "plate.csv", index_col=0)
    (1.001 * plate).to_csv(tmp_path / "out" / "plane" / "second.csv")  # not the same trial to the last digit
    again = text.replace("[constants]", '[from.t02]\ninputs = "foot.csv"\noutputs = "second.csv"\n\n[constants]')
    (tmp_path / "out" / "plane" / "gather.toml").write_text(again)
    with pytest.warns(gc.InputWarning, match="force_x of trial t02 is that of trial t01 at the same times"):
        case = gc.gather(tmp_path / "out" / "plane" / "gather.toml").case
    system, trial = gc.system_of(case), case.calibration[0]
    up = system.simulate(trial, {each.name: each.start for each in case.parameters})[:, 1]
    weight = 77.3 * 9.80665
    assert np.sqrt(np.mean((up - trial.column("force_y")) ** 2)) < 0.3 * weight
    assert float(text.split("numbers is ")[1].split(" N")[0]) < 0.03 * weight  # from the simulated one


def test_a_simulation_that_ends_before_toe_off_says_so() -> None:
    """A number that there is none of is not printed."""
    own, seen = np.arange(0.0, 0.662, 0.002), np.arange(-0.2, 1.2, 0.002)
    found = a_stance(own, walked(own))
    errors, told, doubted = stance_errors(found, plate_of(seen)), summary(found), doubts(found)
    assert any("still on the floor" in line and "0.66 s" in line for line in doubted)
    words = [found_words(found, told), beside_words(errors), *doubted]
    assert not any("nan" in line for line in words), words
    assert "not over after 0.55 s" in words[0]
    assert "over the first 80% of the plate's stance" in words[1]
    assert plain(told)["stance_s"] is None
    table = errors_table(errors).set_index("quantity")
    assert np.isnan(table.loc["stance", "rmse"])
    assert curves_table(errors)["vertical [-]"].isna().sum() > 15


def test_a_whole_stance_has_its_length() -> None:
    own = np.arange(0.0, 0.95, 0.002)
    found = a_stance(own, walked(own))
    assert not any("still on the floor" in line for line in doubts(found))
    assert found_words(found, summary(found)).startswith("stance of 0.69 s at the fulcrum of 117 mm")
    assert beside_words(stance_errors(found, plate_of(own))).endswith("stance as long as measured")


@pytest.mark.slow
def test_draws_of_the_markers_and_standing_still_are_said_and_written(tmp_path: Path) -> None:
    """By hand from the tables: how much of the plate's force is within the band, and what the foot misses."""
    given = GIVEN | {"walks": 4, "marker_error": gc.mm(0.5), "socket_turns": 0, "stand_still": True}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        result = gc.prosthesis.simulate(TRIAL / "walking.trc", **given)
    band, stance = result.table("band"), result.table("stance")
    assert result.band is not None and result.band.drawn + result.band.lost == 4
    np.testing.assert_array_equal(band["time [s]"], stance["time [s]"])
    weight, on = 77.3 * 9.80665, result.stance.on != 0.0
    np.testing.assert_allclose(band["vertical [BW]"], stance["force_y [N]"] / weight, atol=1e-12)
    half = 0.5 * (band["vertical upper [BW]"] - band["vertical lower [BW]"])
    wide = np.sqrt(np.mean(half[on & np.isfinite(half)] ** 2))
    assert 0.0 < wide < 0.5
    plate = result.walk.plate
    assert plate is not None
    seen = np.interp(stance["time [s]"], plate.time, plate.force[:, 1]) / weight
    inside = (np.abs(seen - band["vertical [BW]"]) <= half)[on & np.isfinite(half)].mean()
    (said,) = [line for line in result.sentences if line.startswith("errors of the markers (SD 0.5 mm")]
    assert f"±{wide:.1%} BW" in said and said.endswith(f"is within that for {inside:.0%} of the stance")
    assert result.still is not None
    missing = float(result.still.stance.force[-1, 1]) / weight - 0.5
    assert abs(missing) < 0.05 and result.still.stance.time[-1] == 10.0
    (said,) = [line for line in result.sentences if line.startswith("standing still for 10 s")]
    assert f"carries {missing:+.2%} BW" in said
    assert any("standing still" in line for line in result.warnings) == (abs(missing) > 1e-3)
    result.write(tmp_path / "out")
    assert (tmp_path / "out" / "band.csv").is_file()


def test_numbers_of_the_page_have_units_and_no_rounding_errors() -> None:
    names = ["leg ankle_x", "sole exponent", "sole heel_stiffness"]
    numbers = pd.DataFrame({"number": names, "value": [3.469e-18, 1.5, 2.0]})
    shown = with_units(numbers)
    assert list(shown["unit"]) == ["m", "-", "N/m^n"] and list(shown["value"]) == [0.0, 1.5, 2.0]


@pytest.mark.parametrize(("late", "words"), [(-0.0064, "6 ms shorter"), (0.012, "12 ms longer")])
def test_a_stance_of_another_length_is_shorter_or_longer(late: float, words: str) -> None:
    own = np.arange(0.0, 0.95, 0.002)
    errors = stance_errors(a_stance(own, walked(own)), plate_of(own))
    errors = replace(errors, stance=(0.7 + late, 0.7))
    assert beside_words(errors).endswith(f"stance {words} than measured")
    table = errors_table(errors).set_index("quantity")
    assert table.loc["stance", "difference"] == pytest.approx(late) and np.isnan(table.loc["stance", "rmse"])


def test_a_small_force_is_judged_by_its_error() -> None:
    table = pd.DataFrame({"quantity": ["vertical", "medio_lateral"], "r2 [-]": [0.9, -1.2]})
    (words,) = small_forces(table)
    assert words.paragraphs == ["sideways force: R² is -1.20; this force is small: judge by its error"]
    assert small_forces(table.assign(**{"r2 [-]": 0.5})) == [] and small_forces(None) == []


def test_a_stance_that_fits_worse_than_a_constant_is_asked_about() -> None:
    """As where x and z of the plate are exchanged: R² of the centre of pressure -31."""
    own = np.arange(0.0, 0.95, 0.002)
    errors = stance_errors(a_stance(own, walked(own)), plate_of(own))
    fits = dict.fromkeys(errors.table, (0.9, 0.1))
    errors = replace(errors, table=fits)
    assert goodness_of(errors).outcome == "fits"
    table = fits | {"cop_ground": (-31.28, 0.9), "fore_aft": (-1.0, 0.1)}
    (doubt,) = goodness_of(replace(errors, table=table)).doubts
    assert doubt.contradicts and doubt.what.startswith("centre of pressure: R² is -31.28, a constant would describe")
