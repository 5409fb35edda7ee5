"""A recorded stance: where the foot was and what the plate showed; from markers, or walked by the whole model."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.evaluation import PlateStance, at_times, longest_stance
from geocontact.below_knee_prosthesis.from_markers import MAP, Walked
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.quasi_static import KeelMotion, QuasiStaticKeel
from geocontact.below_knee_prosthesis.leg import MIDDLE, FootOffset, Leg
from geocontact.below_knee_prosthesis.leg_tree import (
    GRAVITY,
    HIP,
    KNEE,
    PELVIS,
    RECORDED,
    LegMotion,
    driving_inputs,
)
from geocontact.below_knee_prosthesis.plate_checks import (
    LATE,
    lowest_sphere,
    require_covering,
    require_one_clock,
    require_under_foot,
    require_weight,
)
from geocontact.below_knee_prosthesis.simulate import Push, share_of_foot
from geocontact.contact.bushing import SOCKET, Bushing
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Marker
from geocontact.dynamics.functional_joint import segment_poses
from geocontact.dynamics.recorded_inputs import RecordedInputs
from geocontact.geometry.shapes import HalfSpace
from geocontact.identify.signals.filters import filled_and_smoothed
from geocontact.loads.centre_of_pressure import GROUND_POINT, centre_of_pressure
from geocontact.loads.resultant import pose_rate
from geocontact.loads.sphere_set import SphereSet

FLOOR = HalfSpace()
"""Level ground, y up."""
CHANNELS = ("forward", "upward", "sideways", "centre")
"""Force on the foot in the ground's frame [N], and centre of pressure from the heel as a share of the keel's length."""


@dataclass(frozen=True)
class Errors:
    """Standard deviations of what was recorded; those of the poses are invented for a marker laboratory.

    Parameters
    ----------
    force
        Of the plate [N].
    couple
        Of the plate about its surface [N m]: over the vertical force it is the error of the centre.
    height, pitch
        Of the foot [m, rad]: what is constant over the stance, and as much that is not. 0.5 degrees are what a foot may
        have stood beside flat, as a choice of the foot has it.
    speed
        Of the foot along each axis [m/s]; along the floor from frame to frame (`slip`), upward constant.
    """

    force: float = 3.0
    couple: float = 1.0
    height: float = 0.5e-3
    pitch: float = np.radians(0.5)
    speed: float = 20e-3

    @property
    def standing(self) -> float:
        """Standard deviation of the height of the foot's middle [m]: a foot that did not stand flat stood on one of
        its ends.
        """
        return float(np.hypot(self.height, self.pitch * MIDDLE[0]))


@dataclass(frozen=True, eq=False)
class RecordedStance:
    """One stance on one plate, level, y up.

    Parameters
    ----------
    time, poses, rate
        Pose `X_GK` of the keel's straight frame, and its derivative.
    fulcrum
        [m].
    force
        Of the plate on the foot [N].
    centre
        Share of the keel's length from the heel; NaN where there is none.
    weight
        Of the body [N].
    standing
        Standing trial of the foot: stances of the same one share its errors of height and pitch; "" is one of its own.
    """

    time: Float[np.ndarray, " t"]
    poses: RigidTransform
    rate: Float[np.ndarray, "t 4 4"]
    fulcrum: float
    force: Float[np.ndarray, "t 3"]
    centre: Float[np.ndarray, " t"]
    weight: float
    errors: Errors = Errors()
    standing: str = ""

    @property
    def measured(self) -> Float[np.ndarray, "t c"]:
        """By `CHANNELS`."""
        return np.column_stack([self.force, self.centre])

    def solved(self, keel: QuasiStaticKeel) -> KeelMotion:
        """The keel without inertia along the poses."""
        return keel.solve(self.poses, FLOOR, rate=self.rate, time=self.time)

    def predicted(self, keel: QuasiStaticKeel, motion: KeelMotion) -> Float[np.ndarray, "t c"]:
        """The same channels of a model; the centre is NaN where nothing touches."""
        centre = centre_of_pressure(motion.loads, GROUND_POINT).centre
        return np.column_stack([motion.force, share_of_foot(self.poses, keel.keel.length, centre)])

    def noise(self, keel: QuasiStaticKeel) -> Float[np.ndarray, "t c"]:
        """Standard deviation of measured less predicted, were the model right.

        The plate's, and what errors of height, pitch and upward speed make of the predicted channels, each by one
        difference: what is constant of height and pitch is sought besides (`moved`), what changes is noise.
        """
        e = self.errors
        pressing = np.maximum(self.force[:, 1], 1.0)
        plate = np.column_stack([np.full((len(self.time), 3), e.force), e.couple / pressing / keel.keel.length])
        base = self.predicted(keel, self.solved(keel))
        square = plate**2
        rate = self.rate.copy()
        rate[:, 1, 3] += e.speed
        for other in (self.moved(e.standing, 0.0), self.moved(0.0, e.pitch), replace(self, rate=rate)):
            square += np.nan_to_num(other.predicted(keel, other.solved(keel)) - base) ** 2
        return np.asarray(np.sqrt(square))

    def moved(self, height: float, pitch: float) -> RecordedStance:
        """Raised by a height [m] and turned by a pitch [rad], the toes up, about `MIDDLE`."""
        raised = RigidTransform.from_translation([0.0, height, 0.0]) * self.poses
        turn = Rotation.from_euler("z", pitch)
        about = RigidTransform.from_components(MIDDLE - turn.apply(MIDDLE), turn)
        return replace(self, poses=raised * about)


def standing_trials(stances: Sequence[RecordedStance]) -> tuple[int, ...]:
    """Number of the standing trial of each stance, in the order in which they first occur."""
    names = [each.standing or f" {k}" for k, each in enumerate(stances)]
    order = list(dict.fromkeys(names))
    return tuple(order.index(name) for name in names)


def sizes_by_trial(stances: Sequence[RecordedStance]) -> Float[np.ndarray, " a"]:
    """One standard deviation of height [m] and pitch [rad] beforehand, by standing trial."""
    numbers = standing_trials(stances)
    firsts = [stances[numbers.index(k)].errors for k in range(len(set(numbers)))]
    return np.array([[each.standing, each.pitch] for each in firsts]).ravel()


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
    """Recorded stance of a right leg.

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


