"""`numbers.csv` is what ran: read back, with `mesh.csv`, it alone gives the written forces, torques and costs.

Motions, controls and recorded channels are those of the run; all else is of the table (`tests.standing_up.from_table`).
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline

import geocontact as gc
from geocontact.analyses.frame.result import Result
from geocontact.analyses.sit_to_stand.calibrate.result import StandingCalibrateResult
from geocontact.analyses.sit_to_stand.compare.result import StandingCompareResult
from geocontact.analyses.sit_to_stand.design.result import StandingDesignResult
from geocontact.analyses.sit_to_stand.exports import write_solution
from geocontact.analyses.sit_to_stand.predict.predictions import MEAN
from geocontact.analyses.sit_to_stand.predict.result import StandingPredictResult
from geocontact.dynamics.collocation import solve as refinement
from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.io.text.results import write_table
from geocontact.standing_up import phase as judged
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial
from tests.cli.calls import MESHES
from tests.standing_up.from_table import Chains, belief, over, read, squares

WORN, HELD_OUT = (MESHES / f"standing_up_{kind}" / "study.toml" for kind in ("exoskeleton", "held_out"))
TRUTH = WORN.parent / "truth.csv"
FAST = {"nodes": 5, "degree": 4}
pytestmark = pytest.mark.slow


def quietly(job: object, *args: object, **options: object) -> object:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return job(*args, **options)  # type: ignore[operator]


def own_study(folder: Path, source: Path, *changes: tuple[str, str]) -> Path:
    """A shipped study with its first trial only, with some of its text replaced."""
    for each in source.parent.iterdir():
        (folder / each.name).write_text(each.read_text())
    text = "\n[[trials]]".join(source.read_text().split("\n[[trials]]")[:2])
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "study.toml").write_text(text)
    return folder / "study.toml"


def written(found: Result, folder: Path, trials: Sequence[TrialResult]) -> Path:
    """What `write` writes, but for figures and pages."""
    folder.mkdir()
    for name, rows in found.tables().items():
        write_table(rows, folder, name)
    for trial in trials:
        write_solution(folder / f"solution_{trial.recorded.name}.sto", trial, True)
    return folder


OTHERS = (
    ("value = 70,", "value = 74,"),
    ("force = { value = 2,", "force = { value = 3,"),
    ("strap = { value = 1,", "strap = { value = 1.5,"),
)


@pytest.fixture(scope="module", autouse=True)
def coarsely() -> Iterator[None]:
    """Meshes are halved once only, and nothing is certified: neither changes what a table has to say."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(refinement, "MOST_HALVINGS", 1)
        patch.setattr(judged, "certificate", lambda *_, **__: None)
        yield


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory: pytest.TempPathFactory) -> tuple[StandingCalibrateResult, Path]:
    folder = tmp_path_factory.mktemp("calibrated")
    found = quietly(gc.sit_to_stand.calibrate, own_study(folder, WORN, *OTHERS), resamples=0, **FAST)
    assert isinstance(found, StandingCalibrateResult) and len(found.phases) == 2 and found.found.solved
    return found, written(found, folder / "out", found.trials)


def test_both_phases_are_in_the_form_of_the_study(calibrated: tuple[StandingCalibrateResult, Path]) -> None:
    """Table II and figures 2 to 5, 8 and 9."""
    found, folder = calibrated
    table = pd.read_csv(folder / "rmsd_by_trial.csv")
    assert list(dict.fromkeys(table["phase"])) == ["A", "B"]
    errors = found.table("errors").set_index("quantity")["rmsd"]
    last = table[table["phase"] == "B"].set_index("variable")
    assert last.loc["strap at the thigh", "mean"] == pytest.approx(errors["strap"])
    joints = ["ankle", "knee", "hip", "exo_ankle", "exo_knee", "exo_hip"]
    assert last.loc["angles", "mean"] == pytest.approx(errors[joints].mean())
    assert last.loc["angles", "sd over channels"] == pytest.approx(errors[joints].std())
    sheets = found.curves()
    assert set(sheets) == {"standing_up", "ground", "kinematics", "straps", "moments", "contact_laws"}
    knee = next(panel for panel in sheets["moments"].panels if panel.title == "knee torque").curves
    assert [curve.name for curve in knee] == ["T1 recorded", "T1"]
    np.testing.assert_allclose(np.asarray(knee[1].values)[-1], found.trials[0].model.torque[-1, 1])


