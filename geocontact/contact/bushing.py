"""A bushing: a spring and a dashpot in each of six directions, F_i = -(k_i q_i + c_i q_i').

The six coordinates are those of a joint of six degrees of freedom, three Cardan angles and three translations in the
axes of the fixed frame, as in the bushing joint of the library with which the study of the variable-stiffness foot
models socket and residual limb. Each spring acts along its own coordinate, so the springs have the energy
sum k_i q_i² / 2 at any size of the angles; torques along Cardan angles are those of a torque vector only where the
angles are small.

The study prints 10 N mm/deg and 5 N mm s/deg for the rotations. 50 N m, which a socket carries in gait, would turn
such a spring by 87 rad: `PRINTED` has these numbers, `SOCKET` a thousand times as much, 10 N m/deg, which turns by 5
degrees. Its 20 N/mm and 10 N s/mm for the translations are taken as printed: under 900 N they creep with a time
constant of 0.5 s, to 34 mm after 0.7 s.

A limit of travel or speed is stated, not kept: `beyond` says where a motion goes past it. What holds a socket at its
limit is no part of this law (`contact.joint_stop` is one that does).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from jaxtyping import Bool, Float


@dataclass(frozen=True)
class Bushing:
    """Numbers of six directions: three rotations, then three translations.

    Parameters
    ----------
    stiffness
        k [N m/rad, N/m].
    damping
        c [N m s/rad, N s/m].

    ValueError for a number that is negative or not finite.
    """

    stiffness: tuple[float, float, float, float, float, float]
    damping: tuple[float, float, float, float, float, float]

    def __post_init__(self) -> None:
        numbers = np.array([self.stiffness, self.damping])
        if not (np.isfinite(numbers).all() and numbers.min() >= 0.0):
            raise ValueError("stiffness and damping of a bushing must be finite and not negative")

    def load(self, q: Any, u: Any) -> list[Any]:
        """Force along each coordinate [N m, N]; `q` and `u` hold six entries each: numbers, arrays or symbols."""
        return [-bushing_force(q[i], u[i], self.stiffness[i], self.damping[i]) for i in range(6)]

    def energy(self, q: Float[np.ndarray, "six t"]) -> Float[np.ndarray, " t"]:
        """Energy of the springs over time [J]."""
        return np.asarray(0.5 * np.array(self.stiffness) @ q**2)


@dataclass(frozen=True)
class BushingLimits:
    """How far [m] and how fast [m/s] a bushing may be displaced along one translation."""

    travel: float
    speed: float

    def beyond(
        self, value: Float[np.ndarray, " t"], rate: Float[np.ndarray, " t"]
    ) -> tuple[Bool[np.ndarray, " t"], Bool[np.ndarray, " t"]]:
        """Where the displacement, and where its rate, is past the limit in either sense."""
        return np.abs(value) > self.travel, np.abs(rate) > self.speed


def bushing_force(value: Any, rate: Any, k: Any, c: Any) -> Any:
    """k value + c rate: what a body that is displaced exerts along one direction [N m, N].

    Scalar in, scalar out: the same source runs on arrays and on CasADi symbols.
    """
    return k * value + c * rate


DEGREE = pi / 180.0
TRANSLATION, CREEP = 20e3, 10e3
"""N/m and N s/m, the study's 20 N/mm and 10 N s/mm."""
PRINTED = Bushing((10e-3 / DEGREE,) * 3 + (TRANSLATION,) * 3, (5e-3 / DEGREE,) * 3 + (CREEP,) * 3)
"""Socket and residual limb as the study prints them; no gait can be walked on it."""
SOCKET = Bushing((10.0 / DEGREE,) * 3 + (TRANSLATION,) * 3, (5.0 / DEGREE,) * 3 + (CREEP,) * 3)
"""The same with N m in place of N mm for the rotations."""
PISTONING = BushingLimits(travel=35e-3, speed=100e-3)
"""Pistoning of the residual limb along the socket, from the study."""
