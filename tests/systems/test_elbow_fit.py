"""What is identified at an elbow on synthetic trials: numbers, intervals, and the line where nothing changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from geocontact.axis_misalignment.bins import FORCE, Binned, binned
from geocontact.axis_misalignment.compensation import (
    DisplacementScale,
    RecordedStroke,
    bin_means,
    displacement_scale,
    recorded_stroke,
    stiffness_by_displacement,
)
from geocontact.axis_misalignment.law import NAMES, ElbowLaw
from geocontact.axis_misalignment.least_squares import (
    ElbowFit,
    Prior,
    estimated,
    normal_residuals,
    normality,
    problem_of,
    r_squared,
    standard_residuals,
)
from geocontact.axis_misalignment.synthetic import PAPER, Design, ideal, multisine
from geocontact.axis_misalignment.uncertainty import (
    along_the_scale,
    covariance,
    direction,
    profiled,
    wild_bootstrap,
    with_link_held,
)
from geocontact.identify.intervals.bin_tests import DRAWS, lilliefors
from tests.systems.elbow_trials import QUICK, parameters, trials

WIDTH = np.radians(2.0)
CLEAN = Design(seconds=30.0, rate=100.0, noise=1e-6, memory=0.1, bits=0)
LINK = {"l": PAPER["l"], "z": PAPER["z"]}
SCALE = np.array([-1.0, 1.0, 1.0, 1.0, 1.0]) / np.sqrt(5.0)


@cache
def noisy() -> Binned:
    return binned(trials(), WIDTH)


@cache
def three() -> ElbowFit:
    return estimated(problem_of(noisy(), parameters(LINK), {}))


@cache
def five() -> ElbowFit:
    return estimated(problem_of(noisy(), parameters({}), {}))


def test_the_design_is_the_papers() -> None:
    time = np.arange(60001) / 1000.0
    beta = multisine(time, Design(), np.random.default_rng(0))
    np.testing.assert_allclose(np.degrees([beta.min(), beta.max()]), [8.0, 92.0])
    power = np.abs(np.fft.rfft((beta - beta.mean()) * np.hanning(len(beta)))) ** 2
    frequency = np.fft.rfftfreq(len(beta), 1e-3)
    assert power[frequency < 0.4].sum() > 0.999 * power.sum()
    assert power[(frequency > 0.03) & (frequency < 0.37)].sum() > 0.95 * power.sum()
    (one,) = trials(design=Design(seconds=2.0), count=1)
    steps = one.force / (100.0 / 2**12)
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)


@pytest.mark.parametrize("signs", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_offsets_of_either_sign_are_found_without_noise(signs: tuple[int, int]) -> None:
    truth = {**PAPER, "x": signs[0] * 0.035, "y": signs[1] * 0.045}
    data = binned(trials(truth, CLEAN, count=2), np.radians(0.5))
    found = estimated(problem_of(data, parameters(LINK), {})).named
    for name in ("k", "x", "y"):
        assert found[name] == pytest.approx(truth[name], rel=2e-3), name


def test_damping_is_found_without_noise() -> None:
    """Bins mix flexion and extension; their mean rates tell damping only as far as these are uneven."""
    truth = {**PAPER, "b": 40.0}
    data = binned(trials(truth, CLEAN, count=6), np.radians(0.5))
    found = estimated(problem_of(data, parameters(LINK, "kxyb"), {})).named
    assert found["b"] == pytest.approx(40.0, rel=0.05) and found["k"] == pytest.approx(PAPER["k"], rel=0.01)


def test_stiffness_over_cuff_pressure() -> None:
    mmhg = 133.322
    design = Design(seconds=30.0, rate=100.0, noise=1e-6, bits=0, pressures=(10 * mmhg, 60 * mmhg))
    truth = {**PAPER, "s": 0.01 / mmhg}
    data = binned(trials(truth, design, mean_pressure=35 * mmhg), np.radians(0.5))
    found = estimated(problem_of(data, parameters(LINK, "kxys"), {})).named
    at_mean = PAPER["k"] * (1.0 + truth["s"] * (data.pressure - 35 * mmhg))
    assert found["k"] == pytest.approx(at_mean, rel=2e-3)
    assert found["s"] * found["k"] == pytest.approx(PAPER["k"] * truth["s"], rel=0.01)


@pytest.mark.parametrize("compliance", [0.0, 1e-3])
def test_derivatives_are_those_of_the_force(compliance: float) -> None:
    rng = np.random.default_rng(2)
    law = ElbowLaw(np.linspace(0.1, 1.6, 30), rng.normal(size=30), rng.normal(size=30))
    theta = np.array([222.0, 0.04, -0.03, 0.17, 0.12, 7.0, 0.1, compliance])
    slopes = law.slopes(theta)
    for k in range(len(NAMES)):
        step = np.zeros(8)
        step[k] = max(1e-5 * abs(theta[k]), 1e-8)
        secant = (law.force(theta + step) - law.force(theta - step)) / (2.0 * step[k])
        np.testing.assert_allclose(slopes[:, k], secant, rtol=1e-6, atol=1e-6 * np.abs(secant).max())


def test_the_scale_is_the_direction_that_nothing_tells() -> None:
    """Also where the numbers are not the best ones: it is exact, not a matter of the fit."""
    for e in (three(), five()):
        told = direction(e)
        assert told.flat and told.singular_values[-2] > 1e-4 * told.singular_values[0]
        np.testing.assert_allclose(told.least, SCALE, atol=1e-6)
    rest = direction(three(), ("k", "x", "y"))
    assert not rest.flat and rest.singular_values[-1] > 0.01 * rest.singular_values[0]


@pytest.mark.parametrize("name", ["x", "z"])
def test_a_known_0_sets_no_scale(name: str) -> None:
    """0 times any factor is 0: the line is there as before, in the numbers that are not 0."""
    e = estimated(problem_of(noisy(), parameters({name: 0.0}), {}), starts=0)
    told = direction(e)
    assert e.problem.scale_free and name not in told.names and told.flat
    np.testing.assert_allclose(told.least, [-0.5, 0.5, 0.5, 0.5], atol=1e-6)
    assert not problem_of(noisy(), parameters({name: 1e-3}), {}).scale_free
    assert not problem_of(noisy(), parameters({name: 0.0}), {"l": Prior(0.17, 0.01)}).scale_free
    assert problem_of(noisy(), parameters({}, "kxylzs"), {"s": Prior(0.0, 1.0)}).scale_free


def test_the_papers_numbers_are_one_point_of_a_line() -> None:
    e = estimated(problem_of(binned(trials(design=CLEAN, count=2), np.radians(0.5)), parameters({}), {}))
    line = along_the_scale(e, np.geomspace(0.3, 3.0, 9))
    force = np.array([e.problem.law.force(theta) for theta in line])
    np.testing.assert_allclose(force, np.tile(e.predicted, (9, 1)), rtol=1e-9, atol=1e-9)
    (point,) = along_the_scale(e, np.array([PAPER["l"] / e.named["l"]]))
    for k, name in enumerate(("k", "x", "y", "l", "z")):
        assert point[k] == pytest.approx(PAPER[name], rel=0.1), name


def test_a_start_elsewhere_ends_elsewhere_on_the_line() -> None:
    """What the paper's 222 N/m rest on: its start and its bounds for l and z."""
    data, ends = noisy(), []
    for factor in (1.0, 0.6):
        known = parameters({})
        moved = [p if p.fixed else type(p)(p.name, p.unit, p.start * factor, p.lower, p.upper) for p in known]
        ends.append(estimated(problem_of(data, moved, {}), starts=0))
    assert ends[1].cost == pytest.approx(ends[0].cost, rel=1e-5)
    assert ends[1].named["k"] > 1.3 * ends[0].named["k"]


