"""Every likelihood of noise beside whole covariance matrices, inverted and summed row by row.

log N(r; 0, V) = -½ rᵀ V⁻¹ r - ½ log det V, each channel, trial and level of a size of its own.
"""

from __future__ import annotations

from math import cos, exp, lgamma, log, pi, tanh

import numpy as np
import pytest
from scipy.optimize import minimize

from geocontact.gap.inputs.spectrum import Spectrum
from geocontact.gap.inputs.spectrum_components import Parts
from geocontact.identify.noise.autocorrelation import autocorrelation_of, sandwich
from geocontact.identify.noise.autoregressive import noise_of
from geocontact.identify.noise.covariance import Layout
from geocontact.identify.noise.input_noise import Instant, NoiseSpectrum
from geocontact.identify.noise.noise_levels import NoiseLevels, NoisePriors
from geocontact.identify.noise.noise_search import CostSurface
from geocontact.identify.noise.student import DEGREES, student_noise
from geocontact.identify.noise.trial_variation import Products, deviations, variation
from geocontact.identify.signals.low_pass import LowPass

RNG = np.random.default_rng(4)


def remembered(time: np.ndarray, sd: float, tau: float) -> np.ndarray:
    return np.array([[sd * sd * exp(-abs(a - b) / tau) for b in time] for a in time])


def unlikely(residual: np.ndarray, matrix: np.ndarray) -> float:
    """-log N(residual; 0, matrix), without the constant."""
    sign, size = np.linalg.slogdet(matrix)
    assert sign > 0
    return float(0.5 * residual @ np.linalg.inv(matrix) @ residual + 0.5 * size)


def uneven(count: int) -> np.ndarray:
    return np.cumsum(RNG.uniform(0.004, 0.02, count))


def test_noise_with_a_memory_by_hand() -> None:
    """Two channels over three trials of other lengths, one sample missing: no level beside it is likelier."""
    times = [uneven(n) for n in (40, 55, 31)]
    true = [(2.0, 0.03), (0.3, 0.11)]
    residuals = []
    for time in times:
        columns = [np.linalg.cholesky(remembered(time, *each)) @ RNG.normal(size=len(time)) for each in true]
        residuals.append(np.column_stack(columns))
    residuals[1][7, 0] = np.nan
    found = noise_of(times, residuals)
    for c in range(2):

        def cost(sd: float, tau: float, c: int = c) -> float:
            total = 0.0
            for time, residual in zip(times, residuals, strict=True):
                there = np.isfinite(residual[:, c])
                total += unlikely(residual[there, c], remembered(time[there], sd, tau))
            return total

        here = float(found.sd[c]), float(found.tau[c])
        by_hand = minimize(lambda x, c=c: cost(exp(x[0]), exp(x[1]), c), np.log(here), method="Nelder-Mead")
        assert cost(*here, c) - float(by_hand.fun) < 1e-6, "nats"
        np.testing.assert_allclose(here, np.exp(by_hand.x), rtol=1e-3)


