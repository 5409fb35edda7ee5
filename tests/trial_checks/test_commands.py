"""Wrong inputs made from the shipped trials: no analysis takes one without a word, and none warns of what is right.

What is read is checked before anything is computed, so that only reading runs here.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocontact.analyses.frame.collector import collecting
from geocontact.analyses.frame.record import Record
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.read import read as read_ik
from geocontact.analyses.motion.scale.factors import read as read_scale
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.prosthesis.calibrate.foot_on_plate import read as read_calibrate
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.trial import read as read_design
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.scale.result import read as read_prosthesis_scale
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import read as read_simulate
from geocontact.analyses.shoulder.simulate.arms import read as read_shoulder
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.result import read as read_standing
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.trc import read_trc, write_trc
from tests import legs
from tests.cli.calls import MESHES

WALK, OVERHEAD, STANDING_UP = MESHES / "gait_P1_medium_1", MESHES / "overhead_P1T1S100", MESHES / "standing_up"
MASS = 77.3
Damage = Callable[[Path], dict[str, Any]]


def said(read: Callable[[Any], object], options: Callable[..., Any], *first: Path, **given: Any) -> set[str]:
    """Warnings of reading with these options, or the refusal; without folders, so that two runs compare."""
    with collecting(Record("test", {})) as record:
        try:
            read(options(*first, **given))
        except InputError as error:
            return {f"refused: {error}"}
    return {re.sub(r"\S*/", "", line) for line in record.warnings}


def markers_changed(file: str, change: Callable[[MarkerTrajectories, np.ndarray], np.ndarray]) -> Damage:
    """A file of markers with other places."""

    def damage(folder: Path) -> dict[str, Any]:
        seen = read_trc(folder / file)
        places = change(seen, seen.positions.copy())
        write_trc(folder / file, MarkerTrajectories(seen.time, places, seen.names))
        return {}

    return damage


def jumping(name: str) -> Callable[[MarkerTrajectories, np.ndarray], np.ndarray]:
    """Three frames of a marker 150 mm aside."""

    def change(seen: MarkerTrajectories, places: np.ndarray) -> np.ndarray:
        k = seen.names.index(name)
        middle = len(places) // 2
        places[middle : middle + 3, k, 2] += 0.15
        return places

    return change


def exchanged(one: str, other: str) -> Callable[[MarkerTrajectories, np.ndarray], np.ndarray]:
    """Two labels exchanged from the middle on."""

    def change(seen: MarkerTrajectories, places: np.ndarray) -> np.ndarray:
        k = [seen.names.index(one), seen.names.index(other)]
        places[len(places) // 2 :, k] = places[len(places) // 2 :, k[::-1]]
        return places

    return change


def raised(by: float) -> Callable[[MarkerTrajectories, np.ndarray], np.ndarray]:
    return lambda _, places: places + np.array([0.0, by, 0.0])


def larger(by: float) -> Callable[[MarkerTrajectories, np.ndarray], np.ndarray]:
    return lambda _, places: by * places


def z_up(_: MarkerTrajectories, places: np.ndarray) -> np.ndarray:
    return places[..., [0, 2, 1]] * np.array([1.0, -1.0, 1.0])


def mirrored(_: MarkerTrajectories, places: np.ndarray) -> np.ndarray:
    return places * np.array([1.0, 1.0, -1.0])


def plates_changed(change: Callable[[dict[str, np.ndarray]], None]) -> Damage:
    """Columns of plates.mot by name, changed in place."""

    def damage(folder: Path) -> dict[str, Any]:
        file = folder / "plates.mot"
        head, body = file.read_text().split("endheader\n")
        names, *rows = body.splitlines()
        values = np.array([[float(cell) for cell in row.split()] for row in rows])
        columns = {name: values[:, k] for k, name in enumerate(names.split("\t"))}
        change(columns)
        lines = ["\t".join(f"{value:.6f}" for value in row) for row in np.column_stack(list(columns.values()))]
        file.write_text(f"{head}endheader\n" + "\n".join([names, *lines]) + "\n")
        return {}

    return damage


def times(factor: float, ends: str) -> Callable[[dict[str, np.ndarray]], None]:
    """Columns whose names end so, times a factor."""

    def change(columns: dict[str, np.ndarray]) -> None:
        hit = [name for name in columns if name.endswith(ends)]
        assert hit
        for name in hit:
            columns[name] = factor * columns[name]

    return change


def late(by: float) -> Callable[[dict[str, np.ndarray]], None]:
    def change(columns: dict[str, np.ndarray]) -> None:
        columns["time"] = columns["time"] + by

    return change


def option(**changed: Any) -> Damage:
    return lambda _: changed


def all_of(*damages: Damage) -> Damage:
    def damage(folder: Path) -> dict[str, Any]:
        return {name: value for each in damages for name, value in each(folder).items()}

    return damage


STANDING = {
    "standing trial 25 % larger": markers_changed("standing.trc", larger(1.25)),
    "standing trial with another floor": markers_changed("standing.trc", raised(0.05)),
    "right and left mirrored": all_of(
        markers_changed("standing.trc", mirrored), markers_changed("walking.trc", mirrored)
    ),
    "z is up": all_of(markers_changed("standing.trc", z_up), markers_changed("walking.trc", z_up)),
}
WALKED = {
    **STANDING,
    "a jump of 150 mm": markers_changed("walking.trc", jumping("RASI")),
    "labels exchanged half-way": markers_changed("walking.trc", exchanged("RASI", "LASI")),
    "the walk with another floor": markers_changed("walking.trc", raised(0.05)),
    "both with another floor": all_of(
        markers_changed("walking.trc", raised(0.05)), markers_changed("standing.trc", raised(0.05))
    ),
    "the standing trial twice": option(markers="standing.trc"),
    "mass x 0.7": option(mass=0.7 * MASS),
    "mass in pounds": option(mass=2.2046 * MASS),
    "force in kN": plates_changed(times(1e-3, "_vy")),
    "force / 2": plates_changed(lambda c: [times(0.5, f"_v{a}")(c) for a in "xyz"] and None),
    "sign of the force along the walk": plates_changed(times(-1.0, "_vx")),
    "sign of all forces": plates_changed(lambda c: [times(-1.0, f"_v{a}")(c) for a in "xyz"] and None),
    "plates 0.1 s late": plates_changed(late(0.1)),
    "plates 0.1 s early": plates_changed(late(-0.1)),
    "centre of pressure in mm": plates_changed(lambda c: [times(1e3, f"_p{a}")(c) for a in "xz"] and None),
    "the other plate": option(plate="other_force"),
}


def files_of(source: Path, folder: Path) -> Path:
    there = folder / source.name
    shutil.copytree(source, there)
    return there


def prosthesis(folder: Path, **changed: Any) -> dict[str, Any]:
    given: dict[str, Any] = {"markers": "walking.trc", "static": "standing.trc", "plates": "plates.mot"} | changed
    files = {name: folder / given.pop(name) for name in ("markers", "static", "plates")}
    return {"mass": MASS, "plate": "own_force", **files, **given}


def simulate(folder: Path, **changed: Any) -> set[str]:
    given = {"other_plate": "other_force", **prosthesis(folder, **changed)}
    return said(read_simulate, ProsthesisSimulateOptions, given.pop("markers"), **given)


def calibrate(folder: Path, **changed: Any) -> set[str]:
    given = prosthesis(folder, **changed)
    return said(read_calibrate, ProsthesisCalibrateOptions, given.pop("markers"), **given)


def design(folder: Path, **changed: Any) -> set[str]:
    given = prosthesis(folder, **changed)
    return said(read_design, ProsthesisDesignOptions, given.pop("markers"), **given)


def stood(folder: Path, **changed: Any) -> set[str]:
    return said(read_prosthesis_scale, ProsthesisScaleOptions, folder / "standing.trc", **({"mass": MASS} | changed))


def shoulder(folder: Path, **changed: Any) -> set[str]:
    return said(read_shoulder, ShoulderSimulateOptions, folder / "markers.trc", **({"side": "right"} | changed))


def standing_up(folder: Path, **_: Any) -> set[str]:
    return said(read_standing, StandingCalibrateOptions, folder / "study.toml")


def body_mass(factor: float) -> Damage:
    def damage(folder: Path) -> dict[str, Any]:
        study = folder / "study.toml"
        study.write_text(study.read_text().replace("value = 70,", f"value = {70.0 * factor:g},"))
        return {}

    return damage


def leg(folder: Path) -> MarkerTrajectories:
    """The leg that swings, in two files."""
    _, multibody, time, values = legs.planted(folder)
    write_trc(folder / "walk.trc", legs.markers_of(multibody, time, values))
    write_trc(folder / "still.trc", legs.markers_of(multibody, time[:5], np.tile(values[:1], (5, 1))))
    return read_trc(folder / "walk.trc")


def ik(folder: Path, **_: Any) -> set[str]:
    return said(read_ik, IkOptions, folder / "walk.trc", model=folder / "leg.osim")


def scale(folder: Path, **_: Any) -> set[str]:
    return said(read_scale, ScaleOptions, folder / "still.trc", model=folder / "leg.osim", scale=("1",))


SHOULDER = {
    "a jump of 150 mm": markers_changed("markers.trc", jumping("humerus_rdn")),
    "labels exchanged half-way": markers_changed("markers.trc", exchanged("humerus_rdn", "humerus_ldn")),
    "two of one arm exchanged half-way": markers_changed("markers.trc", exchanged("humerus_rup", "humerus_rdn")),
    "in inches": markers_changed("markers.trc", larger(1.0 / 25.4)),
}
STOOD_UP = {f"mass x {factor:g}": body_mass(factor) for factor in (0.7, 1.2857, 2.2)}
LEG = {
    "a jump of 150 mm": markers_changed("walk.trc", jumping("foot_r1")),
    "labels exchanged half-way": markers_changed("walk.trc", exchanged("foot_r1", "foot_r3")),
}
COMMANDS: dict[str, tuple[Callable[..., set[str]], Path | None, dict[str, Damage]]] = {
    "prosthesis simulate": (simulate, WALK, WALKED),
    "prosthesis calibrate": (calibrate, WALK, WALKED),
    "prosthesis design": (design, WALK, {name: WALKED[name] for name in WALKED if name != "the other plate"}),
    "prosthesis scale": (
        stood,
        WALK,
        {name: STANDING[name] for name in STANDING if name != "standing trial 25 % larger"},
    ),
    "shoulder simulate": (shoulder, OVERHEAD, SHOULDER),
    "sit-to-stand calibrate": (standing_up, STANDING_UP, STOOD_UP),
    "ik": (ik, None, LEG),
}
EACH = [(command, name) for command, (_, _, damages) in COMMANDS.items() for name in damages]


def trial_of(command: str, folder: Path) -> Path:
    source = COMMANDS[command][1]
    if source is not None:
        return files_of(source, folder)
    leg(folder)
    return folder


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> dict[str, set[str]]:
    """What each command says of its trial as it is shipped."""
    return {
        command: run(trial_of(command, tmp_path_factory.mktemp("clean"))) for command, (run, _, _) in COMMANDS.items()
    }


@pytest.mark.parametrize(("command", "name"), EACH)
def test_no_wrong_input_is_silent(command: str, name: str, tmp_path: Path, clean: dict[str, set[str]]) -> None:
    run, _, damages = COMMANDS[command]
    folder = trial_of(command, tmp_path)
    assert run(folder, **damages[name](folder)) - clean[command]


@pytest.mark.parametrize("command", COMMANDS)
def test_the_shipped_trial_is_not_doubted(command: str, clean: dict[str, set[str]]) -> None:
    """What is said of it is about numbers that nobody has measured, not about the recording."""
    known = ("regression", "for this sole only the general prior", "invented", "to lie straight below")
    assert not [line for line in clean[command] if not any(word in line for word in known)]
