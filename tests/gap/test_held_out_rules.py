"""What a change of a prediction must do on held-out trials, on residuals made up here."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.effects.catalogue import candidates
from geocontact.gap.case.change_amplitude import amplitude
from geocontact.gap.case.placement import GAIN
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import evaluated, floor_of
from geocontact.gap.case.refit import refit
from geocontact.gap.levels import DEVIATIONS, SLIGHT
from geocontact.gap.selection.held_out_rules import (
    ONLY_NOISE,
    TOO_LITTLE,
    WORTH_NAMING,
    HeldOutRules,
    TrialWeight,
    taken_away,
    trimmed,
    with_one,
)
from geocontact.gap.selection.model_comparison import Contender, base_contender, finished
from geocontact.gap.selection.surrogate import Surrogate
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case, judged_as

RNG = np.random.default_rng(5)
TRIALS, SAMPLES = 3, 400


def made(share: float, noise: float = 0.3, where: slice = slice(None)) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Residuals that hold this share of a change, and the change, one channel; the change is 0 outside `where`."""
    before, change = [], []
    for _ in range(TRIALS):
        moved = np.zeros((SAMPLES, 1))
        moved[where, 0] = np.sin(np.linspace(0.0, 9.0, SAMPLES))[where]
        before.append(share * moved + noise * RNG.standard_normal((SAMPLES, 1)))
        change.append(moved)
    return before, change


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0, 1.3])
def test_the_amplitude_is_what_the_residual_holds(share: float):
    found = amplitude(*made(share))
    assert found is not None
    assert found.low < share < found.high
    assert found.high - found.low < 0.2
    assert found.better == (share > 0.5)
    assert found.worse == (share < 0.5)


def test_the_error_falls_or_grows_by_what_the_amplitude_says():
    before, change = made(0.3)
    found = amplitude(before, change)
    old, new = (
        sum(float((x**2).sum()) for x in xs) for xs in (before, [b - m for b, m in zip(before, change, strict=True)])
    )
    assert found is not None
    assert found.grown == pytest.approx(new / old - 1.0)
    assert (found.grown > 0.0) == (found.value < 0.5)


def test_a_change_in_one_block_alone_is_not_sure():
    jump = slice(100, 110)
    before, change = made(0.0, where=jump)
    for b in before[1:]:
        b[jump] = 0.0
    before[0][jump] += 1.5 * change[0][jump]
    change[1:] = [0.0 * m for m in change[1:]]
    found = amplitude(before, change)
    assert found is not None and found.value > 1.0
    assert not found.better, "however large it is there: one block has no spread"


def test_nothing_changed_is_no_amplitude():
    before, change = made(0.0)
    assert amplitude(before, [0.0 * m for m in change]) is None


def test_what_trials_differ_by_weighs_little():
    """A channel that is higher throughout in one trial and lower in the other speaks for no offset."""
    varied = np.ones((SAMPLES, 1, 1))
    present, floor = np.ones((SAMPLES, 1), bool), np.array([0.3])
    noise = 0.3 * RNG.standard_normal((2, SAMPLES, 1))
    before = [noise[0] + 2.0, noise[1] + 1.0]
    change = [np.full((SAMPLES, 1), 1.5)] * 2
    bare = amplitude([b / floor for b in before], [m / floor for m in change])
    weight = TrialWeight.of(present, floor, 3.0 * varied)
    weighed = amplitude([weight(b) for b in before], [weight(m) for m in change])
    assert bare is not None and weighed is not None
    assert bare.better
    held = [sum(float((each**2).sum()) for each in parts) for parts in ([weight(m) for m in change], change)]
    assert held[0] < 0.01 * held[1] / floor[0] ** 2


