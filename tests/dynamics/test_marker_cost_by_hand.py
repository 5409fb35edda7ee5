"""The cost of a pose against markers, beside a loop over plain numbers."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.dynamics.inverse_kinematics import MarkerFit
from geocontact.dynamics.tree import tree_of
from tests.dynamics.models import all_kinds


def test_each_marker_counts_by_its_own_weight() -> None:
    """Half of Σ w |x - observed|² + Σ v (q - wanted)², no two weights alike; its slope by differences."""
    tree = tree_of(all_kinds())
    fit, rng = MarkerFit(tree, tree.model.markers), np.random.default_rng(1)
    m, n = len(tree.model.markers), len(tree.names)
    q, wanted = 0.2 * rng.normal(size=n), 0.2 * rng.normal(size=n)
    weights, held, observed = rng.uniform(0.1, 9.0, m), rng.uniform(0.1, 9.0, n), rng.normal(size=(m, 3))
    places, whole = fit.places(q), tree.coupled()
    from casadi import Function

    moved = Function("moved", [tree.q], [whole])(q).full().ravel()
    total = sum(weights[k] * (places[k, axis] - observed[k, axis]) ** 2 for k in range(m) for axis in range(3))
    total += sum(held[k] * (moved[k] - wanted[k]) ** 2 for k in range(n))
    against = (observed, weights, wanted, held)
    slope, cost = fit.slope(q, against)
    pairs = 0.0 if fit._ties is None else cost - 0.5 * total
    assert cost - pairs == pytest.approx(0.5 * total, rel=1e-12)
    for k in range(n):
        step = np.zeros(n)
        step[k] = 1e-6
        by = (fit.slope(q + step, against)[1] - fit.slope(q - step, against)[1]) / 2e-6
        assert slope[k] == pytest.approx(by, rel=1e-5, abs=1e-6 * abs(slope).max())


@pytest.mark.parametrize("count", [1, 2])
def test_weights_too_few_are_refused(count: int) -> None:
    """One, which NumPy would give to all of them, as well as another number."""
    tree = tree_of(all_kinds())
    m, n = len(tree.model.markers), len(tree.names)
    fit = MarkerFit(tree, tree.model.markers)
    with pytest.raises(ValueError, match=f"{count} numbers for {m} symbols"):
        fit._slope(np.zeros(n), np.zeros(3 * m), np.ones(count), np.zeros(n), np.ones(n))
