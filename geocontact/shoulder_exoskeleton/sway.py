"""Sway of a person under what changes while an exoskeleton is worn: an inverted pendulum about the ankles.

A uniform rod from the ankles to the vertex leans by θ, positive forwards:

    J θ'' = (m g h - K) θ - B θ' + M(t)        J = m L²/3, h = L/2

M is the change of the moment about the ankles. K is what ankles and their reflexes do together, in units of m g h: the
ankles alone have 0.91 ± 0.23 of it and hold nobody up (Loram & Lakie 2002, J Physiol 545:1041). Stiffness by default
and damping are invented; what follows from them is of the order of the answer, not its size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.linalg import expm

GRAVITY = 9.80665
"""m/s²."""
ANKLE = 0.039
"""Height of the ankles over the stature (Winter 2009, Biomechanics and Motor Control, fig. 4.1)."""
INTRINSIC = 0.91
"""Stiffness of the ankles without reflexes over m g h (Loram & Lakie 2002)."""
STIFFNESS, DAMPING = 1.5, 0.7
"""Stiffness over m g h, and damping over the critical one of what it leaves; invented."""


@dataclass(frozen=True)
class InvertedPendulum:
    """A person who stands.

    Parameters
    ----------
    mass, height
        Of the person [kg], [m].
    stiffness
        K over m g h, more than 1. ValueError for one that lets the person fall.
    damping
        B over 2 sqrt(J (K - m g h)).
    """

    mass: float
    height: float
    stiffness: float = STIFFNESS
    damping: float = DAMPING

    def __post_init__(self) -> None:
        if not self.stiffness > 1.0:
            raise ValueError(f"a stiffness of {self.stiffness:g} m g h holds nobody up: more than 1 is needed")

    @property
    def length(self) -> float:
        """Ankles to vertex [m]."""
        return self.height * (1.0 - ANKLE)

    @property
    def toppling(self) -> float:
        """m g h [N m/rad]."""
        return self.mass * GRAVITY * 0.5 * self.length

    @property
    def inertia(self) -> float:
        """J [kg m²]."""
        return self.mass * self.length**2 / 3.0

    @property
    def left(self) -> float:
        """K - m g h [N m/rad]."""
        return (self.stiffness - 1.0) * self.toppling

    def sway(
        self, time: Float[np.ndarray, " t"], moment: Float[np.ndarray, " t"], start: float
    ) -> Float[np.ndarray, " t"]:
        """Lean [rad] under a moment [N m] at even times; exact for one that is linear between them.

        Parameters
        ----------
        start
            Moment [N m] in whose equilibrium the person stands before.
        """
        steps = np.diff(time)
        if not np.allclose(steps, steps[0]):
            raise ValueError("sway is found at even times")
        free, last, change = self._over(float(steps[0]))
        first, second = np.outer(moment[:-1], last - change), np.outer(moment[1:], change)
        now, found = np.array([start / self.left, 0.0]), np.empty(len(time))
        found[0] = now[0]
        for k in range(len(steps)):
            now = free @ now + first[k] + second[k]
            found[k + 1] = now[0]
        return found

    def _over(self, step: float) -> tuple[Float[np.ndarray, "2 2"], Float[np.ndarray, " 2"], Float[np.ndarray, " 2"]]:
        """What lean and its rate become over a step [s]: of themselves, of a moment that stays, and of its change.

        One exponential of all three, as the moment's own rate is constant (Van Loan 1978, IEEE Trans Autom Control
        23:395).
        """
        damping = 2.0 * self.damping * np.sqrt(self.inertia * self.left)
        rates: Float[np.ndarray, "4 4"] = np.zeros((4, 4))
        rates[0, 1] = step
        rates[1, :3] = -self.left / self.inertia * step, -damping / self.inertia * step, 1.0 / self.inertia * step
        rates[2, 3] = 1.0
        found = expm(rates)
        return found[:2, :2], found[:2, 2], found[:2, 3]
