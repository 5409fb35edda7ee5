"""What a next experiment promises, against numbers drawn: normal data of which one of two explanations is true."""

from __future__ import annotations

from itertools import pairwise
from statistics import NormalDist

import numpy as np
import pytest

from geocontact.gap.experiment.promise import Outlook, margin, outlooks_of, share_told_apart


def drawn(lead: float, nats: float, needed: float, count: int = 40_000) -> float:
    """Share of draws of 50 normal numbers after which the true mean is ahead by more than is needed.

    The means differ by a vector of squared length 2 `nats`; likelihoods are written out.
    """
    rng = np.random.default_rng(8)
    apart = rng.standard_normal(50)
    apart *= np.sqrt(2.0 * nats) / np.linalg.norm(apart)
    seen = rng.standard_normal((count, 50))
    true, other = -0.5 * (seen**2).sum(axis=1), -0.5 * ((seen - apart) ** 2).sum(axis=1)
    return float((lead + true - other > needed).mean())


@pytest.mark.parametrize(("lead", "nats"), [(0.0, 1.0), (0.0, 6.0), (-2.0, 9.0), (3.0, 2.0), (1.5, 20.0)])
def test_one_other_explanation(lead: float, nats: float) -> None:
    one = Outlook(1.0, [lead], [nats])
    assert share_told_apart([one], 0.0) == pytest.approx(drawn(lead, nats, margin(0.0)), abs=0.01)


def test_both_count_by_their_probability_and_leads_change_sign() -> None:
    looks = outlooks_of(
        ["a", "b"], {"a": -10.0, "b": -12.0}, {"a": 0.75, "b": 0.25}, {("a", "b"): 8.0, ("b", "a"): 5.0}
    )
    assert [one.leads for one in looks] == [[2.0], [-2.0]]
    each = [share_told_apart([one], 30.0) for one in looks]
    assert share_told_apart(looks, 30.0) == pytest.approx(0.75 * each[0] + 0.25 * each[1])
    assert each[0] > each[1]


def test_more_to_explain_needs_more_and_more_evidence_gives_more() -> None:
    assert margin(100.0) == pytest.approx(3.0 * margin(0.0))
    shares = [share_told_apart([Outlook(1.0, [0.0], [nats])], 40.0) for nats in (2.0, 8.0, 30.0, 200.0)]
    assert all(low < high for low, high in pairwise(shares)) and shares[-1] > 0.99


def test_of_several_no_more_is_promised_than_they_allow() -> None:
    """Two that are ruled out in 60 % of repetitions each are both ruled out in 20 to 60 % of them."""
    nats = 6.0
    lead = margin(0.0) - nats + NormalDist().inv_cdf(0.6) * np.sqrt(2.0 * nats)
    assert share_told_apart([Outlook(1.0, [lead], [nats])], 0.0) == pytest.approx(0.6)
    assert share_told_apart([Outlook(1.0, [lead, lead], [nats, nats])], 0.0) == pytest.approx(0.2)
    assert share_told_apart([Outlook(1.0, [lead] * 3, [nats] * 3)], 0.0) == 0.0
    both, hard = Outlook(1.0, [0.0, 0.0], [500.0, 5.0]), Outlook(1.0, [0.0], [5.0])
    assert share_told_apart([both], 0.0) == pytest.approx(share_told_apart([hard], 0.0))


def test_without_probabilities_all_weigh_the_same() -> None:
    looks = outlooks_of(["a", "b"], {"a": 0.0, "b": 0.0}, {}, {("a", "b"): 8.0, ("b", "a"): 8.0})
    assert [one.weight for one in looks] == [1.0, 1.0]