def stance_on_plate(
    seen: MarkerTrajectories,
    leg: Leg,
    plate: PlateStance,
    foot: VariableStiffnessFoot,
    fulcrum: float,
    *,
    cutoff: float | None,
    gap_limit: float,
    errors: Errors = USUAL,
) -> RecordedStance:
    """Recorded stance of a foot, which is seen to stand on the plate, on one clock with it.

    Parameters
    ----------
    seen
        Markers while walking.
    leg
        By a standing trial, of a right leg (`from_markers.standing_leg`).
    fulcrum
        [m].
    cutoff, gap_limit, errors
        As those of `stance_from_markers`.

    InputError as that, and where the plate is another foot's or runs on another clock.
    """
    stance = stance_from_markers(
        seen, leg, plate, fulcrum, foot.keel.length, cutoff=cutoff, gap_limit=gap_limit, errors=errors
    )
    heights = recorded_heights(seen, leg, foot.sole.spheres, cutoff=cutoff, gap_limit=gap_limit)
    require_one_clock(plate, *heights)
    require_under_foot(plate, stance.centre)
    return stance


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


ANGLE = np.radians(0.4)
"""rad; standard deviation of each turn of hip and knee, constant over the stance; invented. Pitch is 0.55° off."""
LEAD = 12
"""Samples that are simulated before the first that is compared, where the recording has them."""


@dataclass(frozen=True, eq=False)
class WalkedStance:
    """A stance that the whole model walks, as that of a right leg.

    Parameters
    ----------
    recorded
        Plate and poses of the foot by its markers, at even times; its errors are those of the start: height of the
        pelvis and its speed.
    motion
        Angles of pelvis, hip and knee.
    push
        Of the other leg.
    """

    recorded: RecordedStance
    motion: LegMotion
    push: Push
    bushing: Bushing = SOCKET

    @property
    def lead(self) -> int:
        """Samples before the first that is compared."""
        step = self.recorded.time[1] - self.recorded.time[0]
        room = int((self.recorded.time[0] - self.motion.time[0]) / step) - 2
        return int(np.clip(room, 0, LEAD))

    @property
    def begin(self) -> float:
        """When the simulation starts [s]."""
        time = self.recorded.time
        return float(time[0] - self.lead * (time[1] - time[0]))

    def inputs(self) -> RecordedInputs:
        """Inputs of the equations."""
        return driving_inputs(self.motion, self.push.at(self.motion.time))

    def with_foot(self, offset: FootOffset) -> WalkedStance:
        """With the foot beside its standing trial; the recorded poses stay as they are."""
        return replace(self, motion=replace(self.motion, leg=self.motion.leg.with_foot(offset)))

    def moved(self) -> Iterator[WalkedStance]:
        """By one standard deviation of each error of the motion: height, speed, each turn of hip and knee."""
        e, since = self.recorded.errors, self.motion.time - self.recorded.time[0]
        shifts = [(PELVIS[4], np.full(len(since), e.height))]
        shifts += [(name, e.speed * since) for name in PELVIS[3:]]
        shifts += [(name, np.full(len(since), ANGLE)) for name in (*HIP, *KNEE)]
        for name, by in shifts:
            values = self.motion.values.copy()
            values[:, RECORDED.index(name)] += by
            yield replace(self, motion=LegMotion(self.motion.leg, self.motion.time, values))


def walked_stance(stance: RecordedStance, fit: Walked, other: PlateStance, source: str) -> WalkedStance:
    """A recorded stance as the whole model walks it.

    Parameters
    ----------
    fit
        Motion of pelvis and leg by the markers (`from_markers.walked`).
    other
        Plate under the other foot, whose force stands for the other leg.
    source
        Where the markers are from: what an error names.

    InputError where markers or the other plate do not cover enough, and where nobody of that weight stands on it.
    """
    motion, time = fit.motion, stance.time
    require_weight(other, motion.leg.person.mass * GRAVITY, "`other_plate`")
    if motion.time[0] > time[0] - LATE or motion.time[-1] < time[-1]:
        what = f"markers are from {motion.time[0]:.2f} to {motion.time[-1]:.2f} s, the stance from {time[0]:.2f} to"
        remedy = "markers must begin before touch-down and end after it"
        raise InputError(source, "", f"{what} {time[-1]:.2f} s", remedy)
    require_covering(other, motion.time)
    return WalkedStance(stance, motion, Push(other.time, other.force))
