"""Whether a pose, a scaled model, joint moments and a functional joint agree with what was recorded.

No noise is stated of markers: what is advised stands in its place, and what no subject reaches contradicts the data.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Protocol, runtime_checkable

import numpy as np

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.motion.marker_tasks import FAR, MarkerErrors, MarkerLimits
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.functional_joint import JointPoints
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.dynamics.loads_on_bodies import MisplacedLoad
from geocontact.dynamics.residuals import GeneralisedForces, force_residual, moment_residual
from geocontact.identify.goodness_of_fit import AT_BOUND, MUCH, Doubt, GoodnessOfFit, of_r2, of_range

OFTEN = 0.05
"""Share of the frames on the end of its range from which an angle is doubtful."""
AT_TIMES = 0.05
"""Share of the time from which the residual force is spoken of by itself: a foot whose plate is missing, a cut-off."""
HEAVY = 1.0 / 3.0
"""Share of the weight: a residual force above it is no error of masses or accelerations, a load is missing or wrong."""
SLIDING = 0.01
"""m of root mean square that skin slides over bone, up to which no residual is compared with another model."""
LONGEST = 1.0
"""m between a joint and the markers of its segment; no segment is that long."""


@runtime_checkable
class FittedSegments(Protocol):
    """What was fitted in place of markers."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of what was compared."""

    def doubts(self) -> Iterable[Doubt]:
        """What does not agree with the model."""


def goodness_of_poses(
    found: Poses, model: Multibody, limits: MarkerLimits, segments: FittedSegments | None = None
) -> GoodnessOfFit:
    """Markers beside what is advised, angles beside their range, frames beside what markers determine.

    `segments` stand in place of the markers where these were recorded.
    """
    own = of_markers(MarkerErrors.of(found), limits) if segments is None else segments.doubts()
    doubts = [*own, *of_ends(found, model)]
    unsettled = float(np.mean(~found.settled))
    doubts += of_range("the search for the pose did not converge for", unsettled)
    lost = float(np.mean(~np.isfinite(found.values).all(axis=1)))
    few = f"too few {'markers' if segments is None else 'segments'} determine the coordinates for"
    doubts += [Doubt(each.what, False) for each in of_range(few, lost)]
    return GoodnessOfFit(tuple(doubts), (*(found.markers if segments is None else segments.names), *found.names))


def of_markers(errors: MarkerErrors, limits: MarkerLimits) -> Iterable[Doubt]:
    """A doubt for markers that are farther from the model than is advised."""
    if not errors.within(limits):
        yield Doubt(f"markers are {errors.words(limits)}", errors.rms > FAR, errors.rms / limits.rms)


def of_ends(found: Poses, model: Multibody) -> Iterable[Doubt]:
    """A doubt for every coordinate that the markers press against the end of its range; locked ones stay there."""
    for c, values, known in zip(model.coordinates, found.values.T, found.determined.T, strict=True):
        if c.locked or not c.clamped or not known.any():
            continue
        low, high = c.limits
        on = np.minimum(np.abs(values - low), np.abs(values - high)) <= AT_BOUND * (high - low)
        share = float(np.mean(on[known]))
        if share >= OFTEN:
            yield Doubt(f"{c.name} is on the end of the model's range for {share:.0%} of the time", False, share)


def goodness_of_loads(forces: GeneralisedForces, said: str, misplaced: list[MisplacedLoad]) -> GoodnessOfFit:
    """Residuals at the ground beside what Hicks et al. advise, in words `said`; loads beside the bodies they act on."""
    doubts = []
    if force_residual(forces).too_large or moment_residual(forces).too_large:
        doubts.append(Doubt(said, False, force_residual(forces).share))
    off = forces.residual_forces > HEAVY * forces.model.weight
    if np.mean(off) >= AT_TIMES:
        large = tuple(of_range("the residual force exceeds a third of the weight for", float(np.mean(off))))
        doubts += large
        for doubt in large:
            reserve(f"{doubt.what}: is a plate missing, or are clock, mass or cut-off others?")
    turned = forces.residual_moments > HEAVY * forces.model.weight * forces.height
    if np.mean(turned) >= MUCH:
        what = "the residual moment exceeds a third of weight × height of the mass centre for"
        doubts += of_range(what, float(np.mean(turned)))
    for load in misplaced:
        away = f"{load.distance:.2f} m from it and {load.nearest_distance:.2f} m from {load.nearest}"
        other = _without_side(load.body) == _without_side(load.nearest)  # a worn device may press anywhere
        doubts.append(Doubt(f"the load on {load.body} acts {away}", other, load.distance))
    return GoodnessOfFit(tuple(doubts), ("residual force", "residual moment", "places of the loads"))


def _without_side(body: str) -> str:
    """Name of a body without its side: calcn_r, left_foot."""
    return re.sub(r"(^|_)(right|left|r|l)(?=_|$)", "", body.lower())


def goodness_of_joint(points: JointPoints, spread: float, off: tuple[float, float], halves: float) -> GoodnessOfFit:
    """Residual of a joint beside skin and beside no joint at all, segments beside rigid ones, halves of the trial.

    Parameters
    ----------
    spread
        Root mean square by which the segments move away from and towards each other [m], without any joint.
    off
        Markers of either segment from a rigid one [m], root mean square.
    halves
        Distance of the joints of two halves of the trial [m].
    """
    doubts = [*_of_length("the residual between the segments is", points.rms, 2.0 * SLIDING)]
    if points.rms > SLIDING:
        doubts += of_r2("distance of the segments with a joint in common", 1.0 - (points.rms / spread) ** 2)
    for which, size in zip(("first", "second"), off, strict=True):
        doubts += _of_length(f"markers of the {which} segment are off a rigid one by", size, SLIDING)
    doubts += _of_length("joints of two halves of the trial are apart by", halves, 2.0 * SLIDING, 2.0 * FAR)
    for which, places in (("first", points.first), ("second", points.second)):
        far = float(np.linalg.norm(places.mean(axis=0)))
        if far > LONGEST:
            doubts.append(Doubt(f"the joint is {far:.1f} m from the markers of the {which} segment", True, far))
    return GoodnessOfFit(tuple(doubts), ("residual", "rigid segments", "halves", "distance"))


def _of_length(what: str, size: float, doubtful: float, contradicts: float = FAR) -> Iterable[Doubt]:
    """A doubt for a length [m] above one limit, which contradicts above the other."""
    if size > doubtful:
        yield Doubt(f"{what} {1e3 * size:.0f} mm", size > contradicts, size / doubtful)
