"""Bodies that never come near each other, lift off, or overlap: how far, in which frame, and what to check."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion

OVERLAP = 1e-3  # m; as much as fluoroscopy and optical tracking err by across a joint
DIGITS = 6  # of a depth in m that count: further ones are rounding, which differs with the place in the frame
NEAR = 20e-3  # m; bodies that never come this close are a mistake in the input
PLACES = "where each mesh sits in its body (`place_moving`, `place_fixed`)"


def refuse_strangers(e: AreaEvolution, motion: Motion, o: AreaOptions) -> None:
    """InputError for bodies that are far apart in every frame."""
    closest = float(e.min_distance.min())
    if closest <= NEAR:
        return
    remedy = f"check unit, frames and direction: {PLACES}, the motion's axes, which body moves"
    if o.osim is not None:
        remedy = f"wrong direction? try `moving_body` {'child' if o.moving_body == 'parent' else 'parent'}"
    what = f"bodies are {closest * 1e3:.0f} mm apart in every frame"
    raise InputError("", "", what, f"{remedy} (they are nearest in {_nearest(e, motion)})")


def warn_of_no_contact(record: Record, e: AreaEvolution, motion: Motion, name: str) -> None:
    """A reservation where FIXED has no contact in any frame, even within the largest threshold."""
    if e.fixed.area.max() > 0.0:
        return
    largest, closest = max(e.thresholds), float(e.min_distance.min())
    line = _of(name)
    line += f"nothing of FIXED is within {largest * 1e3:g} mm in any frame: "
    line += f"the least distance of the bodies is {closest * 1e3:.3g} mm, in {_nearest(e, motion)}"
    check = f"check unit, {PLACES}, the motion's axes, which body moves, and the threshold"
    if closest <= largest:
        check = "the faces that count are elsewhere, check `region`"
    record.warn(f"{line}; {check}")


def warn_of_lift_off(record: Record, e: AreaEvolution, motion: Motion, name: str) -> None:
    """A reservation where FIXED has contact in some frames and in others has none."""
    without = e.fixed.area[:, int(np.argmax(e.thresholds))] <= 0.0
    if not without.any() or without.all():
        return
    frame = int(np.argmax(e.min_distance))
    record.warn(
        f"{_of(name)}{int(without.sum())} of {len(without)} frames have nothing within {max(e.thresholds) * 1e3:g} mm; "
        f"the bodies are farthest apart, {e.min_distance[frame] * 1e3:.3g} mm, in {_frame(frame, motion)}; "
        "if they should touch, are MOVING and FIXED exchanged, or is a row of the motion wrong?"
    )


def warn_of_overlap(record: Record, e: AreaEvolution, motion: Motion, name: str) -> None:
    """A reservation where one body is farther inside the other than measured poses of rigid bodies bring it."""
    depth = -float(e.min_distance.min())
    if round(depth, DIGITS) >= OVERLAP:
        record.warn(
            f"{_of(name)}the bodies overlap, by {depth * 1e3:.2f} mm at most, in {_nearest(e, motion)}; "
            f"rigid ones do not: check {PLACES}, the order of rotations, "
            "that quaternions have the scalar first, and which body moves"
        )


def least_distance(e: AreaEvolution, motion: Motion, name: str) -> str:
    """How near the bodies come, in which frame, and what the sign of a distance says."""
    sign = "unsigned: overlap cannot be told" if e.signed == "none" else "signed: negative is overlap"
    least = round(float(e.min_distance.min()) * 1e3, 3) + 0.0  # no -0
    return f"{_of(name)}least distance {least:g} mm in {_nearest(e, motion)} ({sign})"


def _of(name: str) -> str:
    return f"{name}: " if name else ""


def _nearest(e: AreaEvolution, motion: Motion) -> str:
    """Frame of the least distance, for people: "frame 12 of 101, 0.11 s"."""
    return _frame(int(np.argmin(e.min_distance)), motion)


def _frame(frame: int, motion: Motion) -> str:
    return f"frame {frame + 1} of {len(motion)}, {motion.course.at(frame)}"
