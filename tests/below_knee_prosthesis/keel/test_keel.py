"""Hinges in place of a beam: what they keep exactly, and how fast they come to it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.below_knee_prosthesis.keel.keel import deflected, root_compliance, tip_compliance, torsional_stiffness
from geocontact.below_knee_prosthesis.keel.sole import law_of, sole_of
from geocontact.below_knee_prosthesis.keel.vsf import fulcrum_of, vsf_keel


def turned(keel_joints: int, fulcrum: float, x: np.ndarray) -> np.ndarray:
    """Small deflection of the hinged keel at x per force on the tip."""
    keel = vsf_keel(joints=keel_joints)
    turn = keel.compliance(fulcrum) * (keel.length - keel.places)
    return np.asarray(np.clip(x[:, None] - keel.places, 0.0, None) @ turn)


@given(st.floats(0.066, 0.151), st.integers(1, 40))
def test_tip_gives_what_the_beam_gives(fulcrum: float, joints: int) -> None:
    keel = vsf_keel(joints=joints)
    found = keel.compliance(fulcrum) @ (keel.length - keel.places) ** 2
    assert found == pytest.approx(tip_compliance(fulcrum, keel.length, keel.bending, "pinned"), rel=1e-12)


@pytest.mark.parametrize("fulcrum", [0.066, 0.1, 0.151])
def test_deflected_shape_converges_at_second_order(fulcrum: float) -> None:
    x, keel = np.linspace(0.16, 0.229, 30), vsf_keel()
    exact = deflected(x, fulcrum, keel.length, keel.bending, "pinned")
    counts = np.array([32, 64, 128, 256])
    error = [np.abs(turned(int(n), fulcrum, x) - exact).max() for n in counts]
    order = -np.polyfit(np.log(counts), np.log(error), 1)[0]
    assert order == pytest.approx(2.0, abs=0.35), error


def test_whole_turn_is_kept_up_to_the_factor() -> None:
    """Without the factor the hinges' sum is that of the beam and of its root."""
    keel = vsf_keel(joints=64)
    whole = (keel.length - 0.1) / keel.bending + root_compliance(0.1, keel.bending, "pinned")
    assert keel.compliance(0.1).sum() == pytest.approx(whole, rel=2e-3)


def test_stiffness_is_continuous_in_the_fulcrum() -> None:
    keel = vsf_keel()
    for place in keel.places[1:4]:
        assert keel.compliance(place - 1e-9) == pytest.approx(keel.compliance(place + 1e-9), rel=1e-4)


def test_eight_joints_span_229_mm() -> None:
    keel = vsf_keel()
    assert len(keel.places) == 8
    assert keel.places[0] == 0.066
    assert keel.places[-1] + keel.pitch == pytest.approx(0.229)
    with pytest.raises(ValueError, match=r"out of its range, 0\.066 to 0\.151 m"):
        keel.stiffness(0.06)


def test_torsion_of_a_square_is_timoshenkos() -> None:
    """J = 0.1406 w⁴ of a square is out of reach of the formula, 0.229 w t³ at 2:1 is not (art. 109, table)."""
    assert torsional_stiffness(1.0, 2.0, 1.0) == pytest.approx(0.229 * 2.0, rel=0.01)
    assert torsional_stiffness(1.0, 10.0, 1.0) == pytest.approx(0.312 * 10.0, rel=0.01)


def test_low_medium_high_are_in_order() -> None:
    assert fulcrum_of("low") < fulcrum_of("medium") < fulcrum_of("high")


@pytest.mark.parametrize(("finer", "columns", "count"), [(1, 2, 24), (2, 2, 48), (2, 4, 96)])
def test_finer_soles_are_as_stiff(finer: int, columns: int, count: int) -> None:
    sole = sole_of(vsf_keel(), finer=finer, columns=columns)
    law = law_of(sole)
    assert len(sole.spheres) == count
    assert list(sole.spheres.zones) == ["heel_back", "heel_middle", "heel_front", "midfoot", "forefoot"]
    stiffness = [law.stiffness[chosen].sum() for chosen in sole.spheres.zones.values()]
    assert stiffness == pytest.approx([30e3, 30e3, 30e3, 120e3, 460e3])
