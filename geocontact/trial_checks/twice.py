"""What is a copy of something else: a recording given twice, a column of a marker or a coordinate that is another's.

Noise never repeats, so that equal values, sample by sample, are no chance. These checks stand before all others: what a
copy contradicts besides is no cause.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.trial_checks.recorded import Check, Contradiction, TrialInputs

FEWEST = 5
"""Samples from which two recordings that are alike are no chance."""
STILL_FOR, SAME = 10, 1e-6
"""Frames in which two markers are at one place, and m that are the same place, no digit of a file changing."""
LOOKED_AT = 256
"""Frames, evenly spread, in which markers are compared before any two are compared all along."""
TOES = "mtp"
"""Coordinates that OpenCap moves alike on both sides."""
MOVES = (1e-2, 1e-3)
"""rad and m by which a coordinate changes that is looked at: a model holds others at one value."""
STRAIGHT, EVEN, KINK, MOSTLY_EVEN = 10, 3e-5, 1.5e-3, 0.75
"""Frames of a straight line at one speed; m, of its second differences, those of places rounded to 0.01 mm, and of
those at its ends, noise of cameras being 0.1 mm and more; share of such frames in a course that a model made."""
FEW = 64
"""Samples by which a course that is even along x is judged in all three directions, before every frame is."""


def same_recordings(recordings: Mapping[str, Float[np.ndarray, "*shape"]]) -> list[tuple[str, str]]:
    """Names of two recordings that have the same values, sample by sample, whatever their times; noise never does."""
    return [
        (first, second)
        for first, second in combinations(recordings, 2)
        if len(recordings[first]) >= FEWEST
        and recordings[first].shape == recordings[second].shape
        and np.array_equal(recordings[first], recordings[second], equal_nan=True)
    ]


def markers_at_one_place(places: Float[np.ndarray, "n m 3"], fewest: int) -> list[tuple[int, int]]:
    """Two markers that are at one place in each frame in which both are seen, `fewest` frames at least.

    In some frames all markers are sorted along x, and neighbours compared. Only two that are always together there,
    or that no such frame shows both of, are compared all along: the work grows as markers times their logarithm.
    """
    some = places[:: max(1, len(places) // LOOKED_AT)]
    shown = np.isfinite(some).all(axis=2).astype(np.float32)
    common = np.rint(shown.T @ shown).astype(int)
    together = np.zeros_like(common)
    order = np.argsort(np.where(shown > 0, some[:, :, 0], np.inf), axis=1)
    ordered = np.take_along_axis(some, order[:, :, None], axis=1)
    for by in range(1, places.shape[1]):
        row, at = np.nonzero(np.abs(ordered[:, by:, 0] - ordered[:, :-by, 0]) < SAME)
        if not len(row):
            break
        near = (np.abs(ordered[row, at + by] - ordered[row, at]) < SAME).all(axis=1)
        ends = np.sort([order[row, at][near], order[row, at + by][near]], axis=0)
        np.add.at(together, tuple(ends), 1)
    one, other = np.nonzero(np.triu(together == common, 1))
    unseen = common[one, other] == 0
    if unseen.any():
        of = np.unique([one[unseen], other[unseen]])
        whole = np.isfinite(places[:, of]).all(axis=2).astype(np.float32)
        enough = np.rint(whole.T @ whole) >= fewest
        keep = ~unseen
        keep[unseen] = enough[np.searchsorted(of, one[unseen]), np.searchsorted(of, other[unseen])]
        one, other = one[keep], other[keep]
    return [(int(i), int(j)) for i, j in zip(one, other, strict=True) if _together(places[:, i], places[:, j], fewest)]


def _together(one: Float[np.ndarray, "n 3"], other: Float[np.ndarray, "n 3"], fewest: int) -> bool:
    apart = np.abs(one - other).max(axis=1)
    apart = apart[np.isfinite(apart)]
    return len(apart) >= fewest and bool((apart < SAME).all())


def held_steps(places: Float[np.ndarray, "n m 3"], fewest: int) -> dict[int, Bool[np.ndarray, " n-1"]]:
    """For each marker that stays at one place for `fewest` steps or more: the steps from frame to frame without motion.

    Every `fewest`-th step is looked at first, which is one of every run that is so long.
    """
    at = np.arange(0, len(places) - 1, fewest)
    held = np.abs(places[at + 1, :, 0] - places[at, :, 0]) < SAME
    row, marker = np.nonzero(held)
    still = (np.abs(places[at[row] + 1, marker] - places[at[row], marker]) < SAME).all(axis=1)
    found = {}
    for k in np.unique(marker[still]):
        same = np.all(np.abs(np.diff(places[:, k], axis=0)) < SAME, axis=1)
        edges = np.flatnonzero(np.diff(np.r_[False, same, False].astype(int)))
        if len(edges) and (edges[1::2] - edges[::2]).max() >= fewest:
            found[int(k)] = same
    return found


def _with_lines(places: Float[np.ndarray, "n m 3"]) -> list[int]:
    """Markers with `STRAIGHT` even samples on end; every `STRAIGHT`-th is looked at first, then those beside it."""

    def even(at: Int[np.ndarray, "*some"], marker: Int[np.ndarray, "*some"]) -> Bool[np.ndarray, "*some"]:
        bent = places[at, marker] - 2.0 * places[at + 1, marker] + places[at + 2, marker]
        return np.asarray(np.linalg.norm(bent, axis=-1) < EVEN)

    at = np.arange(0, len(places) - 2, STRAIGHT)
    x = places[:, :, 0]
    row, marker = np.nonzero(np.abs(x[at] - 2.0 * x[at + 1] + x[at + 2]) < EVEN)
    smooth = np.flatnonzero(np.bincount(marker, minlength=places.shape[1]) > MOSTLY_EVEN * len(at))
    few = at[:: max(len(at) // FEW, 1)]
    share = even(np.repeat(few[:, None], len(smooth), axis=1), np.tile(smooth, (len(few), 1))).mean(axis=0)
    kept = ~np.isin(marker, smooth[share > 0.5 * (1.0 + MOSTLY_EVEN)])  # those that a model made stay out
    row, marker = row[kept], marker[kept]
    there = even(at[row], marker)
    first, marker = at[row[there]], marker[there]
    beside = first[:, None] + np.arange(1 - STRAIGHT, STRAIGHT)
    inside = (beside >= 0) & (beside < len(places) - 2)
    along = even(np.clip(beside, 0, len(places) - 3), np.broadcast_to(marker[:, None], beside.shape)) & inside
    runs = np.any(np.all(np.lib.stride_tricks.sliding_window_view(along, STRAIGHT, axis=1), axis=2), axis=1)
    return [int(k) for k in np.unique(marker[runs])]


def straight_gaps(trial: TrialInputs) -> Iterator[Contradiction]:
    """A marker that goes along a straight line at one speed, with a kink where it begins and where it ends."""
    seen = trial.markers
    if seen is None or len(seen) < STRAIGHT + 2:
        return
    for k in _with_lines(seen.positions):
        name = seen.names[k]
        second = np.linalg.norm(np.diff(seen.positions[:, k], n=2, axis=0), axis=1)
        bent = np.nan_to_num(second, nan=np.inf)
        even = bent < EVEN
        if even.mean() > MOSTLY_EVEN:
            continue
        edges = np.flatnonzero(np.diff(np.r_[False, even, False].astype(int)))
        start, stop = edges[::2], edges[1::2]
        kinks = bent[np.stack([np.maximum(start - 1, 0), np.minimum(stop, len(bent) - 1)])]
        lines = np.flatnonzero((stop - start >= STRAIGHT) & np.isfinite(kinks).all(axis=0) & (kinks.min(axis=0) > KINK))
        if len(lines):
            first, last = seen.time[start[lines[0]]], seen.time[stop[lines[0]] + 1]
            what = f"{name} goes straight on at one speed from {first:.2f} to {last:.2f} s"
            yield Contradiction(seen.source, "", what, "is a gap filled by a straight line? leave gaps empty")


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
        for one, other in markers_at_one_place(each.positions, STILL_FOR):
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
        if c.name not in driven
        and not c.name.startswith(TOES)
        and np.ptp(moved.values[:, k]) > MOVES[c.kind != "rotational"]
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
