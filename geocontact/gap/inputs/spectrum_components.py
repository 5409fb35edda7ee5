"""A spectrum of a measured input taken apart: movement, noise as a filter leaves it, a white rest.

S = A exp(-(f/b)^q) + B/(1 + (f/f_t)^4)² + N H²(f) + R, by Whittle's likelihood (Whittle 1953, J. R. Stat. Soc.
B 15:125). The first term is a movement that falls off with frequency. The second, for which half of SURE nats must
speak, is the tail of one that is put together of pieces: where its third derivative jumps, the power falls off with the
eighth power of the frequency (Bracewell, The Fourier Transform and Its Applications, 2000, ch. 8). H² is the filter
(`identify.signals.low_pass`), R rounding. Noise much higher or lower than usual is less probable, and so is a rest that
is higher than rounding, so that noise which nobody filtered is not taken for it.

Motion is slow; above its own frequencies a recording holds noise up to the corner of the filter and little beyond it.
The spectrum of every input is taken apart into movement, noise and a white rest (`gap/inputs/spectrum_components.py`),
with one f_c for all inputs that were filtered. Frequencies are in cycles per sample: 6 Hz of motion capture at 100 Hz
are 0.06. Corners far from the usual one are less probable: where the movement hides the noise, f_c stays near that.
Usually all inputs were filtered, or none; that some were and others not is least probable.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from math import exp, log

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.trial import Trial
from geocontact.gap.inputs.spectrum import Spectrum, spectrum
from geocontact.gap.levels import FEW, FEWEST, INPUT_NOISE, LEADING, SURE
from geocontact.geometry.kernels.compile import kernel
from geocontact.identify.noise.input_noise import FREQUENCIES
from geocontact.identify.optimise.bounded_gauss_newton import CLOSE, LIMIT
from geocontact.identify.optimise.fisher_scoring import Batch, Scored, least
from geocontact.identify.signals.low_pass import BELOW_NYQUIST, LowPass

USUAL, USUALLY = 0.08, 0.9  # per sample, and the standard deviation of its logarithm: 6 Hz at 75 (Winter 2009)
CORNERS = 21  # that are compared, from one as far below the usual one as the highest that can be identified is above it
UNFILTERED = 4.0  # nats that must speak for no filter of any input


def filters_of(trials: Sequence[Trial], inputs: Sequence[str]) -> Mapping[str, LowPass]:
    """The filter, if any, of each input that makes the spectra most likely; the usual one without spectra."""
    step = float(np.median(np.concatenate([np.diff(trial.time) for trial in trials])))
    highest = 0.5 * BELOW_NYQUIST
    corners = np.geomspace(USUAL**2 / highest, highest, CORNERS) / step
    found = {name: spectrum(trials, name, step) for name in inputs}
    seen = {name: each for name, each in found.items() if each is not None}
    if not seen:
        return dict.fromkeys(inputs, LowPass(USUAL / step, step))
    filters = [*(LowPass(f, step) for f in corners), LowPass.none(step)]
    costs = np.array([split(each, filters).unlikely for each in seen.values()])
    through, free = costs[:, :-1], costs[:, -1]
    far = 0.5 * (np.log(corners * step / USUAL) / USUALLY) ** 2
    everyone, each = far + through.sum(axis=0), far + np.minimum(through, free[:, None]).sum(axis=0) + 2.0 * SURE
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


def likely_noise(trials: Sequence[Trial], name: str, passed: LowPass) -> float:
    """Standard deviation of an input's noise by its spectrum, 0 where it has none."""
    seen = spectrum(trials, name, passed.step)
    return 0.0 if seen is None else float(split(seen, [passed]).noise[0])


LOUDER = 2.0  # standard deviation of the logarithm of the power of an input's noise; one of that of a rest
TAIL = 0.02  # cycles per sample, from which a movement's tail falls off
FLATTEST, STEEPEST = np.log([0.7, 3.0])  # bounds of log q
SLOWEST, BROADEST = np.log([1e-4, 0.2])  # bounds of log b: what is as high at the end of a spectrum is noise
FALLS, STEEPS = (0.001, 0.004, 0.012, 0.03, 0.08), (0.9, 1.6)  # b, per sample, and q that a search starts from
BROAD = ((0.08, 0.7), (float(np.exp(BROADEST)), 0.7))  # the same of broad movements
NOTHING = -2.0 * float(np.log(np.finfo(float).eps))  # nats below the top at which there is none; a bound of exponents


