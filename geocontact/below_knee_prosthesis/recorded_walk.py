"""A person who walks on a foot, from markers and plates: leg and motion fitted to them, and the stance along it.

    walk = fitted_walk(standing, walking, Person(77.3), vsf_foot(), fulcrum_of("medium"), other_plate, plate=own_plate)
    stance = simulated_walk(walk, turns=6).stance

Everything is as of a right prosthesis: what was recorded of a left one is mirrored first (`from_markers.as_right`,
`from_markers.of_side`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.calibration.recorded_stance import keel_poses
from geocontact.below_knee_prosthesis.evaluation import PlateStance, longest_stance
from geocontact.below_knee_prosthesis.from_markers import Walked, standing_hip, standing_leg, walked
from geocontact.below_knee_prosthesis.from_model import ModelLeg
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import AS_STOOD, FootOffset, Leg, Person
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, LegMotion, recorded_tree
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket, limb_in_socket
from geocontact.below_knee_prosthesis.plate_checks import (
    LATE,
    lowest_sphere,
    part_of,
    require_covering,
    require_near_heel,
    require_one_clock,
    require_weight,
)
from geocontact.below_knee_prosthesis.simulate import GATE, Push, Stance, simulate_stance
from geocontact.below_knee_prosthesis.stance_model import FLOOR
from geocontact.contact.bushing import SOCKET, Bushing
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.functional_joint import FunctionalCentre
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Stairs

CUTOFF, GAP = 6.0, 0.2
"""Hz, of a zero-lag low-pass of the coordinates; s, longest gap that is bridged."""
FAR = 0.05
"""m; median distance of the markers from the standing leg that no person has who stood model for it."""
FOOT_CUTOFF = 15.0
"""Hz; of the markers that tell where the foot is, as in a calibration: 6 Hz smooth the touch-down away."""
BEFORE, AFTER = 0.12, 0.1
"""s; simulated before the plate's touch-down and after its toe-off, as far as the markers go."""
INSIDE = 2
"""Frames that are left out at both ends: the splines bend there."""


@dataclass(frozen=True, eq=False)
class SeenFoot:
    """Poses of the keel's frame by the markers on the socket, at their times [s]."""

    time: Float[np.ndarray, " t"]
    poses: RigidTransform


@dataclass(frozen=True, eq=False)
class Walk:
    """A person who walks on a foot, as of a right leg.

    Parameters
    ----------
    walked
        Recorded motion.
    ground
        That both feet walk on.
    fulcrum
        [m].
    push
        Of the other leg.
    plate
        Under the prosthetic foot; None where it is not known.
    cluster
        The foot by the markers on its socket.
    seen
        Markers that the motion was fitted to.
    hip
        Centre by a functional trial, in the pelvis' frame; None where it is that of the regression.
    cutoff, gap_limit
        That the motion was fitted with [Hz, s].
    around
        Swing around the stance on the plate that is simulated at least [s].
    """

    leg: Leg
    walked: Walked
    ground: HalfSpace | Stairs
    foot: VariableStiffnessFoot
    fulcrum: float
    push: Push
    plate: PlateStance | None
    cluster: SeenFoot
    seen: MarkerTrajectories
    hip: FunctionalCentre | None = None
    cutoff: float | None = CUTOFF
    gap_limit: float = GAP
    around: float = 0.0

    @property
    def off(self) -> float:
        """Distance of the markers from the standing leg, median over the frames [m]."""
        return float(np.nanmedian(self.walked.off))

    @property
    def span(self) -> tuple[float, float]:
        """From when to when it is simulated [s]: around the stance on the plate, else as far as the markers go."""
        time = self.walked.motion.time
        span = (float(time[INSIDE]), float(time[-1 - INSIDE]))
        seen = None if self.plate is None else longest_stance(self.plate.time, self.plate.force[:, 1])
        if seen is None:
            return span
        before, after = max(BEFORE, self.around), max(AFTER, self.around)
        return (max(span[0], seen[0] - before), min(span[1], seen[1] + after))


