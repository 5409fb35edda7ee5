"""What a fit to an elbow's recordings predicts of what it did not use."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from geocontact.axis_misalignment.bins import FORCE, Binned, binned
from geocontact.axis_misalignment.law import NAMES
from geocontact.axis_misalignment.least_squares import ElbowFit, estimated, problem_of
from geocontact.axis_misalignment.prediction import (
    correlations_with_others,
    each_left_out,
    held_out,
    mirrored_r2,
    residuals_of,
    scale_line,
)
from geocontact.axis_misalignment.synthetic import PAPER
from tests.systems.elbow_trials import QUICK, parameters, trials

WIDTH = np.radians(3.0)
THREE = trials(design=replace(QUICK, seconds=20.0), count=3)


@cache
def data() -> Binned:
    return binned(THREE, WIDTH)


@cache
def fit() -> ElbowFit:
    return estimated(problem_of(data(), parameters({"l": PAPER["l"], "z": PAPER["z"]}), {}), 1)


def test_a_trial_of_the_other_sign_runs_against_the_others() -> None:
    turned = [*THREE[:2], replace(THREE[2], force=-THREE[2].force)]
    found = correlations_with_others(binned(turned, WIDTH), 8)
    assert found[2] < -0.9
    assert (correlations_with_others(data(), 8) > 0.9).all()
    assert np.isnan(correlations_with_others(data(), 1000)).all()
    assert np.isnan(correlations_with_others(binned(THREE[:1], WIDTH), 8)).all()


def test_what_was_held_out_is_counted_in_bin_means_by_hand() -> None:
    one = data().only(1)
    measured = one.cells.means[:, FORCE]
    off = measured - fit().problem.law.force(fit().theta)[data().cells.trial == 1]
    found = held_out("t2", one, fit().theta)
    assert (found.name, found.bins) == ("t2", len(measured))
    assert found.rmse == pytest.approx(np.sqrt(np.mean(off**2)))
    assert found.r2 == pytest.approx(1.0 - np.sum(off**2) / np.sum((measured - measured.mean()) ** 2))


def test_each_trial_is_predicted_by_the_others_alone() -> None:
    found = each_left_out(data(), fit())
    assert [one.name for one in found] == ["t1", "t2", "t3"]
    assert min(one.r2 for one in found) > 0.9
    others = estimated(problem_of(data().without(0), fit().problem.parameters, {}), 1)
    assert found[0].rmse == pytest.approx(held_out("t1", data().only(0), others.theta).rmse, rel=1e-4)
    alone = binned(THREE[:1], WIDTH)
    assert each_left_out(alone, fit()) == []


def test_along_the_scale_lengths_grow_as_stiffness_falls_and_the_force_stays() -> None:
    line = scale_line(fit(), np.array([0.8, 1.0, 1.25]))
    k, length = NAMES.index("k"), NAMES.index("l")
    np.testing.assert_allclose(line.numbers[:, length], fit().theta[length] * np.array([0.8, 1.0, 1.25]))
    np.testing.assert_allclose(line.numbers[:, k] * line.numbers[:, length], fit().theta[k] * fit().theta[length])
    np.testing.assert_allclose(line.r2, line.r2[1], atol=1e-9)
    assert line.alone_r2[1] == line.r2[1] > line.alone_r2[[0, 2]].max()


def test_the_force_turned_over_is_met_less_well_and_residuals_are_those_of_the_bins() -> None:
    measured = data().cells.means[:, FORCE]
    own = 1.0 - np.sum((measured - fit().predicted) ** 2) / np.sum((measured - measured.mean()) ** 2)
    assert mirrored_r2(fit()) < own
    found = residuals_of(THREE, data(), fit())
    count = data().cells.count
    by_hand = [
        np.average((measured - fit().predicted)[data().cells.place == k], weights=count[data().cells.place == k])
        for k in np.unique(data().cells.place)
    ]
    np.testing.assert_allclose(found.off, by_hand)
    assert 0.5 < found.excess.ratio < 2.0