def test_how_long_a_residual_remembers_by_hand() -> None:
    """-½ (n - p) log s² - ½ log det R - ½ log det JᵀR⁻¹J for each memory, times the prior, in weights that sum to 1."""
    time = uneven(60)
    jacobian = np.column_stack([np.ones(60), 50.0 * time, np.sin(9.0 * time)])
    residual = np.linalg.cholesky(remembered(time, 3.0, 0.05)) @ RNG.normal(size=60)
    found = autocorrelation_of(time, residual, jacobian)
    logs, power = [], []
    for tau in found.tau:
        R = remembered(time, 1.0, tau)
        inverse = np.linalg.inv(R)
        bread = jacobian.T @ inverse @ jacobian
        off = residual - jacobian @ np.linalg.solve(bread, jacobian.T @ inverse @ residual)
        square = float(off @ inverse @ off)
        power.append(square / 57)
        prior = 0.0
        for k in range(59):
            h = (time[k + 1] - time[k]) / tau
            prior += (h * exp(-h)) ** 2 / (1.0 - exp(-2.0 * h))
        value = -0.5 * 57 * log(square) - 0.5 * float(np.linalg.slogdet(R)[1] + np.linalg.slogdet(bread)[1])
        logs.append(value + 0.5 * log(prior))
    weight = np.exp(np.array(logs) - max(logs))
    np.testing.assert_allclose(found.weight, weight / weight.sum(), rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(found.variance, power, rtol=1e-8)
    inner = np.linalg.inv(jacobian.T @ jacobian)
    for k in (0, 11, 29):
        whole = found.variance[k] * inner @ jacobian.T @ remembered(time, 1.0, found.tau[k]) @ jacobian @ inner
        np.testing.assert_allclose(sandwich(found, time, jacobian)[k], whole, rtol=1e-8)


FREQUENCY = 3.0


class Wave(NoiseSpectrum):
    """Noise of one frequency: its covariances are sines of the lag."""

    def covariance(self, lag: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        turn = 2.0 * pi * FREQUENCY
        return np.cos(turn * lag), -turn * np.sin(turn * lag), turn**2 * np.cos(turn * lag)


WAVE = Wave(*np.ones((4, 2)))


def test_levels_of_noise_by_hand() -> None:
    """½ |x|² and, over blocks, -log N(r; 0, white + coloured + growing + inputs + what varies), limits heeded."""
    time, (count, channels) = uneven(50), (50, 2)
    there = np.ones((count, channels), bool)
    there[13, 1] = there[20:22, 0] = False
    to_value, to_rate = RNG.normal(size=(count, channels, 1)), 0.05 * RNG.normal(size=(count, channels, 1))
    spread, signal = RNG.uniform(0.5, 2.0, (count, channels)), RNG.uniform(0.0, 3.0, (count, channels))
    heard = Instant(time, to_value, to_rate, (WAVE,))
    layout = Layout.of(time, there, heard, spread, signal)
    middle = NoiseLevels(
        np.array([0.3, 0.7]),
        np.array([[0.5, 0.1], [0.2, 0.9]]),
        np.array([[0.1, 0.05], [0.02, 0.3]]),
        np.array([0.11, 0.05]),
        np.array([0.4]),
    )
    factor = np.tril(0.3 * RNG.normal(size=(13, 13))) + np.eye(13)
    limits = np.array([0.5, np.inf]), np.array([0.3])
    x = 0.2 * RNG.normal(size=13)
    residual, varied = RNG.normal(size=(count, channels)), RNG.normal(size=(count, channels, 3))
    surface = CostSurface.of([layout], [residual], [varied], NoisePriors(middle, factor, *limits))

    numbers = np.exp(np.log([0.3, 0.7, 0.5, 0.1, 0.2, 0.9, 0.1, 0.05, 0.02, 0.3, 0.11, 0.05, 0.4]) + factor @ x)
    white, coloured, memory, growing, inputs = numbers[:2], numbers[2:6], numbers[6:10], numbers[10:12], numbers[12:]
    for c, limit in enumerate(limits[0]):
        whole = (white[c] ** 2 + coloured[c] ** 2 + coloured[2 + c] ** 2) ** 0.5
        over = log(whole / limit) if whole > limit else 0.0
        down = exp(0.3 * tanh(over / 0.3) - over)
        white[c] *= down
        coloured[c] *= down
        coloured[2 + c] *= down
    over = max(log(inputs[0] / 0.3), 0.0)
    inputs = inputs * exp(0.3 * tanh(over / 0.3) - over)

    total = 0.5 * sum(each * each for each in x)
    for block in layout.blocks:
        n = len(block.rows)
        matrix = np.zeros((n, n))
        places = [(int(row) // channels, int(row) % channels) for row in block.rows]
        for i, (a, c) in enumerate(places):
            for j, (b, d) in enumerate(places):
                lag, turn = time[a] - time[b], 2.0 * pi * FREQUENCY
                if c == d:
                    for process in (c, 2 + c):
                        matrix[i, j] += coloured[process] ** 2 * exp(-abs(lag) / memory[process])
                if i == j:
                    matrix[i, j] += white[c] ** 2 + (growing[c] * signal[a, c] / spread[a, c]) ** 2
                own = to_value[a, c, 0] * to_value[b, d, 0] * cos(turn * lag)
                own += to_rate[a, c, 0] * to_rate[b, d, 0] * turn**2 * cos(turn * lag)
                odd = -turn * np.sin(turn * lag)
                own += (to_rate[a, c, 0] * to_value[b, d, 0] - to_value[a, c, 0] * to_rate[b, d, 0]) * odd
                matrix[i, j] += inputs[0] ** 2 * own / (spread[a, c] * spread[b, d])
                moved = sum(varied[a, c, q] * varied[b, d, q] for q in range(3))
                matrix[i, j] += moved / (spread[a, c] * spread[b, d])
        total += unlikely(np.array([residual[a, c] / spread[a, c] for a, c in places]), matrix)
    assert surface.at(x).cost == pytest.approx(total, rel=1e-7)


def test_variation_between_trials_by_hand() -> None:
    """Standard deviations at which Σ log N(r; 0, I + B Q Bᵀ), prior as so many trials, has no slope."""
    designs = [RNG.normal(size=(n, 2)) * [3.0, 0.4] for n in (12, 20, 9, 15)]
    deviated = [np.array([0.8, 2.1]) * RNG.normal(size=2) for _ in designs]
    residuals = [B @ b + RNG.normal(size=len(B)) for B, b in zip(designs, deviated, strict=True)]
    prior, weight = np.array([0.5, 1.5]), np.array([2.0, 0.7])
    found = variation([Products.of(r, B) for r, B in zip(residuals, designs, strict=True)], prior, weight, rounds=20000)

    def cost(sd: np.ndarray) -> float:
        """A prior worth w trials of s₀: w of ½ (s₀/s)² + log s."""
        total = sum(float(w * (0.5 * (s0 / s) ** 2 + log(s))) for w, s0, s in zip(weight, prior, sd, strict=True))
        for r, B in zip(residuals, designs, strict=True):
            total += unlikely(r, np.eye(len(r)) + B @ np.diag(sd**2) @ B.T)
        return total

    best = minimize(
        lambda x: cost(np.exp(x)), np.log(prior), method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-10}
    )
    np.testing.assert_allclose(found, np.exp(best.x), rtol=2e-3)
    one = Products.of(residuals[0], designs[0])
    B, Q = designs[0], np.diag(found**2)
    kriged = Q @ B.T @ np.linalg.solve(np.eye(12) + B @ Q @ B.T, residuals[0])
    np.testing.assert_allclose(deviations(one, found), kriged, rtol=1e-9)


def test_heavy_tails_by_hand() -> None:
    """Student's density sample by sample, each of the degrees with the scale that is likeliest."""
    values = 1.7 * RNG.standard_t(3.0, 400)

    def cost(degrees: float, scale: float) -> float:
        constant = lgamma(0.5 * (degrees + 1.0)) - lgamma(0.5 * degrees) - 0.5 * log(pi * degrees) - log(scale)
        return -sum(constant - 0.5 * (degrees + 1.0) * log(1.0 + (v / scale) ** 2 / degrees) for v in values)

    best = []
    for degrees in DEGREES:
        least = minimize(lambda x, d=degrees: cost(d, exp(x[0])), [0.5], method="Nelder-Mead", options={"xatol": 1e-6})
        best.append((float(least.fun), degrees, exp(least.x[0])))
    unlikeliness, degrees, scale = min(best)
    found = student_noise(values)
    assert found.degrees == degrees
    assert found.scale == pytest.approx(scale, rel=2e-3)
    variance = sum(v * v for v in values) / 400
    normal = sum(0.5 * log(2.0 * pi * variance) + 0.5 * v * v / variance for v in values)
    assert found.gain == pytest.approx(normal - unlikeliness, abs=1e-3)


@pytest.mark.parametrize("with_tail", [False, True])
def test_a_spectrum_by_hand(with_tail: bool) -> None:
    """Σ log S + P/S over frequencies, and what is believed of noise and of a rest; its slope by differences."""
    frequency = np.linspace(0.5, 24.0, 60)
    power = RNG.uniform(0.2, 3.0, 60)
    seen = Spectrum(frequency, power, 2.0, 1e-3)
    filters = [LowPass(6.0, 0.02), LowPass(11.0, 0.02)]
    parts = Parts.of(seen, filters)
    x = np.array([[0.3, -3.0, 0.2, -1.0, -5.0, -2.0], [1.1, -2.2, 0.5, -0.4, -14.5, -1.0]])[:, : 6 if with_tail else 5]
    value, gradient, _ = parts.scored(x, np.array([1, 0]), with_tail=with_tail)
    for row, which in enumerate((1, 0)):

        def cost(p: np.ndarray, which: int = which) -> float:
            total = 0.0
            for k, f in enumerate(frequency * 0.02):
                passed = filters[which].power(np.array([frequency[k]]))[0]
                S = exp(p[0]) * exp(-((f / exp(p[1])) ** exp(p[2]))) + exp(p[3]) * passed + exp(p[4])
                if with_tail:
                    S += exp(p[5]) / (1.0 + (f / 0.02) ** 4) ** 2
                total += log(S) + power[k] / S
            total += 0.5 * ((p[3] - parts.usual[which]) / 2.0) ** 2
            return total + 0.5 * max(p[4] - parts.rounding, 0.0) ** 2

        assert value[row] == pytest.approx(cost(x[row]), rel=1e-10)
        for k in range(x.shape[1]):
            step = 1e-4 * np.eye(x.shape[1])[k]
            by = (cost(x[row] + step) - cost(x[row] - step)) / 2e-4
            assert gradient[row, k] == pytest.approx(by, rel=1e-5, abs=1e-9 * abs(float(value[row])))
