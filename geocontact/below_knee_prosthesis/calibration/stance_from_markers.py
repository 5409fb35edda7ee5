"""A recorded stance from markers on the socket and a plate: the foot moves as the cluster does."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.calibration.recorded_stance import Errors, RecordedStance
from geocontact.below_knee_prosthesis.clocks import lowest_sphere
from geocontact.below_knee_prosthesis.from_markers.marker_names import MAP
from geocontact.below_knee_prosthesis.model.leg import Leg
from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import share_of_foot
from geocontact.below_knee_prosthesis.stance_errors import PlateStance, at_times, longest_stance
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Marker
from geocontact.dynamics.segment_poses import segment_poses
from geocontact.identify.signals.filled import filled_and_smoothed
from geocontact.loads.pose_rate import pose_rate
from geocontact.loads.sphere_set import SphereSet

RATE, AROUND = 200.0, 0.04
"""Hz, and s before and after the stance that are taken along."""
USUAL = Errors()
FAR = 0.03
"""m; markers of a segment that are further from where they are while standing are others."""
SMOOTH = 5
"""Degree of the splines through the markers."""


def stance_from_markers(
    seen: MarkerTrajectories,
    leg: Leg,
    plate: PlateStance,
    fulcrum: float,
    length: float,
    *,
    cutoff: float | None,
    gap_limit: float,
    errors: Errors = USUAL,
) -> RecordedStance:
    """Of a right leg.

    Parameters
    ----------
    length
        Of the keel [m].
    cutoff
        Of a zero-lag low-pass of the markers [Hz]; the study's 6 Hz smooth the touch-down away.

    InputError where markers are missing or do not cover the stance on the plate.
    """
    span = longest_stance(plate.time, plate.force[:, 1])
    if span is None:
        raise InputError("", "plate", "it carries no whole stance", "give another plate")
    start, stop = max(span[0] - AROUND, float(seen.time[0])), min(span[1] + AROUND, float(seen.time[-1]))
    if start >= span[0] or stop <= span[1]:
        what = f"markers are from {seen.time[0]:.2f} to {seen.time[-1]:.2f} s, the stance from {span[0]:.2f} to"
        raise InputError(
            seen.source, "", f"{what} {span[1]:.2f} s", "markers must cover the stance; one clock for both"
        )
    time = start + np.arange(int((stop - start) * RATE) + 1) / RATE
    poses = keel_poses(seen, leg, time, cutoff, gap_limit)
    force, centre = (at_times(time, plate.time, each) for each in (plate.force, plate.centre))
    share = share_of_foot(poses, length, centre)
    return RecordedStance(time, poses, pose_rate(time, poses), fulcrum, force, share, leg.person.mass * GRAVITY, errors)


def recorded_heights(
    seen: MarkerTrajectories, leg: Leg, spheres: SphereSet, *, cutoff: float | None, gap_limit: float
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """The markers' times [s] and the height of the lowest sphere of a sole that does not bend [m]."""
    return seen.time, lowest_sphere(keel_poses(seen, leg, seen.time, cutoff, gap_limit), spheres)


def keel_poses(
    seen: MarkerTrajectories, leg: Leg, time: Float[np.ndarray, " t"], cutoff: float | None, gap_limit: float
) -> RigidTransform:
    """Poses of the keel's frame at some times [s], as the markers on the socket tell them; InputError where not."""
    socket = body_poses(seen, leg.markers, "shank", time, cutoff, gap_limit)
    return socket * RigidTransform.from_components(leg.keel, leg.turn)


def hip_centres(
    seen: MarkerTrajectories, leg: Leg, time: Float[np.ndarray, " t"], cutoff: float | None, gap_limit: float
) -> Float[np.ndarray, "t 3"]:
    """Centre of the hip at some times [m], as the markers on the pelvis tell it; InputError where they do not."""
    return np.asarray(body_poses(seen, leg.markers, "pelvis", time, cutoff, gap_limit).apply(leg.hip))


def body_poses(
    seen: MarkerTrajectories,
    markers: Sequence[Marker],
    body: str,
    time: Float[np.ndarray, " t"],
    cutoff: float | None,
    gap_limit: float,
) -> RigidTransform:
    """Poses of a body at some times [s], as those of a leg's markers that are fixed to it tell them.

    InputError where they do not.
    """
    by_name = {marker.name: marker.location for marker in markers if marker.body == body}
    names = tuple(by_name)
    missing = [name for name in names if name not in seen.names]
    if missing:
        raise InputError(seen.source, "", f"no marker {', '.join(missing)}", MAP)
    places = seen.of(names).reshape(len(seen.time), -1)
    try:
        even, smooth = filled_and_smoothed(seen.time, places, cutoff=cutoff, longest_gap=gap_limit)
    except ValueError as error:
        raise InputError(seen.source, "", str(error), "fill the gaps, or give another `gap_limit`") from error
    dense = make_interp_spline(even, smooth, k=SMOOTH)(time).reshape(len(time), -1, 3)
    found, _, off = segment_poses(dense, np.array(list(by_name.values())))
    middle = float(np.nanmedian(off))
    if middle > FAR:
        what = f"markers {', '.join(names)} are {1e3 * middle:.0f} mm from the standing ones in the median"
        raise InputError(seen.source, "", what, "the same person and markers? are left and right exchanged?")
    return found
