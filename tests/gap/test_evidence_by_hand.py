"""Evidence of models beside whole covariance matrices and an integral: closed forms of linear Gaussian models."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import exp, log, pi, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad

from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import free
from geocontact.gap.case.whitening import Whitening
from geocontact.gap.identifiability.detectability import Gainer, _calibration_share, _gains, _price
from geocontact.gap.identifiability.separability import Confounder, separation
from geocontact.gap.identifiability.signatures import BaseState, base_state_of
from geocontact.gap.levels import FLAT
from geocontact.gap.selection.evidence import Judged, judged, log_evidence
from geocontact.gap.selection.model_comparison import base_contender
from geocontact.gap.selection.surrogate import SIZES, _without, chosen
from geocontact.identify.noise.covariance import Layout
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case

RNG = np.random.default_rng(21)


def log_normal(residual: np.ndarray, matrix: np.ndarray) -> float:
    """log N(residual; 0, matrix), without the constant."""
    sign, size = np.linalg.slogdet(matrix)
    assert sign > 0
    return -0.5 * float(residual @ np.linalg.inv(matrix) @ residual) - 0.5 * float(size)


def test_evidence_of_one_number_is_the_integral_over_it() -> None:
    """∫ N(r; d w, 1) N(w; 0, s²) dw, the constants of r aside."""
    d, r, s = RNG.normal(size=7), 1.5 * RNG.normal(size=7), 0.7

    def likelihood(w: float) -> float:
        square = sum((a - b * w) ** 2 for a, b in zip(r, d, strict=True))
        return exp(-0.5 * square) * exp(-0.5 * (w / s) ** 2) / (s * sqrt(2.0 * pi))

    mean = quad(likelihood, -12.0 * s, 12.0 * s, epsabs=0.0, epsrel=1e-12)[0]
    assert log_evidence(r, d[:, None], np.array([s])) == pytest.approx(log(mean), rel=1e-9)


def test_evidence_by_the_whole_matrix() -> None:
    """N(r; 0, I + D S² Dᵀ); a spread of nothing leaves its column out."""
    r, D, S = RNG.normal(size=40), RNG.normal(size=(40, 4)) * [3.0, 0.2, 1.0, 8.0], np.array([0.5, 2.0, 0.0, 0.1])
    matrix = np.eye(40)
    for i in range(40):
        for j in range(40):
            matrix[i, j] += sum(D[i, k] * S[k] ** 2 * D[j, k] for k in range(4))
    assert log_evidence(r, D, S) == pytest.approx(log_normal(r, matrix), rel=1e-10)
    part = matrix[:25, :25]
    later = log_evidence(r, D, S) - log_evidence(r[:25], D[:25], S)
    gain = matrix[25:, :25] @ np.linalg.inv(part)
    predictive = log_normal(r[25:] - gain @ r[:25], matrix[25:, 25:] - gain @ matrix[:25, 25:])
    assert later == pytest.approx(predictive, rel=1e-9), "held-out samples as the others predict them"


def test_what_weighs_less_by_the_whole_matrix() -> None:
    """(I + B Bᵀ)^(-1/2) v, by eigenvalues of the whole matrix."""
    B, v = RNG.normal(size=(30, 3)) * [4.0, 0.5, 1.0], RNG.normal(size=(30, 2))
    values, vectors = np.linalg.eigh(np.eye(30) + B @ B.T)
    np.testing.assert_allclose(_without(B)(v), vectors @ np.diag(values**-0.5) @ vectors.T @ v, atol=1e-12)


@pytest.fixture(scope="module")
def prepared() -> tuple[Problem, Judged]:
    """A short case, its noise estimated; the base model judged."""
    case = elbow_case(duration=3.0)
    problem = problem_of(case, system_of(case))
    one = base_contender(problem).judged
    return problem, replace(one, model=replace(one.model, passed_on=problem.passed_on))


def covariance(layout: Layout, levels: object, varied: np.ndarray) -> np.ndarray:
    """Of the measured samples of a trial, blocks independent but for what varies."""
    matrix = np.zeros((len(layout.rows),) * 2)
    ends = np.cumsum([0, *(len(block.rows) for block in layout.blocks)])
    for block, (a, b) in zip(layout.blocks, pairwise(ends), strict=True):
        matrix[a:b, a:b] = block.covariance(levels) * np.outer(block.spread, block.spread)  # type: ignore[arg-type]
    flat = varied.reshape(-1, varied.shape[-1])[layout.rows]
    return matrix + flat @ flat.T


def test_whitening_by_the_whole_matrix(prepared: tuple[Problem, Judged]) -> None:
    problem, one = prepared
    (layout, *_), noise = problem.layouts, one.noise
    varied = problem.varied(one.model.jacobian)[0] * noise.varies
    whiten = Whitening.of(noise.whiteners[0], varied)
    residual = one.model.residuals[0]
    white = whiten(residual[..., None])[:, 0]
    whole = log_normal(residual.ravel()[layout.rows], covariance(layout, noise.levels, varied))
    assert -0.5 * float(white @ white) - whiten.log_scale == pytest.approx(whole, rel=1e-8)


def test_a_judged_model_by_the_whole_matrix(prepared: tuple[Problem, Judged]) -> None:
    """All trials at once: noise of each, and parameters that all have alike, flat priors as wide as their bounds."""
    problem, one = prepared
    count = len(problem.layouts)
    basis = [0.3 * RNG.normal(size=(*r.shape, 2)) for r in one.model.residuals]
    found = judged(problem, one.model, one.noise, basis)
    varied = [each * one.noise.varies for each in problem.varied(one.model.jacobian)]
    sizes = np.cumsum([0, *(len(layout.rows) for layout in problem.layouts)])
    matrix, shared, off = np.zeros((sizes[-1], sizes[-1])), [], []
    spreads = np.array([(p.upper - p.lower) / FLAT for p in free(problem.system)])
    for i, layout in enumerate(problem.layouts):
        a, b = sizes[i], sizes[i + 1]
        matrix[a:b, a:b] = covariance(layout, one.noise.levels, varied[i])
        jacobian = one.model.jacobian[i]
        columns = np.concatenate([jacobian * spreads, basis[i]], axis=-1)
        shared.append(columns.reshape(-1, columns.shape[-1])[layout.rows])
        off.append(one.model.residuals[i].ravel()[layout.rows])
    loose = np.concatenate(shared)
    whole = log_normal(np.concatenate(off), matrix + loose @ loose.T)
    assert found.nats == pytest.approx(whole - one.noise.surprise, rel=1e-7)
    inside = slice(0, sizes[len(problem.calibration.trials)])
    part = log_normal(np.concatenate(off)[inside], (matrix + loose @ loose.T)[inside, inside])
    assert found.calibration == pytest.approx(part - one.noise.surprise, rel=1e-7)
    assert count > len(problem.calibration.trials)


def test_smoother_inputs_are_owed_by_hand(prepared: tuple[Problem, Judged]) -> None:
    """A model that passes half of the inputs' noise on owes ⅜ of the squares that the base model makes of it."""
    problem, one = prepared
    passed = problem.passed_on
    smooth = replace(one.model, passed_on=tuple(0.5 * each for each in passed))
    owed = 0.0
    for i, (layout, each) in enumerate(zip(problem.layouts, passed, strict=True)):
        varied = problem.varied(one.model.jacobian)[i] * one.noise.varies
        flat = each.ravel()[layout.rows]
        owed += 0.5 * 0.75 * float(flat @ np.linalg.inv(covariance(layout, one.noise.levels, varied)) @ flat)
    before, after = (judged(problem, each, one.noise, one.discrepancy_basis).nats for each in (one.model, smooth))
    assert owed > 1e-3
    assert before - after == pytest.approx(owed, rel=1e-6)


