"""Kinds of laboratories: home and abroad are apart, and what a kind says is what is recorded."""

from __future__ import annotations

import zlib
from dataclasses import astuple, replace

import numpy as np
import pytest

from geocontact.gap_benchmark import drawing
from geocontact.gap_benchmark.synthetic import cases
from geocontact.gap_benchmark.synthetic.cases import prepared
from geocontact.gap_benchmark.synthetic.catalogue import NUMBERS, SCENES, SECOND, plans
from geocontact.gap_benchmark.synthetic.laboratories.elsewhere import UNSEEN, placed_as_usual, slightly_wrong
from geocontact.gap_benchmark.synthetic.laboratories.kinds import LABORATORY_KINDS, SIDES, TRIALS, kinds_of
from geocontact.gap_benchmark.synthetic.laboratory import Placement, WarmUp
from geocontact.gap_benchmark.synthetic.noise import (
    Coloured,
    FilteredNoise,
    Humming,
    Knocked,
    NoiseFilter,
    PowerLawNoise,
    SensorNoise,
    Wandering,
)
from geocontact.gap_benchmark.synthetic.recording import Clock
from geocontact.gap_benchmark.synthetic.trials import record
from geocontact.gap_benchmark.synthetic.visibility import floor, sight, whitener
from tests.gap.benchmark.scene_of_kind import scene_of

NEW = {
    "noise": ("lasting", "walking", "hurried", "harmonics"),
    "clock": ("averaging", "lagging", "interrupted"),
    "steps": ("mixed",),
    "trials": ("fewest", "several"),
    "motion": ("sweep", "sines", "holds"),
}
"""What fresh kinds have."""
AS_BEFORE = {
    "white, rows dropped": 554.2055731569167,
    "1/f, coarse, placed anew": 549.0371906990788,
    "growing, uneven clock": 532.5361642603455,
    "mains, raw inputs, many trials": 543.5059838090344,
    "filtered, coarse, constants off": 582.9322064360321,
    "heavy tails, two clocks, few trials": 552.7876393525073,
    "mains, two clocks, coarse": 567.5129998936145,
    "1/f, uneven clock, few trials": 543.8839668473239,
    "filtered, two clocks, coarse": 582.8560642109156,
    "filtered, rows dropped, many trials": 529.2152767323278,
    "knocks, rows dropped": 549.9863708342208,
    "growing, coarse, constants off": 538.8698353157625,
    "white, uneven clock, raw inputs": 545.7304031548991,
    "heavy tails, warming up, many trials": 555.6079844512446,
    "knocks, placed anew, few trials": 543.4261831356195,
}
"""Force of a knee half-way through 198 samples [N], of kinds at home and abroad, before there were fresh ones."""


def test_kinds_at_home_and_abroad_are_disjoint() -> None:
    """No kind abroad has a noise and a clock together that are at home; some things are abroad only."""
    home, abroad, fresh = ([LABORATORY_KINDS[name] for name in kinds_of(side)] for side in SIDES)
    assert len(home) + len(abroad) + len(fresh) == len(LABORATORY_KINDS) and home and abroad
    assert not {(one.noise, one.clock) for one in home} & {(one.noise, one.clock) for one in abroad}
    assert not {astuple(one)[1:] for one in home} & {astuple(one)[1:] for one in abroad}
    for name, value in (("noise", "knocked"), ("trouble", "warm_up"), ("forms", "second")):
        assert value in {getattr(one, name) for one in abroad} - {getattr(one, name) for one in home}


def test_fresh_kinds_share_no_noise_and_clock_with_the_others() -> None:
    """Nor with each other; and what was added for them is on no other side."""
    fresh, others = (
        [kind for kind in LABORATORY_KINDS.values() if (kind.side == "fresh") is side] for side in (True, False)
    )
    together = [(one.noise, one.clock) for one in fresh]
    assert len(fresh) >= 6 and len(set(together)) == len(fresh)
    assert not set(together) & {(one.noise, one.clock) for one in others}
    for name, values in NEW.items():
        assert set(values) <= {getattr(one, name) for one in fresh}, name
        assert not set(values) & {getattr(one, name) for one in others}, name


@pytest.mark.parametrize("name", AS_BEFORE)
def test_the_other_kinds_record_what_they_did_before_there_were_fresh_ones(name: str) -> None:
    scene, rng = scene_of(name, "knee"), np.random.default_rng(2)
    outputs = record(scene, scene.path(rng, 0), rng).outputs
    assert outputs.shape[1] == 198 and outputs[0, 99] == pytest.approx(AS_BEFORE[name], rel=1e-9)


