"""Effects on inputs, balance and sensor against their formulas written out again, and the signs of their amplitudes."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.effect import Candidate
from tests.effects.runs import EXAMPLES, FITTED, OFFERED, label
from tests.systems.examples import ELBOW_CONSTANTS, recording
from tests.systems.test_elbow import restated


def candidate(name: str, wanted: str) -> Candidate:
    return next(one for system, one in OFFERED if system == name and one.label == wanted)


def with_and_without(name: str, wanted: str, **shares: float) -> tuple[np.ndarray, np.ndarray]:
    """Outputs of the base and with the effect on the first trial; parameters by the last word of their names."""
    system, trials = EXAMPLES[name]
    one = candidate(name, wanted)
    values = {p.name: shares[p.name.rpartition(".")[2]] for p in one.parameters}
    changed = one.apply(system).simulate(trials[0], {**system.start, **values})
    return system.simulate(trials[0], system.start), changed


def test_gain() -> None:
    base, got = with_and_without("foot", "sensor_gain.forces", gain=-0.25)
    np.testing.assert_allclose(got[:, :2], 0.75 * base[:, :2], rtol=1e-14)
    np.testing.assert_array_equal(got[:, 2], base[:, 2])


def test_offset_of_one_channel_only() -> None:
    base, got = with_and_without("foot", "sensor_offset.force_x", offset=7.0)
    np.testing.assert_allclose(got - base, np.where(np.isnan(base), np.nan, [7.0, 0.0, 0.0]), atol=1e-9)


@pytest.mark.parametrize("bend", [0.0, 2.0])
def test_drift(bend: float) -> None:
    system, trials = EXAMPLES["elbow"]
    base, got = with_and_without("elbow", "sensor_drift.force", rate=0.06, bend=bend)
    t, whole = trials[0].time, system.scale.duration
    want = 0.06 * t if bend == 0.0 else 0.06 * whole * (1.0 - np.exp(-bend * t / whole)) / bend
    np.testing.assert_allclose((got - base)[:, 0], want, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(("softness", "power"), [(0.0, np.inf), (0.25, 4.0), (0.1, 10.0)])
def test_saturation(softness: float, power: float) -> None:
    base, got = with_and_without("elbow", "saturation.force", level=3.0, softness=softness)
    want = np.clip(base, -3.0, 3.0) if softness == 0.0 else base / (1.0 + np.abs(base / 3.0) ** power) ** (1.0 / power)
    np.testing.assert_allclose(got, want, rtol=1e-12)
    assert got.min() < -2.0
    assert got.max() > 2.0


def test_crosstalk_goes_one_way() -> None:
    base, got = with_and_without("foot", "crosstalk.force_y_in_force_x", share=0.03)
    np.testing.assert_allclose(got[:, 0], base[:, 0] + 0.03 * base[:, 1], rtol=1e-13)
    np.testing.assert_array_equal(got[:, 1:], base[:, 1:])


def test_outputs_come_late_never_early() -> None:
    base, got = with_and_without("elbow", "time_shift", delay=0.1)
    np.testing.assert_allclose(got[5:], base[:-5], rtol=1e-9, atol=1e-9)
    assert candidate("elbow", "time_shift").parameters[0].lower == 0.0


def test_a_clock_slips_once_or_runs_at_another_rate() -> None:
    """Samples of the base model read where the other clock was; a trial of the elbow has a step of 0.02 s."""
    time = EXAMPLES["elbow"][1][0].time
    base, late = with_and_without("elbow", "clock_slip.once", delay=0.1, when=0.5)
    share = (time - time[0]) / (time[-1] - time[0])
    before, after = share < 0.47, np.flatnonzero(share > 0.53)
    np.testing.assert_array_equal(late[before], base[before])
    np.testing.assert_allclose(late[after], base[after - 5], rtol=1e-9, atol=1e-9)
    _, early = with_and_without("elbow", "clock_slip.once", delay=-0.1, when=0.5)
    np.testing.assert_allclose(early[after[:-6]], base[after[:-6] + 5], rtol=1e-9, atol=1e-9)
    _, slow = with_and_without("elbow", "clock_slip.steady", rate=0.05)
    want = np.interp(time - 0.05 * (time - time[0]), time, base[:, 0])
    np.testing.assert_allclose(slow[:, 0], want, atol=2e-3 * np.ptp(base))


@pytest.mark.parametrize("delay", [0.03, 0.06, 0.2])
def test_a_late_clock_stops_at_most(delay: float) -> None:
    """Shares of the trial; a spring that is turned at a steady rate shows which time is read: never an earlier one."""
    system, trials = EXAMPLES["joint"]
    time = trials[0].time
    whole = time[-1] - time[0]
    turned = recording("t0", time, {"angle": time - time[0]}, **trials[0].covariates)
    spring = {**system.start, "b": 0.0}
    values = {"clock_slip.once.delay": delay * whole, "clock_slip.once.when": 0.5}
    got = candidate("joint", "clock_slip.once").apply(system).simulate(turned, {**spring, **values})[:, 0]
    base = system.simulate(turned, spring)[:, 0]
    read = np.interp(got * np.sign(base[-1] - base[0]), np.sort(base * np.sign(base[-1] - base[0])), time)
    assert np.diff(read).min() > -1e-9 and read[-1] == pytest.approx(time[-1] - delay * whole)


def test_play_passes_on_a_rate_where_it_is_carried() -> None:
    """A damper has the rate of the angle while the play is taken up and none while it rests."""
    system, trials = EXAMPLES["joint"]
    angle, damped = trials[0].column("angle"), {**system.start, "b": 2.0}
    values = {**damped, "play.angle.width": 0.1, "play.angle.start": 0.0}
    followed = [angle[0]]
    for value in angle[1:]:
        followed.append(max(value - 0.05, min(followed[-1], value + 0.05)))
    rests = np.abs(np.array(followed) - angle) < 0.05 - 1e-9
    assert 0.1 < rests.mean() < 0.9
    bare = {**values, "b": 0.0}
    one = candidate("joint", "play.angle").apply(system)
    got = (one.simulate(trials[0], values) - one.simulate(trials[0], bare))[:, 0]
    base = (system.simulate(trials[0], damped) - system.simulate(trials[0], {**damped, "b": 0.0}))[:, 0]
    np.testing.assert_allclose(got, np.where(rests, 0.0, base), rtol=1e-9, atol=1e-9)
    slope = 2.0 * np.gradient(np.array(followed), trials[0].time)
    steady = ~rests & ~np.roll(rests, 1) & ~np.roll(rests, -1)
    steady[[0, -1]] = False
    assert np.abs(got - np.sign(got @ base) * np.sign(base @ slope) * slope)[steady].max() < 0.1 * np.ptp(slope)


def test_play_is_a_loop_that_does_not_depend_on_rate() -> None:
    """The play operator written as a loop over samples; the same path twice as fast makes the same outputs."""
    system, trials = EXAMPLES["joint"]
    one = candidate("joint", "play.angle").apply(system)
    values = {**system.start, "play.angle.width": 0.1, "play.angle.start": 0.5}
    angle, last, followed = trials[0].column("angle"), trials[0].column("angle")[0] - 0.025, []
    for value in angle:
        last = max(value - 0.05, min(last, value + 0.05))
        followed.append(last)
    bare = {**values, "b": 0.0}
    want = system.simulate(recording("t0", trials[0].time, {"angle": np.array(followed)}, **trials[0].covariates), bare)
    np.testing.assert_allclose(one.simulate(trials[0], bare), want, rtol=1e-9, atol=1e-9)
    fast = recording("t0", 0.5 * trials[0].time, {"angle": angle}, **trials[0].covariates)
    np.testing.assert_allclose(one.simulate(fast, bare), want, rtol=1e-9, atol=1e-9)


def test_a_filter_makes_late_and_small() -> None:
    base, got = with_and_without("elbow", "filter_lag", lag=0.1, order=1.0)
    ahead = got[5:, 0] - base[:-5, 0]  # nearly the delay of 0.1 s while the force changes slowly
    assert np.sqrt(np.mean(ahead**2)) < 0.15 * np.sqrt(np.mean((got - base) ** 2))
    assert np.ptp(got) < np.ptp(base)


@pytest.mark.parametrize(("name", "channel"), [("elbow", "beta"), ("foot", "y"), ("foot", "pitch")])
def test_offset_of_an_input_is_that_input_moved(name: str, channel: str) -> None:
    system, trials = EXAMPLES[name]
    _, got = with_and_without(name, f"motion_offset.{channel}", offset=0.001)
    columns = {n: trials[0].column(n) + 0.001 * (n == channel) for n in system.inputs}
    want = system.simulate(recording("t0", trials[0].time, columns), system.start)
    np.testing.assert_allclose(got, want, rtol=1e-7, atol=1e-6)


def test_migrating_axis() -> None:
    system, trials = EXAMPLES["elbow"]
    _, got = with_and_without("elbow", "axis_migration", slope=0.02, curvature=-0.01)
    beta = trials[0].column("beta")
    angle = beta - system.scale.centre["beta"]
    x = 0.03 + 0.02 * angle - 0.01 * angle**2
    np.testing.assert_allclose(got[:, 0], restated(beta, 300.0, x, 0.04, **ELBOW_CONSTANTS), rtol=1e-11, atol=1e-11)


def test_weight() -> None:
    base, got = with_and_without("elbow", "gravity_load", weight=4.0, phase=0.2)
    beta = EXAMPLES["elbow"][1][0].column("beta")
    np.testing.assert_allclose((got - base)[:, 0], 4.0 * np.sin(beta + 0.2), rtol=1e-10)


def test_mass_at_the_tip_and_at_the_attachment() -> None:
    system, trials = EXAMPLES["elbow"]
    base, got = with_and_without("elbow", "inertia_load.tip", mass=2.0)
    turn = recorded(trials[0].signals, ("beta",)).acceleration[0]
    np.testing.assert_allclose((got - base)[:, 0], 2.0 * 0.185 * turn, rtol=1e-9, atol=1e-12)
    base, got = with_and_without("elbow", "inertia_load.attachment", mass=2.0)
    time, deflection = trials[0].time, base[:, 0] / system.start["k"]
    want = 2.0 * np.gradient(np.gradient(deflection, time), time)
    inner = slice(10, -10)
    np.testing.assert_allclose((got - base)[inner, 0], want[inner], atol=0.02 * np.abs(want).max())


def test_mass_in_the_foot_is_accelerated_where_it_is() -> None:
    system, _ = EXAMPLES["foot"]
    time = np.arange(301) * 0.005
    x, y, pitch = 0.1 * np.sin(5.0 * time), 0.02 * np.cos(7.0 * time), 0.4 * np.sin(6.0 * time)
    trial = recording("t", time, {"x": x, "y": y, "pitch": pitch})
    heavy = candidate("foot", "inertia_load").apply(system)
    values = {**system.start, "inertia_load.mass": 2.0, "inertia_load.ahead": 0.15}
    base, got = system.simulate(trial, system.start), heavy.simulate(trial, values)
    place = np.column_stack((x + 0.15 * np.cos(pitch), y + 0.15 * np.sin(pitch)))
    want = 2.0 * np.gradient(np.gradient(place, time, axis=0), time, axis=0)
    inner = slice(30, -30)
    np.testing.assert_allclose((got - base)[inner, :2], want[inner], atol=0.01 * np.abs(want).max())
    both = np.isfinite(got[:, 2]) & np.isfinite(base[:, 2])
    np.testing.assert_array_equal(got[both, 2], base[both, 2])


SIGNED = {
    "clock_slip",
    "motion_offset",
    "axis_migration",
    "preload",
    "gravity_load",
    "sensor_gain",
    "sensor_offset",
    "sensor_drift",
}


@pytest.mark.parametrize(("name", "one"), FITTED, ids=label)
def test_amplitudes_have_the_sign_that_physics_asks_for(name: str, one: Candidate) -> None:
    amplitude = one.parameters[0]
    signed = one.name in SIGNED | {"crosstalk", "event_load"} or one.label in ("inertia_load.tip", "inertia_load.cuff")
    signed = signed and one.label != "gravity_load.exo"  # a weight on the exoskeleton pulls it down
    signed = signed or (name, one.name) == ("knee", "asymmetry")
    assert (amplitude.lower < 0.0) == signed
    assert len(one.parameters) <= 2
    assert amplitude.upper > 0.0
