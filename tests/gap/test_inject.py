"""A known effect in measured trials: what is changed, what stays, how large the gap is."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.diagnosis import Diagnosis, Estimate
from geocontact.data.gap_case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Problem
from geocontact.gap.inject import Injected, chosen, imitated, inject, judged, visible
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import elbow_case
from tests.systems.examples import FOOT_CONSTANTS, foot, foot_trial, measured, recording, spheres


def made_ready() -> tuple[GapCase, Problem]:
    case = elbow_case(seed=6)
    return case, problem_of(case, system_of(case))


def sizes(label: str, wanted: float) -> tuple[float, float, dict[str, float]]:
    """Size that was said, the gap that a refit of the base leaves on trials without noise, and the values."""
    case, problem = made_ready()
    one = chosen(candidates(problem.system), label)
    made = inject(case, problem, one, {}, wanted)
    return made.size, visible(problem, one.apply(problem.system), made.values, problem.floor), dict(made.values)


def changes(label: str, values: dict[str, float]) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Of every trial: time, force before, force with the effect."""
    case, problem = made_ready()
    made = inject(case, problem, chosen(candidates(problem.system), label), values, 1.0).case
    pairs = zip((*case.calibration, *case.evaluation), (*made.calibration, *made.evaluation), strict=True)
    return [(a.time, a.column("force"), b.column("force")) for a, b in pairs]


@pytest.mark.parametrize("wanted", [0.5, 3.0])
def test_the_amplitude_makes_the_gap_that_is_asked_for(elsewhere: Elsewhere, wanted: float) -> None:
    said, there, values = elsewhere(sizes, "damping", wanted)
    assert said == pytest.approx(wanted, rel=1e-3) and there == said
    assert values["damping.b"] > 0.0


@pytest.mark.parametrize("wanted", [0.1, 0.6])
def test_a_clipped_signal_has_the_gap_that_is_asked_for(elsewhere: Elsewhere, wanted: float) -> None:
    """Its amplitude runs downwards from where nothing is clipped, and no value is there where the effect is not."""
    said, there, values = elsewhere(sizes, "saturation.force", wanted)
    assert said == pytest.approx(wanted, rel=1e-3) and there == said
    assert 1.0 < values["saturation.force.level"] < 20.0


def test_what_base_parameters_imitate_stops_at_a_bound(elsewhere: Elsewhere) -> None:
    said, _, values = elsewhere(sizes, "sensor_gain.force", 1.0)
    assert said < 1e-3 and values["sensor_gain.force.gain"] in (-0.8, 2.0)


def test_a_sensors_effect_acts_on_what_was_measured(elsewhere: Elsewhere) -> None:
    """Noise is amplified and clipped with the signal."""
    for _, before, after in elsewhere(changes, "sensor_gain.force", {"sensor_gain.force.gain": 1.5}):
        np.testing.assert_allclose(after, 2.5 * before, rtol=1e-12)
    sharp = {"saturation.force.level": 3.0, "saturation.force.softness": 0.0}
    for _, before, after in elsewhere(changes, "saturation.force", sharp):
        np.testing.assert_allclose(after, np.minimum(before, 3.0), atol=1e-9)
        assert (before > 3.5).any()


def test_other_effects_add_what_the_model_says(elsewhere: Elsewhere) -> None:
    """A preload of 4 N is 4 N more, on top of every bit of noise."""
    for _, before, after in elsewhere(changes, "preload", {"preload.tension": 4.0, "preload.slackening": 0.0}):
        np.testing.assert_allclose(after - before, 4.0, rtol=1e-9)


AIR = 2
"""A sample in the air for which a centre of pressure was recorded all the same."""
HOLE = slice(60, 80)
"""Samples without the force along the ground, where one is asked for."""


def foot_made_ready(hole: bool) -> tuple[GapCase, Problem]:
    """Steps with noise that begin in the air, where hardly a centre of pressure is recorded."""
    system, rng = foot(), np.random.default_rng(2)
    trials = []
    for name, depth in (("t1", 0.004), ("t2", 0.006), ("t3", 0.005), ("t4", 0.0045)):
        path = foot_trial(name, depth)
        falling = {c: path.column(c) for c in path.signals.channels} | {
            "y": path.column("y") + 0.05 * np.maximum(0.1 - path.time, 0.0)
        }
        made = measured(system, recording(name, path.time, falling))
        columns = {channel: made.column(channel).copy() for channel in made.signals.channels}
        for channel, level in (("force_x", 0.5), ("force_y", 1.5), ("cop_x", 5e-4)):
            columns[channel] += level * rng.standard_normal(made.time.size)
        columns["cop_x"][AIR] = 0.1
        if hole:
            columns["force_x"][HOLE] = np.nan
        trials.append(recording(name, made.time, columns))
    told = (system.parameters, FOOT_CONSTANTS, {}, {"spheres": spheres()})
    case = GapCase("steps", "foot", tuple(trials[:3]), tuple(trials[3:]), *told)
    return case, problem_of(case, system_of(case))


