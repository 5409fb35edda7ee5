"""The propped beam against the least of its energy, and what compressions say of it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import BSpline
from scipy.linalg import solve

from geocontact.below_knee_prosthesis.keel.compression import Compressed, fitted, rounded, told_apart
from geocontact.below_knee_prosthesis.keel.keel import deflected, tip_compliance
from geocontact.below_knee_prosthesis.keel.sections import SUPPORTS, Support
from geocontact.below_knee_prosthesis.keel.vsf import compression

LENGTH, EI = 0.229, 22.7
LOW, HIGH = Compressed(0.066, 10e3), Compressed(0.151, 32e3)


def by_ritz(x: np.ndarray, fulcrum: float, support: Support) -> np.ndarray:
    """Deflection per force on the tip: least energy over cubic splines with a double knot at the fulcrum.

    Multipliers hold the end and the fulcrum. The exact deflection is a cubic on either side, so it is in the space.
    """
    knots = np.array([0.0] * 4 + [fulcrum] * 2 + [LENGTH] * 4)
    count = len(knots) - 4
    shapes = [BSpline(knots, unit, 3) for unit in np.eye(count)]
    bent = [shape.derivative(2) for shape in shapes]
    nodes, weights = leggauss(3)
    spans = [(0.0, fulcrum), (fulcrum, LENGTH)]
    at = np.concatenate([0.5 * (b - a) * nodes + 0.5 * (a + b) for a, b in spans])
    weight = np.concatenate([0.5 * (b - a) * weights for a, b in spans])
    curved = np.array([shape(at) for shape in bent])
    energy = EI * (curved * weight) @ curved.T
    held = [[shape(0.0) for shape in shapes], [shape(fulcrum) for shape in shapes]]
    if support == "clamped":
        held.append([shape.derivative()(0.0) for shape in shapes])
    none = np.zeros((len(held), len(held)))
    matrix = np.block([[energy, np.array(held).T], [np.array(held), none]])
    load = np.append([shape(LENGTH) for shape in shapes], np.zeros(len(held)))
    found = solve(matrix, load)[:count]
    return np.asarray(BSpline(knots, found, 3)(x))


@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("fulcrum", [0.066, 0.12])
def test_deflection_is_that_of_least_energy(support: Support, fulcrum: float) -> None:
    x = np.linspace(0.0, LENGTH, 25)
    found = deflected(x, fulcrum, LENGTH, EI, support)
    assert found == pytest.approx(by_ritz(x, fulcrum, support), rel=1e-8, abs=1e-12)
    assert found[-1] == pytest.approx(tip_compliance(fulcrum, LENGTH, EI, support), rel=1e-12)


@pytest.mark.parametrize(
    ("support", "ratio", "series", "medium"), [("pinned", 4.367, 92.3e3, 0.1174), ("clamped", 4.852, 74.6e3, 0.1159)]
)
def test_a_stiffness_in_series_explains_the_measured_range(
    support: Support, ratio: float, series: float, medium: float
) -> None:
    """Beam theory alone makes the ends differ by 4.4 or 4.9; measured are 32 and 10 N/mm."""
    low, high = (tip_compliance(each.fulcrum, LENGTH, 1.0, support) for each in (LOW, HIGH))
    assert low / high == pytest.approx(ratio, abs=5e-4)
    fit = compression(support)
    assert [fit.stiffness(0.066), fit.stiffness(0.151)] == pytest.approx([10e3, 32e3], rel=1e-12)
    assert fit.series == pytest.approx(series, rel=1e-3)
    assert fit.fulcrum(19e3, 0.066, 0.151) == pytest.approx(medium, abs=5e-5)


def test_rounding_of_the_measured_stiffnesses_moves_medium_by_two_millimetres() -> None:
    at = [fit.fulcrum(19e3, 0.066, 0.151) for fit in rounded(LOW, HIGH, LENGTH, "pinned", 500.0)]
    assert [min(at), max(at)] == pytest.approx([0.1148, 0.1199], abs=1e-4)


def test_how_the_end_is_held_and_where_the_plate_presses_are_told_badly() -> None:
    """Compressions at ten fulcrums tell EI from the series stiffness, but not these two besides."""
    at, fit = np.linspace(0.066, 0.151, 10), compression()
    assert told_apart(at, fit, share=False).verdict == "separable"
    both = told_apart(at, fit, share=True, place=True)
    assert both.verdict == "poorly separated"
    assert both.condition > 900.0
    with pytest.raises(ValueError, match="2 compressions cannot separate 3 numbers"):
        told_apart(at[[0, -1]], fit, share=True)


def test_stiffnesses_that_no_beam_spans_are_refused() -> None:
    with pytest.raises(ValueError, match="differ by more than a beam with a pinned end does"):
        fitted(LOW, Compressed(0.151, 60e3), LENGTH, "pinned")
