"""What a pressure mat records: one pressure per cell and frame, on a grid."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.frame_blocks import parts, worked


@dataclass(frozen=True, eq=False, repr=False)
class PressureFrames:
    """Frames of one sensor, in the mat's own layout.

    Parameters
    ----------
    time
        Of each frame [s], strictly increasing.
    pressure
        Of each cell [Pa], rows outermost; NaN where `valid` is False. As recorded it may fall below 0, by an offset.
    pitch
        Distance between neighbouring rows and between neighbouring columns [m]; cells fill it.
    valid
        Cells that there are and that work. False: no cell there (masks, cut-outs), or a dead one.
    cell_area
        Sensing area of each cell [m^2]; that of the pitch where the file says nothing else.
    saturation
        Pressure at which a cell clips [Pa]; infinite where nobody says.
    name
        Of the sensor, for messages: "left", "seat".
    """

    time: Float[np.ndarray, " t"]
    pressure: Float[np.ndarray, "t r c"]
    pitch: tuple[float, float]
    valid: Bool[np.ndarray, "r c"]
    cell_area: Float[np.ndarray, "r c"]
    saturation: float = np.inf
    name: str = field(default="mat")

    def __post_init__(self) -> None:
        if not (np.diff(self.time) > 0.0).all():
            raise ValueError(f"{self.name}: times of the frames must increase")
        if not min(self.pitch) > 0.0 or not (self.cell_area[self.valid] > 0.0).all():
            raise ValueError(f"{self.name}: pitch and cell area must be positive")
        if not all(np.isfinite(part[:, self.valid]).all() for (part,) in parts(self.pressure)):
            raise ValueError(f"{self.name}: pressures of valid cells must be finite")

    def __repr__(self) -> str:
        span = f"{self.time[0]:g} to {self.time[-1]:g} s" if len(self.time) else "empty"
        cells = f"{int(self.valid.sum())} of {self.rows} x {self.columns} cells"
        return f"<PressureFrames {self.name}: {len(self.time)} frames, {span}, {cells}, up to {self.force.max():.0f} N>"

    @property
    def rows(self) -> int:
        """Number of rows of the grid."""
        return int(self.pressure.shape[1])

    @property
    def columns(self) -> int:
        """Number of columns of the grid."""
        return int(self.pressure.shape[2])

    @cached_property
    def saturated(self) -> Bool[np.ndarray, "t r c"]:
        """Cells that clip: at or above the saturation level."""
        return worked(lambda part: part >= self.saturation, self.pressure)

    @cached_property
    def force(self) -> Float[np.ndarray, " t"]:
        """Sum of pressure times cell area [N], whichever way the cells look."""
        return worked(lambda part: np.nansum(part * self.cell_area, axis=(1, 2)), self.pressure)