def test_numbers_of_trials_are_those_that_kinds_tell() -> None:
    """In all, from 4 to 12; for fitting two trials at least and for holding out two, with fewer none is diagnosed."""
    assert {sum(one) for one in cases.TRIALS} == {5, 6}
    found = {name: {sum(one) for one in pairs} for name, pairs in TRIALS.items()}
    assert found == {"fewest": {4}, "few": {4, 5}, "several": {7, 8}, "many": {9, 10, 11, 12}}
    assert all(min(one) >= 2 for pairs in TRIALS.values() for one in pairs)


@pytest.mark.parametrize("name", LABORATORY_KINDS)
def test_a_laboratory_has_what_its_kind_says(name: str) -> None:
    kind, scene = LABORATORY_KINDS[name], scene_of(name, "knee")
    laboratory = scene.laboratory
    steps = [step / scene.noise[row].sd for row, step in laboratory.recorder.output_steps.items()]
    which = {"fine": ("fine", "fine"), "coarse": ("coarse", "coarse"), "mixed": ("fine", "coarse")}[kind.steps]
    assert len(steps) == 2 and all(
        step <= 0.3 if one == "fine" else step >= 0.5 / np.sqrt(2.0) for one, step in zip(which, steps, strict=True)
    )
    assert bool(laboratory.clock.trigger) == (kind.clock == "triggered")
    assert bool(laboratory.clock.uneven) == (kind.clock == "uneven")
    assert (laboratory.clock.losing == 1.0) == (kind.clock == "dropping")
    assert bool(laboratory.clock.interrupted) == (kind.clock == "interrupted")
    assert bool(laboratory.sampler.over) == (kind.clock == "averaging")
    assert bool(laboratory.sampler.lag) == (kind.clock == "lagging")
    assert bool(laboratory.recorder.hurry) == (kind.noise == "hurried")
    assert isinstance(scene.noise[0], Wandering) == (kind.noise == "walking")
    assert isinstance(scene.noise[0], Coloured) == (kind.noise == "lasting")
    assert (getattr(scene.noise[0], "third", 0.0) > 0.0) == (kind.noise == "harmonics")
    assert bool(len(laboratory.placement)) == (kind.trouble == "placed")
    assert bool(len(laboratory.standing)) == (kind.trouble == "constants")
    assert bool(len(laboratory.warm_up.cold)) == (kind.trouble == "warm_up")
    count = sum(laboratory.trials or (3, 2))
    within = {"fewest": (4, 4), "few": (4, 5), "usual": (5, 6), "several": (7, 8), "many": (9, 12)}[kind.trials]
    assert within[0] <= count <= within[1] and (laboratory.trials is None) == (kind.trials == "usual")
    assert laboratory.forms == kind.forms
    if kind.inputs == "raw":
        assert {one.corner for one in scene.filters} == {0.5 / scene.step}


@pytest.mark.parametrize(
    "noise",
    [
        FilteredNoise(2.0, NoiseFilter(8.0)),
        Humming(PowerLawNoise(1.0), 0.8, 50.0),
        Knocked(PowerLawNoise(1.0), 10.0, 0.05, 10.0, 0.5),
        Humming(PowerLawNoise(1.0), 0.8, 4.0, 0.6),
        Wandering(PowerLawNoise(1.0), 0.6),
        Coloured(2.0, 0.0, 1.5, 0.7),
    ],
    ids=["filtered", "hum", "knocks", "harmonics", "walk", "long memory"],
)
def test_noise_has_the_covariance_that_labels_are_told_by(noise: SensorNoise) -> None:
    rng, count = np.random.default_rng(0), 300
    drawn = np.array([noise.draw(rng, count, 0.01) for _ in range(1500)])
    found, told = drawn.T @ drawn / len(drawn), noise.covariance(count, 0.01)
    lags = [0, 1, 3, 10]
    mean = [[np.diag(one, lag).mean() for lag in lags] for one in (found, told)]
    np.testing.assert_allclose(mean[0], mean[1], atol=0.06 * told[0, 0])


def test_knocks_are_short_and_in_some_trials_only() -> None:
    noise, rng = Knocked(PowerLawNoise(1e-9), 12.0, 0.03, 15.0, 0.5), np.random.default_rng(3)
    drawn = np.array([noise.draw(rng, 500, 0.01) for _ in range(400)]) / 1e-9
    knocked = (np.abs(drawn) > 4.6).any(axis=1)
    assert 0.4 < knocked.mean() < 0.6
    assert ((np.abs(drawn) > 4.6).sum(axis=1) < 20).all()


def test_two_clocks_record_inputs_late_or_early_and_outputs_in_time() -> None:
    scene = replace(scene_of("white, rows dropped", "knee"), input_noise=np.zeros(4))
    one, two = (replace(scene, laboratory=replace(scene.laboratory, clock=Clock(trigger=by))) for by in (0.0, 0.5))
    path = scene.path(np.random.default_rng(0), 0)
    even, late = (record(each, path, np.random.default_rng(1)) for each in (one, two))
    np.testing.assert_array_equal(even.outputs, late.outputs)
    rate = path(even.time).rate
    moving = np.abs(rate[0]) > 0.3 * np.abs(rate[0]).max()
    lag = ((late.inputs - even.inputs)[0, moving] / rate[0, moving]).mean() / scene.step
    assert 0.02 < abs(lag) <= 0.5