@pytest.fixture(scope="module")
def rules() -> HeldOutRules:
    """Of a short elbow, with made-up residuals of two models on its held-out trials."""
    case = elbow_case(duration=3.0)
    problem = problem_of(case, system_of(case))
    found = HeldOutRules.of(problem, judged_as(evaluated(problem, problem.plain)))
    left = [0.5 * problem.floor * RNG.standard_normal(part.shape) for part in found.before]
    found.fitted["preload"] = left
    found.fitted["damping"] = [part + 2.0 * problem.floor for part in left]
    return found


def contenders(rules: HeldOutRules) -> list[Contender]:
    offered = [one for one in candidates(rules.problem.system) if one.label in ("preload", "damping")]
    return [Contender((one,), rules.base) for one in offered]


@pytest.mark.slow
def test_who_is_surely_outdone_on_held_out_trials_is_not_named(rules: HeldOutRules) -> None:
    rules = replace(rules, fitted=dict(rules.fitted), calmed=dict(rules.fitted))
    assert rules.outdone(contenders(rules)) == {"damping": "preload predicts held-out trials better"}
    rules.fitted["damping"] = rules.calmed["damping"] = [1.05 * part for part in rules.fitted["preload"]]
    assert rules.outdone(contenders(rules)) == {}, "about the same error does not separate them"
    rules.fitted["damping"] = [part + 2.0 * rules.problem.floor for part in rules.fitted["preload"]]
    rules.calmed["damping"] = rules.fitted["damping"]
    pair = Contender((*contenders(rules)[0].candidates, *contenders(rules)[1].candidates), rules.base)
    rules.fitted[pair.label] = [0.0 * part for part in rules.before]
    assert rules.outdone([*contenders(rules), pair]).keys() == {"damping"}, "two effects do not outdo one"


@pytest.mark.slow
def test_a_filter_outdoes_nobody_by_the_noise_of_the_inputs_that_it_keeps_out(rules: HeldOutRules) -> None:
    """The compliance of a foot, 82 % of an error, was outdone by a lag that filtered noisy rates in another channel."""
    rules = replace(rules, calmed={"damping": [0.1 * part for part in rules.fitted["preload"]]})
    rules.calmed["preload"] = rules.fitted["preload"]
    assert rules.outdone(contenders(rules)) == {}
    rules.calmed["damping"] = [3.0 * part for part in rules.fitted["preload"]]
    assert rules.outdone(contenders(rules)).keys() == {"damping"}


@pytest.mark.slow
def test_a_larger_error_on_held_out_trials_is_harm(rules: HeldOutRules) -> None:
    one = contenders(rules)[0]
    rules.fitted[one.label] = [3.0 * part for part in rules.before]
    assert "grows" in rules.harm(one) and rules.ruled_out(one)
    rules.fitted[one.label] = [0.2 * part for part in rules.before]
    assert rules.harm(one) == "" and not rules.ruled_out(one)


@pytest.mark.slow
def test_an_error_that_grows_by_chance_keeps_from_being_named_but_rules_nothing_out(rules: HeldOutRules) -> None:
    one = contenders(rules)[0]
    luck = [0.1 * part.std() * RNG.standard_normal(part.shape) for part in rules.before]
    sign = np.sign(sum(float((m * b).sum()) for m, b in zip(luck, rules.before, strict=True)))
    rules.fitted[one.label] = [b + sign * m for b, m in zip(rules.before, luck, strict=True)]
    assert "grows" in rules.harm(one) and not rules.ruled_out(one)


@pytest.mark.slow
def test_who_takes_less_than_its_share_of_the_error_away_is_not_named(rules: HeldOutRules) -> None:
    first, _ = contenders(rules)
    enough, too_little = np.sqrt(1.0 - 1.1 * WORTH_NAMING), np.sqrt(1.0 - 0.9 * WORTH_NAMING)
    for scale, refused in ((too_little, True), (enough, False)):
        rules.fitted[first.label] = [scale * part for part in rules.before]
        assert bool(rules._of_share(first)) is refused


