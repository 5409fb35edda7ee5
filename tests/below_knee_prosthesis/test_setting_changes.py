"""Changes between settings by hand: means, the model's error of the other stances, Student's and Welch's intervals."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from geocontact.below_knee_prosthesis.setting_changes import StanceOutcome, model_error, setting_changes

PLACES = {"low": 0.066, "medium": 0.117, "high": 0.151}


def stance(person: str, setting: str, predicted: float, measured: float) -> StanceOutcome:
    return StanceOutcome("moment", person, setting, PLACES[setting], predicted, measured)


OTHERS = [
    stance("B", "low", 1.02, 1.00),
    stance("B", "medium", 1.14, 1.10),
    stance("B", "high", 1.20, 1.22),
    stance("C", "low", 0.95, 0.90),
    stance("C", "medium", 1.00, 0.99),
]


def test_the_models_error_is_about_each_persons_mean() -> None:
    """B: 0.02, 0.04, -0.02 about 0.04/3; C: 0.05, 0.01 about 0.03; three degrees of freedom by hand."""
    square = (0.02 - 0.04 / 3) ** 2 + (0.04 - 0.04 / 3) ** 2 + (-0.02 - 0.04 / 3) ** 2 + 2 * 0.02**2
    assert model_error(OTHERS) == (pytest.approx(np.sqrt(square / 3.0), rel=1e-9), 3)


def test_a_change_has_the_interval_of_the_other_stances_error() -> None:
    """One stance low, two high: mean change, t with three degrees of freedom times s (1 + 1/2)^1/2."""
    own = [stance("A", "low", 1.0, 1.1), stance("A", "high", 1.5, 1.55), stance("A", "high", 1.6, 1.75)]
    (found,) = [each for each in setting_changes([*own, *OTHERS]) if each.person == "A"]
    assert found.settings == ("low", "high") and found.stances == (1, 2)
    assert (found.predicted, found.measured) == (pytest.approx(0.55), pytest.approx(0.55))
    half = stats.t.ppf(0.975, 3) * model_error(OTHERS)[0] * np.sqrt(1.5)
    assert (found.lower, found.upper) == (pytest.approx(0.55 - half), pytest.approx(0.55 + half))
    assert found.verdict == "predicted" and np.isnan(found.measured_lower)


@pytest.mark.parametrize(
    ("predicted", "measured", "verdict"),
    [
        (0.50, 0.45, "predicted"),
        (0.50, 0.05, "right direction"),
        (0.50, -0.30, "wrong direction"),
        (0.03, 0.30, "within the model's error"),
        (-0.50, -0.52, "predicted"),
    ],
)
def test_what_is_said_of_a_change(predicted: float, measured: float, verdict: str) -> None:
    own = [stance("A", "low", 1.0, 1.0), stance("A", "medium", 1.0 + predicted, 1.0 + measured)]
    (found,) = [each for each in setting_changes([*own, *OTHERS]) if each.person == "A"]
    assert found.verdict == verdict


def test_the_stances_compared_do_not_tell_their_own_error() -> None:
    """Three stances of one person: for each pair one other stance, which shows no error."""
    own = [stance("A", name, 1.0, 1.0 + k) for k, name in enumerate(PLACES)]
    found = setting_changes(own)
    assert [each.settings for each in found] == [("low", "medium"), ("low", "high"), ("medium", "high")]
    assert {each.verdict for each in found} == {"error not known"} and np.isnan([each.lower for each in found]).all()


def test_settings_are_ordered_by_their_fulcrum() -> None:
    own = [stance("A", "high", 2.0, 2.0), stance("A", "low", 1.0, 1.0)]
    assert setting_changes(own)[0].settings == ("low", "high") and setting_changes(own)[0].measured == 1.0


def test_the_measured_change_has_welchs_interval() -> None:
    low, high = np.array([1.0, 1.1, 0.9]), np.array([1.6, 1.2])
    own = [stance("A", "low", 0.0, each) for each in low] + [stance("A", "high", 0.0, each) for each in high]
    (found,) = setting_changes(own)
    ends = stats.ttest_ind(high, low, equal_var=False).confidence_interval(0.95)
    assert (found.measured_lower, found.measured_upper) == (pytest.approx(ends.low), pytest.approx(ends.high))


def test_planted_errors_leave_the_measured_change_inside_in_nineteen_of_twenty() -> None:
    """Person's bias and stance's error planted, true changes anything: the interval holds 95 % of measured changes."""
    rng, inside = np.random.default_rng(5), []
    for _ in range(60):
        rows = []
        for person in "ABCDEF":
            bias = 0.3 * rng.standard_normal()
            for setting in PLACES:
                true = rng.standard_normal()
                rows.append(stance(person, setting, true + bias + 0.05 * rng.standard_normal(), true))
        inside += [each.lower <= each.measured <= each.upper for each in setting_changes(rows)]
    assert 0.93 < np.mean(inside) < 0.97
