"""What is written for other programs: `geocontact id` finds the torques again; OpenSim and ParaView can read it."""

from __future__ import annotations

import warnings
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.sit_to_stand.exports import write_motion, write_solution, write_standing_model
from geocontact.io.opensim.external_loads import read_external_loads
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import EVERY_PLANTED, Subject
from geocontact.standing_up.exoskeleton import LEGS, STRAP_PLANTED, WORN_PARAMETERS, strapped, with_exoskeleton
from geocontact.standing_up.phase import JudgedMotion
from geocontact.standing_up.strap import strap_force
from geocontact.standing_up.strap_sites import STRAP_SITES
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial, seen_in, standing_up
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

SUBJECT = Subject()
MODEL = strapped(SUBJECT, STRAP_SITES, seated=True)
P = np.r_[EVERY_PLANTED, STRAP_PLANTED, STRAP_PLANTED[:3], 0.3, STRAP_PLANTED[:3], 0.1]
VALUES = {each.name: each.value(float(p)) for each, p in zip(MODEL.parameters, P, strict=True)}
STRAPS = {"strap": "thigh", "shank_strap": "shank", "pelvis_strap": "trunk"}
BODIES = ["foot", "trunk", "thigh", "exo_thigh", "shank", "exo_shank", "trunk", "exo_module"]
TIME = np.linspace(0.0, 1.0, 101)
SEATED = np.array([0.0, 0.083, 0.0, -0.4, 1.6, -2.0, -0.42, 1.66, -1.9])
UP = np.array([0.0, 0.083, 0.0, -0.07, 0.14, -0.14, -0.06, 0.13, -0.1])
WORN_P = np.r_[EVERY_PLANTED, STRAP_PLANTED]
WORN_NAMES = with_exoskeleton(Subject()).equations.names
POSTURE = np.array([0.0, 0.083, 0.0, -0.3, 1.2, -1.6, -0.3, 1.2, -1.6])


def moved() -> tuple[TrialResult, np.ndarray, np.ndarray]:
    """Both chains rise off a chair on their own path; torques of the joints, what is left over at the foot, force along
    the thigh's strap.

    Nobody's motion: the foot stands still, whatever the balance asks of the ground.
    """
    from casadi import Function

    turn = np.pi * TIME[:, None]
    q = SEATED + (UP - SEATED) * np.sin(0.5 * turn) ** 2
    u = (UP - SEATED) * 0.5 * np.pi * np.sin(turn)
    a = (UP - SEATED) * 0.5 * np.pi**2 * np.cos(turn)
    e = MODEL.equations
    chair = np.column_stack([20.0 * (1.0 - TIME), 300.0 * (1.0 - TIME), -90.0 * (1.0 - TIME)])
    outputs = [e.balance, MODEL.force, MODEL.centre, MODEL.strap, MODEL.shear]
    seen = Function("seen", [e.q, e.u, e.a, e.w, e.p], outputs).map(len(TIME))
    given = np.vstack([np.zeros((6, len(TIME))), chair.T])
    many = seen(q.T, u.T, a.T, given, np.tile(P[:, None], (1, len(TIME))))
    balance, force, centre, strap, shear = (each.full().T for each in many)
    trial = StandingTrial(TIME, q, u, force, centre[:, 0], "T1", -balance[:, 3:], strap[:, 0], chair)
    none = np.zeros(len(TIME))
    return (
        TrialResult(
            recorded=trial, model=trial, points=trial, acceleration=a, judged=JudgedMotion(None, TIME, none, none)
        ),
        (-balance[:, :3]),
        shear[:, 0],
    )


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("exports")
    write_motion(folder, SUBJECT, moved()[0], VALUES, True)
    write_standing_model(folder / "model.osim", SUBJECT, VALUES, worn=True)
    return folder


def test_force_of_the_strap_is_that_of_the_equations() -> None:
    trial, _, shear = moved()
    found = strap_force(SUBJECT, trial.model.q, trial.model.u, VALUES)
    assert trial.model.strap is not None
    np.testing.assert_allclose(np.linalg.norm(found.force, axis=1), np.hypot(trial.model.strap, shear), rtol=1e-7)
    assert np.abs(shear).max() > 5.0 and np.abs(found.moment[:, 2]).max() > 1.0


def test_inverse_dynamics_of_what_is_written_finds_the_torques(written: Path) -> None:
    """With the straps as external loads in place of the model's bushing, and with the bushing in place of them."""
    trial, left, _ = moved()
    alone = (written / "loads_T1.xml").read_text()
    first = alone.index('<ExternalForce name="strap_force"')
    (written / "ground.xml").write_text(alone[:first] + alone[alone.index("\t\t</objects>") :])
    names = MODEL.equations.names
    for loads, exclude in (("loads_T1.xml", tuple(STRAPS)), ("ground.xml", ())):
        options = {"model": written / "model.osim", "loads": written / loads, "cutoff": 0.0}
        if exclude:
            options["exclude"] = exclude
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", gc.InputWarning)  # a strap that hardly presses, a foot that is held
            found = gc.inverse_dynamics(written / "coordinates_T1.mot", **options)
        inside = slice(5, -5)  # ends of the spline
        for k, name in enumerate(names):
            wanted = left[:, k] if k < 3 else trial.model.torque[:, k - 3]
            theirs = found.table()[f"{name}_force [N]" if k < 2 else f"{name}_moment [N m]"].to_numpy()
            np.testing.assert_allclose(theirs[inside], wanted[inside], atol=0.05, err_msg=f"{loads} {name}")


