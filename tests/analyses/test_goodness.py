"""Every analysis that fits something: an input that its result contradicts, and a right one that fits.

What contradicts is known from outside: another subject's size, no joint at all, a force upside down.
"""

from __future__ import annotations

import re
import shutil
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.sit_to_stand.compare import result as compared
from geocontact.analyses.sit_to_stand.design import result as designed
from geocontact.analyses.sit_to_stand.goodness import goodness_of_movement
from geocontact.analyses.sit_to_stand.predict import predictions
from geocontact.analyses.sit_to_stand.predict.result import StandingPredictResult
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.phases import TRACKS_C
from geocontact.standing_up.prediction import ALL
from tests import legs
from tests.analyses.mat import samples
from tests.cli.calls import MESHES, PLATE, SPHERE, poses
from tests.cli.gap_cases import damped_elbow, diagnosed_elbow
from tests.unchecked import unchecked

Run = Callable[[Path], Result]
SURE = re.compile(r"\b(known|certified|best|explained|explains|standard error|95 %)", re.IGNORECASE)
"""What is not said of a result that contradicts its data."""
ERROR = re.compile(r"standard error|sd_[fm][xyz] ")
"""Names of columns with standard errors."""


@dataclass(frozen=True)
class Pair:
    """An analysis on an input that its result contradicts, with words of the reason, and on a right one."""

    wrong: Run
    why: str
    right: Run


def _leg(folder: Path, size: float = 1.0) -> Path:
    """Markers of the synthetic leg in motion, of a subject that is so many times larger than the model."""
    _, model, time, values = legs.planted(folder, amplitude=2.5)
    places = legs.markers_of(model, time, values)
    return legs.trc_file(folder, MarkerTrajectories(places.time, size * places.positions, places.names))


def _ik(size: float) -> Run:
    return lambda folder: gc.inverse_kinematics(_leg(folder, size), model=folder / "leg.osim")


def _scale(size: float) -> Run:
    def run(folder: Path) -> Result:
        _, model, time, values = legs.planted(folder)
        places = size * model.marker_places(np.zeros_like(values))
        names = tuple(m.name for m in model.markers)
        return gc.scale(legs.trc_file(folder, MarkerTrajectories(time, places, names)), model=folder / "leg.osim")

    return run


def _id(times: float) -> Run:
    """A leg at rest over a force so many times its weight, under its mass centre: of once Newton leaves nothing."""

    def run(folder: Path) -> Result:
        _, model, time, _ = legs.planted(folder)
        still = legs.motion(model, amplitude=0.0)[1]
        centre = model.mass_centre(still[:1])[0]
        loads = legs.plate_files(folder, time, (0.0, times * model.weight, 0.0), (centre[0], 0.0, centre[2]))
        return gc.inverse_dynamics(legs.mot_file(folder, model, time, still), model=folder / "leg.osim", loads=loads)

    return run


def _joint(apart: float) -> Run:
    """Pelvis and thigh; the thigh is carried away from its hip by so many metres and back, as no joint lets it."""

    def run(folder: Path) -> Result:
        _, model, time, values = legs.planted(folder, amplitude=2.5)
        places = legs.markers_of(model, time, values)
        thigh = [k for k, name in enumerate(places.names) if name.startswith("femur")]
        places.positions[:, thigh] += apart * np.sin(2.0 * np.pi * 3.0 * time)[:, None, None]
        first, second = (",".join(f"{body}{k}" for k in range(4)) for body in ("pelvis", "femur_r"))
        return gc.functional_joint(legs.trc_file(folder, places), first=first, second=second)

    return run


def _tube(_: Path) -> Result:
    """The mantle of a cylinder, without its ends."""
    return gc.fit_shape(
        MESHES / "cylinder_r15_l40.stl", shape="cylinder", unit="mm", region="abs(z) < 19.9 and abs(nz) < 0.5"
    )


STANDING = MESHES / "standing_up_held_out" / "study.toml"
PLANTED = MESHES / "standing_up_exoskeleton" / "truth.csv"


@cache
def _predicted(friction: str) -> StandingPredictResult:
    """The shipped trial with the friction of the feet that made it, 1.3, or with ice under them."""
    text = PLANTED.read_text(encoding="utf-8").replace("friction,-,1.3", f"friction,-,{friction}")
    with TemporaryDirectory() as folder, unchecked():
        given = Path(folder) / "parameters.csv"
        given.write_text(text, encoding="utf-8")
        return gc.sit_to_stand.predict(STANDING, parameters=given, against=PLANTED.with_name("study.toml"), nodes=5.0)


