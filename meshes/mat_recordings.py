"""Synthetic recordings of pressure mats: sit-to-stand with a cuff on the thigh, leaning into a belt around the waist, a
shin pressed into a cuff, an upper arm held by two pads of a shell.

A cell reads the mean of the closed-form pressure over itself, the cell laid as `meshes.mat_placement` says; the truth
comes from the smooth skin (`meshes.moving_pressure`), not from cells. Nothing presses in the first and last 0.3 s.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np

from meshes.mat_placement import SHANK_MAT, THIGH_MAT, TORSO_MAT, UPPER_ARM_MAT, Mat
from meshes.moving_pressure import Footprint, Resultant, resultant

RATE = 50.0
"""Frames per second."""
SOFT = 2.0
"""Exponent of a soft pad's pressure; cells' means then stand to half a Pa."""


@dataclass(frozen=True)
class Recording:
    """What presses under a mat at the times (t,) [s], and the level [kPa] at which its faulty variant clips."""

    mat: Mat
    time: np.ndarray
    footprints: tuple[Footprint, ...]
    clips_at: float
    dead: tuple[tuple[int, int], ...]

    def cells(self) -> np.ndarray:
        """Mean pressure of every cell (t, rows, columns) [kPa]."""
        points, weights = self.mat.cell_points()
        return sum(f.pressure(self.mat.segment, points[None]) @ weights for f in self.footprints)

    def truth(self) -> Resultant:
        """Exact resultants about the origin of the segment's frame."""
        parts = (resultant(self.mat.segment, f, np.zeros(3)) for f in self.footprints)
        return reduce(Resultant.plus, parts)

    def offsets(self) -> np.ndarray:
        """What each cell of the faulty variant reads too much at t = 0 (rows, columns) [kPa], 0.2 to 0.8.

        Spread by the golden section's multiples, so that no random generator has to stay as it is.
        """
        number = np.arange(self.mat.rows * self.mat.columns).reshape(self.mat.rows, self.mat.columns)
        return 0.2 + 0.6 * ((number * (5**0.5 - 1) / 2) % 1.0)

    def faulty(self) -> np.ndarray:
        """Cells with offsets, DRIFT in all, clipped and dead cells at 0 (t, rows, columns) [kPa]."""
        reading = np.minimum(self.cells() + self.offsets() + DRIFT * self.time[:, None, None], self.clips_at)
        reading[:, *np.transpose(self.dead)] = 0.0
        return reading


DRIFT = 0.15
"""Of every cell of the faulty variants [kPa/s]."""


def rise(time: np.ndarray, start: float, end: float) -> np.ndarray:
    """0 before `start`, 1 after `end`, 10 u^3 - 15 u^4 + 6 u^5 between: no jump of speed or acceleration."""
    u = np.clip((time - start) / (end - start), 0.0, 1.0)
    return u**3 * (10 - 15 * u + 6 * u**2)


def sit_to_stand() -> Recording:
    """The cuff takes load while the seat lets go, slides 60 mm up the thigh and lets go when standing."""
    time = np.arange(151) / RATE
    peak = 30.0 * rise(time, 0.3, 1.1) * (1 - rise(time, 1.9, 2.7))
    middle = np.column_stack([0.12 * np.sin(2 * np.pi * time / 3.0), -20.0 + 60.0 * rise(time, 0.6, 2.2)])
    return Recording(THIGH_MAT, time, (Footprint(peak, middle, 60.0, 42.0, SOFT),), 26.0, ((5, 3), (9, 6)))


def leaning() -> Recording:
    """Two pads of a belt at the waist; the weight goes from the left pad to the right one."""
    time = np.arange(121) / RATE
    loaded = rise(time, 0.3, 0.8) * (1 - rise(time, 1.6, 2.1))
    shift = rise(time, 0.6, 1.8)
    height = np.full_like(time, -32.0)
    left = Footprint(loaded * (18.0 - 10.0 * shift), np.column_stack([-0.75 - 0.1 * shift, height]), 36.0, 52.0, SOFT)
    right = Footprint(loaded * (6.0 + 14.0 * shift), np.column_stack([0.85 - 0.1 * shift, height]), 36.0, 52.0, SOFT)
    return Recording(TORSO_MAT, time, (left, right), 15.0, ((9, 4), (23, 5)))


def kneeling() -> Recording:
    """The shin is pressed into a cuff, which rolls 20 mm along it and lets go again."""
    time = np.arange(76) / RATE
    peak = 28.0 * rise(time, 0.3, 0.6) * (1 - rise(time, 0.9, 1.2))
    middle = np.column_stack([np.zeros_like(time), -10.0 + 20.0 * rise(time, 0.4, 1.1)])
    return Recording(SHANK_MAT, time, (Footprint(peak, middle, 56.0, 34.0, SOFT),), 22.0, ((6, 3), (9, 4)))


def lifting() -> Recording:
    """Two pads of a shell on the upper arm; the load goes from the lower one to the upper one."""
    time = np.arange(76) / RATE
    loaded, shift = rise(time, 0.3, 0.6) * (1 - rise(time, 0.9, 1.2)), rise(time, 0.4, 1.1)
    low, high = (np.column_stack([np.full_like(time, np.pi / 2), np.full_like(time, y)]) for y in (-52.0, 46.0))
    lower = Footprint(loaded * (28.0 - 16.0 * shift), low, 42.0, 36.0, SOFT)
    upper = Footprint(loaded * (10.0 + 16.0 * shift), high, 42.0, 36.0, SOFT)
    return Recording(UPPER_ARM_MAT, time, (lower, upper), 17.0, ((4, 4), (11, 3)))


def recordings() -> Iterator[Recording]:
    """Those that are shipped."""
    yield sit_to_stand()
    yield leaning()
    yield kneeling()
    yield lifting()
