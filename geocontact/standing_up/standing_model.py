"""A model that stands up: its bodies, the ground's law, its equations, and what its sensors show."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.contact.smooth_half_space import CONSTANT, HERTZ_SMOOTHING, HUNT_CROSSLEY_SMOOTHING
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.equations import Equations
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.sphere_contact import StribeckFriction
from geocontact.dynamics.symbols import column
from geocontact.standing_up.strap_sites import ContactParameter, StrapSite
from geocontact.standing_up.worn_device import WornDevice

if TYPE_CHECKING:
    from casadi import SX


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
    """Constants of one model, as its equations were built.

    Parameters
    ----------
    sites
        Where straps are; none without an exoskeleton.
    device
        The exoskeleton; None without one.
    """

    chain: Multibody
    ground: GroundLaw
    sites: tuple[StrapSite, ...] = ()
    device: WornDevice | None = None


@dataclass(frozen=True)
class StandingModel:
    """Coordinates are the foot's place (two) and turns; inputs are the torques of the joints, turns after the first,
    and where somebody sits the force of the chair.

    Parameters
    ----------
    equations
        Their parameters are what is searched of `parameters`.
    force, centre
        Of the ground on both feet, forwards and up [N], (2, 1), and its centre of pressure, forwards [m].
    strap, shear
        Force of the strap of one leg on the person [N], across the thigh, which a mat sees, and along it, which none
        does; no entry without an exoskeleton.
    energy, normal_energy
        Of those components of the straps that no mat sees, and of the normal one [J].
    given
        How many of the inputs, the last ones, are given over time.
    elsewhere
        Normal force of one strap at each further site on the person [N], by its name.
    constants
        What the equations were built of besides the parameters; None for a model of another kind.
    """

    equations: Equations
    parameters: tuple[ContactParameter, ...]
    force: SX
    centre: SX
    strap: SX
    shear: SX
    energy: SX
    normal_energy: SX
    given: int = 0
    elsewhere: Mapping[str, SX] = field(default_factory=dict)
    constants: ModelConstants | None = None

    def __post_init__(self) -> None:
        """Keep all of it as CasADi's own columns, whatever a force law returned. ValueError for another shape."""
        for name, count in (("force", 2), ("centre", 1), ("energy", 1), ("normal_energy", 1)):
            object.__setattr__(self, name, column(getattr(self, name), count))
        worn = 1 if self.strap.numel() else 0
        for name in ("strap", "shear"):
            object.__setattr__(self, name, column(getattr(self, name), worn))
        object.__setattr__(self, "elsewhere", {name: column(of, 1) for name, of in self.elsewhere.items()})

    @cached_property
    def stepper(self) -> Stepper:
        """Steps of the equations, made once for all motions."""
        return Stepper(self.equations)

    @property
    def straps(self) -> SX:
        """Normal force of one strap at each site [N]."""
        from casadi import vertcat

        return vertcat(self.strap, *self.elsewhere.values())

    @property
    def count(self) -> int:
        """Number of coordinates."""
        return len(self.equations.names)

    @property
    def joints(self) -> tuple[str, ...]:
        """Coordinates that a torque drives: as many as there are inputs that are not given."""
        return self.equations.names[3 : 3 + self.equations.w.numel() - self.given]

    @property
    def torques(self) -> SX:
        """Torques of these joints [N m]."""
        return self.equations.w[: len(self.joints), :]

    @property
    def turning(self) -> tuple[bool, ...]:
        """Which coordinates are angles."""
        return (False, False, *(True for _ in self.equations.names[2:]))

    def per_coordinate(self, place: float, turn: float) -> Float[np.ndarray, " n"]:
        """One number for the foot's places and one for all turns."""
        return np.where(np.array(self.turning), turn, place)
