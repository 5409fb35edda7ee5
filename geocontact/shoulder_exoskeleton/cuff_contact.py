"""What the cuff does to the recorded arm: one point in a tube, whether the arm is inside, and what the equations read
of it.

A sphere beyond an end is still pressed on there, so that what is found has nothing to do with the device.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

import numpy as np
from jaxtyping import Float

from geocontact.contact.sphere_in_tube import TubeLaw, tube_contact
from geocontact.dynamics.recorded_inputs import RecordedInputs, linear_inputs, recorded_inputs, stepped_inputs
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import SIZES
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.padded_cuff import ArmLine, CuffLaw, cuff_load

if TYPE_CHECKING:
    from casadi import SX

    from geocontact.dynamics.tree import Moving


Cuff = Literal["point", "surface"]
FRICTION = (3, 4, 5)
"""Places of v_th, mu_s and mu_k among the numbers of the law, which both cuffs share."""
CUFF_LAW = tuple(each.name for each in fields(CuffLaw))
"""In the order of the numbers: `arm_numbers.PADDED`, then friction."""


@dataclass(frozen=True)
class HeldArm:
    """Load on the recorded arm, in the device's frame unless said otherwise.

    Parameters
    ----------
    force, couple
        [N], and the moment about the sphere's centre [N m].
    normal, friction
        Parts of the force in the cuff's axes [N].
    sliding, place
        Velocity of the sphere's centre in the cuff without what goes off its axis [m/s], and its place from the middle
        [m], in the cuff's axes.
    pressing
        Normal force, or pressures times areas [N].
    centre
        Of the pressures along the cuff, from its middle [m].
    peak, share
        Largest pressure [Pa] and share of the wall that is pressed on; 0 for a point.
    stored, lost
        Energy [J], and power of friction and damping [W].
    fed
        Power of the recorded arm [W].
    """

    force: SX
    couple: SX
    normal: SX
    friction: SX
    sliding: SX
    place: SX
    pressing: SX
    centre: SX
    peak: SX
    share: SX
    stored: SX
    lost: SX
    fed: SX


def held_at_a_point(arm: Moving, axes: SX, middle: SX, of: dict[str, SX], w: SX) -> HeldArm:
    """A sphere in a tube of its own radius.

    Parameters
    ----------
    arm
        Body that carries the cuff; `axes` and `middle` are the cuff's, in the device's frame.
    of
        Numbers by group.
    w
        Recorded: place and velocity of the sphere first; last the force that presses it into the cuff besides, which
        stands for that much more depth.
    """
    from casadi import SX, vertcat

    offset = axes.T @ (w[:3, :] - middle)
    velocity = axes.T @ (w[3:6, :] - speed_at(arm, w[:3, :]))
    law = TubeLaw(*(of["law"][i] for i in range(SIZES["law"])))
    deeper = offset - vertcat(0.0, 0.0, w[10, :] / law.k)
    found = tube_contact(_components(deeper), _components(velocity), (SX(1), SX(0), SX(0)), law)
    normal, friction, sliding = (vertcat(*each) for each in (found.normal, found.friction, found.sliding))
    force = axes @ (normal + friction)
    return HeldArm(
        force=force,
        couple=SX(3, 1),
        normal=normal,
        friction=friction,
        sliding=sliding,
        place=offset,
        pressing=found.pressing,
        centre=found.along,
        peak=SX(0),
        share=SX(0),
        stored=found.stored,
        lost=-friction.T @ sliding - (normal - vertcat(*found.spring)).T @ velocity,
        fed=-force.T @ w[3:6, :],
    )


def held_by_a_surface(arm: Moving, axes: SX, middle: SX, of: dict[str, SX], w: SX) -> HeldArm:
    """A padded cuff around the arm; recorded are also the direction of the arm's line and its rate, last in `w`."""
    from casadi import cross, vertcat

    line = ArmLine(w[:3, :], w[3:6, :], w[10:13, :], w[13:16, :])
    numbers = [of["padded"][i] for i in range(SIZES["padded"])] + [of["law"][i] for i in FRICTION]
    law = CuffLaw(**dict(zip(CUFF_LAW, numbers, strict=True)))
    found = cuff_load(line, arm, axes, middle, law)
    velocity = axes.T @ (line.speed - speed_at(arm, line.place))
    couple = found.moment - cross(line.place, found.force)
    spin = cross(line.direction, line.turning)
    return HeldArm(
        force=found.force,
        couple=couple,
        normal=axes.T @ found.normal,
        friction=axes.T @ found.friction,
        sliding=vertcat(velocity[0], 0.0, 0.0),
        place=axes.T @ (line.place - middle),
        pressing=found.pressing,
        centre=found.along,
        peak=found.peak,
        share=found.share,
        stored=found.stored,
        lost=found.lost,
        fed=-found.force.T @ line.speed - couple.T @ spin,
    )


def speed_at(body: Moving, place: SX) -> SX:
    """Velocity of the body's material point at a place of the ground's frame [m/s]."""
    from casadi import cross

    return body.speed + cross(body.spin, place - body.place)


def _components(vector: SX) -> tuple[SX, SX, SX]:
    return vector[0], vector[1], vector[2]


