"""Noise of sensors and of measured inputs, as it is drawn and as its covariance is known.

Of sensors: coloured, falling with a power of the frequency, filtered, or with something beside it: hum of the mains, a
cable that is knocked, a zero that walks with the temperature of a room.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq
from scipy.linalg import toeplitz
from scipy.signal import butter, filtfilt, freqz, lfilter

USUAL = 6.0
"""Low-pass of measured inputs that most laboratories use [Hz]."""
LOWEST, HIGHEST = 3.0, 20.0
"""That others use [Hz]."""
OTHERS, NOBODY = 0.5, 0.1
"""Shares of others, and of recordings that nobody filtered."""
FAR_FROM_NYQUIST = 0.3
"""Highest corner as a share of the sampling frequency."""
ORDER = 2
"""Order of the low-pass that most use, which runs over the data forwards and backwards."""
LONG = 1024
"""Frequencies at which a spectrum is summed."""
SILENT = 1e-7
"""Share of the largest power below which a frequency is left out."""


@runtime_checkable
class SensorNoise(Protocol):
    """Noise of a sensor: its whole standard deviation, a realisation, and the covariance of `count` samples."""

    @property
    def sd(self) -> float:
        """In the channel's unit."""
        ...

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        ...

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Covariance of `count` samples in a row."""
        ...


@dataclass(frozen=True)
class Coloured:
    """Sum of two first-order autoregressive processes.

    `sd` is the whole standard deviation; `quick` the lag-one correlation of one part, `slow` [s] the correlation time
    of the other, which holds `share` of the variance.
    """

    sd: float
    quick: float
    slow: float
    share: float

    def parts(self, step: float) -> tuple[tuple[float, float], ...]:
        """(sd, lag-one correlation) of each part."""
        lasting = float(np.exp(-step / self.slow))
        return (self.sd * (1.0 - self.share) ** 0.5, self.quick), (self.sd * self.share**0.5, lasting)

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        total = np.zeros(count)
        for sd, rho in self.parts(step):
            white = rng.standard_normal(count) * sd * np.sqrt(1.0 - rho * rho)
            white[0] = rng.standard_normal() * sd
            total += lfilter([1.0], [1.0, -rho], white)
        return total

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Covariance of `count` samples in a row."""
        lag = np.arange(count)
        first = np.sum([sd * sd * rho**lag for sd, rho in self.parts(step)], axis=0)
        return np.asarray(toeplitz(first))


@dataclass(frozen=True)
class NoiseFilter:
    """Zero-lag Butterworth: corner [Hz], Nyquist's frequency or more where nobody filtered; order of either pass."""

    corner: float
    order: int = ORDER


def corner_of(rng: np.random.Generator, step: float) -> float:
    """A laboratory's low-pass of measured inputs [Hz]; Nyquist's frequency where nobody filtered."""
    other = np.exp(rng.uniform(np.log(LOWEST), np.log(min(HIGHEST, FAR_FROM_NYQUIST / step))))
    which = rng.random()
    if which < NOBODY:
        return 0.5 / step
    return float(other if which < NOBODY + OTHERS else USUAL)


def unfiltered(step: float, passed: NoiseFilter) -> bool:
    """Whether noise stayed white."""
    return passed.corner >= 0.5 / step


def smooth_noise(
    rng: np.random.Generator, sd: float, count: int, step: float, passed: NoiseFilter
) -> Float[np.ndarray, " s"]:
    """White noise through a zero-lag Butterworth low-pass, as motion data come; `sd` is that of the outcome."""
    if unfiltered(step, passed):
        return np.asarray(sd * rng.standard_normal(count))
    b, a = butter(passed.order, passed.corner, fs=1.0 / step)
    pad = int(1.0 / step)
    raw = filtfilt(b, a, rng.standard_normal(count + 2 * pad))[pad : pad + count]
    return np.asarray(raw * sd / np.sqrt(spectrum(step, passed)[1].sum()))


