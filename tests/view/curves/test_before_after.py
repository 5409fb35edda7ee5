"""Before and after adding an effect, read back from what is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from geocontact.view.curves.before_after import SHADE, before_after
from geocontact.view.curves.quantity import AREA, FORCE

PERCENT = np.linspace(0.0, 100.0, 11)
MEASURED = 100.0 + np.arange(33.0).reshape(3, 11)


def test_curves_and_residuals_are_what_was_given() -> None:
    before, after = MEASURED - 4e-6, MEASURED + 1e-6
    axes = before_after(PERCENT, MEASURED, before, after, AREA, "slip").axes
    for k in range(3):
        measured, old, new = (line.get_ydata() for line in axes[k].lines)
        np.testing.assert_array_equal(measured, 1e6 * MEASURED[k])
        np.testing.assert_array_equal(old, 1e6 * before[k])
        np.testing.assert_array_equal(new, 1e6 * after[k])
        zero, left, right = (line.get_ydata() for line in axes[3 + k].lines)
        assert not np.any(zero)
        np.testing.assert_allclose(left, 4.0, atol=1e-6)  # measured minus simulated, mm²
        np.testing.assert_allclose(right, -1.0, atol=1e-6)


def test_errors_are_pooled_over_fitted_and_held_out_trials_apart() -> None:
    offset = np.array([[3.0], [4.0], [12.0]])
    figure = before_after(PERCENT, MEASURED, MEASURED - offset, MEASURED + offset / 2.0, FORCE, "slip", (2,), "abc")
    assert [axes.get_title() for axes in figure.axes[:3]] == [
        "a\nRMSE 3.00 → 1.50 N",
        "b\nRMSE 4.00 → 2.00 N",
        "c\nRMSE 12.0 → 6.00 N",
    ]
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert texts[1] == "without slip: RMSE fitted 3.54, held out 12.0 N"  # sqrt((9 + 16) / 2)
    assert texts[2] == "with slip: RMSE fitted 1.77, held out 6.00 N"
    assert "held out" in texts[3]
    shaded = [to_rgb(axes.get_facecolor()) == to_rgb(SHADE) for axes in figure.axes]
    assert shaded == [False, False, True] * 2


def test_both_errors_are_over_the_same_samples() -> None:
    before, after = MEASURED - 2.0, MEASURED - 1.0
    before[0, :5] -= 100.0
    after[0, :5] = np.nan  # where one model has no value, the other does not count either
    figure = before_after(PERCENT, MEASURED, before, after, FORCE, "slip")
    assert figure.axes[0].get_title() == "trial 1\nRMSE 2.00 → 1.00 N"
    assert len(figure.legends[0].get_texts()) == 3, "nothing held out, nothing said about it"
    assert figure.legends[0].get_texts()[1].get_text() == "without slip: RMSE fitted 2.00 N"


@pytest.mark.usefixtures("unchecked")
def test_what_cannot_be_drawn_is_refused() -> None:
    gone = MEASURED.copy()
    gone[1] = np.nan
    seven = np.ones((7, 11))
    with pytest.raises(ValueError, match=r"after: shape \(2, 11\), expected \(3, 11\)"):
        before_after(PERCENT, MEASURED, MEASURED, MEASURED[:2], FORCE, "slip")
    with pytest.raises(ValueError, match=r"measured: shape \(3, 11\), expected \(trials, 10\)"):
        before_after(PERCENT[:10], MEASURED, MEASURED, MEASURED, FORCE, "slip")
    with pytest.raises(ValueError, match="trial 2: no sample at which all three are there"):
        before_after(PERCENT, MEASURED, gone, MEASURED, FORCE, "slip")
    with pytest.raises(ValueError, match="7 trials: at most 6 fit side by side"):
        before_after(PERCENT, seven, seven, seven, FORCE, "slip")
    with pytest.raises(ValueError, match=r"held_out: \[3\], expected numbers of trials from 0 to 2"):
        before_after(PERCENT, MEASURED, MEASURED, MEASURED, FORCE, "slip", (3,))
    with pytest.raises(ValueError, match="names: 2 for 3 trials"):
        before_after(PERCENT, MEASURED, MEASURED, MEASURED, FORCE, "slip", (), ("a", "b"))
