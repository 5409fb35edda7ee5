"""What the noise of a channel comes from, before any model is fitted: steps, size of the signal, mains, numerical
error.

Noise of a standard deviation b |y| is white noise whose size is known but for b. For y the recording is taken, smoothed
over a few samples, and not the prediction of a model: it is the same for every model, so that none gains by predicting
less, and it has the effect in it that a base model misses. With a sample as it was recorded its noise would decide what
it weighs: one that is too high would weigh less than one that is as much too low.

A centre of pressure is q = M/F. Noise of the force of standard deviation s moves the moment about the middle of the
foot by about s a, a the half-range of q; so q has the noise (s a / F) beside what it has at large forces. Noise of the
moment itself is seen: of the third of the samples with the smallest forces and of that with the largest, fourth
differences tell how much of the noise grows as 1/F.

Hum has the frequency of the mains, 50 or 60 Hz, as sampling shows it: the columns are sines at the times of the
samples, so that sampling folds them as it folds the hum, and unevenly sampled hum is no line at all. Size and phase are
a trial's own (it begins anywhere in the mains' period); a sine and a cosine with independent normal weights have both.
They are directions like those of `gap.case.placement`, their sizes estimated from the trials with what is usual.

Rates come from a cubic through neighbours. Where the movement is fast for the sampling, and more so at the ends of a
recording, where all neighbours are on one side, that is off by more than noise. How far off it is, is seen by taking
more neighbours (grid refinement, Richardson's extrapolation: Roache, Verification and Validation in Computational
Science and Engineering, 1998, ch. 5). At the ends the order is lower and the estimate a lower bound.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.differentiated_inputs import DEGREE
from geocontact.chain.system import FAR, System
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.case.problem import Problem
from geocontact.gap.inputs.spectrum import resolution
from geocontact.gap.levels import DEVIATIONS, FEWEST, FLAT, SLIGHT
from geocontact.identify.noise.noise_levels import typical_noise


def measured_columns(problem: Problem, c: int) -> list[Float[np.ndarray, " _"]]:
    """Measured values of one channel, trial by trial, trials with a few only left out."""
    columns = [outputs[:, c] for outputs in problem.recorded.outputs]
    return [x[np.isfinite(x)] for x in columns if np.isfinite(x).sum() >= FEWEST]


def usual_range(values: Float[np.ndarray, " n"]) -> tuple[float, float]:
    """Ends of the range that all but `SLIGHT` of the values lie in, half of the others beyond either; NaN do not count.

    In the unit of `values`.
    """
    low, high = np.nanquantile(values, [0.5 * SLIGHT, 1.0 - 0.5 * SLIGHT])
    return float(low), float(high)


ASIDE = 4  # samples to either side that the recording is smoothed over
ORDER = 4  # of differences that show noise beside a movement


def signal_size(outputs: Sequence[Float[np.ndarray, "_ c"]]) -> list[Float[np.ndarray, "_ c"]]:
    """Per trial, the magnitude of each channel's mean over `ASIDE` samples to either side; 0 where nothing is known."""
    from scipy.ndimage import uniform_filter1d

    found = []
    for each in outputs:
        there = np.isfinite(each)
        total, count = (
            uniform_filter1d(x.astype(float), 2 * ASIDE + 1, axis=0, mode="constant")
            for x in (np.where(there, each, 0.0), there)
        )
        found.append(np.abs(np.divide(total, count, out=np.zeros_like(total), where=count > 1e-9)))
    return found


def seen_growth(
    outputs: Sequence[Float[np.ndarray, "_ c"]], spread: Sequence[Float[np.ndarray, "_ c"]]
) -> Float[np.ndarray, " c"]:
    """Noise of each channel per unit of its signal, as the recording shows it; 0 where it does not grow.

    Fourth differences of white noise have 70 times its variance; a movement of frequency f leaves (2π f step)⁴ of
    itself in them, less than a thousandth from 36 samples per period on. Their typical squares in the third of the
    samples with the largest signal and in that with the smallest differ by b² times the difference of its squares.

    Parameters
    ----------
    outputs
        Measured, per trial.
    spread
        How many times its level the noise of each sample is for other reasons (`noise_spread`).
    """
    grown = np.zeros(outputs[0].shape[1])
    sizes = signal_size(outputs)
    for c in range(len(grown)):
        rows = [_differences(y[:, c], size[:, c], s[:, c]) for y, size, s in zip(outputs, sizes, spread, strict=True)]
        rough, size = np.concatenate(rows, axis=1)
        low, high = _thirds(size)
        if high > low:
            parts = size <= low, size >= high
            noise = [typical_noise(rough[part], ORDER) ** 2 for part in parts]
            signal = [np.mean(size[part] ** 2) for part in parts]
            grown[c] = np.sqrt(max(noise[1] - noise[0], 0.0) / (signal[1] - signal[0]))
    return grown