def spectrum(step: float, passed: NoiseFilter) -> tuple[Float[np.ndarray, " f"], Float[np.ndarray, " f"]]:
    """Angular frequencies [rad/s] and the power at each of unit white noise after the filter."""
    grid = (np.arange(LONG) + 0.5) * np.pi / LONG
    if unfiltered(step, passed):
        return grid / step, np.full(LONG, 1.0 / LONG)
    b, a = butter(passed.order, passed.corner, fs=1.0 / step)
    _, response = freqz(b, a, worN=grid)
    return grid / step, np.abs(response) ** 4 / LONG


def smooth_covariance(sd: float, count: int, step: float, passed: NoiseFilter) -> tuple[Float[np.ndarray, "s s"], ...]:
    """Covariance of such noise with itself, of the noise with its rate, and of the rate with itself."""
    place, cross, rate = unit_covariance(count, step, passed)
    return sd * sd * place, sd * sd * cross, sd * sd * rate


@functools.lru_cache(maxsize=16)
def unit_covariance(count: int, step: float, passed: NoiseFilter) -> tuple[Float[np.ndarray, "s s"], ...]:
    """The same for a standard deviation of 1; rates are those of a cubic spline through the samples.

    A sine of the angular frequency w then has 3 sin(w h)/(h (2 + cos(w h))) for w, h the time between two samples.
    """
    omega, weight = spectrum(step, passed)
    weight = weight / weight.sum()
    heard = weight > SILENT * weight.max()
    omega, weight = omega[heard], weight[heard]
    angle = np.outer(np.arange(count) * step, omega)
    cosine = np.cos(angle)
    slope = 3.0 * np.sin(omega * step) / (step * (2.0 + np.cos(omega * step)))
    with_rate = np.sin(angle) @ (weight * slope)  # cov(q(t), q'(s)) = sum w slope sin(omega (t - s))
    return toeplitz(cosine @ weight), toeplitz(with_rate, -with_rate), toeplitz(cosine @ (weight * slope**2))


@dataclass(frozen=True)
class PowerLawNoise:
    """Power white + (1 - white) (1 + (f longest)²)^(-exponent/2), scaled to `sd`; nearly 1/f for an exponent of 1.

    Parameters
    ----------
    sd
        Whole standard deviation.
    exponent
        0: white.
    longest
        Time beyond which it is even again [s].
    white
        Share of the variance.
    freedom
        Degrees of freedom of Student's distribution of what is filtered, above 2; infinite: normal.
    """

    sd: float
    exponent: float = 0.0
    longest: float = 1.0
    white: float = 0.0
    freedom: float = np.inf

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        length, power = self._power(count, step)
        raw = rng.standard_normal(length)
        if np.isfinite(self.freedom):
            raw = rng.standard_t(self.freedom, length) * np.sqrt(1.0 - 2.0 / self.freedom)
        return np.asarray(self.sd * irfft(rfft(raw) * np.sqrt(power), length)[:count])

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Covariance of `count` samples in a row."""
        length, power = self._power(count, step)
        return np.asarray(toeplitz(self.sd**2 * irfft(power, length)[:count]))

    def _power(self, count: int, step: float) -> tuple[int, Float[np.ndarray, " f"]]:
        """Length of a period that is long enough, and the power at its frequencies; 1 on average over both sides."""
        length = next_fast_len(2 * (count + int(self.longest / step)), real=True)
        falling = (1.0 + (rfftfreq(length, step) * self.longest) ** 2) ** (-0.5 * self.exponent)
        mean = irfft(falling, length)[0]
        return length, self.white + (1.0 - self.white) * falling / mean


@dataclass(frozen=True)
class FilteredNoise:
    """White noise that came through a filter of the measuring chain, above a white floor.

    Parameters
    ----------
    sd
        Whole standard deviation.
    passed
        The filter.
    white
        Share of the variance that was added after it.
    """

    sd: float
    passed: NoiseFilter
    white: float = 0.1

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        smooth = smooth_noise(rng, self.sd * np.sqrt(1.0 - self.white), count, step, self.passed)
        return np.asarray(smooth + self.sd * np.sqrt(self.white) * rng.standard_normal(count))

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Covariance of `count` samples in a row."""
        smooth = smooth_covariance(self.sd * np.sqrt(1.0 - self.white), count, step, self.passed)[0]
        return np.asarray(smooth + self.white * self.sd**2 * np.eye(count))


