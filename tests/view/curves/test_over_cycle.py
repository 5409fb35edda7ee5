"""Mean ± SD over the cycle, read back from what is drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb

from geocontact.data.trial import mean_and_sd
from geocontact.view.curves.over_cycle import mean_over_cycle
from geocontact.view.curves.quantity import AREA, CYCLE, FORCE
from geocontact.view.curves.style import panels

PERCENT = np.linspace(0.0, 100.0, 21)
TRIALS = np.random.default_rng(1).uniform(100e-6, 300e-6, (5, 21))


def band(axes: Axes, k: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper edge of the k-th band at each of the positions it covers."""
    corners = np.concatenate([path.vertices for path in axes.collections[k].get_paths()])
    x = np.unique(corners[:, 0])
    return (
        np.array([corners[corners[:, 0] == at, 1].min() for at in x]),
        np.array([corners[corners[:, 0] == at, 1].max() for at in x]),
    )


def legend_texts(axes: Axes) -> list[str]:
    legend = axes.get_legend()
    assert legend is not None
    return [text.get_text().replace("\u00a0", " ") for text in legend.get_texts()]


def test_line_is_the_mean_and_band_is_mean_plus_minus_sd_in_square_millimetres() -> None:
    axes = mean_over_cycle(PERCENT, {"implant": TRIALS}, AREA).axes[0]
    mean, sd = 1e6 * np.mean(TRIALS, axis=0), 1e6 * np.std(TRIALS, axis=0, ddof=1)
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), PERCENT)
    np.testing.assert_allclose(axes.lines[0].get_ydata(), mean, rtol=1e-13)
    lower, upper = band(axes)
    np.testing.assert_allclose(lower, mean - sd, rtol=1e-13)
    np.testing.assert_allclose(upper, mean + sd, rtol=1e-13)
    assert axes.get_xlabel() == "cycle [%]" and axes.get_ylabel() == "contact area [mm²]"
    assert legend_texts(axes) == ["implant, mean ± SD (n = 5)"]


def test_missing_samples_are_left_out_and_told() -> None:
    gated = TRIALS.copy()
    gated[0, 3:6] = np.nan
    gated[1:, 10] = np.nan
    gated[:, 15] = np.nan
    mean, sd = mean_and_sd(gated)
    np.testing.assert_allclose(mean[4], gated[1:, 4].mean(), rtol=1e-14)
    np.testing.assert_allclose(sd[4], gated[1:, 4].std(ddof=1), rtol=1e-14)
    assert mean[10] == gated[0, 10] and np.isnan(sd[10]), "one trial has no spread"
    assert np.isnan(mean[15]) and np.isnan(sd[15])
    axes = mean_over_cycle(PERCENT, {"implant": gated}, AREA).axes[0]
    assert legend_texts(axes) == ["implant, mean ± SD (n = 0–5)"]
    assert not np.isin(PERCENT[[10, 15]], np.concatenate([p.vertices for p in axes.collections[0].get_paths()])).any()


def test_a_single_trial_has_no_band() -> None:
    axes = mean_over_cycle(PERCENT, {"one": TRIALS[:1] * 1e6}, FORCE).axes[0]
    np.testing.assert_allclose(axes.lines[0].get_ydata(), TRIALS[0] * 1e6, rtol=1e-15)
    assert not axes.collections
    assert legend_texts(axes) == ["one (n = 1)"]


def test_trials_in_any_order_give_the_same_mean_and_sd() -> None:
    for one, other in zip(mean_and_sd(TRIALS), mean_and_sd(TRIALS[::-1]), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-13)


def test_a_large_offset_does_not_hurt_the_sd() -> None:
    np.testing.assert_allclose(mean_and_sd(TRIALS + 1e3)[1], np.std(TRIALS, axis=0, ddof=1), rtol=1e-8)


def test_groups_differ_in_colour_and_in_grey() -> None:
    axes = mean_over_cycle(PERCENT, {str(k): TRIALS + k * 1e-5 for k in range(6)}, AREA).axes[0]
    assert len({to_rgb(line.get_color()) for line in axes.lines}) == 6
    assert len({str(line._unscaled_dash_pattern) for line in axes.lines}) == 6


def test_it_draws_on_the_axes_it_is_given() -> None:
    figure, (top, bottom) = panels(2, 1)
    assert mean_over_cycle(PERCENT, {"a": TRIALS}, AREA, top) is figure
    assert mean_over_cycle(PERCENT, {"a": TRIALS}, replace(FORCE, name="normal force"), bottom) is figure
    assert top.get_ylabel() == "contact area [mm²]" and bottom.get_ylabel() == "normal force [N]"


@pytest.mark.usefixtures("unchecked")
@pytest.mark.parametrize(
    ("cycle", "groups", "said"),
    [
        (PERCENT, {"a": TRIALS[:, :20]}, r"group 'a': shape \(5, 20\), expected \(trials, 21\)"),
        (PERCENT, {"a": TRIALS[0]}, r"group 'a': shape \(21,\), expected \(trials, 21\)"),
        (PERCENT, {"a": TRIALS[:0]}, "group 'a': no values"),
        (PERCENT, {"a": TRIALS * np.nan}, "group 'a': every sample is NaN"),
        (PERCENT, {"a": TRIALS + np.inf}, "group 'a': 105 infinite values; put NaN"),
        (PERCENT, {"a": [["x"] * 21]}, "group 'a': not an array of numbers"),
        (PERCENT, {}, "group: nothing to draw"),
        (PERCENT, {str(k): TRIALS for k in range(7)}, "group: 7 of them, at most 6"),
        (PERCENT / 100.0, {"a": TRIALS}, "cycle: ends at 1 %; fractions of a cycle times 100"),
        (PERCENT * 2.0, {"a": TRIALS}, "cycle: from 0 to 200, expected 0 to 100 %"),
        (PERCENT[::-1], {"a": TRIALS}, "cycle: not strictly increasing"),
        (PERCENT * np.nan, {"a": TRIALS}, "cycle: not strictly increasing"),
        (PERCENT[:, None], {"a": TRIALS}, r"cycle: shape \(21, 1\), expected \(t,\)"),
    ],
)
def test_what_cannot_be_drawn_is_refused(cycle: np.ndarray, groups: dict[str, np.ndarray], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        mean_over_cycle(cycle, groups, AREA)


def test_a_time_axis_is_not_a_percentage() -> None:
    axes = mean_over_cycle(PERCENT * 3.0, {"a": TRIALS}, AREA, along=replace(CYCLE, name="time", unit="s")).axes[0]
    assert axes.get_xlabel() == "time [s]"
