"""Derivatives along with a law or a motion beside central differences of it."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.chain.effect import Candidate
from geocontact.chain.interface_law import INTERFACE_LAW, MEMORY, interface_force
from geocontact.chain.interface_slopes import UNKNOWN, interface_slopes
from geocontact.chain.links import Law, Motion
from geocontact.chain.single_deflection import SingleDeflection
from geocontact.chain.system import tangents
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from tests.systems.examples import example

LAW = {
    "k": 2000.0,
    "b": 30.0,
    "dead_zone.width": 0.002,
    "dead_zone.share": 0.4,
    "stiffening.gain": 0.7,
    "stiffening.exponent": 1.3,
    "stiffening.reference": 0.01,
    "end_stop.upper.stiffness": 900.0,
    "end_stop.upper.limit": 0.001,
    "end_stop.lower.stiffness": 700.0,
    "end_stop.lower.limit": -0.001,
    "end_stop.power": 1.4,
    "end_stop.reference": 0.01,
    "relaxation.ratio": 0.5,
    "relaxation.tau": 0.03,
    "damping.b": 40.0,
    "damping.exponent": 0.8,
    "damping.reference": 0.05,
    "dry_friction.stroke.limit": 5.0,
    "dry_friction.stroke.reach": 0.004,
    "preload.tension": 6.0,
    "preload.slackening": 30.0,
    "dry_friction.rate.limit": 4.0,
    "dry_friction.rate.turning": 0.05,
    "asymmetry.excess": 0.3,
    "asymmetry.turning": 0.04,
    "contact_loss.opening": 1.5,
    "contact_loss.rounding": 2.0,
}
MOST = {"foot": 0.95, "shoulder": 0.5, "elbow": 0.95, "knee": 0.95, "sit_to_stand": 0.95, "joint": 0.95}
"""Share of the samples that agree: differences of a motion are off where its steps are halved otherwise, and beyond a
kink that is reached at another time."""
EXAMPLES = {name: example(name) for name in MOST}
NOT_KNOWN = ("series_compliance", "slip")
CASES = [
    pytest.param(name, one, id=f"{name}-{one.label}" if one else name)
    for name, (system, _) in EXAMPLES.items()
    for one in (None, *candidates(system))
    if one is None or (one.parameters and (name, one.label) != ("shoulder", "contact_loss.negative"))
]
"""Of a shoulder whose interface stays open nothing moves that could be compared."""


@pytest.mark.parametrize("h", [0.0, 0.01])
def test_derivatives_of_the_interface_law(h: float) -> None:
    n, rng = INTERFACE_LAW.having(LAW).numbers({}), np.random.default_rng(3)
    for _ in range(20):
        u, rate, old = 0.01 * rng.normal(), 0.1 * rng.normal(), rng.normal(size=MEMORY) * [0.01, 0.0, 0.5, 3.0, 5.0]
        du, drate = 0.01 * rng.normal(size=5), 0.1 * rng.normal(size=5)
        dn, dold = n * rng.normal(size=(5, n.size)), rng.normal(size=(5, MEMORY)) * [0.01, 0.0, 0.5, 3.0, 5.0]
        dn[:, [*UNKNOWN, list(INTERFACE_LAW.neutral).index("contact_loss.side")]] = 0.0
        dnew, dforce = np.zeros((5, MEMORY)), np.zeros(5)
        interface_slopes(u, rate, h, n, old, (dn != 0.0).any(axis=0), du, drate, dn, dold, dnew, dforce)
        for k in range(5):
            ends = []
            for e in (1e-6, -1e-6):
                new = np.zeros(MEMORY)
                force = interface_force(u + e * du[k], rate + e * drate[k], h, n + e * dn[k], old + e * dold[k], new)
                ends.append(np.array([force, *new]))
            known = (ends[0] - ends[1]) / 2e-6
            np.testing.assert_allclose([dforce[k], *dnew[k]], known, rtol=1e-6, atol=1e-6 * max(abs(n[0] * u), 1.0))


def inside(p: Parameter) -> float:
    """Where no bound is near."""
    return p.start + 0.03 * (p.upper - p.start) if np.isfinite(p.upper) else 1.03 * p.start


@pytest.mark.parametrize(("name", "one"), CASES)
def test_tangents_are_central_differences(name: str, one: Candidate | None) -> None:
    base, trials = EXAMPLES[name]
    system = base if one is None else one.apply(base)
    values = system.start | {p.name: inside(p) for p in (one.parameters if one else ())}
    steps = {p.name: 1e-7 * (abs(values[p.name]) or p.upper - p.lower) for p in system.parameters}
    found = tangents(system, trials[1], values, steps)
    if one is not None and one.name in NOT_KNOWN:
        assert not found
        return
    missing = {p.name for p in system.parameters} - set(found)
    assert missing == ({p.name for p in one.parameters} if one and one.name in ("motion_offset", "play") else set())
    size = np.nanmax(np.abs(system.simulate(trials[1], values)), axis=0)
    for p in system.parameters:
        if p.name not in found:
            continue
        by = 100.0 * steps[p.name]
        ends = [system.simulate(trials[1], {**values, p.name: values[p.name] + side * by}) for side in (1.0, -1.0)]
        known = np.nan_to_num((ends[0] - ends[1]) / (2.0 * by))
        off = np.abs(found[p.name] - known) / np.maximum(np.abs(known).max(axis=0), 1e-10 * size / steps[p.name])
        assert np.quantile(off, MOST[name], axis=0).max() < 1e-6, p.name


@pytest.mark.parametrize("name", ["elbow", "sit_to_stand", "joint"])
def test_a_spring_in_series_that_does_not_give_yet_is_left_to_differences(name: str) -> None:
    """At no compliance loads are known, but not how they change with it."""
    base, trials = EXAMPLES[name]
    one = next(one for one in candidates(base) if one.name == "series_compliance")
    system = one.apply(base)
    compliance = one.parameters[0].name
    assert compliance.endswith(".compliance")
    values = system.start | {p.name: p.start for p in one.parameters} | {compliance: 0.0}
    steps = {p.name: 1e-7 * (abs(values[p.name]) or p.upper - p.lower) for p in system.parameters}
    found = tangents(system, trials[1], values, steps)
    assert found and compliance not in found and {p.name for p in base.parameters} <= set(found)


def test_a_deflection_may_read_a_parameter_by_its_name() -> None:
    """An own strut whose neutral angle is fitted: its formula reads it, no number of the geometry does."""
    strut = SingleDeflection("angle", lambda angle, numbers: np.sin(angle - numbers["neutral"]))
    law = Law(INTERFACE_LAW, load="N m", deflection="rad").having({"k": "k", "b": "b"})
    time = 0.01 * np.arange(200)
    trial = Trial("t1", Signals(time, np.sin(3.0 * time)[:, None], ("angle",), ("rad",)))
    movement = Motion(("angle",)).seen(trial, {})
    values = {"k": 60.0, "b": 2.0, "neutral": 0.1}
    found = strut.changes(movement, law, values, [{**values, "neutral": 0.1 + 1e-7}])
    assert found is not None and found[1][0] is not None
    ends = [strut.loads(movement, law, {**values, "neutral": 0.1 + by}).normal for by in (1e-5, -1e-5)]
    np.testing.assert_allclose(found[1][0].normal / 1e-7, (ends[0] - ends[1]) / 2e-5, rtol=1e-4, atol=1e-4)
    np.testing.assert_array_equal(found[0].normal, strut.loads(movement, law, values).normal)
