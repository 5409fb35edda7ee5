"""Whether a mat lies where its landmarks are, a scan is that of the body, and the cells read what presses on them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.pressure_frames import PressureFrames
from geocontact.geometry.register.quality import Registration
from geocontact.identify.goodness_of_fit import MUCH, Doubt, GoodnessOfFit
from geocontact.io.text.units import DIMENSIONS

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


def beyond_saturation(read: PressureFrames) -> Iterable[str]:
    """The cell that reads most, in words, where that is beyond the stated end of the cells' range.

    A cell that clips reads that end. Units are named in which the pressure would be within it.
    """
    pressure = np.where(read.valid, np.nan_to_num(read.pressure), 0.0)
    top, end = float(pressure.max(initial=0.0)), read.saturation
    if top <= BEYOND * end:
        return
    row, column = np.argwhere(pressure == top)[0][1:]
    within = [
        f"{top * DIMENSIONS['Pa'][unit] * 1e-6:.4g} kPa if they are in {unit}"
        for unit in ("mmHg", "Pa")
        if top * DIMENSIONS["Pa"][unit] * 1e-3 <= end
    ]
    meant = f"are the pressures in the unit that is stated ({', '.join(within)})" if within else "is the unit right"
    what = f"{read.name}: row {row} column {column} reads {top * 1e-3:.4g} kPa, and cells end at {end * 1e-3:.4g} kPa"
    yield f"{what}: {meant}, is saturation_kPa another one, or that cell faulty?"


STOPS, STOPPED, PART = 5, 3, 0.05
"""Frames in which a cell reads the largest value of all, and cells that do: noise differs; and share of the pressed
samples that are below that value: one pressure everywhere is no range that ends."""


def one_top(read: PressureFrames) -> Iterable[str]:
    """Several cells, in words, that stop at one and the same largest value, below the stated saturation."""
    pressure = np.where(read.valid, np.nan_to_num(read.pressure), 0.0)
    top = float(pressure.max(initial=0.0))
    stopped = ((pressure == top).sum(axis=0) >= STOPS).sum()
    between = ((pressure > 0.0) & (pressure < top)).sum() > PART * (pressure > 0.0).sum()
    if 0.0 < top < read.saturation and stopped >= STOPPED and between:
        what = f"{stopped} cells stop at one value, {top * 1e-3:.4g} kPa, the largest of all"
        yield f"{what}: if that is where they clip, give it in the layout as saturation_kPa; forces are too low"


DISTINCT, BESIDE = 10, 3
"""Different pressures in a line of cells that another line repeats; cells of a line that nothing ever presses while
both cells beside them are pressed."""
TOGETHER, ARCHED = 0.5, 0.8
"""Share of the frames in which one or the other cell beside a silent one is pressed, in which both are; and share of
those in which pressure rises towards it from one side. Between two thighs or feet it falls from both."""


def odd_cells(read: PressureFrames, touched: float, gate: float) -> Iterable[str]:
    """What cells cannot be, in words: lines of them that are silent or copied, or none that is ever touched.

    Parameters
    ----------
    touched, gate
        Pressure from which a cell counts as touched [Pa], and force from which there is a centre of pressure [N].
    """
    pressure = np.where(read.valid, np.nan_to_num(read.pressure), 0.0)
    top = float(pressure.max(initial=0.0))
    if 0.0 < top < touched:
        yield f"`touched` is {1e-3 * touched:g} kPa, and no cell reads more than {1e-3 * top:.4g}: no cell is touched"
    heaviest = float(read.force.max(initial=0.0))
    if 0.0 < heaviest < gate:
        yield f"`gate` is {gate:g} N, and the force {heaviest:.4g} N at most: no frame has a centre of pressure"
    both = ("row", pressure, read.valid), ("column", np.swapaxes(pressure, 1, 2), read.valid.T)
    for way, lines, valid in both if len(pressure) else ():
        for silent in _silent(lines, valid, touched):
            yield f"no cell of {way} {silent} is ever pressed, while those on both sides are: is its line broken?"
        same = [k for k in range(lines.shape[1] - 1) if _repeats(lines[:, k], lines[:, k + 1])]
        mirrored = len(lines) > 1 and np.array_equal(lines, lines[:, ::-1])  # a made-up course
        for k in [] if mirrored else same:
            yield f"{way} {k + 1} reads what {way} {k} reads, in every frame: is it a copy?"


def _silent(lines: Float[np.ndarray, "t r c"], valid: Bool[np.ndarray, "r c"], touched: float) -> Iterable[int]:
    """Lines with cells that work, none of which is ever pressed, across one loaded area; the outer two are not known.

    A line that separates two loaded areas looks the same, but pressure falls towards it from both.
    """
    for k in range(2, lines.shape[1] - 2):
        if not valid[k].any() or lines[:, k].any():
            continue
        one, other = lines[:, k - 1] >= touched, lines[:, k + 1] >= touched
        together, either = one & other, one | other
        crossed = valid[k] & together.any(axis=0) & (together.sum(axis=0) >= TOGETHER * either.sum(axis=0))
        if crossed.sum() < BESIDE:
            continue
        rises = (lines[:, k - 1] > lines[:, k - 2]) | (lines[:, k + 1] > lines[:, k + 2])
        if rises[:, crossed][together[:, crossed]].mean() >= ARCHED:
            yield k


def _repeats(one: Float[np.ndarray, "t c"], other: Float[np.ndarray, "t c"]) -> bool:
    return np.array_equal(one, other) and len(np.unique(one)) > DISTINCT


def _areas(cells: Bool[np.ndarray, "t r c"], frames: PressureFrames) -> Float[np.ndarray, " t"]:
    return np.asarray(np.tensordot(cells.astype(float), np.broadcast_to(frames.cell_area, cells.shape[1:]), 2))
