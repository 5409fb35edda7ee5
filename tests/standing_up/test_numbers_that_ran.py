"""Numbers are read from what the equations were built of: other constants than the usual ones stand in the table."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from casadi import Function, vertcat

from geocontact.dynamics.sphere_contact import StribeckFriction
from geocontact.standing_up import chain, exoskeleton
from geocontact.standing_up import chain as feet
from geocontact.standing_up.chain import FOOT_PARAMETERS, Subject, feet_on_ground
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.numbers_that_ran import (
    Ran,
    belief_numbers,
    model_numbers,
    parameter_numbers,
    size_numbers,
)
from geocontact.standing_up.person_segments import SHARES
from geocontact.standing_up.phases import phase_a
from geocontact.standing_up.standing_model import GroundLaw, StandingModel
from geocontact.standing_up.strap_sites import STRAP_SITES
from geocontact.standing_up.trials import CostWeights, StandingNoise, StandingTrial
from geocontact.standing_up.worn_device import DeviceMasses, WornDevice
from tests.standing_up.from_table import Chains, belief

SUBJECT = Subject(81.0, 1.69, WornDevice(DeviceMasses(foot_plate=1.3, thigh=4.7)))
ODD = WornDevice(
    SUBJECT.device.masses,
    knee_above=0.017,
    along=(0.21, 0.17, 0.11),
    across=(0.012, -0.023, -0.041),
    inertias=(0.07, 0.06, 0.043),
)
"""Set to the person by another height, with own mass centres and inertias."""
OWN = replace(ODD, lengths=(0.433, 0.397), module_height=0.31)
"""Of own lengths, which are not the person's."""
FOOT = [5e6, -0.04, 0.13, 0.09, 0.03, 1.2, 1.1]
STRAPS = [4e3, 2.2e3, 31.0, 0.21, 3.1e3, 1.7e3, 19.0, 0.26, 5.3e3, 2.9e3, 23.0, 0.08]


@pytest.fixture
def unusual(monkeypatch: pytest.MonkeyPatch) -> None:
    """Constants that nobody uses."""
    law = GroundLaw(StribeckFriction(0.13, 0.8, 0.5, 0.3), 250.0, 40.0, 2e-5)
    monkeypatch.setattr(feet, "GROUND_LAW", law)
    monkeypatch.setattr(exoskeleton, "GROUND_LAW", law)
    monkeypatch.setattr(chain, "GRAVITY", np.array([0.3, -9.5, 0.0]))
    monkeypatch.setitem(SHARES["male"], "shank", replace(SHARES["male"]["shank"], gyration=0.3, centre=0.6))


def values(model: StandingModel) -> np.ndarray:
    """What is searched of any values."""
    return np.array([each.searched(x) for each, x in zip(model.parameters, [*FOOT, *STRAPS], strict=False)])


def told(*rows: Ran) -> dict[str, float]:
    found = {row.number: row.value for row in rows}
    assert len(found) == len(rows), "two rows have one name"
    assert all(row.unit and row.source in ("paper", "derived", "invented") for row in rows)
    return found


@pytest.mark.parametrize("device", [None, SUBJECT.device, ODD, OWN])
def test_the_table_alone_moves_as_the_equations_do(unusual: None, device: WornDevice | None) -> None:
    """Forces, straps, energies and the whole balance at anything, with straps at all sites that are not alike."""
    above, worn = (0.017, 0.004, -0.021), device is not None
    sites = [
        replace(site, damping=7.0 + k, turning_damping=0.2 + k, above=above[k]) for k, site in enumerate(STRAP_SITES)
    ]
    model = strapped(replace(SUBJECT, device=device), sites) if device is not None else feet_on_ground(SUBJECT)
    e, n, p = model.equations, model.count, values(model)
    rng = np.random.default_rng(5)
    on_ground = rng.normal(size=4), 0.08 + 0.003 * rng.normal(size=4), 0.02 * rng.normal(size=4)
    q = np.column_stack([*on_ground, 0.3 * rng.normal(size=(4, n - 3))])
    u, a = rng.normal(size=(4, n)) * np.r_[0.1, 0.1, 0.1, np.ones(n - 3)], 3.0 * rng.normal(size=(4, n))
    chains = Chains(told(*model_numbers(model), *parameter_numbers(model.parameters, p)), "", q, u, a)
    outputs = [e.balance, model.force, model.centre, model.straps, vertcat(model.energy, model.normal_energy)]
    at = Function("at", [e.q, e.u, e.a, e.w, e.p], outputs).map(4)
    found = at(q.T, u.T, a.T, np.zeros((e.w.numel(), 4)), np.tile(p[:, None], (1, 4)))
    balance, force, centre, straps, energy = (each.full() for each in found)
    size = np.abs(balance).max()
    np.testing.assert_allclose(-chains.torques().T, balance, rtol=1e-9, atol=1e-9 * size)
    ours, moment = chains.ground()
    np.testing.assert_allclose([ours.real, ours.imag], force, rtol=1e-9)
    np.testing.assert_allclose(moment / ours.imag, centre[0], rtol=1e-9)
    assert chains.sites == (("thigh", "shank", "pelvis") if worn else ())
    if worn:
        np.testing.assert_allclose([chains.strap(site).normal for site in chains.sites], straps, rtol=1e-9)
        np.testing.assert_allclose(chains.energies(), energy, rtol=1e-9)