def foot_changes(
    label: str, values: dict[str, float], hole: bool = False
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Of every trial: time, the three outputs before, the outputs with the effect."""
    case, problem = foot_made_ready(hole)
    made = inject(case, problem, chosen(candidates(problem.system), label), values, 1.0).case
    pairs = zip((*case.calibration, *case.evaluation), (*made.calibration, *made.evaluation), strict=True)
    names = problem.system.outputs
    return [(a.time, *(np.column_stack([t.column(n) for n in names]) for t in (a, b))) for a, b in pairs]


@pytest.mark.slow
def test_missing_samples_do_not_keep_a_sensor_from_what_was_measured(elsewhere: Elsewhere) -> None:
    """A foot has no centre of pressure in the air; noise of its forces is amplified and delayed all the same."""
    gain = elsewhere(foot_changes, "sensor_gain.force_x", {"sensor_gain.force_x.gain": 0.5})
    for _, before, after in gain:
        assert np.isnan(before[:, 2]).any() and np.isfinite(before[:, 2]).sum() > 100
        assert before[AIR, 1] < 20.0 and before[AIR, 2] == 0.1, "what the model would leave out was recorded"
        np.testing.assert_allclose(after[:, 0], 1.5 * before[:, 0], rtol=1e-12)
        np.testing.assert_array_equal(after[:, 1:], before[:, 1:])
    for time, before, after in elsewhere(foot_changes, "time_shift", {"time_shift.delay": 0.015}):
        assert time[1] - time[0] == pytest.approx(0.005)
        before[AIR, 2] = after[AIR + 3, 2] = np.nan  # between a lone sample and nothing there is nothing
        np.testing.assert_allclose(after[3:], before[:-3], rtol=1e-9, atol=1e-9)


def test_what_comes_over_from_a_channel_that_was_not_measured_is_the_models(elsewhere: Elsewhere) -> None:
    share = {"crosstalk.force_x_in_force_y.share": 0.2}
    for _, before, after in elsewhere(foot_changes, "crosstalk.force_x_in_force_y", share, True):
        there = np.isfinite(before[:, 0])
        assert not there[HOLE].any() and there.sum() == len(there) - 20
        np.testing.assert_allclose(after[there, 1], before[there, 1] + 0.2 * before[there, 0], rtol=1e-12)
        over = after[HOLE, 1] - before[HOLE, 1]
        edge = 0.2 * before[[HOLE.start - 1, HOLE.stop], 0]
        assert np.isfinite(over).all() and (abs(over) > 0.2 * abs(edge).min()).all()
        np.testing.assert_array_equal(after[:, [0, 2]], before[:, [0, 2]])


def test_samples_that_a_model_does_not_have_stay_as_measured(elsewhere: Elsewhere) -> None:
    """Stiffer zones change forces; where base model or effect have no centre of pressure, the measured one stays."""
    for _, before, after in elsewhere(foot_changes, "stiffening", {}):
        np.testing.assert_array_equal(np.isnan(after), np.isnan(before))
        assert (after[:, 1] != before[:, 1]).any() and after[AIR, 2] == 0.1


def test_a_mistake_is_made_in_the_trials_that_are_named() -> None:
    case, problem = made_ready()
    one = chosen(candidates(problem.system), "sign_flip.beta")
    made = inject(case, problem, one, {}, 1.0, frozenset({"t02"})).case
    for a, b in zip((*case.calibration, *case.evaluation), (*made.calibration, *made.evaluation), strict=True):
        np.testing.assert_array_equal(b.column("beta"), -a.column("beta") if a.name == "t02" else a.column("beta"))
        np.testing.assert_array_equal(b.column("force"), a.column("force"))


def test_names_are_those_of_candidates() -> None:
    _, problem = made_ready()
    offered = candidates(problem.system)
    assert chosen(offered, "damping").name == "damping"
    with pytest.raises(ValueError, match=r"unit_error has variants; choose one of unit_error\.force"):
        chosen(offered, "unit_error")
    with pytest.raises(
        ValueError, match=r"'rust' is not an effect of this system; there are time_shift, clock_slip, filter_lag"
    ):
        chosen(offered, "rust")


def test_a_gap_that_is_there_is_not_called_imitated_because_another_variant_is() -> None:
    sizes = {0.4: False, 1e-4: True, float("nan"): True}
    assert {size: imitated("sensor_gain", size, ("sensor_gain",)) for size in sizes} == sizes
    assert not imitated("damping", 1e-4, ("sensor_gain",))


def said(*effects: str, possible: tuple[str, ...] = (), absorbed: tuple[str, ...] = ()) -> Diagnosis:
    """A diagnosis that names these effects, and a damping of 40 ± 2 N s/m where that is among them."""
    found = {"damping.b": Estimate(40.0, (38.0, 42.0), "N s/m", True)} if "damping" in effects else {}
    verdict = "explained" if effects else "no_gap"
    return Diagnosis("case", "elbow", verdict, effects, {}, possible, absorbed, (), {}, found, 0.0, "")


@pytest.mark.parametrize(
    ("after", "size", "nats", "status"),
    [
        (said("damping"), 2.0, 900.0, "found"),
        (said(), 2.0, 900.0, "not_found"),
        (said(possible=("damping",)), 2.0, 900.0, "possible"),
        (said(absorbed=("damping",)), 0.01, 900.0, "imitated"),
        (said("damping"), 2.0, 1e-3, "too_small"),
    ],
)
def test_a_judgement_needs_two_diagnoses_and_what_was_injected(
    after: Diagnosis, size: float, nats: float, status: str
) -> None:
    case, problem = made_ready()
    damping = chosen(candidates(problem.system), "damping")
    values = {p.name: p.start for p in damping.parameters} | {"damping.b": 41.0}
    found = judged(damping, Injected(case, values, size, nats), said(), after)
    assert (found.status, found.before) == (status, False)
    assert found.change == (40.0 if status == "found" else None)
    assert found.as_dict()["found"] is (status == "found")