def _compared(friction: str) -> Result:
    with mock.patch.object(compared, "predicted", return_value=_predicted(friction).predictions), unchecked():
        return gc.sit_to_stand.compare(STANDING, parameters=PLANTED, against=PLANTED.with_name("study.toml"), nodes=5.0)


def _design(turned: float) -> Run:
    """The movement that is the recorded one, or one whose knee was turned by so many degrees after the search."""

    def run(_: Path) -> Result:
        def moved(trials, noise):
            knee = COORDINATES.index("knee")
            for trial in trials:
                trial.model.q[:, knee] += np.radians(turned)
            return goodness_of_movement(trials, noise)

        with mock.patch.object(designed, "goodness_of_movement", moved), unchecked():
            return gc.sit_to_stand.design(STANDING, parameters=PLANTED, vary="share", nodes=5.0)

    return run


def _mat(exchanged: bool) -> Run:
    """Four landmarks of a flat scan, the same of the body; or two of them exchanged, 40 mm by 150 mm apart."""

    def run(folder: Path) -> Result:
        places = np.array([[20.0, 30.0], [60.0, 30.0], [20.0, 180.0], [60.0, 180.0]])
        on_body = places[[2, 1, 0, 3]] if exchanged else places
        head = "id, x [mm], y [mm], z [mm], body_x [mm], body_y [mm], body_z [mm]"
        rows = [f"{k},{x},{y},0,{a},{b},0" for k, ((x, y), (a, b)) in enumerate(zip(places, on_body, strict=True))]
        pairs = folder / "pairs.csv"
        pairs.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
        return samples.shipped(body_landmarks=pairs)

    return run


def _cells(sign: float) -> Run:
    """Load cells that are pressed by 300 N each, or pulled."""

    def run(folder: Path) -> Result:
        time = np.linspace(0.0, 1.0, 101)
        cells = {name: sign * 300.0 * np.sin(np.pi * time) for name in ("PM [N]", "AM [N]", "AL [N]", "PL [N]")}
        pd.DataFrame({"time [s]": time} | cells).to_csv(folder / "cells.csv", index=False)
        return gc.load_cells(folder / "cells.csv")

    return run


def _area(threshold: float) -> Run:
    """A ball of 40 mm on a plate: within 1 mm it touches, within 50 mm all of it does."""

    def run(folder: Path) -> Result:
        motion = poses(folder, (0, -30.0, 0), (0, -31.0, 0))
        return gc.area(SPHERE, PLATE, unit="mm", motion=motion, threshold=(threshold,))

    return run


def _shape(mesh: str, shape: str) -> Run:
    return lambda _: gc.fit_shape(MESHES / mesh, shape=shape, unit="mm")


def _gap(folder: Path) -> Result:
    """A damped elbow of which three quarters of the squared error would stay with what is named: 3 of 3.4 N."""
    found = diagnosed_elbow().findings
    force = replace(found.diagnosis.gap["force"], rmse_before=3.4, rmse_after=3.0, noise_floor=0.15, ci95=(0.02, 0.2))
    off = replace(found, diagnosis=replace(found.diagnosis, gap={"force": force}))
    with mock.patch("geocontact.analyses.gap.diagnose.result.findings_of", return_value=off), unchecked():
        return gc.diagnose(damped_elbow(folder / "elbow_7"))


def _inject(stays: bool) -> Run:
    """Stiffening put into the damped elbow, whose given diagnosis leaves little or most of the error."""

    def run(folder: Path) -> Result:
        found = diagnosed_elbow().findings
        force = replace(found.diagnosis.gap["force"], rmse_before=3.4, rmse_after=3.0, noise_floor=0.15)
        off = replace(found, diagnosis=replace(found.diagnosis, gap={"force": force})) if stays else found
        diagnosed = mock.patch("geocontact.analyses.gap.diagnose.result.findings_of", return_value=off)
        with diagnosed, mock.patch("geocontact.analyses.gap.inject.result.diagnose", return_value=found), unchecked():
            return gc.inject(damped_elbow(folder / "elbow_7"), effect="stiffening", size=2.0)

    return run


