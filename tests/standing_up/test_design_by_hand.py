"""The worst of several sets of parameters, and prices of the knee's limit, beside plain numbers."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

import geocontact.standing_up.assistance_design as design

RNG = np.random.default_rng(8)


def test_the_smooth_worst_by_hand(monkeypatch: pytest.MonkeyPatch) -> None:
    """(Σ v^m)^(1/m) over the sets, and its slope by every number."""
    values, slopes = np.array([310.0, 289.0, 305.0, 120.0]), RNG.normal(size=(4, 6))
    monkeypatch.setattr(design, "_each", lambda _, __: (values, slopes))
    bare = getattr(design._worst, "__wrapped__", design._worst)
    found, slope = bare((), 0)

    def norm(x: np.ndarray) -> float:
        moved = [values[s] + sum(slopes[s, k] * x[k] for k in range(6)) for s in range(4)]
        return sum((v / 300.0) ** design.ORDER for v in moved) ** (1.0 / design.ORDER) * 300.0

    assert found == pytest.approx(norm(np.zeros(6)), rel=1e-12)
    assert 310.0 < found < 310.0 * 4 ** (1.0 / design.ORDER)
    for k, step in enumerate(1e-4 * np.eye(6)):
        assert slope[k] == pytest.approx((norm(step) - norm(-step)) / 2e-4, rel=1e-6)


def test_prices_by_hand() -> None:
    """λ ≥ 0 with the least |J + Cᵀ λ|², of all sets of places that may have one, each by its normal equations."""
    of_aim, of_knees = RNG.normal(size=5), RNG.normal(size=(4, 5))
    on = np.array([True, False, True, True])
    found = design._prices(of_aim, of_knees, on)
    assert (found >= 0.0).all() and found[1] == 0.0
    best = float(of_aim @ of_aim)
    for size in (1, 2, 3):
        for places in combinations((0, 2, 3), size):
            C = of_knees[list(places)]
            price = np.linalg.solve(C @ C.T, -C @ of_aim)
            if (price >= 0.0).all():
                best = min(best, float(np.sum((of_aim + C.T @ price) ** 2)))
    assert float(np.sum((of_aim + of_knees.T @ found) ** 2)) == pytest.approx(best, rel=1e-10)
