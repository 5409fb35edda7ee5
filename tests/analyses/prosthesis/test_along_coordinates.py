"""A stance along coordinates of ik and along the markers they are of: one leg, one motion, one force.

How far both may differ by hand: coordinates of the markers are rounded to 0.01 mm, a standard deviation e of 0.0029 mm.
Of a body whose four or five markers are s = 40 mm and more about their middle, a fit turns by e/(s sqrt(4)), 3.6e-5
rad, and shifts by e/sqrt(4); both fits have the same rounding, so their difference is no larger. At 0.16 m of the
pelvis' markers from their middle, four standard deviations are 1.5e-4 rad and 3e-5 m.
"""

from __future__ import annotations

import json
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.compare.earlier import simulated_before
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import read, walk_of
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.standing_model import standing_pose
from geocontact.below_knee_prosthesis.from_markers import as_right
from geocontact.below_knee_prosthesis.from_model import model_leg, model_markers
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import RECORDED
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.trc import trc_text
from geocontact.io.opensim.osim_writer import write_osim
from meshes.amputee import fully_marked, standing_values, true_amputee
from meshes.gait_persons import PARTICIPANTS
from tests.cli.calls import MESHES
from tests.recording import opened

TRIAL = MESHES / "amputee_P1"
STATIC = TRIAL / "standing.trc"
PLATES: dict[str, Any] = {"plates": TRIAL / "plates.mot", "other_plate": "other_force", "plate": "own_force"}
TURN, SHIFT = 1.5e-4, 3e-5
"""rad, m; see above."""


@dataclass(frozen=True)
class Files:
    """A model, its motion, and its markers along the motion, rounded as a laboratory's file."""

    model: Path
    coordinates: Path
    markers: Path
    folder: Path

    def given(self, **changed: Any) -> dict[str, Any]:
        return {"coordinates": self.coordinates, "model": self.model, "static": STATIC, **PLATES} | changed


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Files:
    """Markers of the model along the angles of the shipped walk, and the angles that ik finds of these markers."""
    folder = tmp_path_factory.mktemp("along")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        write_osim(folder / "held.osim", gc.prosthesis.scale(STATIC, mass=77.3).held)
        gc.inverse_kinematics(TRIAL / "walking.trc", model=folder / "held.osim").write(folder / "first")
        made = gc.virtual_markers(folder / "first" / "ik.mot", model=folder / "held.osim").markers
        (folder / "walking.trc").write_text(trc_text("rounded", made, 2))
        gc.inverse_kinematics(folder / "walking.trc", model=folder / "held.osim").write(folder / "ik")
    return Files(folder / "held.osim", folder / "ik" / "ik.mot", folder / "walking.trc", folder)


