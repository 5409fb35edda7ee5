"""A spectrum of a measured input taken apart: movement, noise as a filter leaves it, a white rest.

S = A exp(-(f/b)^q) + B/(1 + (f/f_t)^4)² + N H²(f) + R, by Whittle's likelihood (Whittle 1953, J. R. Stat. Soc.
B 15:125). The first term is a movement that falls off with frequency. The second, for which TAILED nats must speak, is
the tail of one that is put together of pieces: where its third derivative jumps, the power falls off with the eighth
power of the frequency (Bracewell, The Fourier Transform and Its Applications, 2000, ch. 8). H² is the filter
(`identify.low_pass`), R rounding. Noise much louder or quieter than usual is believed less, and so is a rest that is
louder than rounding, so that noise which nobody filtered is not taken for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.gap.input_spectrum import Spectrum
from geocontact.identify.fisher_scoring import Batch, Scored, least
from geocontact.identify.low_pass import LowPass

LEVEL, LOUDER = 2e-3, 2.0  # usual noise of an input in half-ranges, and standard deviation of its power's logarithm
OVER = 1.0  # standard deviation of the logarithm of a rest's power beyond rounding
TAIL = 2.0  # Hz, from which a movement's tail falls off
TAILED = 3.0  # nats that must speak for it
FLATTEST, STEEPEST = np.log([0.7, 3.0])  # bounds of log q
SLOWEST, QUICKEST = np.log([0.02, 20.0])  # of log b
FALLS, STEEPS = (0.1, 0.4, 1.2, 3.0), (0.9, 1.6)  # b [Hz] and q that a search starts from
FIRST, BEST = 40, 4  # steps from all starts, and how many of them, for each filter, go on
FAINT = 600.0  # exponent beyond which a movement is nothing
BENT = 1e6  # ratio of power to what is expected that counts in the curvature at the most


@dataclass(frozen=True)
class Split:
    """For each filter: Whittle's -log likelihood with what was believed, and the noise after the filter.

    `noise` is its standard deviation, in the input's unit.
    """

    unlikely: Float[np.ndarray, " k"]
    noise: Float[np.ndarray, " k"]


def split(seen: Spectrum, filters: Sequence[LowPass]) -> Split:
    """The likeliest movement, noise and rest of a spectrum, given each of the filters, of one sampling frequency."""
    seen = seen.below(0.5 / filters[0].step)  # a quicker recording than the others goes beyond
    parts = Parts.of(seen, filters)
    plain, tailed = (_likeliest(parts, with_tail) for with_tail in (False, True))
    with_tail = tailed.unlikely + TAILED < plain.unlikely
    return Split(
        np.where(with_tail, tailed.unlikely + TAILED, plain.unlikely), np.where(with_tail, tailed.noise, plain.noise)
    )


@dataclass(frozen=True)
class Parts:
    """Everything of which likelihoods are made.

    Parameters
    ----------
    frequency, power
        Of the spectrum.
    passed
        Share of the power that each filter lets through at each frequency.
    part
        That each filter lets through of white noise.
    usual
        Logarithm of the power that noise before each filter is believed to have.
    rounding
        Logarithm of the power of rounding.
    """

    frequency: Float[np.ndarray, " f"]
    power: Float[np.ndarray, " f"]
    passed: Float[np.ndarray, "k f"]
    part: Float[np.ndarray, " k"]
    usual: Float[np.ndarray, " k"]
    rounding: float

    @classmethod
    def of(cls, seen: Spectrum, filters: Sequence[LowPass]) -> Parts:
        """Of a spectrum below Nyquist's frequency."""
        even = np.linspace(0.0, 0.5 / filters[0].step, 400)
        part = np.array([one.power(even).mean() for one in filters])
        passed = np.array([one.power(seen.frequency) for one in filters])
        usual = 2.0 * np.log(LEVEL * seen.half_range) - np.log(part)
        return cls(seen.frequency, seen.power, passed, part, usual, 2.0 * float(np.log(seen.rounding)))

    def scored(self, x: Batch, which: Int[np.ndarray, " b"]) -> Scored:
        """-log likelihoods with their gradients and expected curvatures.

        Parameters
        ----------
        x
            Rows of log A, log b, log q, log N, log R and, if there is a tail, log B.
        which
            Filter of each row.
        """
        ratio, steep = np.log(self.frequency) - x[:, 1:2], np.exp(x[:, 2:3])
        fall = np.minimum(np.exp(steep * ratio), FAINT)
        movement = np.exp(x[:, 0:1] - fall)
        noise, rest = np.exp(x[:, 3:4]) * self.passed[which], np.exp(x[:, 4:5]) * np.ones_like(self.frequency)
        tail = np.exp(x[:, 5:]) / (1.0 + (self.frequency / TAIL) ** 4) ** 2 if x.shape[1] > 5 else 0.0
        total = movement + noise + rest + tail
        slopes = [movement, movement * fall * steep, -movement * fall * steep * ratio, noise, rest]
        slope = np.stack([*slopes, tail] if x.shape[1] > 5 else slopes, axis=1) / total[:, None]
        met = self.power / total
        gradient = (slope * (1.0 - met)[:, None]).sum(axis=2)
        # half of what is expected, half of what is met: far off, steps stay short
        curved = (slope * 0.5 * (1.0 + np.minimum(met, BENT))[:, None]) @ slope.transpose(0, 2, 1)
        off, over = (x[:, 3] - self.usual[which]) / LOUDER, np.maximum(x[:, 4] - self.rounding, 0.0) / OVER
        gradient[:, 3] += off / LOUDER
        gradient[:, 4] += over / OVER
        curved[:, 3, 3] += LOUDER**-2
        curved[:, 4, 4] += (over > 0.0) * OVER**-2
        return (np.log(total) + met).sum(axis=1) + 0.5 * (off**2 + over**2), gradient, curved