@dataclass(frozen=True)
class Humming:
    """Hum of the mains beside other noise, of another phase in every trial; sampled as it is, so that it may fold.

    Parameters
    ----------
    beside
        The other noise.
    hum
        Root mean square of the hum.
    frequency
        Of the mains [Hz].
    third
        Root mean square of its third harmonic, whose phase follows that of the hum.
    """

    beside: SensorNoise
    hum: float
    frequency: float
    third: float = 0.0

    @property
    def sd(self) -> float:
        """Standard deviation of all together."""
        return float(np.hypot(np.hypot(self.beside.sd, self.hum), self.third))

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        angle = 2.0 * np.pi * self.frequency * step * np.arange(count) + rng.uniform(0.0, 2.0 * np.pi)
        noise = self.beside.draw(rng, count, step) + np.sqrt(2.0) * self.hum * np.sin(angle)
        return np.asarray(noise + np.sqrt(2.0) * self.third * np.sin(3.0 * angle) if self.third else noise)

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Covariance of `count` samples in a row, over all phases."""
        angle = 2.0 * np.pi * self.frequency * step * np.arange(count)
        along = self.hum**2 * np.cos(angle) + self.third**2 * np.cos(3.0 * angle)
        return np.asarray(self.beside.covariance(count, step) + toeplitz(along))


@dataclass(frozen=True)
class Knocked:
    """A cable that is knocked now and then: a short ringing beside other noise, at a moment of its own in every trial.

    Parameters
    ----------
    beside
        The other noise.
    height
        Largest value of a knock, in standard deviations of the other noise.
    decay, frequency
        Time in which it falls to 1/e [s]; of its ringing [Hz].
    chance
        Of a knock in a trial.
    """

    beside: SensorNoise
    height: float
    decay: float
    frequency: float
    chance: float

    @property
    def sd(self) -> float:
        """Standard deviation of the other noise: most trials have no more."""
        return self.beside.sd

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        noise = self.beside.draw(rng, count, step)
        begin, sign, knocked = rng.uniform(0.0, count * step), rng.choice([-1.0, 1.0]), rng.random() < self.chance
        return noise + sign * self._shape(np.arange(count) * step - begin) if knocked else noise

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Covariance of `count` samples in a row, over all moments: that of shot noise as rare as this."""
        shape = self._shape((np.arange(count) + 0.5) * step)
        along = np.correlate(shape, shape, "full")[count - 1 :] * self.chance / count
        return np.asarray(self.beside.covariance(count, step) + toeplitz(along))

    def _shape(self, since: Float[np.ndarray, " s"]) -> Float[np.ndarray, " s"]:
        inside = np.maximum(since, 0.0)
        ringing = np.exp(-inside / self.decay) * np.cos(2.0 * np.pi * self.frequency * inside)
        return np.where(since >= 0.0, self.height * self.beside.sd * ringing, 0.0)


@dataclass(frozen=True)
class Wandering:
    """A sensor is set to zero before a trial and walks from there, another way in every trial.

    Parameters
    ----------
    beside
        The other noise.
    walk
        Standard deviation of the walk after one second; it grows with the root of time.
    """

    beside: SensorNoise
    walk: float

    @property
    def sd(self) -> float:
        """Standard deviation of the other noise, which is all that there is at the start."""
        return self.beside.sd

    def draw(self, rng: np.random.Generator, count: int, step: float) -> Float[np.ndarray, " s"]:
        """One realisation."""
        noise = self.beside.draw(rng, count, step)
        by = self.walk * np.sqrt(step) * rng.standard_normal(count - 1)
        return np.asarray(noise + np.concatenate([[0.0], np.cumsum(by)]))

    def covariance(self, count: int, step: float) -> Float[np.ndarray, "s s"]:
        """Covariance of the first `count` samples of a trial: that of a walk is the time of the earlier one."""
        time = step * np.arange(count)
        return np.asarray(self.beside.covariance(count, step) + self.walk**2 * np.minimum(time[:, None], time))
