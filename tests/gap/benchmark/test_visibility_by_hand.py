"""How visible an effect is, beside whole covariance matrices: what generalised least squares leave of it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from geocontact.gap_benchmark.synthetic import visibility

RNG = np.random.default_rng(17)
THETA = np.array([2.0, -1.0])


def test_visible_nats_by_hand(monkeypatch: pytest.MonkeyPatch) -> None:
    """½ of the least (g - J δ)ᵀ (V + J Σ Jᵀ + P Pᵀ)⁻¹ (g - J δ) over trials that share δ; its share by V alone."""
    spread = np.array([[0.3, 0.1], [0.1, 0.2]])
    maps = [RNG.normal(size=(2, count, 2)) for count in (9, 14)]
    planted, trials, gaps = [], [], []
    for of in maps:
        root = np.tril(RNG.normal(size=(2 * of.shape[1],) * 2)) * 0.2 + np.eye(2 * of.shape[1])
        placed = 0.4 * RNG.normal(size=(*of.shape[:2], 3))
        gap = RNG.normal(size=of.shape[:2])
        planted.append(of @ THETA + gap)
        gaps.append(gap.ravel())
        model = lambda theta, of=of: of @ theta  # noqa: E731
        diagonal = np.diag(root @ root.T).reshape(gap.shape).copy()
        trials.append(visibility.WhitenedTrial(lambda t: t, of.shape[1], model, of @ THETA, root, diagonal, placed))
    models = {id(each.model): of for each, of in zip(trials, maps, strict=True)}
    monkeypatch.setattr(visibility, "refit", lambda *_: THETA)
    monkeypatch.setattr(visibility, "jacobian", lambda model, _: models[id(model)])
    monkeypatch.setattr(visibility, "movable", lambda *_: np.ones(2, bool))
    bare = getattr(visibility.sight, "__wrapped__", visibility.sight)
    found = bare(SimpleNamespace(theta=THETA, spread=spread), trials, planted, np.ones(2))

    def left(with_variation: bool) -> float:
        normal, right, whole = np.zeros((2, 2)), np.zeros(2), 0.0
        for one, of, gap in zip(trials, maps, gaps, strict=True):
            J, P = of.reshape(-1, 2), one.placed.reshape(-1, 3)
            V = one.factor @ one.factor.T
            if with_variation:
                V = V + J @ spread @ J.T + P @ P.T
            inverse = np.linalg.inv(V)
            normal += J.T @ inverse @ J
            right += J.T @ inverse @ gap
            whole += float(gap @ inverse @ gap)
        return whole - float(right @ np.linalg.solve(normal, right))

    raw = sum(float(g @ np.linalg.inv(t.factor @ t.factor.T) @ g) for g, t in zip(gaps, trials, strict=True))
    assert found.nats == pytest.approx(0.5 * left(True), rel=1e-9)
    assert found.whole == pytest.approx(0.5 * raw, rel=1e-9)
    assert found.swallowed == pytest.approx(1.0 - left(False) / raw, rel=1e-9)
