"""From gains to an answer, on gains made up here."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.parameter import Parameter
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.problem import Noise
from geocontact.gap.case.refit import Refit
from geocontact.gap.levels import LEFT_OVER, SLIGHT, SURE
from geocontact.gap.selection.evidence import Judged
from geocontact.gap.selection.model_comparison import Contender
from geocontact.gap.selection.verdict import (
    BEYOND,
    answer,
    borne_out,
    contradicted,
    most_of,
    ranking,
    with_mistake,
    with_refused,
)
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case

SYSTEM = system_of(elbow_case(duration=2.0))
OFFERED = {one.label: one for one in candidates(SYSTEM)}
SHARE = 0.6


def contender(nats: float, *labels: str, **values: float) -> Contender:
    """A model that gains so much, on calibration trials as much as on the others; effects where they set out."""
    one = np.ones(1)
    noise = Noise(NoiseLevels(one, one[None], one[None], one, one), one, 0.0, ())
    offered = tuple(OFFERED[label] for label in labels)
    there = {p.name: p.start for one in offered for p in one.parameters} | values
    model = Refit(SYSTEM, {**SYSTEM.start, **there}, [], [], np.zeros(10), np.zeros((10, 3)))
    judged = Judged(model, noise, nats, SHARE * nats, 6, [], np.zeros((10, 0)))
    return Contender(offered, judged)


def shares(*contenders: Contender) -> dict[str, float]:
    """Everyone changes the calibration trials as much as the others, sample by sample."""
    return {one.label: SHARE for one in contenders}


def said(
    *contenders: Contender,
    variants: dict[str, int] | None = None,
    unnamed: float = 0.0,
    odd: float = 0.0,
    rest: float = 0.0,
):
    counts = {one.name: 1 for one in OFFERED.values()} | (variants or {})
    return answer(ranking(contender(0.0), contenders, shares(*contenders), counts), unnamed, odd, rest)


def test_a_gain_that_may_be_luck_is_no_gap() -> None:
    assert said(contender(SURE - 2.0, "damping")).verdict == "no_gap"
    assert said(contender(SURE + 6.0, "damping")).effects == ("damping",)


def test_what_may_not_be_named_keeps_its_place_in_the_ranking() -> None:
    """The verdict is made without it; nothing becomes more probable."""
    refused = [contender(20.0, "preload"), contender(30.0, "damping"), contender(SURE - 2.0, "dead_zone")]
    counts = {one.name: 1 for one in OFFERED.values()}
    everyone = ranking(contender(0.0), refused, shares(*refused), counts)
    silent = said()
    told = with_refused(silent, everyone)
    assert (told.verdict, told.effects, told.ambiguity) == ("no_gap", (), ("damping", "preload"))
    assert told.probabilities == silent.probabilities
    named = said(contender(25.0, "preload"))
    assert with_refused(named, everyone) == named, "where something is named it stands alone"


def test_nothing_is_named_where_an_effect_that_harms_a_channel_gains_far_more() -> None:
    """A foot whose compliance gained 1603 nats, and predicted one channel of two trials worse, was a lag with 0.95."""
    counts = {one.name: 1 for one in OFFERED.values()}
    named = contender(40.0, "preload")
    held = ranking(contender(0.0), [named], shares(named), counts)
    sure = said(named)
    for nats, verdict, effects in ((2.0 * 40.0 + SURE - 0.1, "explained", ("preload",)), (90.0, "unknown", ())):
        harms = contender(nats, "damping")
        found = contradicted(sure, held, ranking(contender(0.0), [harms], shares(harms), counts))
        assert (found.verdict, found.effects) == (verdict, effects)
    assert found.ambiguity == ("damping", "preload")
    assert sum(found.probabilities.values()) == pytest.approx(1.0)
    assert max(found.probabilities, key=lambda name: found.probabilities[name]) == "unknown"
    without = ranking(contender(0.0), [], {}, counts)
    assert contradicted(sure, held, without) is sure
    pair = contender(900.0, "damping", "dead_zone")
    both = ranking(contender(0.0), [pair], shares(pair), counts)
    assert both.living
    assert contradicted(sure, held, both) is sure, "one of the two may be what is named"


def test_what_a_known_effect_explains_is_nothing_unknown_though_it_is_too_small_to_be_named() -> None:
    small = [contender(40.0, "damping"), contender(90.0, "preload")]
    counts = {one.name: 1 for one in OFFERED.values()}
    known = most_of(ranking(contender(0.0), small, shares(*small), counts), {"damping"})
    nobody = ranking(contender(0.0), [], {}, counts)
    assert known == pytest.approx(40.0)
    for little, verdict in ((0.0, "unknown"), (known, "no_gap")):
        for rest in (0.0, 60.0):  # on top of the base, where nobody may be named, as much is left over
            assert answer(nobody, 45.0, 0.0, rest, little).verdict == verdict


def test_a_gain_is_borne_out_in_proportion_to_what_changes_in_the_calibration_trials() -> None:
    assert borne_out(100.0, 60.0, 0.6) == 100.0
    assert borne_out(100.0, 10.0, 0.1) == 100.0
    assert borne_out(100.0, 10.0, 0.5) == pytest.approx(20.0 + SURE + BEYOND * (80.0 - SURE))
    assert borne_out(500.0, 10.0, SLIGHT / 10.0) == borne_out(500.0, 10.0, SLIGHT)


@pytest.mark.parametrize("share", [0.01, 0.1, 0.6])
def test_a_price_that_calibration_trials_paid_is_no_loss_in_all(share: float) -> None:
    assert borne_out(100.0, -2.0, share) == pytest.approx(SURE - 2.0 + BEYOND * (102.0 - SURE))


def test_everyone_is_borne_out_by_what_it_changes_itself() -> None:
    one, other = contender(60.0, "damping"), contender(60.0, "dry_friction.rate")
    counts = {each.name: 1 for each in OFFERED.values()}
    held = ranking(contender(0.0), (one, other), {one.label: 1.0, other.label: SHARE}, counts)
    assert held.gains[one.label] < held.gains[other.label] == pytest.approx(60.0)


def test_variants_share_what_is_believed_of_their_effect() -> None:
    competitors = contender(30.0, "damping"), contender(30.0, "dry_friction.rate")
    even = said(*competitors).probabilities
    assert even["damping"] == pytest.approx(even["dry_friction"])
    odds = said(*competitors, variants={"dry_friction": 2}).probabilities
    assert odds["damping"] / odds["dry_friction"] == pytest.approx(2.0 ** (1.0 / (1.0 + 30.0 * SLIGHT)), rel=0.01)


def test_a_second_effect_must_add_its_share() -> None:
    single, little = contender(200.0, "damping"), contender(216.0, "damping", "sensor_drift.force")
    assert said(single, little).effects == ("damping",)
    much = contender(300.0, "damping", "sensor_drift.force")
    assert set(said(single, much).effects) == {"damping", "sensor_drift"}


def test_of_more_than_four_that_remain_none_is_named() -> None:
    labels = ("damping", "dry_friction.rate", "relaxation", "dead_zone", "stiffening")
    five = [contender(60.0 + 0.1 * k, label) for k, label in enumerate(labels)]
    found = said(*five)
    assert (found.verdict, found.effects) == ("unresolved", ())
    assert set(found.ambiguity) == {OFFERED[label].name for label in labels}
    assert found.chosen is five[-1], "reductions are those of the most probable"
    fewer = said(*five[:4])
    assert (fewer.verdict, fewer.effects) == ("explained", ("dead_zone",)) and len(fewer.ambiguity) == 4


def test_of_two_that_are_named_the_likelier_comes_first() -> None:
    both = contender(120.0, "damping", "sensor_drift.force")
    found = said(contender(100.0, "sensor_drift.force"), both)
    assert found.probabilities["sensor_drift"] > found.probabilities["damping"]
    assert found.effects == found.ambiguity == ("sensor_drift", "damping")


def test_something_without_a_name_wins_where_it_gains_more() -> None:
    assert said(contender(20.0, "damping"), unnamed=90.0).verdict == "unknown"
    assert said(contender(90.0, "damping"), unnamed=20.0).effects == ("damping",)


def test_what_is_odd_weighs_by_its_share_of_the_error() -> None:
    """Nothing at 0; as much as everything else at the share that may be left over; all where it is all."""
    for named in ((), (contender(90.0, "damping"),)):
        odds = [said(*named, odd=part).probabilities["unknown"] for part in (0.0, 0.01, LEFT_OVER, 0.7, 1.0)]
        assert odds == sorted(odds) and odds[0] < 0.01 and 0.02 < odds[1] < 0.06
        assert odds[2] == pytest.approx(0.5, abs=0.01) and odds[3] > 0.9 and odds[4] > 0.999
    assert said(contender(90.0, "damping"), odd=0.1).effects == ("damping",)
    assert said(odd=0.3).verdict == "unknown"


def amplitude(label: str) -> Parameter:
    return OFFERED[label].parameters[0]


@pytest.mark.parametrize("label", ["damping", "sensor_gain.force", "preload"])
def test_an_amplitude_that_wants_to_be_more_than_is_physical_speaks_for_something_unknown(label: str) -> None:
    p = amplitude(label)
    within, beyond = contender(90.0, label), contender(90.0, label, **{p.name: p.upper})
    assert said(within).effects == (OFFERED[label].name,)
    found = said(beyond)
    assert found.verdict == "unknown"
    assert found.probabilities["unknown"] > 0.99
    assert said(contender(89.0, "dry_friction.rate"), beyond).probabilities["dry_friction"] < 0.5
    assert said(contender(99.0, "dry_friction.rate"), beyond).effects == ("dry_friction",)


def test_of_two_effects_neither_may_be_more_than_is_physical() -> None:
    p = amplitude("sensor_gain.force")
    both = contender(300.0, "damping", "sensor_gain.force", **{p.name: p.lower})
    assert said(contender(200.0, "damping"), both).verdict == "unknown"


def test_an_effect_that_a_variant_takes_too_far_is_shown_by_the_one_that_stays_within() -> None:
    p = amplitude("dry_friction.stroke")
    far = contender(80.0, "dry_friction.stroke", **{p.name: p.upper})
    found = said(far, contender(90.0, "dry_friction.rate"))
    assert found.effects == ("dry_friction",)
    assert found.chosen.label == "dry_friction.rate"


@pytest.mark.parametrize(
    ("label", "end", "cut_short"),
    [
        ("damping", "upper", True),
        ("damping", "lower", False),  # where it is not there
        ("sensor_gain.force", "lower", True),
        ("saturation.force", "upper", False),  # towards where it is not there
        ("saturation.force", "lower", True),
        ("end_stop.upper", "upper", False),  # as good as rigid
        ("slip", "upper", False),
    ],
)
def test_which_ends_of_an_amplitude_cut_a_search_short(label: str, end: str, cut_short: bool) -> None:
    p = amplitude(label)
    inside = 0.5 * (p.lower + p.upper)
    assert OFFERED[label].cut_short({p.name: getattr(p, end)}) is cut_short
    assert not OFFERED[label].cut_short({p.name: inside})


def test_what_the_best_contender_leaves_is_asked_of_the_best_contender() -> None:
    """A pair leads by its nats, the single that is as likely without the pair's price is what is weighed."""
    single, pair = contender(200.0, "damping"), contender(205.0, "damping", "sensor_drift.force")
    held = ranking(contender(0.0), (pair, single), shares(pair, single), {one.name: 1 for one in OFFERED.values()})
    assert held.best is single
    assert held.leader is single
    assert said(single, unnamed=190.0, rest=150.0).verdict == "unknown"
    assert said(single, unnamed=190.0, rest=10.0).effects == ("damping",)


