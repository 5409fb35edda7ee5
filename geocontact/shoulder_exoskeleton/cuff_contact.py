"""What the cuff does to the recorded arm: one point in a tube, as in the paper, or the surface of a padded cuff."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Literal

from geocontact.contact.sphere_in_tube import TubeLaw, tube_contact
from geocontact.shoulder_exoskeleton.arm_numbers import SIZES
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
