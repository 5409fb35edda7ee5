"""What no candidate makes and no surrogate sees: a narrow line, ringing; and remarks on how the data were recorded.

Noise is coloured at most, its spectrum smooth; whitened by the right model it is white. Each check compares the
whitened residual, or the recording itself, with that, and says in nats (minus the logarithm of a p-value that is
corrected for everything that was looked at) how far off it is. Bursts, repeated values and coarse steps are of the
recorder: they are remarked upon, and are no evidence of an effect.

Many laws bend the top of a curve, but none makes it the same to the last digit, so values are counted: how many lie at
the largest of a channel, and how many at most at one of the next below. Values are all different, unless samples are
held or recorded in steps; of a smooth top the last step holds up to 1/(√2 - 1) = 1 + √2 times what the one below it
does, since the time within a step of the top of a parabola goes with the root of the step. As many or more by chance
have the probability of a Poisson count.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.trial import Trial
from geocontact.gap.case.noise_sources import HUMMING, at_mains, measured_columns, usual_range, wave_count
from geocontact.gap.case.problem import Problem
from geocontact.gap.inputs.spectrum import resolution, switches
from geocontact.gap.levels import FLAT, SLIGHT, SURE
from geocontact.gap.selection.evidence import Judged, without_discrepancy
from geocontact.identify.intervals.tails import f_nats, gamma_nats, poisson_nats
from geocontact.identify.noise.noise_levels import typical_noise

NEXT = 5  # values below the extreme that it is compared with


@dataclass(frozen=True)
class ClippedChannel:
    """A level [the channel's unit] that is never passed, how many samples lie there, and how sure that is [nats]."""

    channel: str
    level: float
    count: int
    nats: float

    @property
    def words(self) -> str:
        """What is seen."""
        return f"{self.count} samples lie at the same extreme, {self.level:.4g}"


def clipped_channels(problem: Problem) -> tuple[ClippedChannel, ...]:
    """Channels whose recordings end at a level, either way, all trials together."""
    outputs = problem.system.outputs
    looks = np.log(2.0 * len(outputs))
    found = []
    for c, name in enumerate(outputs):
        columns = measured_columns(problem, c)
        if not columns:
            continue
        values, step = np.concatenate(columns), resolution(columns)
        most = float(np.abs(values).max())
        for side in (1.0, -1.0):
            level, count, nats = pile(side * values, step)
            if level > 0.5 * most and nats - looks > SURE:
                found.append(ClippedChannel(name, side * level, count, min(float(nats - looks), 2.0 * SURE)))
    return tuple(found)


def pile(values: Float[np.ndarray, " n"], step: float) -> tuple[float, int, float]:
    """Largest of some values, recorded in steps (0 where there are none); how many share it; nats against chance."""
    whole = np.round(values / step) * step if step > 0.0 else values
    levels, counts = np.unique(whole, return_counts=True)
    usual = float(counts[-1 - NEXT : -1].max(initial=1)) * (1.0 + np.sqrt(2.0) if step > 0.0 else 1.0)
    return float(levels[-1]), int(counts[-1]), poisson_nats(int(counts[-1]), usual)


WINDOWS = (4, 8, 16, 32, 64)  # samples
BESIDE = (-8, -7, -6, -5, -4, -3, 3, 4, 5, 6, 7, 8)  # bins that a line is compared with
OTHERS = 4  # stretches that one is compared with, at the least
CYCLES = 4  # periods in a window, or in a trial, from which something counts as an oscillation
PACKETS = (4, 6, 8)  # samples per period, of the slowest oscillation that a window of CYCLES periods shows


@dataclass(frozen=True)
class ResidualAnomaly:
    """Something odd.

    Parameters
    ----------
    words
        What it is.
    nats
        How sure it is.
    share
        Of the squared error of its channel that it makes up, that of the base model; 0 of what is of the recorder.
    """

    words: str
    channel: str
    nats: float
    share: float = 0.0

    @property
    def told(self) -> str:
        """What it is, where, and its share if it has one."""
        share = f", {100.0 * self.share:.2g} % of its squared error" if self.share > 0.0 else ""
        return f"{self.words} in {self.channel}{share}"

    @property
    def part(self) -> float:
        """The share as far as it is sure, nothing of it at SURE nats and all of it well beyond.

        A narrow line of a thousandth of the error may be as sure as anything, and is a thousandth.
        """
        return float(self.share * -np.expm1(min(SURE - self.nats, 0.0)))


def residual_anomalies(problem: Problem, judged: Judged, base: Judged) -> list[ResidualAnomaly]:
    """Oscillations that a model leaves, the surest first; shares are of the error of `base`."""
    return sorted([*lines(problem, judged, base), *ringing(problem, judged, base)], key=lambda each: -each.nats)


def recorder_remarks(problem: Problem, judged: Judged) -> list[ResidualAnomaly]:
    """What the recording itself shows, the surest first."""
    found = [*hum(problem, judged), *bursts(problem, judged), *held_samples(problem), *steps(problem)]
    return sorted(found, key=lambda each: -each.nats)


def innovations(problem: Problem, judged: Judged) -> list[list[Float[np.ndarray, " _"]]]:
    """Whitened residual of each channel of each trial in the order of time, without what the discrepancy basis makes up
    for.
    """
    whitenings = problem.whitenings(judged.noise, judged.model)
    channels = len(problem.floor)
    out = []
    together = zip(whitenings, judged.noise.whiteners, without_discrepancy(judged), strict=True)
    for whitening, whitener, residual in together:
        white = whitening(residual[..., None])[:, 0]
        flat = np.full(residual.size, np.nan)
        flat[np.concatenate(whitener.rows)] = white
        out.append([column[np.isfinite(column)] for column in flat.reshape(-1, channels).T])
    return out


def lines(problem: Problem, judged: Judged, base: Judged) -> list[ResidualAnomaly]:
    """A narrow line in the spectrum: power at one frequency against that of its neighbours, trials taken together.

    At frequencies of the movement a model misses something, and nothing is odd. What only goes on and off has all
    frequencies, and is no movement. Hum of the mains is of the recorder.
    """
    return _lines(problem, judged, base, "a line", mains=False)


def hum(problem: Problem, judged: Judged) -> list[ResidualAnomaly]:
    """The same at the frequencies of electric mains, as sampling shows them.

    A line that is something else falls there by chance only: they are a few bins of hundreds.
    """
    found = _lines(problem, without_hum(problem, judged), judged, "hum of the mains", mains=True)
    return [replace(one, share=0.0) for one in found]


def without_hum(problem: Problem, judged: Judged) -> Judged:
    """A model judged as if hum were no part of the noise: what it leaves of hum is seen then."""
    waves = wave_count(len(problem.floor))
    varies = judged.noise.varies.copy()
    varies[len(varies) - 1 - waves : -1] = 0.0
    return replace(judged, noise=replace(judged.noise, varies=varies))


def _lines(problem: Problem, judged: Judged, base: Judged, what: str, *, mains: bool) -> list[ResidualAnomaly]:
    """Lines at the mains' frequencies, or everywhere else."""
    found = []
    step = problem.system.scale.step
    trials = [*problem.calibration.trials, *problem.evaluation.trials]
    moved = [name for name in problem.system.inputs if not switches(trials, name)]
    rows = innovations(problem, judged)
    for c, name in enumerate(problem.system.outputs):
        long = [(trial, row[c]) for trial, row in zip(trials, rows, strict=True) if len(row[c]) >= WINDOWS[-1]]
        series = [x for _, x in long]
        if not series:
            continue
        grid = np.linspace(0.0, 0.5, max(map(len, series)) // 2)
        doubt = np.zeros(len(grid))
        for trial, x in long:
            power = np.abs(np.fft.rfft((x - x.mean()) * np.hanning(len(x)))) ** 2
            usual, beside = _around(power)
            above = f_nats(power / usual, 2, beside)  # neighbours overlap under the window, so half of them count
            ruled_out = moving(trial, moved, len(power))
            ruled_out |= at_mains(len(power), len(x), step) != mains
            ruled_out[:CYCLES] = ruled_out[-1] = True  # at Nyquist's frequency power has half the freedom
            doubt += np.interp(grid, np.arange(len(power)) / len(x), np.where(ruled_out, 0.0, above))
        peak = int(np.argmax(doubt))
        nats = gamma_nats(float(doubt[peak]), len(series)) - float(np.log(len(grid)))
        share = share_of_band(problem, judged, base, c, float(grid[peak]), 0.0)
        found.append(ResidualAnomaly(f"{what} at {grid[peak] / step:.3g} Hz", name, max(nats, 0.0), share))
    return found


def moving(trial: Trial, inputs: Sequence[str], count: int) -> Bool[np.ndarray, " f"]:
    """Which of `count` frequencies from 0 to Nyquist's are part of the movement of some input."""
    frequency = np.linspace(0.0, 0.5, count)
    found = np.zeros(count, bool)
    for name in inputs:
        column = trial.column(name)
        there = np.isfinite(column)
        if not there.any() or np.ptp(column[there]) == 0.0:
            continue
        grid = np.arange(len(column))
        even = np.interp(grid, grid[there], column[there])
        size = np.abs(np.fft.rfft((even - even.mean()) * np.hanning(len(even))))
        wide = np.maximum.reduce([size, np.roll(size, 1), np.roll(size, -1)])
        found |= np.interp(frequency, np.fft.rfftfreq(len(even)), wide) > SLIGHT * size.max()
    return found


def _around(power: Float[np.ndarray, " f"]) -> tuple[Float[np.ndarray, " f"], Float[np.ndarray, " f"]]:
    """Mean power of the bins a little to either side, and how many of them there are."""
    at = np.arange(len(power))[:, None] + np.array(BESIDE)
    there = (at > 0) & (at < len(power))
    count = there.sum(axis=1).astype(float)
    return (power[np.where(there, at, 0)] * there).sum(axis=1) / count, count


def ringing(problem: Problem, judged: Judged, base: Judged) -> list[ResidualAnomaly]:
    """An oscillation that comes at the same phase of every trial and dies away: power there against that elsewhere.

    Of one frequency, beyond what all frequencies gain there.
    """
    found = []
    rows = innovations(problem, judged)
    for c, name in enumerate(problem.system.outputs):
        best, at_best, narrow = 0.0, 0.0, 0.0
        for width in (CYCLES * samples for samples in PACKETS if samples > 2):  # of two is Nyquist's frequency
            spectra = [_packets(trial[c], width) for trial in rows if len(trial[c]) >= OTHERS * width]
            if not spectra:
                continue
            frames = min(map(len, spectra))
            grid = np.linspace(0.0, 1.0, frames)
            together = np.mean([_along(each, grid) for each in spectra], axis=0)
            usual = np.mean([each.mean(axis=0) for each in spectra], axis=0)
            others = (usual * frames - together) / (frames - 1)
            freedom = 2 * len(spectra)
            ratio = together / others
            ratio /= np.maximum(np.median(ratio, axis=1, keepdims=True), 1.0)  # higher at all frequencies is no ringing
            nats = f_nats(ratio, freedom, freedom * frames // 2) - np.log(ratio.size * len(PACKETS))
            frame, at = np.unravel_index(int(np.argmax(nats)), nats.shape)
            if nats[frame, at] > best:
                best, at_best, narrow = float(nats[frame, at]), (at + CYCLES) / width, 1.0 / width
        words = f"ringing at {at_best / problem.system.scale.step:.3g} Hz at the same phase of every trial"
        found.append(ResidualAnomaly(words, name, best, share_of_band(problem, judged, base, c, at_best, narrow)))
    return found


def share_of_band(problem: Problem, judged: Judged, base: Judged, c: int, centre: float, half: float) -> float:
    """Part of a channel's squared error that is within `half` of a frequency [cycles per sample], 0 … 1.

    Of all trials together that are long enough to show a line. What is within is what a model leaves, beyond as much as
    bins as far again to either side have; the error is that of `base`, its mean with it, or what the model leaves where
    that is more. With `half` 0 within the bins that hold 87 % of a line or more, wherever it lies between them.
    """
    inside = whole = before = 0.0
    both = zip(judged.model.residuals, base.model.residuals, problem.recorded.present, strict=True)
    for residual, first, present in both:
        x, y = residual[present[:, c], c], first[present[:, c], c]
        if len(x) < WINDOWS[-1]:
            continue
        power = 2.0 * np.abs(np.fft.rfft(x))[1 : (len(x) + 1) // 2] ** 2 / len(x)  # neither mean nor Nyquist's
        off, wide = np.abs(np.arange(1, len(power) + 1) / len(x) - centre), max(half, HUMMING / len(x))
        near, beside = power[off <= wide], power[(off > wide) & (off <= 2.0 * wide)]
        inside += float(near.sum()) - len(near) * (float(beside.mean()) if len(beside) else 0.0)
        whole, before = whole + float(x @ x), before + float(y @ y)
    return min(max(inside, 0.0) / max(whole, before), 1.0) if whole > 0.0 else 0.0


def _packets(values: Float[np.ndarray, " n"], width: int) -> Float[np.ndarray, "m f"]:
    """Power spectra of half-overlapping windows, without their lowest frequencies."""
    starts = range(0, len(values) - width + 1, width // 2)
    frames = np.array([values[a : a + width] for a in starts]) * np.hanning(width)
    return np.asarray(np.abs(np.fft.rfft(frames, axis=1)[:, CYCLES:-1]) ** 2)


def _along(power: Float[np.ndarray, "m f"], grid: Float[np.ndarray, " p"]) -> Float[np.ndarray, "p f"]:
    """Frames nearest in phase."""
    return np.asarray(power[np.round(grid * (len(power) - 1)).astype(int)])


def bursts(problem: Problem, judged: Judged) -> list[ResidualAnomaly]:
    """A stretch of one trial in which the residual is far larger than there and then in the other trials."""
    found = []
    rows = innovations(problem, judged)
    for c, name in enumerate(problem.system.outputs):
        best, looked = 0.0, 0
        for width in WINDOWS:
            energies = [_energy(trial[c], width) for trial in rows if len(trial[c]) >= OTHERS * width]
            for own, energy in enumerate(energies):
                phase = np.linspace(0.0, 1.0, len(energy))
                others = [
                    np.interp(phase, np.linspace(0.0, 1.0, len(e)), e) for i, e in enumerate(energies) if i != own
                ]
                usual = np.maximum(np.median(others, axis=0), 1.0) if others else np.ones(len(energy))
                best = max(best, float(f_nats(energy / usual, width, OTHERS * width).max()))
                looked += 2 * len(energy) // width
        found.append(ResidualAnomaly("a burst", name, max(best - float(np.log(max(looked, 1))), 0.0)))
    return found


def _energy(values: Float[np.ndarray, " n"], width: int) -> Float[np.ndarray, " m"]:
    """Mean square in a running window."""
    total = np.concatenate([[0.0], np.cumsum(values**2)])
    return np.asarray((total[width:] - total[:-width]) / width)


def held_samples(problem: Problem) -> list[ResidualAnomaly]:
    """Samples that repeat the one before, away from the ends of the range, where saturation would hold them.

    By chance as many repeat as the resolution of the recording and the size of its steps suggest (the density of normal
    steps at 0), and one more.
    """
    found = []
    for c, name in enumerate(problem.system.outputs):
        columns = measured_columns(problem, c)
        step = resolution(columns)
        repeats, count, expected = 0, 0, 0.0
        for x in columns:
            low, high = usual_range(x)
            inside = (x[1:] > low) & (x[1:] < high)
            steps = np.diff(x)[inside]
            repeats += int((steps == 0.0).sum())
            count += len(steps)
            usual = typical_noise(steps)
            expected += len(steps) * min(step / (np.sqrt(2.0 * np.pi) * usual) if usual > 0.0 else 1.0, 1.0)
        share, chance = repeats / max(count, 1), (expected + 1.0) / max(count, 1)
        if share > chance:
            rest = np.log(max(1.0 - share, 1e-12) / max(1.0 - chance, 1e-12))
            nats = count * (share * np.log(share / chance) + (1.0 - share) * rest)
            found.append(ResidualAnomaly(f"{100.0 * share:.1f} % of the samples repeat the last", name, float(nats)))
    return found


def steps(problem: Problem) -> list[ResidualAnomaly]:
    """A recording whose steps are coarse against its noise: rounding adds more than `SLIGHT` to its variance."""
    found, usual = [], FLAT * float(np.sqrt(SLIGHT))
    for c, name in enumerate(problem.system.outputs):
        columns = measured_columns(problem, c)
        step = resolution(columns)
        values = sum(map(len, columns))
        distinct = len(np.unique(np.round(np.concatenate(columns) / max(step, 1e-300)))) if values else 0
        coarse = step / problem.floor_of_noise[c]
        if coarse > usual and distinct < values:
            found.append(ResidualAnomaly(f"it comes in steps of {step:.3g}", name, SURE * coarse / usual))
    return found
