"""What an effect may do otherwise than its candidate: worth a set share of its energy, and only where it is needed."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.selection.model_comparison import BENT, orthonormal
from tests.elsewhere import Elsewhere
from tests.gap.cases import evidence_of_bends


def test_bends_are_worth_a_set_share_of_the_effect_and_a_mistake_has_none(elsewhere: Elsewhere) -> None:
    gain, share, of_a_mistake = elsewhere(evidence_of_bends, 0.0)
    assert share == pytest.approx(BENT**2, rel=1e-6)
    assert of_a_mistake == 0
    assert -20.0 < gain < 4.0


def test_an_effect_that_leans_is_still_that_effect(elsewhere: Elsewhere) -> None:
    gain, _, _ = elsewhere(evidence_of_bends, 0.4)
    assert gain > 10.0


def test_channels_have_directions_of_their_own_and_together_those_of_all() -> None:
    """Against the singular vectors of all channels at once; a silent channel, one that is lost beside the others."""
    rng = np.random.default_rng(6)
    net, monomials = rng.normal(size=(60, 4)) * [1.0, 20.0, 0.0, 1e-7], rng.normal(size=(60, 5))
    monomials[:, 4] = monomials[:, 0] - monomials[:, 1]
    kept = orthonormal(net, monomials)
    assert kept.shape == (60, 4, 8)
    whole = np.zeros((60, 4, 4, 5))
    for c in range(4):
        whole[:, c, c] = net[:, c, None] * monomials
    left, singular, _ = np.linalg.svd(whole.reshape(240, 20), full_matrices=False)
    left, flat = left[:, singular > 1e-6 * singular[0]], kept.reshape(240, -1)
    np.testing.assert_allclose(flat @ flat.T, left @ left.T, atol=1e-12)
    assert not kept[:, 0, 4:].any() and not kept[:, 1, :4].any()