@pytest.mark.slow
def test_the_share_is_that_of_an_error_without_what_base_parameters_differ_by(rules: HeldOutRules) -> None:
    one, problem, count = contenders(rules)[0], rules.problem, len(rules.problem.calibration.trials)
    varied = replace(rules.base, noise=replace(rules.base.noise, varies=problem.usual))
    stiffness = [jacobian[..., 0] * 2.0 * problem.usual[0] for jacobian in rules.base.model.jacobian[count:]]
    noise = [0.3 * problem.floor * RNG.standard_normal(part.shape) for part in stiffness]
    fast = [0.3 * problem.floor * np.sin(np.arange(len(part)))[:, None] for part in stiffness]
    both = [sum(parts) for parts in zip(stiffness, noise, fast, strict=True)]
    rules.fitted[one.label] = [b - m for b, m in zip(both, fast, strict=True)]
    assert taken_away(both, rules.fitted[one.label]) < WORTH_NAMING, "of the error as it is"
    assert replace(rules, base=varied, before=both)._of_share(one) == ""
    rules.fitted[one.label] = [b - s for b, s in zip(both, stiffness, strict=True)]
    assert taken_away(both, rules.fitted[one.label]) > 0.5, "of the error as it is"
    assert replace(rules, base=varied, before=both)._of_share(one) == TOO_LITTLE, (
        "a trial's own stiffness is not an effect"
    )


@pytest.mark.slow
def test_a_floor_is_never_above_the_error_itself(rules: HeldOutRules) -> None:
    problem = rules.problem
    believed = replace(rules.base.noise, levels=problem.beliefs.middle, varies=100.0 * problem.usual)
    count = len(problem.calibration.trials)
    missed = np.sqrt(np.mean(np.concatenate(problem.plain.residuals[:count]) ** 2, axis=0))
    assert floor_of(problem, believed, problem.plain) == pytest.approx(missed)
    quiet = replace(believed, varies=0.0 * problem.usual)
    assert floor_of(problem, quiet, problem.plain) <= missed


@pytest.mark.slow
def test_less_noise_of_the_inputs_is_no_effect(rules: HeldOutRules) -> None:
    """What goes of the error with inputs as measured, and not with their noise taken off, was that noise."""
    one = contenders(rules)[0]
    rules.fitted[one.label] = [0.2 * part for part in rules.before]
    assert rules._of_share(one) == "" and rules._of_noise(one) == ONLY_NOISE, "the model itself is the base model"
    assert replace(rules, calm=[part + 2.0 * rules.problem.floor for part in rules.calm])._of_noise(one) == ""


@pytest.mark.slow
def test_a_little_harm_must_be_sure_beside_what_trials_differ_by(rules: HeldOutRules) -> None:
    """Where trials are stiffer than the others throughout, a little more stiffness looks like harm in every block."""
    one, problem, count = contenders(rules)[0], rules.problem, len(rules.problem.calibration.trials)
    stiffness = [jacobian[..., 0] * 2.0 * problem.usual[0] for jacobian in rules.base.model.jacobian[count:]]
    varied = replace(rules.base, noise=replace(rules.base.noise, varies=problem.usual))
    makes = [varied.noise.varies * each for each in problem.varied(rules.base.model.jacobian)]
    weights = [TrialWeight.of(p, problem.floor, v) for p, v in zip(problem.recorded.present, makes, strict=True)]
    before = [part + 0.1 * problem.floor * RNG.standard_normal(part.shape) for part in stiffness]
    alike = replace(rules, base=varied, before=before, weights=tuple(weights))
    for more, ruled_out in ((0.02, False), (0.2, True)):
        rules.fitted[one.label] = [b + more * s for b, s in zip(before, stiffness, strict=True)]
        assert alike.ruled_out(one) is ruled_out
    rules.fitted[one.label] = [1.02 * b + 0.0 * s for b, s in zip(rules.before, stiffness, strict=True)]
    still = replace(
        rules,
        weights=tuple(TrialWeight.of(w.present, problem.floor, 0.0 * v) for w, v in zip(weights, makes, strict=True)),
    )
    assert still.ruled_out(one), "where trials differ by nothing it is sure"


