"""The elbow against its equations written out again from the text, and against a point worked by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geocontact.axis_misalignment.explicit import misalignment
from geocontact.chain.differentiated_inputs import recorded
from geocontact.systems.elbow import build
from tests.systems.examples import ELBOW_CONSTANTS, elbow, elbow_trial, recording


def restated(beta: np.ndarray, k: float, x: float, y: float, l: float, z: float) -> np.ndarray:
    tangent = (x * np.cos(beta) + y * np.sin(beta)) / (l + y * np.cos(beta) - x * np.sin(beta))
    linear = y + np.sqrt(l**2 - x**2) - np.hypot(l * np.sin(beta) - x, y + l * np.cos(beta))
    return k * (linear - z * tangent)


@pytest.mark.parametrize("x", [0.0, 0.03, 0.09])
@pytest.mark.parametrize("y", [0.0, 0.04, 0.11])
def test_force_is_that_of_the_text(x: float, y: float) -> None:
    trial = elbow_trial("t", 2.0)
    got = elbow().simulate(trial, {"k": 321.0, "x": x, "y": y})
    want = restated(trial.column("beta"), 321.0, x, y, **ELBOW_CONSTANTS)
    np.testing.assert_allclose(got[:, 0], want, rtol=1e-12, atol=1e-12)


def test_former_names_of_the_lengths_are_read() -> None:
    trial, free = elbow_trial("t", 2.0), elbow().parameters
    former = build(free, {"l_ex": ELBOW_CONSTANTS["l"], "z_ex": ELBOW_CONSTANTS["z"]}, {})
    values = {each.name: each.start for each in free}
    np.testing.assert_array_equal(former.simulate(trial, values), elbow().simulate(trial, values))


def test_a_right_angle_by_hand() -> None:
    # l = 0.17, x = 0.03, y = 0.04, z = 0.1: d_lin = 0.04 + sqrt(0.028) - sqrt(0.0212), tan = 0.04/0.14
    trial = recording("t", np.arange(6.0), {"beta": np.full(6, np.pi / 2), "force": np.zeros(6)})
    got = elbow().simulate(trial, {"k": 300.0, "x": 0.03, "y": 0.04, "l": 0.17, "z": 0.1})
    assert got[3, 0] == pytest.approx(300.0 * (0.04 + 0.16733200530681513 - 0.14560219778561037 - 0.1 * 2.0 / 7.0))
    assert got[3, 0] == pytest.approx(9.947513684, rel=1e-9)


@given(st.floats(0.0, 2.3), st.floats(0.0, 0.1), st.floats(0.0, 0.12), st.floats(-0.05, 0.05), st.floats(-0.03, 0.03))
def test_rate_is_the_derivative(beta: float, x: float, y: float, slope: float, curvature: float) -> None:
    n = np.array([0.185, 0.09, x, y, slope, curvature, 0.9, 0.0, 1.0, 1.0])
    x_there = x + (beta - 0.9) * (slope + curvature * (beta - 0.9))
    assume(0.185 + y * np.cos(beta) - x_there * np.sin(beta) > 0.02)  # differences are poor near the pole of tan γ
    assume(abs(x_there) < 0.17)
    step = 1e-6
    ahead, behind = (misalignment(beta + side * step, 0.0, n)[0] for side in (1, -1))
    assert misalignment(beta, 2.0, n)[1] == pytest.approx(2.0 * (ahead - behind) / (2 * step), rel=1e-5, abs=1e-7)


def test_lengths_and_stiffness_scale_each_other_away() -> None:
    trial = elbow_trial("t", 2.0)
    values = {"k": 300.0, "x": 0.03, "y": 0.04, "l": 0.17, "z": 0.09}
    larger = {name: 2.0 * value for name, value in values.items()} | {"k": 150.0}
    np.testing.assert_allclose(elbow().simulate(trial, larger), elbow().simulate(trial, values), rtol=1e-12)


def test_out_of_its_domain_it_is_finite() -> None:
    trial = elbow_trial("t", 2.0)
    folded = elbow().simulate(trial, {"k": 300.0, "x": 0.19, "y": 0.04})  # offset longer than the link
    assert np.isfinite(folded).all()
    turn = np.linspace(-7.0, 7.0, 500)
    over = recording("t", np.arange(500.0), {"beta": turn, "force": turn})
    assert np.isfinite(elbow().simulate(over, {"k": 300.0, "x": 0.1, "y": 0.185})).all()  # through the pole of tan γ


def test_a_missing_value_is_asked_for_by_name() -> None:
    with pytest.raises(KeyError, match="y"):
        elbow().simulate(elbow_trial("t", 2.0), {"k": 300.0, "x": 0.03})


def test_differentiating_is_done_once_per_recording() -> None:
    signals = elbow_trial("t", 2.0).signals
    assert recorded(signals, ("beta",)) is recorded(signals, ("beta",))
