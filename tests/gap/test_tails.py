"""Heavy tails of the noise carry no effect and hide none; a gap is no tail. All cases are synthetic."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.effects.catalogue import candidates
from geocontact.gap.attribute import Attribution, attribute
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.levels import SURE
from geocontact.gap.selection.model_comparison import base_contender, singles
from geocontact.gap.selection.surrogate import surrogate
from geocontact.gap.selection.tails import by_chance, most_by_normal, returning, sharp, standing_out, tails
from geocontact.identify.noise.covariance import Layout
from geocontact.identify.noise.input_noise import Instant
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.identify.noise.student import StudentNoise, student_noise
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import NOISE, Change, elbow_case

STRUCK = 0.03
"""Of the samples, that are off by twenty standard deviations."""
DAMPED = {"damping.b": 6.0, "damping.exponent": 1.0}


def strikes(at_the_top: bool) -> Change:
    """A sensor that is struck: upwards where the force is large, or either way anywhere."""
    rng = np.random.default_rng(101)

    def struck(_: str, __: np.ndarray, force: np.ndarray) -> np.ndarray:
        often = np.where(force > np.quantile(force, 0.8), 5.0 * STRUCK, 0.0) if at_the_top else STRUCK
        there = rng.random(len(force)) < often
        out = force.copy()
        out[there] += 20.0 * NOISE * (1.0 if at_the_top else rng.choice([-1.0, 1.0], there.sum()))
        return out

    return struck


def answered(damped: bool, at_the_top: bool, names: Sequence[str]) -> tuple[dict[str, float], Attribution]:
    """What effects gain on a case with strikes where every sample weighs the same [nats], and what is found out."""
    case = elbow_case("damping" if damped else "", DAMPED if damped else {}, 1, 8.0, recorded=strikes(at_the_top))
    system = system_of(case)

    def offer(scaled: System) -> list[Candidate]:
        return [one for one in candidates(scaled) if one.name in names]

    problem = problem_of(case, system)
    base = base_contender(problem)
    found = singles(problem, base, offer(problem.system))
    return {c.label: c.nats - base.nats for c in found}, attribute(case, system, offer)


def gains(*asked: object) -> tuple[dict[str, float], dict[str, float], tuple[str, ...], tuple[str, ...]]:
    """The same, with what they gain in the end, the effects that are named, and the channels with tails."""
    before, found = answered(*asked)  # type: ignore[arg-type]
    after = {c.label: c.nats - found.base.nats for c in found.contenders}
    return before, after, found.answer.effects, tuple(found.heavy)


def seen_without_tails() -> list[tuple[str, ...]]:
    """Channels with tails where noise is Gaussian and damping is missing: beside the base, and the surrogate on it."""
    case = elbow_case("damping", DAMPED, 1, 8.0)
    problem = problem_of(case, system_of(case))
    base = base_contender(problem).judged
    rest = surrogate(problem, base)
    assert rest.nats > 20.0
    return [tuple(tails(problem, base, rest.predicted).channels)]


@pytest.mark.slow
def test_strikes_carry_no_effect(elsewhere: Elsewhere) -> None:
    """Not even where every sample weighs the same: noise that grows with the signal takes strikes at the top."""
    before, after, named, channels = elsewhere(gains, False, True, ("saturation", "stiffening"))
    assert max(before.values()) < 6.0
    assert channels == ("force",)
    assert max(after.values()) < 6.0
    assert named == ()


@pytest.mark.slow
def test_a_true_effect_comes_out_from_under_them(elsewhere: Elsewhere) -> None:
    before, after, named, channels = elsewhere(gains, True, False, ("damping", "relaxation"))
    assert before["damping"] < before["relaxation"], "what was to be shown"
    assert channels == ("force",)
    assert after["damping"] > max(100.0, after["relaxation"] + 5.0)
    assert named == ("damping",)


def test_a_gap_is_no_tail(elsewhere: Elsewhere) -> None:
    assert elsewhere(seen_without_tails) == [()]


def test_what_returns_in_every_trial_is_no_tail() -> None:
    rng = np.random.default_rng(2)
    calm = np.ones((5, 400))
    reversal, anywhere = calm.copy(), calm.copy()
    reversal[:, 190:215] = rng.uniform(0.02, 1.0, (5, 25))
    for row in anywhere:
        row[rng.choice(400, 12, replace=False)] = 0.02
    assert returning(list(reversal)) > 0.9
    assert returning(list(anywhere)) < by_chance(len(anywhere))


def test_what_is_smooth_is_no_tail() -> None:
    smooth = 20.0 * np.sin(np.linspace(0.0, 9.0, 300))
    struck = smooth.copy()
    struck[150], struck[200] = struck[150] - 15.0, np.nan
    found = sharp(struck)
    assert np.isnan(found[200])
    assert np.abs(np.delete(found, [149, 150, 151, 199, 200, 201])).max() < 0.5
    assert abs(found[150]) > 10.0


def test_normal_noise_of_many_samples_has_no_tails() -> None:
    """Of nine thousand samples Student's distribution gains a hundred nats, by how they are taken."""
    rng = np.random.default_rng(5)
    levels = NoiseLevels(*(np.array(each) for each in ([0.03], [[0.09], [0.02]], [[0.6], [0.8]], [1.0], [])))
    layouts = plain_layouts(12, 0.05, rng)
    varied = [np.zeros((*layout.shape, 1)) for layout in layouts]
    (most,) = most_by_normal(layouts, levels, varied)
    off = []
    for layout, own in zip(layouts, varied, strict=True):
        whitener, noise = layout.whitener(levels), np.zeros(layout.shape).ravel()
        for rows, factor in zip(whitener.rows, whitener.factors, strict=True):
            noise[rows] = np.linalg.solve(factor, rng.standard_normal(len(rows)))
        off.append(sharp(standing_out(layout, levels, noise.reshape(layout.shape), own)[:, 0]))
    gain = student_noise(np.concatenate(off)).gain
    assert gain > 10.0 * SURE, "what was to be shown"
    assert gain < most


