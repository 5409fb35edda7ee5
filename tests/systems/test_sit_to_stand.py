"""Base model of the strapped sites, F = k u + b u', written out again; effects at one site, at all, at fewer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.systems import sit_to_stand
from geocontact.systems.catalogue import system_of
from tests.systems.examples import LEVERS, SITES_CONSTANTS, STIFFNESS, example, recording, sites, sites_trial

SYSTEM, TRIALS = example("sit_to_stand")
B = SITES_CONSTANTS["b"]


def deflection(trial: Trial, site: str) -> tuple[np.ndarray, np.ndarray]:
    moved = recorded(trial.signals, SYSTEM.inputs)
    normal, rotation = moved.row(f"{site}_normal"), moved.row(f"{site}_rotation")
    return tuple(each[normal] + LEVERS[site] * each[rotation] for each in (moved.position, moved.rate))  # type: ignore[return-value]


def candidate(wanted: str, system: System = SYSTEM) -> Candidate:
    return next(each for each in candidates(system) if each.label == wanted)


def label(one: Candidate) -> str:
    return one.label


def with_effect(wanted: str, **values: float) -> np.ndarray:
    one = candidate(wanted)
    given = {p.name: values[p.name.split(".")[-1]] for p in one.parameters}
    return one.apply(SYSTEM).simulate(TRIALS[0], {**SYSTEM.start, **given})


def base(trial: Trial = TRIALS[0]) -> np.ndarray:
    return SYSTEM.simulate(trial, SYSTEM.start)


def test_each_site_is_a_spring_and_a_dashpot() -> None:
    for column, site in enumerate(sit_to_stand.SITES):
        u, rate = deflection(TRIALS[0], site)
        np.testing.assert_allclose(base()[:, column], STIFFNESS[site] * u + B * rate, rtol=1e-11, atol=1e-11)


def test_the_tangential_displacement_does_not_matter() -> None:
    trial = sites_trial("t", 2.3)
    columns = {n: np.zeros(len(trial)) if "tangential" in n else trial.column(n) for n in SYSTEM.inputs}
    still = SYSTEM.simulate(recording("t", trial.time, columns), SYSTEM.start)
    np.testing.assert_array_equal(still, SYSTEM.simulate(trial, SYSTEM.start))
    assert set(SYSTEM.spare) == {f"{site}_tangential" for site in sit_to_stand.SITES}
    assert not [one.label for one in candidates(SYSTEM) if "tangential" in one.label]


@pytest.mark.parametrize("one", [one for one in candidates(SYSTEM) if one.variant.endswith("thigh")], ids=label)
def test_what_is_at_the_thigh_leaves_the_other_sites_alone(one: Candidate) -> None:
    full = one.apply(SYSTEM)
    got = full.simulate(TRIALS[1], {**SYSTEM.start, **one.starts[-1]})
    np.testing.assert_array_equal(got[:, [0, 2]], base(TRIALS[1])[:, [0, 2]])
    assert all(p.name.split(".")[-2] == "thigh" for p in one.parameters)


def test_a_site_alone_is_that_site_among_others() -> None:
    alone = SYSTEM.at("thigh")
    assert alone.inputs == tuple(f"thigh_{motion}" for motion in sit_to_stand.MOTIONS)
    assert alone.outputs == ("thigh_force",)
    np.testing.assert_array_equal(alone.simulate(TRIALS[0], SYSTEM.start), base()[:, [1]])
    assert alone.scale.deflection == pytest.approx(np.abs(deflection_of_all("thigh")).max())
    assert SYSTEM.scale.deflection == max(SYSTEM.at(site).scale.deflection for site in SYSTEM.places)
    with pytest.raises(ValueError, match="no place foot; it has pelvis, thigh, shank"):
        SYSTEM.at("foot")


def deflection_of_all(site: str) -> np.ndarray:
    return np.concatenate([deflection(trial, site)[0] for trial in TRIALS])


def test_stiffening_at_one_site() -> None:
    force = with_effect("stiffening.thigh", gain=0.8, exponent=2.0)[:, 1]
    u, rate = deflection(TRIALS[0], "thigh")
    largest = np.abs(deflection_of_all("thigh")).max()
    want = STIFFNESS["thigh"] * u * (1.0 + 0.8 * (u / largest) ** 2) + B * rate
    np.testing.assert_allclose(force, want, rtol=1e-10, atol=1e-10)


def test_stiffening_everywhere_is_alike_over_the_deflection_of_each_site() -> None:
    force = with_effect("stiffening", gain=0.8, exponent=2.0)
    for column, site in enumerate(sit_to_stand.SITES):
        single = with_effect(f"stiffening.{site}", gain=0.8, exponent=2.0)
        np.testing.assert_allclose(force[:, column], single[:, column], rtol=1e-12)
    assert len({SYSTEM.at(site).scale.deflection for site in SYSTEM.places}) == 3


def test_a_lever_that_changes_with_its_own_rotation() -> None:
    force = with_effect("axis_migration.shank", slope=0.5, curvature=-2.0)[:, 2]
    columns = {name: TRIALS[0].column(name) for name in SYSTEM.inputs}
    turn = columns["shank_rotation"]
    angle = turn - SYSTEM.scale.centre["shank_rotation"]
    u = columns["shank_normal"] + (LEVERS["shank"] + 0.5 * angle - 2.0 * angle**2) * turn
    want = STIFFNESS["shank"] * u + B * np.gradient(u, TRIALS[0].time)
    np.testing.assert_allclose(force[5:-5], want[5:-5], atol=0.02 * B * np.abs(np.gradient(u, 0.02)).max())
    slow = replace(SYSTEM, constants={"b": 0.0})
    values = {**SYSTEM.start, "axis_migration.shank.slope": 0.5, "axis_migration.shank.curvature": -2.0}
    still = candidate("axis_migration.shank").apply(slow).simulate(TRIALS[0], values)[:, 2]
    np.testing.assert_allclose(still, STIFFNESS["shank"] * u, rtol=1e-10, atol=1e-10)


def test_two_springs_in_series_share_the_displacement() -> None:
    without = replace(SYSTEM, constants={"b": 0.0})
    c = 5e-5
    values = {**SYSTEM.start, "series_compliance.pelvis.compliance": c, "series_compliance.pelvis.exponent": 1.0}
    force = candidate("series_compliance.pelvis").apply(without).simulate(TRIALS[0], values)
    u, _ = deflection(TRIALS[0], "pelvis")
    k = STIFFNESS["pelvis"]
    np.testing.assert_allclose(force[:, 0], k * u / (1.0 + k * c), rtol=1e-8, atol=1e-8)


def test_a_pad_that_lost_contact_carries_what_exceeds_its_opening() -> None:
    force = with_effect("contact_loss.pelvis", opening=25.0, rounding=0.0)
    np.testing.assert_allclose(force[:, 0], np.maximum(base()[:, 0] - 25.0, 0.0), rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(force[:, 1:], base()[:, 1:])
    pushes = with_effect("contact_loss", opening=0.0, rounding=0.0)
    assert base().min() < 0.0
    np.testing.assert_allclose(pushes, np.maximum(base(), 0.0), rtol=1e-12)


def test_a_stop_is_offered_where_it_is_only() -> None:
    offered = {one.label for one in candidates(SYSTEM) if one.name == "end_stop"}
    want = {f"end_stop.{side}{buffer}" for side in ("upper", "lower") for buffer in ("", ".buffer")}
    assert offered == {f"{stop}.{site}" for stop in want for site in sit_to_stand.SITES}


@pytest.mark.parametrize("some", [("pelvis", "shank"), ("thigh",)])
def test_fewer_sites_work_as_they_do_among_all(some: tuple[str, ...]) -> None:
    chosen = tuple(p for p in sites().parameters if p.name.rpartition("_")[2] in some)
    columns = {n: TRIALS[0].column(n) for n in TRIALS[0].signals.channels if n.partition("_")[0] in some}
    trials = tuple(recording(name, TRIALS[0].time, columns) for name in ("t1", "t2"))
    system = system_of(GapCase("few", "sit_to_stand", trials[:1], trials[1:], chosen, SITES_CONSTANTS))
    assert system.places == some
    assert system.outputs == tuple(f"{site}_force" for site in some)
    places = [sit_to_stand.SITES.index(site) for site in some]
    np.testing.assert_array_equal(system.simulate(trials[0], system.start), base()[:, places])
    labels = [one.label for one in candidates(system) if one.name == "damping"]
    assert labels == [f"damping.{site}" for site in some] + (["damping"] if len(some) > 1 else [])
    for one in candidates(system):
        one.apply(system).simulate(trials[0], {**system.start, **one.starts[0]})


def test_sites_remember_apart() -> None:
    """Exchanged motions of two sites with the same numbers give exchanged forces, relaxation and friction included."""
    alike = {**SYSTEM.start, "k_n_thigh": 4000.0, "k_n_pelvis": 4000.0, "rho_thigh": 0.02, "rho_pelvis": 0.02}
    other = {"pelvis": "thigh", "thigh": "pelvis", "shank": "shank"}
    columns = {n: TRIALS[0].column(other[n.partition("_")[0]] + "_" + n.partition("_")[2]) for n in SYSTEM.inputs}
    exchanged = recording("t0", TRIALS[0].time, columns)
    both = candidate("dry_friction.stroke").apply(candidate("relaxation").apply(SYSTEM))
    values = {**alike, "relaxation.ratio": 0.6, "relaxation.tau": 0.4}
    values |= {"dry_friction.stroke.limit": 4.0, "dry_friction.stroke.reach": 5e-4}
    there, back = (both.simulate(trial, values) for trial in (TRIALS[0], exchanged))
    np.testing.assert_allclose(there, back[:, [1, 0, 2]], rtol=1e-12, atol=1e-12)


K = (Parameter("k_n_thigh", "N/m", 5e3, 1e3, 2e4),)


@pytest.mark.parametrize(
    ("parameters", "constants", "words"),
    [
        ((), {"b": 80.0}, "no stiffness is given; name k_n_<site> for at least one of pelvis, thigh, shank"),
        (K, {"b": 80.0}, "rho_thigh is missing; give it as a parameter or as a constant"),
        (K, {"rho_thigh": 0.0}, "b is missing"),
        (K, {"b": 80.0, "rho_thigh": 0.0, "k_n_hip": 1.0}, r"no site hip \(k_n_hip\); there are pelvis, thigh, shank"),
    ],
)
def test_what_a_case_lacks_is_named(parameters: tuple[Parameter, ...], constants: dict[str, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        sit_to_stand.build(parameters, constants, {})
