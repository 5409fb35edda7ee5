"""Displacements of both chains, as the base model `sit_to_stand` takes them: its force is the strap's normal one."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.sit_to_stand.exports import motion_table, write_strap_case
from geocontact.chain.differentiated_inputs import recorded
from geocontact.data.parameter import Parameter
from geocontact.standing_up.chain import EVERY_PLANTED, Subject
from geocontact.standing_up.exoskeleton import DAMPING, STRAP_PARAMETERS, STRAP_PLANTED, with_exoskeleton
from geocontact.standing_up.strap import strap_motion
from geocontact.standing_up.trials import StandingTrial
from geocontact.systems import sit_to_stand
from tests.systems.examples import recording

SUBJECT = Subject()
P = np.r_[EVERY_PLANTED, STRAP_PLANTED]
VALUES = {each.name: each.value(float(p)) for each, p in zip(STRAP_PARAMETERS, STRAP_PLANTED, strict=True)}
TIME = np.linspace(0.0, 1.0, 101)


def stood_up(slower: float = 1.0) -> StandingTrial:
    """Both chains rise, the exoskeleton's beside the person's; the mat sees the strap at rest in each posture."""
    from casadi import Function

    s = np.sin(0.5 * np.pi * slower * TIME) ** 2
    seated = np.array([0.0, 0.083, 0.0, -0.4, 1.6, -2.0, -0.42, 1.66, -1.9])
    q = seated + s[:, None] * (np.array([0.0, 0.083, 0.0, -0.07, 0.14, -0.14, -0.06, 0.13, -0.1]) - seated)
    model = with_exoskeleton(SUBJECT)
    e = model.equations
    normal = Function("normal", [e.q, e.u, e.p], [model.strap])
    force = np.array([float(normal(row, np.zeros(9), P)) for row in q])
    return StandingTrial(TIME, q, 0.0 * q, np.zeros((101, 2)), 0.0 * TIME, "T1", None, force)


def test_the_base_model_s_force_is_the_strap_s() -> None:
    trial = stood_up()
    moved = strap_motion(SUBJECT, trial.q, VALUES["strap place"])
    columns = {name.split(" ")[0]: column.to_numpy() for name, column in motion_table(trial, moved).items()}
    signals = recording("T1", TIME, {name: of for name, of in columns.items() if name != "time"})
    known = (Parameter("k_n_thigh", "N/m", VALUES["strap normal"], 1.0, 1e5),)
    force = {}
    for b in (0.0, DAMPING):
        system = sit_to_stand.build(known, {"rho_thigh": 0.0, "b": b}, {})
        force[b] = system.simulate(signals, system.start)[:, 0]
    assert trial.strap is not None and np.ptp(trial.strap) > 20.0
    np.testing.assert_allclose(force[0.0], trial.strap, rtol=1e-12, atol=1e-12 * np.abs(trial.strap).max())
    rate = recorded(signals.signals, system.inputs).rate[0]
    np.testing.assert_allclose(force[DAMPING], trial.strap + DAMPING * rate, rtol=1e-12, atol=1e-11)


def test_a_strap_that_sits_elsewhere_is_the_lever() -> None:
    trial, below = stood_up(), 0.02
    there, taken = (strap_motion(SUBJECT, trial.q, VALUES["strap place"] + off) for off in (-below, 0.0))
    assert np.abs(there.normal - taken.normal).max() > 5e-4
    np.testing.assert_allclose(there.normal, taken.normal + below * taken.rotation, atol=1e-5)


def test_written_files_gather_to_a_case(tmp_path: Path) -> None:
    trials = [stood_up(), StandingTrial(**{**vars(stood_up(0.9)), "name": "T2"})]
    write_strap_case(tmp_path / "none", SUBJECT, trials[:1], VALUES)
    assert not (tmp_path / "none").exists()
    write_strap_case(tmp_path / "gap", SUBJECT, trials, VALUES)
    gc.gather(tmp_path / "gap" / "gather.toml").write(tmp_path / "case")
    case = gc.read_gap_case(tmp_path / "case")
    system, values = gc.system_of(case), {each.name: each.start for each in case.parameters}
    (held_out,) = case.evaluation
    assert held_out.name == "T2" and trials[1].strap is not None
    damped = DAMPING * recorded(held_out.signals, system.inputs).rate[system.inputs.index("thigh_normal")]
    np.testing.assert_allclose(system.simulate(held_out, values)[:, 0] - damped, trials[1].strap, atol=1e-8)


@pytest.mark.parametrize(("count", "held"), [(2, 1), (3, 1), (4, 2), (5, 2)])
def test_two_of_four_trials_are_held_out(tmp_path: Path, count: int, held: int) -> None:
    """A diagnosis takes two held out at least, and two to fit to."""
    base = stood_up()
    trials = [StandingTrial(**{**vars(base), "name": f"T{k}"}) for k in range(count)]
    write_strap_case(tmp_path, SUBJECT, trials, VALUES)
    text = tomllib.loads((tmp_path / "gather.toml").read_text())
    assert text["evaluation"] == [f"T{k}" for k in range(count - held, count)]
    assert text["calibration"] == [f"T{k}" for k in range(count - held)]