def test_lines_over_time_carry_the_forces(written: Path) -> None:
    trial, _, _ = moved()
    collection = ET.parse(written / "forces_T1.pvd").getroot()
    files = [each.get("file") for each in collection.iter("DataSet")]
    assert len(files) == len(TIME)
    frame = ET.parse(written / str(files[0])).getroot()
    (force,) = [each for each in frame.iter("DataArray") if each.get("Name") == "force [N]"]
    rows = np.array(str(force.text).split(), float).reshape(-1, 3)
    assert trial.model.strap is not None
    np.testing.assert_allclose(rows[0, :2], trial.model.force[0], rtol=1e-5)
    for site, row in zip(STRAP_SITES, rows[-5::2], strict=True):
        of_strap = strap_force(SUBJECT, trial.model.q[:1], trial.model.u[:1], VALUES, site).force[0]
        np.testing.assert_allclose(row, of_strap, rtol=1e-5, atol=1e-9)
    assert (rows[1:-5] == 0.0).all() and (rows[-4::2] == 0.0).all()


def test_straps_push_back_on_the_exoskeleton(written: Path) -> None:
    data, loads = read_external_loads(written / "loads_T1.xml")
    assert [load.body for load in loads] == BODIES
    table = read_table(data)
    trial, _, _ = moved()
    for site, (name, body) in zip(STRAP_SITES, STRAPS.items(), strict=True):
        one, other = (table.column(f"{name}_{way}_vx") for way in ("force", "back_force"))
        np.testing.assert_array_equal(one, -other)
        whole = np.hypot(one, table.column(f"{name}_force_vy"))
        own = strap_force(SUBJECT, trial.model.q, trial.model.u, VALUES, site).force
        count = 1 if body == "trunk" else LEGS
        np.testing.assert_allclose(whole, count * np.linalg.norm(own, axis=1), rtol=1e-8)


@pytest.mark.oracle
def test_opensim_reads_the_loads(opensim: Elsewhere, written: Path) -> None:
    loads = opensim(opensim_oracle.external_loads, written / "loads_T1.xml")
    assert [load[1] for load in loads] == BODIES


def written_model(file: Path) -> Path:
    """The model of planted parameters."""
    values = {each.name: each.value(float(p)) for each, p in zip(WORN_PARAMETERS, WORN_P, strict=True)}
    write_standing_model(file, Subject(), values, worn=True)
    return file


@pytest.mark.oracle
def test_opensim_accelerates_the_written_chains_as_the_equations_do(opensim: Elsewhere, tmp_path: Path) -> None:
    """On a standing foot and on one that slides, sinks and turns, with the strap displaced and turned."""
    file, rng = written_model(tmp_path / "standing.osim"), np.random.default_rng(4)
    q = POSTURE + rng.normal(size=(4, 9)) * np.r_[np.full(3, 1e-3), np.full(6, 1e-2)]
    u = 0.1 * rng.normal(size=(4, 9))
    still = u.copy()
    still[:, :3] = 0.0
    theirs = opensim(opensim_oracle.accelerations, file, WORN_NAMES, np.vstack([q, q]), np.vstack([still, u]))

    own = with_exoskeleton(Subject()).equations.accelerations()
    rates = zip(np.vstack([q, q]), np.vstack([still, u]), strict=True)
    ours = np.array([own(a, b, [], np.zeros(6), WORN_P).full().ravel() for a, b in rates])
    np.testing.assert_allclose(theirs, ours, rtol=1e-6, atol=1e-5)


@pytest.mark.oracle
def test_what_is_written_solves_the_model_that_is_written(opensim: Elsewhere, tmp_path: Path) -> None:
    """A rise of both chains on few intervals: at its points OpenSim's accelerations are those of the file."""
    model = with_exoskeleton(Subject())
    _, found = standing_up(model, Subject(), planted=WORN_P, intervals=12)
    (motion,), n = found.motions, model.count
    points = seen_in(model, motion, WORN_P, motion.held_times[:-1], "T1")
    none = np.zeros(len(points.time))
    trial = TrialResult(
        recorded=points,
        model=points,
        points=points,
        acceleration=motion.state(points.time)[:, 2 * n : 3 * n],
        judged=JudgedMotion(None, points.time, none, none),
    )
    write_solution(tmp_path / "solution_T1.sto", trial, found.solved)
    told, theirs = opensim(opensim_oracle.solved, written_model(tmp_path / "model.osim"), tmp_path / "solution_T1.sto")
    assert len(told) == 49 and np.abs(told).max() > 5.0
    np.testing.assert_allclose(theirs, told, rtol=0.0, atol=1e-6)