def _calibrated(mass: float) -> Run:
    """One shipped trial of standing up by 70 kg, with another mass stated."""

    def run(folder: Path) -> Result:
        there = folder / "standing_up"
        shutil.copytree(MESHES / "standing_up", there)
        text = (there / "study.toml").read_text(encoding="utf-8")
        first = text.split("\n[[trials]]")[:2]
        one = "\n[[trials]]".join(first).replace("value = 70,", f"value = {mass:g},")
        (there / "study.toml").write_text(one, encoding="utf-8")
        with unchecked():
            return gc.sit_to_stand.calibrate(there / "study.toml", nodes=8.0, resamples=0)

    return run


PAIRS = {
    "gap inject": Pair(_inject(True), "of the squared error on held-out trials stay", _inject(False)),
    "sit-to-stand calibrate": Pair(_calibrated(79.0), "force_y: residual", _calibrated(70.0)),
    "gap diagnose": Pair(_gap, "of the squared error on held-out trials stay", lambda _: diagnosed_elbow()),
    "sit-to-stand predict": Pair(lambda _: _predicted("0.13"), "force_x: residual", lambda _: _predicted("1.3")),
    "sit-to-stand compare": Pair(lambda _: _compared("0.13"), "force_x: residual", lambda _: _compared("1.3")),
    "sit-to-stand design": Pair(_design(10.0), "knee: residual", _design(0.0)),
    "mat": Pair(_mat(True), "landmarks of scan and body", _mat(False)),
    "loadcells": Pair(_cells(-1.0), "pulls on its tray", _cells(1.0)),
    "area": Pair(_area(gc.mm(50)), "that of all its faces", _area(gc.mm(1))),
    "fit a sphere": Pair(_shape("thigh.stl", "sphere"), "of the radius", _shape("sphere_r20.stl", "sphere")),
    "fit a cylinder": Pair(_shape("torus_r25_r8.stl", "cylinder"), "a plane is as near", _tube),
    "fit a plane": Pair(_shape("sphere_r20.stl", "plane"), "from the plane", _shape("plate_80x80x12.stl", "plane")),
    "ik": Pair(_ik(1.4), "mm from the model", _ik(1.0)),
    "scale": Pair(_scale(1.4), "mm from the model", _scale(1.0)),
    "id": Pair(_id(0.5), "third of the weight", _id(1.0)),
    "joint": Pair(_joint(0.3), "residual between the segments", _joint(0.0)),
}


CONFRONTED = {"sit-to-stand calibrate"}
"""Pairs whose wrong input the way in finds too: the command ends with 2."""
NAMES = [pytest.param(each, marks=pytest.mark.slow) if each.startswith("sit-to-stand") else each for each in PAIRS]


@pytest.fixture(autouse=True)
def _quiet() -> object:
    """Warnings are not what is tested here; of the predictors the one that is given everything is enough."""
    with warnings.catch_warnings(), mock.patch.object(predictions, "GIVEN", {ALL: TRACKS_C}):
        warnings.simplefilter("ignore")
        yield


@pytest.mark.parametrize("name", NAMES)
def test_a_wrong_input_contradicts_and_nothing_is_said_to_be_sure(name: str, tmp_path: Path) -> None:
    result = PAIRS[name].wrong(tmp_path)
    assert (result.fit_outcome, result.exit_code) == ("contradicts", 2 if name in CONFRONTED else 1)
    assert result.sentences[0].startswith("the result contradicts its data")
    assert any(PAIRS[name].why in doubt.what and doubt.contradicts for doubt in result.record.fit.doubts)
    for line in result.sentences[1:]:
        assert not SURE.search(line.replace("none of the known effects explains it", "")), line
    page = _headline(result.page(tmp_path / REPORT))
    assert page.startswith("The result contradicts its data")
    assert not SURE.search(page.replace("none of the known effects explains it", "")), page
    whole = result.tables()
    errors = [table[column] for table in whole.values() for column in table if ERROR.match(str(column))]
    assert all(column.isna().all() for column in errors)
    assert not re.search(r"\d ± \d|largest standard error", (tmp_path / REPORT).read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", NAMES)
def test_a_right_input_fits(name: str, tmp_path: Path) -> None:
    result = PAIRS[name].right(tmp_path)
    assert (result.fit_outcome, result.exit_code) == ("fits", 0), result.record.fit
    assert not any("contradicts" in line for line in result.sentences)


def _headline(page: Path) -> str:
    """Text of the page's answer, its first sentences and numbers."""
    text = page.read_text(encoding="utf-8")
    found = re.search(r'<(\w+) class="answer[^"]*">(.*?)</\1>', text, re.DOTALL)
    assert found is not None
    return re.sub(r"<[^>]+>", " ", found[2]).strip()