@pytest.mark.slow
def test_without_a_gap_nothing_is_called_unknown(rules: HeldOutRules) -> None:
    """However many nats a surrogate has gained: what it takes of the held-out error must be worth naming."""
    floor = rules.problem.floor
    shapes = [part.shape for part in rules.base.model.residuals]
    noise = [floor * RNG.standard_normal(shape) for shape in shapes]
    waves = [floor * np.sin(0.7 * np.arange(shape[0]))[:, None] for shape in shapes]
    for size, counts in ((0.3, False), (2.0, True)):
        change = tuple(size * wave for wave in waves)
        found = Surrogate("time within the trial", 900.0, 500.0, 5.0, change, change)
        assert rules.unnamed(found, [n + m for n, m in zip(noise, change, strict=True)]) is counts


@pytest.mark.slow
def test_a_level_that_the_recording_passes_is_none_that_it_was_cut_off_at(rules: HeldOutRules) -> None:
    """The level is refused as long as more than two in a hundred samples lie beyond it, gains and noise aside."""
    problem = rules.problem
    one = next(each for each in candidates(problem.system) if each.name == "saturation")
    seen = np.sort(np.abs(np.concatenate([each.ravel() for each in problem.recorded.outputs])))
    enough = (seen[-len(seen) // 100] - DEVIATIONS * problem.recorded.rough[0]) / (1.0 + DEVIATIONS * GAIN)

    def cut(level: float) -> Contender:
        values = {**rules.base.model.values, "saturation.force.level": level}
        return Contender((one,), replace(rules.base, model=replace(rules.base.model, values=values)))

    assert rules._of_recording(cut(enough)) == ""
    assert rules.over_base(cut(0.8 * enough)).endswith(f"of the samples of force lie beyond {0.8 * enough:.4g}")
    assert rules._of_recording(contenders(rules)[0]) == "", "other effects have no level"


@pytest.mark.slow
def test_each_of_two_effects_must_earn_its_place_beside_the_other_alone() -> None:
    """A damper is there and a drift is not: what the two gain together is the damper's."""
    case = elbow_case("damping", {"damping.b": 6.0, "damping.exponent": 1.0}, duration=6.0)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem)
    offered = {one.label: one for one in candidates(problem.system)}
    two = (offered["damping"], offered["sensor_drift.force"])
    system = two[1].apply(two[0].apply(problem.system))
    start = {**problem.plain.values, **two[0].starts[0], **two[1].starts[0]}
    fitted = refit(system, problem.calibration, problem.fitting(base.judged.noise, problem.plain), [start])
    pair = finished(problem, two, fitted, base.judged.noise)
    rules = HeldOutRules.of(problem, base.judged)
    damper, drift = (with_one(problem, pair, one) for one in two)
    assert rules.over_base(pair) == "" and rules.objection(damper, ()) == ""
    said = "compared with damping alone, trials left out are not surely"
    assert rules.objection(pair, (damper, drift)).startswith(said)
    assert rules.objection(pair, (drift,)).startswith(said), "also where it was not judged alone"


def test_the_share_that_is_gone_is_that_of_the_channel_that_gains_most():
    before = [RNG.standard_normal((SAMPLES, 3)) for _ in range(TRIALS)]
    after = [part * np.sqrt([0.7, 1.5, 1.0]) for part in before]
    assert taken_away(before, after) == pytest.approx(0.3)
    assert taken_away(before, [1.1 * part for part in before]) == pytest.approx(1.0 - 1.21)
    assert taken_away([0.0 * part for part in before], after) == 0.0


def test_few_samples_count_for_nothing():
    gains = np.full(1000, -0.01)
    gains[: int(SLIGHT * 1000)] = 50.0
    assert gains.sum() > 900.0
    assert trimmed(gains) < 0.0
    even = np.full(1000, 0.02)
    assert trimmed(even) == pytest.approx(20.0 * (1.0 - 2.0 * SLIGHT))