def test_masses_that_the_study_gives_are_not_called_invented() -> None:
    """Foot plates and thigh were weighed, shank and module were not; with an identified device only its masses are."""
    rows = {row.number: row for row in model_numbers(strapped(SUBJECT, STRAP_SITES))}
    assert [(rows[f"body exo_{part} mass"].source) for part in ("shank", "thigh", "module")] == [
        "invented",
        "derived",
        "invented",
    ]
    assert rows["body exo_thigh mass"].value == 4.7 and "as the study has it" in rows["body exo_thigh mass"].note
    assert rows["body exo_thigh inertia"].source == "invented", "a uniform rod"
    assert rows["body foot mass"].note.endswith("with foot plates, as the study has it")
    shipped = {row.number: row for row in model_numbers(strapped(Subject(81.0, 1.69), STRAP_SITES))}
    assert shipped["body foot mass"].note.endswith("with foot plates, which are invented")
    assert shipped["body exo_thigh mass"].source == "invented"
    alone = {row.number: row for row in model_numbers(feet_on_ground(SUBJECT))}
    assert "foot plates" not in alone["body foot mass"].note
    device = replace(SUBJECT.device, parts=SUBJECT.device.bodies((0.4, 0.4, 0.2)))
    found = {row.number: row for row in model_numbers(strapped(replace(SUBJECT, device=device), STRAP_SITES))}
    assert found["body exo_shank inertia"].source == "derived" and found["body exo_shank mass"].source == "invented"


def test_sizes_and_beliefs_are_those_of_the_cost() -> None:
    """Jerk of 7 m/s³ and 8 rad/s³ counts as 1; the weight of the torques and what is believed of two lengths."""
    model, time = feet_on_ground(SUBJECT), np.linspace(0.0, 1.0, 41)
    flat = np.tile(np.r_[0.05, 0.082, np.zeros(4)], (41, 1))
    trial = StandingTrial(time, flat, 0.0 * flat, np.tile([20.0, 700.0], (41, 1)), np.full(41, 0.06))
    noise = StandingNoise(force=7.0, centre=2.3e-3)
    phase = phase_a(
        model,
        SUBJECT,
        [trial],
        noise,
        free=("toe", "stiffness"),
        start=values(model),
        weights=CostWeights(foot_jerk=7.0, joint_jerk=8.0),
    )
    assert phase.sizes is not None
    p, s = values(model), phase.control.system
    table = told(*size_numbers(phase.sizes), *belief_numbers(phase), *parameter_numbers(FOOT_PARAMETERS, p))
    rng = np.random.default_rng(6)
    u, x = rng.normal(size=9), np.r_[flat[0], rng.normal(size=12)]
    wanted = phase.control.trials[0].inputs(np.array([0.5]))[0]
    at = Function(
        "at", [s.x, s.u, s.w, s.p], [phase.terms["jerk"], phase.terms["torques"], phase.terms["rates"], s.prior]
    )
    jerk, torques, rates, prior = (float(each) for each in at(x, u, wanted, p))
    sizes = np.r_[np.full(3, table["jerk foot"]), np.full(3, table["jerk joints"])]
    assert jerk == pytest.approx(np.sum((u[:6] / sizes) ** 2), rel=1e-9)
    assert torques == pytest.approx(table["weight torques"] * np.sum(u[6:] ** 2), rel=1e-9)
    counted = trial.rate / table["rate"]
    assert rates == pytest.approx(counted * np.sum((x[6:12] / table["noise rate"]) ** 2), rel=1e-9)
    assert prior == pytest.approx(belief(table, ""), rel=1e-9) and prior > 0.0
    assert table["noise force"] == 7.0 and (table["toe least"], table["toe most"]) == (0.05, 0.22)