def walk_along(o: ProsthesisSimulateOptions) -> Any:
    opened(Record("prosthesis simulate", {}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return walk_of(read(o), o)


def test_leg_and_motion_are_those_of_the_markers(files: Files) -> None:
    one = walk_along(ProsthesisSimulateOptions(files.markers, static=STATIC, mass=77.3, **PLATES))
    other = walk_along(ProsthesisSimulateOptions(**files.given()))
    assert other.leg.person.mass == pytest.approx(77.3, rel=1e-9), "the model's"
    for name in ("hip", "thigh", "ankle", "keel"):
        np.testing.assert_allclose(getattr(other.leg, name), getattr(one.leg, name), atol=1e-6)
    away = np.abs(other.walked.motion.values - one.walked.motion.values).max(axis=0)
    for name, off in zip(RECORDED, away, strict=True):
        assert off < (SHIFT if "_t" in name and "tilt" not in name else TURN), name
    assert np.nanmax(other.walked.off) < 1e-6, "markers of a model fit its own leg without a remainder"


@pytest.mark.slow
def test_a_stance_is_that_along_the_markers(files: Files) -> None:
    """TURN at a leg of 0.9 m, of which the filter of 6 Hz leaves a third of the noise at 100 Hz, is 0.05 mm at four
    standard deviations; a leg of 100 N/mm then carries 5 N, 0.7 % BW, more or less. Where the foot touches down or
    begins to slip the force jumps: there both may be one sample apart. Measured: RMS 3.0 N, 98 % of the samples within
    3.4 N, 54 N in one, 30 ms before toe-off.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        one = gc.prosthesis.simulate(files.markers, static=STATIC, mass=77.3, socket_turns=1, **PLATES)
        other = gc.prosthesis.simulate(**files.given(socket_turns=1, markers=files.markers))
    assert len(one.time) == len(other.time)
    away = np.linalg.norm(other.force - one.force, axis=1)
    on = one.stance.on
    assert np.sqrt(np.mean(away[on] ** 2)) < 5.0 and np.quantile(away[on], 0.98) < 5.0
    assert away.max() < np.linalg.norm(np.diff(one.force, axis=0), axis=1).max()
    assert one.force[:, 1].max() > 700.0
    assert any("recorded markers are 0.0 mm (RMS) from the model" in each for each in other.sentences)


@pytest.mark.parametrize("side", ["right", "left"])
def test_joints_and_markers_of_a_model_are_those_it_was_made_of(side: Any) -> None:
    """Of exact markers of a person who stands, on both sides; a marker on the socket by hand, angle after angle."""
    made = true_amputee(PARTICIPANTS[0], vsf_foot(), fulcrum_of("medium", "pinned"))
    marked, model = amputee_tree(fully_marked(made), held=True), amputee_tree(made, side, held=True)
    still = MarkerTrajectories(
        np.zeros(1), marked.marker_places(standing_values(marked)), tuple(m.name for m in marked.markers), "standing"
    )
    found = model_leg(model, still, side, "model")
    np.testing.assert_allclose(found.hip, made.prosthetic.hip, atol=1e-9)
    known = marked.poses(standing_values(marked))["tibia_r"]
    np.testing.assert_allclose(found.knee, known.translation[0], atol=1e-9)
    np.testing.assert_allclose(found.across, known.rotation.apply([0.0, 0.0, 1.0])[0], atol=1e-9)
    assert found.off < 1e-9
    values = standing_pose(model, still, side).values
    names = [c.name for c in model.coordinates]
    end = side[0]
    values = np.array(values)
    moved = {"pelvis_tx": 0.7, f"hip_flexion_{end}": 0.4, f"hip_adduction_{end}": -0.1, f"knee_flexion_{end}": 0.6}
    for name, value in moved.items():
        values[0, names.index(name)] = value
    seen = as_right(model_markers(model, np.zeros(1), values, side, "model"), side)
    at = {name: values[0, k] for k, name in enumerate(names)}
    mirror = 1.0 if side == "right" else -1.0
    pelvis = Rotation.from_euler("YXZ", [mirror * at["pelvis_rotation"], mirror * at["pelvis_list"], at["pelvis_tilt"]])
    hip = pelvis * Rotation.from_euler(
        "ZXY", [at[f"hip_{turn}_{end}"] for turn in ("flexion", "adduction", "rotation")]
    )
    knee = hip * Rotation.from_euler("z", -at[f"knee_flexion_{end}"])
    place = np.array([at["pelvis_tx"], at["pelvis_ty"], mirror * at["pelvis_tz"]]) + pelvis.apply(made.prosthetic.hip)
    place += hip.apply([0.0, -made.prosthetic.thigh, 0.0])
    location = next(m.location for m in made.prosthetic.markers if m.name == "RSO1")
    wanted = place + knee.apply(location)
    np.testing.assert_allclose(seen.positions[0, seen.names.index("RSO1")], wanted, atol=1e-9)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"model": None}, "`model`: is missing with `coordinates`"),
        ({"coordinates": None}, "`model`: has no effect without `coordinates`"),
        ({"coordinates": None, "model": None}, "neither markers nor `coordinates`"),
        ({"functional": TRIAL / "functional.trc"}, "the hip's centre is the model's"),
        ({"walks": 10}, "without its errors"),
        ({"model": MESHES / "leg.osim", "coordinates": MESHES / "leg_swing.mot"}, "has no marker RASI"),
        ({"static": MESHES / "gait_P1_medium_1" / "standing.trc", "side": "left"}, "no marker"),
        ({"time": (5.0, 6.0)}, "no frame between 5 and 6 s"),
        ({"coordinates": MESHES / "leg_swing.mot"}, "no column for any coordinate"),
    ],
)
def test_refused(files: Files, changed: dict[str, Any], words: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        with pytest.raises(gc.InputError, match=words):
            gc.prosthesis.simulate(**files.given(**changed))


def test_markers_mass_and_standing_trial_are_compared_with_the_model(files: Files) -> None:
    """Markers a decimetre ahead are of another walk; 2.5 cm are a warning, as are 5 kg."""
    head = files.markers.read_text().splitlines()
    for shift, refused in ((100.0, True), (25.0, False)):
        rows = [line.split("\t") for line in head[6:]]
        moved = [
            "\t".join([*row[:2], *(f"{float(x) + shift * (k % 3 == 0):.2f}" for k, x in enumerate(row[2:]))])
            for row in rows
        ]
        file = files.folder / f"ahead_{shift:g}.trc"
        file.write_text("\n".join([*head[:6], *moved]) + "\n")
        o = ProsthesisSimulateOptions(file, **files.given(mass=82.3))
        record = opened(Record("prosthesis simulate", {}))
        if refused:
            with pytest.raises(gc.InputError, match=r"100\.0 mm \(RMS\) from the model"):
                read(o)
            continue
        assert read(o).mass == 82.3
        assert any("25.0 mm (RMS) from the model" in line for line in record.warnings)
        assert any("`mass` is 82.3 kg, `model` weighs 77.3 kg" in line for line in record.warnings)


def test_runs_describe_stances(files: Files, tmp_path: Path) -> None:
    """Options of run.json in SI come back; other commands, changed inputs and runs without a plate are refused."""
    o = ProsthesisSimulateOptions(**files.given(setting="low"))
    told: dict[str, Any] = {
        "command": "prosthesis simulate",
        "options": {},
        "options_si": json.loads(json.dumps(o.in_si(), default=str)),
        "inputs": [],
    }

    def run(name: str, **changed: Any) -> Path:
        file = tmp_path / f"{name}.json"
        file.write_text(json.dumps(told | changed))
        return file

    opened(Record("prosthesis compare", {}))
    high = {**told["options_si"], "setting": "high"}
    found = simulated_before([run("one"), run("two"), run("three", options_si=high)])
    assert [each.name for each in found] == ["amputee_P1_low_1", "amputee_P1_low_2", "amputee_P1_high"]
    assert found[0].asked == o and {each.person for each in found} == {"amputee_P1"}
    study = {**told["options_si"], "score": "study"}
    changed = [{"file": str(files.coordinates), "sha256": "0"}]
    without = {name: value for name, value in told["options_si"].items() if name != "plate"}
    odd = {**told["options_si"], "fulcra": 3}
    for more, words in (
        ({"command": "ik"}, "is of `ik`"),
        ({"options_si": study}, "have scores stance and study"),
        ({"inputs": changed}, "has changed since"),
        ({"options_si": without}, "nothing to compare with"),
        ({"options_si": odd}, "fulcra"),
    ):
        with pytest.raises(gc.InputError, match=words):
            simulated_before([run("one"), run("odd", **more)])


def as_run(file: Path, **options: Any) -> Path:
    """The run.json of a simulation that was asked this, with no input to compare."""
    asked = ProsthesisSimulateOptions(**options).in_si()
    told = {"command": "prosthesis simulate", "options": {}, "options_si": asked, "inputs": []}
    file.write_text(json.dumps(told, default=str))
    return file


def test_runs_of_several_persons(files: Files, tmp_path: Path) -> None:
    """A person is who has one standing trial, whatever its folder is called; one person has one mass and one side."""

    def persons(*standing: str) -> list[str]:
        runs = [
            as_run(tmp_path / f"{k}.json", **files.given(static=tmp_path / each)) for k, each in enumerate(standing)
        ]
        return [each.person for each in simulated_before(runs)]

    record = opened(Record("prosthesis compare", {}))
    assert persons("P1/standing.trc", "P2/standing.trc", "P1/standing.trc") == ["P1", "P2", "P1"]
    assert persons("P1/static/a.trc", "P2/static/a.trc") == ["P1/static", "P2/static"]
    assert persons("all/P1.trc", "all/P2.trc") == ["all/P1", "all/P2"]
    assert not record.warnings
    one = as_run(tmp_path / "one.json", **files.given(mass=77.3))
    for more in ({"mass": 60.0}, {"mass": 77.3, "side": "left"}):
        other = as_run(tmp_path / "other.json", **files.given(**more))
        with pytest.raises(gc.InputError, match=r"other\.json.*in an earlier one with the same standing trial"):
            simulated_before([one, other])
    fitted = as_run(tmp_path / "fitted.json", **files.given(law=tmp_path / "law.toml"))
    assert [each.calibrated for each in simulated_before([one, fitted])] == [False, False]
    (line,) = record.warnings
    assert line.startswith("amputee_P1_medium_2: whether the law was fitted")


def test_runs_of_a_schedule_and_of_one_stance_twice_are_refused(files: Files, tmp_path: Path) -> None:
    """A schedule has no one fulcrum; a stance would be among the others that it is compared with."""
    opened(Record("prosthesis compare", {}))
    one = as_run(tmp_path / "one.json", **files.given())
    moved = as_run(tmp_path / "moved.json", **files.given(schedule=tmp_path / "schedule.csv"))
    with pytest.raises(gc.InputError, match=r"moved\.json.*`schedule`: moves the fulcrum"):
        gc.prosthesis.compare(runs=[moved])
    high = as_run(tmp_path / "high.json", **files.given(setting="high"))
    for second in (one, high):
        with pytest.raises(gc.InputError, match=r"`runs`: the stance of amputee_P1_medium\w* and of amputee_P1_\w+ is"):
            gc.prosthesis.compare(runs=[one, second])


def test_runs_have_their_own_options() -> None:
    for given, words in (
        ({}, "no stances are described"),
        ({"runs": (STATIC,), "cutoff": 8.0}, "`cutoff`: has no effect with `runs`"),
        ({"study": STATIC, "runs": (STATIC,)}, "both describe the stances"),
    ):
        with pytest.raises(gc.InputError, match=words):
            gc.prosthesis.compare(**given)
