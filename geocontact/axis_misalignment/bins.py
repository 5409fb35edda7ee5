"""Elbow recordings sorted by angle, with how long what moves the force besides the angle is remembered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.noise.autoregressive import AutoregressiveNoise, noise_of
from geocontact.identify.signals.angle_bins import LEAST_SECONDS, AngleBins, Cells, angle_bins, edges_over

CHUNK = 0.05  # s, over which a residual is averaged before its correlation time is estimated
MEMORIES = 10.0  # correlation times in a stretch: a tenth of the variance is lost across their ends
SHORTEST, FEWEST = 1.0, 6  # s of a stretch, and stretches in the longest of few trials
LONGER = "give a longer recording, or wider bins (`bin`)"
MANY = 12  # trials; these are stretches enough
BETA, FORCE, RATE, PRESSURE, DISPLACEMENT = range(5)
"""Channels of the visits."""


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
    """

    names: tuple[str, ...]
    visits: AngleBins
    cells: Cells
    noise: AutoregressiveNoise
    stretch: float
    step: float
    pressure: float

    @property
    def centres(self) -> Float[np.ndarray, " b"]:
        """Middle of each bin [rad]."""
        return np.asarray(0.5 * (self.visits.edges[1:] + self.visits.edges[:-1]))

    @property
    def information(self) -> Float[np.ndarray, " n"]:
        """Reciprocal variance of the mean force of each cell [1/N^2].

        A correlation time tau leaves t / (2 tau) independent values in t seconds.
        """
        seconds = self.cells.count * self.step
        sd, tau = float(self.noise.sd[0]), float(self.noise.tau[0])
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
        return Binned(self.names, some, some.cells(), self.noise, self.stretch, self.step, self.pressure)


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
    return Binned(tuple(r.name for r in recordings), found, found.cells(), noise, stretch, step, pressure)


def _stretch(durations: Sequence[float], tau: float) -> float:
    """Length of a stretch [s] for a correlation time; a trial that is shorter is one stretch.

    Few trials are cut finer than that, so that there are stretches to compare: the longest decides, as one short trial
    does not make those of the others independent.
    """
    wanted = max(SHORTEST, MEMORIES * tau)
    return wanted if len(durations) >= MANY else min(wanted, max(durations) / FEWEST)


def _channels(r: ElbowRecording, pressure: float) -> Float[np.ndarray, "t 5"]:
    nothing = np.zeros(len(r.time))
    cuff = nothing if r.pressure is None else r.pressure - pressure
    joint = nothing if r.displacement is None else r.displacement
    return np.column_stack([r.beta, r.force, r.rate, cuff, joint])


def _noise(
    times: Sequence[Float[np.ndarray, " _"]],
    channels: Sequence[Float[np.ndarray, "_ 5"]],
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
    chunks = [
        _averaged(t, c[:, FORCE] - np.interp(c[:, BETA], beta, force)) for t, c in zip(times, channels, strict=True)
    ]
    return noise_of([t for t, _ in chunks], [off[:, None] for _, off in chunks])


def _averaged(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"]
) -> tuple[Float[np.ndarray, " c"], Float[np.ndarray, " c"]]:
    """Means over chunks of time; the samples themselves where they are farther apart."""
    number = np.floor((time - time[0]) / CHUNK).astype(int)
    count = np.bincount(number)
    there = count > 0
    return np.bincount(number, time)[there] / count[there], np.bincount(number, values)[there] / count[there]
