"""Description of the bushing between residual limb and socket: stiffness and damping of turns and shifts.

    turn_stiffness = { value = 10, unit = "N m/deg" }
    turn_damping = { value = 5, unit = "N m s/deg" }
    shift_stiffness = { value = 20, unit = "N/mm" }
    shift_damping = { value = 10, unit = "N s/mm" }

    piston_stiffness = { value = 35, unit = "N/mm" }

Axes are those of the keel's frame while standing, with y along the limb: pistoning.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

from geocontact.data.plausible import N_M_PER_DEG, N_PER_MM, N_S_PER_MM, Plausible
from geocontact.data.units import Unit
from geocontact.io.documents import Document, WithUnit, read_document

N_M_S_PER_DEG = Unit("N m s/deg", "N m s/rad", math.degrees(1))
TURNING = Annotated[float, WithUnit(Plausible("the stiffness of a socket's turn", N_M_PER_DEG, (1e-3, 1e4)))]
TURN_DAMPING = Annotated[float, WithUnit(Plausible("the damping of a socket's turn", N_M_S_PER_DEG, (0.0, 1e4)))]
SHIFTING = Annotated[float, WithUnit(Plausible("the stiffness of a socket's shift", N_PER_MM, (0.1, 1e5)))]
SHIFT_DAMPING = Annotated[float, WithUnit(Plausible("the damping of a socket's shift", N_S_PER_MM, (0.0, 1e4)))]


class SocketDescription(Document):
    """A socket on a residual limb.

    Parameters
    ----------
    turn_stiffness, turn_damping
        About every axis.
    shift_stiffness, shift_damping
        Across the limb, and along it by default.
    piston_stiffness, piston_damping
        Along the limb.
    """

    turn_stiffness: TURNING
    turn_damping: TURN_DAMPING
    shift_stiffness: SHIFTING
    shift_damping: SHIFT_DAMPING
    piston_stiffness: SHIFTING | None = None
    piston_damping: SHIFT_DAMPING | None = None


def read_socket(path: Path) -> SocketDescription:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, SocketDescription)
