"""Noise with a memory: first-order autoregressive per channel, for samples that need not be equally spaced."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

SHORTEST, LONGEST = 0.02, 200.0  # usual steps; a correlation time is looked for between them


@dataclass(frozen=True)
class AutoregressiveNoise:
    """Stationary noise of each channel: standard deviation and correlation time.

    The correlation of two samples a time h apart is exp(-h / tau): the Ornstein-Uhlenbeck process, which on equally
    spaced samples is AR(1) with the coefficient exp(-step / tau).

    Parameters
    ----------
    sd
        Standard deviation of each channel, in the channel's unit.
    tau
        Correlation time of each channel [s]; 0 for white noise.
    """

    sd: Float[np.ndarray, " c"]
    tau: Float[np.ndarray, " c"]

    def whitened(self, time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t c p"]) -> Float[np.ndarray, "n p"]:
        """Innovations divided by their standard deviation, channels one after another, missing samples left out.

        The columns p (residual, derivatives of it) go through the same filter; a sample is missing when its first
        column is NaN, and the next innovation then spans the gap.
        """
        rows = []
        for c in range(values.shape[1]):
            there = np.isfinite(values[:, c, 0])
            rows.append(_innovations(time[there], values[there, c], self.sd[c], self.tau[c]))
        return np.concatenate(rows)

    def log_scale(self, time: Float[np.ndarray, " t"], present: Float[np.ndarray, "t c"]) -> float:
        """Sum of the logarithms of the innovations' standard deviations, over samples where `present` is finite."""
        total = 0.0
        for c in range(present.shape[1]):
            h = np.diff(time[np.isfinite(present[:, c])])
            total += (len(h) + 1) * np.log(self.sd[c]) + 0.5 * float(np.log(_new_share(h, self.tau[c])).sum())
        return total


def _innovations(
    time: Float[np.ndarray, " n"], values: Float[np.ndarray, "n p"], sd: float, tau: float
) -> Float[np.ndarray, "n p"]:
    out = values / sd
    if len(time) > 1 and tau > 0.0:
        h = np.diff(time)
        out[1:] = (out[1:] - np.exp(-h / tau)[:, None] * out[:-1]) / np.sqrt(_new_share(h, tau))[:, None]
    return np.asarray(out)


def _new_share(h: Float[np.ndarray, " n"], tau: float) -> Float[np.ndarray, " n"]:
    """Variance of what is new after a time h, as a share of the whole: 1 - exp(-2 h / tau)."""
    return np.asarray(-np.expm1(-2.0 * h / tau)) if tau > 0.0 else np.ones_like(h)


def noise_of(times: list[Float[np.ndarray, " _"]], residuals: list[Float[np.ndarray, "_ c"]]) -> AutoregressiveNoise:
    """Noise that makes these residuals most likely, channel by channel over all trials.

    The standard deviation follows from the correlation time in closed form, the correlation time from a bounded
    one-dimensional search on its logarithm. Channels without residual get the smallest positive number as sd.
    """
    from scipy.optimize import minimize_scalar

    channels = residuals[0].shape[1]
    sd, tau = np.empty(channels), np.empty(channels)
    for c in range(channels):
        series = [(t[m], r[m, c]) for t, r in zip(times, residuals, strict=True) if (m := np.isfinite(r[:, c])).any()]
        step = float(np.median(np.concatenate([np.diff(t) for t, _ in series])))

        def cost(log_tau: float, series: list[tuple[np.ndarray, np.ndarray]] = series) -> float:
            return _profile(series, np.exp(log_tau))[0]

        found = minimize_scalar(cost, bounds=(np.log(SHORTEST * step), np.log(LONGEST * step)), method="bounded")
        tau[c] = np.exp(found.x)
        sd[c] = _profile(series, tau[c])[1]
    return AutoregressiveNoise(np.maximum(sd, np.finfo(float).tiny), tau)


def _profile(series: list[tuple[np.ndarray, np.ndarray]], tau: float) -> tuple[float, float]:
    """Twice the negative log likelihood per sample at the best sd, and that sd."""
    squares, logs, count = 0.0, 0.0, 0
    for time, values in series:
        squares += float((_innovations(time, values[:, None], 1.0, tau) ** 2).sum())
        logs += float(np.log(_new_share(np.diff(time), tau)).sum())
        count += len(time)
    variance = max(squares / count, np.finfo(float).tiny)
    return float(np.log(variance) + logs / count), float(np.sqrt(variance))
