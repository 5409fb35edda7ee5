"""Elbow recordings sorted by angle, with how long what moves the force besides the angle is remembered."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.noise.autoregressive import AutoregressiveNoise, noise_of
from geocontact.identify.signals.angle_bins import (
    LEAST_SECONDS,
    AngleBins,
    Cells,
    angle_bins,
    bin_numbers,
    edges_over,
)

CHUNK = 0.05  # s, over which a residual is averaged before its correlation time is estimated
MEMORIES = 10.0  # correlation times in a stretch: a tenth of the variance is lost across their ends
SHORTEST, FEWEST = 1.0, 6  # s of a stretch, and stretches in the longest of few trials
LONGER = "give a longer recording, or wider bins (`bin`)"
MANY = 12  # trials; these are stretches enough
BETA, FORCE, RATE, PRESSURE, DISPLACEMENT, MOMENT, ALPHA = range(7)
"""Channels of the visits; NaN where a trial has no moment or no angle of the arm."""
LEAST_NOISE = 1e-3  # of a channel's range: means of a bin stand for their samples to no better than that


@dataclass(frozen=True, eq=False)
class Binned:
    """Visits of the trials to the bins, the cells that they make up, and the noise about their curve.

    Parameters
    ----------
    noise
        Standard deviation [N] and correlation time [s] of the force about the curve through the bins' means.
    stretch
        Length of a stretch [s].
    step
        Usual time between samples [s].
    pressure
        Mean cuff pressure [Pa] that the channel is counted from; 0 where none was recorded.
    beside
        Noise of moment [N m] and angle of the arm [rad], by channel, as far as they were recorded.
    """

    names: tuple[str, ...]
    visits: AngleBins
    cells: Cells
    noise: AutoregressiveNoise
    stretch: float
    step: float
    pressure: float
    beside: Mapping[int, AutoregressiveNoise] = field(default_factory=dict)

    @property
    def centres(self) -> Float[np.ndarray, " b"]:
        """Middle of each bin [rad]."""
        return np.asarray(0.5 * (self.visits.edges[1:] + self.visits.edges[:-1]))

    @property
    def information(self) -> Float[np.ndarray, " n"]:
        """Reciprocal variance of the mean force of each cell [1/N^2]."""
        return self.information_of(self.noise)

    def information_of(self, noise: AutoregressiveNoise) -> Float[np.ndarray, " n"]:
        """Reciprocal variance of the mean of each cell of a channel with this noise.

        A correlation time tau leaves t / (2 tau) independent values in t seconds.
        """
        seconds = self.cells.count * self.step
        sd, tau = float(noise.sd[0]), float(noise.tau[0])
        return np.asarray(seconds / (2.0 * tau + CHUNK) / sd**2)

    def without(self, trial: int) -> Binned:
        """The same trials but one."""
        return self._kept(self.visits.trial != trial)

    def only(self, trial: int) -> Binned:
        """One of the trials."""
        return self._kept(self.visits.trial == trial)

    def _kept(self, kept: np.ndarray) -> Binned:
        v = self.visits
        some = AngleBins(v.edges, v.trial[kept], v.stretch[kept], v.place[kept], v.count[kept], v.means[kept])
        return replace(self, visits=some, cells=some.cells())


def binned(recordings: Sequence[ElbowRecording], width: float, centre: float | None = None) -> Binned:
    """Bins of `width` [rad] over the range that the recordings reach.

    `centre` is the cuff pressure that the channel is counted from [Pa]; their mean by default.
    """
    times = [r.time for r in recordings]
    edges = edges_over([r.beta for r in recordings], width)
    known = [r.pressure for r in recordings if r.pressure is not None]
    own = float(np.concatenate(known).mean()) if known else 0.0
    pressure = own if centre is None else centre
    channels = [_channels(r, pressure) for r in recordings]
    noise = _noise(times, channels, edges)
    stretch = _stretch([float(t[-1] - t[0]) for t in times], float(noise.tau[0]))
    found = angle_bins(times, channels, edges, stretch)
    step = float(np.median([r.step for r in recordings]))
    names, beside = tuple(r.name for r in recordings), _noise_beside(times, channels, edges)
    return Binned(names, found, found.cells(), noise, stretch, step, pressure, beside)


def _stretch(durations: Sequence[float], tau: float) -> float:
    """Length of a stretch [s] for a correlation time; a trial that is shorter is one stretch.

    Few trials are cut finer than that, so that there are stretches to compare: the longest decides, as one short trial
    does not make those of the others independent.
    """
    wanted = max(SHORTEST, MEMORIES * tau)
    return wanted if len(durations) >= MANY else min(wanted, max(durations) / FEWEST)


def _channels(r: ElbowRecording, pressure: float) -> Float[np.ndarray, "t 7"]:
    nothing, unknown = np.zeros(len(r.time)), np.full(len(r.time), np.nan)
    cuff = nothing if r.pressure is None else r.pressure - pressure
    joint = nothing if r.displacement is None else r.displacement
    moment, alpha = (unknown if each is None else each for each in (r.moment, r.alpha))
    return np.column_stack([r.beta, r.force, r.rate, cuff, joint, moment, alpha])


def _noise(
    times: Sequence[Float[np.ndarray, " _"]],
    channels: Sequence[Float[np.ndarray, "_ 7"]],
    edges: Float[np.ndarray, " edges"],
) -> AutoregressiveNoise:
    """Noise of the force about the curve through all trials' bin means, which no model has a part in."""
    found = angle_bins(times, channels, edges, np.inf)
    if not len(found.count):
        held = f"no bin of {np.degrees(edges[1] - edges[0]):g} degrees is held for {LEAST_SECONDS:g} s in any recording"
        raise InputError("", "", f"{held}: {max(float(t[-1] - t[0]) for t in times):.3g} s are too short", LONGER)
    curve = found.cells()
    bins = len(edges) - 1
    count = np.bincount(curve.place, curve.count, bins)
    reached = count > 0.0
    beta, force = (
        np.bincount(curve.place, curve.count * curve.means[:, k], bins)[reached] / count[reached] for k in (BETA, FORCE)
    )
    return _noise_about(times, [c[:, FORCE] - np.interp(c[:, BETA], beta, force) for c in channels])


