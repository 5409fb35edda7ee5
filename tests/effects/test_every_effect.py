"""What holds for every candidate of the catalogue, on the listed systems and on an own model."""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np
import pytest

from geocontact.chain.effect import Candidate
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import EFFECTS, candidates
from tests.effects.runs import DISCRETE, EXAMPLES, FITTED, OFFERED, difference, label, outputs, truth
from tests.systems.examples import NAMES, example, recording

VOCABULARY = {
    "elbow": "time_shift clock_slip filter_lag motion_offset play axis_migration series_compliance stiffening "
    "damping relaxation dry_friction dead_zone end_stop preload slip gravity_load inertia_load sensor_gain "
    "sensor_offset sensor_drift saturation unit_error sign_flip",
    "foot": "time_shift clock_slip filter_lag motion_offset play series_compliance stiffening damping relaxation "
    "asymmetry inertia_load sensor_gain sensor_offset sensor_drift saturation crosstalk unit_error sign_flip "
    "side_swap",
    "shoulder": "time_shift clock_slip filter_lag motion_offset axis_migration series_compliance stiffening "
    "damping relaxation dry_friction dead_zone end_stop preload slip contact_loss event_load gravity_load "
    "inertia_load sensor_gain sensor_offset sensor_drift saturation unit_error sign_flip",
    "knee": "time_shift clock_slip filter_lag motion_offset axis_migration relaxation asymmetry sensor_gain "
    "sensor_offset sensor_drift saturation crosstalk unit_error sign_flip side_swap",
    "sit_to_stand": "time_shift clock_slip filter_lag motion_offset play axis_migration series_compliance "
    "stiffening damping relaxation dry_friction dead_zone end_stop preload slip contact_loss sensor_gain "
    "sensor_offset sensor_drift saturation crosstalk unit_error sign_flip side_swap",
    "joint": "time_shift clock_slip filter_lag motion_offset play series_compliance stiffening damping "
    "relaxation dry_friction dead_zone end_stop preload slip contact_loss asymmetry gravity_load inertia_load "
    "sensor_gain sensor_offset sensor_drift saturation unit_error sign_flip",
}
STAGES = {"timing", "kinematics", "geometry", "constitutive", "load", "sensor", "data"}


@pytest.mark.parametrize("name", NAMES)
def test_catalogue_holds_the_vocabulary(name: str) -> None:
    offered = candidates(EXAMPLES[name][0])
    assert {one.name for one in offered} == set(VOCABULARY[name].split())
    assert len({one.label for one in offered}) == len(offered)
    assert {one.stage for one in offered} <= STAGES
    assert all(effect.source for effect in EFFECTS)


@pytest.mark.parametrize(("name", "one"), FITTED, ids=label)
def test_neutral_is_the_base_exactly(name: str, one: Candidate) -> None:
    system, trials = EXAMPLES[name]
    values = {**system.start, **truth(one), **one.neutral}
    np.testing.assert_array_equal(
        outputs(one.apply(system), trials, values), outputs(system, trials, system.start), strict=True
    )


@pytest.mark.parametrize(("name", "one"), FITTED, ids=label)
def test_output_changes_more_with_more_of_it(name: str, one: Candidate) -> None:
    system, trials = EXAMPLES[name]
    base = outputs(system, trials, system.start)
    amplitude = one.parameters[0].name
    full = truth(one)
    if one.name == "saturation":
        doses = [{amplitude: full[amplitude] / share} for share in (0.9, 0.95, 1.0)]
    else:
        doses = [{amplitude: full[amplitude] * share} for share in (0.25, 0.5, 1.0)]
    changes = [
        difference(system, outputs(one.apply(system), trials, {**system.start, **full, **dose}), base) for dose in doses
    ]
    assert 1e-6 < changes[0] < changes[1] < changes[2], changes


@pytest.mark.parametrize(("name", "one"), DISCRETE, ids=label)
def test_a_mistake_in_one_trial_leaves_the_others_alone(name: str, one: Candidate) -> None:
    system, trials = EXAMPLES[name]
    wrong = one.only(frozenset({trials[0].name})).apply(system)
    pairs = [(wrong.simulate(t, system.start), system.simulate(t, system.start)) for t in trials]
    assert difference(system, *pairs[0]) > 1e-3
    np.testing.assert_array_equal(*pairs[1])
    everywhere = one.apply(system).simulate(trials[0], system.start)
    np.testing.assert_array_equal(everywhere, pairs[0][0])


