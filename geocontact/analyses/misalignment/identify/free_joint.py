"""What recordings with a free compensation joint tell: ends of its stroke, stiffness, and the scale of the lengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geocontact.analyses.misalignment.identify.fitted import require_bins
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.axis_misalignment.bins import FORCE, Binned, binned
from geocontact.axis_misalignment.compensation import (
    DisplacementScale,
    RecordedStroke,
    Stiffness,
    bin_means,
    displacement_scale,
    recorded_stroke,
    stiffness_by_displacement,
)
from geocontact.axis_misalignment.least_squares import ElbowFit
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.intervals.bin_tests import BinPair, BinTest, between_bins, between_neighbours

AGAINST = 3.0  # standard errors below 0 from which a stiffness is a turned sign


@dataclass(frozen=True, eq=False)
class Free:
    """What the recordings with a free joint tell.

    Parameters
    ----------
    boxes
        Their samples in wide bins.
    stiffness
        Locked force over the free joint's displacement; None where that is not told.
    scale
        What the displacement tells of the lengths; None without a standard error.
    """

    recordings: Sequence[ElbowRecording]
    boxes: Binned
    stroke: RecordedStroke
    stiffness: Stiffness | None
    scale: DisplacementScale | None
    bins_differ: BinTest | None
    neighbours: Sequence[BinPair]
    rotary_free: bool


def free_joint(o: IdentifyOptions, recordings: Sequence[ElbowRecording], locked: Binned) -> Free | None:
    """Ends of the stroke, stiffness and scale from trials with a free joint beside locked ones; None without any."""
    if not recordings or o.unlocked is None:
        return None
    data = binned(recordings, o.bin)
    require_bins(o.unlocked, data)
    stroke = recorded_stroke(bin_means(data))
    if stroke is None:
        what = "the compensation joint slides over fewer than three bins"
        raise InputError(o.unlocked[0], "", what, "was it free?")
    boxes = binned(recordings, o.box)
    trials = [bin_means(data.only(trial)) for trial in range(len(data.names))]
    return Free(
        recordings=recordings,
        boxes=boxes,
        stroke=stroke,
        stiffness=None if o.rotary_free else _stiffness(o, locked, stroke),
        scale=displacement_scale(trials, stroke, o.bin, rotary_free=o.rotary_free),
        bins_differ=between_bins(boxes.visits, FORCE),
        neighbours=between_neighbours(boxes.visits, FORCE),
        rotary_free=o.rotary_free,
    )


def stroke_stiffness(e: ElbowFit, free: Free) -> float | None:
    """k that says how much stroke is wanting [N/m]: by displacement, else as fitted; None where the scale is free."""
    if free.stiffness is not None and free.stiffness.value > 0.0:
        return free.stiffness.value
    return None if e.problem.scale_free else e.named["k"]


def _stiffness(o: IdentifyOptions, locked: Binned, stroke: RecordedStroke) -> Stiffness | None:
    each = [bin_means(locked.only(trial)) for trial in range(len(locked.names))]
    found = stiffness_by_displacement(each, stroke, o.bin)
    if found is not None and found.value + AGAINST * np.nan_to_num(found.error) < 0.0:
        what = f"displacement and locked force run against each other ({found.value:.4g} N/m)"
        remedy = "one of them has its sign turned: `map` displacement=-… or force=-…"
        raise InputError((o.unlocked or ("",))[0], "", what, remedy)
    return found
