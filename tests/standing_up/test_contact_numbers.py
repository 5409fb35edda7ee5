"""What trials tell of the feet: planted values in their intervals, a bound that is told, terms of the cost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.standing_up.chain import FOOT_PARAMETERS, LAW, PLANTED, Subject, feet_on_ground
from geocontact.standing_up.contact_numbers import contact_numbers
from geocontact.standing_up.phase import PhaseProblem, cost_shares
from geocontact.standing_up.phases import phase_a
from geocontact.standing_up.strap_sites import ContactParameter, bounds, searched, usual
from geocontact.standing_up.trials import StandingNoise, recorded, standing_up

OPTIONS = SolverOptions("radau", 4, 20, 1e-7)


def test_a_logarithm_stands_for_a_part_of_the_usual_value() -> None:
    both = (
        ContactParameter("k", "Pa", 2.0, 1.0, 0.5, 8.0, logarithm=True),
        ContactParameter("x", "m", 0.1, 0.1, 0.0, 1.0),
    )
    np.testing.assert_allclose(searched(both, [4.0, 0.3]), [np.log(2.0), 0.3])
    np.testing.assert_allclose(usual(both), [0.0, 0.1])
    np.testing.assert_allclose(bounds(both, ["k"]), [[np.log(0.25), 0.1], [np.log(4.0), 0.1]])
    with pytest.raises(ValueError, match="'y'"):
        bounds(both, ["y"])


@pytest.fixture(scope="module")
def phase() -> PhaseProblem:
    subject, noise = Subject(), StandingNoise()
    feet = feet_on_ground(subject)
    _, true = standing_up(feet, subject, intervals=20)
    trial = recorded(feet, true.motions[0], true.p, 100.0, noise, 7)
    return phase_a(feet, subject, [trial], noise)


@pytest.mark.slow
def test_planted_values_are_within_three_standard_deviations(phase: PhaseProblem) -> None:
    """Three of 1.96 would be too few for one noise: the benchmark counts over many."""
    found = solve(phase.control, OPTIONS)
    told = contact_numbers(phase, found)
    for k, number in enumerate(told.numbers):
        assert number.verdict == ("known" if number.name in LAW else "held")
        off = found.p[k] - PLANTED[k]
        assert abs(off) <= 3.0 * number.after
    assert (np.diff(told.directions) <= 0.0).all() and told.directions[-1] > 2.0
    assert told.told_apart is not None and told.names == LAW
    shares = cost_shares(phase, found)
    assert sum(shares.values()) == pytest.approx(1.0) and 0.2 < shares["coordinates"] < 0.6


@pytest.mark.slow
def test_a_parameter_on_its_bound_has_no_interval(phase: PhaseProblem) -> None:
    low, high = (each.copy() for each in phase.control.p)
    high[2] = PLANTED[2] - 0.02
    start = np.minimum(phase.control.guess_p, high)
    narrow = replace(phase, control=replace(phase.control, p=(low, high), guess_p=start))
    told = contact_numbers(narrow, solve(narrow.control, OPTIONS))
    toe = told.numbers[[each.name for each in FOOT_PARAMETERS].index("toe")]
    assert toe.verdict == "on its bound" and np.isnan(toe.lower) and np.isinf(toe.after)
    assert told.names == ("stiffness", "heel")
    # the toe may lie inside its bound, as here: its neighbours are not known to what the bound alone leaves of them
    for name in told.names:
        k = [each.name for each in FOOT_PARAMETERS].index(name)
        number, of = told.numbers[k], FOOT_PARAMETERS[k]
        assert of.searched(number.lower) < PLANTED[k] < of.searched(number.upper), number
        assert number.assumed > 0.5 * number.after, number