def test_bumps_by_the_whole_matrix() -> None:
    """The first is that with the largest log N(r; 0, I + s² c cᵀ) - log N(r; 0, I) of all columns and sizes."""
    known, columns = RNG.normal(size=(80, 2)), RNG.normal(size=(80, 9)) * RNG.uniform(0.2, 2.0, 9)
    residual = RNG.normal(size=80) + 1.5 * columns[:, 4] - 0.9 * columns[:, 7] + 3.0 * known[:, 0]
    out = np.eye(80) - known @ np.linalg.inv(known.T @ known) @ known.T
    left, clear = out @ residual, out @ columns
    single = {
        (s, k): log_normal(left, np.eye(80) + s * s * np.outer(clear[:, k], clear[:, k])) + 0.5 * float(left @ left)
        for s in SIZES
        for k in range(9)
    }
    found = chosen(residual, columns, known, 50, 2.0)
    size, first = max(single, key=lambda each: single[each])
    assert found.columns[0] == first and len(found.columns) == 2
    second = {}
    base = np.eye(80) + size * size * np.outer(clear[:, first], clear[:, first])
    for s in SIZES:
        for k in range(9):
            second[s, k] = log_normal(left, base + s * s * np.outer(clear[:, k], clear[:, k])) + 0.5 * float(
                left @ left
            )
    other, then = max((each for each in second if each[1] == found.columns[1]), key=lambda each: second[each])
    assert then == 7
    assert found.gain == pytest.approx(second[other, then], rel=0.01)  # its size by the rest of the first alone
    assert any(found.gain == pytest.approx(second[s, then], rel=1e-6) for s in SIZES)
    assert found.price == pytest.approx(2.0 + 2 * log(9 * len(SIZES)))
    powers = next(s for s in SIZES if found.gain == pytest.approx(second[s, then], rel=1e-6))
    S = np.diag([size, powers])
    design = clear[:, found.columns] @ S
    weights = S @ np.linalg.solve(np.eye(2) + design.T @ design, design.T @ left)
    np.testing.assert_allclose(found.by_all.weights, weights, rtol=1e-5)
    rest = residual - columns[:, found.columns] @ weights
    np.testing.assert_allclose(found.by_all.shift, np.linalg.inv(known.T @ known) @ known.T @ rest, rtol=1e-5)


