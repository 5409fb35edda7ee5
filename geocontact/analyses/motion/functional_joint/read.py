"""Markers of two segments, while the joint moves and while the subject stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.analyses.motion.functional_joint.options import JointOptions
from geocontact.analyses.motion.markers import markers_given, renamed_as_told, turn_of
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.functional_joint import FEWEST, seen_together, segment_poses
from geocontact.io.text.tables import listed
from geocontact.trial_checks.recorded import TrialInputs

SHORTEST = 0.3
"""s that a movement of a joint through its range lasts at least."""
SIGHT = "name markers that one frame shows all of, or give `static`"


@dataclass(frozen=True, eq=False)
class Segment:
    """A cluster of markers.

    Parameters
    ----------
    template
        Their places [m] about their mean, in the laboratory's axes: while standing, or in the first whole frame.
    origin
        That mean in the laboratory [m].
    """

    names: tuple[str, ...]
    template: Float[np.ndarray, "m 3"]
    origin: Float[np.ndarray, " 3"]


@dataclass(frozen=True, eq=False)
class MovedPair:
    """Two segments in the frames of the trial that show both.

    Parameters
    ----------
    shown
        The markers that the joint is written beside: the standing trial, else the trial.
    time
        Of the frames [s].
    first_poses, second_poses
        In the laboratory.
    off
        How far markers of either segment are from a rigid one [m], root mean square.
    """

    shown: MarkerTrajectories
    time: Float[np.ndarray, " t"]
    first: Segment
    second: Segment
    first_poses: RigidTransform
    second_poses: RigidTransform
    off: tuple[float, float]

    def near(self, names: tuple[str, ...] | None) -> Float[np.ndarray, " 3"]:
        """Middle of markers where the first segment's template stands [m], in its frame; of both segments for None."""
        if names is None:
            both = np.concatenate([segment.origin + segment.template for segment in (self.first, self.second)])
            return np.asarray(both.mean(axis=0) - self.first.origin)
        return np.asarray(means_of(self.shown, names, "`near`").mean(axis=0) - self.first.origin)


def read(o: JointOptions) -> MovedPair:
    """Everything the options name."""
    seen = renamed_as_told(markers_given(o.trial, o.axes, o.time, o.c3d_unit), o.markers_map)
    add_input("trial", o.trial, frames=len(seen), markers=len(seen.names))
    still = None
    if o.static is not None:
        still = renamed_as_told(markers_given(o.static, o.axes, None, o.c3d_unit), o.markers_map)
        add_input("`static`", o.static, frames=len(still), markers=len(still.names))
    check_trial(TrialInputs(markers=seen, standing=still, turn=turn_of(o.axes)))
    first, second = marker_list(o.first), marker_list(o.second)
    both = [name for name in first if name in second]
    if both:
        what = f"{listed(tuple(both))} is of both segments"
        raise InputError("", "`second`", what, "give each segment markers of its own")
    segments = _segment(seen, still, first, "`first`"), _segment(seen, still, second, "`second`")
    tracks = []
    for segment, option in zip(segments, ("`first`", "`second`"), strict=True):
        try:
            tracks.append(segment_poses(seen.of(segment.names), segment.template))
        except ValueError as error:
            raise InputError(seen.source, option, str(error), "name other markers of that segment") from error
    one, other, together = seen_together(tracks[0][:2], tracks[1][:2])
    if not together.any():
        raise InputError(seen.source, "", "no frame shows both segments", "name markers that are visible together")
    _doubt_span(seen.source, seen.time[together])
    off = tuple(float(np.sqrt(np.nanmean(track[2] ** 2))) for track in tracks)
    return MovedPair(still or seen, seen.time[together], *segments, one, other, (off[0], off[1]))


def _doubt_span(source: str, time: Float[np.ndarray, " t"]) -> None:
    span = float(time[-1] - time[0])
    if span < SHORTEST:
        what = f"{len(time)} frames over {span:.2g} s are no movement through a joint's range"
        reserve(f"{source}: {what}: are `time` and the rate right?", cause=True)


def marker_list(text: str) -> tuple[str, ...]:
    """Names with commas between them."""
    return tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))


def _segment(
    seen: MarkerTrajectories, still: MarkerTrajectories | None, names: tuple[str, ...], option: str
) -> Segment:
    for trial in (seen, *([] if still is None else [still])):
        _require(trial, names, option)
    if len(names) < FEWEST:
        raise InputError(
            seen.source, option, f"{len(names)} markers do not determine a pose", f"name {FEWEST} at the least"
        )
    if still is not None:
        places = means_of(still, names, option)
    else:
        tracks = seen.of(names)
        whole = np.flatnonzero(np.isfinite(tracks).all(axis=(1, 2)))
        if not len(whole):
            raise InputError(seen.source, option, "no frame shows all these markers", SIGHT)
        places = tracks[whole[0]]
    return Segment(names, places - places.mean(axis=0), places.mean(axis=0))


def means_of(trial: MarkerTrajectories, names: tuple[str, ...], option: str) -> Float[np.ndarray, "m 3"]:
    """Mean place of each marker over the frames that show it [m]; InputError for one that no frame shows."""
    _require(trial, names, option)
    tracks = trial.of(names)
    unseen = [name for k, name in enumerate(names) if not np.isfinite(tracks[:, k]).all(axis=1).any()]
    if unseen:
        raise InputError(trial.source, option, f"{unseen[0]} is visible in no frame", "leave it out")
    return np.asarray(np.nanmean(tracks, axis=0))


def _require(trial: MarkerTrajectories, names: tuple[str, ...], option: str) -> None:
    missing = [name for name in names if name not in trial.names]
    if missing:
        raise InputError(trial.source, option, f"no marker {missing[0]}", f"recorded are {listed(trial.names, 60)}")