def test_profile_along_the_scale_is_flat_and_one_length_known_ends_that() -> None:
    e = five()
    flat = profiled(e, covariance(noisy(), e), "l", points=9)
    middle = np.abs(flat.values / e.named["l"] - 1.0) < 0.3
    assert flat.upper / flat.lower > 3.0 and (np.abs(flat.rise[middle]) < 0.01).all()
    known = three()
    sharp = profiled(known, covariance(noisy(), known), "k", points=5)
    assert sharp.upper / sharp.lower < 1.5 and not (sharp.lower_open or sharp.upper_open)
    assert sharp.lower < PAPER["k"] < sharp.upper


@pytest.mark.slow
def test_intervals_hold_both_signs_where_offsets_of_either_fit() -> None:
    """Two minima, mirrored in the signs of x and z: whichever is the lower, both are within."""
    data = binned(trials(PAPER, Design(), [51, 0]), WIDTH)
    both = with_link_held(estimated(problem_of(data, parameters({}), {})))
    close = [end for end, cost in zip(both.ends, both.costs, strict=True) if cost < both.cost + 0.5]
    assert {float(np.sign(end[1])) for end in close} == {-1.0, 1.0}, "the recordings tell the sign"
    c = covariance(data, both)
    for place, name in ((1, "x"), (3, "z")):
        p = profiled(both, c, name, points=5)
        assert all(any(low <= end[place] <= high for low, high in p.parts) for end in close), name
        assert p.lower < 0.0 < p.upper
    drawn = wild_bootstrap(data, both, 100)
    assert all(0.05 < share < 0.95 for share in (drawn[:, [1, 3]] > 0.0).mean(axis=0)), "draws of one sign only"