def test_sensors_warm_up_from_trial_to_trial() -> None:
    warm = WarmUp(Placement(gains={0: 0.02}, zeros={0: 4.0}), 2.0)
    assert [warm.at(turn).zeros[0] for turn in (0, 2, 40)] == pytest.approx([4.0, 4.0 / np.e, 0.0], abs=1e-6)
    scene = replace(scene_of("heavy tails, warming up, many trials", "knee"), noise=(PowerLawNoise(1e-9),) * 2)
    scene = replace(scene, spread=1e-12 * scene.spread)
    laboratory = replace(scene.laboratory, warm_up=warm, recorder=type(scene.laboratory.recorder)())
    scene = replace(scene, laboratory=laboratory)
    path = scene.path(np.random.default_rng(0), 0)
    cold, later = (record(scene, path, np.random.default_rng(1), turn=turn).outputs[0] for turn in (0, 40))
    np.testing.assert_allclose(cold, 1.02 * later + 4.0, rtol=1e-4)


def test_constants_are_wrong_by_less_than_shows() -> None:
    scene = scene_of("growing, coarse, constants off", "elbow", 4)
    large = scene.laboratory.standing.times(np.full(len(scene.laboratory.standing), 200.0))
    scene = replace(scene, laboratory=replace(scene.laboratory, standing=large))
    trials = prepared(scene, [scene.path(np.random.default_rng(0), 0)], "none").anew.trials
    floors = floor(scene, trials)
    slight = slightly_wrong(scene, trials, floors)
    left = slight.laboratory.standing.constants
    assert all(0.0 < abs(left[name]) < abs(by) for name, by in large.constants.items())
    grid = np.arange(trials[0].count) * scene.step
    shifted = slight.laboratory.standing.shifted(scene.numbers(scene.theta))
    planted = scene.body.base_model(trials[0].path(grid), shifted)(scene.theta)
    assert sight(scene, trials, [planted], floors).nats <= 1.05 * UNSEEN


@pytest.mark.parametrize("name", SECOND)
def test_the_second_family_plants_other_equations(name: str) -> None:
    """Under the same name, with other outputs; whitened once for a system that has all of them."""
    system = "elbow"
    first, second = (next(p for p in plans(system, forms) if p.name == name) for forms in ("first", "second"))
    assert first is not second and first.planted != second.planted
    assert all((name in NUMBERS[s].names) == (second in plans(s, "second")) for s in SCENES)
    scene = SCENES[system](np.random.default_rng(12), shifted=False)
    stage = prepared(scene, [scene.path(np.random.default_rng(0), 0)], "single")
    shown = []
    for plan in (first, second):
        draw = plan.drawn(np.random.default_rng(3), stage.scale)
        seen = stage.sight(draw.hooks(np.sqrt(draw.low * draw.high)))
        assert np.isfinite(seen.nats) and seen.nats > 0.0
        shown.append(seen.nats)
    assert shown[0] != pytest.approx(shown[1], rel=1e-3)


def test_another_kind_changes_no_case_of_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drawing, "synthetic_case", lambda *asked, **_: asked[2].spawn_key)
    first, kinds = list(drawing.ABROAD), list(LABORATORY_KINDS)
    keys = [drawing.drawn(drawing.Lot("knee", "none", 1, 0, name))[-1] for name in (*first, *kinds)]
    assert keys[:3] == [1, 2, 3] and len(set(keys)) == len(keys)
    assert keys[3] == zlib.crc32(kinds[0].encode())


def test_a_label_knows_warming_up_and_two_clocks() -> None:
    scene = scene_of("white, rows dropped", "knee")
    path = scene.path(np.random.default_rng(0), 0)
    assert whitener(scene, path).placed.shape[2] == 0
    triggered = replace(scene, laboratory=replace(scene.laboratory, clock=Clock(trigger=0.5)))
    (column,) = np.moveaxis(whitener(triggered, path).placed, 2, 0)
    assert np.abs(column).max() > 0.0
    usual, both = (placed_as_usual(each, path, 60).shape[2] for each in (scene, triggered))
    assert both == usual + 1  # also where all is placed anew
    cold = WarmUp(Placement(zeros={0: 4.0}), 2.0)
    cold_scene = replace(scene, laboratory=replace(scene.laboratory, warm_up=cold))
    np.testing.assert_allclose(whitener(cold_scene, path).placed[0, :, 0], 4.0)