@pytest.mark.parametrize(("name", "one"), DISCRETE, ids=label)
def test_a_mistake_says_what_it_does(name: str, one: Candidate) -> None:
    system, trials = EXAMPLES[name]
    if one.channel in system.outputs:
        column = system.outputs.index(one.channel)
        right, wrong = (model.simulate(trials[0], system.start)[:, column] for model in (system, one.apply(system)))
        np.testing.assert_allclose(wrong, one.factor * right, rtol=1e-12)
    elif one.channel:
        columns = {n: trials[0].column(n) * (one.factor if n == one.channel else 1.0) for n in system.inputs}
        misread = recording("t0", trials[0].time, columns, **trials[0].covariates)
        got = one.apply(system).simulate(misread, system.start)
        np.testing.assert_allclose(got, system.simulate(trials[0], system.start), rtol=1e-6, atol=1e-6)
    else:
        assert one.name == "side_swap"


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_pairs_compose_in_either_order(name: str) -> None:
    system, trials = EXAMPLES[name]
    offered = [one for n, one in FITTED if n == name] + [one for n, one in DISCRETE if n == name][::7]
    for a, b in itertools.combinations(offered, 2):
        if a.name == b.name:
            continue  # two forms of one effect, of which the contest takes one
        values = {**system.start}
        for one in (a, b):
            values |= truth(one) if one.parameters else {}
        there = b.apply(a.apply(system)).simulate(trials[0], values)
        back = a.apply(b.apply(system)).simulate(trials[0], values)
        np.testing.assert_array_equal(there, back, err_msg=f"{a.label} and {b.label}")


@pytest.mark.parametrize(("name", "one"), OFFERED, ids=label)
def test_an_effect_is_added_once(name: str, one: Candidate) -> None:
    system, _ = EXAMPLES[name]
    with pytest.raises(ValueError, match="already"):
        one.apply(one.apply(system))


@pytest.mark.parametrize(("name", "one"), FITTED, ids=label)
def test_starts_lie_within_bounds(name: str, one: Candidate) -> None:
    for start in one.starts:
        for parameter in one.parameters:
            assert parameter.lower <= start[parameter.name] <= parameter.upper, parameter


@pytest.mark.parametrize(("name", "one"), FITTED, ids=label)
def test_outputs_are_finite_all_over_the_bounds(name: str, one: Candidate) -> None:
    system, trials = EXAMPLES[name]
    changed = one.apply(system)
    rng = np.random.default_rng(7)
    for draw in range(12):
        values = {}
        for p in changed.parameters:
            corner = (p.lower, p.upper)[rng.integers(2)]
            values[p.name] = float(corner if draw % 2 else rng.uniform(p.lower, p.upper))
        got = outputs(changed, trials, values)
        loads = [column for column, channel in enumerate(system.outputs) if not channel.startswith("cop")]
        assert np.isfinite(got[:, loads]).all(), values


@cache
def finer(name: str, refine: int) -> tuple[Trial, ...]:
    """Trials of an example, sampled that many times as finely; made once for all candidates."""
    return example(name, refine)[1]


@pytest.mark.parametrize(("name", "one"), FITTED, ids=label)
def test_finer_sampling_changes_less_and_less(name: str, one: Candidate) -> None:
    """At least of order 0.75: over two halvings, over three where a force jumps at the edge of a zone.

    There a step ends before or after the edge by chance, and one halving more or less decides nothing.
    """
    system, _ = EXAMPLES[name]
    values = {**system.start, **truth(one)}
    halvings = 3 if (name, one.label) == ("shoulder", "dead_zone") else 2
    got = [
        np.concatenate([one.apply(system).simulate(trial, values)[::refine] for trial in finer(name, refine)])
        for refine in (1, 2, 4, 8, 16)[: halvings + 2]
    ]
    steps = [difference(system, a, b) for a, b in itertools.pairwise(got)]
    assert steps[2] < 2e-3, steps
    assert steps[-1] < 1e-6 or steps[0] / steps[-1] > 2.0 ** (0.75 * halvings), steps
