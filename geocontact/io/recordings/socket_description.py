"""Description of the bushing between residual limb and socket: stiffness and damping of turns and shifts.

    turn_stiffness = { value = 10, unit = "N m/deg" }
    turn_damping = { value = 5, unit = "N m s/deg" }
    shift_stiffness = { value = 20, unit = "N/mm" }
    shift_damping = { value = 10, unit = "N s/mm" }

    [y]
    shift_stiffness = { value = 35, unit = "N/mm" }

Axes are those of the keel's frame while standing: x forwards, y upwards, z to the right. What an axis does not state is
that of all.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

from geocontact.contact.bushing import Bushing
from geocontact.data.plausible import N_M_PER_DEG, N_PER_MM, N_S_PER_MM, Plausible
from geocontact.data.units import Unit
from geocontact.io.documents import Document, WithUnit, read_document

N_M_S_PER_DEG = Unit("N m s/deg", "N m s/rad", math.degrees(1))
TURNING = Annotated[float, WithUnit(Plausible("the stiffness of a socket's turn", N_M_PER_DEG, (1e-3, 1e4)))]
TURN_DAMPING = Annotated[float, WithUnit(Plausible("the damping of a socket's turn", N_M_S_PER_DEG, (0.0, 1e4)))]
SHIFTING = Annotated[float, WithUnit(Plausible("the stiffness of a socket's shift", N_PER_MM, (0.1, 1e5)))]
SHIFT_DAMPING = Annotated[float, WithUnit(Plausible("the damping of a socket's shift", N_S_PER_MM, (0.0, 1e4)))]
KINDS = ("turn", "shift")


class SocketAxis(Document):
    """Numbers of one axis.

    Parameters
    ----------
    turn_stiffness, turn_damping
        About it; those of all axes by default.
    shift_stiffness, shift_damping
        Along it; those of all axes by default.
    """

    turn_stiffness: TURNING | None = None
    turn_damping: TURN_DAMPING | None = None
    shift_stiffness: SHIFTING | None = None
    shift_damping: SHIFT_DAMPING | None = None


class SocketDescription(Document):
    """A socket on a residual limb.

    Parameters
    ----------
    turn_stiffness, turn_damping
        About every axis that has none of its own.
    shift_stiffness, shift_damping
        Along every axis that has none of its own.
    x, y, z
        Numbers of an axis; pistoning is along y.
    """

    turn_stiffness: TURNING
    turn_damping: TURN_DAMPING
    shift_stiffness: SHIFTING
    shift_damping: SHIFT_DAMPING
    x: SocketAxis = SocketAxis()
    y: SocketAxis = SocketAxis()
    z: SocketAxis = SocketAxis()

    @property
    def bushing(self) -> Bushing:
        """Numbers of the six directions in SI."""
        (a, b, c, d, e, f), (g, h, i, j, k, m) = (self._six(of) for of in ("stiffness", "damping"))
        return Bushing((a, b, c, d, e, f), (g, h, i, j, k, m))

    def _six(self, of: str) -> list[float]:
        found = []
        for kind in KINDS:
            for axis in (self.x, self.y, self.z):
                own = getattr(axis, f"{kind}_{of}")
                found.append(float(getattr(self, f"{kind}_{of}") if own is None else own))
        return found


def read_socket(path: Path) -> SocketDescription:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, SocketDescription)
