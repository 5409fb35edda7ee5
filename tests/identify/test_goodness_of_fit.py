"""Goodness of fit: known answers in closed form, and noise of whose excess the chance is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from geocontact.analyses.frame.collector import collecting, judge, say
from geocontact.analyses.frame.record import Record
from geocontact.data.plausible import VISCOUS
from geocontact.identify.goodness_of_fit import (
    Doubt,
    GoodnessOfFit,
    of_bounds,
    of_each,
    of_low_r2,
    of_many_r2,
    of_r2,
    of_range,
    of_residual,
    of_size,
    of_verdict,
    residual_test,
)


def test_a_residual_twice_its_noise() -> None:
    """The mean square of white noise of twice the size is 4 of n: (4 - 1) / sqrt(2 / n), within its own spread."""
    white = np.random.default_rng(1).normal(0.0, 2.0, 4000)
    test = residual_test(white, 1.0)
    assert test.ratio == pytest.approx(2.0, rel=0.03)
    assert test.excess == pytest.approx(3.0 / np.sqrt(2.0 / 4000), rel=0.1)


def test_memory_makes_an_excess_less_sure() -> None:
    """An AR(1) of a: rho_k = a^k, so that 1 + 2 sum rho^2 is (1 + a^2) / (1 - a^2)."""
    a, rng = 0.9, np.random.default_rng(2)
    noise = lfilter([np.sqrt(1.0 - a**2)], [1.0, -a], rng.normal(size=40_000))
    test = residual_test(1.5 * noise, 1.0)
    expected = (1.5**2 - 1.0) / np.sqrt(2.0 / 40_000 * (1.0 + a**2) / (1.0 - a**2))
    assert test.excess == pytest.approx(expected, rel=0.15)


@pytest.mark.parametrize("a", [0.0, 0.8])
def test_noise_as_stated_is_hardly_ever_doubted(a: float) -> None:
    rng = np.random.default_rng(3)
    drawn = [lfilter([np.sqrt(1.0 - a**2)], [1.0, -a], rng.normal(size=400)) for _ in range(400)]
    assert sum(bool(list(of_residual("x", "N", each, 1.0))) for each in drawn) <= 2


def test_sizes_of_a_residual() -> None:
    white = np.random.default_rng(4).normal(size=500)
    words = {
        size: [doubt.contradicts for doubt in of_residual("x", "N", size * white, 1.0)] for size in (1.0, 2.0, 5.0)
    }
    assert words == {1.0: [], 2.0: [False], 5.0: [True]}


def test_gaps_do_not_count() -> None:
    white = np.random.default_rng(5).normal(size=500)
    white[::7] = np.nan
    assert residual_test(white, 1.0).ratio == pytest.approx(1.0, abs=0.1)
    assert np.isnan(residual_test(np.full(3, np.nan), 1.0).ratio)


def test_each_reason() -> None:
    assert [doubt.contradicts for doubt in of_r2("force", -0.1)] == [True] and not list(of_r2("force", 0.0))
    assert [d.what for d in of_bounds({"k": (5.0, 1.0, 5.0), "d": (2.0, 1.0, 5.0)})] == [
        "k is on the upper bound of its search, 5"
    ]
    assert not list(of_bounds({"k": (5.0, 1.0, 5.0)}, allowed=("k",)))
    (turned,) = of_size("friction", (-3.2, -2.8), VISCOUS)
    assert turned.contradicts and "-3.2 N m s/rad to -2.8 N m s/rad, which cannot be the viscous" in turned.what
    assert not list(of_size("friction", (-3.2, 0.1), VISCOUS)), "an interval that reaches what is possible is no fault"
    assert not list(of_size("friction", (np.nan, np.nan), VISCOUS))
    (large,) = of_size("friction", (2800.0, 3200.0), VISCOUS)
    (small,) = of_size("friction", (0.0028, 0.0032), VISCOUS)
    assert (large.contradicts, small.contradicts) == (True, False) and "unusual" in small.what
    assert [d.contradicts for share in (0.0, 0.1, 0.9) for d in of_range("out of the cuff for", share)] == [False, True]


def test_members_of_a_group_contradict_it_together() -> None:
    """Half of them or more; a constant is the mean of each member's own data."""
    assert not list(of_many_r2("force", {"a": 0.0, "b": 0.9, "c": np.nan}))
    (one,) = of_many_r2("force", {"a": -0.1, "b": 0.9, "c": 0.8})
    (half,) = of_many_r2("force", {"a": -0.1, "b": 0.9})
    (alone,) = of_many_r2("force", {"a": -0.1})
    assert [each.contradicts for each in (one, half, alone)] == [False, True, True]
    assert "in 1 of 3: a (-0.10)" in one.what and "in a (-0.10)" in alone.what
    assert [d.contradicts for r2 in (-0.1, 0.0, 0.4, 0.5) for d in of_low_r2("force", r2)] == [True, False, False]


def test_a_verdict_that_its_interval_turns_is_doubtful() -> None:
    (open_one,) = of_verdict("the gain", (-0.1, 0.3), 0.0)
    assert not open_one.contradicts and "the interval -0.1 to 0.3 reaches the other verdict" in open_one.what
    assert not list(of_verdict("the gain", (0.1, 0.3), 0.0))


def test_outcome_is_the_worst_of_its_doubts() -> None:
    sure, unsure = Doubt("R² is -1", True), Doubt("k is on a bound", False)
    assert GoodnessOfFit((), ("force",)).outcome == "fits"
    assert GoodnessOfFit((unsure,), ()).outcome == "doubtful"
    found = GoodnessOfFit((unsure, sure), ())
    many = GoodnessOfFit(tuple(Doubt(f"channel {k}", True, float(k)) for k in range(5)), ())
    assert many.words.endswith("channel 4; channel 3; channel 2; and 2 more, see run.json")
    assert found.outcome == "contradicts" and found.words.endswith("must not be used: R² is -1; k is on a bound")


def test_the_record_says_it_first() -> None:
    with collecting(Record("test", {})) as record:
        say("12 N")
        judge(GoodnessOfFit((Doubt("R² is -1", True),), ("force",)))
        judge(GoodnessOfFit((Doubt("R² is -1", True), Doubt("k is on a bound", False)), ("k",)))
    assert record.fit is not None and record.fit.tested == ("force", "k") and len(record.fit.doubts) == 2
    assert record.judged.startswith("the result contradicts its data")


def test_one_number_that_is_missed_is_a_doubt_whatever_the_others_are() -> None:
    """Three numbers with deviations of 2, one missed by 3.1 of them: its mean square, 3.2, is no excess for three."""
    off = {"a": (0.0, 2.0), "b": (-6.2, 2.0), "c": (0.0, 2.0), "d": (5.9, 2.0), "e": (9.0, 0.0)}
    (doubt,) = of_each("the model", off, "N")
    assert doubt == Doubt("the model is -6.2 N off b, 3.1 times its standard deviation", False, 3.1)
    assert not [*of_residual("numbers", "N", np.array([0.0, -6.2, 0.0]), 2.0)]
