"""The low-pass filters that the inputs of a case came through, read off their spectra.

Motion is slow; above its own frequencies a recording holds noise up to the corner of the filter and little beyond it.
The spectrum of every input is taken for a movement that falls off with frequency, noise as the filter leaves it
(`identify.low_pass`) and a white rest (rounding), S = A exp(-(f/b)^q) + N H²(f; f_c) + R, fitted by Whittle's
likelihood (Whittle 1953, J. R. Stat. Soc. B 15:125) with one f_c for all inputs that were filtered. Noise much louder
or quieter than usual is believed less, and so are corners far from 6 Hz: where the movement hides the noise, f_c stays
near that. A rest that is louder than rounding is believed less as well, so that noise which nobody filtered is not
taken for it. Usually all inputs were filtered, or none; that some were and others not is believed least.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.trial import Trial
from geocontact.gap.grids import even_grid
from geocontact.gap.resolution import resolution
from geocontact.identify.low_pass import BELOW_NYQUIST, LowPass

USUAL, USUALLY = 6.0, 0.6  # Hz, and the standard deviation of its logarithm (Winter 2009, ch. 3: 4 to 8 Hz in gait)
LOWEST, HIGHEST, CORNERS = 2.5, 40.0, 17  # Hz, that are compared, and how many
LEVEL, LOUDER = 2e-3, 2.0  # usual noise of an input in half-ranges, and standard deviation of its power's logarithm
ROUNDED = 1e-5  # of a half-range, up to which a white rest is rounding at any rate: five digits
UNFILTERED, MIXED = 4.0, 12.0  # nats that must speak for no filter: of any input, of some and not of others
TREND = 3  # degree of the polynomial that is taken off before the window
APART = 3  # bins from which spectral values under the window count as independent
FEWEST = 24  # samples of a trial that has a spectrum
BOTH = 2  # values of an input that goes on and off
FLATTEST, STEEPEST = np.log([0.7, 3.0])  # bounds of log q


@dataclass(frozen=True)
class Spectrum:
    """Power of one input over all trials: of unit variance for white noise of unit variance.

    Parameters
    ----------
    frequency
        Of each value [Hz].
    power
        In the input's unit squared.
    half_range
        Of the input, in its unit.
    rounding
        Standard deviation of what rounding adds at the most, in its unit.
    """

    frequency: Float[np.ndarray, " f"]
    power: Float[np.ndarray, " f"]
    half_range: float
    rounding: float


def filters_of(trials: Sequence[Trial], inputs: Sequence[str]) -> Mapping[str, LowPass]:
    """The filter, if any, of each input that makes the spectra most likely; the usual one without spectra."""
    step = float(np.median(np.concatenate([np.diff(trial.time) for trial in trials])))
    corners = np.geomspace(LOWEST, HIGHEST, CORNERS)
    corners = corners[corners < BELOW_NYQUIST * 0.5 / step]
    found = {name: spectrum(trials, name) for name in inputs}
    seen = {name: each for name, each in found.items() if each is not None}
    if not seen or not len(corners):
        return dict.fromkeys(inputs, LowPass(USUAL, step))
    through = np.array([[split(each, LowPass(f, step)).unlikely for f in corners] for each in seen.values()])
    free = np.array([split(each, LowPass.none(step)).unlikely for each in seen.values()])
    far = 0.5 * (np.log(corners / USUAL) / USUALLY) ** 2
    everyone, each = far + through.sum(axis=0), far + np.minimum(through, free[:, None]).sum(axis=0) + MIXED
    if free.sum() + UNFILTERED < min(everyone.min(), each.min()):
        return dict.fromkeys(inputs, LowPass.none(step))
    raw = (free < through[:, np.argmin(each)]) & (each.min() < everyone.min())
    differ = {name: LowPass.none(step) for name, own in zip(seen, raw, strict=True) if own}
    return dict.fromkeys(inputs, LowPass(_between(np.log(corners), far + through[~raw].sum(axis=0)), step)) | differ


def _between(at: Float[np.ndarray, " n"], costs: Float[np.ndarray, " n"]) -> float:
    """Where a parabola through the least value and its neighbours is least."""
    k = int(np.argmin(costs))
    if not 0 < k < len(costs) - 1:
        return float(np.exp(at[k]))
    left, middle, right = costs[k - 1 : k + 2]
    bend = left - 2.0 * middle + right
    return float(np.exp(at[k] + 0.5 * (left - right) / max(bend, 1e-12) * (at[k + 1] - at[k])))


def switches(trials: Sequence[Trial], name: str) -> bool:
    """Whether an input only goes on and off, or stands still: then it is no measurement, and has no noise."""
    values = np.concatenate([trial.column(name) for trial in trials])
    return len(np.unique(values[np.isfinite(values)])) <= BOTH


def spectrum(trials: Sequence[Trial], name: str) -> Spectrum | None:
    """Periodograms under Nuttall's window, of all trials long enough.

    None where there are none, where nothing moves, and of an input that only goes on and off.
    """
    from scipy.interpolate import CubicSpline
    from scipy.signal.windows import nuttall

    frequency, power, values = [], [], []
    if switches(trials, name):
        return None
    for trial in trials:
        column = trial.column(name)
        there = np.isfinite(column)
        if there.sum() < FEWEST:
            continue
        grid = even_grid(trial.time[there])
        even = CubicSpline(trial.time[there], column[there])(grid)
        u = np.linspace(-1.0, 1.0, len(grid))
        window = nuttall(len(grid))
        bent = even - np.polynomial.legendre.legval(u, np.polynomial.legendre.legfit(u, even, TREND))
        frequency.append(np.fft.rfftfreq(len(grid), grid[1] - grid[0])[APART:-1:APART])
        power.append((np.abs(np.fft.rfft(bent * window)) ** 2 / (window**2).sum())[APART:-1:APART])
        values.append(column[there])
    if not values or not np.ptp(np.concatenate(values)) > 0.0:
        return None
    half_range = 0.5 * float(np.ptp(np.concatenate(values)))
    least = (1e-12 * half_range) ** 2
    rounding = max(resolution(values) / np.sqrt(12.0), ROUNDED * half_range)
    return Spectrum(np.concatenate(frequency), np.concatenate(power) + least, half_range, rounding)


@dataclass(frozen=True)
class Split:
    """A spectrum taken apart: Whittle's -log likelihood with what was believed, and the noise after the filter.

    `noise` is its standard deviation, in the input's unit.
    """

    unlikely: float
    noise: float


def likely_noise(trials: Sequence[Trial], name: str, passed: LowPass) -> float:
    """Standard deviation of an input's noise by its spectrum, 0 where it has none."""
    seen = spectrum(trials, name)
    return 0.0 if seen is None else split(seen, passed).noise