def _thirds(size: Float[np.ndarray, " n"]) -> tuple[float, float]:
    """What a third of the samples are at most, and a third at least; 0 without any."""
    low, high = np.quantile(size, np.array([1.0, 2.0]) / 3.0) if len(size) else (0.0, 0.0)
    return float(low), float(high)


def _differences(
    values: Float[np.ndarray, " t"], size: Float[np.ndarray, " t"], spread: Float[np.ndarray, " t"]
) -> Float[np.ndarray, "two m"]:
    """Fourth differences where all five samples were measured, and the signal's size there, in levels of the noise."""
    half = ORDER // 2
    rough = np.diff(values, ORDER)
    middle = slice(half, len(values) - half)
    both = np.stack([rough, size[middle]])[:, : len(rough)] / spread[middle]
    return np.asarray(both[:, np.isfinite(rough)])


@dataclass(frozen=True)
class QuotientNoise:
    """Noise of an output that is a quotient q = M/F: sqrt(c² + (m/F)²).

    Parameters
    ----------
    constant
        c, in the unit of q.
    moment
        m, in that of M.
    least
        Magnitude that F is taken for where it is smaller: that of its own noise.
    """

    constant: float
    moment: float
    least: float

    @classmethod
    def of(
        cls,
        quotients: Sequence[Float[np.ndarray, " _"]],
        divisors: Sequence[Float[np.ndarray, " _"]],
        rough: float,
        least: float,
    ) -> QuotientNoise:
        """What recordings show, one per trial; `rough` is the quotient's typical noise, `least` the divisor's.

        The moment has the noise of the divisor times half the range of the quotient at the least.
        """
        larger = [1.0 / np.maximum(np.abs(each), least) for each in divisors]
        share, middle = _grown_share(quotients, larger)
        low, high = usual_range(np.concatenate(quotients))
        seen = float(np.sqrt(share)) * rough / middle
        return cls(float(np.sqrt(1.0 - share)) * rough, max(seen, least * 0.5 * (high - low)), least)

    def at(self, divisor: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """Standard deviation of each sample."""
        return np.asarray(np.hypot(self.constant, self.moment / np.maximum(np.abs(divisor), self.least)))


def _grown_share(
    quotients: Sequence[Float[np.ndarray, " _"]], larger: Sequence[Float[np.ndarray, " _"]]
) -> tuple[float, float]:
    """Share of a quotient's typical variance of noise that grows with one over its divisor, which `larger` is per trial
    and sample, and the median of that; 0 and 1 where fewer than `FEWEST` fourth differences are in a third.
    """
    rows = [_differences(q, each, np.ones_like(each)) for q, each in zip(quotients, larger, strict=True)]
    uneven, size = np.concatenate(rows, axis=1)
    low, high = _thirds(size)
    far, near = size <= low, size >= high
    if min(far.sum(), near.sum()) < FEWEST:
        return 0.0, 1.0
    middle = float(np.median(size))
    least = typical_noise(uneven[far], ORDER) ** 2  # c² + m² s
    per_size = typical_noise(uneven[near] / size[near], ORDER) ** 2  # m² + c² t
    s, t = float(np.median(size[far])) ** 2, float(np.median(size[near] ** -2.0))
    if s * t >= 1.0:
        return 0.0, middle
    grown = max(per_size - least * t, 0.0) / (1.0 - s * t)
    even = max(least - grown * s, 0.0)
    return float(grown * middle**2 / max(grown * middle**2 + even, np.finfo(float).tiny)), middle


def quotient_noise(
    system: System, outputs: Sequence[Float[np.ndarray, "_ c"]], rough: Float[np.ndarray, " c"]
) -> dict[str, QuotientNoise]:
    """Noise of each output that is a quotient and was measured.

    Parameters
    ----------
    outputs
        Measured, per trial.
    rough
        Noise of each output where it is typical.
    """
    found = {}
    for name, divisor in system.quotients.items():
        c, d = system.outputs.index(name), system.outputs.index(divisor)
        both = [each[:, c] for each in outputs], [each[:, d] for each in outputs]
        if np.isfinite(np.concatenate(both[0])).any():
            found[name] = QuotientNoise.of(*both, float(rough[c]), float(rough[d]))
    return found


def noise_spread(
    system: System, outputs: Sequence[Float[np.ndarray, "_ c"]], noise: Mapping[str, QuotientNoise]
) -> list[Float[np.ndarray, "_ c"]]:
    """Per trial, how many times its median each sample's sensor noise is; 1 for outputs that are no quotient.

    Parameters
    ----------
    outputs
        Measured or predicted, per trial.
    noise
        Of quotients (`quotient_noise`).
    """
    spread = [np.ones_like(each) for each in outputs]
    for name, one in noise.items():
        c, d = system.outputs.index(name), system.outputs.index(system.quotients[name])
        own = [one.at(each[:, d]) for each in outputs]
        measured = np.concatenate([s[np.isfinite(each[:, c])] for s, each in zip(own, outputs, strict=True)])
        typical = float(np.nanmedian(measured))
        for made, each in zip(spread, own, strict=True):
            made[:, c] = np.where(np.isfinite(each), each / typical, 1.0)
    return spread


def with_rounding(case: GapCase) -> dict[str, float]:
    """Noise that the case tells, by channel, with that of the recorder's steps: q²/12 of variance, and nothing more."""
    return {name: float(np.hypot(sd, rounding(case, name))) for name, sd in case.noise.items()}


def rounding(case: GapCase, name: str) -> float:
    """Standard deviation of the noise that rounding makes of a channel."""
    columns = [trial.column(name) for trial in (*case.calibration, *case.evaluation)]
    return resolution([x[np.isfinite(x)] for x in columns]) / FLAT


def typical_step(case: GapCase) -> float:
    """Time between two samples of the calibration trials [s]."""
    return float(np.median(np.concatenate([np.diff(trial.time) for trial in case.calibration])))


def rough_noise(system: System, case: GapCase) -> Float[np.ndarray, " c"]:
    """Noise that the case tells, else what second differences of the measurement suggest; no less than its rounding."""
    stated = with_rounding(case)
    seen = (stated.get(name) or max(_jumpiness(case, name), rounding(case, name)) for name in system.outputs)
    return np.array(list(seen))


def _jumpiness(case: GapCase, name: str) -> float:
    steps = np.concatenate([np.diff(t.column(name)[np.isfinite(t.column(name))], 2) for t in case.calibration])
    spread = typical_noise(steps, 2)
    most = max(float(np.nanmax(np.abs(t.column(name)), initial=0.0)) for t in case.calibration)
    return max(spread, 1e-4 * most, 1e-12)


MAINS = (50.0, 60.0)  # Hz
HUM = 0.3  # root mean square, in noise levels of the channel, that hum of either frequency usually has
WAVES = (np.cos, np.sin)  # of each frequency
HUMMING = 2.0  # bins about such a frequency, or where sampling folds it to, that are hum


def wave_count(channels: int) -> int:
    """How many waves that many outputs have."""
    return channels * len(MAINS) * len(WAVES)


def hum(time: Float[np.ndarray, " t"], rough: Float[np.ndarray, " c"]) -> Float[np.ndarray, "t c k"]:
    """What one usual standard deviation of each wave adds to the outputs, in their units: channel after channel.

    Parameters
    ----------
    time
        Of the samples [s].
    rough
        Noise level of each output, in its unit.
    """
    turns = 2.0 * np.pi * (time - time[0])[:, None] * np.array(MAINS)
    waves = np.concatenate([wave(turns) for wave in WAVES], axis=1)
    waves = waves - waves.mean(axis=0)  # sampled once or so in a period it is a zero of the output, which is known
    found = np.zeros((len(time), len(rough), len(rough), wave_count(1)))
    for c, level in enumerate(rough):
        found[:, c, c] = HUM * level * waves
    return found.reshape(len(time), len(rough), -1)


def at_mains(count: int, samples: int, step: float) -> Bool[np.ndarray, " f"]:
    """Which of `count` frequencies of so many samples, every `step` [s], are those of the mains or of their images."""
    cycles = np.array(MAINS) * step
    image = np.abs(cycles - np.round(cycles)) * samples
    return np.asarray((np.abs(np.arange(count)[:, None] - image) <= HUMMING).any(axis=1))


def error_of_rates(system: System, trial: Trial, values: Mapping[str, float]) -> Float[np.ndarray, "t c"]:
    """Numerical error of a prediction, in the outputs' units; 0 where there is none.

    A polynomial of degree p through symmetric neighbours gives rates of order p + 1; neighbours twice as far away are
    off by 2^(p + 1) times as much.
    """
    fine, wide = (system.reaching(n * system.motion.reach).simulate(trial, values) for n in (1.0, 2.0))
    told = [np.isfinite(each) & (np.abs(each) < 0.5 * FAR) for each in (fine, wide)]
    return np.where(told[0] & told[1], wide - fine, 0.0) / (2.0 ** (DEGREE + 1) - 1.0)


def coarse_rates(problem: Problem) -> tuple[str, ...]:
    """In words where the base model's prediction is off by more than DEVIATIONS of a channel's noise for this.

    At the worst measured sample of all trials, as the last column of the placement has it; nothing for a channel whose
    rates are known well enough everywhere.
    """
    trials = problem.recorded.trials
    measured = zip(problem.placement, problem.recorded.present, strict=True)
    errors = [np.where(there, np.abs(columns[..., -1]), 0.0) for columns, there in measured]
    told = []
    for c, name in enumerate(problem.system.outputs):
        most = [float(error[:, c].max()) / problem.floor_of_noise[c] for error in errors]
        worst = int(np.argmax(most))
        if most[worst] > DEVIATIONS:
            at = trials[worst].time[int(np.argmax(errors[worst][:, c]))]
            told.append(
                f"rates of the inputs are recorded too coarsely: at {at:.3g} s of {trials[worst].name} "
                f"{name} is off by {most[worst]:.2g} times its noise or more"
            )
    return tuple(told)
