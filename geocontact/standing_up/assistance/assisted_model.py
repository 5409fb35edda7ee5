"""The exoskeleton helps at the knee with a share of the person's torque, most of all at one time of the movement.

Its torque there is s g(t/T) times that of the person's knee, with g = exp(-((t/T - c)/w)²/2): the share s and the time
c are to be chosen, the width w is invented. Its ankle turns freely; its hip holds the module, which no strap holds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.tree import tree_of
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.contact_parameter import ContactParameter
from geocontact.standing_up.exoskeleton import WORN_PARAMETERS, StrapLaw, two_chains, worn_model
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trials import StandingTrial, seen_in

if TYPE_CHECKING:
    from casadi import SX

WIDTH = 0.25
"""Of the help, in parts of the movement; invented."""
ASSISTANCE_PARAMETERS = (
    ContactParameter("share", "-", 0.25, 0.25, 0.0, 2.0),
    ContactParameter("timing", "-", 0.25, 0.25, 0.0, 0.8),
)
"""Of the person's knee torque, and where in the movement it is most."""
ASSISTED_PARAMETERS = (*WORN_PARAMETERS, *ASSISTANCE_PARAMETERS)
SHARE, TIMING = (len(WORN_PARAMETERS) + k for k in range(2))
KNEE = 1
"""Of the torques."""
TORQUES = ("ankle torque", "knee torque", "hip torque", "exo_hip torque")
"""What is sought over time."""
DRIVEN = (3, 4, 5, 8)
"""Coordinates that these turn."""


@dataclass(frozen=True)
class AssistedModel:
    """Two chains whose exoskeleton helps.

    Parameters
    ----------
    standing
        Its equations have the part of the movement as their first input, then `TORQUES`.
    help
        Of `standing`'s inputs and parameters: torque of the exoskeleton's knee [N m].
    width
        Of the help, in parts of the movement.
    """

    standing: StandingModel
    help: SX
    width: float

    @property
    def controlled(self) -> range:
        """Inputs of the equations that are sought."""
        return range(1, 1 + len(TORQUES))


def assisted_model(subject: Subject, strap: StrapLaw | None = None, width: float = WIDTH) -> AssistedModel:
    """Of a person who wears the exoskeleton, with the strap that is calibrated unless another is given."""
    from casadi import SX, exp, vertcat

    p, part, torque = SX.sym("p", len(ASSISTED_PARAMETERS)), SX.sym("part"), SX.sym("torque", len(TORQUES))
    helped = p[SHARE] * exp(-0.5 * ((part - p[TIMING]) / width) ** 2) * torque[KNEE]
    along = {name: torque[k] for k, name in enumerate(("ankle", "knee", "hip", "exo_hip"))} | {"exo_knee": helped}
    tree = tree_of(two_chains(subject))
    standing = worn_model(tree, p, along, vertcat(part, torque), ASSISTED_PARAMETERS, strap)
    return AssistedModel(standing, helped, width)


def seen_assisted(
    model: AssistedModel,
    motion: CollocatedMotion,
    p: Float[np.ndarray, " p"],
    time: Float[np.ndarray, " t"],
    name: str,
) -> StandingTrial:
    """What perfect encoders, plates and mats see of a motion; torques of all joints, the exoskeleton's too."""
    from casadi import Function

    seen = seen_in(model.standing, motion, p, time, name)
    sought, e = motion.control(time)[:, model.standing.count :], model.standing.equations
    part = (time - motion.breaks[0]) / np.ptp(motion.breaks)
    helped = Function("help", [e.w, e.p], [model.help]).map(len(time))
    knee = helped(np.column_stack([part, sought]).T, np.tile(p[:, None], (1, len(time)))).full()[0]
    torque = np.column_stack([sought[:, :3], np.zeros(len(time)), knee, sought[:, 3]])
    return replace(seen, torque=torque)