@pytest.fixture(scope="module")
def compared(tmp_path_factory: pytest.TempPathFactory) -> tuple[StandingCompareResult, Path]:
    folder = tmp_path_factory.mktemp("compared")
    found = quietly(gc.sit_to_stand.compare, HELD_OUT, parameters=TRUTH, against=WORN, **FAST)
    assert isinstance(found, StandingCompareResult) and all(one.solved for one in found.predictions)
    return found, written(found, folder / "out", ())


@pytest.fixture(scope="module")
def designed(tmp_path_factory: pytest.TempPathFactory) -> tuple[StandingDesignResult, Path]:
    folder = tmp_path_factory.mktemp("designed")
    found = quietly(gc.sit_to_stand.design, HELD_OUT, parameters=TRUTH, vary="share", knee=0.9, **FAST)
    assert isinstance(found, StandingDesignResult)
    return found, written(found, folder / "out", found.best.trials)


def solution(file: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Coordinates, rates, accelerations and torques of a written solution."""
    rows = pd.read_csv(file, sep="\t", skiprows=file.read_text().split("endheader")[0].count("\n") + 1)
    ends = ("/value", "/speed", "/accel", "_torque")
    return tuple(rows[[name for name in rows if name.endswith(end)]].to_numpy() for end in ends)  # type: ignore[return-value]


def check_written(told: dict[str, float], prefix: str, folder: Path, trial: TrialResult) -> None:
    """Forces of the table of the trial, whose rates are in no file, and the torques of its solution."""
    chains = Chains(told, prefix, trial.model.q, trial.model.u)
    rows = pd.read_csv(folder / f"trial_{trial.recorded.name}.csv")
    force, moment = chains.ground()
    np.testing.assert_allclose(force.real, rows["force_x [N]"], rtol=1e-9, atol=1e-8)
    np.testing.assert_allclose(force.imag, rows["force_y [N]"], rtol=1e-9)
    np.testing.assert_allclose(1e3 * moment / force.imag, rows["centre [mm]"], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(chains.strap("thigh").normal, rows["strap [N]"], rtol=1e-9, atol=1e-9)
    check_solution(told, prefix, folder, trial.recorded.name)


def check_solution(told: dict[str, float], prefix: str, folder: Path, name: str) -> None:
    """Nothing is left at the foot, and the torques are the written ones, within what the solver lets pass."""
    q, u, a, torque = solution(folder / f"solution_{name}.sto")
    found = Chains(told, prefix, q, u, a).torques()
    assert np.abs(torque).max() > 50.0
    np.testing.assert_allclose(found[:, :3], 0.0, atol=1e-4)
    np.testing.assert_allclose(found[:, 3:], torque, atol=1e-4)


def integrated(ends: np.ndarray, degree: float, motion: CollocatedMotion) -> tuple[np.ndarray, ...]:
    """Times and weights by the tables; states and controls at these points."""
    time, weights = over(ends, int(degree))
    assert len(time) == motion.controls[..., 0].size
    return time, weights, motion.states[:, 1:].reshape(len(time), -1), motion.controls.reshape(len(time), -1)


def phase_cost(
    told: dict[str, float],
    prefixes: tuple[str, str],
    tracks: Sequence[str],
    trial: StandingTrial,
    at: tuple[np.ndarray, ...],
    small: str,
) -> float:
    """By the formula of docs/theory/sit_to_stand.md, integrated; prefixes of the cost's rows and of the trial's."""
    (time, weights, x, u), (of, own) = at, prefixes
    n = x.shape[1] // 3
    chains = Chains(told, of, x[:, :n], x[:, n : 2 * n])
    force, moment = chains.ground()
    size = {
        name: told[f"{of}noise {name}"] for name in ("length", "angle", "rate", "force", "centre", "torque", "strap")
    }
    assert trial.torque is not None and trial.strap is not None
    channels = {
        "coordinates": (x[:, :n], trial.q, np.r_[size["length"], size["length"], np.full(n - 2, size["angle"])]),
        "rates": (x[:, n : 2 * n], trial.u, size["rate"]),
        "force": (np.column_stack([force.real, force.imag]), trial.force, size["force"]),
        "centre": ((moment / force.imag)[:, None], trial.centre[:, None], size["centre"]),
        "torque": (u[:, n:], trial.torque, size["torque"]),
        "strap": (chains.strap("thigh").normal[:, None], trial.strap[:, None], size["strap"]),
    }
    total = np.zeros(len(time))
    for name in tracks:
        model, recorded, sd = channels[name]
        total += told[f"{own} rate"] / told[f"{of}rate"] * squares(model - CubicSpline(trial.time, recorded)(time), sd)
    total += squares(u[:, :n], np.r_[np.full(3, told[f"{of}jerk foot"]), np.full(n - 3, told[f"{of}jerk joints"])])
    unseen, seen = chains.energies()
    kept = {
        "torques": squares(u[:, n:], 1.0),
        "energy": unseen**2,
        "whole energy": (unseen + seen) ** 2,
    }[small]
    return float((total + told[f"{of}weight {small.removeprefix('whole ')}"] * kept) @ weights)


IN_A = ("coordinates", "rates", "force", "centre")
PHASES = {"A": (IN_A, "torques"), "B": ((*IN_A, "torque", "strap"), "energy")}


def test_a_calibration_by_its_table(calibrated: tuple[StandingCalibrateResult, Path]) -> None:
    """Of another person and noise than the usual ones; forces and torques of B, costs of both phases."""
    found, folder = calibrated
    told, ends = read(folder)
    (trial,) = found.given.trials
    assert told["body trunk mass"] == pytest.approx((1.0 - 2 * (0.0137 + 0.0433 + 0.1416)) * 74.0, rel=1e-12)
    check_written(told, "phase B ", folder, found.trials[0])
    for phase in found.phases:
        of, (tracks, small) = f"phase {phase.name} ", PHASES[phase.name]
        at = integrated(ends[phase.name, "T1"], told[f"{of}T1 degree"], phase.found.motions[0])
        cost = phase_cost(told, (of, f"{of}T1"), tracks, trial, at, small) + belief(told, of)
        assert cost == pytest.approx(phase.found.objective, rel=1e-9), phase.name
        assert told[f"{of}T1 intervals"] == len(ends[phase.name, "T1"]) - 1
    assert told["phase A strap normal"] < 1e-6 < 100.0 < told["phase B strap normal"]
    assert told["phase A noise force"] == 3.0 and told["phase B noise strap"] == 1.5


def test_predictions_by_their_table(compared: tuple[StandingCompareResult, Path]) -> None:
    """Costs of all three predictors, and the forces and torques of each."""
    found, folder = compared
    told, ends = read(folder)
    given = {"all given": ("force", "centre", "torque"), "without ground reaction": ("torque",)}
    given["without torques"] = ("force", "centre")
    (trial,) = found.given.trials.trials
    for one in found.predictions:
        own = f"{one.name} P1"
        at = integrated(ends[one.name, "P1"], told[f"{own} degree"], one.motion)
        cost = phase_cost(told, ("", own), given[one.name], trial, at, "whole energy")
        assert cost == pytest.approx(one.objective, rel=1e-9), one.name
        chains = Chains(told, "", one.trial.model.q, one.trial.model.u)
        np.testing.assert_allclose(chains.ground()[0].imag, one.trial.model.force[:, 1], rtol=1e-9)
        np.testing.assert_allclose(chains.strap("thigh").normal, one.trial.model.strap, rtol=1e-9, atol=1e-9)
        # the first state is free within these of the smoothed recording: a polynomial of degree 7
        start, fit = one.motion.nodes[0], np.polynomial.Polynomial.fit(trial.time, trial.q[:, 5], 7)
        assert abs(start[5] - fit(0.0)) <= told["ends angle"] + 1e-6  # IPOPT relaxes bounds
    assert told["ends length"] == pytest.approx(3.0 * told["noise length"], rel=1e-9)


def test_a_prediction_has_the_same_table(compared: tuple[StandingCompareResult, Path], tmp_path: Path) -> None:
    found, folder = compared
    means = {name: of[MEAN] for name, of in found.trivial.items()}
    predicted = StandingPredictResult(
        record=found.record, options=found.options, given=found.given, predictions=found.predictions, means=means
    )
    predicted.write_numbers(tmp_path)
    for name in ("numbers.csv", "mesh.csv"):
        assert (tmp_path / name).read_text() == (folder / name).read_text()
    check_written(read(tmp_path)[0], "", tmp_path, found.predictions[0].trial)


def test_a_design_by_its_table(designed: tuple[StandingDesignResult, Path]) -> None:
    """Cost, help, forces and smooth peaks of every design; torques of the last from the written solution."""
    found, folder = designed
    told, ends = read(folder)
    (trial,) = found.given.trials.trials
    for one in found.designs:
        rows, (motion,) = dict(told), one.movement.found.motions
        # held parameters have one row, those that may be chosen one for each design
        rows |= {f"{one.name} {name}": told[name] for name in ("stiffness", "heel", "toe", "bottom", "radius")}
        rows |= {f"{one.name} {name}": told[name] for name in ("dissipation", "friction")}
        time, weights, x, u = integrated(ends[one.name, "P1"], told[f"{one.name} P1 degree"], motion)
        fits = [np.polynomial.Polynomial.fit(trial.time, q, int(told["habit degree"])) for q in trial.q[:, :6].T]
        wanted = np.column_stack([fit(time) for fit in fits])
        total = squares(x[:, :6] - wanted, [told["habit place"]] * 2 + [told["habit turn"]] * 4)
        total += ((x[:, 6:9].sum(axis=1) - x[:, 3:6].sum(axis=1)) / told["habit lean"]) ** 2
        total += told["habit jerk"] * squares(u[:, :9], 1.0) + told["habit torque"] * squares(u[:, 9:], 1.0)
        assert float(total @ weights) == pytest.approx(one.movement.found.objective, rel=1e-9), one.name
        chains = Chains(rows, f"{one.name} ", x[:, :9], x[:, 9:18])
        part = time / told[f"{one.name} P1 duration"]
        bell = np.exp(-0.5 * ((part - rows[f"{one.name} timing"]) / told["help width"]) ** 2)
        strap, order = chains.strap("thigh"), told["peak order"]
        for k, curve in enumerate((strap.normal, u[:, 10], sum(chains.energies()), strap.shear)):
            peak = float((np.abs(curve) ** order @ weights) / told[f"{one.name} P1 duration"]) ** (1.0 / order)
            mean = float(curve @ weights) / told[f"{one.name} P1 duration"]
            assert one.movement.asked.sizes[k] == pytest.approx(mean if k == 2 else peak, rel=1e-9)
        np.testing.assert_allclose(
            Chains(rows, f"{one.name} ", x[:, :9], x[:, 9:18], x[:, 18:27]).torques()[:, 3:],
            np.column_stack([u[:, 9:12], 0.0 * part, rows[f"{one.name} share"] * bell * u[:, 10], u[:, 12]]),
            atol=1e-4,
        )
    assert told["chosen limit of the knee"] == pytest.approx(0.9 * found.designs[0].movement.asked.largest[1], rel=1e-9)
    check_solution(rows, "chosen ", folder, "P1")