def test_p_of_normal_residuals_is_uniform_also_where_neighbouring_bins_share_noise() -> None:
    """One trial of 20 s, a noise of 0.3 s: p from independent values is below 0.05 in one run of six.

    Bounds are 0.1 % on either side of what 150 uniform values give; in newtons, spreads of the bins' own would show.
    """
    alone = Design(seconds=20.0, rate=50.0, noise=0.5, memory=0.3)
    independent = np.random.default_rng(0).normal(size=(DRAWS, 50))
    p = np.empty((150, 2))
    for run in range(150):
        recordings = trials(design=alone, seed=[62, run], count=1)
        data = binned(recordings, WIDTH)
        e = estimated(problem_of(data, parameters(LINK), {}), starts=0)
        standard = standard_residuals(data, e)
        p[run] = normality(recordings, data, e).p, lilliefors(standard, independent[:, : len(standard)]).p
    below = {share: (p[:, 0] < share).sum() for share in (0.05, 0.25, 0.5)}
    assert 1 <= below[0.05] <= 17 and 22 <= below[0.25] <= 55 and 56 <= below[0.5] <= 94, below
    assert 0.43 < p[:, 0].mean() < 0.57
    assert (p[:, 1] < 0.05).sum() > 17


def test_residuals_that_are_not_normal_are_called_so() -> None:
    """A mean of bins is nearly normal whatever a sample is; a model that misses a part of the force is not."""
    recordings = trials()
    wrong = [replace(r, force=r.force + 1.5 * (np.abs(r.beta - 0.9) < 0.05)) for r in recordings]
    data = binned(wrong, WIDTH)
    e = estimated(problem_of(data, parameters(LINK), {}), starts=0)
    assert normality(wrong, data, e).p < 0.01


def test_standard_residuals_have_more_of_one_spread_than_residuals_in_newtons() -> None:
    """Bins at the ends of the range hold more time. None is above 1: noise shared with neighbours is in both."""
    spread = normal_residuals(trials(), noisy(), three()).std(axis=0)
    information = np.bincount(noisy().cells.place, noisy().information)
    newtons = spread / np.sqrt(information)
    assert spread.max() < 1.0 and spread.max() / spread.min() < 2.5 < 3.0 < newtons.max() / newtons.min()


