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


def _areas(cells: Bool[np.ndarray, "t r c"], frames: PressureFrames) -> Float[np.ndarray, " t"]:
    return np.asarray(np.tensordot(cells.astype(float), np.broadcast_to(frames.cell_area, cells.shape[1:]), 2))