def test_what_is_left_beside_an_effect_is_there_without_it() -> None:
    """A poor candidate that a stand-in mends, where one on the base alone finds nothing."""
    poor = contender(8.0, "damping")
    assert said(poor, unnamed=2.0, rest=30.0).verdict != "unknown"
    assert said(poor, unnamed=40.0, rest=30.0).verdict == "unknown"


def test_of_contenders_that_gain_nothing_none_leads() -> None:
    base, worse = contender(0.0), contender(-3.0, "damping")
    held = ranking(base, (worse,), shares(worse), {one.name: 1 for one in OFFERED.values()})
    assert held.leader is base
    assert held.best is worse


def test_a_mistake_takes_what_speaks_for_nothing_else() -> None:
    nothing = with_mistake(said(contender(3.0, "damping")), "unit_error")
    assert nothing.effects == ("unit_error",)
    assert "none" not in nothing.probabilities
    assert nothing.probabilities["unit_error"] > 0.9
    beside = with_mistake(said(contender(90.0, "damping")), "unit_error")
    assert beside.effects == ("unit_error", "damping")
    assert beside.probabilities["unit_error"] == pytest.approx(beside.probabilities["damping"], abs=0.01)
    stranger = with_mistake(said(odd=0.9), "unit_error")
    assert stranger.verdict == "unknown"
    for found in (nothing, beside, stranger):
        assert sum(found.probabilities.values()) == pytest.approx(1.0)


def test_who_has_no_evidence_is_not_weighed() -> None:
    competitors = contender(np.nan, "preload"), contender(50.0, "damping"), contender(np.nan, "damping", "preload")
    held = ranking(contender(0.0), competitors, shares(*competitors), {one.name: 1 for one in OFFERED.values()})
    assert held.best is competitors[1]
    assert said(*competitors).effects == ("damping",)


@pytest.mark.parametrize("given", [{"rest": np.nan}, {"unnamed": np.nan}, {"odd": np.nan}])
def test_what_is_no_number_is_no_verdict(given: dict[str, float]) -> None:
    with pytest.raises(FloatingPointError, match="what is left unexplained is not a number"):
        said(contender(50.0, "damping"), **given)


def test_a_pair_must_add_to_the_best_single_though_that_may_not_be_named() -> None:
    base, alone, both = contender(0.0), contender(60.0, "damping"), contender(55.0, "damping", "sensor_drift.force")
    found = ranking(base, [alone, both], shares(alone, both), {one.name: 1 for one in OFFERED.values()}, {alone.label})
    assert found.living == (), "two effects that gain less than one of them does"
