"""Motion of pelvis and leg from a walking trial: inverse kinematics of the standing leg, gaps filled, filtered."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.from_markers.marker_names import BODIES, MAP, WALKING
from geocontact.below_knee_prosthesis.model.leg import Leg
from geocontact.below_knee_prosthesis.model.leg_motion import LegMotion
from geocontact.below_knee_prosthesis.model.leg_tree import RECORDED, recorded_tree
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_tasks import MarkerTasks
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.dynamics.functional_joint import FunctionalCentre, functional_centre
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.segment_poses import segment_poses
from geocontact.dynamics.tree import tree_of
from geocontact.identify.signals.filled import filled_and_smoothed

SLOWEST = 0.2
"""m/s; a pelvis that moves forward less does not walk along x."""


@dataclass(frozen=True, eq=False)
class Walked:
    """A motion and how well the markers fit it, root mean square over markers that were seen [m]."""

    motion: LegMotion
    off: Float[np.ndarray, " t"]


def walked(seen: MarkerTrajectories, leg: Leg, *, cutoff: float | None, gap_limit: float) -> Walked:
    """Coordinates of a right leg; InputError where the markers do not tell them.

    Parameters
    ----------
    cutoff
        Of a zero-lag low-pass of the coordinates [Hz]; None for none.
    gap_limit
        Longest gap that is bridged [s].
    """
    missing = [name for name in WALKING if name not in seen.names]
    if missing:
        raise InputError(seen.source, "", f"no marker {', '.join(missing)}", MAP)
    tree = tree_of(recorded_tree(leg))
    try:
        found: Poses = inverse_kinematics(tree, seen, MarkerTasks(dict.fromkeys(WALKING, 1.0)))
        columns = [found.names.index(name) for name in RECORDED]
        values = found.values[:, columns]
        time, smooth = filled_and_smoothed(seen.time, values, cutoff=cutoff, longest_gap=gap_limit)
    except ValueError as error:
        raise InputError(
            seen.source, "", str(error), "fill the gaps, or give another `cutoff` or `gap_limit`"
        ) from error
    motion = LegMotion(leg, time, smooth)
    speed = float((motion.of("pelvis_tx")[-1] - motion.of("pelvis_tx")[0]) / (time[-1] - time[0]))
    if speed < SLOWEST:
        what = f"the pelvis moves along x with {speed:.2f} m/s"
        raise InputError(seen.source, "", what, "x must point where the person walks: turn the file with `axes`")
    with np.errstate(invalid="ignore"):
        off = np.sqrt(np.nanmean(found.distances**2, axis=1))
    return Walked(motion, off)


def functional_hip(seen: MarkerTrajectories, pelvis: Float[np.ndarray, "4 3"]) -> FunctionalCentre:
    """Hip centre in the pelvis' frame, in which its markers have these places [m]; InputError where it is not told."""
    places = [seen.of(BODIES[body]) for body in ("pelvis", "thigh")]
    try:
        one, known, _ = segment_poses(places[0], pelvis)
        other, known_too, _ = segment_poses(places[1])
        both = known & known_too
        return functional_centre(one[both[known]], other[both[known_too]])
    except ValueError as error:
        raise InputError(
            seen.source, "`functional`", str(error), "swing the leg in all directions, markers seen"
        ) from error