def _noise_about(
    times: Sequence[Float[np.ndarray, " _"]], off: Sequence[Float[np.ndarray, " _"]]
) -> AutoregressiveNoise:
    chunks = [_averaged(t, values) for t, values in zip(times, off, strict=True)]
    return noise_of([t for t, _ in chunks], [values[:, None] for _, values in chunks])


@dataclass(frozen=True, eq=False)
class _Curve:
    """Means of all samples of a bin by channel, and how the moment goes with the force within it [m]."""

    means: Float[np.ndarray, "b c"]
    lever: Float[np.ndarray, " b"]

    @classmethod
    def through(cls, channels: Sequence[Float[np.ndarray, "_ 7"]], edges: Float[np.ndarray, " edges"]) -> _Curve:
        every = np.vstack(channels)
        place, bins = bin_numbers(every[:, BETA], edges), len(edges) - 1
        count = np.bincount(place, minlength=bins)
        reached = count > 0
        sums = np.column_stack([np.bincount(place, column, bins) for column in every.T])
        means = sums / np.maximum(count, 1)[:, None]
        off = every - means[place]
        both, own = (np.bincount(place, off[:, FORCE] * off[:, k], bins) for k in (MOMENT, FORCE))
        return cls(means[reached], (both / np.where(own > 0.0, own, np.inf))[reached])

    def at(self, samples: Float[np.ndarray, "t 7"], channel: int) -> Float[np.ndarray, " t"]:
        """The channel's mean at the angles of some samples."""
        return np.asarray(np.interp(samples[:, BETA], self.means[:, BETA], self.means[:, channel]))

    def levers(self, samples: Float[np.ndarray, "t 7"]) -> Float[np.ndarray, " t"]:
        """By how much the moment goes with the force at these angles [m]."""
        return np.asarray(np.interp(samples[:, BETA], self.means[:, BETA], self.lever))


def _noise_beside(
    times: Sequence[Float[np.ndarray, " _"]],
    channels: Sequence[Float[np.ndarray, "_ 7"]],
    edges: Float[np.ndarray, " edges"],
) -> dict[int, AutoregressiveNoise]:
    """Noise of the moment beside the force of the same sample, and of the arm's angle beside the exoskeleton's.

    The moment's is about its curve through the bins and, within them, a line over the force; the angle's about the
    curve of the difference of both angles. Each trial's own mean is taken out. No model has a part in either.
    """
    found: dict[int, AutoregressiveNoise] = {}
    for channel in (MOMENT, ALPHA):
        with_it = [k for k, c in enumerate(channels) if np.isfinite(c[0, channel])]
        if not with_it:
            continue
        own = [channels[k].copy() for k in with_it]
        if channel == ALPHA:
            for c in own:
                c[:, ALPHA] -= c[:, BETA]
        curve = _Curve.through(own, edges)
        off = [c[:, channel] - curve.at(c, channel) for c in own]
        if channel == MOMENT:
            pairs = zip(own, off, strict=True)
            off = [each - curve.levers(c) * (c[:, FORCE] - curve.at(c, FORCE)) for c, each in pairs]
        noise = _noise_about([times[k] for k in with_it], [each - each.mean() for each in off])
        least = LEAST_NOISE * float(np.ptp(curve.means[:, channel]))
        found[channel] = AutoregressiveNoise(np.maximum(noise.sd, least), noise.tau)
    return found


def _averaged(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"]
) -> tuple[Float[np.ndarray, " c"], Float[np.ndarray, " c"]]:
    """Means over chunks of time; the samples themselves where they are farther apart."""
    number = np.floor((time - time[0]) / CHUNK).astype(int)
    count = np.bincount(number)
    there = count > 0
    return np.bincount(number, time)[there] / count[there], np.bincount(number, values)[there] / count[there]