@dataclass(frozen=True)
class Split:
    """For each filter: Whittle's -log likelihood with the prior, and the noise after the filter.

    `noise` is its standard deviation, in the input's unit.
    """

    unlikely: Float[np.ndarray, " k"]
    noise: Float[np.ndarray, " k"]


def split(seen: Spectrum, filters: Sequence[LowPass]) -> Split:
    """The likeliest movement, noise and rest of a spectrum, given each of the filters, one at least.

    The filters are of one sampling frequency, and the spectrum lies below half of it.
    """
    parts = Parts.of(seen, filters)
    plain, tailed = (_likeliest(parts, with_tail) for with_tail in (False, True))
    better = tailed.unlikely + 0.5 * SURE < plain.unlikely
    return Split(
        np.where(better, tailed.unlikely + 0.5 * SURE, plain.unlikely), np.where(better, tailed.noise, plain.noise)
    )


@dataclass(frozen=True)
class Parts:
    """Everything of which likelihoods are made.

    Parameters
    ----------
    frequency, power, count
        Of the spectrum, frequencies in cycles per sample: its values, or means of neighbours and how many of them.
    passed
        Share of the power that each filter lets through at each frequency.
    part
        That each filter lets through of white noise.
    usual
        Logarithm of the prior power of the noise before each filter.
    rounding
        Logarithm of the power of rounding.
    """

    frequency: Float[np.ndarray, " f"]
    power: Float[np.ndarray, " f"]
    count: Float[np.ndarray, " f"]
    passed: Float[np.ndarray, "k f"]
    part: Float[np.ndarray, " k"]
    usual: Float[np.ndarray, " k"]
    rounding: float

    @classmethod
    def of(cls, seen: Spectrum, filters: Sequence[LowPass]) -> Parts:
        """Values of a spectrum below Nyquist's frequency."""
        frequency, power, count = _pooled(seen)
        even = np.linspace(0.0, 0.5 / filters[0].step, FREQUENCIES)
        part = np.array([one.power(even).mean() for one in filters])
        passed = np.array([one.power(frequency) for one in filters])
        usual = 2.0 * np.log(INPUT_NOISE * seen.half_range) - np.log(part)
        return cls(frequency * filters[0].step, power, count, passed, part, usual, 2.0 * float(np.log(seen.rounding)))

    def scored(self, x: Batch, which: Int[np.ndarray, " b"], *, with_tail: bool) -> Scored:
        """-log likelihoods with their gradients, and curvatures to step by.

        Curvatures are half of what is expected, half of what the powers that are met would make of it: far off, where
        powers are much larger than expected, steps stay short.

        Parameters
        ----------
        x
            Rows of log A, log b, log q, log N, log R and, with a tail, log B.
        which
            Filter of each row.
        """
        tail = self._tail if with_tail else self._tail[:0]
        arrays = (np.log(self.frequency), self.power, self.count, tail, self.passed)
        value, gradient, curved = whittle(*arrays, x, which)
        off, over = (x[:, 3] - self.usual[which]) / LOUDER, np.maximum(x[:, 4] - self.rounding, 0.0)
        gradient[:, 3] += off / LOUDER
        gradient[:, 4] += over
        curved[:, 3, 3] += LOUDER**-2
        curved[:, 4, 4] += over > 0.0
        return value + 0.5 * (off**2 + over**2), gradient, curved

    @cached_property
    def _tail(self) -> Float[np.ndarray, " f"]:
        """Share of a movement's tail, its power over that at low frequencies."""
        return (1.0 + (self.frequency / TAIL) ** 4) ** -2.0


@kernel
def whittle(
    logarithm: Float[np.ndarray, " f"],
    power: Float[np.ndarray, " f"],
    count: Float[np.ndarray, " f"],
    tail: Float[np.ndarray, " f"],
    passed: Float[np.ndarray, "k f"],
    x: Batch,
    which: Int[np.ndarray, " b"],
) -> Scored:
    """Whittle's -log likelihood of each row of parameters, its gradient, and the curvature that `Parts.scored` tells.

    `logarithm` is that of the frequencies; `tail` is empty where there is none.
    """
    size = x.shape[1]
    value, gradient, curved = np.zeros(len(x)), np.zeros((len(x), size)), np.zeros((len(x), size, size))
    slope = np.empty(size)
    for row in range(len(x)):
        steep, noise, rest = exp(x[row, 2]), exp(x[row, 3]), exp(x[row, 4])
        high = exp(x[row, 5]) if tail.size else 0.0
        for f in range(power.size):
            ratio = logarithm[f] - x[row, 1]
            fall = exp(min(steep * ratio, NOTHING))
            movement = exp(x[row, 0] - fall)
            bend = movement * fall * steep
            slope[0], slope[1], slope[2] = movement, bend, -bend * ratio
            slope[3], slope[4] = noise * passed[which[row], f], rest
            total = movement + slope[3] + rest
            if tail.size:
                slope[5] = high * tail[f]
                total += slope[5]
            met = power[f] / total
            value[row] += count[f] * (log(total) + met)
            pull = count[f] * (1.0 - met) / total
            weight = 0.5 * count[f] * (1.0 + min(met, 1.0 / CLOSE)) / (total * total)
            for i in range(size):
                gradient[row, i] += pull * slope[i]
                own = weight * slope[i]
                for j in range(i + 1):
                    curved[row, i, j] += own * slope[j]
        for i in range(size):
            for j in range(i):
                curved[row, j, i] = curved[row, i, j]
    return value, gradient, curved


