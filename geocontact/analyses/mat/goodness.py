"""Whether a mat lies where its landmarks are, a scan is that of the body, and the cells read what presses on them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.register.quality import Registration
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit

PALPATED = 0.02
"""m; root mean square up to which landmarks that somebody palpated are not doubted; a convention of this command."""
LOST = 0.05
"""m; beyond, they are other landmarks, or in another order."""
SCANNED = 0.5
"""Share of a scan that lies on the body, below which it may be another one."""


def goodness_of_registration(way: str, found: Registration) -> GoodnessOfFit:
    """Landmarks, or the shape of the scan, beside those of the body; `way` is which of them."""
    doubts = []
    if found.names and found.rms > PALPATED:
        worst, off = found.worst
        said = f"landmarks of scan and body are {1e3 * found.rms:.0f} mm apart, {worst} {1e3 * off:.0f} mm"
        doubts.append(Doubt(said, found.rms > LOST, found.rms / PALPATED))
    if not found.names and found.overlap < SCANNED:
        said = f"{found.overlap:.0%} of the scan lie on the body"
        doubts.append(Doubt(said, found.overlap < SCANNED / 2.0, 1.0 - found.overlap))
    if not found.converged:
        doubts.append(Doubt(f"the registration by {way} did not converge", False))
    return GoodnessOfFit(tuple(doubts), (f"registration by {way}",))


def goodness_of_cells(frames: PressureFrames, saturated: Bool[np.ndarray, "t r c"]) -> GoodnessOfFit:
    """Cells at the end of their range, where they only say that more presses on them."""
    return GoodnessOfFit(tuple(_of_cells(frames, saturated)), ("range of the cells",))


def _of_cells(frames: PressureFrames, saturated: Bool[np.ndarray, "t r c"]) -> Iterable[Doubt]:
    if not saturated.any():
        return
    pressed = np.where(frames.valid, frames.pressure, 0.0) > 0.0
    under = _areas(pressed, frames)
    heaviest = int(np.argmax(frames.force))
    if under[heaviest] > 0.0:
        share = float(_areas(saturated & pressed, frames)[heaviest] / under[heaviest])
        what = f"cells clip on {share:.0%} of the area under the largest force"
        yield Doubt(what, share >= MUCH, share)


BEYOND = 1.05
"""Times the stated saturation, which cells that clip do not read."""
DISTINCT, BESIDE = 10, 3
"""Different pressures in a line of cells that another line repeats; cells of a line that nothing ever presses while
both cells beside them are pressed."""


def odd_cells(read: PressureFrames, touched: float, gate: float) -> Iterable[str]:
    """What cells cannot be, in words: beyond their saturation, lines of them that are silent or copied, never touched.

    Parameters
    ----------
    touched, gate
        Pressure from which a cell counts as touched [Pa], and force from which there is a centre of pressure [N].
    """
    pressure = np.where(read.valid, np.nan_to_num(read.pressure), 0.0)
    top, saturation = float(pressure.max(initial=0.0)), read.saturation
    if top > BEYOND * saturation:
        row, column = np.unravel_index(int(np.argmax(pressure.max(axis=0))), pressure.shape[1:])
        what = f"row {row} column {column} reads {1e-3 * top:.4g} kPa, beyond the saturation of {1e-3 * saturation:g}"
        yield f"{what}: is the unit of the recording or of saturation_kPa another one, or that cell faulty?"
    if 0.0 < top < touched:
        yield f"`touched` is {1e-3 * touched:g} kPa, and no cell reads more than {1e-3 * top:.4g}: no cell is touched"
    heaviest = float(read.force.max(initial=0.0))
    if 0.0 < heaviest < gate:
        yield f"`gate` is {gate:g} N, and the force {heaviest:.4g} N at most: no frame has a centre of pressure"
    for way, lines in (("row", pressure), ("column", np.swapaxes(pressure, 1, 2))):
        peak = lines.max(axis=0)
        beside = (np.minimum(peak[:-2], peak[2:]) >= touched).sum(axis=1)
        for silent in np.flatnonzero((peak[1:-1].max(axis=1) <= 0.0) & (beside >= BESIDE)) + 1:
            yield f"no cell of {way} {silent} is ever pressed, while those on both sides are: is its line broken?"
        same = [k for k in range(lines.shape[1] - 1) if _repeats(lines[:, k], lines[:, k + 1])]
        mirrored = len(lines) > 1 and np.array_equal(lines, lines[:, ::-1])  # a made-up course
        for k in [] if mirrored else same:
            yield f"{way} {k + 1} reads what {way} {k} reads, in every frame: is it a copy?"


def _repeats(one: Float[np.ndarray, "t c"], other: Float[np.ndarray, "t c"]) -> bool:
    return np.array_equal(one, other) and len(np.unique(one)) > DISTINCT


def _areas(cells: Bool[np.ndarray, "t r c"], frames: PressureFrames) -> Float[np.ndarray, " t"]:
    return np.asarray(np.tensordot(cells.astype(float), np.broadcast_to(frames.cell_area, cells.shape[1:]), 2))
