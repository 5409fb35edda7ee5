"""Whether a mat lies where its landmarks are, a scan is that of the body, and the cells read what presses on them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.frame_blocks import parts
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
    if not any(part.any() for (part,) in parts(saturated)):
        return
    heaviest = int(np.argmax(frames.force))
    pressed = np.where(frames.valid, frames.pressure[heaviest], 0.0) > 0.0
    under = float(frames.cell_area[pressed].sum())
    if under > 0.0:
        share = float(frames.cell_area[saturated[heaviest] & pressed].sum()) / under
        what = f"cells clip on {share:.0%} of the area under the largest force"
        yield Doubt(what, share >= MUCH, share)


BEYOND = 1.05
"""Times the stated saturation, which cells that clip do not read."""


def beyond_saturation(read: PressureFrames) -> Iterable[str]:
    """The cell that reads most, in words, where that is beyond the stated end of the cells' range.

    A cell that clips reads that end. Units are named in which the pressure would be within it.
    """
    top, end = _top(read), read.saturation
    if top <= BEYOND * end:
        return
    row, column = next(np.argwhere(part == top)[0][1:] for part in _readings(read) if (part == top).any())
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
    top = _top(read)
    stopped = (np.sum([(part == top).sum(axis=0) for part in _readings(read)], axis=0) >= STOPS).sum()
    pressed = sum(int((part > 0.0).sum()) for part in _readings(read))
    between = sum(int(((part > 0.0) & (part < top)).sum()) for part in _readings(read)) > PART * pressed
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
    top = _top(read)
    if 0.0 < top < touched:
        yield f"`touched` is {1e-3 * touched:g} kPa, and no cell reads more than {1e-3 * top:.4g}: no cell is touched"
    heaviest = float(read.force.max(initial=0.0))
    if 0.0 < heaviest < gate:
        yield f"`gate` is {gate:g} N, and the force {heaviest:.4g} N at most: no frame has a centre of pressure"
    for way, turned in (("row", False), ("column", True)) if len(read.pressure) else ():
        for silent in _silent(read, turned, touched):
            yield f"no cell of {way} {silent} is ever pressed, while those on both sides are: is its line broken?"
        for k in _copied(read, turned):
            yield f"{way} {k + 1} reads what {way} {k} reads, in every frame: is it a copy?"


def _readings(read: PressureFrames, turned: bool = False) -> Iterable[Float[np.ndarray, "t r c"]]:
    """Frames a part at a time, 0 where there is no cell; rows and columns exchanged where `turned`."""
    for (part,) in parts(read.pressure):
        pressure = np.where(read.valid, np.nan_to_num(part), 0.0)
        yield np.swapaxes(pressure, 1, 2) if turned else pressure


def _top(read: PressureFrames) -> float:
    """Largest reading, 0 at least."""
    return max(float(part.max(initial=0.0)) for part in _readings(read))


def _silent(read: PressureFrames, turned: bool, touched: float) -> Iterable[int]:
    """Lines with cells that work, none of which is ever pressed, across one loaded area; the outer two are not known.

    A line that separates two loaded areas looks the same, but pressure falls towards it from both.
    """
    valid = read.valid.T if turned else read.valid
    pressed = np.any([part.any(axis=(0, 2)) for part in _readings(read, turned)], axis=0)
    for k in range(2, len(valid) - 2):
        if not valid[k].any() or pressed[k]:
            continue
        counts = np.sum([_about(part[:, k - 2 : k + 3], touched) for part in _readings(read, turned)], axis=0)
        together, either, arched = counts
        crossed = valid[k] & (together > 0) & (together >= TOGETHER * either)
        if crossed.sum() >= BESIDE and arched[crossed].sum() >= ARCHED * together[crossed].sum():
            yield k


def _about(lines: Float[np.ndarray, "t 5 c"], touched: float) -> Int[np.ndarray, "3 c"]:
    """In how many frames each cell beside the middle one of five lines is pressed: both, either, and both while
    pressure rises towards the middle from one side.
    """
    one, other = lines[:, 1] >= touched, lines[:, 3] >= touched
    rises = (lines[:, 1] > lines[:, 0]) | (lines[:, 3] > lines[:, 4])
    return np.array([each.sum(axis=0) for each in (one & other, one | other, one & other & rises)])


def _copied(read: PressureFrames, turned: bool) -> Iterable[int]:
    """Lines that the next one repeats, with several different pressures; none of a mat that is its own mirror image,
    as a made-up course is.
    """
    count = (read.valid.T if turned else read.valid).shape[0]
    same, distinct = np.ones(max(count - 1, 0), bool), [set[float]() for _ in range(count)]
    mirrored = len(read.pressure) > 1
    for part in _readings(read, turned):
        same &= (part[:, 1:] == part[:, :-1]).all(axis=(0, 2))
        mirrored = mirrored and np.array_equal(part, part[:, ::-1])
        for k in np.flatnonzero(same):
            if len(distinct[k]) <= DISTINCT:
                distinct[k].update(np.unique(part[:, k])[: DISTINCT + 1].tolist())
    return [] if mirrored else [int(k) for k in np.flatnonzero(same) if len(distinct[k]) > DISTINCT]
