"""Cells and regions of the map of a gap, and cells of a pressure mat beside the channel that they add up to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

FAST = 5.0  # Hz, above which the map over the phase looks
BAND, FAST_PHASE = "band", "fast phase"
"""Axes of energies: frequency [Hz], and the phase of the trial for what is faster than `FAST`."""


@dataclass(frozen=True)
class Cell:
    """What a model misses of one channel in one part of an axis.

    Parameters
    ----------
    channel, axis, low, high
        Of an output, over "phase", an input, its rate, "load", "band" [Hz], or "fast phase", between these values, SI.
    gap
        Mean residual there [the channel's unit]; of an energy the root mean square.
    share
        Of the channel's squared gap along this axis, noise taken off: along an axis they add up to 1, or to 0.
    p_value
        Family-wise.
    ci95
        Of `share`.
    floor
        Part of the channel's squared residual along this axis that is no gap: with it (1 - floor) × shares make 1.
    """

    channel: str
    axis: str
    low: float
    high: float
    gap: float
    share: float
    p_value: float
    ci95: tuple[float, float]
    floor: float


@dataclass(frozen=True)
class Region:
    """A region of phase, state and rate in which a channel's base model misses what all trials have.

    Parameters
    ----------
    channel
        That it is of.
    phase
        Parts of the trial between which it lies, 0…1.
    input, state
        Input that the channel follows, and between which of its values, SI; "" and zeros where it follows none.
    way
        "rising" or "falling" input, "" where both.
    mean
        Measured less predicted there [the channel's unit].
    share
        Of the channel's squared error, all trials.
    q_value
        Least false-discovery rate, over all cells, at which it is found.
    units
        Of the channel and of the input.
    """

    channel: str
    phase: tuple[float, float]
    input: str
    state: tuple[float, float]
    way: str
    mean: float
    share: float
    q_value: float
    units: tuple[str, str] = ("", "")

    def as_dict(self) -> dict[str, Any]:
        """The content of diagnosis.json."""
        return {
            "channel": self.channel,
            "phase": list(self.phase),
            "input": self.input,
            "state": list(self.state),
            "way": self.way,
            "mean": self.mean,
            "share": self.share,
            "q_value": self.q_value,
        }

    @property
    def place(self) -> str:
        """Where it is, in words."""
        parts = [f"phase {100.0 * self.phase[0]:.0f}–{100.0 * self.phase[1]:.0f} %"]
        if self.input:
            parts.append(f"{self.input} {self.state[0]:.3g} to {self.state[1]:.3g} {self.units[1]}")
        return ", ".join([*parts, *([self.way] if self.way else [])])


def shares(parts: Float[np.ndarray, " b"]) -> Float[np.ndarray, " b"]:
    """Parts of their sum; 0 where there is nothing."""
    return np.asarray(parts / max(float(parts.sum()), 1e-300))


@dataclass(frozen=True, eq=False)
class CellTrial:
    """One trial: time [s], strictly increasing, and pressures [Pa]; NaN where a cell was not measured."""

    time: Float[np.ndarray, " t"]
    pressure: Float[np.ndarray, "t n"]


@dataclass(frozen=True, eq=False)
class CellChannels:
    """One site of a case.

    Parameters
    ----------
    channel
        Output that the cells are the parts of ("thigh_force").
    ids
        Names of the cells, as in the layout.
    place, area
        Middle of each cell in the scan's frame [m], and its area [m^2].
    trials
        By the trial's id; a trial without cells is not there.
    """

    channel: str
    ids: tuple[str, ...]
    place: Float[np.ndarray, "n 3"]
    area: Float[np.ndarray, " n"]
    trials: Mapping[str, CellTrial]

    def forces(self, trial: str, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t n"]:
        """Force of every cell [N] at other times of a trial, straight between frames; NaN outside of them."""
        own = self.trials[trial]
        columns = [np.interp(time, own.time, column, np.nan, np.nan) for column in own.pressure.T]
        return np.asarray(np.column_stack(columns) * self.area)


@dataclass(frozen=True, eq=False)
class SurfaceGap:
    """One channel's gap over the cells of its site.

    Parameters
    ----------
    site, channel, ids, place
        Of the cells; middles in the scan's frame [m].
    load, gap
        Part of each cell in the base model's force and in the gap; either adds up to 1.
    holding
        The fewest cells that hold 70 % of the gap, the fullest first.
    p_value
        That a gap spread as the load is would differ so much from that spread, family-wise over the cells.
    """

    site: str
    channel: str
    ids: tuple[str, ...]
    place: Float[np.ndarray, "n 3"]
    load: Float[np.ndarray, " n"]
    gap: Float[np.ndarray, " n"]
    holding: tuple[str, ...]
    p_value: float

    @property
    def held(self) -> tuple[float, float]:
        """What those cells hold of the gap, and of the load."""
        which = [self.ids.index(name) for name in self.holding]
        return float(self.gap[which].sum()), float(self.load[which].sum())