def _pooled(seen: Spectrum) -> tuple[Float[np.ndarray, " f"], Float[np.ndarray, " f"], Float[np.ndarray, " f"]]:
    """Frequencies, powers, and how many values each is the mean of: neighbours, where there are too many.

    The likelihood of values that share what is expected is that of their mean, as often as there are of them.
    """
    order = np.argsort(seen.frequency, kind="stable")
    frequency, power = seen.frequency[order], seen.power[order]
    if len(frequency) <= FREQUENCIES:
        return frequency, power, np.ones(len(frequency))
    edges = np.geomspace(frequency[0], frequency[-1], FREQUENCIES)
    _, first = np.unique(np.searchsorted(edges, frequency, side="right"), return_index=True)
    count = np.diff(np.append(first, len(frequency))).astype(float)
    return np.add.reduceat(frequency, first) / count, np.add.reduceat(power, first) / count, count


def _likeliest(parts: Parts, with_tail: bool) -> Split:
    """For each filter the best of all starts, those that fall behind given up, and of where its neighbours ended."""
    top = float(np.log(parts.power.max()))
    bottom, beyond = top - NOTHING, top + NOTHING
    digits = 0.5 * NOTHING  # what is lower by that is lost beside it; of a movement there is more
    low = np.array([top - digits, SLOWEST, FLATTEST, bottom, bottom, bottom])
    high = np.array([beyond, BROADEST, STEEPEST, top + 2.0, top, beyond])
    chosen = slice(None if with_tail else -1)
    low, high, k = low[chosen], high[chosen], np.arange(len(parts.part))

    def ended(
        start: Float[np.ndarray, "k s p"], rounds: int = LIMIT
    ) -> tuple[Float[np.ndarray, "k s"], Float[np.ndarray, "k s p"]]:
        which = np.repeat(k, start.shape[1])
        rows = np.concatenate(start)
        found = least(lambda x, of: parts.scored(x, which[of], with_tail=with_tail), rows, low, high, rounds)
        return found.value.reshape(start.shape[:2]), found.at.reshape(start.shape)

    value, at = ended(_starts(parts)[..., chosen], LIMIT // FEW)
    ahead = np.argsort(value, axis=1)[:, :LEADING]
    value, at = ended(at[k[:, None], ahead])
    own, place = value.min(axis=1), at[k, value.argmin(axis=1)]
    beside = np.stack([place[np.maximum(k - 1, 0)], place[np.minimum(k + 1, k[-1])]], axis=1)
    value, at = (
        np.concatenate(both, axis=1) for both in zip((own[:, None], place[:, None]), ended(beside), strict=True)
    )
    best = value.argmin(axis=1)
    return Split(value[k, best], np.sqrt(np.exp(at[k, best, 3]) * parts.part))


def _starts(parts: Parts) -> Float[np.ndarray, "k s p"]:
    """Parameters to start from, tail and all, for each filter."""
    slow = np.argsort(parts.frequency)[:FEWEST]
    powers = np.log(parts.power)
    bottom, middle = np.quantile(powers, [1.0 / FEWEST, 0.5])
    digits = 0.5 * NOTHING  # of a double: what is lower by that is not there
    heights = [
        (b, q, float(np.median(powers[slow] + np.minimum((parts.frequency[slow] / b) ** q, digits))))
        for b, q in product(FALLS, STEEPS)
    ]
    heights += [(b, q, float(middle) + 1.0) for b, q in BROAD]
    return np.array(
        [
            [
                [height, np.log(b), np.log(q), noise, bottom - 1.0, middle]
                for b, q, height in heights
                for noise in (usual, middle)
            ]
            for usual in parts.usual
        ]
    )
