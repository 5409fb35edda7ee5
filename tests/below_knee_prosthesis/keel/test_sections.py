"""A keel whose bending stiffness changes along its length, against Euler and Bernoulli by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from geocontact.below_knee_prosthesis.keel.compression import pressed_tip
from geocontact.below_knee_prosthesis.keel.sections import SUPPORTS, Sections, Support
from geocontact.below_knee_prosthesis.keel.vsf import vsf_keel

LENGTH, EI = 0.24, 20.0


def two_sections_by_hand(edge: float, first: float, second: float, force: float) -> float:
    """Tip of a cantilever of EI `first` up to `edge` and `second` beyond, under a force on its tip.

    Moment F (L - x): the tip gives F/3 [(L³ - b³)/EI1 + b³/EI2], b = L - edge.
    """
    rest = LENGTH - edge
    return force / 3.0 * ((LENGTH**3 - rest**3) / first + rest**3 / second)


def test_a_cantilever_of_one_section_gives_force_times_length_cubed_over_three_ei() -> None:
    """A clamp with the fulcrum next to it is a plain cantilever: F L³/(3 EI)."""
    found = Sections().tip_compliance(1e-9, LENGTH, EI, "clamped")
    assert found == pytest.approx(LENGTH**3 / (3.0 * EI), rel=1e-6)


@pytest.mark.parametrize(("edge", "second"), [(0.1, 5.0), (0.15, 60.0)])
def test_a_cantilever_of_two_sections_gives_what_a_hand_computes(edge: float, second: float) -> None:
    sections = Sections((edge,), (1.0, second / EI))
    found = 50.0 * sections.tip_compliance(1e-9, LENGTH, EI, "clamped")
    assert found == pytest.approx(two_sections_by_hand(edge, EI, second, 50.0), rel=1e-6)


@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("fulcrum", [0.06, 0.13])
def test_a_propped_beam_of_three_sections_has_the_energy_of_its_moments(support: Support, fulcrum: float) -> None:
    """Castigliano by quadrature: the tip gives the integral of m²/EI, the clamp's moment is that of least energy."""
    edges, factors = (0.08, 0.16), (1.5, 1.0, 0.4)
    x, weight = quadrature([0.0, fulcrum, *edges, LENGTH])
    flexible = weight / (EI * np.array(factors)[np.searchsorted(edges, x)])
    behind, arm = x < fulcrum, LENGTH - fulcrum
    moment = np.where(behind, arm * x / fulcrum, LENGTH - x)
    clamp = np.where(behind, 1.0 - x / fulcrum, 0.0)
    if support == "clamped":
        moment = moment - clamp * (flexible @ (moment * clamp)) / (flexible @ clamp**2)
    found = Sections(edges, factors).tip_compliance(fulcrum, LENGTH, EI, support)
    assert found == pytest.approx(flexible @ moment**2, rel=1e-10)


def quadrature(ends: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights that are exact for squares of moments between these places."""
    nodes, weights = leggauss(3)
    spans = list(zip(sorted(ends)[:-1], sorted(ends)[1:], strict=True))
    x = np.concatenate([0.5 * (b - a) * nodes + 0.5 * (a + b) for a, b in spans])
    return x, np.concatenate([0.5 * (b - a) * weights for a, b in spans])


def test_sections_that_are_alike_are_one() -> None:
    """Cut into three of the same stiffness, a keel has the hinges of the uncut one."""
    keel = vsf_keel()
    cut = replace(keel, sections=Sections((0.1, 0.17), (1.0, 1.0, 1.0)))
    np.testing.assert_allclose(cut.compliance(0.12), keel.compliance(0.12), rtol=1e-12)
    assert cut.torsion(0.12) == pytest.approx(keel.torsion(0.12), rel=1e-12)


def test_hinges_of_a_keel_of_two_sections_give_the_beams_tip() -> None:
    """A plate on the tip of the hinged keel: small travel, stiffness of the beam; a soft tip bends in front."""
    keel = replace(vsf_keel(joints=16), sections=Sections((0.15,), (1.0, 0.3)))
    travel, series = np.array([1e-5]), 1e9
    tip = keel.sections.tip_compliance(0.1, keel.length, keel.bending, "pinned")
    assert pressed_tip(keel, 0.1, series, travel)[0] / travel[0] == pytest.approx(1.0 / tip, rel=2e-3)
    alike = vsf_keel(joints=16).compliance(0.1)
    front, back = keel.compliance(0.1)[-2:].sum() / alike[-2:].sum(), keel.compliance(0.1)[3:5].sum() / alike[3:5].sum()
    assert front == pytest.approx(1.0 / 0.3, rel=0.05) and back == pytest.approx(1.0, rel=0.05)


@pytest.mark.parametrize(
    ("edges", "factors"), [((0.1,), (1.0,)), ((0.1, 0.1), (1.0, 1.0, 1.0)), ((0.1,), (1.0, 0.0)), ((-0.1,), (1.0, 1.0))]
)
def test_sections_that_are_none_are_refused(edges: tuple[float, ...], factors: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="section"):
        Sections(edges, factors)