def split(seen: Spectrum, through: LowPass) -> Split:
    """The likeliest movement, noise and rest of a spectrum, given the filter."""
    from scipy.optimize import minimize

    below = seen.frequency < 0.5 / through.step  # a quicker recording than the others goes beyond
    f, p = seen.frequency[below], seen.power[below]
    passed = through.power(f)
    part = float(through.power(np.linspace(0.0, 0.5 / through.step, 400)).mean())  # of white noise, let through
    usual = 2.0 * np.log(LEVEL * seen.half_range) - np.log(part)
    rounding = 2.0 * np.log(seen.rounding)
    top, (bottom, middle) = float(np.log(p.max())), np.log(np.quantile(p, [0.05, 0.3]))

    def cost(x: Float[np.ndarray, " 5"]) -> tuple[float, Float[np.ndarray, " 5"]]:
        ratio = np.log(f) - x[1]
        steep = np.exp(x[4])
        fall = np.minimum(np.exp(steep * ratio), 600.0)
        movement, noise, rest = np.exp(x[0] - fall), np.exp(x[2]) * passed, np.exp(x[3])
        total = movement + noise + rest
        pull = (1.0 - p / total) / total
        off, over = (x[2] - usual) / LOUDER, max(x[3] - rounding, 0.0) / LOUDER
        slope = [
            (pull * movement).sum(),
            (pull * movement * fall).sum() * steep,
            (pull * noise).sum() + off / LOUDER,
            pull.sum() * rest + over / LOUDER,
            -(pull * movement * fall * ratio).sum() * steep,
        ]
        return float((np.log(total) + p / total).sum() + 0.5 * (off**2 + over**2)), np.array(slope)

    low = np.array([top - 20.0, np.log(0.02), top - 60.0, top - 80.0, FLATTEST])
    high = np.array([top + 40.0, np.log(20.0), top + 2.0, top, STEEPEST])
    starts = [[top, np.log(b), n, bottom - 1.0, 0.2] for b in (0.3, 1.5) for n in (usual, middle)]
    bounds = list(zip(low, high, strict=True))
    best = min(
        (minimize(cost, np.clip(s, low, high), jac=True, method="L-BFGS-B", bounds=bounds) for s in starts),
        key=lambda found: float(found.fun),
    )
    return Split(float(best.fun), float(np.sqrt(np.exp(best.x[2]) * part)))