def test_prices_and_gains_by_hand(prepared: tuple[Problem, Judged]) -> None:
    """½ log det(I + Sᵀ Dᵀ P⊥ D S); ½ |Qᵀ ε|² less the price; part of what is left that calibration rows hold."""
    D = RNG.normal(size=(30, 3))
    base, _ = np.linalg.qr(RNG.normal(size=(30, 2)))
    out = np.eye(30) - base @ base.T
    assert _price(D, base) == pytest.approx(0.5 * np.linalg.slogdet(np.eye(3) + D.T @ out @ D)[1], rel=1e-12)
    Q, _ = np.linalg.qr(RNG.normal(size=(30, 2)))
    draws = 3.0 * RNG.normal(size=(6, 30))
    one = Gainer("a", Q, Q, 1.3, 1.3, 0.7, 1.0, 0)
    wanted = [0.5 * sum(float(d @ q) ** 2 for q in Q.T) - 1.3 for d in draws]
    np.testing.assert_allclose(_gains(one, np.eye(30), draws), np.array(wanted) - 0.7, rtol=1e-12)
    above = _gains(replace(one, sign=1), np.eye(30), draws)
    assert [bool(np.isfinite(g)) for g in above] == [float(d @ Q[:, 0]) > 0.0 for d in draws]
    problem, model = prepared
    ground = base_state_of(problem, model.noise, model.model.values)
    moved = RNG.normal(size=len(ground.slopes))
    inside = slice(0, ground.fitted_rows)
    J = ground.slopes
    shift = np.linalg.inv(J[inside].T @ J[inside]) @ J[inside].T @ moved[inside]
    left = moved - J @ shift
    share = float(left[inside] @ left[inside]) / float(left @ left)
    assert _calibration_share(ground, moved) == pytest.approx(share, rel=1e-6)


def test_what_another_effect_leaves_by_hand(prepared: tuple[Problem, Judged]) -> None:
    """½ of the squares beside the span of its directions, far off where no refit is made."""
    problem, model = prepared
    ground: BaseState = base_state_of(problem, model.noise, model.model.values)
    target = 50.0 * RNG.normal(size=len(ground.slopes))
    spans = [np.linalg.qr(RNG.normal(size=(len(target), 3)))[0] for _ in range(2)]
    other = Confounder("b", ground.system, (), (), tuple(spans))  # type: ignore[arg-type]
    lefts = [0.5 * sum(float(x) ** 2 for x in target - Q @ (Q.T @ target)) for Q in spans]

    one = SimpleNamespace(candidate=SimpleNamespace(label="a"))
    bare = getattr(separation, "__wrapped__", separation)
    found = bare(ground, one, target, other)  # type: ignore[arg-type]
    assert found.nats == pytest.approx(min(lefts), rel=1e-10)