def plain_layouts(trials: int, lost: float, rng: np.random.Generator) -> list[Layout]:
    """Trials of 800 samples of one channel, but for those that are lost; no noise of inputs."""
    layouts = []
    for _ in range(trials):
        time = np.flatnonzero(rng.random(800) >= lost).astype(float)
        felt = np.zeros((len(time), 1, 0))
        present = np.ones((len(time), 1), bool)
        layouts.append(Layout.of(time, present, Instant(time, felt, felt, ()), present.astype(float), 0.0 * present))
    return layouts


def test_the_gain_of_normal_noise_is_known_with_its_spread() -> None:
    """White noise of four thousand samples. Of two draws one gains as much as twice `SURE` more one time in four; none
    gains more than is allowed, while Student's noise with four degrees of freedom does.
    """
    rng = np.random.default_rng(11)
    levels = NoiseLevels(*(np.array(each) for each in ([1.0], [[1e-3]], [[1.0]], [1e-9], [])))
    layouts = plain_layouts(5, 0.0, rng)
    (most,) = most_by_normal(layouts, levels, [np.zeros((*layout.shape, 1)) for layout in layouts])

    def gained(draw: Callable[[int], np.ndarray]) -> StudentNoise:
        return student_noise(np.concatenate([sharp(draw(len(layout.rows))) for layout in layouts]))

    normal = [gained(rng.standard_normal) for _ in range(60)]
    gains, spreads = (np.array(each) for each in zip(*((one.gain, one.spread) for one in normal), strict=True))
    assert gains.std() == pytest.approx(spreads.mean(), rel=4.0 / np.sqrt(2.0 * len(gains)))
    assert gains.std() > 0.8 * 2.0 * SURE / np.sqrt(2.0), "what was to be shown: two draws differ by more"
    assert gains.max() < most
    assert all(gained(lambda n: rng.standard_t(4.0, n)).gain > most for _ in range(10))