def test_a_prior_sets_the_scale_and_no_more() -> None:
    sd = 0.01
    e = estimated(problem_of(noisy(), parameters({"z": PAPER["z"]}), {"l": Prior(0.15, sd)}))
    c = covariance(noisy(), e)
    k = e.problem.names.index("l")
    assert np.sqrt(c.matrix[k, k]) <= 1.001 * sd
    sharper = estimated(problem_of(noisy(), parameters({}), {"l": Prior(0.15, 1e-6)}))
    assert sharper.named["l"] == pytest.approx(0.15, abs=1e-5)
    off = estimated(problem_of(noisy(), parameters({"l": 0.15}), {}))
    assert sharper.named["k"] == pytest.approx(off.named["k"], rel=1e-2)


def test_profile_of_a_linear_number_is_its_standard_error() -> None:
    """With the lengths known F is linear in k: the profile is the sandwich's interval."""
    e = estimated(problem_of(noisy(), parameters({n: PAPER[n] for n in ("x", "y", "l", "z")}), {}))
    c = covariance(noisy(), e)
    p = profiled(e, c, "k")
    np.testing.assert_allclose([p.lower, p.upper], e.named["k"] + np.array([-1, 1]) * c.half_width(0), rtol=1e-6)
    drawn = wild_bootstrap(noisy(), e, 400)[:, 0]
    assert drawn.std() == pytest.approx(np.sqrt(c.matrix[0, 0]), rel=0.15)
    assert drawn.mean() == pytest.approx(e.named["k"], rel=0.01)


def test_intervals_hold_the_truth_about_as_often_as_they_say() -> None:
    """80 recordings; with 95 % right, fewer than 68 hits happen once in 10 000. The benchmark counts more."""
    quick = Design(seconds=20.0, rate=50.0, noise=0.5, memory=0.1)
    hits = np.zeros(3)
    for run in range(80):
        data = binned(trials(design=quick, seed=[9, run], count=3), np.radians(4.0))
        e = estimated(problem_of(data, parameters(LINK), {}), starts=0)
        c = covariance(data, e)
        half = np.array([c.half_width(k) for k in range(3)])
        hits += np.abs(e.values - [PAPER[n] for n in "kxy"]) <= half
    assert (hits >= 68).all(), hits


def test_a_trial_that_was_left_out_is_predicted() -> None:
    data = noisy()
    problem = problem_of(data.without(2), parameters(LINK), {})
    e, rest = estimated(problem), data.only(2)
    assert set(data.without(2).cells.trial) == {0, 1, 3, 4, 5}
    law = problem_of(rest, parameters(LINK), {}).law
    assert r_squared(rest.cells.means[:, FORCE], law.force(e.theta)) > 0.95


def test_noise_is_told_without_a_model() -> None:
    design = Design(seconds=60.0, rate=100.0, noise=0.8, memory=0.3)
    noise = binned(trials(design=design), WIDTH).noise
    assert noise.sd[0] == pytest.approx(0.8, rel=0.15) and 0.2 < noise.tau[0] < 0.6


def test_the_joint_slides_where_the_force_levels_off() -> None:
    """The paper's Fig. 8: a negative force up to an angle at which the joint, until then at its end, starts to move."""
    stroke = (-0.010, 0.060)
    free = bin_means(binned(trials(design=QUICK, stroke=stroke), WIDTH))
    found = recorded_stroke(free)
    assert found is not None
    (stop,) = found.stops
    assert stop.side == "lower" and stop.position == pytest.approx(-0.010, abs=2e-4) and stop.force < -5.0
    time = np.arange(2000) * 1e-3
    beta = np.linspace(0.2, 1.6, 2000)
    _, joint = ideal(time, beta, PAPER, stroke)
    leaves = beta[int(np.argmax(joint > -0.010))]
    assert stop.leaves == pytest.approx(leaves, abs=np.radians(2.5))
    beyond = free.beta > stop.leaves + np.radians(4.0)
    assert abs(free.force[beyond].mean()) < 0.2 and abs(found.level) < 0.2
    # lowered by what is wanting, the end is not reached any more
    lower = (stroke[0] + stop.force / PAPER["k"] - 0.003, stroke[1])
    eased, _ = ideal(time, beta, PAPER, lower)
    assert np.abs(eased).max() < 1e-9


