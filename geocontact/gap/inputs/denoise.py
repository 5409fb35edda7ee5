"""Measured inputs with their noise taken off, so that no candidate gains by smoothing them.

A low-pass filter, an inertia or a damper that a model does not have can look useful merely because it smooths the noise
of the inputs that the model is driven by. The noise of each input is read off its spectrum, or estimated from what the
base model misses (`identify.noise.covariance`); its spectrum is that of the low-pass filter that motion usually has
been through, and the Wiener filter 1 - N/P takes it off: P is the spectrum of the recording, N that of the noise. Both
hold for a stretch of it: a movement that sets out sharply after a rest keeps its high frequencies, and the rest loses
its noise. Where the signal stands far above the noise nothing changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product

import numpy as np
from jaxtyping import Bool, Complex, Float, Int
from scipy.special import gammaincinv

from geocontact.chain.differentiated_inputs import NEIGHBOURS
from geocontact.chain.system import FAR, System
from geocontact.data.trial import Trial
from geocontact.gap.inputs.spectrum import TREND, even_grid, long_runs
from geocontact.gap.inputs.spectrum_components import USUAL
from geocontact.gap.levels import FEWEST, SLIGHT, SURE
from geocontact.identify.noise.covariance import BLOCK_ROWS
from geocontact.identify.noise.input_noise import Lasting, NoiseSpectrum
from geocontact.identify.signals.low_pass import BELOW_NYQUIST, LowPass

BUMP = 1e-3  # of an input's half-range
PLACES = (0.2, 0.35, 0.5, 0.65)  # of a trial, where it is seen how long a response lasts


def responses(system: System, trial: Trial, values: Mapping[str, float], spectra: tuple[NoiseSpectrum, ...]) -> Lasting:
    """Responses to a change of every sample of every input that the base uses, by differences.

    Samples that do not feel each other any more are changed at once, so that as many simulations are needed as a
    response has samples (Curtis, Powell & Reid 1974, J. Inst. Math. Appl. 13:117). That grows with the sampling rate:
    200 Hz over 20 s take seconds, 1 kHz over a minute minutes. A response ends with a block of the covariance.
    """
    count = len(trial)
    step = float(np.median(np.diff(trial.time))) if count > 1 else 1.0
    ahead = max(int(np.ceil(2.0 * system.motion.reach / step)), NEIGHBOURS) + _longest_gap(system, trial)
    plain = system.simulate(trial, values)
    most = min(int((1.0 - PLACES[-1]) * count), BLOCK_ROWS)
    faded = {name: min(max(_lasting(system, trial, values, name, plain), ahead), most) for name in system.driving}
    longest = ahead + max(faded.values(), default=0) + 1
    found = np.zeros((len(system.inputs), count, plain.shape[1], longest))
    for name, lasting in faded.items():
        width, j = ahead + lasting + 1, system.inputs.index(name)
        for phase in range(min(width, count)):
            changed = np.arange(phase, count, width)
            answer = _answer(system, trial, values, name, plain, changed)
            for i in map(int, changed):
                felt = np.arange(max(i - ahead, 0), min(i + lasting + 1, count))
                found[j, felt, :, felt - i + ahead] = answer[felt]
    return Lasting(trial.time, found, ahead, spectra)


def _longest_gap(system: System, trial: Trial) -> int:
    """Most samples in a row in which an input that drives the model was not measured: both sides fill them."""
    most = 0
    for name in system.driving:
        there = np.flatnonzero(np.isfinite(trial.column(name)))
        most = max(most, int(np.diff(there, prepend=-1, append=len(trial)).max()) - 1)
    return most


def _lasting(
    system: System, trial: Trial, values: Mapping[str, float], name: str, plain: Float[np.ndarray, "t c"]
) -> int:
    """Samples after which a response has faded, in the channel and at the place where it takes longest."""
    count, longest = len(trial), 0
    for place in PLACES:
        at = int(place * count)
        answer = np.abs(_answer(system, trial, values, name, plain, np.array([at])))
        large: Bool[np.ndarray, " t"] = (answer > SLIGHT * answer.max(axis=0)).any(axis=1) & (answer.max() > 0.0)
        last = int(np.flatnonzero(large)[-1]) if large.any() else at
        longest = max(longest, last - at)
    return longest


def _answer(
    system: System,
    trial: Trial,
    values: Mapping[str, float],
    name: str,
    plain: Float[np.ndarray, "t c"],
    changed: np.ndarray,
) -> Float[np.ndarray, "t c"]:
    """Change of the outputs per change of these samples of an input."""
    step = BUMP * system.scale.span.get(name, 1.0)
    moved = trial.signals.values.copy()
    moved[changed, trial.signals.channels.index(name)] += step
    other = replace(trial, signals=replace(trial.signals, values=moved))
    answer = system.simulate(other, values)
    if (answer == FAR).any() or (plain == FAR).any():
        return np.zeros_like(plain)  # nothing is known of it
    return np.asarray(np.nan_to_num((answer - plain) / step))


PLATEAU = (0.25, 0.42, 0.58, 0.75, 0.92)  # of the corner
FLAT = 2.5  # largest over smallest power of a plateau
SMOOTH = 5  # bins that the spectrum of a stretch is averaged over
PERIODS = 8.0  # of the corner in a stretch
SHIFTS = 4  # by which a stretch is passed: at a quarter of it squared Hann windows add up to the same everywhere
Filters = Mapping[str, LowPass]
"""What each input came through."""


def denoised(trial: Trial, noise: Mapping[str, float], passed: Filters) -> Trial:
    """A trial with the noise of some inputs, standard deviations in their units, taken off by a Wiener filter.

    `passed` are the filters that the inputs came through.

    Samples are put on an even grid for it and back by linear interpolation of what was taken off; where an input was
    not measured nothing is taken off.
    """
    return changed(trial, noise, lambda name, even, step: -noise_in(even, step, noise[name], passed[name]))


def shaken(trial: Trial, noise: Mapping[str, float], passed: Filters, rng: np.random.Generator) -> Trial:
    """What `denoised` makes of a recording, with noise again as that leaves it.

    Noise of these standard deviations is drawn, and taken off as far as the filter takes it off the recording. Of
    movement that was taken off along with it nothing is added.
    """

    def change(name: str, even: Float[np.ndarray, " n"], step: float) -> Float[np.ndarray, " n"]:
        sd, through = noise[name], passed[name]
        more, own = drawn(rng, len(even), step, sd, through), Stretches.of(even, step, through)
        shares = own.shares(sd)
        return np.asarray(more - own.summed(shares) - Stretches.of(more, step, through).summed(shares))

    return changed(trial, noise, change)


def changed(
    trial: Trial,
    names: Iterable[str],
    change: Callable[[str, Float[np.ndarray, " n"], float], Float[np.ndarray, " n"]],
) -> Trial:
    """A trial with something added to some inputs, worked out on an even grid from name, values and step [s] there."""
    values = trial.signals.values.copy()
    for name, run in product(names, trial.runs):
        time, column = trial.time[run], values[run, trial.signals.channels.index(name)]
        there = np.isfinite(column)
        if there.sum() < FEWEST:
            continue
        grid = even_grid(time)
        even = np.interp(grid, time[there], column[there])
        column[there] += np.interp(time[there], grid, change(name, even, float(grid[1] - grid[0])))
    return replace(trial, signals=replace(trial.signals, values=values))


def drawn(rng: np.random.Generator, count: int, step: float, sd: float, passed: LowPass) -> Float[np.ndarray, " n"]:
    """Gaussian noise of this standard deviation that came through a filter."""
    long = 2 * count  # the end does not know of the beginning
    power = passed.power(np.fft.rfftfreq(long, step))
    white = np.fft.rfft(rng.standard_normal(long))
    return np.asarray(sd * np.fft.irfft(white * np.sqrt(power * (long // 2 + 1) / power.sum()), long)[:count])


def seen_noise(trials: Sequence[Trial], name: str, passed: LowPass) -> float | None:
    """Noise of an input as its spectrum over all trials shows it, None where the movement hides it."""
    return plateau(_evenly(trials, name), passed)


def highest_noise(trials: Sequence[Trial], name: str, passed: LowPass) -> float:
    """Standard deviation that an input's noise cannot well exceed: that of the weakest band of its spectrum.

    Movement only adds to what a band holds; how little noise may hold there by chance is given by a χ² of as many
    values as are independent under the window. Bands are those of the plateau, below the corner and below that of most
    laboratories, of which the one that allows more counts, since the corner may have come out too high. Infinite where
    no trial is long enough.
    """
    recordings, found = _evenly(trials, name), []
    for corner in {passed.corner, min(passed.corner, USUAL / passed.step)}:
        bands = in_bands(recordings, passed, corner)
        if not bands:
            return float("inf")
        least = float(np.exp(-SURE)) / len(bands)
        freedom = [2.0 * band.values / bins_wide(np.blackman(max(len(x) for x, _ in recordings))) for band in bands]
        found.append(
            min(band.variance * f / (2.0 * gammaincinv(0.5 * f, least)) for band, f in zip(bands, freedom, strict=True))
        )
    return float(np.sqrt(max(found)))


def bins_wide(window: Float[np.ndarray, " n"]) -> float:
    """Bins of a spectrum under a window that hold as much noise as one: n Σw²/(Σw)² (Harris 1978, Proc. IEEE 66:51)."""
    return float(len(window) * (window**2).sum() / window.sum() ** 2)


def _evenly(trials: Sequence[Trial], name: str) -> list[tuple[Float[np.ndarray, " _"], float]]:
    """Evenly spaced values of an input and their step [s], of each trial that is long enough."""
    recordings = []
    for trial in trials:
        for run in long_runs(trial):
            column, time, grid = trial.column(name)[run], trial.time[run], even_grid(trial.time[run])
            there = np.isfinite(column)
            if there.sum() > FEWEST:
                recordings.append((np.interp(grid, time[there], column[there]), float(grid[1] - grid[0])))
    return recordings


def plateau(recordings: Sequence[tuple[Float[np.ndarray, " _"], float]], passed: LowPass) -> float | None:
    """Standard deviation of an input's noise where its spectrum shows it, else None.

    A movement slower than the low-pass filter leaves a plateau of noise between its own frequencies and the corner:
    over the bands from a quarter of it up to it power per power let through is the same. `recordings` are evenly
    spaced values and their step [s].
    """
    levels = [band.variance for band in in_bands(recordings, passed, passed.corner)]
    return float(np.sqrt(np.mean(levels))) if levels and max(levels) < FLAT * min(levels) else None


@dataclass(frozen=True)
class Band:
    """Variance of noise that would have the power of a band, and how many values of one spectrum its mean is worth."""

    variance: float
    values: float


def in_bands(recordings: Sequence[tuple[Float[np.ndarray, " _"], float]], passed: LowPass, corner: float) -> list[Band]:
    """Each band of the plateau below `corner` [Hz]; none where recordings are too short to have values in all."""
    bands = []
    for low, high in pairwise(corner * share for share in PLATEAU):
        power, spread = [], 0.0
        for values, step in recordings:
            spectrum, frequency, scale = _spectrum(values, step, passed)
            inside = (frequency >= low) & (frequency < high)
            if inside.any():
                power.append(float(np.mean(np.abs(spectrum[inside]) ** 2 / passed.power(frequency[inside])) / scale))
                spread += 1.0 / int(inside.sum())
        if not power:
            return []
        bands.append(Band(float(np.mean(power)), len(power) ** 2 / spread))
    return bands


def _spectrum(
    values: Float[np.ndarray, " n"], step: float, passed: LowPass
) -> tuple[Complex[np.ndarray, " f"], Float[np.ndarray, " f"], float]:
    """Windowed spectrum, its frequencies, and what its power is for unit variance where the filter lets all through."""
    count = len(values)
    window = np.blackman(count)
    spectrum = np.fft.rfft((values - np.linspace(values[0], values[-1], count)) * window)
    frequency = np.fft.rfftfreq(count, step)
    return spectrum, frequency, float((window**2).sum() * count / (2.0 * passed.power(frequency).sum()))


@dataclass(frozen=True)
class Left:
    """Share of the power of an input's noise that is left after a Wiener filter, by frequency [Hz]."""

    frequency: Float[np.ndarray, " f"]
    share: Float[np.ndarray, " f"]

    def __call__(self, frequency: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """At some frequencies."""
        return np.asarray(np.interp(frequency, self.frequency, self.share))


def left(trials: Sequence[Trial], name: str, sd: float, passed: LowPass) -> Left | None:
    """What `denoised` leaves of an input's noise, on average over all stretches; None where it takes nothing off.

    Where it takes off the share s of the power N + X, it leaves (1 - s) N of noise and of movement it should not have
    taken. What a cubic follows within a stretch stays as it is.
    """
    found = []
    for trial in trials:
        for run in trial.runs:
            column, time = trial.column(name)[run], trial.time[run]
            there = np.isfinite(column)
            if there.sum() < FEWEST:
                continue
            grid = even_grid(time)
            own = Stretches.of(np.interp(grid, time[there], column[there]), float(grid[1] - grid[0]), passed)
            found.append((np.fft.rfftfreq(own.width, grid[1] - grid[0]), 1.0 - own.shares(sd) * own.beside_cubics))
    if not found:
        return None
    frequency = found[0][0]
    each = np.concatenate([[np.interp(frequency, f, row) for row in rows] for f, rows in found])
    return Left(frequency, each.mean(axis=0))


def cubics(width: int) -> Float[np.ndarray, "w four"]:
    """Orthonormal polynomials up to the third degree over a stretch."""
    return np.asarray(np.linalg.qr(np.vander((2.0 * np.arange(width) + 1.0) / width - 1.0, TREND + 1))[0])


@dataclass(frozen=True)
class Stretches:
    """Spectra of overlapping stretches of evenly spaced values.

    Stretches last `PERIODS` periods of the corner, or of the highest corner that is looked for where nothing was
    filtered, less a cubic, a quarter of a stretch apart, weighed by a Hann window before and after so that they add up
    to the whole (Portnoff, IEEE Trans. Acoust. Speech Signal Process. 28:55, 1980).

    Parameters
    ----------
    count, width
        Of the values, and of a stretch.
    begin
        Of each stretch, in values padded by one width in front.
    window
        Weights in a stretch.
    spectra
        One per stretch.
    shape
        Power that the filter lets through.
    """

    count: int
    width: int
    begin: Int[np.ndarray, " k"]
    window: Float[np.ndarray, " w"]
    spectra: Complex[np.ndarray, "k f"]
    shape: Float[np.ndarray, " f"]

    @classmethod
    def of(cls, values: Float[np.ndarray, " n"], step: float, passed: LowPass) -> Stretches:
        """Values of values `step` seconds apart."""
        hop = max(round(PERIODS / SHIFTS / min(passed.corner * step, 0.5 * BELOW_NYQUIST)), FEWEST // SHIFTS)
        width = SHIFTS * hop
        longer = np.pad(values, (width, 2 * width), mode="reflect", reflect_type="odd")
        window = np.sin(np.pi * (np.arange(width) + 0.5) / width) ** 2
        slow = cubics(width)
        begin = np.arange(0, len(longer) - width + 1, hop)
        each = longer[begin[:, None] + np.arange(width)]
        spectra = np.fft.rfft(window * (each - (each @ slow) @ slow.T))
        return cls(len(values), width, begin, window, spectra, passed.power(np.fft.rfftfreq(width, step)))

    @property
    def beside_cubics(self) -> Float[np.ndarray, " f"]:
        """Share of the power at each frequency of the spectra that a stretch less its cubic keeps."""
        slow = cubics(self.width)
        waves = np.exp(2j * np.pi * np.outer(np.arange(len(self.shape)), np.arange(self.width)) / self.width)
        rest = self.window * (waves - (waves @ slow) @ slow.T)
        return np.asarray(np.minimum((np.abs(rest) ** 2).sum(axis=1) / (self.window**2).sum(), 1.0))

    def shares(self, sd: float) -> Float[np.ndarray, "k f"]:
        """Share of each power that is noise of this standard deviation."""
        from scipy.ndimage import uniform_filter1d

        shape = self.shape
        noise = sd**2 * float(self.window @ self.window) * self.width * shape / (2.0 * shape.sum() - shape[0])
        power = uniform_filter1d(np.abs(self.spectra) ** 2, SMOOTH, axis=1, mode="nearest")
        return np.asarray(np.minimum(noise / np.maximum(power, 1e-300), 1.0))

    def summed(self, shares: Float[np.ndarray, "k f"]) -> Float[np.ndarray, " n"]:
        """These shares of the spectra, put together again."""
        off = np.zeros(int(self.begin[-1]) + self.width)
        for begin, part in zip(self.begin, np.fft.irfft(shares * self.spectra, self.width), strict=True):
            off[begin : begin + self.width] += self.window * part
        return np.asarray(off[self.width : self.width + self.count] / (SHIFTS * np.mean(self.window**2)))


def noise_in(values: Float[np.ndarray, " n"], step: float, sd: float, passed: LowPass) -> Float[np.ndarray, " n"]:
    """What a Wiener filter takes off evenly spaced values whose low-passed noise has this standard deviation."""
    stretches = Stretches.of(values, step, passed)
    return stretches.summed(stretches.shares(sd))
