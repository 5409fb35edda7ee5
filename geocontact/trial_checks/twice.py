"""What is a copy of something else: a recording given twice, a column of a marker or a coordinate that is another's.

Noise never repeats, so that equal values, sample by sample, are no chance. These checks stand before all others: what a
copy contradicts besides is no cause.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np
from jaxtyping import Float

from geocontact.trial_checks.recorded import Check, Contradiction, TrialInputs

FEWEST = 5
"""Samples from which two recordings that are alike are no chance."""
STILL_FOR, SAME = 10, 1e-6
"""Frames in which two markers are at one place, and m that are the same place, no digit of a file changing."""
MOVES = (1e-2, 1e-3)
"""rad and m by which a coordinate changes that is looked at: a model holds others at one value."""


def same_recordings(recordings: Mapping[str, Float[np.ndarray, "*shape"]]) -> list[tuple[str, str]]:
    """Names of two recordings that have the same values, sample by sample, whatever their times; noise never does."""
    return [
        (first, second)
        for first, second in combinations(recordings, 2)
        if len(recordings[first]) >= FEWEST
        and recordings[first].shape == recordings[second].shape
        and np.array_equal(recordings[first], recordings[second], equal_nan=True)
    ]


def standing_twice(trial: TrialInputs) -> Iterator[Contradiction]:
    """The trial against the standing trial, frame by frame."""
    still, moving = trial.standing, trial.markers
    if still is None or moving is None:
        return
    if same_recordings({"still": still.positions, "moving": moving.positions}):
        what = "its markers are those of the standing trial, frame by frame"
        yield Contradiction(moving.source, "", what, "give two different recordings", refuse=True)


def markers_twice(trial: TrialInputs) -> Iterator[Contradiction]:
    """Two markers of one recording at one place all along."""
    for each in trial.recordings:
        for one, other in combinations(range(len(each.names)), 2):
            apart = np.abs(each.positions[:, one] - each.positions[:, other]).max(axis=1)
            if (apart < SAME).sum() >= STILL_FOR and (apart[np.isfinite(apart)] < SAME).all():
                what = f"{each.names[other]} is where {each.names[one]} is, in every frame"
                yield Contradiction(each.source, "", what, "is a column copied, or one marker labelled twice?")


def coordinates_twice(trial: TrialInputs) -> Iterator[Contradiction]:
    """Two coordinates of a model that have one course, sample by sample.

    Of a movement in which right and left are alike in every pair, as in one that was computed, nothing is said, nor of
    coordinates that follow others.
    """
    moved = trial.moved
    if moved is None:
        return
    driven = {coupler.dependent for coupler in moved.model.couplers}
    own = {
        c.name: moved.values[:, k]
        for k, c in enumerate(moved.model.coordinates)
        if c.name not in driven and np.ptp(moved.values[:, k]) > MOVES[c.kind != "rotational"]
    }
    same = same_recordings(own)
    both = [
        (name, name.replace("right", "left") if "right" in name else re.sub("_r(?=_|$)", "_l", name)) for name in own
    ]
    sides = [pair for pair in both if pair[0] != pair[1] and pair[1] in own]
    if len(sides) > 1 and all(pair in same or pair[::-1] in same for pair in sides):
        return
    for first, second in same:
        what = f"{second} has the values of {first}, sample by sample"
        yield Contradiction(moved.source, "", what, "is a column copied? loads, markers and residuals follow from it")


COPY_CHECKS = (
    Check(
        "standing trial twice",
        "markers of the trial with those of the standing trial",
        "all equal",
        standing_twice,
    ),
    Check(
        "one marker twice",
        "places of markers with each other",
        f"equal in all frames, {STILL_FOR} or more",
        markers_twice,
    ),
    Check(
        "one coordinate twice",
        "courses of coordinates with each other, unless all of right and left are alike",
        "equal in all samples",
        coordinates_twice,
    ),
)
"""Checks for copies."""
