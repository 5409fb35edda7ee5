"""A spring in series against its equation solved sample by sample, and what happens where it has no solution."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.optimize import brentq

from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.system import FAR, NotConverged
from geocontact.effects.mechanical.damping import DAMPING
from geocontact.effects.mechanical.series_compliance import SERIES_COMPLIANCE
from geocontact.systems.foot_spheres import INPUTS
from tests.systems.examples import elbow, elbow_trial, example, foot, foot_trial, recording, spheres
from tests.systems.test_elbow import restated
from tests.systems.test_foot import restated as restated_foot


def test_series_spring_of_the_elbow_solves_its_equation() -> None:
    system, trial, c = elbow(), elbow_trial("t", 2.0, 0.05), 0.02
    soft = system.geometry.having(
        {"series_compliance.compliance": c, "series_compliance.reference": 20.0, "series_compliance.exponent": 1.4}
    )
    got = soft.loads(system.motion.seen(trial, {}), system.law, {**system.known, **system.start}).normal[:, 0]
    values = {**system.known, **system.start}

    def miss(force: float, beta: float) -> float:
        give = c * 20.0 * np.sign(force) * abs(force / 20.0) ** 1.4
        return force - float(restated(np.array(beta - give), **values))

    want = [brentq(miss, -60.0, 60.0, args=(beta,), xtol=1e-12, rtol=1e-14) for beta in trial.column("beta")]
    np.testing.assert_allclose(got, want, rtol=2e-9, atol=2e-9)


def test_series_spring_of_the_foot_is_the_foot_lifted_by_it() -> None:
    # without damping the load of every sample is that of the rigid foot, higher by c F
    system, trial, c = foot(), foot_trial("t", 0.007), 3e-6
    soft = system.geometry.having({"series_compliance.compliance": c, "series_compliance.reference": 1e3})
    values = {**system.known, **system.start} | {f"b_z{i}": 0.0 for i in (1, 2, 3)}
    loads = soft.loads(system.motion.seen(trial, {}), system.law, values)
    got = loads.normal.sum(axis=1)
    columns = {name: trial.column(name) for name in trial.signals.channels}
    lifted = recording("t", trial.time, columns | {"y": columns["y"] + c * got})
    moved = recorded(lifted.signals, INPUTS)
    rate = moved.rate.copy()
    rate[0] -= moved.rate[2] * c * got  # the lever down from the measured origin is longer by c F
    want = restated_foot(moved.position, rate, spheres(), values)
    assert got.max() > 500.0
    np.testing.assert_allclose(got, want[:, 1], rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(loads.tangential.sum(axis=1), want[:, 0], rtol=1e-9, atol=1e-6)


def test_a_stiff_spring_and_damped_spheres_in_series_refine_at_first_order() -> None:
    results = []
    for refine in (1, 2, 4, 8):
        system, trials = example("foot", refine)
        (one,) = SERIES_COMPLIANCE.candidates(system)
        values = {**system.start, **one.starts[0]} | {f"b_z{i}": 3000.0 for i in (1, 2, 3)}
        results.append(one.apply(system).simulate(trials[1], values)[::refine, 1])
    steps = [float(np.sqrt(np.mean((a - b) ** 2))) for a, b in itertools.pairwise(results)]
    assert steps[1] / steps[2] == pytest.approx(2.0, abs=0.5), steps


def test_where_there_is_no_solution_it_is_far_off_and_says_why() -> None:
    system, trials = example("elbow")
    (spring,), (damper,) = SERIES_COMPLIANCE.candidates(system), DAMPING.candidates(system)
    both = damper.apply(spring.apply(system))
    values = {**both.start, "k": 50.0, "x": 0.0, "y": 0.2}
    values |= {p.name: p.upper for p in (*spring.parameters, *damper.parameters)}
    values["series_compliance.exponent"] = 0.5
    assert (both.simulate(trials[0], values) == FAR).all()
    numbers = {**both.known, **values}
    with pytest.raises(NotConverged, match=r"series compliance .* samples have no load within 1e-10"):
        both.geometry.loads(both.motion.seen(trials[0], numbers), both.law, numbers)
