"""The contact forces of an OpenSim model on the spheres of a foot: `HuntCrossleyForce`, `SmoothSphereHalfSpaceForce`.

Both press with the Hertz force of a sphere on a half-space, 4/3 k sqrt(R) d^1.5, times 1 + 3/2 c d', and have the
friction of `contact.smooth_half_space.half_space_coefficient`. Sources: Simbody's `HuntCrossleyForce` (Sherman, Seth &
Delp 2011, Procedia IUTAM 2, 241-261); for the smooth one Serrancoli et al. 2019 (IEEE Trans Neural Syst Rehabil Eng 27,
1597-1605) as it became a component of Simbody. The smooth force acts before the sphere touches: 7 N at a depth of 0
for K = 1 MPa and R = 32 mm, less than 1e-6 N 50 mm above the ground, where it is cut off.

Deviation: while a sphere parts the smooth form pulls with up to 0.14 (3c/2) / b_v of its elastic force, and the other
rubs with a negative normal force (Simbody 3). Neither is taken: a force that would pull is 0.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.contact.smooth_half_space import half_space_coefficient, half_space_force

REACH = 50e-3
"""m above the ground, up to which the smooth force acts."""
NO_DISSIPATION = 1e-12
"""s/m; 2/(3c) is finite there, and 3/2 c d' is no digit of 1."""


@dataclass(frozen=True)
class OpenSimLaw:
    """Numbers of the contact forces, sphere by sphere.

    Parameters
    ----------
    smooth
        `SmoothSphereHalfSpaceForce`; else `HuntCrossleyForce`.
    modulus
        k of sphere and ground together [Pa].
    radius
        [m].
    dissipation
        c of both together [s/m].
    transition
        Transition velocity of friction [m/s].
    static, dynamic, viscous
        Coefficients of friction of both together [-, -, s/m].
    share
        Where the force acts, and what slides: so much of the depth above the sphere's lowest point [-].
    hertz_smoothing, velocity_smoothing, constant
        Of the smooth force: `hertz_smoothing` [1/m], `hunt_crossley_smoothing` [s/m], `constant_contact_force`.
    """

    smooth: Bool[np.ndarray, " n"]
    modulus: Float[np.ndarray, " n"]
    radius: Float[np.ndarray, " n"]
    dissipation: Float[np.ndarray, " n"]
    transition: Float[np.ndarray, " n"]
    static: Float[np.ndarray, " n"]
    dynamic: Float[np.ndarray, " n"]
    viscous: Float[np.ndarray, " n"]
    share: Float[np.ndarray, " n"]
    hertz_smoothing: Float[np.ndarray, " n"]
    velocity_smoothing: Float[np.ndarray, " n"]
    constant: Float[np.ndarray, " n"]

    def __post_init__(self) -> None:
        if not (np.minimum(self.modulus, self.radius) > 0.0).all() or not (self.transition > 0.0).all():
            raise ValueError("modulus, radius and transition velocity must be positive")

    @property
    def needs_velocity(self) -> bool:
        """Whether any force depends on how the foot moves, not only on where it is."""
        return any(bool(each.any()) for each in (self.dissipation, self.static, self.dynamic, self.viscous))

    @property
    def reach(self) -> float:
        """Height of a sphere above the ground up to which a force acts [m]."""
        return REACH if self.smooth.any() else 0.0

    def chosen(self, of: Bool[np.ndarray, " n"]) -> OpenSimLaw:
        """Numbers of some of the spheres."""
        return OpenSimLaw(**{each.name: getattr(self, each.name)[of] for each in fields(self)})

    def acts_at(self, sphere: Int[np.ndarray, " c"]) -> Float[np.ndarray, " c"]:
        """Place of the force above the sphere's lowest point, as a share of the depth [-]."""
        return np.asarray(self.share[sphere])

    def slides_at(self, sphere: Int[np.ndarray, " c"]) -> Float[np.ndarray, " c"]:
        """Place of the material point that slides, likewise [-]."""
        return np.asarray(self.share[sphere])

    def pressing(
        self, depth: Float[np.ndarray, " c"], closing: Float[np.ndarray, " c"], sphere: Int[np.ndarray, " c"]
    ) -> Float[np.ndarray, " c"]:
        """Normal force [N], >= 0, of depth [m] and its rate [m/s]."""
        k, radius, c = self.modulus[sphere], self.radius[sphere], self.dissipation[sphere]
        hertz = 4.0 / 3.0 * k * np.sqrt(radius) * np.maximum(depth, 0.0) ** 1.5
        plain = hertz * (1.0 + 1.5 * c * closing)
        rounded = half_space_force(
            depth,
            closing,
            2.0**1.5 * k,
            radius,
            np.maximum(c, NO_DISSIPATION),
            self.hertz_smoothing[sphere],
            self.velocity_smoothing[sphere],
            self.constant[sphere],
        )
        return np.asarray(np.maximum(np.where(self.smooth[sphere], rounded, plain), 0.0))

    def rubbing(self, sliding: Float[np.ndarray, "c 3"], sphere: Int[np.ndarray, " c"]) -> Float[np.ndarray, "c 3"]:
        """Friction over normal force, as a vector, of a velocity along the ground [m/s].

        The smooth force adds its constant to the square of the speed, so that it has a derivative at rest.
        """
        added = np.where(self.smooth[sphere], self.constant[sphere], 0.0)
        speed = np.sqrt(np.einsum("ci,ci->c", sliding, sliding) + added)
        numbers = (each[sphere] for each in (self.transition, self.static, self.dynamic, self.viscous))
        coefficient = half_space_coefficient(speed, *numbers)
        over = np.divide(coefficient, speed, out=np.zeros_like(speed), where=speed > 0.0)
        return np.asarray(-over[:, None] * sliding)