def _likeliest(parts: Parts, with_tail: bool) -> Split:
    """Of all starts, for each filter."""
    top = float(np.log(parts.power.max()))
    low = np.array([top - 20.0, SLOWEST, FLATTEST, top - 60.0, top - 80.0, top - 60.0])
    high = np.array([top + 40.0, QUICKEST, STEEPEST, top + 2.0, top, top + 20.0])
    start, which = _starts(parts)
    chosen = slice(6 if with_tail else 5)
    low, high, start = low[chosen], high[chosen], start[:, chosen]
    first = least(lambda x, rows: parts.scored(x, which[rows]), start, low, high, FIRST)
    best = np.concatenate([_least_few(first.value, which == k) for k in range(len(parts.part))])
    found = least(lambda x, rows: parts.scored(x, which[best][rows]), first.at[best], low, high)
    value, noise = (each.reshape(len(parts.part), -1) for each in (found.value, found.at[:, 3]))
    k = np.arange(len(parts.part)), value.argmin(axis=1)
    return Split(value[k], np.sqrt(np.exp(noise[k]) * parts.part))


def _least_few(value: Float[np.ndarray, " s"], there: Bool[np.ndarray, " s"]) -> Int[np.ndarray, " b"]:
    """Places of the least values among those that are there."""
    places = np.flatnonzero(there)
    return np.asarray(places[np.argsort(value[places], kind="stable")[:BEST]])


def _starts(parts: Parts) -> tuple[Batch, Int[np.ndarray, " s"]]:
    """Parameters to start from, tail and all, and the filter of each."""
    slow = np.argsort(parts.frequency)[: max(4, len(parts.frequency) // 20)]
    top = float(np.log(parts.power.max()))
    bottom, middle = np.log(np.quantile(parts.power, [0.05, 0.3]))
    rows, which = [], []
    for (k, usual), b, q in product(enumerate(parts.usual), FALLS, STEEPS):
        fall = np.minimum((parts.frequency[slow] / b) ** q, 30.0)
        height = float(np.median(np.log(parts.power[slow]) + fall))
        for noise in (usual, middle):
            rows.append([height, np.log(b), np.log(q), noise, bottom - 1.0, top - 6.0])
            which.append(k)
    return np.array(rows), np.array(which)
