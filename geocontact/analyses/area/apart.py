"""Bodies that never come near each other: how close they come, in which frame, and what to check."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion

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
    line = f"{name}: " if name else ""
    line += f"nothing of FIXED is within {largest * 1e3:g} mm in any frame: "
    line += f"the least distance of the bodies is {closest * 1e3:.3g} mm, in {_nearest(e, motion)}"
    check = f"check unit, {PLACES}, the motion's axes, which body moves, and the threshold"
    if closest <= largest:
        check = "the faces that count are elsewhere, check `region`"
    record.warn(f"{line}; {check}")


def _nearest(e: AreaEvolution, motion: Motion) -> str:
    """Frame of the least distance, for people: "frame 12 of 101, 0.11 s"."""
    frame = int(np.argmin(e.min_distance))
    return f"frame {frame + 1} of {len(motion)}, {motion.course.at(frame)}"
