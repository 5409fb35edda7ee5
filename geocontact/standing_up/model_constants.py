"""What a model that stands up is built of besides its parameters: bodies, the ground's law, straps."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.contact.smooth_half_space import CONSTANT, HERTZ_SMOOTHING, HUNT_CROSSLEY_SMOOTHING
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.smooth_sphere_contact import StribeckFriction
from geocontact.standing_up.strap_sites import StrapSite


@dataclass(frozen=True)
class GroundLaw:
    """OpenSim's sphere on the ground, without what is searched.

    Parameters
    ----------
    friction
        Before its factor.
    hertz, hunt_crossley, constant
        `hertz_smoothing` [1/m], `hunt_crossley_smoothing` [s/m] and `constant_contact_force` [m^2].
    """

    friction: StribeckFriction
    hertz: float = HERTZ_SMOOTHING
    hunt_crossley: float = HUNT_CROSSLEY_SMOOTHING
    constant: float = CONSTANT


@dataclass(frozen=True)
class ModelConstants:
    """Of one model, as its equations were built.

    Parameters
    ----------
    sites
        Where straps are; none without an exoskeleton.
    """

    chain: Multibody
    ground: GroundLaw
    sites: tuple[StrapSite, ...] = ()