def test_an_extreme_of_a_joint_that_slides_is_no_end() -> None:
    found = recorded_stroke(bin_means(binned(trials(design=QUICK, stroke=(-0.2, 0.2)), WIDTH)))
    assert found is not None and not found.stops
    (stuck,) = trials(design=QUICK, stroke=(0.0, 0.0), count=1)
    assert recorded_stroke(bin_means(binned([stuck], WIDTH))) is None


def test_free_displacement_and_locked_force_tell_the_stiffness() -> None:
    """The one number that angle and force alone leave open."""
    data = binned(trials(seed=3), WIDTH)
    stroke = recorded_stroke(bin_means(binned(trials(seed=4, stroke=(-0.010, 0.060)), WIDTH)))
    assert stroke is not None
    locked = [bin_means(data.only(k)) for k in range(6)]
    found = stiffness_by_displacement(locked, stroke, WIDTH)
    assert found is not None and found.trials == 6
    assert abs(found.value - PAPER["k"]) < 4.0 * found.error and found.error < 0.05 * PAPER["k"]


FREE = (-0.010, 0.060)


def free_scale(design: Design, seed: Sequence[int]) -> tuple[DisplacementScale, RecordedStroke]:
    data = binned(trials(design=design, seed=seed, stroke=FREE), WIDTH)
    stroke = recorded_stroke(bin_means(data))
    assert stroke is not None
    scale = displacement_scale([bin_means(data.only(trial)) for trial in range(6)], stroke, WIDTH)
    assert scale is not None and scale.trials == 6
    return scale, stroke


def test_the_scale_of_the_truth_is_one_and_its_derivatives_are_those() -> None:
    scale, _ = free_scale(replace(QUICK, rate=50.0, donning=2e-3), [71, 0])
    theta = np.array([PAPER[name] for name in NAMES])
    assert abs(scale.residual(theta)) < 3.0
    larger = theta * np.array([0.5, 2.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    assert scale.residual(larger) * scale.error + 1.0 == pytest.approx(
        2.0 * (scale.residual(theta) * scale.error + 1.0)
    )
    for k in range(len(NAMES)):
        step = np.zeros(8)
        step[k] = 1e-5 * max(abs(theta[k]), 1.0)
        secant = (scale.residual(theta + step) - scale.residual(theta - step)) / (2.0 * step[k])
        assert scale.slopes(theta)[k] == pytest.approx(secant, rel=1e-5, abs=1e-9)


def test_locked_forces_count_once_where_the_free_joint_sets_the_scale() -> None:
    """k spreads over recordings as its standard error says, and less than where a slope over the displacement is all
    that the forces are asked for: with the forces in a prior on k as well it would spread as that slope does.
    """
    quick = Design(seconds=30.0, rate=50.0, noise=0.5, memory=0.1)
    found = np.empty((30, 3))
    for run in range(30):
        data = binned(trials(design=quick, seed=[72, run]), WIDTH)
        scale, stroke = free_scale(quick, [73, run])
        e = estimated(problem_of(data, parameters({}), {}, scale), starts=0)
        assert not e.problem.scale_free
        slope = stiffness_by_displacement([bin_means(data.only(k)) for k in range(6)], stroke, WIDTH)
        assert slope is not None
        found[run] = e.named["k"], np.sqrt(covariance(data, e).matrix[0, 0]), slope.value
    spread = found.std(axis=0, ddof=1)
    assert abs(found[:, 0].mean() - PAPER["k"]) < 4.0 * spread[0] / np.sqrt(30)
    assert 0.6 < spread[0] / np.median(found[:, 1]) < 1.5
    assert spread[0] < 0.8 * spread[2]


def test_one_free_trial_has_no_scale() -> None:
    data = binned(trials(design=QUICK, stroke=FREE, count=1), WIDTH)
    stroke = recorded_stroke(bin_means(data))
    assert stroke is not None and displacement_scale([stroke.curve], stroke, WIDTH) is None