BEYOND = 0.5
"""Share of the cuff's radius: a sphere farther than that beyond an end is lost. One that is less far out is a warning,
not refused: without support the device hangs on the arm and slides to 20 mm beyond its end on the shipped trial."""
MOST_LOST = 0.25
"""Share of the time for which the sphere may be lost; beyond, nothing that is found is a result. Our choice: a cuff set
for an arm 8 cm too short loses it for 27 % of the shipped trial, one set 5 cm too short or 3 cm too long never."""
RAISED = np.radians(30.0)
"""Elevation below which an arm that was recorded at work comes somewhere, unless its markers are exchanged."""
SHORTEST, LONGEST = 0.20, 0.45
"""Upper arms of grown-up persons [m]."""


class OutOfCuffError(ArithmeticError):
    """The sphere is far out of the cuff for too long.

    Parameters
    ----------
    what
        For how long, when and how far.
    cause
        What is probably wrong, as a question to whoever gave the input.
    """

    def __init__(self, what: str, cause: str) -> None:
        super().__init__(f"{what}; {cause}")
        self.what, self.cause = what, cause


def require_in_cuff(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    along: Float[np.ndarray, " t"],
    hinge: Float[np.ndarray, "t 3"],
    most: float = MOST_LOST,
) -> None:
    """`OutOfCuffError` where the sphere is lost for more than this share of the time.

    Parameters
    ----------
    along
        Place of the sphere along the cuff, from its middle towards the hand [m].
    hinge
        Active joint, in the motion's frame [m].
    """
    end = 0.5 * device["cuff_length"]
    out = np.flatnonzero(np.abs(along) > end + BEYOND * device["cuff_radius"])
    if len(out) <= most * len(along):
        return
    time, far = motion.time[out[[0, -1]]], float(np.abs(along).max())
    what = (
        f"the sphere is far out of the cuff for {len(out) / len(along):.0%} of the time, between {time[0]:.2f} and "
        f"{time[1]:.2f} s, up to {1e3 * (far - end):.0f} mm beyond its end: no result"
    )
    raise OutOfCuffError(what, _cause(motion, device, wearer, along, hinge))


def _cause(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    along: Float[np.ndarray, " t"],
    hinge: Float[np.ndarray, "t 3"],
) -> str:
    """The first that the motion speaks for: exchanged markers, another length, a short cuff, a unit."""
    upper, lower = ("humerus_rup", "humerus_rdn") if motion.side == "right" else ("humerus_lup", "humerus_ldn")
    apart = [float(np.median(np.linalg.norm(each - hinge, axis=1))) for each in (motion.shoulder, motion.interface)]
    if apart[0] > apart[1] and motion.elevation.min() > RAISED:
        return (
            f"are {upper} and {lower} exchanged? the upper one is farther from the device's active joint "
            f"({1e3 * apart[0]:.0f} mm) than the lower one ({1e3 * apart[1]:.0f} mm)"
        )
    low, high = float(along.min()), float(along.max())
    fits = wearer.upper_arm + 0.5 * (low + high) / device["armrest_share"]
    if not SHORTEST <= fits <= LONGEST:
        return "are unit and names of the markers right, `person`, and `device`? no upper arm would fit them"
    if high - low > device["cuff_length"]:
        slides, long = 1e3 * (high - low), 1e3 * device["cuff_length"]
        return f"is `cuff_length` right? the sphere slides over {slides:.0f} mm, the cuff is {long:.0f} mm long"
    return (
        f"is `upper_arm` of `person` right, and its unit? {1e3 * wearer.upper_arm:.0f} mm are set, "
        f"{1e3 * fits:.0f} mm would put the cuff where the sphere is"
    )


MIRROR = np.array([-1.0, 1.0, 1.0])


REMEMBERED = 64
"""Motions whose mirror image and splines are kept: one is simulated under many profiles."""


@lru_cache(REMEMBERED)
def mirrored_arm(motion: ArmMotion) -> ArmMotion:
    """A left arm as a right one, which the equations are those of; a right one as it is."""
    if motion.side == "right":
        return motion
    return replace(
        motion,
        side="right",
        interface=motion.interface * MIRROR,
        shoulder=motion.shoulder * MIRROR,
        gravity=motion.gravity * MIRROR,
    )


def arm_inputs(
    motion: ArmMotion,
    factor: Float[np.ndarray, " t"] | None = None,
    cuff: Cuff = "point",
    pressed: Float[np.ndarray, " t"] | None = None,
) -> RecordedInputs:
    """Place and velocity of the sphere, gravity and the support's factor over time.

    Then the force that presses on a point, or the arm's line for a surface.
    """
    held = np.ones(len(motion.time)) if factor is None else np.asarray(factor, float)
    found = _placed(motion).beside(stepped_inputs(motion.time, held[:-1, None]))
    if cuff == "point":
        force = np.zeros(len(motion.time)) if pressed is None else np.asarray(pressed, float)
        return found.beside(linear_inputs(motion.time, force[:, None]))
    if pressed is not None:
        raise ValueError("a surface has no force that presses the arm into it besides its motion")
    line = motion.interface - motion.shoulder
    line = line / np.linalg.norm(line, axis=1, keepdims=True)
    return found.beside(recorded_inputs(motion.time, line, derivatives=1))


@lru_cache(REMEMBERED)
def _placed(motion: ArmMotion) -> RecordedInputs:
    """Place and velocity of the sphere, and gravity."""
    place = recorded_inputs(motion.time, motion.interface, derivatives=1)
    return place.beside(recorded_inputs(motion.time, motion.gravity_at_frames()))
