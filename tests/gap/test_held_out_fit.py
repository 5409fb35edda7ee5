"""What a diagnosis claims beside its own errors on held-out trials, by hand."""

from __future__ import annotations

from dataclasses import replace

from geocontact.data.diagnosis import BudgetPart, ChannelGap, Detected, Diagnosis, Where
from geocontact.gap.held_out_fit import goodness_of_diagnosis, without_claims


def said(verdict: str, before: float, after: float, *effects: str) -> Diagnosis:
    """A diagnosis of one channel with a floor of 1."""
    gap = ChannelGap(before, after, 1.0, 1.0 - after / before, (0.1, 0.4), 0.5, "N", 3)
    odds = {"damping": 0.8, "unknown": 0.2}
    return Diagnosis("case", "elbow", verdict, effects, odds, effects, (), (), {"force": gap}, {}, 1.0, "0")  # type: ignore[arg-type]


def test_no_gap_with_errors_beyond_noise_is_doubted() -> None:
    (doubt,) = goodness_of_diagnosis(said("no_gap", 3.0, 3.0)).doubts
    assert "3 times the noise floor" in doubt.what and not doubt.contradicts
    assert goodness_of_diagnosis(said("no_gap", 1.2, 1.2)).doubts == ()


def test_what_remains_beside_a_part_contradicts_nothing() -> None:
    """An effect that takes 45 % of a square of 100 floors leaves an error of 7.4."""
    whole, part = said("explained", 10.0, 7.4, "damping"), said("partly_explained", 10.0, 7.4, "damping")
    assert [doubt.contradicts for doubt in goodness_of_diagnosis(whole).doubts] == [True]
    assert [doubt.contradicts for doubt in goodness_of_diagnosis(part).doubts] == [False]


def test_a_withdrawn_effect_leaves_no_figures_of_its_own() -> None:
    d = replace(
        said("explained", 10.0, 8.0, "damping"),
        budget={"force": {"effects": BudgetPart(0.36, (0.3, 0.4))}},
        detected=(Detected("damping", 50.0, "force", 0.36, (0.3, 0.4)),),
        where=(Where("force", (0.2, 0.4), 1.0, 0.01, "constitutive"),),
    )
    left = without_claims(d, "why")
    assert (left.verdict, left.effects, dict(left.budget), left.detected) == ("unknown", (), {}, ())
    assert left.probabilities == {"unknown": 1.0, "damping": 0.0} and left.where[0].stage == ""
    gap = left.gap["force"]
    assert (gap.rmse_before, gap.rmse_after, gap.reduction, gap.ci95, gap.unexplained) == (
        10.0,
        10.0,
        0.0,
        (0.0, 0.0),
        None,
    )