def fitted_walk(
    standing: MarkerTrajectories,
    seen: MarkerTrajectories,
    person: Person,
    foot: VariableStiffnessFoot,
    fulcrum: float,
    other: PlateStance,
    *,
    plate: PlateStance | None = None,
    stance: tuple[float, float] | None = None,
    moving: MarkerTrajectories | None = None,
    joints: ModelLeg | None = None,
    ground: HalfSpace | Stairs = FLOOR,
    offset: FootOffset = AS_STOOD,
    cutoff: float | None = CUTOFF,
    gap_limit: float = GAP,
    residual: float | None = None,
    around: float = 0.0,
) -> Walk:
    """The leg and the keel's place by a standing trial, its motion by a walking one.

    Parameters
    ----------
    standing, seen
        Markers while standing and while walking, x forward along the walk and y up.
    fulcrum
        [m].
    other, plate
        Plates under the intact foot, whose force stands for the other leg, and under the prosthetic one, where known.
    stance
        Touch-down and toe-off on `plate` by which it is tested [s]; by default of the longest stance.
    moving
        Markers of a functional trial, which tells the hip's centre better than the regression.
    joints
        Hip and knee of a model of the person, in place of those of the trials.
    ground
        That both feet walk on.
    offset
        The foot beside its standing trial.
    cutoff
        Of a zero-lag low-pass of the coordinates [Hz]; None for none.
    gap_limit
        Longest gap that is bridged [s].
    residual
        Length of the residual limb [m]; by default the person's share of the shank.
    around
        Swing around the stance on the plate that is simulated at least [s].

    InputError where markers are missing or do not fit the standing ones, and where a plate is not the person's, not
    under the foot, or on another clock.
    """
    hip = None if moving is None else standing_hip(standing, moving)
    centre = None if hip is None else hip.first
    given = (centre, None) if joints is None else (joints.hip, (joints.knee, joints.across))
    stood = standing_leg(standing, person, foot.keel, foot.record.below, *given)
    leg = (stood if residual is None else with_residual(stood, residual)).with_foot(offset)
    fit = walked(seen, leg, cutoff=cutoff, gap_limit=gap_limit)
    _require_fit(seen, fit)
    require_weight(other, person.mass * GRAVITY, "`other_plate`")
    require_covering(other, fit.motion.time, "both need one clock; cut with `time`")
    if plate is not None:
        _require_own(plate, fit.motion, foot, ground, stance)
    cluster = SeenFoot(seen.time, keel_poses(seen, leg, seen.time, FOOT_CUTOFF, gap_limit))
    push = Push(other.time, other.force)
    return Walk(leg, fit, ground, foot, fulcrum, push, plate, cluster, seen, hip, cutoff, gap_limit, around)


RESIDUAL = "`residual_length` or `residual_markers`"


def with_residual(leg: Leg, length: float) -> Leg:
    """With a residual limb of a length [m]; InputError where the shank is not longer."""
    try:
        return leg.with_residual(length)
    except ValueError as error:
        raise InputError("", RESIDUAL, str(error), "measure from the knee to the end of the limb") from error


def _require_fit(seen: MarkerTrajectories, fit: Walked) -> None:
    """InputError where the markers are too far from the standing leg."""
    off = float(np.nanmedian(fit.off))
    if off > FAR:
        what = f"markers are {1e3 * off:.0f} mm (median) away from the standing leg"
        raise InputError(seen.source, "", what, "the same person and markers? are left and right exchanged?")


def _require_own(
    plate: PlateStance,
    motion: LegMotion,
    foot: VariableStiffnessFoot,
    ground: HalfSpace | Stairs,
    stance: tuple[float, float] | None,
) -> None:
    """InputError where it is not the prosthetic foot that stands on the plate, by a stance or the longest one [s].

    Clocks are compared from the middle of the swing before to the middle of the one after where a stance is given.
    """
    leg = motion.leg
    require_weight(plate, leg.person.mass * GRAVITY)
    span = stance or longest_stance(plate.time, plate.force[:, 1])
    if span is None:
        what = f"{plate.name} carries no whole stance above {GATE:g} N"
        raise InputError(plate.source, "`plate`", what, "give another plate")
    start, stop = motion.time[[0, -1]]
    if span[0] < start + LATE or span[1] > stop:
        what = f"the stance on {plate.name} is from {span[0]:.2f} to {span[1]:.2f} s, the markers from {start:.2f} to"
        remedy = "markers must begin before touch-down and end after it"
        raise InputError(plate.source, "`plate`", f"{what} {stop:.2f} s", remedy)
    keel = recorded_tree(leg).poses(motion.values)["shank"] * RigidTransform.from_components(leg.keel, leg.turn)
    height = lowest_sphere(keel, foot.sole.spheres, ground)
    if stance is None:
        require_one_clock(plate, motion.time, height)
    else:
        own = part_of(plate, *stance)
        begin, end = 0.5 * (own.time[0] + stance[0]), 0.5 * (own.time[-1] + stance[1])
        near = (motion.time >= begin) & (motion.time <= end)
        require_one_clock(own, motion.time[near], height[near])
    require_near_heel(plate, keel, motion.time)


def simulated_walk(walk: Walk, *, turns: int, bushing: Bushing = SOCKET, machine_code: bool = True) -> LimbInSocket:
    """The stance over `Walk.span`, with the socket's motion taken out of its markers.

    Parameters
    ----------
    turns
        Most fits after the first, as those of `limb_in_socket`.
    machine_code
        Whether the equations are compiled first.

    ArithmeticError or ValueError as `simulate_stance`.
    """
    span = walk.span

    def along(motion: LegMotion) -> Stance:
        given = motion, walk.foot, walk.fulcrum, walk.push, span
        return simulate_stance(*given, bushing=bushing, ground=walk.ground, machine_code=machine_code)

    return limb_in_socket(walk.seen, walk.walked, along, cutoff=walk.cutoff, gap_limit=walk.gap_limit, turns=turns)
