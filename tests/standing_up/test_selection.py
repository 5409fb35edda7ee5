"""Parameters that trials identify together: by closed forms, all subsets, trials solved again, and shipped ones."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.standing_up.calibrated_phase import PhaseSearch
from geocontact.standing_up.calibration import calibrated_phases
from geocontact.standing_up.chain import FOOT_PARAMETERS, Subject, feet_on_ground
from geocontact.standing_up.phase import RATE
from geocontact.standing_up.phases import phase_a
from geocontact.standing_up.selection import LEAST, selected, trials_information
from geocontact.standing_up.trials import StandingNoise, recorded, standing_up
from tests.cli.calls import MESHES
from tests.recording import opened

NAMES = ("a", "b", "c", "d")


def least_of(information: np.ndarray, chosen: tuple[int, ...]) -> float:
    """Least of what is known of each of a subset: 1 over the largest variance, by the inverse."""
    return float(1.0 / np.diag(np.linalg.inv(information[np.ix_(chosen, chosen)])).max())


def test_independent_parameters_are_taken_by_what_is_known_of_them() -> None:
    """The prior's deviation is halved by 3 times its information."""
    rows = selected(NAMES, np.diag([50.0, 2.9, 400.0, 3.1]))
    assert LEAST == 3.0 and [(row.name, row.turn, row.outcome) for row in rows] == [
        ("c", 1, "identified"),
        ("a", 2, "identified"),
        ("d", 3, "identified"),
        ("b", 0, "not identified"),
    ]
    assert [row.alone for row in rows] == [400.0, 50.0, 3.1, 2.9]


def test_two_numbers_that_act_as_one_are_coupled() -> None:
    """Correlation r of the recordings' slopes leaves (1 - r²) of what is known of the second."""
    r = 0.999
    information = np.array([[900.0, r * 30.0 * 20.0, 0.0], [r * 30.0 * 20.0, 400.0, 0.0], [0.0, 0.0, 10.0]])
    rows = {row.name: row for row in selected(("height", "radius", "heel"), information)}
    assert rows["height"].turn == 1 and rows["heel"].turn == 2
    assert (rows["radius"].outcome, rows["radius"].partner) == ("coupled", "height")
    assert rows["radius"].beside == pytest.approx(400.0 * (1.0 - r**2), rel=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_what_is_taken_is_identified_and_nothing_can_be_added(seed: int) -> None:
    """By the inverses of all subsets: every number of the set is known, and with any further one some is not."""
    rng = np.random.default_rng(seed)
    slopes = rng.normal(size=(40, 4)) @ np.diag([3.0, 1.0, 0.3, 2.0]) @ rng.normal(size=(4, 4))
    information = slopes.T @ slopes / 20.0
    taken = tuple(NAMES.index(row.name) for row in selected(NAMES, information) if row.turn)
    assert taken and least_of(information, taken) >= LEAST
    for k in set(range(4)) - set(taken):
        assert least_of(information, (*taken, k)) < LEAST
    fit = [s for n in range(1, 5) for s in combinations(range(4), n) if least_of(information, s) >= LEAST]
    assert tuple(sorted(taken)) in fit


def test_trials_that_say_nothing_identify_nothing() -> None:
    rows = selected(NAMES, 0.1 * np.eye(4))
    assert all(row.outcome == "not identified" and row.turn == 0 for row in rows)


@pytest.mark.slow
def test_a_trial_s_information_is_the_curvature_of_its_cost() -> None:
    """By solving again with every parameter held, one of them a little off: f'' of the cost, less the prior's."""
    subject, noise, model = Subject(), StandingNoise(), feet_on_ground(Subject())
    _, truth = standing_up(model, subject, intervals=25)
    trial = recorded(model, truth.motions[0], truth.p, 100.0, noise, 34)
    every, options = [each.name for each in FOOT_PARAMETERS], SolverOptions("radau", 4, 15, 1e-9)
    phase = phase_a(model, subject, [trial], noise, free=every)
    found = solve(phase.control, options)
    assert found.solved
    information = trials_information(phase, found)
    for name in ("bottom", "stiffness"):
        k = every.index(name)
        step = 0.02 * FOOT_PARAMETERS[k].sd / np.sqrt(1.0 + information[k, k] / 100.0)
        cost = []
        for off in (-step, 0.0, step):
            p = found.p + off * np.eye(len(every))[k]
            held = replace(phase.control, p=(p, p), guess_p=p)
            again = solve(held, options, warm=found)
            assert again.solved
            cost.append(again.objective)
        curvature = (cost[0] - 2.0 * cost[1] + cost[2]) / step**2
        wanted = 0.5 * RATE * curvature * FOOT_PARAMETERS[k].sd ** 2 - 1.0
        assert information[k, k] == pytest.approx(wanted, rel=0.02), (name, information[k, k], wanted)


@pytest.mark.slow
@pytest.mark.long
def test_the_shipped_trials_identify_six_of_seven() -> None:
    """All but the radius, which is coupled with the stiffness."""
    opened(Record("sit-to-stand calibrate", {}))
    given = standing_trials(MESHES / "standing_up" / "study.toml", "study")
    (one,) = calibrated_phases(given, PhaseSearch(SolverOptions("radau", 4, 1, 1e-7)))
    taken = {row.name: row for row in one.selection}
    assert len(taken) == 7 and sum(row.outcome == "identified" for row in taken.values()) == 6
    assert (taken["radius"].outcome, taken["radius"].partner) == ("coupled", "stiffness")
    assert taken["radius"].alone == pytest.approx(280.0, rel=0.05) and taken["radius"].beside < 0.1
